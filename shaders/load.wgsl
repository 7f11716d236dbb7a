// Reading shared structs out of `tables`, which holds several arrays; the n-th of an array that begins at a given vec4. (A test reads random structs back on the device, byte for byte.)

fn load_material(index: u32) -> Material {
    let at = control.params.materials + index * 6u;
    let a = tables[at];
    let b = tables[at + 1u];
    let c = tables[at + 2u];
    let d = bitcast<vec4<f32>>(tables[at + 3u]);
    let e = tables[at + 4u];
    let f = tables[at + 5u];
    return Material(
        bitcast<vec3<f32>>(a.xyz), a.w,
        bitcast<vec3<f32>>(b.xyz), bitcast<f32>(b.w),
        bitcast<vec3<f32>>(c.xyz), bitcast<f32>(c.w),
        d.x, d.y, d.z, d.w,
        bitcast<f32>(e.x), e.y, e.z, bitcast<f32>(e.w),
        f.x, f.y, f.z, f.w,
    );
}

fn load_light(index: u32) -> Light {
    let at = control.params.lights + index * 4u;
    let a = tables[at];
    let b = tables[at + 1u];
    let c = tables[at + 2u];
    let d = bitcast<vec4<f32>>(tables[at + 3u]);
    return Light(
        bitcast<vec3<f32>>(a.xyz), a.w,
        bitcast<vec3<f32>>(b.xyz), b.w,
        bitcast<vec3<f32>>(c.xyz), bitcast<f32>(c.w),
        d.x, d.y, d.z, d.w,
    );
}

fn load_texture(index: u32) -> Texture {
    let at = control.params.textures + index * 3u;
    let a = tables[at];
    let b = tables[at + 1u];
    let c = tables[at + 2u];
    return Texture(a.x, a.y, a.z, a.w, bitcast<vec3<f32>>(b.xyz), b.w, bitcast<vec3<f32>>(c.xyz), c.w);
}

fn load_texel(index: u32) -> Texel {
    let a = tables[control.params.environment_texels + index];
    return Texel(bitcast<vec3<f32>>(a.xyz), bitcast<f32>(a.w));
}

// Two cells share a vec4.
fn load_alias_cell(first: u32, index: u32) -> AliasCell {
    let a = tables[first + (index >> 1u)];
    let odd = (index & 1u) == 1u;
    return AliasCell(bitcast<f32>(select(a.x, a.z, odd)), select(a.y, a.w, odd));
}

// Four linear values share a vec4.
fn load_linear(code: u32) -> f32 {
    return bitcast<f32>(tables[control.params.linear + (code >> 2u)][code & 3u]);
}

fn load_attributes(index: u32) -> Attributes {
    let at = control.params.attributes + index * 2u;
    let a = tables[at];
    let b = tables[at + 1u];
    return Attributes(a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w);
}

fn load_normals(index: u32) -> Normals {
    let at = control.params.normals + index * 3u;
    let a = tables[at];
    let b = tables[at + 1u];
    let c = tables[at + 2u];
    return Normals(bitcast<vec3<f32>>(a.xyz), a.w, bitcast<vec3<f32>>(b.xyz), b.w, bitcast<vec3<f32>>(c.xyz), c.w);
}

fn load_tangents(index: u32) -> Tangents {
    let at = control.params.tangents + index * 3u;
    let a = tables[at];
    let b = tables[at + 1u];
    let c = tables[at + 2u];
    return Tangents(bitcast<vec3<f32>>(a.xyz), bitcast<f32>(a.w), bitcast<vec3<f32>>(b.xyz), b.w, bitcast<vec3<f32>>(c.xyz), c.w);
}

// Two entries share three vec4s.
fn load_uvs(index: u32) -> Uvs {
    let at = control.params.uvs + (index >> 1u) * 3u;
    let b = bitcast<vec4<f32>>(tables[at + 1u]);
    if (index & 1u) == 0u {
        let a = bitcast<vec4<f32>>(tables[at]);
        return Uvs(a.xy, a.zw, b.xy);
    }
    let c = bitcast<vec4<f32>>(tables[at + 2u]);
    return Uvs(b.zw, c.xy, c.zw);
}

fn load_colors(index: u32) -> Colors {
    let at = control.params.colors + index * 3u;
    return Colors(bitcast<vec4<f32>>(tables[at]), bitcast<vec4<f32>>(tables[at + 1u]), bitcast<vec4<f32>>(tables[at + 2u]));
}
