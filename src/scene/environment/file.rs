//! Where an environment comes from: a constant, or an equirectangular picture (.hdr, .exr).

use super::Environment;
use crate::math::Vec3;
use crate::scene::SceneError;
use std::path::PathBuf;

/// What the user or a file names as the environment.
#[derive(Clone, Debug, PartialEq)]
pub enum EnvironmentSource {
    /// The same radiance from everywhere, W m⁻² sr⁻¹.
    Constant(Vec3),
    /// A picture file.
    File(PathBuf),
}

impl EnvironmentSource {
    /// Reads it; `rotation` in degrees about +Y; what is to be told goes to `notes`.
    ///
    /// # Errors
    /// If the file cannot be read or is no picture, or a constant is negative or not finite.
    pub fn open(&self, rotation: f64, _notes: &mut Vec<String>) -> Result<Environment, SceneError> {
        match self {
            Self::Constant(radiance) => Ok(Environment::from_map([1, 1], &[*radiance], rotation)),
            Self::File(path) => Err(SceneError::file(path, "not yet")),
        }
    }
}
