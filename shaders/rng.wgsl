// Random numbers without state: twin of src/rng.rs, bit for bit.

struct SampleId {
    x: u32,
    y: u32,
    sample: u32,
    seed: u32,
    // One of SAMPLER_….
    sampler: u32,
}

fn words(id: SampleId, block: u32) -> vec4<u32> {
    return pcg4d(vec4<u32>(pixel_word(id), id.sample, id.seed, block));
}

fn hashed(id: SampleId, block: u32) -> vec4<f32> {
    return units_f32(words(id, block));
}

fn numbers(id: SampleId, block: u32) -> vec4<f32> {
    // One hash, called from one place: the keys of the points, or the numbers themselves.
    let spread = id.sampler == SAMPLER_SOBOL;
    var w = pcg4d(vec4<u32>(pixel_word(id), select(id.sample, KEYS, spread), id.seed, block));
    if spread {
        w = sobol_words(id.sample, w);
    }
    return units_f32(w);
}

fn pixel_word(id: SampleId) -> u32 {
    return id.x | (id.y << 16u);
}

fn units_f32(w: vec4<u32>) -> vec4<f32> {
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
