//! A picture that is there, complete: kept, or read from a .exr or .hdr file. A file is known by its first bytes.
//!
//! Values are taken as they are, as radiances. Of an .exr the first layer with R, G and B is read; a part of a film lies at its
//! place on the whole of it, with black around.

use crate::math::Vec3;
use ::exr::meta::header::Header;
use ::exr::prelude::Vec2 as Size;
use ::exr::prelude::traits::*;
use image::ImageDecoder;
use image::codecs::hdr::HdrDecoder;
use std::fmt;
use std::io::{Cursor, ErrorKind};
use std::path::Path;

/// Most pixels of a picture that is read: fewer in a browser, for want of memory.
const MOST_PIXELS: usize = if cfg!(target_arch = "wasm32") { 1 << 24 } else { 1 << 26 };

/// A picture.
#[derive(Clone, PartialEq)]
pub struct Picture {
    /// Size, pixels.
    pub size: [u32; 2],
    /// Linear radiance, row by row from the top.
    pub pixels: Vec<Vec3>,
}

impl fmt::Debug for Picture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Picture({}×{})", self.size[0], self.size[1])
    }
}

/// A pixel of a picture of this size; `None` outside.
pub fn pixel_of(size: [u32; 2], pixels: &[Vec3], at: [u32; 2]) -> Option<Vec3> {
    let inside = at[0] < size[0] && at[1] < size[1];
    pixels.get(at[1] as usize * size[0] as usize + at[0] as usize).copied().filter(|_| inside)
}

impl Picture {
    /// Reads a .exr or a .hdr file.
    ///
    /// # Errors
    /// If there is no such file, or it is no picture; the sentence says what to do.
    pub fn open(path: &Path) -> Result<Self, String> {
        let name = path.display();
        let bytes = std::fs::read(path).map_err(|error| match error.kind() {
            _ if path.is_dir() => format!("'{name}' is a folder; give the .exr or .hdr file in it"),
            ErrorKind::NotFound => format!("there is no file '{name}'; give a .exr or .hdr file"),
            _ => format!("'{name}' cannot be read ({error})"),
        })?;
        Self::decode(&bytes).map_err(|reason| format!("'{name}': {reason}"))
    }

    /// Decodes the bytes of a .exr or .hdr file.
    ///
    /// # Errors
    /// If they are no such picture, or damaged.
    pub fn decode(bytes: &[u8]) -> Result<Self, String> {
        if bytes.starts_with(b"#?") {
            Self::from_hdr(bytes)
        } else if bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
            Self::from_exr(bytes)
        } else {
            Err("neither an OpenEXR nor a Radiance picture; give a .exr or .hdr file".to_owned())
        }
    }

    /// A black picture, if its size is a sensible one.
    fn black([width, height]: [usize; 2]) -> Result<Self, String> {
        let count = width.saturating_mul(height);
        let (Ok(columns), Ok(rows), 1..=MOST_PIXELS) = (u32::try_from(width), u32::try_from(height), count) else {
            return Err(format!("it has {width}×{height} pixels, 1 to {MOST_PIXELS} can be read"));
        };
        Ok(Self { size: [columns, rows], pixels: vec![Vec3::ZERO; count] })
    }

    fn from_hdr(bytes: &[u8]) -> Result<Self, String> {
        let decoder = HdrDecoder::with_strictness(Cursor::new(bytes), false).map_err(damaged)?;
        let (width, height) = decoder.dimensions();
        let mut picture = Self::black([width as usize, height as usize])?;
        decoder.read_image(bytemuck::cast_slice_mut(&mut picture.pixels)).map_err(damaged)?;
        Ok(picture)
    }

    fn from_exr(bytes: &[u8]) -> Result<Self, String> {
        let reader = ::exr::block::read(Cursor::new(bytes), false).map_err(damaged)?;
        let found = reader.headers().iter().find_map(|header| Some((rgb_prefix(header)?, header)));
        let Some((prefix, header)) = found else {
            return Err("it has no layer with the channels R, G and B".to_owned());
        };
        // Where the layer lies on the whole.
        let whole = header.shared_attributes.display_window;
        let corner = header.own_attributes.layer_position - whole.position;
        let picture = Self::black([whole.size.0, whole.size.1])?;
        Self::black([header.layer_size.0, header.layer_size.1])?;
        let image = ::exr::prelude::read()
            .no_deep_data()
            .largest_resolution_level()
            .specific_channels()
            .required(&*format!("{prefix}R"))
            .required(&*format!("{prefix}G"))
            .required(&*format!("{prefix}B"))
            .collect_pixels(
                move |_, _| picture.clone(),
                move |picture, Size(x, y), (r, g, b): (f32, f32, f32)| {
                    picture.put([x as i64 + i64::from(corner.0), y as i64 + i64::from(corner.1)], Vec3::new(r, g, b));
                },
            )
            .first_valid_layer()
            .all_attributes()
            .non_parallel()
            .from_chunks(reader)
            .map_err(damaged)?;
        Ok(image.layer_data.channel_data.pixels)
    }

    /// Sets a pixel, if it is one of the picture's.
    fn put(&mut self, [x, y]: [i64; 2], value: Vec3) {
        let [width, height] = self.size.map(i64::from);
        if (0..width).contains(&x)
            && (0..height).contains(&y)
            && let Some(pixel) = self.pixels.get_mut((y * width + x) as usize)
        {
            *pixel = value;
        }
    }
}

