// A point on a surface and what its material looks like there: twin of src/scene/surface.rs.

struct SurfacePoint {
    position: vec3<f32>,
    n_g: vec3<f32>,
    n_s: vec3<f32>,
    error: f32,
    triangle: u32,
    material: u32,
    light: u32,
    look: Look,
}

const MIN_COS: f32 = 1e-3;
// γ₉ of f32.
const GAMMA_9: f32 = 5.3644209e-7;

fn look_of(material: Material) -> Look {
    return Look(material.color, material.roughness, material.metallic, 1.0, vec2<f32>(0.0));
}

fn look_nothing() -> Look {
    return Look(vec3<f32>(0.0), 0.0, 0.0, 1.0, vec2<f32>(0.0));
}

fn surface_point(triangle: u32, b: vec2<f32>) -> SurfacePoint {
    let tri = triangles[triangle];
    let q0 = tri.p0 * (1.0 - b.x - b.y);
    let q1 = tri.p1 * b.x;
    let q2 = tri.p2 * b.y;
    let n_g = normalized(cross3(tri.p1 - tri.p0, tri.p2 - tri.p0));
    let material = load_material(tri.material);
    var look = look_of(material);
    look.barycentric = b;
    let error = GAMMA_9 * max_element(abs(q0) + abs(q1) + abs(q2));
    var point = SurfacePoint(q0 + q1 + q2, n_g, n_g, error, triangle, tri.material, tri.light, look);
    if tri.attributes != NONE {
        let own = load_attributes(tri.attributes);
        if own.normals != NONE {
            point.n_s = normals_at(load_normals(own.normals), b);
        }
        if HAS_TEXTURES && material_has(material, VARIES | TRANSPARENT) {
            look_up(&point, material, own, tri);
        } else if HAS_ALPHA && material_has(material, TRANSPARENT) {
            point.look.opacity = alpha_of(material, base_color(material, own, b).w);
        }
    } else if HAS_ALPHA && material_has(material, TRANSPARENT) {
        point.look.opacity = alpha_of(material, 1.0);
    }
    return point;
}

// Looks up what varies: colour, roughness, metallic share, normal, alpha. One loop over the textures: inlined for each, a
// look-up would be most of a kernel.
fn look_up(point: ptr<function, SurfacePoint>, material: Material, own: Attributes, tri: Triangle) {
    let b = (*point).look.barycentric;
    var values = array<vec4<f32>, 3>(vec4<f32>(1.0), vec4<f32>(1.0), vec4<f32>(0.0));
    let varies = material_has(material, VARIES);
    for (var i = 0u; i < 3u; i++) {
        var texture = material.base_color_texture;
        if i > 0u {
            texture = select(NONE, select(material.normal_texture, material.metallic_roughness_texture, i == 1u), varies);
        }
        if texture != NONE {
            values[i] = textured(texture, own, b);
        }
    }
    if own.colors != NONE {
        values[0] *= colors_at(load_colors(own.colors), b);
    }
    if HAS_ALPHA && material_has(material, TRANSPARENT) {
        (*point).look.opacity = alpha_of(material, values[0].w);
    }
    if varies {
        (*point).look.color *= values[0].xyz;
        (*point).look.roughness *= values[1].y;
        if material.kind == COAT {
            (*point).look.metallic *= values[1].z;
        }
        if material.normal_texture != NONE {
            (*point).n_s = mapped_normal((*point).n_g, (*point).n_s, values[2].xyz * 2.0 - 1.0, b, material, own, tri);
        }
    }
}

// Texture times vertex colour: what multiplies the base colour and alpha.
fn base_color(material: Material, own: Attributes, b: vec2<f32>) -> vec4<f32> {
    var value = vec4<f32>(1.0);
    if material.base_color_texture != NONE {
        value = textured(material.base_color_texture, own, b);
    }
    if own.colors != NONE {
        value = value * colors_at(load_colors(own.colors), b);
    }
    return value;
}

fn uv_set(texture: u32, own: Attributes) -> u32 {
    return select(own.uvs_0, own.uvs_1, (load_texture(texture).flags & SET_1) != 0u);
}

