//! A point on a surface: where it is, its two normals, and what its material looks like just there.
//!
//! ```text
//! colour    = base colour · texture · vertex colour         roughness, metallic = factor · texture (green, blue)
//! n_s       = normalize(x t + y b + z n)    (x, y, z) = normalize((2 texel − 1) · (scale, scale, 1)),  b = sign · n × t
//! a (alpha) = base alpha · texture · vertex alpha;   MASK: 0 below the cutoff, else 1
//! ```

use super::attributes::Attributes;
use super::material::{COAT, TRANSPARENT, UNLIT, VARIES};
use super::texture::SET_1;
use super::{Hit, Material, NONE, Scene, Shape};
use crate::math::{Vec2, Vec3};
use crate::shared_struct;
use glam::Vec4;

shared_struct! {
    /// A material's numbers at a point, textures looked up.
    pub struct Look {
        /// Base colour.
        pub color: Vec3,
        /// Roughness.
        pub roughness: f32,
        /// Share of the conductor.
        pub metallic: f32,
        /// a, the probability that the surface is there, in [0, 1].
        pub opacity: f32,
        /// Barycentric coordinates of p1 and p2 of its triangle.
        pub barycentric: Vec2,
    }
}

impl Look {
    /// What a material looks like where nothing varies it.
    #[inline]
    pub fn of(material: &Material) -> Self {
        Self { color: material.color, roughness: material.roughness, metallic: material.metallic, opacity: 1.0, barycentric: Vec2::ZERO }
    }

    /// Of what is no surface.
    pub const NOTHING: Self = Self { color: Vec3::ZERO, roughness: 0.0, metallic: 0.0, opacity: 1.0, barycentric: Vec2::ZERO };
}

/// A point on a surface, with everything scattering and emission need.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// Position, m, relative to the scene's origin.
    pub position: Vec3,
    /// Geometric normal (unit, front side).
    pub n_g: Vec3,
    /// Shading normal (unit, on the same side as `n_g`).
    pub n_s: Vec3,
    /// Bound on the error of each coordinate of `position`, m.
    pub error: f32,
    /// The triangle hit.
    pub triangle: u32,
    /// Its material.
    pub material: u32,
    /// Its light, or [`NONE`].
    pub light: u32,
    /// What the material looks like here.
    pub look: Look,
}

/// Least cosine between a normal that a map made and the geometric one.
const MIN_COS: f32 = 1e-3;

impl Scene {
    /// The surface point of a hit.
    #[inline]
    pub fn surface_point(&self, hit: &Hit) -> SurfacePoint {
        self.surface_point_as::<super::General>(hit.triangle, Vec2::new(hit.b1, hit.b2))
    }

    /// The surface point at barycentric coordinates (b1, b2) of a triangle.
    #[inline]
    pub fn point_on_triangle(&self, triangle: u32, b: Vec2) -> SurfacePoint {
        self.surface_point_as::<super::General>(triangle, b)
    }

    /// The surface point at barycentric coordinates (b1, b2) of a triangle; its position comes from the corners, not from a
    /// ray, and its error bound is that of the three-term sum (PBRT 6.8.4: γ₇ Σ|bᵢ pᵢ|).
    #[inline(always)]
    pub fn surface_point_as<F: Shape>(&self, triangle: u32, b: Vec2) -> SurfacePoint {
        const GAMMA_9: f32 = 9.0 * 0.5 * f32::EPSILON / (1.0 - 9.0 * 0.5 * f32::EPSILON);
        let tri = &self.triangles[triangle as usize];
        let (q0, q1, q2) = (tri.p0 * (1.0 - b.x - b.y), tri.p1 * b.x, tri.p2 * b.y);
        let n_g = (tri.p1 - tri.p0).cross(tri.p2 - tri.p0).normalize();
        let material = &self.materials[tri.material as usize];
        let mut point = SurfacePoint {
            position: q0 + q1 + q2,
            n_g,
            n_s: n_g,
            error: GAMMA_9 * (q0.abs() + q1.abs() + q2.abs()).max_element(),
            triangle,
            material: tri.material,
            light: tri.light,
            look: Look { barycentric: b, ..Look::of(material) },
        };
        if tri.attributes != NONE {
            let attributes = &self.attributes.list[tri.attributes as usize];
            if attributes.normals != NONE {
                point.n_s = self.attributes.normals[attributes.normals as usize].at(b);
            }
            if F::TEXTURES && material.has(VARIES) {
                self.look_up(&mut point, material, attributes);
            }
        }
        if F::ALPHA && material.has(TRANSPARENT) {
            point.look.opacity = self.opacity_at(material, tri.attributes, b);
        }
        point
    }

    /// Looks up what varies: colour, roughness, metallic share, normal.
    #[inline(never)]
    fn look_up(&self, point: &mut SurfacePoint, material: &Material, attributes: &Attributes) {
        let b = point.look.barycentric;
        point.look.color *= self.base_color(material, attributes, b).truncate();
        if material.metallic_roughness_texture != NONE {
            let value = self.texture(material.metallic_roughness_texture, attributes, b);
            point.look.roughness *= value.y;
            point.look.metallic = if material.kind == COAT { point.look.metallic * value.z } else { point.look.metallic };
        }
        if material.normal_texture != NONE {
            point.n_s = self.mapped_normal(point, material, attributes);
        }
    }

