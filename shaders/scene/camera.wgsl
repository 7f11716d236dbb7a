// The camera with its film: twin of `View` in src/scene/camera.rs.

fn has_lens() -> bool {
    return control.params.lens_radius > 0.0;
}

fn sample_lens(u: vec2<f32>) -> vec3<f32> {
    if !has_lens() {
        return control.params.camera_position;
    }
    let l = sample_disk(u) * control.params.lens_radius;
    return control.params.camera_position + control.params.camera_right * l.x + control.params.camera_up * l.y;
}

fn on_lens(point: vec3<f32>) -> vec2<f32> {
    let offset = point - control.params.camera_position;
    return vec2<f32>(dot3(offset, control.params.camera_right), dot3(offset, control.params.camera_up));
}

struct LensPoint {
    some: bool,
    point: vec3<f32>,
}

fn cross_lens(origin: vec3<f32>, direction: vec3<f32>) -> LensPoint {
    let towards = -dot3(direction, control.params.camera_axis);
    let distance = dot3(origin - control.params.camera_position, control.params.camera_axis) / towards;
    if !(towards > 0.0 && distance > 0.0) {
        return LensPoint(false, vec3<f32>(0.0));
    }
    let l = on_lens(origin + direction * distance);
    let inside = l.x * l.x + l.y * l.y <= control.params.lens_radius * control.params.lens_radius;
    return LensPoint(inside, control.params.camera_position + control.params.camera_right * l.x + control.params.camera_up * l.y);
}

fn shift(lens_point: vec3<f32>) -> vec2<f32> {
    if has_lens() {
        return on_lens(lens_point) * control.params.inverse_focus;
    }
    return vec2<f32>(0.0);
}

fn camera_direction(raster: vec2<f32>, lens_point: vec3<f32>) -> vec3<f32> {
    let x = (2.0 * raster.x / f32(control.params.size.x) - 1.0) * control.params.half_extent.x;
    let y = (1.0 - 2.0 * raster.y / f32(control.params.size.y)) * control.params.half_extent.y;
    let m = vec2<f32>(x, y) - shift(lens_point);
    return normalized(control.params.camera_right * m.x + control.params.camera_up * m.y + control.params.camera_axis);
}

struct Raster {
    some: bool,
    at: vec2<f32>,
}

// Where the direction w from a point of the lens meets the film; it may lie outside.
fn project(w: vec3<f32>, lens_point: vec3<f32>) -> Raster {
    let z = dot3(w, control.params.camera_axis);
    if z <= 0.0 {
        return Raster(false, vec2<f32>(0.0));
    }
    let p = vec2<f32>(dot3(w, control.params.camera_right), dot3(w, control.params.camera_up)) * (1.0 / z) + shift(lens_point);
    let at = p * control.params.inverse_half_extent;
    return Raster(true, vec2<f32>((at.x + 1.0) * 0.5 * f32(control.params.size.x), (1.0 - at.y) * 0.5 * f32(control.params.size.y)));
}

fn inside_film(raster: vec2<f32>) -> bool {
    return raster.x >= 0.0 && raster.y >= 0.0 && raster.x < f32(control.params.size.x) && raster.y < f32(control.params.size.y);
}

fn pdf_direction_psa_on_film(w: vec3<f32>) -> f32 {
    let cos = dot3(w, control.params.camera_axis);
    return 1.0 / (control.params.film_area * (cos * cos) * (cos * cos));
}

fn w_e_1_on_film(w: vec3<f32>) -> f32 {
    return pdf_direction_psa_on_film(w) * control.params.pixels;
}