// A texture's value at a point of a triangle; without its texture coordinates, as at (0, 0). (`texture` in Rust.)
fn textured(texture: u32, own: Attributes, b: vec2<f32>) -> vec4<f32> {
    let uvs = uv_set(texture, own);
    var uv = vec2<f32>(0.0);
    if uvs != NONE {
        uv = uvs_at(load_uvs(uvs), b);
    }
    return texture_value(texture, uv);
}

// The normal that a normal map makes of the interpolated one `n`; on the geometric normal's side.
fn mapped_normal(
    n_g: vec3<f32>, n: vec3<f32>, texel: vec3<f32>, b: vec2<f32>, material: Material, own: Attributes, tri: Triangle,
) -> vec3<f32> {
    let zero = vec3<f32>(0.0);
    let raw = tangent(b, material, own, tri);
    let local = normalized_or(texel * vec3<f32>(material.normal_scale, material.normal_scale, 1.0), zero);
    let t = normalized_or(raw.xyz - n * dot3(n, raw.xyz), zero);
    if raw.w == 0.0 || all(local == zero) || all(t == zero) {
        return n;
    }
    let mapped = t * local.x + cross3(n, t) * (raw.w * local.y) + n * local.z;
    let cos = dot3(mapped, n_g);
    return normalized_or(mapped + n_g * max(MIN_COS - cos, 0.0), n);
}

// The direction of a normal map's x, and the sign of its y in w; w = 0 if there is none.
fn tangent(b: vec2<f32>, material: Material, own: Attributes, tri: Triangle) -> vec4<f32> {
    if own.tangents != NONE {
        let t = load_tangents(own.tangents);
        return vec4<f32>(tangents_at(t, b), t.sign);
    }
    let uvs = uv_set(material.normal_texture, own);
    if uvs == NONE {
        return vec4<f32>(0.0);
    }
    let texture = load_texture(material.normal_texture);
    let uv = load_uvs(uvs);
    let e1 = tri.p1 - tri.p0;
    let e2 = tri.p2 - tri.p0;
    let d1 = turned(texture, uv.uv1 - uv.uv0);
    let d2 = turned(texture, uv.uv2 - uv.uv0);
    let det = d1.x * d2.y - d1.y * d2.x;
    let t = (e1 * d2.y - e2 * d1.y) * copysign(1.0, det);
    return vec4<f32>(t, select(copysign(1.0, -det), 0.0, det == 0.0));
}

fn turned(texture: Texture, d: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(texture.row_u.x * d.x + texture.row_u.y * d.y, texture.row_v.x * d.x + texture.row_v.y * d.y);
}

// a at a point of a triangle whose material may be transparent.
fn opacity_at(material: Material, own_index: u32, b: vec2<f32>) -> f32 {
    var varies = 1.0;
    if own_index != NONE {
        varies = base_color(material, load_attributes(own_index), b).w;
    }
    return alpha_of(material, varies);
}

// a where texture and vertex colour make so much of it.
fn alpha_of(material: Material, varies: f32) -> f32 {
    let a = clamp(material.opacity * varies, 0.0, 1.0);
    if material.cutoff < 0.0 {
        return a;
    }
    return select(0.0, 1.0, a >= material.cutoff);
}

// What multiplies a light's radiance at a point of its triangle: the emissive texture.
fn emission_factor(triangle: u32, material_index: u32, b: vec2<f32>) -> vec3<f32> {
    if !HAS_TEXTURES {
        return vec3<f32>(1.0);
    }
    let material = load_material(material_index);
    let own_index = triangles[triangle].attributes;
    let unlit = material_has(material, UNLIT);
    if (material.emissive_texture == NONE && !unlit) || own_index == NONE {
        return vec3<f32>(1.0);
    }
    let own = load_attributes(own_index);
    var value = vec4<f32>(1.0);
    if material.emissive_texture != NONE {
        value = textured(material.emissive_texture, own, b);
    }
    if unlit && own.colors != NONE {
        value = value * colors_at(load_colors(own.colors), b);
    }
    return value.xyz;
}
