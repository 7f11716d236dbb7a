//! Where an environment comes from: a constant, or an equirectangular picture, Radiance .hdr or OpenEXR.
//!
//! A picture is known by its first bytes, not by its name. Its values are radiances, W m⁻² sr⁻¹; where a .hdr says that they
//! were multiplied (EXPOSURE, COLORCORR), they are divided again. Of an .exr the first layer with R, G and B is read. What no
//! radiance can be is repaired, what has more texels than can be chosen from is halved, and the notes say so.

use super::super::SceneError;
use super::super::alias::MAX_CELLS;
use super::super::assemble::plural;
use super::super::files::File;
use super::Environment;
use crate::math::Vec3;
use ::exr::meta::header::Header;
use ::exr::prelude::Vec2 as Size;
use ::exr::prelude::traits::*;
use image::ImageDecoder;
use image::codecs::hdr::HdrDecoder;
use std::io::{Cursor, ErrorKind};
use std::path::{Path, PathBuf};

/// Largest radiance, W m⁻² sr⁻¹ (and intensity, W sr⁻¹, and irradiance, W m⁻²) of a light: sums over a map, and powers, stay in
/// the range of f32.
pub const MAX_RADIANCE: f32 = 1e30;
/// Longest side of a picture that is read, texels.
const MAX_SIDE: usize = 1 << 16;
/// Most texels of a picture that is read; twelve bytes each: 1.5 GiB, in a browser 384 MiB.
const MAX_TEXELS: usize = if cfg!(target_arch = "wasm32") { 1 << 25 } else { 1 << 27 };

/// What the user or a file names as the environment.
#[derive(Clone, Debug, PartialEq)]
pub enum EnvironmentSource {
    /// The same radiance from everywhere, W m⁻² sr⁻¹.
    Constant(Vec3),
    /// A picture file.
    File(PathBuf),
    /// A picture file in memory.
    Memory(File),
}

impl EnvironmentSource {
    /// Understands "R,G,B", a single number for grey, and takes everything else for the path of a picture.
    ///
    /// # Errors
    /// If the text is empty, or its numbers are no radiance.
    pub fn parse(text: &str) -> Result<Self, String> {
        if text.is_empty() {
            return Err("give a radiance R,G,B or a .hdr or .exr file".into());
        }
        let numbers: Option<Vec<f32>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
        let radiance = match numbers.as_deref() {
            None => return Ok(Self::File(text.into())),
            Some(&[grey]) => Vec3::splat(grey),
            Some(&[r, g, b]) => Vec3::new(r, g, b),
            Some(_) => return Err("give one number, or three as R,G,B".into()),
        };
        constant(radiance).map(Self::Constant)
    }

    /// Reads it; `rotation` in degrees about +Y; what is to be told goes to `notes`.
    ///
    /// # Errors
    /// If the file cannot be read or is no picture, or a constant is negative, not finite or above [`MAX_RADIANCE`].
    pub fn open(&self, rotation: f64, notes: &mut Vec<String>) -> Result<Environment, SceneError> {
        match self {
            Self::Constant(radiance) => {
                let radiance = constant(*radiance).map_err(|reason| SceneError::file(Path::new("the environment"), reason))?;
                Ok(Environment::constant(radiance))
            }
            Self::File(path) => {
                let bytes = crate::scene::read::whole(path).map_err(|error| SceneError::file(path, unreadable(path, &error)))?;
                Environment::decode(&bytes, rotation, notes).map_err(|reason| SceneError::file(path, reason))
            }
            Self::Memory(file) => {
                let decoded = Environment::decode(&file.bytes, rotation, notes);
                decoded.map_err(|reason| SceneError::file(Path::new(file.short_name()), reason))
            }
        }
    }
}

/// Checks a constant radiance.
pub fn constant(radiance: Vec3) -> Result<Vec3, String> {
    let good = (0..3).all(|i| (0.0..=MAX_RADIANCE).contains(&radiance[i]));
    if good { Ok(radiance) } else { Err(format!("a radiance must be a number from 0 to {MAX_RADIANCE:.0e} in each channel")) }
}

/// Why a file cannot be read.
fn unreadable(path: &Path, error: &std::io::Error) -> String {
    match error.kind() {
        _ if path.is_dir() => "this is a folder; give the .hdr or .exr file in it".into(),
        ErrorKind::NotFound => "there is no such file; give a .hdr or .exr file, or a radiance R,G,B".into(),
        _ => format!("cannot be read ({error}); check the path and its permissions"),
    }
}

