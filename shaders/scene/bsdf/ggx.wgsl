// GGX microfacets: twin of src/scene/bsdf/ggx.rs.

fn schlick(f0: vec3<f32>, f90: vec3<f32>, cos: f32) -> vec3<f32> {
    let m = clamp(1.0 - cos, 0.0, 1.0);
    let m2 = m * m;
    return f0 + (f90 - f0) * (m2 * m2 * m);
}

fn half_vector(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    return normalized_or(a + b, vec3<f32>(0.0));
}

fn ggx_distribution(alpha: f32, n: vec3<f32>, h: vec3<f32>) -> f32 {
    let cos = dot3(n, h);
    let a2 = alpha * alpha;
    let d = a2 * cos * cos + length_squared(cross3(n, h));
    return a2 / (PI * d * d);
}

fn ggx_smith(alpha: f32, cos: f32) -> f32 {
    return sqrt(cos * cos + alpha * alpha * max(1.0 - cos * cos, 0.0));
}

// D V (`eval`), and the densities of w_out and of w_in given the other (`pdf_sa`), of two directions with these cosines and
// half vector h.
fn ggx_terms(alpha: f32, n: vec3<f32>, cos_in: f32, cos_out: f32, h: vec3<f32>) -> vec3<f32> {
    let d = ggx_distribution(alpha, n, h) * 0.5;
    let smith_in = ggx_smith(alpha, cos_in);
    let smith_out = ggx_smith(alpha, cos_out);
    return vec3<f32>(d / (cos_out * smith_in + cos_in * smith_out), d / (cos_in + smith_in), d / (cos_out + smith_out));
}

fn ggx_sample(alpha: f32, n: vec3<f32>, w_in: vec3<f32>, u: vec2<f32>) -> vec3<f32> {
    let frame = frame_around(n);
    let local = vec3<f32>(dot3(frame.x, w_in), dot3(frame.y, w_in), dot3(frame.z, w_in));
    let stretched = normalized(vec3<f32>(local.x * alpha, local.y * alpha, local.z));
    let sc = sin_cos_turn(u.x);
    let z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
    let r = sqrt(max(1.0 - z * z, 0.0));
    let cap = vec3<f32>(r * sc.y, r * sc.x, z) + stretched;
    let h = normalized_or(vec3<f32>(cap.x * alpha, cap.y * alpha, max(cap.z, 0.0)), vec3<f32>(0.0, 0.0, 1.0));
    return normalized(reflected(w_in, to_world(frame, h)));
}
