//! What emits: lamps of triangles, lights of no extent, light from infinity.
//!
//! A spot's edge in Mitsuba falls off linearly in the angle, here as the square of a ramp in its cosine: where the edge is not hard,
//! the falloff is a picture that the spot projects. An environment is handed over on a lattice on which both interpolants agree.

use super::Writing;
use super::mesh::Group;
use super::pictures::{Wanted, rgb};
use super::view::looking;
use super::xml::Element;
use crate::math::{Frame, Vec3};
use crate::scene::light::{DIRECTIONAL, Light, POINT};
use crate::scene::material::{DIELECTRIC, THIN_DIELECTRIC, TRANSPARENT, UNLIT};
use crate::scene::{Environment, NONE};
use glam::Vec4;

/// A spot's edge is hard if it is narrower than this share of the angle.
const HARD_EDGE: f64 = 1e-3;
/// Texels along each side of the picture of a spot's soft edge.
const SPOT: u32 = 1024;
/// Widest spot whose picture still has texels to spare in its middle, degrees from the axis.
const WIDEST: f64 = 80.0;

impl Writing<'_> {
    /// What a group emits; nothing, if it is no lamp.
    ///
    /// # Errors
    /// A sentence without its subject, if Mitsuba has no such lamp.
    pub fn emitter(&mut self, group: &Group<'_>) -> Result<Option<Element>, String> {
        let (Some(radiance), material) = (group.key.lamp, group.material()) else { return Ok(None) };
        let transparent = material.has(TRANSPARENT);
        if material.two_sided == 1 && (transparent || matches!(material.kind, DIELECTRIC | THIN_DIELECTRIC)) {
            return Err("it emits on both sides and lets light through".into());
        }
        if transparent && (group.key.colored || material.base_color_texture != NONE) {
            return Err("it emits, and its alpha varies".into());
        }
        if material.has(UNLIT) && group.key.colored {
            return Err("it is unlit with colours at its vertices".into());
        }
        // What is there with probability a emits so much of its light; Mitsuba's lamps emit all of it.
        let there = if !transparent {
            1.0
        } else if material.cutoff < 0.0 {
            material.opacity
        } else {
            f32::from(u8::from(material.opacity >= material.cutoff))
        };
        let radiance = Vec3::from_array(radiance.map(f32::from_bits)) * there;
        let area = Element::plugin("emitter", "area");
        if material.emissive_texture == NONE {
            return Ok(Some(area.rgb("radiance", radiance)));
        }
        // Mitsuba draws points of the texture and looks for them on the mesh.
        let inside = |x: f32| (-1e-6..=1.0 + 1e-6).contains(&x);
        let corners = || group.mesh_uvs();
        let covered: f32 = corners().map(|[a, b, c]| 0.5 * (b - a).perp_dot(c - a).abs()).sum();
        if covered > 1.0 + 1e-6 || !corners().flatten().all(|uv| inside(uv.x) && inside(uv.y)) {
            return Err("it emits by a texture that repeats, and Mitsuba must find each texel once".into());
        }
        let wanted = Wanted { purpose: "radiance", of: &|texel: Vec4| texel.truncate() * radiance, grey: false, finer: 0 };
        Ok(Some(area.child(self.look_up(group, material.emissive_texture, &wanted)?.named("radiance"))))
    }

    /// The lights that no triangle carries.
    ///
    /// # Errors
    /// If a picture cannot be encoded.
    pub fn lights(&mut self) -> Result<Vec<Element>, String> {
        let scene = self.scene;
        let mut found = Vec::new();
        for (name, light) in scene.lights.dirac() {
            found.push(match light.kind {
                POINT => Element::plugin("emitter", "point").point("point", "position", light.position).rgb("intensity", light.radiance),
                DIRECTIONAL => {
                    Element::plugin("emitter", "directional").point("vector", "direction", light.axis).rgb("irradiance", light.radiance)
                }
                _ => self.spot(name, light)?,
            });
        }
        if let Some(environment) = &scene.lights.environment {
            found.push(self.environment(environment)?);
        }
        Ok(found)
    }

    fn spot(&mut self, name: &str, light: &Light) -> Result<Element, String> {
        // 1 − cos = 2 sin²(θ/2).
        let angle = |versine: f32| 2.0 * (0.5 * f64::from(versine)).sqrt().min(1.0).asin();
        let (inner, outer) = (angle(light.versine_inner), angle(light.versine_outer));
        let frame = Frame::around(light.axis);
        let spot = Element::plugin("emitter", "spot").placed(looking(light.axis, frame.y), light.position);
        let spot = spot.rgb("intensity", light.radiance);
        let soft = outer - inner > HARD_EDGE * outer;
        if soft && outer.to_degrees() <= WIDEST {
            self.remark("Mitsuba's spots have another soft edge, so it is a picture of 1024×1024 texels", name);
            let bytes = rgb([SPOT; 2], &falloff(light, outer))?;
            let file = self.file("textures/spot", ".exr", bytes);
            let picture = Element::plugin("texture", "bitmap").named("texture");
            let picture = picture.property("string", "filename", file).property("boolean", "raw", true);
            let degrees = outer.to_degrees();
            let spot = spot.property("float", "cutoff_angle", degrees).property("float", "beam_width", degrees * (1.0 - 1e-5));
            return Ok(spot.child(picture.property("string", "wrap_mode", "clamp")));
        }
        if soft {
            self.remark("The soft edge of these spots is only near in Mitsuba", name);
        }
        // Across the edge our factor is a square (mean 1/3), Mitsuba's is linear (mean 1/2): two thirds of the width carry the same.
        let edge = (outer - inner).max(1e-6 * outer);
        let degrees = |angle: f64| angle.to_degrees();
        Ok(spot.property("float", "beam_width", degrees(outer - edge)).property("float", "cutoff_angle", degrees(outer - edge / 3.0)))
    }

    /// Ours has texel centres at ((i + ½)/W, (j + ½)/H); Mitsuba's first and last rows lie at v = 0 and 1, its columns as ours. Our
    /// u = ½ is Mitsuba's u = 0: half a turn.
    fn environment(&mut self, map: &Environment) -> Result<Element, String> {
        if let [texel] = &map.texels[..] {
            return Ok(Element::plugin("emitter", "constant").rgb("radiance", texel.radiance));
        }
        // Mitsuba wants two columns.
        let (width, columns, rows) = (map.width as usize, map.width.max(2), 2 * map.height as usize + 1);
        let row = |y: usize| map.texels[y * width..][..width].iter().cycle().take(columns as usize);
        let between = |j: usize| {
            // Half a texel's steps from the upper edge.
            let clamp = |y: isize| y.clamp(0, map.height as isize - 1) as usize;
            let (above, below) = (clamp((j as isize - 1).div_euclid(2)), clamp((j as isize).div_euclid(2)));
            row(above).zip(row(below)).map(|(a, b)| 0.5 * (a.radiance + b.radiance)).collect::<Vec<_>>()
        };
        let pixels: Vec<Vec3> = (0..rows).flat_map(between).collect();
        let file = self.file("textures/environment", ".exr", rgb([columns, rows as u32], &pixels)?);
        let turn = Element::new("rotate").with("y", "1").with("angle", (180.0 + 360.0 * f64::from(map.rotation())).to_string());
        let map = Element::plugin("emitter", "envmap").property("string", "filename", file);
        Ok(map.child(Element::new("transform").named("to_world").child(turn)))
    }
}

/// A spot's falloff on the square of tangents that its cone fits into.
fn falloff(light: &Light, outer: f64) -> Vec<Vec3> {
    let tangent = |i: u32| outer.tan() * (2.0 * (f64::from(i) + 0.5) / f64::from(SPOT) - 1.0);
    let value = |x: u32, y: u32| {
        let square = tangent(x).powi(2) + tangent(y).powi(2);
        // 1 − 1/√(1 + t²), where t is small too.
        let root = (1.0 + square).sqrt();
        let versine = square / (root * (1.0 + root));
        let (low, high) = (f64::from(light.versine_inner), f64::from(light.versine_outer));
        let ramp = ((high - versine) / (high - low)).clamp(0.0, 1.0);
        Vec3::splat((ramp * ramp) as f32)
    };
    (0..SPOT).flat_map(|y| (0..SPOT).map(move |x| value(x, y))).collect()
}