fn damaged(error: impl fmt::Display) -> String {
    format!("it cannot be decoded ({error}); it is damaged, cut short or of an unusual kind: export it again")
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
    use super::super::Rect;
    use super::super::save::{Layer, Window, save_exr};
    use super::*;

    #[test]
    fn what_was_saved_is_read_back_bit_for_bit_at_its_place() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let pixels: Vec<Vec3> = (0..20).map(|i| Vec3::new(i as f32, 1e-20 * i as f32, -0.5)).collect();
        save_exr(&path, Window::full([5, 4]), &[Layer { name: "", pixels: &pixels }]).unwrap();
        assert_eq!(Picture::open(&path).unwrap(), Picture { size: [5, 4], pixels: pixels.clone() });
        let rect = Rect { x: 2, y: 1, width: 3, height: 2 };
        save_exr(&path, Window { film: [5, 4], rect }, &[Layer { name: "", pixels: &pixels }]).unwrap();
        let part = Picture::open(&path).unwrap();
        let expected: Vec<Vec3> = (0..20).map(|i| if rect.contains([i % 5, i / 5]) { pixels[i as usize] } else { Vec3::ZERO }).collect();
        assert_eq!(part, Picture { size: [5, 4], pixels: expected });
    }

    #[test]
    fn what_is_no_picture_is_refused_in_a_sentence() {
        let folder = tempfile::tempdir().unwrap();
        let refused = |path: &Path| Picture::open(path).unwrap_err();
        assert!(refused(folder.path()).contains("is a folder"));
        assert!(refused(&folder.path().join("none.exr")).contains("there is no file"));
        for (name, bytes) in
            [("text.exr", &b"hello"[..]), ("cut.exr", &[0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0]), ("cut.hdr", b"#?RADIANCE\n\n")]
        {
            let path = folder.path().join(name);
            std::fs::write(&path, bytes).unwrap();
            let sentence = refused(&path);
            assert!(sentence.contains(name) && sentence.contains("export it again") || sentence.contains("give a .exr"), "{sentence}");
        }
    }

    #[test]
    fn a_pixel_outside_is_none() {
        let pixels = [Vec3::ZERO, Vec3::ONE];
        assert_eq!([[1, 0], [2, 0], [0, 1]].map(|at| pixel_of([2, 1], &pixels, at)), [Some(Vec3::ONE), None, None]);
    }

    #[test]
    fn a_radiance_picture_is_read() {
        // 2×1, not compressed: 1, 0.5, 0.25 and black.
        let bytes = [&b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n"[..], &[128, 64, 32, 129, 0, 0, 0, 0]].concat();
        let picture = Picture::decode(&bytes).unwrap();
        assert_eq!((picture.size, picture.pixels), ([2, 1], vec![Vec3::new(1.0, 0.5, 0.25), Vec3::ZERO]));
    }
}
