//! Materials as Mitsuba's BSDFs. Inside out: the surface seen from its front, `normalmap`, `twosided`, `mask`.
//!
//! With plugins, rough metal, coats and whatever has shading normals are `gltf_surface`, which comes with normals and both sides.

use super::Writing;
use super::mesh::{Group, textures};
use super::pictures::{Lookup, Wanted};
use super::xml::Element;
use crate::math::Vec3;
use crate::scene::material::{CONDUCTOR, DIELECTRIC, LAMBERT, MIRROR, THIN_DIELECTRIC, TRANSPARENT, UNLIT};
use crate::scene::texture::{NEAREST, SET_1};
use crate::scene::{Material, NONE};
use glam::Vec4;

/// How much finer the picture of holes is than the texture whose interpolated alpha makes them, and its longest side.
const FINER: u32 = 8;
const LONGEST: u32 = 8192;
/// What to do where Mitsuba lacks something.
const WITH_PLUGINS: &str = "add --plugins, which brings what it lacks";

/// A number or a colour that a texture, the vertices or both may vary.
enum Value {
    Number(f32),
    Color(Vec3),
    Texture(Element),
}

impl Value {
    /// The BSDF with this as its property.
    fn of(self, element: Element, name: &str) -> Element {
        match self {
            Self::Number(value) => element.property("float", name, value),
            Self::Color(value) => element.rgb(name, value),
            Self::Texture(texture) => element.child(texture.named(name)),
        }
    }
}

