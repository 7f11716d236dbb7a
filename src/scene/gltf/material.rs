//! From glTF materials to the models we render. What has no model becomes grey Lambert, and the notes say so.
//!
//! | glTF | model |
//! |---|---|
//! | metallic 0, `KHR_materials_specular` factor 0 | Lambert, albedo = base colour |
//! | metallic 1, roughness < 0.03 | mirror, F₀ = base colour |
//! | metallic 0, transmission 1, roughness < 0.03 | smooth dielectric, solid if the mesh is closed or has a thickness, else thin |
//! | anything else | Lambert, albedo 0.5 |
//!
//! Emission = emissive factor × `KHR_materials_emissive_strength`, W m⁻² sr⁻¹, from the front face only unless `doubleSided`.

use super::super::environment::MAX_RADIANCE;
use super::super::{Material, SceneError};
use super::container::{Document, label};
use crate::math::Vec3;
use ::gltf::json::material::{AlphaMode, Material as Json};
use ::gltf::json::validation::Checked;
use std::collections::{BTreeMap, HashMap};

/// Below this roughness a surface is a Dirac.
const SMOOTH: f32 = 0.03;
/// Albedo of what has no model.
const GREY: Vec3 = Vec3::splat(0.5);

/// What a glTF material means, before the mesh decides between solid and thin.
enum Model {
    Lambert(Vec3),
    Mirror(Vec3),
    Dielectric {
        tint: Vec3,
        ior: f32,
    },
    /// No model: why.
    Unknown(String),
}

/// The materials in use, made when they are first asked for.
pub struct Materials<'a> {
    document: &'a Document<'a>,
    /// The materials with their names.
    pub list: Vec<(String, Material)>,
    index_of: HashMap<(Option<usize>, bool), u32>,
    /// Names of materials by what is to be said of them.
    remarks: BTreeMap<String, Vec<String>>,
}

impl<'a> Materials<'a> {
    /// None yet.
    pub fn new(document: &'a Document<'a>) -> Self {
        Self { document, list: Vec::new(), index_of: HashMap::new(), remarks: BTreeMap::new() }
    }

    /// The index of a glTF material on a mesh; `closed` tells whether that mesh encloses a volume (asked of glass only).
    pub fn index(&mut self, material: Option<usize>, closed: impl FnOnce() -> bool) -> Result<u32, SceneError> {
        let materials = &self.document.root.materials;
        let default = Json::default();
        let (json, name) = match material {
            None => (&default, "glTF's default material".to_owned()),
            Some(i) => match materials.get(i) {
                Some(json) => (json, json.name.clone().unwrap_or_else(|| format!("material {i}"))),
                None => return Err(self.document.error(format!("material {i}"), "it is used but does not exist; export the file again")),
            },
        };
        let solid = transmission(json) > 0.0 && (thickness(json) > 0.0 || closed());
        if let Some(&index) = self.index_of.get(&(material, solid)) {
            return Ok(index);
        }
        let made = self.make(json, &name, solid).map_err(|reason| {
            let element = material.map_or_else(|| name.clone(), |i| label("material", i, json.name.as_deref()));
            self.document.error(element, reason)
        })?;
        let index = self.list.len() as u32;
        self.list.push((name, made));
        self.index_of.insert((material, solid), index);
        Ok(index)
    }

    /// One sentence for everything that is to be said of some materials.
    pub fn notes(self) -> Vec<String> {
        let sentence = |(remark, mut names): (String, Vec<String>)| {
            names.dedup();
            let more = names.len().saturating_sub(6);
            let listed = names.iter().take(6).map(|n| format!("'{n}'")).collect::<Vec<_>>().join(", ");
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            format!("{remark}: {listed}{more}.")
        };
        self.remarks.into_iter().map(sentence).collect()
    }

    fn remark(&mut self, remark: impl Into<String>, name: &str) {
        self.remarks.entry(remark.into()).or_default().push(name.to_owned());
    }

    fn make(&mut self, json: &Json, name: &str, solid: bool) -> Result<Material, String> {
        let base = json.pbr_metallic_roughness.base_color_factor.0;
        let color = self.factors(Vec3::new(base[0], base[1], base[2]), "base colour", name)?;
        let scattering = match model(json, color)? {
            Model::Lambert(albedo) => Material::lambert(albedo),
            Model::Mirror(f0) => Material::mirror(f0),
            Model::Dielectric { tint, ior } => {
                if absorbs(json) {
                    self.remark("The absorption inside glass was ignored", name);
                }
                Material::dielectric(tint, ior, !solid)
            }
            Model::Unknown(why) => {
                self.remark(format!("Shown as grey Lambert (albedo 0.5) because of {why}"), name);
                Material::lambert(GREY)
            }
        };
        Ok(Material { emission: self.emission(json, name)?, two_sided: u32::from(json.double_sided), ..scattering })
    }

