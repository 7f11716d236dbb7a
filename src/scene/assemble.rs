//! From loose parts to a scene: recentre, build the hierarchy, collect the lights, derive the features.

use super::attributes::Arrays;
use super::bvh::Bvh;
use super::parts::{Bounds, PartCamera};
use super::sphere::Sphere;
use super::texture::Textures;
use super::{Camera, Costs, Lens, Lights, NONE, Parts, Recipe, Scene, SceneEdits, SceneError, SceneFeatures, Triangle};
use crate::math::DVec3;
use std::path::Path;
use std::sync::{Arc, OnceLock};

/// Largest extent of a scene, m: beyond it, products of lengths leave the range of f32.
pub const MAX_EXTENT: f64 = 1e9;

impl Scene {
    /// Makes the parts a scene.
    ///
    /// # Errors
    /// If no triangle has an area and nothing comes from infinity, there is no usable camera, a coordinate is not finite, the
    /// extent, or the distance of a camera or a light, exceeds [`MAX_EXTENT`], or a triangle names a material that does not
    /// exist.
    pub fn assemble(mut parts: Parts) -> Result<Self, SceneError> {
        // With a sky there is something to see even where there is nothing else.
        let sky = parts.environment.is_some();
        if parts.triangles.is_empty() && !sky {
            return Err(parts.error("the scene has no triangles; export at least one mesh of triangles"));
        }
        let nothing = Bounds { min: DVec3::ZERO, max: DVec3::ZERO };
        let bounds = if parts.triangles.is_empty() { Some(nothing) } else { parts.bounds() };
        let bounds = bounds.ok_or_else(|| parts.error("a position is not a finite number; repair the mesh and export it again"))?;
        let extent = (bounds.max - bounds.min).max_element();
        if extent > MAX_EXTENT {
            return Err(parts.error(format!("the scene is {extent:.1e} m wide, at most {MAX_EXTENT:.0e} m can be rendered; scale it down")));
        }
        let origin = bounds.centre();
        let cameras = parts.cameras.iter().map(|camera| ("camera", &camera.name, camera.position));
        let lights = parts.lights.iter().filter_map(|(name, light)| Some(("light", name, light.position()?)));
        for (kind, name, distance) in cameras.chain(lights).map(|(kind, name, p)| (kind, name, (p - origin).length())) {
            if distance.is_nan() || distance > MAX_EXTENT {
                let reason =
                    format!("it is {distance:.1e} m away from the scene, at most {MAX_EXTENT:.0e} m can be rendered; move it nearer");
                return Err(SceneError::element(Path::new(&parts.name), format!("{kind} '{name}'"), reason));
            }
        }
        let (mut triangles, attributes) = recentred(&parts, origin)?;
        let dropped = parts.triangles.len() - triangles.len();
        if triangles.is_empty() && !sky {
            return Err(parts.error(format!("the scene has no triangles: all {dropped} are without area")));
        }
        if dropped > 0 {
            parts.notes.push(format!(
                "{dropped} triangle{} without area {} dropped.",
                plural(dropped),
                if dropped == 1 { "was" } else { "were" }
            ));
        }
        let cameras = parts.cameras.iter().map(|c| camera(c, origin)).collect::<Option<Vec<_>>>().filter(|list| !list.is_empty());
        let cameras = cameras.ok_or_else(|| parts.error("the scene has no usable camera; add a perspective camera"))?;
        let sphere = Sphere::around_points(triangles.iter().flat_map(|t| [t.p0, t.p1, t.p2]));
        let start = web_time::Instant::now();
        let bvh = Bvh::build(&mut triangles);
        let build_seconds = start.elapsed().as_secs_f64();
        let (material_names, materials): (Vec<_>, Vec<_>) = parts.materials.into_iter().unzip();
        let known = parts.recipes.into_iter().map(Some).chain(std::iter::repeat(None));
        let recipes = materials.iter().zip(known).map(|(material, recipe)| recipe.unwrap_or_else(|| Recipe::of(material))).collect();
        let others = parts.lights.iter().filter_map(|(name, light)| Some((name.clone(), light.relative_to(origin)?))).collect();
        let textures = Textures::new(parts.images, &parts.textures);
        let mut scene = Self {
            name: parts.name,
            origin,
            sphere,
            triangles: triangles.into(),
            attributes: Arc::new(attributes),
            materials,
            recipes,
            material_names,
            textures: Arc::new(textures),
            lights: Lights::default(),
            bvh,
            cameras,
            notes: parts.notes,
            scene_names: parts.scene_names,
            scene: parts.scene,
            features: SceneFeatures::default(),
            edits: SceneEdits::default(),
            costs: Costs { build_seconds, ..Costs::default() },
            lamps: OnceLock::new(),
        };
        scene.collect_lights(others, parts.environment.map(Arc::new), |_, emission| emission);
        scene.find_features();
        for index in 0..scene.cameras.len() {
            if scene.cameras[index].lens.focus_distance.is_nan() {
                scene.cameras[index].lens.focus_distance = scene.default_focus(&scene.cameras[index]);
            }
            let camera = &scene.cameras[index];
            if let Err(reason) = scene.sphere.check_lens(camera.lens) {
                return Err(SceneError::element(Path::new(&scene.name), format!("camera '{}'", camera.name), reason));
            }
        }
        Ok(scene)
    }

