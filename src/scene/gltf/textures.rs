//! From glTF textures to uses of images: sampler, transform, texture coordinate set, and each image once.
//!
//! ```text
//! u′ =  cosφ s_u u + sinφ s_v v + o_u        KHR_texture_transform: scale s, then rotation φ, then offset o
//! v′ = −sinφ s_u u + cosφ s_v v + o_v        (counter-clockwise as one sees it, v pointing down)
//! ```

use super::super::texture::{TextureUse, Wrap};
use super::container::{Document, label};
use super::images::{Found, Picture, look};
use crate::math::Vec3;
use ::gltf::json::extensions::texture::TextureTransform;
use ::gltf::json::material::NormalTexture;
use ::gltf::json::texture::{Info, MagFilter, Sampler, WrappingMode};
use ::gltf::json::validation::Checked;
use std::borrow::Cow;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// Extensions that hold a texture's image in a format of their own.
const FOREIGN: [&str; 4] = ["KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif", "MSFT_texture_dds"];
/// Largest number in a transform of texture coordinates.
const LARGEST: f32 = 1e9;
/// "No image" in gltf's own words.
const NO_SOURCE: usize = u32::MAX as usize;

/// How a material refers to a texture.
pub struct Reference {
    texture: usize,
    set: u32,
    transform: Option<TextureTransform>,
}

impl Reference {
    /// A plain reference.
    pub fn of(info: &Info) -> Self {
        let transform = info.extensions.as_ref().and_then(|e| e.texture_transform.clone());
        Self { texture: info.index.value(), set: info.tex_coord, transform }
    }

    /// A normal map's, whose transform the parser leaves as it is.
    pub fn of_normal(info: &NormalTexture) -> Result<Self, String> {
        let own = info.extensions.as_ref().and_then(|e| e.others.get("KHR_texture_transform"));
        let transform = own.map(|value| serde_json::from_value(value.clone())).transpose();
        let transform = transform.map_err(|e| format!("its KHR_texture_transform is not valid ({e}); export the file again"))?;
        Ok(Self { texture: info.index.value(), set: info.tex_coord, transform })
    }

    /// The set of texture coordinates.
    pub fn set(&self) -> u32 {
        self.transform.as_ref().and_then(|t| t.tex_coord).unwrap_or(self.set)
    }

    /// The transform's rows.
    fn rows(&self) -> Result<[Vec3; 2], String> {
        let Some(TextureTransform { offset, rotation, scale, .. }) = &self.transform else { return Ok([Vec3::X, Vec3::Y]) };
        let (sin, cos) = f64::from(rotation.0).sin_cos();
        let ([su, sv], [ou, ov]) = (scale.0.map(f64::from), offset.0.map(f64::from));
        let rows = [[cos * su, sin * sv, ou], [-sin * su, cos * sv, ov]].map(|row| Vec3::from_array(row.map(|x| x as f32)));
        if rows.iter().all(|row| row.abs().max_element() <= LARGEST) {
            Ok(rows)
        } else {
            Err(format!("its KHR_texture_transform is not finite or above {LARGEST:.0e}; repair the material and export it again"))
        }
    }
}

/// The textures in use, made when they are first asked for.
pub struct TextureTable<'a> {
    document: &'a Document<'a>,
    /// The uses so far.
    pub uses: Vec<TextureUse>,
    /// The images so far, not decoded.
    pub pictures: Vec<Picture<'a>>,
    use_of: HashMap<[u32; 8], u32>,
    /// By image of the file: its place among the pictures, or the format that cannot be read.
    picture_of: HashMap<usize, Result<u32, &'static str>>,
}

impl<'a> TextureTable<'a> {
    /// None yet.
    pub fn new(document: &'a Document<'a>) -> Self {
        Self { document, uses: Vec::new(), pictures: Vec::new(), use_of: HashMap::new(), picture_of: HashMap::new() }
    }

