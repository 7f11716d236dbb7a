//! Which materials are transparent, and how much.

use super::*;
use bdpt_explorer::scene::Hit;
use bdpt_explorer::scene::material::TRANSPARENT;

/// The texels' alpha of the upper left, upper right, lower left and lower right quarter.
fn masked(alpha: [u8; 4], mode: &str, cutoff: Option<f64>) -> Glb {
    let mut paint = lambert("paint", [1.0; 3]);
    paint["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": 0 });
    paint["alphaMode"] = json!(mode);
    if let Some(cutoff) = cutoff {
        paint["alphaCutoff"] = json!(cutoff);
    }
    let mut glb = with_coordinates(paint);
    glb.texture(&png([2, 2], &alpha.map(|a| [255, 255, 255, a])), json!({ "magFilter": 9728 }));
    glb
}

/// a in the four quarters of the square.
fn opacities(scene: &Scene) -> [f32; 4] {
    [(-0.25, 0.25), (0.25, 0.25), (-0.25, -0.25), (0.25, -0.25)].map(|(x, y)| {
        let at = point(scene, x, y);
        let b = at.look.barycentric;
        assert_eq!(at.look.opacity, scene.opacity(&Hit { distance: 1.0, triangle: at.triangle, b1: b.x, b2: b.y }));
        at.look.opacity
    })
}

fn is_transparent(scene: &Scene) -> bool {
    seen(scene).has(TRANSPARENT)
}

#[test]
fn blend_takes_alpha_as_it_is() {
    let scene = load(&masked([255, 204, 51, 0], "BLEND", None));
    for (a, expected) in opacities(&scene).into_iter().zip([1.0, 0.8, 0.2, 0.0]) {
        assert!((a - expected).abs() < 1e-6, "{a} {expected}");
    }
    assert!(scene.features.alpha_blend && !scene.features.alpha_mask && scene.notes.is_empty());
    // The factor's alpha multiplies.
    let mut glb = masked([255, 204, 51, 0], "BLEND", None);
    glb.json["materials"][1]["pbrMetallicRoughness"]["baseColorFactor"] = json!([1.0, 1.0, 1.0, 0.5]);
    assert!((opacities(&load(&glb))[1] - 0.4).abs() < 1e-6);
}

#[test]
fn mask_knows_only_there_and_not_there() {
    assert_eq!(opacities(&load(&masked([255, 128, 127, 0], "MASK", None))), [1.0, 1.0, 0.0, 0.0]);
    let scene = load(&masked([255, 128, 52, 50], "MASK", Some(0.2)));
    assert_eq!(opacities(&scene), [1.0, 1.0, 1.0, 0.0]);
    assert!(scene.features.alpha_mask && !scene.features.alpha_blend);
    // Above 1 nothing is there; at 0 all is.
    assert_eq!(opacities(&load(&masked([255; 4], "MASK", Some(1.5)))), [0.0; 4]);
    assert!(!is_transparent(&load(&masked([255, 128, 1, 0], "MASK", Some(0.0)))));
}

#[test]
fn what_is_opaque_all_over_is_no_transparent_material() {
    assert!(!is_transparent(&load(&masked([255, 128, 1, 0], "OPAQUE", None))));
    assert!(!is_transparent(&load(&masked([255; 4], "BLEND", None))));
    assert!(!is_transparent(&load(&masked([255, 200, 200, 129], "MASK", None))));
    let mut factor = lambert("paint", GREY);
    factor["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.5, 0.5, 0.5, 0.25]);
    assert!(!is_transparent(&load(&square(factor.clone()))));
    assert_eq!(point(&load(&square(factor.clone())), 0.1, 0.1).look.opacity, 1.0);
    factor["alphaMode"] = json!("BLEND");
    let scene = load(&square(factor.clone()));
    assert!(is_transparent(&scene) && point(&scene, 0.1, 0.1).look.opacity == 0.25);
    factor["alphaMode"] = json!("MASK");
    factor["alphaCutoff"] = json!(0.25);
    assert_eq!(point(&load(&square(factor)), 0.1, 0.1).look.opacity, 1.0);
}

#[test]
fn colours_at_vertices_have_alpha() {
    let mut paint = lambert("paint", GREY);
    paint["alphaMode"] = json!("BLEND");
    let mut glb = square(paint);
    let colors =
        glb.accessor(&[255, 255, 255, 102].repeat(4), json!({ "componentType": 5121, "normalized": true, "count": 4, "type": "VEC4" }));
    glb.attribute(1, "COLOR_0", colors);
    let scene = load(&glb);
    assert!(is_transparent(&scene));
    opacities(&scene).into_iter().for_each(|a| assert!((a - 0.4).abs() < 1e-6, "{a}"));
    glb.json["materials"][1]["alphaMode"] = json!("OPAQUE");
    assert!(!is_transparent(&load(&glb)));
}

#[test]
fn unlit_surfaces_may_have_holes() {
    let mut glb = masked([255, 255, 0, 0], "MASK", None);
    glb.json["materials"][1]["extensions"] = json!({ "KHR_materials_unlit": {} });
    let scene = load(&glb);
    assert_eq!(opacities(&scene), [1.0, 1.0, 0.0, 0.0]);
    assert!(scene.features.unlit && scene.features.alpha_mask);
}
