// Rays against the hierarchy: twin of src/scene/bvh.rs and src/scene/bvh/prepared.rs.
// STACK_SIZE stands in the prelude: it follows from the tree's depth.

struct Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
}

struct Segment {
    start: vec3<f32>,
    end: vec3<f32>,
}

// `triangle` is NONE where nothing was hit.
struct Hit {
    triangle: u32,
    distance: f32,
    b1: f32,
    b2: f32,
}

struct PreparedRay {
    origin: vec3<f32>,
    reciprocal: vec3<f32>,
    axes: vec3<u32>,
    start: vec3<f32>,
    shear: vec3<f32>,
}

const TINY: f32 = 1e-20;
// 1 + 2γ₃: what rounding may have taken from the far distance.
const WIDEN: f32 = 1.0000004;

fn pick(v: vec3<f32>, i: u32) -> f32 {
    return select(select(v.x, v.y, i == 1u), v.z, i == 2u);
}

fn finite_reciprocal(d: f32) -> f32 {
    return 1.0 / select(d, copysign(TINY, d), abs(d) < TINY);
}

fn prepared_ray(origin: vec3<f32>, direction: vec3<f32>) -> PreparedRay {
    let a = abs(direction);
    var z = 0u;
    if a.y > a.x {
        z = 1u;
    }
    if a.z > max(a.x, a.y) {
        z = 2u;
    }
    let x = select(z + 1u, 0u, z == 2u);
    let y = select(x + 1u, 0u, x == 2u);
    let axes = select(vec3<u32>(x, y, z), vec3<u32>(y, x, z), pick(direction, z) < 0.0);
    let scale = 1.0 / pick(direction, z);
    return PreparedRay(
        origin,
        vec3<f32>(finite_reciprocal(direction.x), finite_reciprocal(direction.y), finite_reciprocal(direction.z)),
        axes,
        vec3<f32>(pick(origin, axes.x), pick(origin, axes.y), pick(origin, axes.z)),
        vec3<f32>(pick(direction, axes.x) * scale, pick(direction, axes.y) * scale, scale),
    );
}

// The distances at which the ray enters and leaves the box, within 0…t_max; it misses if the first is the larger.
fn span(ray: PreparedRay, node: Node, t_max: f32) -> vec2<f32> {
    let t0 = (node.min - ray.origin) * ray.reciprocal;
    let t1 = (node.max - ray.origin) * ray.reciprocal;
    let low = min(t0, t1);
    let high = max(t0, t1);
    let near = max(low.x, max(low.y, low.z));
    let far = min(high.x, min(high.y, high.z)) * WIDEN;
    return vec2<f32>(select(0.0, near, near > 0.0), select(t_max, far, far < t_max));
}

fn column(triangle: Triangle, axis: u32) -> vec3<f32> {
    return vec3<f32>(pick(triangle.p0, axis), pick(triangle.p1, axis), pick(triangle.p2, axis));
}

// a·b − c·d with the right sign wherever `fma` rounds once (Kahan): a compiler that contracted the plain form would
// give neighbouring triangles different signs on their common edge. Where `fma` rounds twice it is the plain form.
fn difference_of_products(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>, d: vec3<f32>) -> vec3<f32> {
    let cd = c * d;
    return fma(a, b, -cd) + fma(-c, d, cd);
}

// The watertight triangle test, both faces, for 0 < distance < t_max.
fn triangle_hit(ray: PreparedRay, triangle: Triangle, index: u32, t_max: f32) -> Hit {
    let z = column(triangle, ray.axes.z) - ray.start.z;
    let x = column(triangle, ray.axes.x) - ray.start.x - z * ray.shear.x;
    let y = column(triangle, ray.axes.y) - ray.start.y - z * ray.shear.y;
    var e = difference_of_products(x.zxy, y.yzx, y.zxy, x.yzx);
    if any(e == vec3<f32>(0.0)) {
        e = exact_edges(e, x, y);
    }
    let miss = Hit(NONE, t_max, 0.0, 0.0);
    if any(e < vec3<f32>(0.0)) && any(e > vec3<f32>(0.0)) {
        return miss;
    }
    let det = e.x + e.y + e.z;
    if det == 0.0 {
        return miss;
    }
    let inv = 1.0 / det;
    let distance = ray.shear.z * dot3(e, z) * inv;
    if distance > 0.0 && distance < t_max {
        return Hit(index, distance, e.y * inv, e.z * inv);
    }
    return miss;
}

