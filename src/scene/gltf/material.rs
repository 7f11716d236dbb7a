//! From glTF materials to the models we render; what of a material is not modelled is named in the notes.
//!
//! `KHR_materials_unlit` emits its base colour and does not scatter; transmission 1 with metallic 0 and roughness < 0.03 is clear
//! glass, solid if the mesh is closed or has a thickness, else a sheet; every other model is the recipe's affair (`scene::recipe`).
//!
//! Emission = emissive factor × `KHR_materials_emissive_strength`, W m⁻² sr⁻¹, from the front face only unless `doubleSided`.
//! Alpha counts for MASK and BLEND, and only where it can be below 1 (MASK: below the cutoff).

mod factors;

use super::super::material::{TRANSPARENT, UNLIT, VARIES};
use super::super::recipe::{Glass, Recipe, SMOOTH};
use super::super::texture::{Image, TextureUse};
use super::super::{DIELECTRIC, Material, NONE, Progress, SceneError, THIN_DIELECTRIC};
use super::container::{Document, label, listed};
use super::images;
use super::textures::{Reference, TextureTable};
use crate::math::Vec3;
use ::gltf::json::material::{AlphaMode, Material as Json};
use ::gltf::json::texture::Info;
use ::gltf::json::validation::Checked;
use factors::Factors;
use std::collections::{BTreeMap, HashMap};

/// Most by which a normal map is scaled: its squares must stay in the range of f32.
const STEEPEST: f32 = 1e15;

/// A material in the making.
struct Draft {
    name: String,
    material: Material,
    recipe: Recipe,
    /// Whether alpha counts, and the cutoff if it masks.
    alpha: Option<Option<f32>>,
    /// The least alpha among the colours of its vertices.
    vertex_alpha: f32,
}

/// What a material wants of the vertices.
#[derive(Clone, Copy, Debug, Default)]
pub struct Needs {
    /// Sets of texture coordinates.
    pub sets: [bool; 2],
    /// Tangents.
    pub tangents: bool,
    /// Alpha of colours.
    pub alpha: bool,
}

/// All materials with what belongs to them.
pub struct Finished {
    pub list: Vec<(String, Material)>,
    pub recipes: Vec<Recipe>,
    pub textures: Vec<TextureUse>,
    pub images: Vec<Image>,
}

/// The materials in use, made when they are first asked for.
pub struct Materials<'a> {
    document: &'a Document<'a>,
    drafts: Vec<Draft>,
    textures: TextureTable<'a>,
    index_of: HashMap<(Option<usize>, bool), u32>,
    remarks: Remarks,
}

/// Names of materials by what is to be said of them.
#[derive(Default)]
struct Remarks(BTreeMap<String, Vec<String>>);

impl Remarks {
    fn add(&mut self, remark: impl Into<String>, name: &str) {
        self.0.entry(remark.into()).or_default().push(name.to_owned());
    }

    /// One sentence for everything that is to be said of some materials.
    fn sentences(self) -> impl Iterator<Item = String> {
        self.0.into_iter().map(|(remark, mut names)| {
            names.sort();
            names.dedup();
            format!("{remark}: {}.", listed(&names))
        })
    }
}

impl<'a> Materials<'a> {
    /// None yet.
    pub fn new(document: &'a Document<'a>) -> Self {
        let textures = TextureTable::new(document);
        Self { document, drafts: Vec::new(), textures, index_of: HashMap::new(), remarks: Remarks::default() }
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
        let transmits = factors::transmission(json) > 0.0;
        let closed = transmits && closed();
        let solid = closed || (transmits && factors::thickness(json) > 0.0);
        let index = match self.index_of.get(&(material, solid)) {
            Some(&index) => index,
            None => {
                let draft = self.make(json, name.clone(), solid).map_err(|reason| {
                    let element = material.map_or_else(|| name.clone(), |i| label("material", i, json.name.as_deref()));
                    self.document.error(element, reason)
                })?;
                self.drafts.push(draft);
                self.index_of.insert((material, solid), self.drafts.len() as u32 - 1);
                self.drafts.len() as u32 - 1
            }
        };
        if self.drafts[index as usize].material.kind == DIELECTRIC && !closed {
            self.remarks.add(
                "The mesh of this glass is not closed, so what its thickness lets in may never leave; do not trust its radiance",
                &name,
            );
        }
        Ok(index)
    }

