//! Images of textures: PNG and JPEG pictures become eight-bit texels, as many as there is room for.
//!
//! A picture's size is read from its header and judged before anything is allocated for it; what does not fit into the
//! budget of all images is halved on decoding, the largest first. Gamma and colour profiles inside pictures do not count, as
//! glTF demands.

use super::super::Progress;
use super::super::progress::Stage;
use super::super::texture::Image;
use ::image::{DynamicImage, ImageFormat, ImageReader, Limits};
use rayon::prelude::*;
use std::borrow::Cow;
use std::collections::BinaryHeap;
use std::io::Cursor;

/// Longest side of a picture that is decoded, texels.
const MAX_SIDE: u32 = if cfg!(target_arch = "wasm32") { 1 << 13 } else { 1 << 14 };
/// The most texels all images keep together; four bytes each: 1 GiB, in a browser 128 MiB.
const MAX_TEXELS: u64 = if cfg!(target_arch = "wasm32") { 1 << 25 } else { 1 << 28 };
/// Pictures of more texels are decoded one after the other, for want of memory.
const LARGE: u64 = 1 << 24;

/// A picture that has not been decoded yet.
#[derive(Debug)]
pub struct Picture<'a> {
    /// "image 3 'bark'".
    pub label: String,
    /// Is it read as sRGB somewhere?
    pub srgb: bool,
    bytes: Cow<'a, [u8]>,
    format: ImageFormat,
    size: [u32; 2],
    /// How often it is halved on decoding.
    halvings: u32,
}

/// What the bytes of an image are.
pub enum Found<'a> {
    /// A picture that can be decoded.
    Picture(Picture<'a>),
    /// One of a format that only an extension allows: which.
    Foreign(&'static str),
}

/// An image, and the least alpha among its texels.
pub struct Decoded {
    pub image: Image,
    pub least_alpha: u8,
}

/// Says what the bytes of an image are; only the header is read.
pub fn look<'a>(label: &str, bytes: Cow<'a, [u8]>) -> Result<Found<'a>, String> {
    let format = match &bytes[..] {
        [0x89, b'P', b'N', b'G', ..] => ImageFormat::Png,
        [0xff, 0xd8, 0xff, ..] => ImageFormat::Jpeg,
        [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => return Ok(Found::Foreign("WebP")),
        [0xab, b'K', b'T', b'X', ..] => return Ok(Found::Foreign("KTX")),
        [b'D', b'D', b'S', b' ', ..] => return Ok(Found::Foreign("DDS")),
        [_, _, _, _, b'f', b't', b'y', b'p', ..] => return Ok(Found::Foreign("AVIF")),
        _ => return Err(format!("{label} is neither a PNG nor a JPEG picture; convert it and export the scene again")),
    };
    let reader = ImageReader::with_format(Cursor::new(&bytes[..]), format);
    let (width, height) = reader.into_dimensions().map_err(|e| undecodable(label, &e.to_string()))?;
    let size = [width, height];
    if size.contains(&0) || size.iter().any(|&side| side > MAX_SIDE) {
        return Err(format!(
            "{label} has {width}×{height} texels, 1 to {MAX_SIDE} a side can be read; scale it and export the scene again"
        ));
    }
    Ok(Found::Picture(Picture { label: label.to_owned(), srgb: false, bytes, format, size, halvings: 0 }))
}

fn undecodable(label: &str, why: &str) -> String {
    format!("{label} cannot be decoded ({why}); save the picture anew and export the scene again")
}

/// Decodes all pictures, halved where they would not fit otherwise; then a sentence is added to `notes`.
pub fn decode(mut pictures: Vec<Picture>, notes: &mut Vec<String>, progress: &Progress) -> Result<Vec<Decoded>, String> {
    notes.extend(fit(&mut pictures, MAX_TEXELS));
    progress.begin(Stage::Images, pictures.len());
    let one = |picture: &Picture| {
        let decoded = picture.decode();
        progress.advance();
        decoded
    };
    let small = |picture: &Picture| (texels(picture.size) <= LARGE).then(|| one(picture));
    let decoded: Vec<_> = pictures.par_iter().map(small).collect();
    decoded.into_iter().zip(&pictures).map(|(small, picture)| small.unwrap_or_else(|| one(picture))).collect()
}

fn texels([width, height]: [u32; 2]) -> u64 {
    u64::from(width) * u64::from(height)
}

fn half([width, height]: [u32; 2]) -> [u32; 2] {
    [(width / 2).max(1), (height / 2).max(1)]
}

