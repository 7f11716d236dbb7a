// Adding splats to a tile of the film: twin of `Splats::add` in src/film/mod.rs.

// 64-bit counters in pairs of words, [layer][channel][pixel].
@group(1) @binding(0) var<storage, read_write> splats: array<atomic<u32>>;

// Half of what the high word can hold.
const MAX_HIGH: u32 = 0x80000000u;

@compute @workgroup_size(64)
fn resolve(@builtin(global_invocation_id) global: vec3<u32>) {
    let count = min(atomicLoad(&output.records_count), arrayLength(&output.records));
    // The grid has a lane for each pair, and some more to fill the last workgroup.
    let lanes = (control.batch.pairs + 63u) / 64u * 64u;
    for (var i = global.x; i < count; i += lanes) {
        resolve_record(output.records[i]);
    }
}

fn resolve_record(record: SplatRecord) {
    let first = control.batch.tile_row * control.params.size.x;
    if record.pixel < first || record.pixel - first >= control.batch.tile_pixels {
        return;
    }
    let id = SampleId(record.source & 0xffffu, record.source >> 16u, control.batch.sample, control.params.seed, control.params.sampler);
    let u = hashed(id, BLOCK_SPLAT + record.s).xyz;
    let slot = tables[control.params.slots + record.strategy];
    let weighted = record.value * record.mis_weight;
    add_to_splats(0u, record.pixel - first, weighted, u);
    add_to_splats(slot.y, record.pixel - first, weighted, u);
    add_to_splats(slot.z, record.pixel - first, record.value, u);
}

fn add_to_splats(layer: u32, place: u32, value: vec3<f32>, u: vec3<f32>) {
    if layer == NONE {
        return;
    }
    var left_out = 0u;
    for (var c = 0u; c < 3u; c++) {
        let at = ((layer * 3u + c) * control.batch.tile_pixels + place) * 2u;
        let rounded = quanta(value[c], u[c]);
        if rounded.x == 0u && rounded.y == 0u {
            continue;
        }
        let before = atomicAdd(&splats[at], rounded.x);
        let high = rounded.y + select(0u, 1u, before + rounded.x < before);
        if high > 0u {
            if atomicAdd(&splats[at + 1u], high) >= MAX_HIGH - min(high, MAX_HIGH) {
                // Too much for the counter: this splat is left out, all but its low word, and the caller told.
                atomicSub(&splats[at + 1u], high);
                left_out = 1u;
            }
        }
    }
    if left_out == 1u {
        atomicAdd(&output.saturated, 1u);
    }
}

// value / quantum, rounded stochastically, as low and high word; at most 2⁶³.
fn quanta(value: f32, u: f32) -> vec2<u32> {
    let q = value / control.params.quantum;
    if !(q < 9.223372e18) {
        return vec2<u32>(0u, MAX_HIGH);
    }
    let whole = floor(q);
    if whole < 16777216.0 {
        return vec2<u32>(u32(max(whole, 0.0)) + select(0u, 1u, u < q - whole), 0u);
    }
    // From 2²⁴ on an f32 has no fraction left to round: its mantissa, shifted.
    let bits = bitcast<u32>(whole);
    let mantissa = (bits & 0x7fffffu) | 0x800000u;
    let places = ((bits >> 23u) & 255u) - 150u;
    if places == 0u {
        return vec2<u32>(mantissa, 0u);
    }
    if places < 32u {
        return vec2<u32>(mantissa << places, mantissa >> (32u - places));
    }
    return vec2<u32>(0u, mantissa << (places - 32u));
}
