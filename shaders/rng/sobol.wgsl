// Points that fill the cube evenly: twin of src/rng/sobol.rs, bit for bit.

// In the place of the sample's number, where the keys are drawn.
const KEYS: u32 = 0xffffffffu;

fn sobol_words(sample: u32, keys: vec4<u32>) -> vec4<u32> {
    let order = keys.x ^ ((keys.y << 8u) | (keys.y >> 24u)) ^ ((keys.z << 16u) | (keys.z >> 16u)) ^ ((keys.w << 24u) | (keys.w >> 8u));
    let x = sobol_point(reverseBits(owen_scramble(reverseBits(sample), order)));
    return reverseBits(vec4<u32>(owen_scramble(x.x, keys.x), owen_scramble(x.y, keys.y), owen_scramble(x.z, keys.z), owen_scramble(x.w, keys.w)));
}

fn sobol_point(index: u32) -> vec4<u32> {
    let over = pascal_over_four(index);
    return vec4<u32>(index, pascal(index), over, pascal(over));
}

fn pascal(bits: u32) -> u32 {
    var v = bits;
    v = v ^ ((v & 0xaaaaaaaau) >> 1u);
    v = v ^ ((v & 0xccccccccu) >> 2u);
    v = v ^ ((v & 0xf0f0f0f0u) >> 4u);
    v = v ^ ((v & 0xff00ff00u) >> 8u);
    return v ^ (v >> 16u);
}

fn pascal_over_four(bits: u32) -> u32 {
    var v = bits;
    v = v ^ times_omega((v & 0xccccccccu) >> 2u);
    v = v ^ times_omega(times_omega((v & 0xf0f0f0f0u) >> 4u));
    v = v ^ times_omega((v & 0xff00ff00u) >> 8u);
    return v ^ times_omega(times_omega(v >> 16u));
}

fn times_omega(v: u32) -> u32 {
    return ((v >> 1u) & 0x55555555u) | ((v ^ (v << 1u)) & 0xaaaaaaaau);
}

fn owen_scramble(bits: u32, key: u32) -> u32 {
    var x = bits ^ (bits * 0x3d20adeau);
    x = (x + key) * ((key >> 16u) | 1u);
    x = x ^ (x * 0x05526c56u);
    return x ^ (x * 0x53a22864u);
}
