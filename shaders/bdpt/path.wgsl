// A full path and its density under every strategy: twin of src/bdpt/path.rs.
// What a subpath's vertices contribute far from the connection is kept in small arrays; the ends come as vertices.

const PATH_SIZE: u32 = MAX_VERTICES + 1u;

// The joined path.
var<private> path_k: u32;
var<private> p_light: array<f32, PATH_SIZE>;
var<private> p_eye: array<f32, PATH_SIZE>;
// Bit s: strategy s takes part and can make the path.
var<private> path_active: array<u32, 3>;

// pdf_fwd_area, pdf_rev_area and flags of y₀, y₁, … and z₀, z₁, …
var<private> light_fwd: array<f32, PATH_SIZE>;
var<private> light_rev: array<f32, PATH_SIZE>;
var<private> light_flags: array<u32, PATH_SIZE>;
var<private> eye_fwd: array<f32, PATH_SIZE>;
var<private> eye_rev: array<f32, PATH_SIZE>;
var<private> eye_flags: array<u32, PATH_SIZE>;

// Becomes the path of y₀…y_{s−1} and z_{t−1}…z₀, t ≥ 1, whose ends are a and b; `at_a` and `at_b` is what they scatter along
// the edge, `geometry` is that of the edge with its V, `opacity_a` and `opacity_b` are a of y_{s−2} and z_{t−2}. s = 0 has no a
// and no edge.
fn join(
    s: u32, t: u32, a: Vertex, b: Vertex, geometry: f32, at_a: Evaluated, at_b: Evaluated, opacity_a: f32, opacity_b: f32,
) {
    let k = s + t - 1u;
    path_begin(k);
    for (var i = 0u; i + 1u < s; i++) {
        take_light_vertex(i, true);
    }
    for (var j = 0u; j + 1u < t; j++) {
        let i = k - j;
        p_eye[i] = eye_fwd[j];
        p_light[i] = eye_rev[j];
        if (eye_flags[j] & DELTA) != 0u {
            no_connection_at(i);
        }
    }
    p_eye[s] = b.pdf_fwd_area;
    if s == 0u {
        join_at_light(b, opacity_b);
    } else {
        // y_{s−1} may be a fresh end.
        p_light[s - 1u] = a.pdf_fwd_area;
        if s == 1u && has(a, DISCRETE) {
            rule_out(0u);
        }
        p_light[s] = a.survival * at_a.forward * geometry * vertex_opacity(b);
        p_eye[s - 1u] = b.survival * at_b.forward * geometry * vertex_opacity(a);
        if t >= 2u {
            p_light[s + 1u] = b.survival * at_b.reverse * b.geometry_prev * opacity_b;
        }
        if s >= 2u {
            p_eye[s - 2u] = a.survival * at_a.reverse * a.geometry_prev * opacity_a;
        }
    }
    path_activate();
}

// t = 0: becomes the path of a light subpath y₀…y_{k−1} that went on to the lens.
fn join_at_lens(k: u32, lens: Vertex, opacity_last: f32) {
    path_begin(k);
    for (var i = 0u; i < k; i++) {
        take_light_vertex(i, true);
    }
    p_light[k] = lens.pdf_fwd_area;
    p_eye[k] = control.params.pdf_lens_area;
    p_eye[k - 1u] = pdf_direction_psa_on_film(lens.w_prev) * lens.geometry_prev * opacity_last;
    path_activate();
}

// s = 0: x₀ lies on a light, which could have chosen it and emitted towards x₁.
fn join_at_light(x0: Vertex, opacity_x1: f32) {
    let light = load_light(x0.light);
    p_light[0] = pdf_origin(light, x0.w_prev);
    let leaves_psa = light_pdf_direction_psa(light, x0.n_g, x0.w_prev, control.params.pdf_disk_area);
    p_light[1] = leaves_psa * x0.geometry_prev * opacity_x1;
}

fn path_begin(k: u32) {
    path_k = k;
    path_active[0] = 0xffffffffu;
    path_active[1] = 0xffffffffu;
    path_active[2] = 0xffffffffu;
    // A pinhole cannot be hit.
    if !has_lens() {
        rule_out(k + 1u);
    }
}

fn rule_out(s: u32) {
    path_active[s >> 5u] &= ~(1u << (s & 31u));
}

fn is_active(s: u32) -> bool {
    return ((path_active[s >> 5u] >> (s & 31u)) & 1u) == 1u;
}

fn take_light_vertex(i: u32, scatters: bool) {
    p_light[i] = light_fwd[i];
    p_eye[i] = light_rev[i];
    if scatters && (light_flags[i] & DELTA) != 0u {
        no_connection_at(i);
    }
    if i == 0u && (light_flags[i] & DISCRETE) != 0u {
        rule_out(0u);
    }
}

fn no_connection_at(i: u32) {
    rule_out(i);
    rule_out(i + 1u);
}

// Word n of the strategies that take part in paths of k edges: bit s is strategy (s, k + 1 − s).
fn strategy_row(k: u32, n: u32) -> u32 {
    let first = (k - 1u) * (k + 4u) / 2u + 32u * n;
    let shift = first & 31u;
    let low = strategy_word(first >> 5u) >> shift;
    if shift == 0u {
        return low;
    }
    return low | (strategy_word((first >> 5u) + 1u) << (32u - shift));
}

fn strategy_word(i: u32) -> u32 {
    return select(0u, control.params.strategies[min(i >> 2u, 17u)][i & 3u], i < 72u);
}

fn path_activate() {
    path_active[0] &= strategy_row(path_k, 0u);
    if path_k + 1u >= 32u {
        path_active[1] &= strategy_row(path_k, 1u);
        path_active[2] &= strategy_row(path_k, 2u);
    }
}
