// Random numbers without state: twin of src/rng.rs, bit for bit.

struct SampleId {
    x: u32,
    y: u32,
    sample: u32,
    seed: u32,
}

fn words(id: SampleId, block: u32) -> vec4<u32> {
    return pcg4d(vec4<u32>(id.x | (id.y << 16u), id.sample, id.seed, block));
}

fn numbers(id: SampleId, block: u32) -> vec4<f32> {
    let w = words(id, block);
    return vec4<f32>(unit_f32(w.x), unit_f32(w.y), unit_f32(w.z), unit_f32(w.w));
}

fn pcg4d(v_in: vec4<u32>) -> vec4<u32> {
    var v = v_in * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v = v ^ (v >> vec4<u32>(16u));
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

fn unit_f32(bits: u32) -> f32 {
    return f32(bits >> 8u) * (1.0 / 16777216.0);
}
