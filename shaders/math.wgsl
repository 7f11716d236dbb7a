// Vectors, frames and sampling warps: twin of src/math.rs.
// Normalisations are written out, because the builtin may round in another way.

const PI: f32 = 3.14159265358979;
const INV_PI: f32 = 0.318309886183791;
const MAX_FLOAT: f32 = 3.40282346638528859812e+38;

// x.copysign(sign)
fn copysign(x: f32, sign: f32) -> f32 {
    return bitcast<f32>((bitcast<u32>(x) & 0x7fffffffu) | (bitcast<u32>(sign) & 0x80000000u));
}

// Is it neither infinite nor NaN? By its bits: a compiler may assume that neither occurs.
fn is_finite(x: f32) -> bool {
    return (bitcast<u32>(x) & 0x7f800000u) != 0x7f800000u;
}

fn is_finite_vec3(v: vec3<f32>) -> bool {
    return is_finite(v.x) && is_finite(v.y) && is_finite(v.z);
}

fn max_element(v: vec3<f32>) -> f32 {
    return max(v.x, max(v.y, v.z));
}

fn element_sum(v: vec3<f32>) -> f32 {
    return v.x + v.y + v.z;
}

fn dot3(a: vec3<f32>, b: vec3<f32>) -> f32 {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

fn length_squared(v: vec3<f32>) -> f32 {
    return dot3(v, v);
}

fn cross3(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y);
}

fn normalized(v: vec3<f32>) -> vec3<f32> {
    return v * (1.0 / sqrt(length_squared(v)));
}

// The unit vector along v, or `otherwise` where v has no direction.
fn normalized_or(v: vec3<f32>, otherwise: vec3<f32>) -> vec3<f32> {
    let rcp = 1.0 / sqrt(length_squared(v));
    if length_squared(v) > 0.0 && is_finite(rcp) && rcp > 0.0 {
        return v * rcp;
    }
    return otherwise;
}

struct Frame {
    x: vec3<f32>,
    y: vec3<f32>,
    z: vec3<f32>,
}

fn frame_around(z: vec3<f32>) -> Frame {
    let sign = copysign(1.0, z.z);
    let a = -1.0 / (sign + z.z);
    let b = z.x * z.y * a;
    return Frame(vec3<f32>(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x), vec3<f32>(b, sign + z.y * z.y * a, -z.y), z);
}

fn to_world(frame: Frame, v: vec3<f32>) -> vec3<f32> {
    return frame.x * v.x + frame.y * v.y + frame.z * v.z;
}

// (sin, cos) of 2π·turn
fn sin_cos_turn(turn: f32) -> vec2<f32> {
    let quarter = floor(turn * 4.0 + 0.5);
    let a = (turn - quarter * 0.25) * (2.0 * PI);
    let a2 = a * a;
    let s = a * (1.0 + a2 * (-1.6666665e-1 + a2 * (8.333216e-3 + a2 * -1.9515296e-4)));
    let c = 1.0 + a2 * (-0.5 + a2 * (4.1666646e-2 + a2 * (-1.3887316e-3 + a2 * 2.4433157e-5)));
    switch i32(quarter) & 3 {
        case 0: { return vec2<f32>(s, c); }
        case 1: { return vec2<f32>(c, -s); }
        case 2: { return vec2<f32>(-s, -c); }
        default: { return vec2<f32>(-c, s); }
    }
}

fn sample_disk(u: vec2<f32>) -> vec2<f32> {
    let a = u * 2.0 - 1.0;
    if a.x == 0.0 && a.y == 0.0 {
        return vec2<f32>(0.0);
    }
    var radius = a.y;
    var turn = 0.0;
    if abs(a.x) > abs(a.y) {
        radius = a.x;
        turn = (a.y / a.x) * 0.125;
    } else {
        turn = 0.25 - (a.x / a.y) * 0.125;
    }
    let sc = sin_cos_turn(turn - floor(turn));
    return vec2<f32>(sc.y, sc.x) * radius;
}