    /// What a material wants of the vertices.
    pub fn needs(&self, index: u32) -> Needs {
        let Draft { material, alpha, .. } = &self.drafts[index as usize];
        let set = |texture: u32| self.textures.uses.get(texture as usize).map(|x| x.set as usize);
        let mut needs = Needs { tangents: material.normal_texture != NONE, alpha: alpha.is_some(), ..Needs::default() };
        let all = [material.base_color_texture, material.metallic_roughness_texture, material.emissive_texture, material.normal_texture];
        all.into_iter().filter_map(set).for_each(|set| needs.sets[set] = true);
        needs
    }

    /// Takes note that a mesh has colours at its vertices, `least` their least alpha.
    pub fn has_colors(&mut self, index: u32, least: f32) {
        let draft = &mut self.drafts[index as usize];
        draft.material.flags |= VARIES;
        draft.vertex_alpha = draft.vertex_alpha.min(least);
    }

    /// Says of a material what its meshes lack.
    pub fn remark(&mut self, index: u32, remark: &str) {
        self.remarks.add(remark, &self.drafts[index as usize].name);
    }

    /// Decodes the images and settles what depends on them; what is to be told goes to `notes`.
    pub fn finish(self, notes: &mut Vec<String>, progress: &Progress) -> Result<Finished, SceneError> {
        notes.extend(self.remarks.sentences());
        let decoded =
            images::decode(self.textures.pictures, notes, progress).map_err(|reason| SceneError::file(self.document.file, reason))?;
        let uses = self.textures.uses;
        let least = |texture: u32| uses.get(texture as usize).map_or(255, |x| decoded[x.image as usize].least_alpha);
        let finished = |draft: Draft| {
            let Draft { name, mut material, mut recipe, alpha, vertex_alpha } = draft;
            let lowest = material.opacity * (f32::from(least(material.base_color_texture)) / 255.0) * vertex_alpha;
            // Interpolation rounds: what just reaches the cutoff counts as transparent.
            let transparent = alpha.is_some_and(|cutoff| lowest < cutoff.map_or(1.0, |cutoff| cutoff.min(1e9) * (1.0 + 1e-6)));
            if transparent {
                if material.kind == DIELECTRIC {
                    // What enters through the surface and leaves through a hole would keep the radiance of the inside.
                    (material.kind, recipe.glass) = (THIN_DIELECTRIC, Some(Glass::Thin));
                    notes.push(format!("Glass with holes has no inside; it was taken for a sheet: '{name}'."));
                }
                material.flags |= TRANSPARENT;
                material.cutoff = alpha.flatten().unwrap_or(-1.0);
            } else {
                material.opacity = 1.0;
                // Its colour is its emission.
                material.base_color_texture = if material.has(UNLIT) { NONE } else { material.base_color_texture };
            }
            ((name, material.finished()), recipe)
        };
        let (list, recipes) = self.drafts.into_iter().map(finished).unzip();
        Ok(Finished { list, recipes, textures: uses, images: decoded.into_iter().map(|decoded| decoded.image).collect() })
    }

    fn make(&mut self, json: &Json, name: String, solid: bool) -> Result<Draft, String> {
        let f = Factors::read(json, &mut |remark| self.remarks.add(remark, &name))?;
        self.say_what_is_ignored(json, &name);
        let alpha = match json.alpha_mode {
            Checked::Valid(AlphaMode::Opaque) => None,
            Checked::Valid(AlphaMode::Mask) => Some(Some(json.alpha_cutoff.map_or(0.5, |cutoff| cutoff.0.max(0.0)))),
            Checked::Valid(AlphaMode::Blend) => Some(None),
            Checked::Invalid => return Err("its alphaMode is none of OPAQUE, MASK and BLEND; export the file again".into()),
        };
        let pbr = &json.pbr_metallic_roughness;
        let base_color_texture = self.texture(pbr.base_color_texture.as_ref(), "base colour", true, &name)?;
        let opacity = if alpha.is_some() { f.opacity } else { 1.0 };
        let sided = Material { two_sided: u32::from(json.double_sided), opacity, base_color_texture, ..Material::lambert(f.color) };
        let unlit = json.extensions.as_ref().is_some_and(|e| e.unlit.is_some());
        let (material, recipe) = if unlit {
            let material = Material { color: Vec3::ZERO, emission: f.color, emissive_texture: base_color_texture, flags: UNLIT, ..sided };
            (material, Recipe { emission: f.color, ..f.recipe(None) })
        } else {
            self.scattering(json, &f, solid, sided, &name)?
        };
        Ok(Draft { name, material, recipe, alpha, vertex_alpha: 1.0 })
    }

