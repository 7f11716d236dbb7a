//! Textures as Mitsuba's `bitmap`: the texels a material uses, decoded and multiplied by its factors, as an EXR of 32-bit floats.
//!
//! Both programs put the centre of texel (i, j) at ((i + ½)/W, (j + ½)/H) with v downwards, and interpolate linear values
//! bilinearly. Mitsuba has one wrap mode for both axes: where ours differ, it gets a picture of all the tiles in use.

use super::Writing;
use super::xml::Element;
use crate::film::save::{Layer, Window, exr_bytes, exr_grey_bytes};
use crate::math::{DMat3, DVec3, Vec2, Vec3};
use crate::scene::texture::{NEAREST, Texture, WRAP_U, WRAP_V, Wrap};
use glam::Vec4;

/// The most texels of a picture that repeats what was one texture.
const MOST_TILED: f32 = (1u32 << 26) as f32;

/// What a picture is to hold.
pub struct Wanted<'a> {
    /// What it is for, in a file's name: "color".
    pub purpose: &'static str,
    /// What becomes of a texel.
    pub of: &'a dyn Fn(Vec4) -> Vec3,
    /// Only the first of these numbers.
    pub grey: bool,
    /// Every texel as so many by so many, and each of those sharp; 0: just as they are.
    pub finer: u32,
}

/// Where a texture is looked up.
pub struct Lookup<'a> {
    /// Coordinates in use, of triangles, as the scene has them.
    pub uvs: &'a [[Vec2; 3]],
    /// From the scene's texture coordinates to those the mesh is written with.
    pub mesh: DMat3,
}

impl Writing<'_> {
    /// The `texture` element for one of the scene's textures.
    ///
    /// # Errors
    /// A sentence without its subject, if Mitsuba has no such texture.
    pub fn bitmap(&mut self, texture: u32, wanted: &Wanted, lookup: &Lookup) -> Result<Element, String> {
        let own = self.scene.textures.list[texture as usize];
        let [mut columns, mut rows] = [0..i64::from(own.width), 0..i64::from(own.height)];
        let mut transform = matrix(&own);
        let mut wrap = mode(&own, WRAP_U);
        if wrap != mode(&own, WRAP_V) {
            let (low, high) = tiles(&own, lookup.uvs);
            if (high - low).element_product() * (own.width * own.height) as f32 > MOST_TILED {
                return Err("its texture has different wrap modes over too many tiles; bake it into one picture".into());
            }
            let range = |axis: usize, n: u32| low[axis] as i64 * i64::from(n)..high[axis] as i64 * i64::from(n);
            (columns, rows) = (range(0, own.width), range(1, own.height));
            let shrink = DVec3::new(f64::from((high - low).x), f64::from((high - low).y), 1.0).recip();
            let move_back = DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::new(f64::from(-low.x), f64::from(-low.y), 1.0));
            transform = DMat3::from_diagonal(shrink) * move_back * transform;
            wrap = Wrap::Clamp;
        }
        let values = |x: i64, y: i64, at: Vec2| {
            let corner = Vec2::new((columns.start + x) as f32, (rows.start + y) as f32);
            let texel = if wanted.finer == 0 { self.scene.textures.texel(&own, corner) } else { self.between(&own, corner + at) };
            (wanted.of)(texel)
        };
        let (size, picture) = picture([columns.end - columns.start, rows.end - rows.start], wanted.finer.max(1), &values);
        let bytes = if wanted.grey { exr_grey_bytes(size, picture.iter().map(|value| value.x).collect()) } else { rgb(size, &picture) }?;
        let file = self.file(&format!("textures/{texture}-{}", wanted.purpose), ".exr", bytes);
        let mode = ["repeat", "mirror", "clamp"][wrap as usize];
        let mut element = Element::plugin("texture", "bitmap").property("string", "filename", file).property("boolean", "raw", true);
        if wanted.finer > 0 || own.flags & NEAREST != 0 {
            element = element.property("string", "filter_type", "nearest");
        }
        element = element.property("string", "wrap_mode", mode);
        let from_mesh = transform * lookup.mesh.inverse();
        let same = from_mesh.abs_diff_eq(DMat3::IDENTITY, 1e-12);
        Ok(if same { element } else { element.uv_rows([from_mesh.row(0), from_mesh.row(1)]) })
    }

    /// The interpolated value at a place, in texels.
    fn between(&self, texture: &Texture, at: Vec2) -> Vec4 {
        if texture.flags & NEAREST != 0 {
            return self.scene.textures.texel(texture, at.floor());
        }
        let low = (at - 0.5).floor();
        let part = at - 0.5 - low;
        let texel = |x: f32, y: f32| self.scene.textures.texel(texture, low + Vec2::new(x, y));
        texel(0.0, 0.0).lerp(texel(1.0, 0.0), part.x).lerp(texel(0.0, 1.0).lerp(texel(1.0, 1.0), part.x), part.y)
    }
}

/// What takes texture coordinates to those of the texture.
pub fn matrix(texture: &Texture) -> DMat3 {
    let [u, v] = [texture.row_u, texture.row_v].map(|row| row.as_dvec3());
    DMat3::from_cols(u, v, DVec3::Z).transpose()
}

fn mode(texture: &Texture, axis: u32) -> Wrap {
    match texture.flags >> axis & 3 {
        1 => Wrap::Mirror,
        2 => Wrap::Clamp,
        _ => Wrap::Repeat,
    }
}

/// The first tile in use, and the one after the last; interpolation asks half a texel further.
fn tiles(texture: &Texture, uvs: &[[Vec2; 3]]) -> (Vec2, Vec2) {
    let size = Vec2::new(texture.width as f32, texture.height as f32);
    let places = || uvs.iter().flatten().map(|uv| texture.place(*uv));
    let low = places().reduce(Vec2::min).unwrap_or_default();
    let high = places().reduce(Vec2::max).unwrap_or_default();
    (((low - 0.5) / size).floor(), ((high + 0.5) / size).ceil())
}

/// The size and the values, row by row from the top, of a picture that has `finer`² of them for each texel: what there is in column
/// x and row y, at a place within the texel.
fn picture([width, height]: [i64; 2], finer: u32, values: &dyn Fn(i64, i64, Vec2) -> Vec3) -> ([u32; 2], Vec<Vec3>) {
    let finer = i64::from(finer);
    // Mitsuba wants two texels each way; a single one is the same as two alike.
    let [wide, high] = [width, height].map(|side| (side * finer).max(2));
    let part = |i: i64| ((i % finer) as f32 + 0.5) / finer as f32;
    let texel = |i: i64, side: i64| (i / finer).min(side - 1);
    let value = |x: i64, y: i64| values(texel(x, width), texel(y, height), Vec2::new(part(x), part(y)));
    let all = (0..high).flat_map(|y| (0..wide).map(move |x| (x, y))).map(|(x, y)| value(x, y)).collect();
    ([wide, high].map(|side| side as u32), all)
}

/// An EXR of colours.
pub fn rgb(size: [u32; 2], pixels: &[Vec3]) -> Result<Vec<u8>, String> {
    exr_bytes(Window::full(size), &[Layer { name: "", pixels }])
}
