//! What a person changed about a scene: plain data that travels in links, and what it makes of the file's scene.
//!
//! ```text
//! apply(file's scene, edits) = the scene that a file with these numbers would have made
//! ```
//!
//! Edits start from the file every time, they never add up. What an edit does not touch is shared with the file's scene: only
//! moved lamps copy the triangles (and refit the hierarchy), and materials that do not shine leave the lights alone. The origin
//! of the coordinates stays the file's.

mod lights;
mod materials;

pub use materials::hue_and_strength;

use super::assemble::MAX_EXTENT;
use super::environment::MAX_RADIANCE;
use super::{Scene, sphere::Sphere};
use crate::math::Vec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;

/// Version of this data: what another program wrote in another version is refused.
pub const EDITS_VERSION: u32 = 1;
/// The factors a power may have.
pub const POWERS: [f32; 2] = [0.0, 1e6];
/// The factors a size may have.
pub const SIZES: [f32; 2] = [1e-3, 1e3];
/// The indices of refraction a material may have.
pub const IORS: [f32; 2] = [1.0, 1e3];

/// A material other than its file has it; what is `None` is the file's.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct MaterialEdit {
    /// The material's name, to know it again.
    pub name: String,
    /// Base colour, linear, 0…1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color: Option<[f32; 3]>,
    /// Roughness, 0…1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub roughness: Option<f32>,
    /// Metallic share, 0…1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub metallic: Option<f32>,
    /// Index of refraction, one of [`IORS`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ior: Option<f32>,
    /// Hue of the emission, linear, 0…1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub emission_color: Option<[f32; 3]>,
    /// What multiplies that hue, W m⁻² sr⁻¹.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub emission_strength: Option<f32>,
}

/// A lamp (see [`super::Lamp`]) other than its file has it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LampEdit {
    /// Its material's name, to know it again.
    pub name: String,
    /// What multiplies its radiance, one of [`POWERS`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub power: Option<f32>,
    /// Hue of its radiance, linear, 0…1; its largest channel stays as strong as it was.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color: Option<[f32; 3]>,
    /// How far it is moved, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub offset: Option<[f64; 3]>,
    /// What multiplies its lengths about its centroid, one of [`SIZES`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub size: Option<f32>,
}

/// A light of no extent other than its file has it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LightEdit {
    /// Its name, to know it again.
    pub name: String,
    /// Its largest channel: intensity, W sr⁻¹, or irradiance, W m⁻².
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strength: Option<f32>,
    /// Its hue, linear, 0…1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color: Option<[f32; 3]>,
    /// Point and spot: how far it is moved, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub offset: Option<[f64; 3]>,
    /// Spot: the axis; directional: where the light travels; of any length.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f32; 3]>,
    /// Spot: the angles from the axis up to which it has its full intensity, and from which it is dark, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cone: Option<[f32; 2]>,
}

/// The environment other than it was loaded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct EnvironmentEdit {
    /// What multiplies its radiance, one of [`POWERS`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strength: Option<f32>,
    /// How far it is turned about +Y, counter-clockwise seen from above, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotation: Option<f64>,
}

/// Everything that is other than the file has it, by the numbers the file's scene gives its parts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SceneEdits {
    /// [`EDITS_VERSION`].
    pub version: u32,
    /// Materials.
    pub materials: BTreeMap<u32, MaterialEdit>,
    /// Lamps.
    pub lamps: BTreeMap<u32, LampEdit>,
    /// Lights of no extent.
    pub lights: BTreeMap<u32, LightEdit>,
    /// The environment.
    pub environment: EnvironmentEdit,
}

impl Default for SceneEdits {
    fn default() -> Self {
        Self {
            version: EDITS_VERSION,
            materials: BTreeMap::new(),
            lamps: BTreeMap::new(),
            lights: BTreeMap::new(),
            environment: EnvironmentEdit::default(),
        }
    }
}

impl MaterialEdit {
    /// Does it change nothing?
    pub fn is_empty(&self) -> bool {
        *self == Self { name: self.name.clone(), ..Self::default() }
    }
}

impl LampEdit {
    /// Does it change nothing?
    pub fn is_empty(&self) -> bool {
        *self == Self { name: self.name.clone(), ..Self::default() }
    }

    /// Does it move or resize the lamp?
    fn moves(&self) -> bool {
        self.offset.is_some() || self.size.is_some()
    }
}

impl LightEdit {
    /// Does it change nothing?
    pub fn is_empty(&self) -> bool {
        *self == Self { name: self.name.clone(), ..Self::default() }
    }
}

/// Why edits cannot be applied: one sentence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EditError(pub String);

impl fmt::Display for EditError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for EditError {}

impl SceneEdits {
    /// Does nothing differ from the file?
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Forgets entries that change nothing.
    pub fn tidy(&mut self) {
        self.materials.retain(|_, edit| !edit.is_empty());
        self.lamps.retain(|_, edit| !edit.is_empty());
        self.lights.retain(|_, edit| !edit.is_empty());
    }

