//! Textures: images of eight-bit texels and the ways materials use them.
//!
//! ```text
//! (u′, v′) = M (u, v, 1)          KHR_texture_transform; v points down, (0, 0) is the upper left corner
//! value    = bilinear mean of the four texels around (u′ w − ½, v′ h − ½), each decoded to linear numbers first
//! ```
//!
//! An image is stored once, however many textures read it; whether its numbers are sRGB is the use's affair.

use crate::math::{Vec2, Vec3};
use crate::shared_struct;
use glam::{BVec2, Vec4};
use std::sync::{LazyLock, OnceLock};

shared_struct! {
    /// One use of an image.
    pub struct Texture {
        /// Index of the image's first texel in [`Textures::texels`].
        pub first: u32,
        /// Texels in a row.
        pub width: u32,
        /// Rows.
        pub height: u32,
        /// [`WRAP_U`] and [`WRAP_V`] hold a [`Wrap`] each; [`SRGB`], [`NEAREST`], [`SET_1`].
        pub flags: u32,
        /// u′ = `row_u` · (u, v, 1).
        pub row_u: Vec3,
        /// Padding.
        pub _pad0: u32,
        /// v′ = `row_v` · (u, v, 1).
        pub row_v: Vec3,
        /// Padding.
        pub _pad1: u32,
    }
}

/// Place of the horizontal wrap mode in the flags.
pub const WRAP_U: u32 = 0;
/// Place of the vertical wrap mode in the flags.
pub const WRAP_V: u32 = 2;
/// Flag: colours are sRGB (alpha never is).
pub const SRGB: u32 = 16;
/// Flag: no interpolation.
pub const NEAREST: u32 = 32;
/// Flag: texture coordinate set 1 instead of 0.
pub const SET_1: u32 = 64;

/// Farthest place from an image's corner that is told apart, texels.
const FARTHEST: f32 = 1e9;

/// What lies beyond an image's edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The image again.
    #[default]
    Repeat = 0,
    /// The image mirrored.
    Mirror = 1,
    /// Its last texels.
    Clamp = 2,
}

/// An image: R, G, B and alpha of a texel are the bytes of a word from the lowest up; row by row from the top.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Image {
    /// Width and height, texels; neither is 0.
    pub size: [u32; 2],
    /// Its texels.
    pub texels: Vec<u32>,
}

/// A use of an image, as the loader names it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureUse {
    /// Index into the images.
    pub image: u32,
    /// Are colours sRGB?
    pub srgb: bool,
    /// Horizontal and vertical wrap mode.
    pub wrap: [Wrap; 2],
    /// No interpolation.
    pub nearest: bool,
    /// Texture coordinate set, 0 or 1.
    pub set: u32,
    /// Rows of the transform of texture coordinates.
    pub rows: [Vec3; 2],
}

impl TextureUse {
    /// An image as it is: set 0, repeated, bilinear.
    pub fn of(image: u32, srgb: bool) -> Self {
        Self { image, srgb, wrap: [Wrap::Repeat; 2], nearest: false, set: 0, rows: [Vec3::X, Vec3::Y] }
    }
}

/// All textures of a scene.
#[derive(Debug, Default)]
pub struct Textures {
    /// What materials refer to.
    pub list: Vec<Texture>,
    /// The texels of all images.
    pub texels: Vec<u32>,
    /// The largest value of each channel of a texture, once it was asked for.
    peaks: Vec<OnceLock<Vec4>>,
}

/// Linear values of the 256 sRGB codes (IEC 61966-2-1).
static LINEAR: LazyLock<[f32; 256]> = LazyLock::new(|| {
    std::array::from_fn(|i| {
        let c = i as f64 / 255.0;
        (if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }) as f32
    })
});

/// Linear values of the 256 sRGB codes.
pub fn linear_values() -> &'static [f32; 256] {
    &LINEAR
}

impl Textures {
    /// Puts images one after the other.
    pub fn new(images: Vec<Image>, uses: &[TextureUse]) -> Self {
        let sizes: Vec<[u32; 2]> = images.iter().map(|image| image.size).collect();
        let mut texels = Vec::new();
        let firsts: Vec<u32> = images
            .into_iter()
            .map(|mut image| {
                // Each image goes as soon as it is appended: all of them twice would be much.
                let first = texels.len() as u32;
                texels.append(&mut image.texels);
                first
            })
            .collect();
        let texture = |x: &TextureUse| {
            let flag = |set: bool, flag: u32| if set { flag } else { 0 };
            Texture {
                first: firsts[x.image as usize],
                width: sizes[x.image as usize][0],
                height: sizes[x.image as usize][1],
                flags: ((x.wrap[0] as u32) << WRAP_U)
                    | ((x.wrap[1] as u32) << WRAP_V)
                    | flag(x.srgb, SRGB)
                    | flag(x.nearest, NEAREST)
                    | flag(x.set == 1, SET_1),
                row_u: x.rows[0],
                _pad0: 0,
                row_v: x.rows[1],
                _pad1: 0,
            }
        };
        Self { list: uses.iter().map(texture).collect(), texels, peaks: vec![OnceLock::new(); uses.len()] }
    }

