//! What every part of the estimator reads: the scene, its view, the settings, and what the loops are compiled for.

use super::settings::Settings;
use super::vertex::Vertex;
use crate::scene::material::VARIES;
use crate::scene::{General, Scene, Shape, View};

/// What every part of the estimator reads.
#[derive(Clone, Copy, Debug)]
pub struct Context<'a, F = General> {
    /// The scene.
    pub scene: &'a Scene,
    /// The camera with its film.
    pub view: &'a View,
    /// The user's choices.
    pub settings: &'a Settings,
    /// What the loops are compiled for; it must fit the scene.
    pub shape: F,
}

impl<'a> Context<'a> {
    /// The context of any scene.
    pub fn new(scene: &'a Scene, view: &'a View, settings: &'a Settings) -> Self {
        Self { scene, view, settings, shape: General }
    }
}

impl<F: Shape> Context<'_, F> {
    /// Survival probability at a surface vertex.
    #[inline]
    pub fn survival(&self, v: &Vertex) -> f32 {
        if !self.settings.roulette {
            return 1.0;
        }
        let material = &self.scene.materials[v.material as usize];
        if F::TEXTURES && material.has(VARIES) { material.survival_of(v.look.color, v.look.metallic) } else { material.survival }
    }

    /// a of a vertex.
    #[inline(always)]
    pub fn opacity(&self, v: &Vertex) -> f32 {
        if F::ALPHA { v.look.opacity } else { 1.0 }
    }
}