    /// A material that scatters, and may emit.
    fn scattering(&mut self, json: &Json, f: &Factors, solid: bool, sided: Material, name: &str) -> Result<(Material, Recipe), String> {
        let smooth = f.roughness < SMOOTH;
        let clear = f.transmission >= 1.0 && !f.transmission_varies && f.metallic == 0.0 && smooth;
        let emissive = json.emissive_texture.as_ref().filter(|_| f.emission != Vec3::ZERO);
        let emissive_texture = self.texture(emissive, "emissive", true, name)?;
        let (normal_texture, normal_scale) = match &json.normal_texture {
            Some(normal) if normal.scale.is_finite() => {
                let texture = self.refer(&Reference::of_normal(normal)?, "normal", false, name)?;
                (texture, normal.scale.clamp(-STEEPEST, STEEPEST))
            }
            Some(_) => return Err("the scale of its normal texture is not finite; repair the material and export it again".into()),
            None => (NONE, 1.0),
        };
        let material = Material { emissive_texture, normal_texture, normal_scale, ..sided };
        if f.transmission > 0.0 && f.metallic < 1.0 {
            match f.ior {
                Some(_) if clear => {
                    if f.f0_scale != Vec3::ONE || f.f90 != 1.0 {
                        self.remarks.add("The specular factors of glass were ignored", name);
                    }
                    if factors::absorbs(json) {
                        self.remarks.add("The absorption inside glass was ignored", name);
                    }
                    let recipe = f.recipe(Some(if solid { Glass::Solid } else { Glass::Thin }));
                    return Ok((recipe.material(&material), recipe));
                }
                None if clear => self.remarks.add("Shown opaque because glass of an index of refraction of 0 is not modelled", name),
                _ => self.remarks.add("Shown opaque because rough or partial transmission is not modelled", name),
            }
        }
        let recipe = f.recipe(None);
        // Where neither metal nor gloss counts, nobody reads what varies them.
        let varied = json.pbr_metallic_roughness.metallic_roughness_texture.as_ref().filter(|_| !recipe.is_lambert());
        let metallic_roughness_texture = self.texture(varied, "metallic-roughness", false, name)?;
        Ok((recipe.material(&Material { metallic_roughness_texture, ..material }), recipe))
    }

    /// The index of a texture, [`NONE`] without one.
    fn texture(&mut self, info: Option<&Info>, what: &str, srgb: bool, name: &str) -> Result<u32, String> {
        info.map_or(Ok(NONE), |info| self.refer(&Reference::of(info), what, srgb, name))
    }

    fn refer(&mut self, reference: &Reference, what: &str, srgb: bool, name: &str) -> Result<u32, String> {
        if reference.set() > 1 {
            self.remarks.add("Texture coordinates beyond set 1 are not read, set 0 stands in for them", name);
        }
        let used = self.textures.index(reference, srgb).map_err(|reason| format!("its {what} texture: {reason}"))?;
        Ok(used.unwrap_or_else(|format| {
            self.remarks.add(format!("The {what} texture was ignored, as {format} images are not read"), name);
            NONE
        }))
    }

    /// Names what of a material has no place in the models.
    fn say_what_is_ignored(&mut self, json: &Json, name: &str) {
        let extensions = json.extensions.as_ref();
        let specular = extensions.and_then(|e| e.specular.as_ref());
        let transmission = extensions.and_then(|e| e.transmission.as_ref()).filter(|t| t.transmission_factor.0 > 0.0);
        let volume = extensions.and_then(|e| e.volume.as_ref());
        let ignored = [
            ("occlusion", json.occlusion_texture.is_some()),
            ("specular", specular.is_some_and(|s| s.specular_texture.is_some())),
            ("specular colour", specular.is_some_and(|s| s.specular_color_texture.is_some())),
            ("transmission", transmission.is_some_and(|t| t.transmission_texture.is_some())),
            ("thickness", volume.is_some_and(|v| v.thickness_texture.is_some())),
        ];
        for (what, _) in ignored.into_iter().filter(|(_, there)| *there) {
            self.remarks.add(format!("The {what} texture was ignored"), name);
        }
        for extension in extensions.into_iter().flat_map(|e| e.others.keys()) {
            self.remarks.add(format!("The extension {extension} was ignored"), name);
        }
    }
}
