//! Edits of lights: lamps moved, resized and dimmed; points, spots and suns; the environment. The table of powers is made anew.

use super::super::light::{DIRECTIONAL, Light, POINT, SPOT};
use super::super::{Environment, Lamp, NONE, Scene};
use super::materials::hue_and_strength;
use super::{EditError, LampEdit, LightEdit, POWERS, SIZES, SceneEdits, hue, missing, offset, radiance, within};
use crate::math::{DVec3, Vec3};
use std::collections::HashMap;
use std::sync::Arc;

/// Narrowest and widest angle at which a spot is dark, degrees.
const CONES: [f32; 2] = [6e-4, 90.0];

/// The lamp an edit is about.
fn lamp_of<'a>(file: &'a Scene, index: u32, edit: &LampEdit) -> Result<&'a Lamp, EditError> {
    file.lamps().get(index as usize).filter(|lamp| lamp.name == edit.name).ok_or_else(|| missing("lamp", index, &edit.name))
}

/// Moves and resizes lamps; their triangles stay in the leaves they are in.
pub fn move_lamps(file: &Scene, scene: &mut Scene, edits: &SceneEdits) -> Result<(), EditError> {
    let triangles = Arc::make_mut(&mut scene.triangles);
    for (&index, edit) in edits.lamps.iter().filter(|(_, edit)| edit.moves()) {
        let (lamp, element) = (lamp_of(file, index, edit)?, format!("lamp '{}'", edit.name));
        let size = f64::from(within(edit.size.unwrap_or(1.0), SIZES, &element, "size")?);
        let (centre, by) = (lamp.centroid.as_dvec3(), offset(edit.offset.unwrap_or([0.0; 3]), &element)?);
        let placed = |p: Vec3| (centre + by + (p.as_dvec3() - centre) * size).as_vec3();
        for &i in &lamp.triangles {
            let t = &mut triangles[i as usize];
            (t.p0, t.p1, t.p2) = (placed(t.p0), placed(t.p1), placed(t.p2));
            let cross = (t.p1 - t.p0).cross(t.p2 - t.p0);
            let had_area = file.triangles[i as usize].light != NONE;
            if had_area && !(cross.length_squared() >= f32::MIN_POSITIVE && cross.is_finite()) {
                return Err(EditError(format!("{element}: so small, or so far away, nothing is left of its area")));
            }
        }
    }
    Ok(())
}

/// Collects the lights anew, with the edits.
pub fn relight(file: &Scene, scene: &mut Scene, edits: &SceneEdits) -> Result<(), EditError> {
    let mut own: HashMap<u32, Vec3> = HashMap::new();
    for (&index, edit) in edits.lamps.iter().filter(|(_, edit)| edit.power.is_some() || edit.color.is_some()) {
        let lamp = lamp_of(file, index, edit)?;
        let radiance = lamp_radiance(scene.materials[lamp.material as usize].emission, edit)?;
        own.extend(lamp.triangles.iter().map(|&t| (t, radiance)));
    }
    let mut others: Vec<(String, Light)> = file.lights.dirac().map(|(name, light)| (name.to_owned(), *light)).collect();
    for (&index, edit) in &edits.lights {
        let Some((_, light)) = others.get_mut(index as usize).filter(|(name, _)| *name == edit.name) else {
            return Err(missing("light", index, &edit.name));
        };
        *light = changed(light, edit)?;
    }
    let environment = environment(file, edits)?;
    scene.collect_lights(others, environment, |triangle, emission| own.get(&triangle).copied().unwrap_or(emission));
    Ok(())
}

/// What a lamp whose material emits `emission` emits itself.
fn lamp_radiance(emission: Vec3, edit: &LampEdit) -> Result<Vec3, EditError> {
    let element = format!("lamp '{}'", edit.name);
    let power = within(edit.power.unwrap_or(1.0), POWERS, &element, "power")?;
    let (own, strength) = hue_and_strength(emission);
    let color = edit.color.map_or(Ok(own), |color| hue(color, &element, "colour"))?;
    radiance(if edit.color.is_some() { color * strength * power } else { emission * power }, &element)
}

/// A light of no extent with other numbers.
fn changed(light: &Light, edit: &LightEdit) -> Result<Light, EditError> {
    let element = format!("light '{}'", edit.name);
    let refuse = |what: &str| Err(EditError(format!("{element}: a {} light has no {what}", light.kind_name())));
    let (own_hue, own_strength) = hue_and_strength(light.radiance);
    let color = edit.color.map_or(Ok(own_hue), |color| hue(color, &element, "colour"))?;
    let strength = within(edit.strength.unwrap_or(own_strength), [0.0, f32::MAX], &element, "strength")?;
    let untouched = edit.color.is_none() && edit.strength.is_none();
    let radiance = if untouched { light.radiance } else { radiance(color * strength, &element)? };
    let mut changed = Light { radiance, ..*light };
    if let Some(by) = edit.offset {
        if !matches!(light.kind, POINT | SPOT) {
            return refuse("position");
        }
        changed.position = (light.position.as_dvec3() + offset(by, &element)?).as_vec3();
    }
    if let Some(direction) = edit.direction {
        if !matches!(light.kind, SPOT | DIRECTIONAL) {
            return refuse("direction");
        }
        let axis = Vec3::from(direction).as_dvec3().try_normalize().map(|axis: DVec3| axis.as_vec3());
        changed.axis = axis.ok_or_else(|| EditError(format!("{element}: its direction must be finite and not zero")))?;
    }
    if let Some([inner, outer]) = edit.cone {
        if light.kind != SPOT {
            return refuse("cone");
        }
        within(outer, CONES, &element, "cone's outer angle")?;
        within(inner, [0.0, outer], &element, "cone's inner angle")?;
        let angles = [inner, outer].map(|degrees| f64::from(degrees).to_radians());
        let spot = Light::spot(changed.position, changed.axis, radiance, angles);
        (changed.versine_inner, changed.versine_outer) = (spot.versine_inner, spot.versine_outer);
    }
    Ok(changed)
}

/// The environment, stronger and turned; `None` if there is none, or nothing left of it.
fn environment(file: &Scene, edits: &SceneEdits) -> Result<Option<Arc<Environment>>, EditError> {
    let edit = edits.environment;
    let Some(map) = &file.lights.environment else {
        return match edit.strength.is_some() || edit.rotation.is_some() {
            true => Err(EditError("the environment: the scene has none".to_owned())),
            false => Ok(None),
        };
    };
    let strength = within(edit.strength.unwrap_or(1.0), POWERS, "the environment", "strength")?;
    let turn = edit.rotation.unwrap_or_else(|| f64::from(map.rotation()) * 360.0);
    if !(turn.is_finite() && turn.abs() <= 1e6) {
        return Err(EditError(format!("the environment: it cannot be turned by {turn:?} degrees")));
    }
    if edit.strength.is_none() && edit.rotation.is_none() {
        return Ok(Some(Arc::clone(map)));
    }
    let brightest = map.texels.iter().map(|texel| texel.radiance.max_element()).fold(0.0, f32::max);
    radiance(Vec3::splat(brightest * strength), "the environment")?;
    Ok((strength > 0.0).then(|| Arc::new(map.changed(strength, edit.rotation))))
}