    /// Derives the features from what there is.
    pub(super) fn find_features(&mut self) {
        self.features = SceneFeatures::of(&self.triangles, &self.attributes, &self.materials, &self.lights);
    }

    /// The distance, along the axis, of what a camera shows in the middle of its picture; if that is nothing, of the scene's
    /// centre, and if that is not in front, the scene's radius.
    fn default_focus(&self, camera: &Camera) -> f32 {
        let to_centre = -camera.position.dot(camera.axis);
        let seen = self.depth_along(&super::Ray { origin: camera.position, direction: camera.axis }, camera.axis);
        seen.or((to_centre > 0.0).then_some(to_centre)).unwrap_or(self.sphere.radius)
    }
}

/// The triangles that have an area, relative to `origin`, with what they have beyond their corners.
fn recentred(parts: &Parts, origin: DVec3) -> Result<(Vec<Triangle>, Arrays), SceneError> {
    let mut triangles = Vec::with_capacity(parts.triangles.len());
    let mut arrays = Arrays::default();
    for part in &parts.triangles {
        if part.material as usize >= parts.materials.len() {
            return Err(parts.error(format!("a triangle uses material {}, of {} there are", part.material, parts.materials.len())));
        }
        let Some(([p0, p1, p2], n_g)) = part.relative_to(origin) else { continue };
        let attributes = arrays.add(part, n_g, parts.attributes.get(part.attributes as usize));
        triangles.push(Triangle { p0, material: part.material, p1, light: NONE, p2, attributes });
    }
    Ok((triangles, arrays))
}

/// The camera relative to `origin`, its axes orthonormal; `None` if its directions or its angle make no picture.
fn camera(part: &PartCamera, origin: DVec3) -> Option<Camera> {
    let axis = part.axis.try_normalize()?;
    let up = (part.up - axis * part.up.dot(axis)).try_normalize()?;
    let usable = part.position.is_finite() && part.yfov > 0.0 && part.yfov < std::f64::consts::PI;
    usable.then(|| Camera {
        name: part.name.clone(),
        position: (part.position - origin).as_vec3(),
        right: axis.cross(up).as_vec3(),
        up: up.as_vec3(),
        axis: axis.as_vec3(),
        yfov: part.yfov as f32,
        // NaN until the scene is there to be focused on.
        lens: Lens { radius: part.lens_radius as f32, focus_distance: part.focus_distance.map_or(f32::NAN, |d| d as f32) },
    })
}

/// The plural's ending.
pub(super) fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}