    /// The index of a use of a texture; `Err` in `Ok`: its image has this format, which cannot be read.
    pub fn index(&mut self, reference: &Reference, srgb: bool) -> Result<Result<u32, &'static str>, String> {
        let index = reference.texture;
        let textures = &self.document.root.textures;
        let texture = textures.get(index).ok_or_else(|| format!("texture {index} does not exist; export the file again"))?;
        let source = texture.source.value();
        if source == NO_SOURCE {
            let foreign = texture.extensions.as_ref().and_then(|e| FOREIGN.into_iter().find(|name| e.others.contains_key(*name)));
            return foreign.map(Err).ok_or_else(|| format!("texture {index} has no image; export the file again"));
        }
        let image = match self.picture(source)? {
            Ok(image) => image,
            Err(format) => return Ok(Err(format)),
        };
        self.pictures[image as usize].srgb |= srgb;
        let (wrap, nearest) = match texture.sampler {
            None => ([Wrap::Repeat; 2], false),
            Some(sampler) => {
                let known = self.document.root.samplers.get(sampler.value());
                let known = known.ok_or_else(|| format!("sampler {} does not exist; export the file again", sampler.value()))?;
                sampling(known).ok_or_else(|| format!("sampler {} has an unknown mode; export the file again", sampler.value()))?
            }
        };
        let rows = reference.rows()?;
        let new = TextureUse { image, srgb, wrap, nearest, set: u32::from(reference.set() == 1), rows };
        let modes = u32::from(srgb) | u32::from(nearest) << 1 | new.set << 2 | (wrap[0] as u32) << 3 | (wrap[1] as u32) << 5;
        let [[a, b, c], [d, e, f]] = rows.map(|row| row.to_array().map(f32::to_bits));
        let next = self.uses.len() as u32;
        let known = *self.use_of.entry([image, modes, a, b, c, d, e, f]).or_insert(next);
        if known == next {
            self.uses.push(new);
        }
        Ok(Ok(known))
    }

    /// The place of an image among the pictures.
    fn picture(&mut self, index: usize) -> Result<Result<u32, &'static str>, String> {
        let entry = match self.picture_of.entry(index) {
            Entry::Occupied(known) => return Ok(*known.get()),
            Entry::Vacant(new) => new,
        };
        let image = self.document.root.images.get(index).ok_or_else(|| format!("image {index} does not exist; export the file again"))?;
        let uri = image.uri.as_deref().filter(|uri| !uri.starts_with("data:"));
        let name = label("image", index, image.name.as_deref().or(uri));
        let bytes = match (&image.uri, image.buffer_view) {
            (_, Some(view)) => self.document.view(view.value()).map(Cow::Borrowed),
            (Some(uri), None) => self.document.fetch(uri),
            (None, None) => Err("it has neither a file nor a buffer view; export the scene again".into()),
        };
        let bytes = bytes.map_err(|reason| format!("{name}: {reason}"))?;
        let found = match look(&name, bytes)? {
            Found::Foreign(format) => Err(format),
            Found::Picture(picture) => {
                self.pictures.push(picture);
                Ok(self.pictures.len() as u32 - 1)
            }
        };
        Ok(*entry.insert(found))
    }
}

/// A sampler's wrap modes, and whether it takes the nearest texel; `None` if a mode is unknown.
fn sampling(sampler: &Sampler) -> Option<([Wrap; 2], bool)> {
    let wrap = |mode: Checked<WrappingMode>| match mode {
        Checked::Valid(WrappingMode::Repeat) => Some(Wrap::Repeat),
        Checked::Valid(WrappingMode::MirroredRepeat) => Some(Wrap::Mirror),
        Checked::Valid(WrappingMode::ClampToEdge) => Some(Wrap::Clamp),
        Checked::Invalid => None,
    };
    let nearest = match sampler.mag_filter {
        Some(Checked::Invalid) => return None,
        filter => filter == Some(Checked::Valid(MagFilter::Nearest)),
    };
    Some(([wrap(sampler.wrap_s)?, wrap(sampler.wrap_t)?], nearest))
}