    /// Texture times vertex colour: what multiplies the base colour and alpha.
    #[inline]
    fn base_color(&self, material: &Material, attributes: &Attributes, b: Vec2) -> Vec4 {
        let textured = match material.base_color_texture {
            NONE => Vec4::ONE,
            texture => self.texture(texture, attributes, b),
        };
        match attributes.colors {
            NONE => textured,
            colors => textured * self.attributes.colors[colors as usize].at(b),
        }
    }

    /// A texture's value at a point of a triangle; without its texture coordinates, as at (0, 0).
    #[inline]
    pub fn texture(&self, texture: u32, attributes: &Attributes, b: Vec2) -> Vec4 {
        let set = if self.textures.list[texture as usize].flags & SET_1 != 0 { attributes.uvs_1 } else { attributes.uvs_0 };
        let uv = if set == NONE { Vec2::ZERO } else { self.attributes.uvs[set as usize].at(b) };
        self.textures.value(texture, uv)
    }

    /// The normal that a normal map makes of the interpolated one; on the geometric normal's side.
    fn mapped_normal(&self, point: &SurfacePoint, material: &Material, attributes: &Attributes) -> Vec3 {
        let (n, b) = (point.n_s, point.look.barycentric);
        let Some((t, sign)) = self.tangent(point, material, attributes) else { return n };
        let texel = self.texture(material.normal_texture, attributes, b).truncate() * 2.0 - 1.0;
        let Some(local) = (texel * Vec3::new(material.normal_scale, material.normal_scale, 1.0)).try_normalize() else { return n };
        let Some(t) = (t - n * n.dot(t)).try_normalize() else { return n };
        let mapped = t * local.x + n.cross(t) * (sign * local.y) + n * local.z;
        // A map may turn a normal to the back of its surface: it is stopped just before.
        let cos = mapped.dot(point.n_g);
        (mapped + point.n_g * (MIN_COS - cos).max(0.0)).try_normalize().unwrap_or(n)
    }

    /// The direction of a normal map's x and the sign of its y: the file's, or that of the texture coordinates.
    fn tangent(&self, point: &SurfacePoint, material: &Material, attributes: &Attributes) -> Option<(Vec3, f32)> {
        if attributes.tangents != NONE {
            return Some(self.attributes.tangents[attributes.tangents as usize].at(point.look.barycentric));
        }
        let texture = &self.textures.list[material.normal_texture as usize];
        let second = texture.flags & SET_1 != 0;
        let uvs = self.attributes.uvs.get(if second { attributes.uvs_1 } else { attributes.uvs_0 } as usize)?;
        let tri = &self.triangles[point.triangle as usize];
        let (e1, e2) = (tri.p1 - tri.p0, tri.p2 - tri.p0);
        // The coordinates as the texture is met: a map that is turned takes its axes along.
        let turned = |d: Vec2| Vec2::new(texture.row_u.truncate().dot(d), texture.row_v.truncate().dot(d));
        let (d1, d2) = (turned(uvs.uv1 - uvs.uv0), turned(uvs.uv2 - uvs.uv0));
        let det = d1.perp_dot(d2);
        // ∂p/∂u times |det|. v points down, so the map's y is −∂p/∂v: where u and v are not mirrored, n × t.
        let t = (e1 * d2.y - e2 * d1.y) * 1.0f32.copysign(det);
        (det != 0.0).then_some((t, 1.0f32.copysign(-det)))
    }

    /// a at a point of a triangle whose material may be transparent.
    #[inline(never)]
    pub(super) fn opacity_at(&self, material: &Material, attributes: u32, b: Vec2) -> f32 {
        let varies = match attributes {
            NONE => 1.0,
            index => self.base_color(material, &self.attributes.list[index as usize], b).w,
        };
        let a = (material.opacity * varies).clamp(0.0, 1.0);
        if material.cutoff < 0.0 { a } else { f32::from(u8::from(a >= material.cutoff)) }
    }

    /// What multiplies a light's radiance at a point of its triangle: the emissive texture.
    #[inline]
    pub fn emission_factor<F: Shape>(&self, triangle: u32, material: u32, b: Vec2) -> Vec3 {
        let material = &self.materials[material as usize];
        if !F::TEXTURES || (material.emissive_texture == NONE && !material.has(UNLIT)) {
            return Vec3::ONE;
        }
        let Some(attributes) = self.attributes.list.get(self.triangles[triangle as usize].attributes as usize) else { return Vec3::ONE };
        let textured = match material.emissive_texture {
            NONE => Vec4::ONE,
            texture => self.texture(texture, attributes, b),
        };
        let colors = if material.has(UNLIT) { self.attributes.colors.get(attributes.colors as usize) } else { None };
        colors.map_or(textured, |colors| textured * colors.at(b)).truncate()
    }
}