    /// Factors that must lie in [0, 1], clamped.
    fn factors(&mut self, factors: Vec3, what: &str, name: &str) -> Result<Vec3, String> {
        if !factors.is_finite() {
            return Err(format!("its {what} is not finite; repair the material and export it again"));
        }
        let clamped = factors.clamp(Vec3::ZERO, Vec3::ONE);
        if clamped != factors {
            self.remark(format!("The {what} was clamped to 0…1"), name);
        }
        Ok(clamped)
    }

    /// L_e, W m⁻² sr⁻¹.
    fn emission(&mut self, json: &Json, name: &str) -> Result<Vec3, String> {
        let strength = json.extensions.as_ref().and_then(|e| e.emissive_strength.as_ref()).map_or(1.0, |e| e.emissive_strength.0);
        let emission = Vec3::from_array(json.emissive_factor.0) * strength;
        if !(emission.is_finite() && emission.max_element() <= MAX_RADIANCE) {
            return Err(format!("its emission is not finite or above {MAX_RADIANCE:.0e}; repair the material and export it again"));
        }
        if emission.min_element() < 0.0 {
            self.remark("Negative emission was set to 0", name);
        }
        let emission = emission.max(Vec3::ZERO);
        if json.emissive_texture.is_some() && emission != Vec3::ZERO {
            self.remark("The emissive texture was ignored, the emissive factor holds all over", name);
        }
        Ok(emission)
    }
}

/// Which model a material is.
fn model(json: &Json, color: Vec3) -> Result<Model, String> {
    let pbr = &json.pbr_metallic_roughness;
    let (metallic, roughness, transmission) = (pbr.metallic_factor.0, pbr.roughness_factor.0, transmission(json));
    let extensions = json.extensions.as_ref();
    let ior = extensions.and_then(|e| e.ior.as_ref()).map_or(1.5, |e| e.ior.0);
    let specular = extensions.and_then(|e| e.specular.as_ref());
    let specular_factor = specular.map_or(1.0, |s| s.specular_factor.0);
    if [metallic, roughness, transmission, ior, specular_factor].iter().any(|f| !f.is_finite()) {
        return Err("one of its factors is not finite; repair the material and export it again".into());
    }
    let unknown = |why: &str| Ok(Model::Unknown(why.to_owned()));
    if let Some(why) = beyond_factors(json) {
        return Ok(Model::Unknown(why));
    }
    if metallic >= 1.0 {
        return if roughness < SMOOTH { Ok(Model::Mirror(color)) } else { unknown("rough metal") };
    }
    if metallic > 0.0 {
        return unknown("a metalness between 0 and 1");
    }
    if transmission > 0.0 {
        let plain = specular.is_none_or(|s| s.specular_factor.0 == 1.0 && s.specular_color_factor.0 == [1.0; 3]);
        return match () {
            () if transmission < 1.0 => unknown("partial transmission"),
            () if roughness >= SMOOTH => unknown("rough transmission"),
            () if ior < 1.0 => unknown("an index of refraction below 1"),
            () if !plain => unknown("transmission with altered specular reflection"),
            () => Ok(Model::Dielectric { tint: color, ior }),
        };
    }
    if specular_factor <= 0.0 { Ok(Model::Lambert(color)) } else { unknown("a specular coat") }
}

/// What of a material is not a factor of the models: textures, alpha, unlit, unknown extensions.
fn beyond_factors(json: &Json) -> Option<String> {
    let pbr = &json.pbr_metallic_roughness;
    let extensions = json.extensions.as_ref();
    let specular = extensions.and_then(|e| e.specular.as_ref());
    let textured = pbr.base_color_texture.is_some()
        || pbr.metallic_roughness_texture.is_some()
        || json.normal_texture.is_some()
        || specular.is_some_and(|s| s.specular_texture.is_some() || s.specular_color_texture.is_some())
        || extensions.and_then(|e| e.transmission.as_ref()).is_some_and(|t| t.transmission_texture.is_some());
    if textured {
        return Some("textures".into());
    }
    if !matches!(json.alpha_mode, Checked::Valid(AlphaMode::Opaque)) {
        return Some("transparency by alpha".into());
    }
    if extensions.is_some_and(|e| e.unlit.is_some()) {
        return Some("KHR_materials_unlit".into());
    }
    extensions.and_then(|e| e.others.keys().next().cloned())
}

/// `KHR_materials_transmission`'s factor, 0 without it.
fn transmission(json: &Json) -> f32 {
    json.extensions.as_ref().and_then(|e| e.transmission.as_ref()).map_or(0.0, |t| t.transmission_factor.0)
}

/// `KHR_materials_volume`'s thickness, 0 without it.
fn thickness(json: &Json) -> f32 {
    json.extensions.as_ref().and_then(|e| e.volume.as_ref()).map_or(0.0, |v| v.thickness_factor.0)
}

/// Does the inside absorb?
fn absorbs(json: &Json) -> bool {
    let volume = json.extensions.as_ref().and_then(|e| e.volume.as_ref());
    volume.is_some_and(|v| v.attenuation_distance.0.is_finite() && v.attenuation_color.0 != [1.0; 3])
}
