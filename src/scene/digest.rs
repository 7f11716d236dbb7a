//! Is a scene the same as another one? A digest of each part of what is rendered; names, notes and the place of the file do not
//! count.
//!
//! ```text
//! h ← (h ⊕ word) · (2⁸⁸ + 315),   h ← h ⊕ ⌊h / 2⁶⁷⌋          128 bits; the bytes as words of 64, then their number
//! ```
//! It tells apart what differs by mistake (by chance once in 10³⁸), not what somebody made to have the same digest. The numbers
//! are those in memory: where another system's library rounds a sine otherwise, a scene may have another digest.

use super::{Camera, NONE, Scene, Triangle};
use bytemuck::{Pod, bytes_of, cast_slice};
use std::fmt;

/// Of FNV, for 128 bits.
const START: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
/// The same.
const PRIME: u128 = (1 << 88) + 315;

/// A digest of what was added so far, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Digest(u128);

impl Default for Digest {
    fn default() -> Self {
        Self(START)
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}

impl Digest {
    fn word(&mut self, word: u64) {
        let mixed = (self.0 ^ u128::from(word)).wrapping_mul(PRIME);
        self.0 = mixed ^ mixed >> 67;
    }

    /// Adds a list.
    #[must_use]
    pub fn with<T: Pod>(mut self, list: &[T]) -> Self {
        let bytes: &[u8] = cast_slice(list);
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.word(u64::from_le_bytes(word));
        }
        self.word(bytes.len() as u64);
        self
    }
}

impl Scene {
    /// The parts of the scene, without its cameras, and their digests.
    pub fn digests(&self) -> [(&'static str, Digest); 4] {
        let (arrays, textures, lights) = (&self.attributes, &self.textures, &self.lights);
        // Which light a triangle is follows from materials and lights.
        let shape = |digest: Digest, triangle: &Triangle| digest.with(bytes_of(&Triangle { light: NONE, ..*triangle }));
        let shapes = self.triangles.iter().fold(Digest::default(), shape);
        let shapes = shapes.with(&arrays.list).with(&arrays.normals).with(&arrays.tangents).with(&arrays.uvs).with(&arrays.colors);
        // Light from infinity is as strong as the sphere is wide.
        let (centre, radius) = (self.sphere.centre, self.sphere.radius);
        let mut lit = Digest::default().with(&lights.list).with(&[centre.x, centre.y, centre.z, radius]);
        if let Some(sky) = &lights.environment {
            lit = lit.with(&[sky.width, sky.height]).with(&sky.texels).with(&[sky.rotation()]);
        }
        [
            ("shapes", shapes),
            ("materials", Digest::default().with(&self.materials)),
            ("textures", Digest::default().with(&textures.list).with(&textures.texels)),
            ("lights", lit),
        ]
    }
}

impl Camera {
    /// The digest of its place, its direction and its angle of view; not of its lens.
    pub fn digest(&self) -> Digest {
        let Self { position, right, up, axis, yfov, .. } = self;
        [position, right, up, axis].iter().fold(Digest::default(), |digest, v| digest.with(&v.to_array())).with(&[*yfov])
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Overrides, builtin};
    use super::*;
    use crate::scene::environment::EnvironmentSource;
    use std::sync::Arc;

    fn differing(a: &Scene, b: &Scene) -> Vec<&'static str> {
        a.digests().into_iter().zip(b.digests()).filter(|(a, b)| a != b).map(|(a, _)| a.0).collect()
    }

    #[test]
    fn a_digest_knows_every_bit_and_every_border() {
        let of = |list: &[u8]| Digest::default().with(list);
        let zeros = [0u8; 40];
        let mut seen = vec![of(&zeros)];
        for bit in 0..320 {
            let mut list = zeros;
            list[bit / 8] ^= 1 << (bit % 8);
            seen.push(of(&list));
        }
        seen.extend((0..40).map(|length| of(&zeros[..length])));
        seen.push(of(&zeros[..20]).with(&zeros[20..]));
        let count = seen.len();
        seen.sort_unstable_by_key(|digest| digest.0);
        seen.dedup();
        assert_eq!(seen.len(), count);
        // Files hold it: pinned.
        assert_eq!(of("x̄ = x₀…x_k".as_bytes()).to_string(), "5a1170cb1ac2c4a8da07136faa51642c");
    }

    #[test]
    fn a_scene_is_itself_again_and_a_changed_part_is_named() {
        for entry in builtin::list() {
            let (a, b) = (builtin::open(entry.name).unwrap(), builtin::open(entry.name).unwrap());
            assert_eq!(differing(&a, &b), Vec::<&str>::new(), "{}", entry.name);
        }
        let cornell = builtin::open("cornell").unwrap();
        let mut changed = cornell.clone();
        changed.materials[0].color.x += f32::EPSILON;
        assert_eq!(differing(&cornell, &changed), ["materials"]);
        let mut changed = cornell.clone();
        let mut triangles = changed.triangles.to_vec();
        triangles[3].p1.y += f32::EPSILON;
        changed.triangles = Arc::from(triangles);
        assert_eq!(differing(&cornell, &changed), ["shapes"]);
        let sky = |text: &str| {
            let overrides = Overrides { environment: Some(EnvironmentSource::parse(text).unwrap()), ..Overrides::default() };
            builtin::open_with("cornell", &overrides, &Default::default()).unwrap()
        };
        assert_eq!(differing(&cornell, &sky("1,1,1")), ["lights"]);
        assert_eq!(differing(&sky("1,1,1"), &sky("1,1,1.0000001")), ["lights"]);
        assert_eq!(differing(&cornell, &builtin::open("furnace").unwrap()).len(), 3);
    }

    #[test]
    fn a_camera_is_where_it_stands() {
        let scene = builtin::open("cornell").unwrap();
        let camera = scene.cameras[0].clone();
        let moved = Camera { position: camera.position + camera.axis * 1e-3, ..camera.clone() };
        let renamed = Camera { name: "other".to_owned(), ..camera.clone() };
        assert!(camera.digest() != moved.digest() && camera.digest() == renamed.digest());
    }
}