/// Has the largest pictures halved until all fit into `budget` texels; the sentence that says so.
fn fit(pictures: &mut [Picture], budget: u64) -> Option<String> {
    let wanted: u64 = pictures.iter().map(|picture| texels(picture.size)).sum();
    let (mut left, mut heap) = (wanted, BinaryHeap::new());
    heap.extend(pictures.iter().enumerate().map(|(i, picture)| (texels(picture.size), i, picture.size)));
    while left > budget
        && let Some((now, i, size)) = heap.pop()
        && now > 1
    {
        let next = half(size);
        left -= now - texels(next);
        heap.push((texels(next), i, next));
        pictures[i].halvings += 1;
    }
    let halved: Vec<_> = pictures.iter().filter(|picture| picture.halvings > 0).collect();
    let describe = |picture: &&Picture| {
        let ([w, h], [new_w, new_h]) = (picture.size, (0..picture.halvings).fold(picture.size, |size, _| half(size)));
        format!("{} from {w}×{h} to {new_w}×{new_h}", picture.label)
    };
    let listed: Vec<_> = halved.iter().take(6).map(describe).collect();
    let more = if halved.len() > 6 { format!(" and {} more", halved.len() - 6) } else { String::new() };
    let sentence = || format!("The textures have {wanted} texels, at most {budget} are kept; scaled down: {}{more}.", listed.join(", "));
    (!halved.is_empty()).then(sentence)
}

impl Picture<'_> {
    fn decode(&self) -> Result<Decoded, String> {
        let mut reader = ImageReader::with_format(Cursor::new(&self.bytes[..]), self.format);
        let mut limits = Limits::default();
        (limits.max_image_width, limits.max_image_height) = (Some(self.size[0]), Some(self.size[1]));
        // The widest texel has four channels of 16 bits; what a decoder needs beside them is a few rows.
        limits.max_alloc = Some(texels(self.size) * 8 + (16 << 20));
        reader.limits(limits);
        let picture = reader.decode().map_err(|e| undecodable(&self.label, &e.to_string()))?;
        let mut image = unpacked(picture);
        for _ in 0..self.halvings {
            image = halved(&image, self.srgb);
        }
        let least_alpha = image.texels.iter().map(|texel| texel.to_le_bytes()[3]).min().unwrap_or(255);
        Ok(Decoded { image, least_alpha })
    }
}

/// Red, green, blue and alpha of eight bits, whatever the picture has.
fn unpacked(picture: DynamicImage) -> Image {
    let size = [picture.width(), picture.height()];
    let texels = picture.into_rgba8().into_raw();
    Image { size, texels: texels.chunks_exact(4).map(|t| u32::from_le_bytes([t[0], t[1], t[2], t[3]])).collect() }
}

/// The image at half its size, each texel the mean of four; sRGB colours by their squares, which are nearly linear.
fn halved(image: &Image, srgb: bool) -> Image {
    let [width, height] = half(image.size);
    let mean = |x: u32, y: u32| {
        let at = |dx: u32, dy: u32| {
            let (x, y) = ((2 * x + dx).min(image.size[0] - 1), (2 * y + dy).min(image.size[1] - 1));
            image.texels[y as usize * image.size[0] as usize + x as usize].to_le_bytes()
        };
        let four = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
        u32::from_le_bytes(std::array::from_fn(|c| {
            let values = four.map(|texel| f32::from(texel[c]));
            let mean =
                if srgb && c < 3 { (values.iter().map(|v| v * v).sum::<f32>() * 0.25).sqrt() } else { values.iter().sum::<f32>() * 0.25 };
            mean.round() as u8
        }))
    };
    let texels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| mean(x, y)).collect();
    Image { size: [width, height], texels }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(size: [u32; 2]) -> Picture<'static> {
        Picture { label: format!("image {}", size[0]), srgb: true, bytes: Cow::Borrowed(&[]), format: ImageFormat::Png, size, halvings: 0 }
    }

    #[test]
    fn the_largest_pictures_are_halved_until_all_fit() {
        let mut pictures = [picture([64, 64]), picture([32, 8]), picture([128, 64])];
        assert_eq!(fit(&mut pictures, 64 * 64 + 256 + 128 * 64), None);
        let note = fit(&mut pictures, 4000).unwrap();
        assert_eq!(pictures.each_ref().map(|p| p.halvings), [1, 0, 1]);
        assert_eq!(
            note,
            "The textures have 12544 texels, at most 4000 are kept; scaled down: image 64 from 64×64 to 32×32, image 128 from 128×64 to 64×32."
        );
        // What cannot be halved stays.
        let mut pictures = [picture([1, 1]), picture([1, 4])];
        assert!(fit(&mut pictures, 1).is_some());
        assert_eq!(pictures.each_ref().map(|p| p.halvings), [0, 2]);
    }

    #[test]
    fn halving_keeps_means() {
        let image = Image { size: [3, 2], texels: vec![0xff00_0000, 0xff00_00ff, 7, 0x0000_00ff, 0x0000_0000, 9] };
        let linear = halved(&image, false);
        assert_eq!((linear.size, linear.texels[0].to_le_bytes()), ([1, 1], [128, 0, 0, 128]));
        // Half the light is more than half the code.
        assert_eq!(halved(&image, true).texels[0].to_le_bytes(), [180, 0, 0, 128]);
        let row = Image { size: [4, 1], texels: vec![10, 20, 30, 40] };
        assert_eq!(halved(&row, false), Image { size: [2, 1], texels: vec![15, 35] });
    }
}