impl Writing<'_> {
    /// How a group scatters.
    ///
    /// # Errors
    /// A sentence without its subject, if Mitsuba cannot show it.
    pub fn bsdf(&mut self, group: &Group<'_>) -> Result<Element, String> {
        let material = group.material();
        let second = |texture: u32| self.scene.textures.list[texture as usize].flags & SET_1 != 0;
        let sets: Vec<bool> = textures(material).map(second).collect();
        if sets.contains(&true) && sets.contains(&false) {
            return Err("its textures are on two sets of coordinates, and Mitsuba's meshes have one".into());
        }
        if !textures(material).all(|_| group.mesh_uv.determinant() != 0.0) {
            return Err("the transform of its texture cannot be inverted".into());
        }
        let scattering = self.scattering(group, material)?;
        if !material.has(TRANSPARENT) {
            return Ok(scattering);
        }
        self.lets_through = true;
        Ok(self.opacity(group, material)?.of(Element::plugin("bsdf", "mask"), "opacity").child(scattering))
    }

    /// Does the mesh of a group need tangents?
    pub fn uses_tangents(&self, group: &Group<'_>) -> bool {
        group.material().normal_texture != NONE && self.is_ours(group)
    }

    /// Is it shown by our own formulas?
    fn is_ours(&self, group: &Group<'_>) -> bool {
        let material = group.material();
        let plain = material.kind == LAMBERT && !group.key.smooth && !group.other_tangents();
        self.plugins && !material.is_dirac() && !material.has(UNLIT) && !plain
    }

    fn scattering(&mut self, group: &Group<'_>, material: &Material) -> Result<Element, String> {
        if material.has(UNLIT) {
            return Ok(Element::plugin("bsdf", "diffuse").rgb("reflectance", Vec3::ZERO));
        }
        if self.is_ours(group) {
            return self.ours(group, material);
        }
        if group.key.smooth {
            self.remark(
                "Mitsuba does not ask the faces' normals on which side of a surface a direction lies, so these are only near",
                group.name(),
            );
        }
        if group.other_tangents() {
            self.remark("Mitsuba takes a normal map's tangents from the texture coordinates, and the file has others", group.name());
        }
        let color = self.color(group, material)?;
        let front = match material.kind {
            LAMBERT => color.of(Element::plugin("bsdf", "diffuse"), "reflectance"),
            MIRROR => self.mirror(group, color),
            kind @ (DIELECTRIC | THIN_DIELECTRIC) => {
                if material.normal_texture != NONE {
                    return Err("it is clear glass with a normal map".into());
                }
                let glass = Element::plugin("bsdf", if kind == DIELECTRIC { "dielectric" } else { "thindielectric" });
                let glass = glass.property("float", "int_ior", material.ior).property("float", "ext_ior", 1);
                return Ok(color.of(glass, "specular_transmittance"));
            }
            _ => {
                let remark = "Rough metal and coats are Mitsuba's `principled`, another model of the same numbers, so these are only near (--plugins: ours)";
                self.remark(remark, group.name());
                let surface = color.of(Element::plugin("bsdf", "principled"), "base_color");
                let root = material.f0.max_element().min(0.99).sqrt();
                // At 1 Mitsuba leaves the metal out too.
                let eta = ((1.0 + root) / (1.0 - root)).max(1.001);
                self.metallic_roughness(group, material, surface)?.property("float", "eta", eta)
            }
        };
        self.two_sided(group, material, &front)
    }

    /// A mirror: Mitsuba's Fresnel term of an index n − ik that is much like Schlick's.
    fn mirror(&mut self, group: &Group<'_>, color: Value) -> Element {
        let mirror = Element::plugin("bsdf", "conductor");
        match color {
            Value::Color(f0) if f0 == Vec3::ONE => mirror.property("string", "material", "none"),
            Value::Color(f0) => {
                self.remark(
                    "Mitsuba's mirrors have another Fresnel term, near ours (F₀ of 0.7 and more: to 0.4 %, of 0.3: 3 %)",
                    group.name(),
                );
                let [r, g, b] = f0.to_array().map(index);
                mirror.rgb("eta", Vec3::new(r[0], g[0], b[0])).rgb("k", Vec3::new(r[1], g[1], b[1]))
            }
            texture => {
                self.remark("Mitsuba's mirrors with textures or colours at the vertices reflect F₀ at every angle", group.name());
                texture.of(mirror.property("string", "material", "none"), "specular_reflectance")
            }
        }
    }

    /// The base colour.
    fn color(&mut self, group: &Group<'_>, material: &Material) -> Result<Value, String> {
        let vertices = Element::plugin("texture", "mesh_attribute").property("string", "name", "vertex_color");
        // The factor is in the vertices' colours where there are any.
        let factor = if group.key.colored { Vec3::ONE } else { material.color };
        if material.base_color_texture == NONE {
            return Ok(if group.key.colored { Value::Texture(vertices) } else { Value::Color(material.color) });
        }
        let wanted = Wanted { purpose: "color", of: &|texel: Vec4| texel.truncate() * factor, grey: false, finer: 0 };
        let texture = self.look_up(group, material.base_color_texture, &wanted)?;
        if group.key.colored { self.product(texture, vertices, "its colours") } else { Ok(Value::Texture(texture)) }
    }

    /// a.
    fn opacity(&mut self, group: &Group<'_>, material: &Material) -> Result<Value, String> {
        let vertices = Element::plugin("texture", "mesh_attribute").property("string", "name", "vertex_alpha");
        let (texture, colored, cutoff) = (material.base_color_texture, group.key.colored, material.cutoff);
        let factor = if colored { 1.0 } else { material.opacity };
        let hole = |a: f32| if cutoff < 0.0 { a.clamp(0.0, 1.0) } else { f32::from(u8::from(a >= cutoff)) };
        if texture == NONE && !colored {
            return Ok(Value::Number(hole(material.opacity)));
        }
        if texture != NONE && !colored && cutoff >= 0.0 && !self.plugins {
            let own = &self.scene.textures.list[texture as usize];
            let sharp = own.flags & NEAREST != 0;
            let finer = if sharp { 1 } else { FINER.min(LONGEST / own.width.max(own.height)).max(1) };
            if !sharp {
                self.remark(
                    "The holes of these are a picture with up to eight times the texels in Mitsuba (--plugins: exact)",
                    group.name(),
                );
            }
            let wanted = Wanted { purpose: "holes", of: &|texel: Vec4| Vec3::splat(hole(texel.w * factor)), grey: true, finer };
            return Ok(Value::Texture(self.look_up(group, texture, &wanted)?));
        }
        let mut value = Value::Texture(vertices);
        if texture != NONE {
            let wanted = Wanted { purpose: "alpha", of: &|texel: Vec4| Vec3::splat(texel.w * factor), grey: true, finer: 0 };
            let looked_up = self.look_up(group, texture, &wanted)?;
            value = match value {
                Value::Texture(vertices) if colored => self.product(looked_up, vertices, "its alpha")?,
                _ => Value::Texture(looked_up),
            };
        }
        match value {
            Value::Texture(nested) if cutoff >= 0.0 => {
                if !self.plugins {
                    return Err(format!("its holes depend on colours at the vertices; {WITH_PLUGINS}"));
                }
                self.uses_plugins = true;
                Ok(Value::Texture(
                    Element::plugin("texture", "gltf_cutoff").property("float", "cutoff", cutoff).child(nested.named("nested")),
                ))
            }
            value => Ok(value),
        }
    }

    /// The product of two textures.
    fn product(&mut self, first: Element, second: Element, what: &str) -> Result<Value, String> {
        if !self.plugins {
            return Err(format!("{what} are a texture times colours at the vertices; {WITH_PLUGINS}"));
        }
        self.uses_plugins = true;
        Ok(Value::Texture(Element::plugin("texture", "gltf_product").child(first.named("first")).child(second.named("second"))))
    }

    /// A texture on a group.
    pub fn look_up(&mut self, group: &Group<'_>, texture: u32, wanted: &Wanted<'_>) -> Result<Element, String> {
        self.bitmap(texture, wanted, &Lookup { uvs: &group.uvs, mesh: group.mesh_uv })
    }

    /// The surface with its metallic share and roughness; of all these models α is roughness².
    fn metallic_roughness(&mut self, group: &Group<'_>, material: &Material, mut surface: Element) -> Result<Element, String> {
        let metallic = if material.kind == CONDUCTOR { 1.0 } else { material.metallic };
        let parts = [("roughness", material.roughness, 1), ("metallic", metallic, 2)];
        for (name, factor, channel) in parts {
            let value = match material.metallic_roughness_texture {
                NONE => Value::Number(factor),
                texture => {
                    let wanted = Wanted { purpose: name, of: &|texel: Vec4| Vec3::splat(texel[channel] * factor), grey: true, finer: 0 };
                    Value::Texture(self.look_up(group, texture, &wanted)?)
                }
            };
            surface = value.of(surface, name);
        }
        Ok(surface)
    }

    /// Our own formulas.
    fn ours(&mut self, group: &Group<'_>, material: &Material) -> Result<Element, String> {
        self.uses_plugins = true;
        let surface = self.color(group, material)?.of(Element::plugin("bsdf", "gltf_surface"), "color");
        let surface = self.metallic_roughness(group, material, surface)?.rgb("f0", material.f0).property("float", "f90", material.f90);
        if material.normal_texture == NONE { Ok(surface) } else { Ok(surface.child(self.normals(group, material, 1.0)?.named("normals"))) }
    }

    /// The normal map, scaled, its green along n × t; turned around but for z if `side` is −1.
    fn normals(&mut self, group: &Group<'_>, material: &Material, side: f32) -> Result<Element, String> {
        let scale = side * material.normal_scale;
        let turn = Vec3::new(scale, if group.key.mirrored { -scale } else { scale }, 1.0);
        let of = |texel: Vec4| (texel.truncate() - 0.5) * turn + 0.5;
        let purpose = if side > 0.0 { "normals" } else { "normals-back" };
        self.look_up(group, material.normal_texture, &Wanted { purpose, of: &of, grey: false, finer: 0 })
    }

    /// Mitsuba's surfaces reflect on their front only, ours on both sides. From behind, our normal is turned around; in `twosided` it is
    /// mirrored at the surface. So the back gets a map of its own, and neither Mitsuba's remedies for normals that face away.
    fn two_sided(&mut self, group: &Group<'_>, material: &Material, front: &Element) -> Result<Element, String> {
        let both = Element::plugin("bsdf", "twosided");
        if material.normal_texture == NONE {
            return Ok(both.child(front.clone()));
        }
        let mut side = |name: &str, side: f32| -> Result<Element, String> {
            let map = self.normals(group, material, side)?.named("normalmap");
            let bare = Element::plugin("bsdf", "normalmap").named(name).child(map).child(front.clone());
            Ok(bare.property("boolean", "flip_invalid_normals", false).property("boolean", "use_shadowing_function", false))
        };
        Ok(both.child(side("a_front", 1.0)?).child(side("b_back", -1.0)?))
    }
}

