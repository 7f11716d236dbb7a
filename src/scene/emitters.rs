//! Finding a scene's lights: which triangles emit, and how much each does in the mean.

use super::attributes::Attributes;
use super::light::{AREA, ENVIRONMENT, Light};
use super::material::{TRANSPARENT, UNLIT};
use super::{Environment, General, Lights, Material, NONE, Scene, Triangle};
use crate::math::{Vec2, Vec3, sample_triangle};
use std::sync::Arc;

/// The most points at which the mean of an emissive texture over a triangle is taken: a floor on what is not met keeps it
/// samplable.
const POINTS: u32 = 64;
/// The fewest, for triangles on few texels.
const FEWEST: u32 = 8;

impl Scene {
    /// Collects the emissive triangles, writes each one's index into its `light` field, and adds the other lights. `shine` makes of
    /// what a triangle's material emits what the triangle itself does.
    pub(super) fn collect_lights(
        &mut self,
        others: Vec<(String, Light)>,
        environment: Option<Arc<Environment>>,
        shine: impl Fn(u32, Vec3) -> Vec3,
    ) {
        let (mut list, mut means, mut renumbered) = (Vec::new(), Vec::new(), Vec::new());
        for (triangle, index) in self.triangles.iter().zip(0..) {
            let material = &self.materials[triangle.material as usize];
            let radiance = if material.emits() { shine(index, material.emission) } else { Vec3::ZERO };
            let area = 0.5 * (triangle.p1 - triangle.p0).cross(triangle.p2 - triangle.p0).length();
            let shines = radiance.max_element() > 0.0 && area > 0.0;
            let mean = if shines { self.mean_emission(index, triangle, radiance) } else { None };
            let light = mean.map(|mean| {
                let sides = if material.two_sided == 1 { 2.0 } else { 1.0 };
                list.push(Light { triangle: index, area, sides, ..Light::new(AREA, radiance) });
                means.push(mean);
                list.len() as u32 - 1
            });
            let light = light.unwrap_or(NONE);
            if light != triangle.light {
                renumbered.push((index, light));
            }
        }
        // Only where something changed are the triangles copied.
        if !renumbered.is_empty() {
            let triangles = Arc::make_mut(&mut self.triangles);
            renumbered.into_iter().for_each(|(index, light)| triangles[index as usize].light = light);
        }
        let (names, others): (Vec<_>, Vec<_>) = others.into_iter().filter(|(_, light)| light.radiance.max_element() > 0.0).unzip();
        list.extend(others);
        let environment = environment.filter(|map| map.emits());
        list.extend(environment.iter().map(|_| Light::new(ENVIRONMENT, Vec3::ONE)));
        self.lights = Lights::new(list, &means, names, environment, self.sphere.radius);
    }

    /// The mean over a triangle of what multiplies its radiance; `None` if that is nothing anywhere.
    fn mean_emission(&self, index: u32, triangle: &Triangle, radiance: Vec3) -> Option<Vec3> {
        let material = &self.materials[triangle.material as usize];
        let varies = material.emissive_texture != NONE || material.has(TRANSPARENT) || material.has(UNLIT);
        if triangle.attributes == NONE || !varies {
            let opacity = self.emission_opacity(triangle, material);
            return (opacity > 0.0).then_some(Vec3::splat(opacity));
        }
        let attributes = &self.attributes.list[triangle.attributes as usize];
        let count = self.points_for(material, attributes);
        let points = (0..count).map(|i| {
            // A Kronecker sequence: it fills the triangle evenly.
            let u = Vec2::new((0.5 + i as f32 * 0.754_877_7).fract(), (0.5 + i as f32 * 0.569_840_3).fract());
            let b = sample_triangle(u);
            let a = if material.has(TRANSPARENT) { self.opacity_at(material, triangle.attributes, b) } else { 1.0 };
            self.emission_factor::<General>(index, triangle.material, b) * a
        });
        let mean = points.sum::<Vec3>() / count as f32;
        let somewhere = |factor: Vec3| (factor * radiance).max_element() > 0.0;
        (somewhere(mean) || somewhere(self.largest_emission(material, attributes))).then_some(mean)
    }

    /// At how many points the mean is taken.
    fn points_for(&self, material: &Material, attributes: &Attributes) -> u32 {
        if material.emissive_texture == NONE || material.has(TRANSPARENT) {
            return POINTS;
        }
        let texels = self.textures.texels_under(material.emissive_texture, self.emissive_corners(material, attributes));
        (texels as u32).clamp(FEWEST, POINTS)
    }

    /// Texture coordinates of the emissive texture at a triangle's corners.
    fn emissive_corners(&self, material: &Material, attributes: &Attributes) -> [Vec2; 3] {
        let second = self.textures.list[material.emissive_texture as usize].flags & super::texture::SET_1 != 0;
        let uvs = if second { attributes.uvs_1 } else { attributes.uvs_0 };
        self.attributes.uvs.get(uvs as usize).map_or([Vec2::ZERO; 3], |uvs| [uvs.uv0, uvs.uv1, uvs.uv2])
    }

    /// A bound on what the textures make of the emission on a triangle.
    fn largest_emission(&self, material: &Material, attributes: &Attributes) -> Vec3 {
        if material.emissive_texture == NONE || material.has(UNLIT) {
            return Vec3::ONE;
        }
        let corners = self.emissive_corners(material, attributes);
        self.textures.largest(material.emissive_texture, corners).truncate()
    }

    /// a of a triangle on which nothing varies.
    fn emission_opacity(&self, triangle: &Triangle, material: &Material) -> f32 {
        if material.has(TRANSPARENT) { self.opacity_at(material, triangle.attributes, Vec2::ZERO) } else { 1.0 }
    }
}