fn sample_cosine_hemisphere(u: vec2<f32>) -> vec3<f32> {
    let d = sample_disk(u);
    return vec3<f32>(d.x, d.y, sqrt(max(1.0 - (d.x * d.x + d.y * d.y), 0.0)));
}

fn sample_sphere(u: vec2<f32>) -> vec3<f32> {
    return direction_at(u.y, 2.0 * u.x);
}

fn direction_at(turn: f32, versine: f32) -> vec3<f32> {
    let sc = sin_cos_turn(turn);
    let r = sqrt(max(versine * (2.0 - versine), 0.0));
    return vec3<f32>(sc.y * r, sc.x * r, 1.0 - versine);
}

fn versine(a: vec3<f32>, b: vec3<f32>) -> f32 {
    return 0.5 * length_squared(a - b);
}

fn turn_of(y: f32, x: f32) -> f32 {
    let ax = abs(x);
    let ay = abs(y);
    let small = min(ax, ay);
    let large = max(ax, ay);
    if large == 0.0 {
        return 0.0;
    }
    let shifted = small > 0.41421357 * large;
    var a = 0.0;
    if shifted {
        a = (small - large) / (small + large);
    } else {
        a = small / large;
    }
    let a2 = a * a;
    let poly = a + a * a2 * (-3.333295e-1 + a2 * (1.9977711e-1 + a2 * (-1.3877686e-1 + a2 * 8.0537445e-2)));
    let octant = poly * (0.5 * INV_PI) + select(0.0, 0.125, shifted);
    let quarter = select(octant, 0.25 - octant, ax < ay);
    let halfway = select(quarter, 0.5 - quarter, x < 0.0);
    let turn = select(halfway, 1.0 - halfway, y < 0.0);
    return select(turn, 0.0, turn >= 1.0);
}

fn cube_root(x: f32) -> f32 {
    if x <= 1.17549435e-38 {
        return 0.0;
    }
    var y = bitcast<f32>(bitcast<u32>(x) / 3u + 0x2a5137a0u);
    y -= (y - x / (y * y)) * (1.0 / 3.0);
    y -= (y - x / (y * y)) * (1.0 / 3.0);
    y -= (y - x / (y * y)) * (1.0 / 3.0);
    return y;
}

fn sample_triangle(u: vec2<f32>) -> vec2<f32> {
    let r = sqrt(u.x);
    return vec2<f32>(r * (1.0 - u.y), r * u.y);
}

fn reflected(w: vec3<f32>, n: vec3<f32>) -> vec3<f32> {
    return n * (2.0 * dot3(w, n)) - w;
}

struct Refraction {
    some: bool,
    w: vec3<f32>,
}

fn refracted(w: vec3<f32>, n: vec3<f32>, eta: f32) -> Refraction {
    let cos_signed = dot3(w, n);
    let towards = select(n, -n, cos_signed < 0.0);
    let cos_i = abs(cos_signed);
    let cos2_t = 1.0 - eta * eta * max(1.0 - cos_i * cos_i, 0.0);
    if cos2_t <= 0.0 {
        return Refraction(false, vec3<f32>(0.0));
    }
    return Refraction(true, normalized(towards * (eta * cos_i - sqrt(cos2_t)) - w * eta));
}

// The unit direction from a to b, and the squared distance in w.
fn direction_between(a: vec3<f32>, b: vec3<f32>) -> vec4<f32> {
    let offset = b - a;
    let distance_squared = length_squared(offset);
    return vec4<f32>(offset * (1.0 / sqrt(distance_squared)), distance_squared);
}

fn geometry_term(n: vec3<f32>, n_other: vec3<f32>, w: vec3<f32>, distance_squared: f32) -> f32 {
    return abs(dot3(n, w) * dot3(n_other, w)) / distance_squared;
}

fn offset_ray_origin(p: vec3<f32>, error: f32, n: vec3<f32>, w: vec3<f32>) -> vec3<f32> {
    return p + n * copysign((abs(n.x) + abs(n.y) + abs(n.z)) * error, dot3(n, w));
}
