//! A small picture to draw on: rectangles, scaled images, anti-aliased text.

use crate::film::Rect;
use crate::film::tonemap::{ToneMap, to_srgb8};
use crate::math::Vec3;
use ab_glyph::{Font, FontRef, PxScale, ScaleFont, point};

/// An sRGB colour.
pub type Color = [u8; 3];

/// The largest rectangle of the proportions of `size` in the middle of `frame`.
pub fn fit(frame: Rect, size: [u32; 2]) -> Rect {
    let scale = (f64::from(frame.width) / f64::from(size[0])).min(f64::from(frame.height) / f64::from(size[1]));
    let [width, height] = size.map(|v| (f64::from(v) * scale).round().max(1.0) as u32);
    let (width, height) = (width.min(frame.width), height.min(frame.height));
    Rect { x: frame.x + (frame.width - width) / 2, y: frame.y + (frame.height - height) / 2, width, height }
}

/// How a line of text looks.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    /// Height of the letters, pixels per em.
    pub size: f32,
    /// Colour.
    pub color: Color,
}

/// The picture, eight-bit sRGB.
#[derive(Debug)]
pub struct Canvas {
    /// Width and height.
    pub size: [u32; 2],
    /// Row by row from the top, three bytes a pixel.
    pub rgb: Vec<u8>,
}

impl Canvas {
    /// A canvas of one colour.
    pub fn new(size: [u32; 2], color: Color) -> Self {
        Self { size, rgb: color.repeat(size[0] as usize * size[1] as usize) }
    }

    fn pixel(&mut self, x: i64, y: i64) -> Option<&mut [u8]> {
        let inside = (0..i64::from(self.size[0])).contains(&x) && (0..i64::from(self.size[1])).contains(&y);
        let start = 3 * (y * i64::from(self.size[0]) + x);
        if inside { self.rgb.get_mut(start as usize..start as usize + 3) } else { None }
    }

    /// Fills a rectangle.
    pub fn fill(&mut self, rect: Rect, color: Color) {
        self.draw(rect, |_, _| color);
    }

    /// Draws a linear image, already of the rectangle's size, as a screen would show it.
    pub fn image(&mut self, rect: Rect, pixels: &[Vec3], exposure_ev: f32, tonemap: ToneMap) {
        self.draw(rect, |x, y| pixels.get((y * rect.width + x) as usize).map_or([0; 3], |&pixel| to_srgb8(pixel, exposure_ev, tonemap)));
    }

    fn draw(&mut self, rect: Rect, color: impl Fn(u32, u32) -> Color) {
        for y in 0..rect.height {
            for x in 0..rect.width {
                if let Some(pixel) = self.pixel(i64::from(rect.x + x), i64::from(rect.y + y)) {
                    pixel.copy_from_slice(&color(x, y));
                }
            }
        }
    }

    /// Writes a line of text from `x` on, its top at `y`; returns where it ends.
    pub fn text(&mut self, x: f32, y: f32, style: Style, text: &str) -> f32 {
        let Some(font) = font() else { return x };
        let baseline = y + font.as_scaled(PxScale::from(style.size)).ascent();
        let end = layout(&font, style.size, text, |glyph, advance| {
            let mut glyph = glyph.with_scale(style.size);
            glyph.position = point(x + advance, baseline);
            let Some(outline) = font.outline_glyph(glyph) else { return };
            let corner = outline.px_bounds().min;
            outline.draw(|column, row, coverage| {
                if let Some(pixel) = self.pixel(corner.x as i64 + i64::from(column), corner.y as i64 + i64::from(row)) {
                    for (old, new) in pixel.iter_mut().zip(style.color) {
                        *old = (f32::from(*old) + (f32::from(new) - f32::from(*old)) * coverage.clamp(0.0, 1.0)).round() as u8;
                    }
                }
            });
        });
        x + end
    }

    /// Writes a line of text centred on `x`.
    pub fn text_centred(&mut self, x: f32, y: f32, style: Style, text: &str) {
        self.text(x - 0.5 * text_width(style.size, text), y, style, text);
    }
}

/// Width of a line of text, pixels.
pub fn text_width(size: f32, text: &str) -> f32 {
    font().map_or(0.0, |font| layout(&font, size, text, |_, _| ()))
}

fn font() -> Option<FontRef<'static>> {
    FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT).ok()
}