    /// Bytes that the texels take.
    pub fn bytes(&self) -> usize {
        size_of_val(self.texels.as_slice())
    }

    /// The linear value at texture coordinates, alpha last.
    #[inline]
    pub fn value(&self, texture: u32, uv: Vec2) -> Vec4 {
        let texture = &self.list[texture as usize];
        let place = texture.place(uv);
        if texture.flags & NEAREST != 0 {
            return self.texel(texture, place.floor());
        }
        let low = (place - 0.5).floor();
        let part = place - 0.5 - low;
        let row = |y: f32| self.texel(texture, Vec2::new(low.x, y)).lerp(self.texel(texture, Vec2::new(low.x + 1.0, y)), part.x);
        row(low.y).lerp(row(low.y + 1.0), part.y)
    }

    /// The linear value of the texel in this column and row, whole numbers; wrapped.
    #[inline]
    pub fn texel(&self, texture: &Texture, at: Vec2) -> Vec4 {
        let x = wrapped(at.x, texture.width, texture.flags >> WRAP_U & 3);
        let y = wrapped(at.y, texture.height, texture.flags >> WRAP_V & 3);
        let bytes = self.texels[(texture.first + y * texture.width + x) as usize].to_le_bytes();
        let [r, g, b, a] = bytes.map(f32::from);
        if texture.flags & SRGB != 0 {
            let [r, g, b, _] = bytes.map(|c| LINEAR[c as usize]);
            return Vec4::new(r, g, b, a * (1.0 / 255.0));
        }
        Vec4::new(r, g, b, a) * (1.0 / 255.0)
    }

    /// A bound on the linear value of each channel that interpolation can give within a box of texture coordinates: exact
    /// for small boxes, the image's largest for others, so that its cost does not grow with the image.
    pub fn largest(&self, index: u32, corners: [Vec2; 3]) -> Vec4 {
        const SMALL: f32 = 4096.0;
        let texture = &self.list[index as usize];
        let (low, count) = texture.texels_around(corners);
        if count.x * count.y <= SMALL {
            let all = (0..count.y as u32).flat_map(|y| (0..count.x as u32).map(move |x| Vec2::new(x as f32, y as f32)));
            return all.map(|offset| self.texel(texture, low + offset)).fold(Vec4::ZERO, Vec4::max);
        }
        *self.peaks[index as usize].get_or_init(|| {
            let all = (0..texture.height).flat_map(|y| (0..texture.width).map(move |x| Vec2::new(x as f32, y as f32)));
            all.map(|at| self.texel(texture, at)).fold(Vec4::ZERO, Vec4::max)
        })
    }

    /// About how many texels a triangle with these texture coordinates lies on.
    pub fn texels_under(&self, index: u32, corners: [Vec2; 3]) -> f32 {
        let (_, count) = self.list[index as usize].texels_around(corners);
        count.x * count.y
    }
}

impl Texture {
    /// Texture coordinates after the transform, in texels.
    #[inline]
    pub fn place(&self, uv: Vec2) -> Vec2 {
        let uv = uv.extend(1.0);
        let place = Vec2::new(self.row_u.dot(uv) * self.width as f32, self.row_v.dot(uv) * self.height as f32);
        // Beyond that f32 has no places between texels; infinity would have none at all.
        place.clamp(Vec2::splat(-FARTHEST), Vec2::splat(FARTHEST))
    }
}

impl Texture {
    /// The first column and row of the texels that count around three places, and how many columns and rows those are; what
    /// repeats is counted twice at most.
    fn texels_around(&self, corners: [Vec2; 3]) -> (Vec2, Vec2) {
        let places = corners.map(|uv| self.place(uv));
        let size = Vec2::new(self.width as f32, self.height as f32);
        let low = places.into_iter().reduce(Vec2::min).unwrap_or_default().floor() - 1.0;
        let high = places.into_iter().reduce(Vec2::max).unwrap_or_default().floor() + 1.0;
        // Where the edge is repeated for ever, what lies beyond it is the edge.
        let clamped = BVec2::new(self.flags >> WRAP_U & 3 == Wrap::Clamp as u32, self.flags >> WRAP_V & 3 == Wrap::Clamp as u32);
        let inside = |place: Vec2| Vec2::select(clamped, place.clamp(Vec2::ZERO, size - 1.0), place);
        let (low, high) = (inside(low), inside(high));
        (low, (high - low + 1.0).min(size * 2.0))
    }
}

