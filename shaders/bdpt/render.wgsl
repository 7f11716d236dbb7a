// The kernels: for every pair of subpaths of a batch the light side (t ≤ 1), then the eye side (t ≥ 2). Twin of
// src/bdpt/render.rs, cut in two so that each kernel has its own registers and its own share of a driver's loop limit.

const WORKGROUP_SIZE: u32 = 64u;

struct Slot {
    // Does the strategy run?
    runs: bool,
    // Layers within the kind that t decides, or NONE.
    weighted: u32,
    raw: u32,
}

fn load_slot(s: u32, t: u32) -> Slot {
    let word = tables[control.params.slots + strategy_index(s, t)];
    return Slot(word.x != 0u, word.y, word.z);
}

fn strategy_index(s: u32, t: u32) -> u32 {
    let k = s + t - 1u;
    return (k - 1u) * (k + 4u) / 2u + s;
}

// The sample of a pair of this batch.
fn sample_of(pair: u32) -> SampleId {
    let row = pair / control.params.size.x;
    let pixel = vec2<u32>(pair % control.params.size.x, control.batch.first_row + row * control.batch.row_step);
    return SampleId(pixel.x, pixel.y, control.batch.sample, control.params.seed, control.params.sampler);
}

// Whose numbers the eye subpath of a sample has.
fn eye_id(id: SampleId) -> SampleId {
    return SampleId(id.x, id.y, control.batch.pass_number, id.seed, id.sampler);
}

fn in_crop(pixel: vec2<u32>) -> bool {
    let origin = vec2<u32>(control.params.crop_x, control.params.crop_y);
    return all(pixel >= origin) && all(pixel - origin < vec2<u32>(control.params.crop_width, control.params.crop_height));
}

// y_i of a pair: vertex by vertex, so that neighbours in a workgroup are neighbours in memory.
fn light_place(i: u32, pair: u32) -> u32 {
    return i * control.batch.pairs + pair;
}

@compute @workgroup_size(WORKGROUP_SIZE)
fn trace_light(@builtin(global_invocation_id) global: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let pair = global.x;
    if pair < control.batch.pairs {
        light_side(sample_of(pair), pair);
    }
    count_up(local);
}

fn light_side(id: SampleId, pair: u32) {
    var count = 0u;
    if control.params.lights_count > 0u {
        count = light_subpath(id, pair);
    }
    if count < control.params.light_vertices {
        light_vertices[light_place(count, pair)].flags = 0u;
    }
    let z0 = numbers(eye_id(id), BLOCK_EYE_START).zw;
    for (var s = 1u; s <= min(count, control.params.max_edges); s++) {
        if !load_slot(s, 1u).runs {
            continue;
        }
        var u = z0;
        if control.params.fresh_ends != 0u && has_lens() {
            u = numbers(id, BLOCK_FRESH_LENS + s).xy;
        }
        let a = light_vertices[light_place(s - 1u, pair)];
        var opacity_a = 1.0;
        if HAS_ALPHA && s >= 2u {
            opacity_a = light_vertices[light_place(s - 2u, pair)].look.opacity;
        }
        splat(id, s, 1u, evaluate(id, s, 1u, a, lens_vertex(sample_lens(u)), opacity_a, 1.0));
    }
}

// Walks y₀, y₁, … into `light_vertices`, and through the lens where it crosses it; their number.
fn light_subpath(id: SampleId, pair: u32) -> u32 {
    var last = sample_light_vertex(id, BLOCK_LIGHT_START, BLOCK_LIGHT_PLACE);
    var step = light_start(id, &last);
    keep_light_vertex(0u, pair, last);
    if step.pdf_fwd_psa <= 0.0 || all(last.alpha == vec3<f32>(0.0)) {
        return 1u;
    }
    var count = 1u;
    while count < control.params.light_vertices {
        let taken = step;
        let walked = walk_step(&step, IMPORTANCE, id, last, count - 1u, count + 1u == control.params.light_vertices);
        if walked.pdf_rev_area > 0.0 {
            light_rev[count - 1u] = walked.pdf_rev_area;
            light_vertices[light_place(count - 1u, pair)].pdf_rev_area = walked.pdf_rev_area;
        }
        if has_lens() && (walked.pushed || walked.end == END_ESCAPED) && load_slot(count + 1u, 0u).runs {
            let lens = crossing(last, walked, taken);
            if lens.some {
                splat(id, count + 1u, 0u, light_hits_lens(count + 1u, lens.vertex, vertex_opacity(last)));
            }
        }
        if !walked.pushed {
            break;
        }
        last = walked.vertex;
        keep_light_vertex(count, pair, last);
        count++;
        if walked.end != END_NONE {
            break;
        }
    }
    return count;
}

