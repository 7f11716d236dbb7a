//! The lights of `KHR_lights_punctual`: colour × intensity in W sr⁻¹ (point, spot) or W m⁻² (directional), along the node's −Z.
//!
//! Only place and direction come from the node: its scale changes neither intensity nor cone. A `range` is ignored, light
//! falls off with the square of the distance alone.

use super::super::SceneError;
use super::super::environment::MAX_RADIANCE;
use super::super::parts::PartLight;
use super::container::{Document, label};
use super::nodes::Placed;
use crate::math::Vec3;
use ::gltf::json::extensions::scene::khr_lights_punctual::{Light, Type};
use ::gltf::json::validation::Checked;
use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

/// Narrowest cone of a spot, radians: beyond it, f32 directions are too coarse.
const NARROWEST: f32 = 1e-5;

/// The lights at the placed nodes, with their names; what is to be told of them goes to `notes`.
pub fn lights(document: &Document, placed: &[Placed], notes: &mut Vec<String>) -> Result<Vec<(String, PartLight)>, SceneError> {
    let extension = document.root.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
    let known = extension.map_or(&[][..], |e| &e.lights);
    let (mut list, mut ranges) = (Vec::new(), 0);
    for place in placed {
        let used = place.node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
        let Some(index) = used.map(|e| e.light.value()) else { continue };
        let Some(json) = known.get(index) else {
            return Err(document.error(place.label(), format!("it uses light {index}, which does not exist; export the file again")));
        };
        let element = || format!("{} at {}", label("light", index, json.name.as_deref()), place.label());
        let light = light(json, place).map_err(|reason| document.error(element(), reason))?;
        let name = json.name.as_deref().or(place.node.name.as_deref()).map_or_else(|| format!("light {index}"), str::to_owned);
        match light {
            Some(light) => list.push((name, light)),
            None => notes.push(format!("The light '{name}' has a degenerate transform and was ignored.")),
        }
        ranges += usize::from(json.range.is_some());
    }
    if ranges > 0 {
        notes.push(format!("Ignored: the range of lights ({ranges})."));
    }
    Ok(list)
}

/// The light a node carries; `None` if its direction is lost in a degenerate transform.
fn light(json: &Light, place: &Placed) -> Result<Option<PartLight>, String> {
    let intensity = Vec3::from(json.color) * json.intensity;
    if !intensity.to_array().iter().all(|x| (0.0..=MAX_RADIANCE).contains(x)) {
        return Err(format!(
            "its colour × intensity is negative, not finite or above {MAX_RADIANCE:.0e}; repair the light and export it again"
        ));
    }
    let (position, axis) = (place.world_from_node.w_axis.truncate(), -place.world_from_node.z_axis.truncate());
    let light = match json.type_ {
        Checked::Valid(Type::Point) => return Ok(Some(PartLight::Point { position, intensity })),
        Checked::Valid(Type::Spot) => PartLight::Spot { position, axis, intensity, angles: angles(json)? },
        Checked::Valid(Type::Directional) => PartLight::Directional { axis, irradiance: intensity },
        Checked::Invalid => return Err("its type is none of point, spot and directional; export the file again".into()),
    };
    Ok(axis.try_normalize().map(|_| light))
}

/// A spot's inner and outer angle, radians. They may be equal: many exporters write hard edges so.
fn angles(json: &Light) -> Result<[f64; 2], String> {
    let (inner, outer) = json.spot.as_ref().map_or((0.0, FRAC_PI_4), |spot| (spot.inner_cone_angle, spot.outer_cone_angle));
    if !((0.0..=outer).contains(&inner) && (NARROWEST..=FRAC_PI_2).contains(&outer)) {
        return Err(format!(
            "its cone angles {inner} and {outer} make no cone; set 0 ≤ innerConeAngle ≤ outerConeAngle, and that from {NARROWEST} to π/2"
        ));
    }
    Ok([inner, outer].map(f64::from))
}