    /// The edits that another version of the scene still has a place for, by number and name or else by a name that is there
    /// once; and the names of those it has none for.
    pub fn fitted(&self, scene: &Scene) -> (Self, Vec<String>) {
        let mut lost = Vec::new();
        let lamps: Vec<&str> = scene.lamps().iter().map(|lamp| lamp.name.as_str()).collect();
        let materials: Vec<&str> = scene.material_names.iter().map(String::as_str).collect();
        let lights: Vec<&str> = scene.lights.dirac().map(|(name, _)| name).collect();
        let fitted = Self {
            version: self.version,
            materials: rekeyed(&self.materials, |edit| &edit.name, &materials, &mut lost),
            lamps: rekeyed(&self.lamps, |edit| &edit.name, &lamps, &mut lost),
            lights: rekeyed(&self.lights, |edit| &edit.name, &lights, &mut lost),
            environment: if scene.lights.environment.is_some() { self.environment } else { EnvironmentEdit::default() },
        };
        (fitted, lost)
    }
}

fn rekeyed<T: Clone>(map: &BTreeMap<u32, T>, name: impl Fn(&T) -> &str, names: &[&str], lost: &mut Vec<String>) -> BTreeMap<u32, T> {
    let mut fitted = BTreeMap::new();
    for (&index, edit) in map {
        let name = name(edit);
        let only = || {
            let mut places = (0..names.len()).filter(|&i| names[i] == name);
            places.next().filter(|_| places.next().is_none()).map(|i| i as u32)
        };
        match if names.get(index as usize) == Some(&name) { Some(index) } else { only() } {
            Some(index) => drop(fitted.insert(index, edit.clone())),
            None => lost.push(name.to_owned()),
        }
    }
    fitted
}

/// The scene that a file with these numbers would have made.
///
/// # Errors
/// If the edits are of another version, name something the scene does not have, or hold a number that cannot be rendered.
pub fn apply(file: &Scene, edits: &SceneEdits) -> Result<Scene, EditError> {
    if edits.version != EDITS_VERSION {
        return Err(EditError(format!("these edits are of version {}; this program knows version {EDITS_VERSION}", edits.version)));
    }
    let mut scene = file.clone();
    scene.edits = edits.clone();
    scene.edits.tidy();
    let mut shines = false;
    for (&index, edit) in &edits.materials {
        shines |= materials::apply(file, &mut scene, index, edit)?;
    }
    let moved = edits.lamps.values().any(LampEdit::moves);
    if moved {
        lights::move_lamps(file, &mut scene, edits)?;
        let corners = scene.triangles.iter().flat_map(|t| [t.p0, t.p1, t.p2]);
        scene.sphere = Sphere::around_points(corners);
        if f64::from(scene.sphere.radius) > MAX_EXTENT {
            return Err(EditError(format!("a lamp is moved too far: a scene can be at most {MAX_EXTENT:.0e} m wide")));
        }
        scene.bvh = scene.bvh.refitted(&scene.triangles);
    }
    let lit_otherwise = !(edits.lamps.is_empty() && edits.lights.is_empty()) || edits.environment != EnvironmentEdit::default();
    if shines || moved || lit_otherwise {
        lights::relight(file, &mut scene, edits)?;
    }
    if !edits.is_empty() {
        scene.find_features();
    }
    Ok(scene)
}

/// A number within its range; else a sentence.
fn within(value: f32, [least, most]: [f32; 2], element: &str, what: &str) -> Result<f32, EditError> {
    if (least..=most).contains(&value) {
        return Ok(value);
    }
    Err(EditError(format!("{element}: its {what} {value:?} must be {least} to {most}")))
}

/// A colour within 0…1.
fn hue(color: [f32; 3], element: &str, what: &str) -> Result<Vec3, EditError> {
    color.iter().try_for_each(|&channel| within(channel, [0.0, 1.0], element, what).map(drop))?;
    Ok(color.into())
}

/// What shines, not too brightly.
fn radiance(value: Vec3, element: &str) -> Result<Vec3, EditError> {
    within(value.max_element(), [0.0, MAX_RADIANCE], element, "strength")?;
    Ok(value)
}

/// How far something is moved, m.
fn offset(by: [f64; 3], element: &str) -> Result<crate::math::DVec3, EditError> {
    let by = crate::math::DVec3::from(by);
    if by.is_finite() && by.length() <= MAX_EXTENT {
        return Ok(by);
    }
    Err(EditError(format!("{element}: it can be moved by at most {MAX_EXTENT:.0e} m")))
}

/// The error about something the scene does not have.
fn missing(what: &str, index: u32, name: &str) -> EditError {
    EditError(format!("{what} {index} '{name}': the scene has no such {what}"))
}