// The edge functions again where one came out as 0: their signs are exact. (Rust uses f64.)
fn exact_edges(e: vec3<f32>, x: vec3<f32>, y: vec3<f32>) -> vec3<f32> {
    const LEAST: f32 = 1.17549435e-38;
    var exact = e;
    for (var i = 0u; i < 3u; i++) {
        if e[i] == 0.0 {
            let j = (i + 1u) % 3u;
            let k = (i + 2u) % 3u;
            exact[i] = LEAST * f32(compare_products(x[k], y[j], y[k], x[j]));
        }
    }
    return exact;
}

// The sign of a·b − c·d, in integers.
fn compare_products(a: f32, b: f32, c: f32, d: f32) -> i32 {
    let ab = exact_product(a, b);
    let cd = exact_product(c, d);
    if ab.sign != cd.sign {
        return select(-1, 1, ab.sign > cd.sign);
    }
    if ab.sign == 0 {
        return 0;
    }
    var larger = 0;
    if ab.exponent != cd.exponent {
        larger = select(-1, 1, ab.exponent > cd.exponent);
    } else if ab.high != cd.high {
        larger = select(-1, 1, ab.high > cd.high);
    } else if ab.low != cd.low {
        larger = select(-1, 1, ab.low > cd.low);
    }
    return larger * ab.sign;
}

// sign · (high·2²⁴ + low) · 2^exponent, with the highest of 48 bits set; sign 0 for zero.
struct ExactProduct {
    sign: i32,
    exponent: i32,
    high: u32,
    low: u32,
}

fn exact_product(a: f32, b: f32) -> ExactProduct {
    let x = mantissa_and_exponent(a);
    let y = mantissa_and_exponent(b);
    if x.x == 0u || y.x == 0u {
        return ExactProduct(0, 0, 0u, 0u);
    }
    // 24 × 24 bits out of halves of 12.
    let x1 = x.x >> 12u;
    let x0 = x.x & 0xfffu;
    let y1 = y.x >> 12u;
    let y0 = y.x & 0xfffu;
    let middle = x1 * y0 + x0 * y1;
    let lowest = x0 * y0 + ((middle & 0xfffu) << 12u);
    var low = lowest & 0xffffffu;
    var high = x1 * y1 + (middle >> 12u) + (lowest >> 24u);
    var exponent = bitcast<i32>(x.y) + bitcast<i32>(y.y);
    if (high & 0x800000u) == 0u {
        high = (high << 1u) | (low >> 23u);
        low = (low << 1u) & 0xffffffu;
        exponent -= 1;
    }
    let negative = ((bitcast<u32>(a) ^ bitcast<u32>(b)) >> 31u) == 1u;
    return ExactProduct(select(1, -1, negative), exponent, high, low);
}

// The mantissa with its highest of 24 bits set, and the exponent; 0 for zero.
fn mantissa_and_exponent(x: f32) -> vec2<u32> {
    let bits = bitcast<u32>(x);
    let exponent = i32((bits >> 23u) & 255u);
    let fraction = bits & 0x7fffffu;
    if exponent != 0 {
        return vec2<u32>(fraction | 0x800000u, bitcast<u32>(exponent));
    }
    if fraction == 0u {
        return vec2<u32>(0u);
    }
    let shift = countLeadingZeros(fraction) - 8u;
    return vec2<u32>(fraction << shift, bitcast<u32>(1 - i32(shift)));
}