/// n and k of a conductor that reflects `f0` at normal incidence and about F₀ + (1 − F₀)(1 − cosθ)⁵ elsewhere.
fn index(f0: f32) -> [f32; 2] {
    let a = (1.0 + f0) / (1.0 - f0).max(1e-6);
    // F₀ = ((n − 1)² + k²)/((n + 1)² + k²) has two solutions n; this k fits best.
    let k = (0.95 * (a * a - 1.0).sqrt()).min(2.3);
    [(1.0 + k * k) / (a + (a * a - 1.0 - k * k).sqrt()), k]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fresnel's equations for n − ik, unpolarised.
    fn fresnel([n, k]: [f32; 2], cos: f32) -> f32 {
        let (c2, s2) = (cos * cos, 1.0 - cos * cos);
        let t = n * n - k * k - s2;
        let root = (t * t + 4.0 * n * n * k * k).sqrt();
        let a = (0.5 * (root + t)).max(0.0).sqrt();
        let s = (root + c2 - 2.0 * cos * a) / (root + c2 + 2.0 * cos * a);
        let p = s * (c2 * root + s2 * s2 - 2.0 * cos * a * s2) / (c2 * root + s2 * s2 + 2.0 * cos * a * s2);
        0.5 * (s + p)
    }

    #[test]
    fn a_mirrors_index_reflects_about_what_schlick_says() {
        for (f0, most) in [(0.3f32, 0.05), (0.5, 0.045), (0.7, 0.005), (0.8, 0.005), (0.93, 0.005), (0.99, 0.005), (1.0, 1e-4)] {
            for degrees in 0..90 {
                let cos = (degrees as f32).to_radians().cos();
                let off = fresnel(index(f0), cos) - (f0 + (1.0 - f0) * (1.0 - cos).powi(5));
                assert!(off.abs() < most, "{f0} at {degrees}°: {off}");
            }
        }
    }
}
