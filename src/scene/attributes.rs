//! What a triangle may have beyond its corners: shading normals, tangents, texture coordinates, colours.
//!
//! Each kind is a flat array; a triangle names its entries through one record, and a flat grey triangle has none at all.

use super::NONE;
use super::parts::{PartAttributes, PartTriangle};
use crate::math::{Vec2, Vec3};
use crate::shared_struct;
use glam::Vec4;

shared_struct! {
    /// Where a triangle's entries are in the flat arrays; [`NONE`] where it has none.
    pub struct Attributes {
        /// Index into [`Arrays::normals`].
        pub normals: u32,
        /// Index into [`Arrays::tangents`].
        pub tangents: u32,
        /// Index of texture coordinate set 0 in [`Arrays::uvs`].
        pub uvs_0: u32,
        /// Index of texture coordinate set 1 in [`Arrays::uvs`].
        pub uvs_1: u32,
        /// Index into [`Arrays::colors`].
        pub colors: u32,
        /// Padding.
        pub _pad0: u32,
        /// Padding.
        pub _pad1: u32,
        /// Padding.
        pub _pad2: u32,
    }
}

impl Attributes {
    /// Nothing beyond the corners.
    pub const PLAIN: Self = Self { normals: NONE, tangents: NONE, uvs_0: NONE, uvs_1: NONE, colors: NONE, _pad0: 0, _pad1: 0, _pad2: 0 };
}

shared_struct! {
    /// The shading normals at a triangle's corners: unit vectors on the geometric normal's side.
    pub struct Normals {
        /// At p0.
        pub n0: Vec3,
        /// Padding.
        pub _pad0: u32,
        /// At p1.
        pub n1: Vec3,
        /// Padding.
        pub _pad1: u32,
        /// At p2.
        pub n2: Vec3,
        /// Padding.
        pub _pad2: u32,
    }
}

shared_struct! {
    /// The tangents at a triangle's corners: the direction in which a normal map's x points, of any length.
    pub struct Tangents {
        /// At p0.
        pub t0: Vec3,
        /// ±1: the bitangent (the map's y) is `sign` · n × t.
        pub sign: f32,
        /// At p1.
        pub t1: Vec3,
        /// Padding.
        pub _pad0: u32,
        /// At p2.
        pub t2: Vec3,
        /// Padding.
        pub _pad1: u32,
    }
}

shared_struct! {
    /// Texture coordinates at a triangle's corners; v points down.
    pub struct Uvs {
        /// At p0.
        pub uv0: Vec2,
        /// At p1.
        pub uv1: Vec2,
        /// At p2.
        pub uv2: Vec2,
    }
}

shared_struct! {
    /// Linear colours at a triangle's corners; they multiply the base colour, alpha included.
    pub struct Colors {
        /// At p0.
        pub c0: Vec4,
        /// At p1.
        pub c1: Vec4,
        /// At p2.
        pub c2: Vec4,
    }
}

/// All triangles' attributes.
#[derive(Debug, Default)]
pub struct Arrays {
    /// One for each triangle that has any.
    pub list: Vec<Attributes>,
    /// Shading normals.
    pub normals: Vec<Normals>,
    /// Tangents.
    pub tangents: Vec<Tangents>,
    /// Texture coordinates of both sets.
    pub uvs: Vec<Uvs>,
    /// Colours.
    pub colors: Vec<Colors>,
}

impl Arrays {
    /// Bytes of all arrays.
    pub fn bytes(&self) -> usize {
        let Self { list, normals, tangents, uvs, colors } = self;
        size_of_val(&list[..]) + size_of_val(&normals[..]) + size_of_val(&tangents[..]) + size_of_val(&uvs[..]) + size_of_val(&colors[..])
    }
}

