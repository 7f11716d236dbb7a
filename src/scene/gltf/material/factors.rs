//! The numbers of a glTF material, judged and brought into their ranges; what had to be changed is remarked.

use super::super::super::Recipe;
use super::super::super::environment::MAX_RADIANCE;
use super::super::super::recipe::Glass;
use crate::math::Vec3;
use ::gltf::json::material::Material as Json;

/// The largest index of refraction, beyond which nothing changes any more.
const MAX_IOR: f32 = 1e3;

/// What a glTF material says in numbers.
#[derive(Clone, Copy, Debug)]
pub struct Factors {
    /// Base colour, in [0, 1].
    pub color: Vec3,
    /// Its alpha, in [0, 1].
    pub opacity: f32,
    /// Metallic share, in [0, 1].
    pub metallic: f32,
    /// Roughness, in [0, 1].
    pub roughness: f32,
    /// Transmission, in [0, 1].
    pub transmission: f32,
    /// Does a texture vary the transmission?
    pub transmission_varies: bool,
    /// Index of refraction, 1 or more; `None` stands for glTF's 0: everything is reflected.
    pub ior: Option<f32>,
    /// The specular colour: what multiplies the reflectance at normal incidence.
    pub f0_scale: Vec3,
    /// The specular factor: reflectance at grazing incidence, in [0, 1].
    pub f90: f32,
    /// L_e, W m⁻² sr⁻¹.
    pub emission: Vec3,
}

impl Factors {
    /// Reads them; `remark` is told what is worth telling.
    pub fn read(json: &Json, remark: &mut impl FnMut(String)) -> Result<Self, String> {
        let pbr = &json.pbr_metallic_roughness;
        let extensions = json.extensions.as_ref();
        let specular = extensions.and_then(|e| e.specular.as_ref());
        let [r, g, b, a] = pbr.base_color_factor.0;
        let mut clamped = |value: Vec3, most: f32, what: &str| {
            if !value.is_finite() {
                return Err(format!("its {what} is not finite; repair the material and export it again"));
            }
            let inside = value.clamp(Vec3::ZERO, Vec3::splat(most));
            if inside != value {
                remark(if most == 1.0 { format!("The {what} was clamped to 0…1") } else { format!("A negative {what} was set to 0") });
            }
            Ok(inside)
        };
        let color = clamped(Vec3::new(r, g, b), 1.0, "base colour")?;
        let mut unit = |value: f32, what: &str| clamped(Vec3::splat(value), 1.0, what).map(|v| v.x);
        let opacity = unit(a, "base colour's alpha")?;
        let metallic = unit(pbr.metallic_factor.0, "metallic factor")?;
        let roughness = unit(pbr.roughness_factor.0, "roughness factor")?;
        let transmission = unit(transmission(json), "transmission factor")?;
        let f90 = unit(specular.map_or(1.0, |s| s.specular_factor.0), "specular factor")?;
        let f0_scale = clamped(specular.map_or(Vec3::ONE, |s| s.specular_color_factor.0.into()), f32::MAX, "specular colour factor")?;
        let ior = extensions.and_then(|e| e.ior.as_ref()).map_or(1.5, |e| e.ior.0);
        if !ior.is_finite() {
            return Err("its index of refraction is not finite; repair the material and export it again".into());
        }
        if ior != 0.0 && !(1.0..=MAX_IOR).contains(&ior) {
            remark(format!("The index of refraction was clamped to 1…{MAX_IOR}"));
        }
        Ok(Self {
            color,
            opacity,
            metallic,
            roughness,
            transmission,
            transmission_varies: extensions.and_then(|e| e.transmission.as_ref()).is_some_and(|t| t.transmission_texture.is_some()),
            ior: (ior != 0.0).then(|| ior.clamp(1.0, MAX_IOR)),
            f0_scale,
            f90,
            emission: emission(json, remark)?,
        })
    }
}

impl Factors {
    /// What a material of these numbers is made from.
    pub fn recipe(&self, glass: Option<Glass>) -> Recipe {
        let Self { color, metallic, roughness, ior, f0_scale, f90, emission, .. } = *self;
        Recipe { color, emission, roughness, metallic, ior, f0_scale, f90, glass }
    }
}

/// L_e, W m⁻² sr⁻¹.
fn emission(json: &Json, remark: &mut impl FnMut(String)) -> Result<Vec3, String> {
    let strength = json.extensions.as_ref().and_then(|e| e.emissive_strength.as_ref()).map_or(1.0, |e| e.emissive_strength.0);
    let emission = Vec3::from_array(json.emissive_factor.0) * strength;
    if !(emission.is_finite() && emission.max_element() <= MAX_RADIANCE) {
        return Err(format!("its emission is not finite or above {MAX_RADIANCE:.0e}; repair the material and export it again"));
    }
    if emission.min_element() < 0.0 {
        remark("Negative emission was set to 0".into());
    }
    Ok(emission.max(Vec3::ZERO))
}

/// `KHR_materials_transmission`'s factor, 0 without it.
pub fn transmission(json: &Json) -> f32 {
    json.extensions.as_ref().and_then(|e| e.transmission.as_ref()).map_or(0.0, |t| t.transmission_factor.0)
}

/// `KHR_materials_volume`'s thickness, 0 without it.
pub fn thickness(json: &Json) -> f32 {
    json.extensions.as_ref().and_then(|e| e.volume.as_ref()).map_or(0.0, |v| v.thickness_factor.0)
}

/// Does the inside absorb?
pub fn absorbs(json: &Json) -> bool {
    let volume = json.extensions.as_ref().and_then(|e| e.volume.as_ref());
    volume.is_some_and(|v| v.attenuation_distance.0.is_finite() && v.attenuation_color.0 != [1.0; 3])
}
