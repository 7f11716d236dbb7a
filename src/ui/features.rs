//! What a scene needs of a renderer, in the words of the reader.

use super::state::State;
use super::text::{Text, fill};
use crate::scene::Scene;

/// The features by their names in reports.
const TABLE: [(&str, Text); 18] = [
    ("area lights", Text::FeatureAreaLights),
    ("two-sided emitters", Text::FeatureTwoSided),
    ("point lights", Text::FeaturePoint),
    ("spot lights", Text::FeatureSpot),
    ("directional lights", Text::FeatureDirectional),
    ("environment", Text::FeatureEnvironment),
    ("mirror", Text::FeatureMirror),
    ("glass", Text::FeatureGlass),
    ("thin glass", Text::FeatureThinGlass),
    ("rough metal", Text::FeatureRoughMetal),
    ("coat", Text::FeatureCoat),
    ("unlit", Text::FeatureUnlit),
    ("textures", Text::FeatureTextures),
    ("vertex colours", Text::FeatureVertexColors),
    ("normal maps", Text::FeatureNormalMaps),
    ("shading normals", Text::FeatureShadingNormals),
    ("alpha mask", Text::FeatureAlphaMask),
    ("alpha blend", Text::FeatureAlphaBlend),
];

/// How many triangles a scene has, which features are in use, and what its textures take, in a line or two.
pub fn sentence(state: &State, scene: &Scene) -> String {
    let word = |name: &&'static str| TABLE.iter().find(|(key, _)| key == name).map_or(*name, |(_, text)| state.say(*text));
    let names: Vec<&str> = scene.features.names().iter().map(word).collect();
    let needs = fill(state.say(Text::SceneNeeds), &[&scene.triangles.len().to_string(), &names.join(", ")]);
    match scene.textures.bytes() {
        0 => needs,
        bytes => format!("{needs}\n{}", fill(state.say(Text::SceneTextures), &[&size(bytes)])),
    }
}

/// A number of bytes as one reads it.
fn size(bytes: usize) -> String {
    match bytes as f64 {
        bytes if bytes < 1e3 => format!("{bytes} B"),
        bytes if bytes < 1e6 => format!("{:.1} kB", bytes / 1e3),
        bytes => format!("{:.1} MB", bytes / 1e6),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::SceneFeatures;

    #[test]
    fn every_feature_has_its_words() {
        let names = SceneFeatures::all().names();
        assert_eq!(names, TABLE.map(|(name, _)| name));
    }
}
