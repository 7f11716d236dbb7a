// What follows from a material's numbers: twin of src/scene/material.rs.

const MIN_GLOSSY_SURVIVAL: f32 = 0.25;

fn mean_schlick(f0: vec3<f32>, f90: f32) -> vec3<f32> {
    return f0 * (20.0 / 21.0) + vec3<f32>(f90 * (1.0 / 21.0));
}

fn survival_of(material: Material, color: vec3<f32>, metallic: f32) -> f32 {
    switch material.kind {
        case LAMBERT: {
            return clamp(max_element(color), 0.0, 1.0);
        }
        case CONDUCTOR: {
            return clamp(max_element(mean_schlick(color, 1.0)), MIN_GLOSSY_SURVIVAL, 1.0);
        }
        case COAT: {
            let dielectric = mean_schlick(material.f0, material.f90);
            let coated = color * (1.0 - max_element(dielectric)) + dielectric;
            return clamp(max_element(coated * (1.0 - metallic) + mean_schlick(color, 1.0) * metallic), MIN_GLOSSY_SURVIVAL, 1.0);
        }
        default: {
            return 1.0;
        }
    }
}

// α of GGX for a roughness.
fn ggx_alpha(roughness: f32) -> f32 {
    return max(roughness * roughness, MIN_ALPHA);
}

fn is_dirac(material: Material) -> bool {
    return material.kind == MIRROR || material.kind == DIELECTRIC || material.kind == THIN_DIELECTRIC;
}

fn material_has(material: Material, flag: u32) -> bool {
    return (material.flags & flag) != 0u;
}
