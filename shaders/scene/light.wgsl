// Light sources: twin of src/scene/light.rs.

fn is_infinite(light: Light) -> bool {
    return light.kind >= DIRECTIONAL;
}

fn light_pdf_area(light: Light) -> f32 {
    return light.pmf / light.area;
}

fn spot_solid_angle(light: Light) -> f32 {
    return 2.0 * PI * (light.versine_inner + (light.versine_outer - light.versine_inner) * (1.0 / 3.0));
}

fn l_e_0(light: Light) -> vec3<f32> {
    var factor = 1.0;
    if light.kind == AREA {
        factor = PI * light.sides;
    } else if light.kind == POINT {
        factor = 4.0 * PI;
    } else if light.kind == SPOT {
        factor = spot_solid_angle(light);
    }
    return light.radiance * factor;
}

fn falloff(light: Light, w: vec3<f32>) -> f32 {
    let v = versine(light.axis, w);
    if v <= light.versine_inner {
        return 1.0;
    }
    if v >= light.versine_outer {
        return 0.0;
    }
    let ramp = (light.versine_outer - v) / (light.versine_outer - light.versine_inner);
    return ramp * ramp;
}

fn l_e_1(light: Light, n_g: vec3<f32>, w: vec3<f32>) -> f32 {
    switch light.kind {
        case AREA: {
            if light.sides == 2.0 {
                return 0.5 * INV_PI;
            }
            return select(0.0, INV_PI, dot3(n_g, w) > 0.0);
        }
        case POINT: {
            return 0.25 * INV_PI;
        }
        case SPOT: {
            return falloff(light, w) / spot_solid_angle(light);
        }
        default: {
            return 1.0;
        }
    }
}

fn light_pdf_direction_psa(light: Light, n_g: vec3<f32>, w: vec3<f32>, pdf_disk_area: f32) -> f32 {
    if is_infinite(light) {
        return pdf_disk_area;
    }
    return l_e_1(light, n_g, w);
}

fn light_sample_direction(light: Light, n_g: vec3<f32>, u: vec2<f32>, u_side: f32) -> vec3<f32> {
    switch light.kind {
        case AREA: {
            let n = select(n_g, -n_g, light.sides == 2.0 && u_side >= 0.5);
            return to_world(frame_around(n), sample_cosine_hemisphere(u));
        }
        case POINT: {
            return sample_sphere(u);
        }
        default: {
            return to_world(frame_around(light.axis), sample_cone(light, u));
        }
    }
}

fn sample_cone(light: Light, u: vec2<f32>) -> vec3<f32> {
    let inner = light.versine_inner;
    let fall = light.versine_outer - light.versine_inner;
    let place = u.y * (inner + fall * (1.0 / 3.0));
    var v = place;
    if !(place < inner) {
        v = light.versine_outer - fall * cube_root(min((place - inner) * 3.0 / fall, 1.0));
    }
    return direction_at(u.x, v);
}

// Density of x₀, an area light's point (m⁻²) or the environment's direction (sr⁻¹, w travels from it).
fn pdf_origin(light: Light, w: vec3<f32>) -> f32 {
    if light.kind == ENVIRONMENT {
        return light.pmf * environment_pdf_sa(-w);
    }
    return light_pdf_area(light);
}

// L_e(x₀→w) of a light that an eye path can hit.
fn l_e(light: Light, n_g: vec3<f32>, w: vec3<f32>) -> vec3<f32> {
    if light.kind == ENVIRONMENT {
        return environment_radiance(-w);
    }
    return select(vec3<f32>(0.0), light.radiance, l_e_1(light, n_g, w) > 0.0);
}