/// Visits the glyphs with their distance from the start; returns the width.
fn layout(font: &FontRef<'_>, size: f32, text: &str, mut visit: impl FnMut(ab_glyph::GlyphId, f32)) -> f32 {
    let scaled = font.as_scaled(PxScale::from(size));
    let mut advance = 0.0;
    let mut previous = None;
    for id in text.chars().map(|letter| font.glyph_id(letter)) {
        if let Some(previous) = previous.replace(id) {
            advance += scaled.kern(previous, id);
        }
        visit(id, advance);
        advance += scaled.h_advance(id);
    }
    advance
}

/// Scales a linear image with a box filter: every new pixel is the mean over the area it covers, so energy is kept.
pub fn resample(pixels: impl IntoIterator<Item = Vec3>, [width, height]: [u32; 2], target: [u32; 2]) -> Vec<Vec3> {
    let (columns, rows) = (overlaps(width, target[0]), overlaps(height, target[1]));
    let [wide, tall] = target.map(|v| v as usize);
    let mut out = vec![Vec3::ZERO; wide * tall];
    let mut row = vec![Vec3::ZERO; wide];
    let mut pixels = pixels.into_iter();
    for rows in rows {
        row.fill(Vec3::ZERO);
        for (columns, pixel) in columns.iter().zip(&mut pixels) {
            columns.iter().for_each(|&(x, weight)| row[x] += pixel * weight);
        }
        for (y, weight) in rows {
            out[y * wide..][..wide].iter_mut().zip(&row).for_each(|(sum, &value)| *sum += value * weight);
        }
    }
    out
}

/// For each of `from` source pixels: the target pixels it overlaps, and the share of each target that it covers.
fn overlaps(from: u32, to: u32) -> Vec<Vec<(usize, f32)>> {
    let scale = f64::from(to) / f64::from(from);
    let of = |source: u32| {
        let (start, end) = (f64::from(source) * scale, f64::from(source + 1) * scale);
        let last = (end.ceil() as u32).min(to);
        (start as u32..last).map(move |x| (x as usize, (end.min(f64::from(x + 1)) - start.max(f64::from(x))).max(0.0) as f32)).collect()
    };
    (0..from).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn resampling_keeps_the_mean() {
        let pixels: Vec<_> = (0..35).map(|i| Vec3::new(i as f32, 1.0, ((i * 7) % 5) as f32)).collect();
        let mean = |pixels: &[Vec3]| pixels.iter().sum::<Vec3>() / pixels.len() as f32;
        for target in [[1, 1], [3, 2], [7, 5], [16, 9], [7, 50]] {
            let scaled = resample(pixels.iter().copied(), [7, 5], target);
            assert_eq!(scaled.len() as u32, target[0] * target[1]);
            assert!((mean(&scaled) - mean(&pixels)).abs().max_element() < 1e-4, "{target:?}");
        }
        assert_eq!(resample(pixels.iter().copied(), [7, 5], [7, 5]), pixels);
    }

    #[test]
    fn text_has_ink_inside_its_width_and_is_clipped_outside_the_canvas() {
        let style = Style { size: 20.0, color: [255; 3] };
        let mut canvas = Canvas::new([200, 40], [0; 3]);
        let end = canvas.text(10.0, 5.0, style, "next event (1,2) · β");
        assert!((end - 10.0 - text_width(20.0, "next event (1,2) · β")).abs() < 1e-3);
        let ink = |range: std::ops::Range<u32>| {
            range.flat_map(|x| (0..40).map(move |y| (x, y))).any(|(x, y)| canvas.rgb[3 * (y * 200 + x) as usize] > 128)
        };
        assert!(ink(10..end as u32) && !ink(0..9) && !ink(end as u32 + 1..200));
        canvas.text(-30.0, -7.0, style, "clipped");
        canvas.text(190.0, 35.0, style, "clipped");
    }

    #[test]
    fn every_letter_we_use_is_in_the_font() {
        let font = font().unwrap();
        for letter in "abcXYZ019()<+-–·×=≤Σβ%,.:/".chars() {
            assert_ne!(font.glyph_id(letter).0, 0, "{letter}");
        }
    }

    #[test]
    fn fitting_keeps_proportions() {
        let cell = Rect { x: 10, y: 20, width: 160, height: 120 };
        assert_eq!(fit(cell, [320, 240]), cell);
        assert_eq!(fit(cell, [100, 100]), Rect { x: 30, y: 20, width: 120, height: 120 });
        assert_eq!(fit(cell, [1000, 1]), Rect { x: 10, y: 79, width: 160, height: 1 });
    }
}