/// A whole number of texels, brought into the image.
#[inline]
fn wrapped(at: f32, size: u32, wrap: u32) -> u32 {
    let period = |n: f32| at - (at / n).floor() * n;
    let n = size as f32;
    let inside = match wrap {
        1 => {
            let place = period(2.0 * n);
            if place >= n { 2.0 * n - 1.0 - place } else { place }
        }
        2 => at,
        _ => period(n),
    };
    // Rounding at huge coordinates must not leave the image; nor does NaN.
    (inside.max(0.0) as u32).min(size - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checker(wrap: Wrap) -> Textures {
        // Red 0, 1 / 2, 3 (of 255).
        let image = Image { size: [2, 2], texels: vec![0, 1, 2, 3] };
        Textures::new(vec![image], &[TextureUse { wrap: [wrap; 2], ..TextureUse::of(0, false) }])
    }

    fn red(textures: &Textures, u: f32, v: f32) -> f32 {
        textures.value(0, Vec2::new(u, v)).x * 255.0
    }

    #[test]
    fn texels_are_met_at_their_centres_and_interpolated_between() {
        let t = checker(Wrap::Clamp);
        for (u, v, expected) in
            [(0.25, 0.25, 0.0), (0.75, 0.25, 1.0), (0.25, 0.75, 2.0), (0.75, 0.75, 3.0), (0.5, 0.5, 1.5), (0.5, 0.0, 0.5)]
        {
            assert!((red(&t, u, v) - expected).abs() < 1e-5, "{u} {v}: {}", red(&t, u, v));
        }
    }

    #[test]
    fn wrap_modes_say_what_lies_beyond() {
        let at = |wrap, u| red(&checker(wrap), u, 0.25);
        assert!((at(Wrap::Repeat, 1.25) - 0.0).abs() < 1e-5 && (at(Wrap::Repeat, -0.25) - 1.0).abs() < 1e-5);
        assert!((at(Wrap::Mirror, 1.25) - 1.0).abs() < 1e-5 && (at(Wrap::Mirror, -0.25) - 0.0).abs() < 1e-5);
        assert!((at(Wrap::Clamp, 5.0) - 1.0).abs() < 1e-5 && (at(Wrap::Clamp, -5.0) - 0.0).abs() < 1e-5);
        for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
            for u in [1e30, -1e30, f32::MAX, f32::NAN] {
                assert!((0.0..=3.0).contains(&at(wrap, u)) || u.is_nan(), "{wrap:?} {u}");
            }
        }
    }

    #[test]
    fn srgb_is_decoded_before_the_mean_is_taken() {
        let image = Image { size: [2, 1], texels: vec![0xff00_0000, 0x8000_00ff] };
        let t = Textures::new(vec![image], &[TextureUse::of(0, true)]);
        let v = t.value(0, Vec2::new(0.5, 0.5));
        assert!((v.x - 0.5).abs() < 1e-6 && (v.w - (255.0 + 128.0) / 510.0).abs() < 1e-6, "{v}");
        assert!((LINEAR[188] - 0.502_886_5).abs() < 1e-6 && LINEAR[0] == 0.0 && LINEAR[255] == 1.0);
    }

    #[test]
    fn the_largest_value_bounds_every_value() {
        let image = || Image { size: [8, 4], texels: (0..32u32).map(|i| i.wrapping_mul(2_654_435_761) >> 8).collect() };
        for (i, wrap) in (0..600u32).zip([Wrap::Repeat, Wrap::Mirror, Wrap::Clamp].into_iter().cycle()) {
            let t = Textures::new(vec![image()], &[TextureUse { wrap: [wrap, Wrap::Mirror], ..TextureUse::of(0, true) }]);
            let r = |k: u32| ((i * 7 + k) as f32 * 0.618_034).fract() * 5.0 - 2.0;
            let corners = [Vec2::new(r(1), r(2)), Vec2::new(r(3), r(4)), Vec2::new(r(5), r(6))];
            let bound = t.largest(0, corners);
            for j in 0..50 {
                let (a, b) = ((j as f32 * 0.754_877_7).fract(), (j as f32 * 0.569_840_3).fract());
                let (a, b) = if a + b > 1.0 { (1.0 - a, 1.0 - b) } else { (a, b) };
                let value = t.value(0, corners[0] * (1.0 - a - b) + corners[1] * a + corners[2] * b);
                assert!(value.cmple(bound + 1e-6).all(), "{value} {bound}");
            }
        }
    }
}
