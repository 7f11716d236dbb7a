// Weights by ratios of neighbouring densities: twin of src/bdpt/mis.rs.

const TIE: f32 = 1e-4;

// A positive number as mantissa in [1, 2) and binary exponent, or zero.
struct Scaled {
    mantissa: f32,
    exponent: i32,
}

fn scaled(x: f32) -> Scaled {
    let bits = bitcast<u32>(x);
    let exponent = i32((bits >> 23u) & 255u);
    if exponent == 0 {
        return Scaled(0.0, 0);
    }
    return Scaled(bitcast<f32>((bits & 0x007fffffu) | 0x3f800000u), exponent - 127);
}

fn times_ratio(x: Scaled, numerator: f32, denominator: f32) -> Scaled {
    let n = scaled(numerator);
    let d = scaled(denominator);
    if d.mantissa == 0.0 || n.mantissa == 0.0 {
        return Scaled(0.0, 0);
    }
    let m = scaled(x.mantissa * n.mantissa / d.mantissa);
    return Scaled(m.mantissa, x.exponent + n.exponent - d.exponent + m.exponent);
}

fn scaled_to_f32(x: Scaled) -> f32 {
    if x.mantissa == 0.0 || x.exponent < -126 {
        return 0.0;
    }
    return x.mantissa * bitcast<f32>(u32(min(x.exponent, 126) + 127) << 23u);
}

fn scaled_powf(x: Scaled, beta: f32) -> f32 {
    if x.mantissa == 0.0 {
        return 0.0;
    }
    if beta == 2.0 {
        return scaled_to_f32(Scaled(1.0, 2 * x.exponent)) * (x.mantissa * x.mantissa);
    }
    if beta == 1.0 {
        return scaled_to_f32(x);
    }
    return exp2(clamp((log2(x.mantissa) + f32(x.exponent)) * beta, -126.0, 126.0));
}

// What is summed over the ratios n_i p_i/(n_s p_s) of the active strategies i ≠ s.
const SUM_POWERS: u32 = 0u;
const COUNT_ALL: u32 = 1u;
const LARGEST: u32 = 2u;
const COUNT_TIES: u32 = 3u;
const SUM_ABOVE: u32 = 4u;

fn take_ratio(so_far: f32, ratio: Scaled, what: u32, parameter: f32) -> f32 {
    switch what {
        case SUM_POWERS: { return so_far + scaled_powf(ratio, parameter); }
        case COUNT_ALL: { return so_far + 1.0; }
        case LARGEST: { return max(so_far, scaled_to_f32(ratio)); }
        case COUNT_TIES: { return so_far + select(0.0, 1.0, scaled_to_f32(ratio) >= parameter); }
        default: {
            let value = scaled_to_f32(ratio);
            return so_far + select(0.0, value, value >= parameter);
        }
    }
}

// n_{i+1}/n_i.
fn more_tries(i: u32) -> f32 {
    return select(1.0, control.params.light_subpaths, i + 1u == path_k);
}

fn for_each_ratio(s: u32, what: u32, start: f32, parameter: f32) -> f32 {
    var result = start;
    var ratio = Scaled(1.0, 0);
    for (var i = s; i <= path_k; i++) {
        ratio = times_ratio(ratio, p_light[i] * more_tries(i), p_eye[i]);
        if ratio.mantissa == 0.0 {
            break;
        }
        if is_active(i + 1u) {
            result = take_ratio(result, ratio, what, parameter);
        }
    }
    ratio = Scaled(1.0, 0);
    for (var i = s; i > 0u; i--) {
        ratio = times_ratio(ratio, p_eye[i - 1u], p_light[i - 1u] * more_tries(i - 1u));
        if ratio.mantissa == 0.0 {
            break;
        }
        if is_active(i - 1u) {
            result = take_ratio(result, ratio, what, parameter);
        }
    }
    return result;
}

// Σ_{i≠s} (n_i p_i/(n_s p_s))^β for β = 1 or 2 in plain f32; −1 as soon as a ratio leaves the range in which its square is safe.
fn plain_sum(s: u32, squared: bool) -> f32 {
    var sum = 0.0;
    var ratio = 1.0;
    for (var i = s; i <= path_k; i++) {
        if p_light[i] == 0.0 {
            break;
        }
        ratio *= p_light[i] * more_tries(i) / p_eye[i];
        if !(ratio >= 1e-18 && ratio < 1e18) {
            return -1.0;
        }
        if is_active(i + 1u) {
            sum += select(ratio, ratio * ratio, squared);
        }
    }
    ratio = 1.0;
    for (var i = s; i > 0u; i--) {
        if p_eye[i - 1u] == 0.0 {
            break;
        }
        ratio *= p_eye[i - 1u] / (p_light[i - 1u] * more_tries(i - 1u));
        if !(ratio >= 1e-18 && ratio < 1e18) {
            return -1.0;
        }
        if is_active(i - 1u) {
            sum += select(ratio, ratio * ratio, squared);
        }
    }
    return sum;
}

// w_s of the strategy that made the path. Two rounds at most over the ratios, by the same code.
fn mis_weight(s: u32) -> f32 {
    let kind = control.params.heuristic;
    let plain = kind <= HEURISTIC_BALANCE && (control.params.beta == 2.0 || control.params.beta == 1.0);
    if plain {
        // Most paths are harmless; the others, and other exponents, take the careful way.
        let sum = plain_sum(s, control.params.beta == 2.0);
        if sum >= 0.0 {
            return 1.0 / (1.0 + sum);
        }
    }
    var what = SUM_POWERS;
    var parameter = control.params.beta;
    if kind == HEURISTIC_UNIFORM {
        what = COUNT_ALL;
    } else if kind == HEURISTIC_MAX || kind == HEURISTIC_CUTOFF {
        what = LARGEST;
    }
    loop {
        // The strategy itself counts 1 in every sum, and is the first largest.
        let result = for_each_ratio(s, what, 1.0, parameter);
        if what != LARGEST {
            return 1.0 / result;
        }
        what = select(SUM_ABOVE, COUNT_TIES, kind == HEURISTIC_MAX);
        parameter = result * select(control.params.cutoff, 1.0 - TIE, kind == HEURISTIC_MAX);
        if 1.0 < parameter {
            return 0.0;
        }
    }
    return 0.0;
}