// The nodes that wait, and where a ray enters them: for one traversal at a time, so that nothing is cleared for each.
var<private> waiting: array<u32, STACK_SIZE>;
var<private> entries: array<f32, STACK_SIZE>;

// What a closest-hit traversal found.
struct Closest {
    hit: Hit,
    // Was anything rejected that might have been there?
    passed: bool,
}

// The nearest hit with distance > 0 that the draws accept (`draws` counts only with HAS_ALPHA).
fn closest_hit(ray: Ray, draws: vec4<u32>) -> Closest {
    let prepared = prepared_ray(ray.origin, ray.direction);
    var best = Closest(Hit(NONE, MAX_FLOAT, 0.0, 0.0), false);
    if control.params.triangles_count == 0u {
        return best;
    }
    var top = 0u;
    var node = nodes[0];
    loop {
        var descend = false;
        if node.count > 0u {
            for (var index = node.first; index < node.first + node.count; index++) {
                let hit = triangle_hit(prepared, triangles[index], index, best.hit.distance);
                if hit.triangle != NONE {
                    if HAS_ALPHA {
                        let a = opacity(hit);
                        let accepted = a >= 1.0 || draw(draws, hit.triangle) < a;
                        best.passed = best.passed || (!accepted && a > 0.0);
                        if accepted {
                            best.hit = hit;
                        }
                    } else {
                        best.hit = hit;
                    }
                }
            }
        } else {
            let a = nodes[node.first];
            let b = nodes[node.first + 1u];
            let span_a = span(prepared, a, best.hit.distance);
            let span_b = span(prepared, b, best.hit.distance);
            let hits_a = span_a.x <= span_a.y;
            let hits_b = span_b.x <= span_b.y;
            descend = hits_a || hits_b;
            let a_first = hits_a && (!hits_b || span_a.x <= span_b.x);
            if hits_a && hits_b {
                if top < STACK_SIZE {
                    waiting[top] = select(node.first, node.first + 1u, a_first);
                    entries[top] = select(span_a.x, span_b.x, a_first);
                    top++;
                } else {
                    stack_overflows++;
                }
            }
            if a_first {
                node = a;
            } else if hits_b {
                node = b;
            }
        }
        if !descend {
            var found = false;
            while top > 0u && !found {
                top--;
                found = entries[top] <= best.hit.distance;
            }
            if !found {
                break;
            }
            node = nodes[waiting[top]];
        }
    }
    return best;
}

// V of what lies along a ray for 0 < distance < t_max: Π (1 − a), 0 as soon as anything lets nothing through.
fn transmittance(prepared: PreparedRay, t_max: f32) -> f32 {
    if control.params.triangles_count == 0u {
        return 1.0;
    }
    var v = 1.0;
    var top = 0u;
    var node = nodes[0];
    loop {
        var descend = false;
        if node.count > 0u {
            for (var index = node.first; index < node.first + node.count; index++) {
                let hit = triangle_hit(prepared, triangles[index], index, t_max);
                if hit.triangle != NONE {
                    if HAS_ALPHA {
                        v = v * (1.0 - opacity(hit));
                    } else {
                        v = 0.0;
                    }
                    if v <= 0.0 {
                        return 0.0;
                    }
                }
            }
        } else {
            let a = nodes[node.first];
            let b = nodes[node.first + 1u];
            let span_a = span(prepared, a, t_max);
            let span_b = span(prepared, b, t_max);
            let hits_a = span_a.x <= span_a.y;
            let hits_b = span_b.x <= span_b.y;
            descend = hits_a || hits_b;
            if hits_a && hits_b {
                if top < STACK_SIZE {
                    waiting[top] = node.first + 1u;
                    top++;
                } else {
                    stack_overflows++;
                }
            }
            if hits_a {
                node = a;
            } else if hits_b {
                node = b;
            }
        }
        if !descend {
            if top == 0u {
                break;
            }
            top--;
            node = nodes[waiting[top]];
        }
    }
    return v;
}
