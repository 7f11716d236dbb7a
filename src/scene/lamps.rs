//! Lamps: the emissive triangles of a material that hang together, so that they can be named, moved and dimmed as one.

use super::{Scene, Triangle};
use crate::math::Vec3;
use std::collections::HashMap;
use std::sync::Arc;

/// Emissive triangles of one material that are joined by common corners.
#[derive(Clone, Debug, PartialEq)]
pub struct Lamp {
    /// The material's name.
    pub name: String,
    /// Index into [`Scene::materials`].
    pub material: u32,
    /// Mean of its points, by area; m, relative to the scene's origin.
    pub centroid: Vec3,
    /// Its triangles' area, m².
    pub area: f32,
    /// Its triangles, in ascending order.
    pub triangles: Vec<u32>,
}

impl Scene {
    /// The lamps, in the order of their materials, then from left to right; found when they are first asked for.
    pub fn lamps(&self) -> &Arc<[Lamp]> {
        self.lamps.get_or_init(|| self.find_lamps().into())
    }

    /// The lamp a triangle belongs to.
    pub fn lamp_of(&self, triangle: u32) -> Option<usize> {
        let material = self.triangles.get(triangle as usize)?.material;
        self.lamps().iter().position(|lamp| lamp.material == material && lamp.triangles.binary_search(&triangle).is_ok())
    }

    fn find_lamps(&self) -> Vec<Lamp> {
        let emits = |t: &Triangle| self.materials[t.material as usize].emits();
        let shining: Vec<u32> = (0..self.triangles.len() as u32).filter(|&i| emits(&self.triangles[i as usize])).collect();
        let mut groups = Groups::of(shining.len());
        let mut at: HashMap<(u32, [u32; 3]), usize> = HashMap::new();
        for (number, &index) in shining.iter().enumerate() {
            let t = &self.triangles[index as usize];
            for corner in [t.p0, t.p1, t.p2] {
                // Adding zero makes one of both zeros.
                let key = (t.material, (corner + 0.0).to_array().map(f32::to_bits));
                groups.join(number, *at.entry(key).or_insert(number));
            }
        }
        let mut members: HashMap<usize, Vec<u32>> = HashMap::new();
        for (number, &index) in shining.iter().enumerate() {
            members.entry(groups.root(number)).or_default().push(index);
        }
        let mut lamps: Vec<Lamp> = members.into_values().map(|triangles| self.lamp(triangles)).collect();
        lamps.sort_by(|a, b| {
            let places = a.centroid.to_array().into_iter().zip(b.centroid.to_array());
            places.fold(a.material.cmp(&b.material), |order, (x, y)| order.then(x.total_cmp(&y)))
        });
        lamps
    }

    fn lamp(&self, triangles: Vec<u32>) -> Lamp {
        let parts = triangles.iter().map(|&i| &self.triangles[i as usize]).map(|t| {
            let area = 0.5 * (t.p1 - t.p0).cross(t.p2 - t.p0).length();
            (area, (t.p0 + t.p1 + t.p2) * (area / 3.0))
        });
        let (area, sum) = parts.fold((0.0, Vec3::ZERO), |(area, sum), (a, s)| (area + a, sum + s));
        let material = triangles.first().map_or(0, |&i| self.triangles[i as usize].material);
        let centroid = if area > 0.0 { sum / area } else { Vec3::ZERO };
        Lamp { name: self.material_names[material as usize].clone(), material, centroid, area, triangles }
    }
}

/// Who belongs together.
struct Groups(Vec<usize>);

impl Groups {
    fn of(count: usize) -> Self {
        Self((0..count).collect())
    }

    fn root(&mut self, mut i: usize) -> usize {
        while self.0[i] != i {
            self.0[i] = self.0[self.0[i]];
            i = self.0[i];
        }
        i
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b)] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::super::builtin;

    #[test]
    fn lamps_are_what_hangs_together() {
        let scene = builtin::open("cornell").unwrap();
        let [lamp] = &scene.lamps()[..] else { panic!("{:?}", scene.lamps()) };
        assert_eq!((lamp.triangles.len(), lamp.material), (2, scene.triangles[lamp.triangles[0] as usize].material));
        let centre = scene.in_file(lamp.centroid);
        assert!((centre[0] - 0.278).abs() < 1e-6 && (centre[1] - 0.548).abs() < 1e-6, "under the ceiling: {centre:?}");
        assert!(lamp.triangles.iter().all(|&t| scene.lamp_of(t) == Some(0)));
        assert_eq!(scene.lamp_of(u32::MAX), None);
        let balls = builtin::open("sphere-lights").unwrap();
        assert_eq!(balls.lamps().len(), 4, "a ball's triangles are one lamp");
        assert_eq!(builtin::open("spots").unwrap().lamps().len(), 0);
    }
}