impl Environment {
    /// Decodes an equirectangular picture, the bytes of a .hdr or an .exr file, and turns it by `rotation` degrees about +Y;
    /// what is to be told goes to `notes`.
    ///
    /// # Errors
    /// If the bytes are no such picture, are damaged or cut short, or hold no texel or far too many.
    pub fn decode(bytes: &[u8], rotation: f64, notes: &mut Vec<String>) -> Result<Self, String> {
        let mut map = if bytes.starts_with(b"#?") {
            Map::from_hdr(bytes, notes)?
        } else if bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
            Map::from_exr(bytes)?
        } else {
            return Err("neither a Radiance nor an OpenEXR picture; give a .hdr or .exr file".into());
        };
        let [width, height] = map.size;
        if width != 2 * height {
            notes.push(format!("The environment map has {width}×{height} texels: as it is not twice as wide as high, it was stretched."));
        }
        map.repair(notes);
        map.shrink(MAX_CELLS, notes);
        Ok(Self::from_map(map.size.map(|side| side as u32), &map.texels, rotation))
    }
}

/// A picture as it was read: radiances, row by row from the top.
#[derive(Debug)]
struct Map {
    size: [usize; 2],
    texels: Vec<Vec3>,
}

/// Refuses sizes that no picture has, before any memory is asked for.
fn check_size(size: [usize; 2]) -> Result<(), String> {
    let [width, height] = size;
    if width == 0 || height == 0 {
        return Err(format!("the picture is empty ({width}×{height} texels); give another"));
    }
    if width.max(height) > MAX_SIDE || width.saturating_mul(height) > MAX_TEXELS {
        return Err(format!("the picture has {width}×{height} texels, at most {MAX_TEXELS} can be read; make it smaller"));
    }
    Ok(())
}

fn damaged(kind: &str, error: impl std::fmt::Display) -> String {
    format!("the {kind} picture cannot be decoded ({error}); it is damaged, cut short or of an unusual kind: copy or export it again")
}

impl Map {
    /// Radiance's RGBE.
    fn from_hdr(bytes: &[u8], notes: &mut Vec<String>) -> Result<Self, String> {
        let fail = |error| damaged(".hdr", error);
        // Not strictly: the signature may be #?RGBE, and headers hold all sorts of things.
        let decoder = HdrDecoder::with_strictness(Cursor::new(bytes), false).map_err(fail)?;
        let (about, (width, height)) = (decoder.metadata(), decoder.dimensions());
        let size = [width as usize, height as usize];
        check_size(size)?;
        let mut texels = vec![Vec3::ZERO; size[0] * size[1]];
        decoder.read_image(bytemuck::cast_slice_mut(&mut texels)).map_err(fail)?;
        let multiplied = Vec3::from(about.color_correction.unwrap_or((1.0, 1.0, 1.0))) * about.exposure.unwrap_or(1.0);
        if multiplied != Vec3::ONE && multiplied.is_finite() && multiplied.min_element() > 0.0 {
            texels.iter_mut().for_each(|texel| *texel /= multiplied);
            notes.push(format!("The environment map was divided by the exposure in its header, {multiplied}."));
        }
        Ok(Self { size, texels })
    }

    /// OpenEXR.
    fn from_exr(bytes: &[u8]) -> Result<Self, String> {
        let fail = |error| damaged(".exr", error);
        let reader = ::exr::block::read(Cursor::new(bytes), false).map_err(fail)?;
        let layer = |header: &Header| Some((rgb_prefix(header)?, header.layer_size));
        let Some((prefix, Size(width, height))) = reader.headers().iter().find_map(layer) else {
            return Err("the .exr picture has no layer with the channels R, G and B; export it with them".into());
        };
        check_size([width, height])?;
        let image = ::exr::prelude::read()
            .no_deep_data()
            .largest_resolution_level()
            .specific_channels()
            .required(&*format!("{prefix}R"))
            .required(&*format!("{prefix}G"))
            .required(&*format!("{prefix}B"))
            .collect_pixels(
                |Size(width, height), _| Self { size: [width, height], texels: vec![Vec3::ZERO; width * height] },
                |map, Size(x, y), (r, g, b): (f32, f32, f32)| map.texels[y * map.size[0] + x] = Vec3::new(r, g, b),
            )
            .first_valid_layer()
            .all_attributes()
            .non_parallel()
            .from_chunks(reader)
            .map_err(fail)?;
        Ok(image.layer_data.channel_data.pixels)
    }

