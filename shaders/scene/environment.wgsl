// Light from infinity: twin of src/scene/environment.rs.

fn environment_place(w: vec3<f32>) -> vec2<f32> {
    let u = turn_of(w.x, -w.z) + control.params.environment_rotation + 0.5;
    let v = turn_of(sqrt(w.x * w.x + w.z * w.z), w.y) * 2.0;
    return vec2<f32>(fract(u) * f32(control.params.environment_width), v * f32(control.params.environment_height));
}

fn environment_at(x: u32, y: u32) -> vec3<f32> {
    return load_texel(y * control.params.environment_width + x).radiance;
}

// L from the unit direction w (towards the environment).
fn environment_radiance(w: vec3<f32>) -> vec3<f32> {
    let width = i32(control.params.environment_width);
    let height = i32(control.params.environment_height);
    if width * height == 1 {
        return environment_at(0u, 0u);
    }
    let place = environment_place(w) - 0.5;
    let low = floor(place);
    let part = place - low;
    let column = vec2<i32>(i32(low.x), i32(low.x) + 1);
    let x = vec2<u32>(((column % width) + width) % width);
    let y = vec2<u32>(clamp(vec2<i32>(i32(low.y), i32(low.y) + 1), vec2<i32>(0), vec2<i32>(height - 1)));
    let upper = environment_at(x.x, y.x) * (1.0 - part.x) + environment_at(x.y, y.x) * part.x;
    let lower = environment_at(x.x, y.y) * (1.0 - part.x) + environment_at(x.y, y.y) * part.x;
    return upper * (1.0 - part.y) + lower * part.y;
}

// p_ω of the unit direction w (towards the environment), sr⁻¹.
fn environment_pdf_sa(w: vec3<f32>) -> f32 {
    var index = 0u;
    if control.params.environment_width * control.params.environment_height > 1u {
        let place = environment_place(w);
        let x = min(u32(max(place.x, 0.0)), control.params.environment_width - 1u);
        let y = min(u32(max(place.y, 0.0)), control.params.environment_height - 1u);
        index = y * control.params.environment_width + x;
    }
    return load_texel(index).pdf_sa;
}

// A direction towards the environment with that density.
fn environment_sample(u_texel: vec2<f32>, u_place: vec2<f32>) -> vec3<f32> {
    let index = choose(control.params.environment_choice, control.params.environment_cells, u_texel);
    let x = index % control.params.environment_width;
    let y = index / control.params.environment_width;
    let turn = (f32(x) + u_place.x) / f32(control.params.environment_width) - 0.5 - control.params.environment_rotation;
    let sc = sin_cos_turn(turn - floor(turn));
    let row = environment_row(y, control.params.environment_height);
    let versine = row.x + (row.y - row.x) * u_place.y;
    let sin_theta = sqrt(max(versine * (2.0 - versine), 0.0));
    return vec3<f32>(sc.x * sin_theta, (1.0 - versine) * row.z, -sc.y * sin_theta);
}

// 1 − cosθ at both edges of a row, from the nearer pole, and that pole's sign.
fn environment_row(y: u32, height: u32) -> vec3<f32> {
    let upper = 2u * y + 1u < height;
    let from_pole = select(height - 1u - y, y, upper);
    return vec3<f32>(pole_versine(from_pole, height), pole_versine(from_pole + 1u, height), select(-1.0, 1.0, upper));
}

fn pole_versine(k: u32, height: u32) -> f32 {
    let s = sin_cos_turn(f32(k) / f32(4u * height)).x;
    return 2.0 * s * s;
}
