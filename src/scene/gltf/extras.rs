//! What scenes say in `extras`, for want of words in glTF: a camera's lens, and the light from infinity.
//!
//! | of a | member | meaning |
//! |---|---|---|
//! | camera | `lensRadius` | radius of the aperture, m, ≥ 0; no node scales it; absent: a pinhole |
//! | camera | `focusDistance` | distance of the sharp plane along the axis, m, > 0; absent: of what the middle of the picture shows |
//! | scene | `environment` | a number or `[r, g, b]`: the radiance from everywhere, W m⁻² sr⁻¹ |
//! | | | a string: the URI of a .hdr or .exr picture, a file beside the scene's or `data:…;base64,…` |
//! | | | `{"bufferView": n}`: the bytes of such a picture, so that a .glb can carry it |
//! | scene | `environmentRotation` | degrees by which the picture is turned about +Y, counter-clockwise seen from above |

use super::super::environment::{Environment, EnvironmentSource};
use super::super::{Overrides, SceneError};
use super::container::{Document, label};
use crate::math::Vec3;
use ::gltf::json::camera::Camera;
use serde_json::Value;

/// The radius of a camera's lens and its focus distance, m.
pub fn lens(document: &Document, index: usize, json: &Camera) -> Result<(f64, Option<f64>), SceneError> {
    let fail = |reason: String| document.error(label("camera", index, json.name.as_deref()), reason);
    let members = Document::members(&json.extras).map_err(fail)?;
    let number = |name: &str| members.get(name).map(|value| value.as_f64().unwrap_or(f64::NAN));
    // Judged as the f32 they will be.
    let radius = number("lensRadius").unwrap_or(0.0);
    if !(radius >= 0.0 && (radius as f32).is_finite()) {
        return Err(fail("its lensRadius must be a number of metres, 0 or more".into()));
    }
    let focus_distance = number("focusDistance");
    if focus_distance.is_some_and(|d| !(d as f32 > 0.0 && (d as f32).is_finite())) {
        return Err(fail("its focusDistance must be a number of metres above 0".into()));
    }
    Ok((radius, focus_distance))
}

/// The environment: the user's, or else that of the scene which is shown.
pub fn environment(document: &Document, overrides: &Overrides, notes: &mut Vec<String>) -> Result<Option<Environment>, SceneError> {
    if let Some(source) = &overrides.environment {
        return source.open(overrides.environment_rotation.unwrap_or(0.0), notes).map(Some);
    }
    let Some((index, scene)) = document.scene.and_then(|index| Some((index, document.root.scenes.get(index)?))) else { return Ok(None) };
    let fail = |reason: String| document.error(label("scene", index, scene.name.as_deref()), reason);
    let members = Document::members(&scene.extras).map_err(fail)?;
    let Some(value) = members.get("environment") else { return Ok(None) };
    let degrees = members.get("environmentRotation").map_or(Some(0.0), Value::as_f64);
    let degrees = degrees.ok_or_else(|| fail("its environmentRotation must be a number of degrees".into()))?;
    let environment = read(document, value, overrides.environment_rotation.unwrap_or(degrees), notes);
    environment.map(Some).map_err(|reason| fail(format!("its environment: {reason}")))
}

fn read(document: &Document, value: &Value, rotation: f64, notes: &mut Vec<String>) -> Result<Environment, String> {
    let mut picture = |bytes: &[u8]| Environment::decode(bytes, rotation, notes);
    let channel = |value: &Value| value.as_f64().map(|x| x as f32);
    let radiance = match value {
        Value::String(uri) => return picture(&document.fetch(uri)?),
        Value::Object(members) => match members.get("bufferView").and_then(Value::as_u64) {
            Some(view) => return picture(document.view(view as usize)?),
            None => None,
        },
        Value::Array(list) => match &list.iter().map(channel).collect::<Option<Vec<_>>>().unwrap_or_default()[..] {
            &[r, g, b] => Some(Vec3::new(r, g, b)),
            _ => None,
        },
        _ => channel(value).map(Vec3::splat),
    };
    let radiance = radiance.ok_or("it must be a number, [r, g, b], the URI of a .hdr or .exr picture, or {\"bufferView\": n}")?;
    EnvironmentSource::Constant(radiance).open(rotation, notes).map_err(|error| error.reason)
}