    /// Makes radiances of what are none: negative or NaN → 0, infinite → the largest finite value of the map.
    fn repair(&mut self, notes: &mut Vec<String>) {
        let good = |x: f32| (0.0..=MAX_RADIANCE).contains(&x);
        let largest = self.texels.iter().flat_map(|texel| texel.to_array()).filter(|&x| good(x)).fold(0.0, f32::max);
        let (mut no_radiance, mut infinite, mut cut) = (0, 0, 0);
        for texel in self.texels.iter_mut().filter(|texel| !texel.to_array().into_iter().all(good)) {
            let values = texel.to_array();
            no_radiance += usize::from(values.iter().any(|x| x.is_nan() || *x < 0.0));
            infinite += usize::from(values.contains(&f32::INFINITY));
            cut += usize::from(values.iter().any(|x| x.is_finite() && *x > MAX_RADIANCE));
            *texel = Vec3::from(values.map(|x| match x {
                f32::INFINITY => largest,
                x if x > 0.0 => x.min(MAX_RADIANCE),
                _ => 0.0,
            }));
        }
        let mut note = |count: usize, what: &str, instead: &str| {
            if count > 0 {
                notes.push(format!("The environment map has {count} texel{} {what}: {instead} there instead.", plural(count)));
            }
        };
        note(no_radiance, "with values that are negative or no numbers", "0 was put");
        note(infinite, "of infinite radiance", &format!("its largest finite value, {largest}, was put"));
        note(cut, &format!("above {MAX_RADIANCE:.0e} W m⁻² sr⁻¹"), "that was put");
    }

    /// Halves the map, each texel the mean of four, until it has at most `most` texels.
    fn shrink(&mut self, most: usize, notes: &mut Vec<String>) {
        let before = self.size;
        while self.texels.len() > most {
            let (Self { size: [w, h], texels }, [width, height]) = (&*self, self.size.map(|side| side.div_ceil(2)));
            let at = |x: usize, y: usize| texels[y.min(h - 1) * w + x.min(w - 1)] * 0.25;
            let mean = |x: usize, y: usize| at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1);
            let texels = (0..width * height).map(|i| mean(2 * (i % width), 2 * (i / width))).collect();
            *self = Self { size: [width, height], texels };
        }
        if self.size != before {
            let ([w, h], [width, height]) = (before, self.size);
            notes.push(format!("The environment map has {w}×{h} texels: it was reduced to {width}×{height}."));
        }
    }
}

/// What stands before R, G and B in the names of a layer's channels: preferably nothing; `None` if they are not there.
fn rgb_prefix(header: &Header) -> Option<String> {
    let names: Vec<String> = header.channels.list.iter().map(|channel| channel.name.to_string()).collect();
    let prefixes = names.iter().filter_map(|name| name.strip_suffix('R')).filter(|prefix| prefix.is_empty() || prefix.ends_with('.'));
    let complete = prefixes.filter(|prefix| ["G", "B"].iter().all(|letter| names.contains(&format!("{prefix}{letter}"))));
    complete.min_by_key(|prefix| !prefix.is_empty()).map(str::to_owned).filter(|_| !header.deep)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halving_takes_the_mean_of_four() {
        let mut map = Map { size: [4, 3], texels: (0..12).map(|i| Vec3::splat(i as f32)).collect() };
        let mut notes = Vec::new();
        map.shrink(12, &mut notes);
        assert!(notes.is_empty());
        map.shrink(11, &mut notes);
        // The last row has no partner: it is its own.
        let means: Vec<f32> = map.texels.iter().map(|texel| texel.x).collect();
        assert_eq!((map.size, means), ([2, 2], vec![2.5, 4.5, 8.5, 10.5]));
        assert_eq!(notes, ["The environment map has 4×3 texels: it was reduced to 2×2."]);
    }

    #[test]
    fn absurd_sizes_are_refused_before_memory_is_asked_for() {
        assert!(check_size([0, 5]).is_err_and(|e| e.contains("empty")));
        for size in [[1 << 17, 1], [1 << 16, 1 << 12], [usize::MAX, usize::MAX]] {
            assert!(check_size(size).is_err_and(|e| e.contains("make it smaller")));
        }
        assert!(check_size([1 << 14, 1 << 13]).is_ok());
    }
}