fn keep_light_vertex(i: u32, pair: u32, v: Vertex) {
    light_fwd[i] = v.pdf_fwd_area;
    light_rev[i] = 0.0;
    light_flags[i] = v.flags;
    light_vertices[light_place(i, pair)] = v;
}

// Hands a splat over to the kernel that adds it.
fn splat(id: SampleId, s: u32, t: u32, contribution: Contribution) {
    if !contribution.some {
        return;
    }
    let weighted = contribution.contribution_unweighted * contribution.mis_weight;
    if !is_finite_vec3(contribution.contribution_unweighted) || !is_finite_vec3(weighted) {
        non_finite++;
        return;
    }
    if !in_crop(contribution.pixel) {
        return;
    }
    let index = atomicAdd(&output.records_count, 1u);
    if index < arrayLength(&output.records) {
        output.records[index] = SplatRecord(
            contribution.contribution_unweighted, contribution.mis_weight, contribution.pixel.y * control.params.size.x + contribution.pixel.x,
            id.x | (id.y << 16u), strategy_index(s, t), s,
        );
    }
}

@compute @workgroup_size(WORKGROUP_SIZE)
fn trace_eye(@builtin(global_invocation_id) global: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let pair = global.x;
    if pair < control.batch.pairs {
        let id = sample_of(pair);
        if in_crop(vec2<u32>(id.x, id.y)) {
            eye_side(id, pair);
        }
    }
    count_up(local);
}

fn eye_side(id: SampleId, pair: u32) {
    let light_count = recall_light_vertices(pair);
    let image_place = (id.y - control.batch.tile_row) * control.params.size.x + id.x;
    let own = eye_id(id);
    let u = numbers(own, BLOCK_EYE_START);
    let raster = vec2<f32>(inside_cell(id.x, u.x), inside_cell(id.y, u.y));
    var last = lens_vertex(sample_lens(u.zw));
    var step = eye_start(last, raster);
    eye_fwd[0] = last.pdf_fwd_area;
    eye_rev[0] = 0.0;
    eye_flags[0] = last.flags;
    var image = vec3<f32>(0.0);
    var count = 1u;
    while count < control.params.eye_vertices {
        let walked = walk_step(&step, RADIANCE, own, last, count - 1u, count + 1u == control.params.eye_vertices);
        if !walked.pushed {
            break;
        }
        image += eye_vertex(id, pair, image_place, count + 1u, walked.vertex, vertex_opacity(last), light_count);
        eye_rev[count - 1u] = walked.pdf_rev_area;
        eye_fwd[count] = walked.vertex.pdf_fwd_area;
        eye_rev[count] = 0.0;
        eye_flags[count] = walked.vertex.flags;
        last = walked.vertex;
        count++;
        if walked.end != END_NONE {
            break;
        }
    }
    add_to_film(0u, image_place, image);
}

// Fetches what paths need of the light vertices away from the connection; how many there are.
fn recall_light_vertices(pair: u32) -> u32 {
    var count = 0u;
    while count < control.params.light_vertices {
        let place = light_place(count, pair);
        let flags = light_vertices[place].flags;
        if flags == 0u {
            break;
        }
        light_fwd[count] = light_vertices[place].pdf_fwd_area;
        light_rev[count] = light_vertices[place].pdf_rev_area;
        light_flags[count] = flags;
        count++;
    }
    return count;
}

