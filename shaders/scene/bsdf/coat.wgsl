// A diffuse base under a dielectric coat, mixed with a metal: twin of src/scene/bsdf/coat.rs.

const MIN_SHARE: f32 = 0.1;

struct Lobes {
    alpha: f32,
    f0: vec3<f32>,
    f90: vec3<f32>,
    base: vec3<f32>,
    over: vec2<f32>,
}

// Both lobes at a point; of a rough metal, its microfacets alone.
fn lobes_of(material: Material, look: Look) -> Lobes {
    let m = select(look.metallic, 1.0, material.kind == CONDUCTOR);
    return Lobes(
        ggx_alpha(look.roughness),
        look.color * m + material.f0 * (1.0 - m),
        vec3<f32>(m + material.f90 * (1.0 - m)),
        look.color * ((1.0 - m) / max(1.0 - max_element(mean_schlick(material.f0, material.f90)), 1e-3)),
        vec2<f32>(max_element(material.f0), material.f90),
    );
}

fn passes(lobes: Lobes, cos: f32) -> f32 {
    let m = 1.0 - cos;
    let m2 = m * m;
    return 1.0 - lobes.over.x - (lobes.over.y - lobes.over.x) * (m2 * m2 * m);
}

fn share(lobes: Lobes, cos: f32) -> f32 {
    let base = element_sum(lobes.base);
    if base <= 0.0 {
        return 1.0;
    }
    let glossy = element_sum(schlick(lobes.f0, lobes.f90, cos));
    let diffuse = base * max(passes(lobes, cos), 0.0);
    return clamp(glossy / (glossy + diffuse), MIN_SHARE, 1.0 - MIN_SHARE);
}

// What the base adds to f, sr⁻¹.
fn coat_base(lobes: Lobes, cos_a: f32, cos_b: f32) -> vec3<f32> {
    return lobes.base * max(INV_PI * (passes(lobes, cos_a) * passes(lobes, cos_b)), 0.0);
}