/// The value at barycentric coordinates (b1, b2) of what is b0 a + b1 b + b2 c.
macro_rules! interpolate {
    ($b:expr, $a:expr, $b1:expr, $c:expr) => {
        $a * (1.0 - $b.x - $b.y) + $b1 * $b.x + $c * $b.y
    };
}

impl Normals {
    /// The unit normal at barycentric coordinates (b1, b2).
    #[inline]
    pub fn at(&self, b: Vec2) -> Vec3 {
        interpolate!(b, self.n0, self.n1, self.n2).normalize()
    }
}

impl Tangents {
    /// The tangent, of any length, and the bitangent's sign.
    #[inline]
    pub fn at(&self, b: Vec2) -> (Vec3, f32) {
        (interpolate!(b, self.t0, self.t1, self.t2), self.sign)
    }
}

impl Uvs {
    /// The texture coordinates.
    #[inline]
    pub fn at(&self, b: Vec2) -> Vec2 {
        interpolate!(b, self.uv0, self.uv1, self.uv2)
    }
}

impl Colors {
    /// The colour.
    #[inline]
    pub fn at(&self, b: Vec2) -> Vec4 {
        interpolate!(b, self.c0, self.c1, self.c2)
    }
}

impl Arrays {
    /// Adds what a triangle has beyond its corners; its index in the list, [`NONE`] if that is nothing.
    pub(super) fn add(&mut self, part: &PartTriangle, n_g: Vec3, own: Option<&PartAttributes>) -> u32 {
        let mut entry = Attributes::PLAIN;
        let sides = part.normals.map(|n| shading_normals(n, n_g, part));
        if let Some((corners, true, _)) = sides {
            entry.normals = push(&mut self.normals, corners);
        }
        if let Some(own) = own {
            let uvs = own.uvs.map(|set| set.map_or(NONE, |[uv0, uv1, uv2]| push(&mut self.uvs, Uvs { uv0, uv1, uv2 })));
            [entry.uvs_0, entry.uvs_1] = uvs;
            entry.colors = own.colors.map_or(NONE, |[c0, c1, c2]| push(&mut self.colors, Colors { c0, c1, c2 }));
            if let (Some([t0, t1, t2]), Some((_, _, turned))) = (own.tangents, sides) {
                // A normal that went to the other side takes the bitangent along.
                let sign = if turned { -t0.w } else { t0.w };
                let [t0, t1, t2] = [t0, t1, t2].map(Vec4::truncate);
                entry.tangents = push(&mut self.tangents, Tangents { t0, sign: 1.0f32.copysign(sign), t1, _pad0: 0, t2, _pad1: 0 });
            }
        }
        if entry == Attributes::PLAIN { NONE } else { push(&mut self.list, entry) }
    }
}

/// Appends an item; its index.
fn push<T>(list: &mut Vec<T>, item: T) -> u32 {
    list.push(item);
    list.len() as u32 - 1
}

/// The corners' normals, unit and on the side of `n_g`; whether any differs from the geometric normal; whether the first one
/// had to be turned around.
fn shading_normals(corners: [Vec3; 3], n_g: Vec3, part: &PartTriangle) -> (Normals, bool, bool) {
    /// Deviations below this (radians) are the file's rounding, not a wish.
    const SAME: f32 = 5e-6;
    let [p0, p1, p2] = part.corners;
    let exact = (p1 - p0).cross(p2 - p0).normalize().as_vec3();
    let turned = corners[0].dot(n_g) < 0.0;
    let mut differs = false;
    let [n0, n1, n2] = corners.map(|n| {
        let n = n.try_normalize().unwrap_or(n_g);
        let cos = n.dot(n_g);
        // A normal in the triangle's own plane belongs to no side.
        let n = if cos.abs() < 1e-4 { n_g } else { n * cos.signum() };
        differs |= (n - exact).length() > SAME && n != n_g;
        n
    });
    (Normals { n0, _pad0: 0, n1, _pad1: 0, n2, _pad2: 0 }, differs, turned)
}