// Every strategy that ends at z_{t−1} = b; what they add to the image.
fn eye_vertex(id: SampleId, pair: u32, place: u32, t: u32, b: Vertex, opacity_b: f32, light_count: u32) -> vec3<f32> {
    var image = vec3<f32>(0.0);
    var most = min(max(light_count, 1u), control.params.max_edges + 1u - t);
    if has(b, AT_INFINITY) || control.params.lights_count == 0u {
        most = 0u;
    }
    for (var s = 0u; s <= most; s++) {
        let fresh = s == 1u && control.params.fresh_ends != 0u;
        if !load_slot(s, t).runs || (s > light_count && !fresh) {
            continue;
        }
        var a: Vertex;
        var opacity_a = 1.0;
        if fresh {
            a = sample_light_vertex(id, BLOCK_FRESH_LIGHT + t, BLOCK_FRESH_PLACE + t);
        } else if s > 0u {
            a = light_vertices[light_place(s - 1u, pair)];
        }
        if HAS_ALPHA && s >= 2u {
            opacity_a = light_vertices[light_place(s - 2u, pair)].look.opacity;
        }
        image += add(s, t, place, evaluate(id, s, t, a, b, opacity_a, opacity_b));
    }
    return image;
}

// Adds to the strategy's own layers; the weighted contribution.
fn add(s: u32, t: u32, place: u32, contribution: Contribution) -> vec3<f32> {
    if !contribution.some {
        return vec3<f32>(0.0);
    }
    let weighted = contribution.contribution_unweighted * contribution.mis_weight;
    if !is_finite_vec3(contribution.contribution_unweighted) || !is_finite_vec3(weighted) {
        non_finite++;
        return vec3<f32>(0.0);
    }
    let slot = load_slot(s, t);
    add_to_film(slot.weighted, place, weighted);
    add_to_film(slot.raw, place, contribution.contribution_unweighted);
    return weighted;
}

// Adds to a layer of the batch's tile: [layer][channel][pixel].
fn add_to_film(layer: u32, place: u32, value: vec3<f32>) {
    if layer == NONE {
        return;
    }
    let at = layer * 3u * control.batch.tile_pixels + place;
    film[at] += value.x;
    film[at + control.batch.tile_pixels] += value.y;
    film[at + 2u * control.batch.tile_pixels] += value.z;
}

// Sums of a workgroup's counts.
var<workgroup> group_counts: array<atomic<u32>, 5>;

// Adds what this invocation counted to the totals. Every invocation of the group comes here.
fn count_up(local: u32) {
    // A driver that stops loops without a word (lavapipe does after 65 535 rounds) stops this one too.
    var rounds = 0u;
    while rounds < control.params.canary {
        rounds++;
    }
    atomicAdd(&group_counts[0], rays_closest);
    atomicAdd(&group_counts[1], rays_shadow);
    atomicAdd(&group_counts[2], non_finite);
    atomicAdd(&group_counts[3], stack_overflows);
    atomicAdd(&group_counts[4], select(1u, 0u, rounds == control.params.canary));
    workgroupBarrier();
    if local == 0u {
        // Rays are counted in two words each.
        let closest = atomicLoad(&group_counts[0]);
        let before_closest = atomicAdd(&output.rays_closest_low, closest);
        atomicAdd(&output.rays_closest_high, select(0u, 1u, before_closest + closest < before_closest));
        let shadow = atomicLoad(&group_counts[1]);
        let before_shadow = atomicAdd(&output.rays_shadow_low, shadow);
        atomicAdd(&output.rays_shadow_high, select(0u, 1u, before_shadow + shadow < before_shadow));
        atomicAdd(&output.non_finite, atomicLoad(&group_counts[2]));
        atomicAdd(&output.stack_overflows, atomicLoad(&group_counts[3]));
        atomicAdd(&output.cut_short, atomicLoad(&group_counts[4]));
    }
}
