//! Edits of a material: its recipe with other numbers, cooked again.

use super::super::material::UNLIT;
use super::super::{Recipe, Scene};
use super::{EditError, IORS, MaterialEdit, hue, missing, radiance, within};
use crate::math::Vec3;

const UNIT: [f32; 2] = [0.0, 1.0];

/// Changes a material of `scene`; true if what it emits differs from the file.
pub fn apply(file: &Scene, scene: &mut Scene, index: u32, edit: &MaterialEdit) -> Result<bool, EditError> {
    let i = index as usize;
    let known = file.material_names.get(i).is_some_and(|name| *name == edit.name);
    let (Some(own), Some(recipe), true) = (file.materials.get(i), file.recipes.get(i), known) else {
        return Err(missing("material", index, &edit.name));
    };
    let recipe = changed(recipe, edit, own.has(UNLIT))?;
    scene.materials[i] = recipe.material(own).finished();
    scene.recipes[i] = recipe;
    Ok(recipe.emission != file.recipes[i].emission)
}

fn changed(recipe: &Recipe, edit: &MaterialEdit, unlit: bool) -> Result<Recipe, EditError> {
    let (mut recipe, element) = (*recipe, format!("material '{}'", edit.name));
    let refuse = |what: &str, why: &str| Err(EditError(format!("{element}: its {what} cannot be changed, {why}")));
    if let Some(color) = edit.color {
        if unlit {
            return refuse("base colour", "as it is unlit: change its emission");
        }
        recipe.color = hue(color, &element, "base colour")?;
    }
    for (value, place, what) in
        [(edit.roughness, &mut recipe.roughness, "roughness"), (edit.metallic, &mut recipe.metallic, "metallic share")]
    {
        let Some(value) = value else { continue };
        if unlit || recipe.glass.is_some() {
            return refuse(what, if unlit { "as it is unlit" } else { "as it is clear glass" });
        }
        *place = within(value, UNIT, &element, what)?;
    }
    if let Some(ior) = edit.ior {
        recipe.ior = Some(within(ior, IORS, &element, "index of refraction")?);
    }
    if edit.emission_color.is_some() || edit.emission_strength.is_some() {
        let (own_hue, own_strength) = hue_and_strength(recipe.emission);
        let color = edit.emission_color.map_or(Ok(own_hue), |color| hue(color, &element, "emission's colour"))?;
        let strength = edit.emission_strength.unwrap_or(own_strength);
        within(strength, [0.0, f32::MAX], &element, "strength")?;
        recipe.emission = radiance(color * strength, &element)?;
    }
    Ok(recipe)
}

/// A radiance as a hue whose largest channel is 1, and its strength; black is white of strength 0.
pub fn hue_and_strength(radiance: Vec3) -> (Vec3, f32) {
    let strength = radiance.max_element();
    if strength > 0.0 { (radiance / strength, strength) } else { (Vec3::ONE, 0.0) }
}
