// Textures: twin of src/scene/texture.rs.

const FARTHEST: f32 = 1e9;

// Texture coordinates after the transform, in texels.
fn texture_place(texture: Texture, uv: vec2<f32>) -> vec2<f32> {
    let uv1 = vec3<f32>(uv, 1.0);
    let place = vec2<f32>(dot3(texture.row_u, uv1) * f32(texture.width), dot3(texture.row_v, uv1) * f32(texture.height));
    return clamp(place, vec2<f32>(-FARTHEST), vec2<f32>(FARTHEST));
}

// The linear value at texture coordinates, alpha last. One loop over the taps: inlined four times, a texel would be most of a
// kernel.
fn texture_value(index: u32, uv: vec2<f32>) -> vec4<f32> {
    let texture = load_texture(index);
    let place = texture_place(texture, uv);
    let single = (texture.flags & NEAREST) != 0u;
    let low = select(floor(place - 0.5), floor(place), single);
    let part = select(place - 0.5 - low, vec2<f32>(0.0), single);
    var rows = array<vec4<f32>, 2>();
    for (var tap = 0u; tap < select(4u, 1u, single); tap++) {
        let right = f32(tap & 1u);
        let value = texture_texel(texture, low + vec2<f32>(right, f32(tap >> 1u)));
        rows[tap >> 1u] += value * select(1.0 - part.x, part.x, right == 1.0);
    }
    return rows[0] * (1.0 - part.y) + rows[1] * part.y;
}

// The linear value of the texel in this column and row, whole numbers; wrapped.
fn texture_texel(texture: Texture, at: vec2<f32>) -> vec4<f32> {
    let x = wrapped(at.x, texture.width, (texture.flags >> WRAP_U) & 3u);
    let y = wrapped(at.y, texture.height, (texture.flags >> WRAP_V) & 3u);
    let word = texels[texture.first + y * texture.width + x];
    let bytes = vec4<u32>(word & 255u, (word >> 8u) & 255u, (word >> 16u) & 255u, word >> 24u);
    if (texture.flags & SRGB) != 0u {
        return vec4<f32>(load_linear(bytes.x), load_linear(bytes.y), load_linear(bytes.z), f32(bytes.w) * (1.0 / 255.0));
    }
    return vec4<f32>(bytes) * (1.0 / 255.0);
}

fn period(at: f32, n: f32) -> f32 {
    return at - floor(at / n) * n;
}

// A whole number of texels, brought into the image.
fn wrapped(at: f32, size: u32, wrap: u32) -> u32 {
    let n = f32(size);
    var inside = at;
    if wrap == 1u {
        let place = period(at, 2.0 * n);
        inside = select(place, 2.0 * n - 1.0 - place, place >= n);
    } else if wrap != 2u {
        inside = period(at, n);
    }
    return min(u32(max(inside, 0.0)), size - 1u);
}
