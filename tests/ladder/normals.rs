//! Normal maps in both directions of transport: no light comes through a wall, and nothing is black that need not be.

use crate::images::{job, rendered};
use crate::sampling::numbers;
use crate::scenes::Room;
use bdpt_explorer::bdpt::{Settings, Strategy};
use bdpt_explorer::engine::Job;
use bdpt_explorer::math::{Vec2, Vec3, sample_sphere};
use bdpt_explorer::rng::pair;
use bdpt_explorer::scene::{Bsdf, Look, Material, Scene, TransportMode};
use std::sync::Arc;

/// A closed box of normal-mapped walls in a bright sky; the camera is inside, a lamp inside or outside.
fn sealed(lamp_inside: bool) -> Arc<Scene> {
    let mut room = Room::new("sealed");
    let noise = |x: u32, y: u32, k: u32| (x.wrapping_mul(374_761_393) ^ y.wrapping_mul(668_265_263) ^ k.wrapping_mul(2_246_822_519)) >> 9;
    // Normals that lean as far as a map can make them.
    let bumps = room.texture(8, false, |x, y| [noise(x, y, 1) as u8, noise(x, y, 2) as u8, 128 + (noise(x, y, 3) % 64) as u8, 255]);
    let matte = Material { normal_texture: bumps, ..Material::lambert(Vec3::splat(0.8)) }.finished();
    let paint = Material { normal_texture: bumps, normal_scale: 2.0, ..Material::coat(Vec3::splat(0.8), 0.4, 0.3, 1.5) }.finished();
    let (matte, paint) = (room.material(matte), room.material(paint));
    room.cuboid([-1.0; 3], [1.0; 3], true, [matte, paint, matte, paint, matte, paint]);
    room.unwrap_uvs(40.0);
    let lamp = room.emitter(5.0, 0.0, true);
    let y = if lamp_inside { 0.8 } else { 1.8 };
    room.quad([-0.4, y, -0.4], [0.8, 0.0, 0.0], [0.0, 0.0, 0.8], lamp);
    room.environment(bdpt_explorer::scene::Environment::constant(Vec3::splat(if lamp_inside { 1e-6 } else { 3.0 })));
    room.camera([0.0, 0.0, 0.9], [0.0, -0.2, -1.0], 80.0);
    room.build()
}

#[test]
fn no_light_leaks_through_walls() {
    let settings = Settings { max_edges: 5, ..Settings::default() };
    let dark = rendered(Job { raw_layers: true, ..job(&sealed(false), [32, 32], settings) }, 16);
    assert!(dark.image().iter().all(|c| *c == Vec3::ZERO), "light comes through a wall");
    for strategy in dark.layers() {
        assert!(dark.layer(strategy, false).unwrap().iter().all(|c| *c == Vec3::ZERO), "by {strategy}");
    }
    // Negative control: with the lamp inside every part of the picture is lit, by connections and by splats.
    let lit = rendered(Job { raw_layers: true, ..job(&sealed(true), [32, 32], settings) }, 64);
    // Where the map leans a normal away from the eye, the two normals disagree and nothing is scattered; elsewhere nothing is
    // black. Pixels are wider than the map's texels, so each sees both.
    let black = lit.image().iter().filter(|c| c.max_element() <= 1e-4).count();
    assert!(black == 0, "{black} pixels are black");
    for strategy in [Strategy::new(1, 2), Strategy::new(2, 2), Strategy::new(3, 1)] {
        assert!(lit.layer(strategy, false).unwrap().iter().any(|c| c.max_element() > 0.0), "{strategy}");
    }
}

/// f̄ is 0 where the two normals disagree on a direction's side, or the directions lie on different sides, and nowhere else;
/// where it is not 0, both walks can draw it.
#[test]
fn only_a_disagreement_of_the_normals_is_black() {
    let materials =
        [Material::lambert(Vec3::splat(0.7)), Material::coat(Vec3::splat(0.5), 0.5, 0.2, 1.5), Material::conductor(Vec3::ONE, 0.6)];
    let (mut lit, mut black) = (0, 0);
    for i in 0..30_000 {
        let material = &materials[i as usize % 3];
        let n_g = sample_sphere(pair(numbers(i, 20), 0));
        let lean = sample_sphere(pair(numbers(i, 21), 0)) * 0.99;
        let n_s = (n_g + lean).normalize();
        let (w_l, w_e) = (sample_sphere(pair(numbers(i, 22), 0)), sample_sphere(pair(numbers(i, 23), 0)));
        let sides = [n_g, n_s].map(|n| [w_l, w_e].map(|w| w.dot(n) > 0.0));
        let agree = sides[0] == sides[1] && sides[0][0] == sides[0][1];
        let look = Look::of(material);
        let bsdf = Bsdf::new(n_g, n_s, material, &look);
        let f = bsdf.eval(w_l, w_e);
        assert_eq!(f.max_element() > 0.0, agree, "{f} {n_g} {n_s} {w_l} {w_e}");
        let pdfs = [bsdf.pdf_psa(w_e, w_l, TransportMode::Radiance), bsdf.pdf_psa(w_l, w_e, TransportMode::Importance)];
        assert!(pdfs.iter().all(|&p| (p > 0.0) == agree && p.is_finite()), "{pdfs:?}");
        (lit, black) = (lit + u32::from(agree), black + u32::from(!agree));
    }
    assert!(lit > 3000 && black > 3000);
}

/// The map's x leans the normal along ∂p/∂u, its y against ∂p/∂v (v points down), however the triangle is turned, and however
/// KHR_texture_transform turns the texture on it.
#[test]
fn maps_lean_the_way_the_texture_runs() {
    let sides = [([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]), ([0.0, 1.0, 0.0], [1.0, 0.0, 0.0]), ([0.0, 0.0, -2.0], [0.3, 1.0, 0.0])];
    // The last one is the first, its texture turned by a quarter: u′ = v, v′ = −u.
    let quarter = [Vec3::Y, Vec3::NEG_X];
    for (i, (u, v)) in sides.into_iter().chain([sides[0]]).enumerate() {
        let mut room = Room::new("map");
        let leaning = room.texture(1, false, |_, _| [128 + 60, 128 + 40, 230, 255]);
        if i == 3 {
            room.parts().textures[0].rows = quarter;
        }
        let material = room.material(Material { normal_texture: leaning, ..Material::lambert(Vec3::ONE) }.finished());
        room.textured_quad([0.0; 3], u, v, material, (1.0, [glam::Vec4::ONE; 4]));
        room.camera([0.0, 0.0, 3.0], [0.0; 3], 40.0);
        room.environment(bdpt_explorer::scene::Environment::constant(Vec3::ONE));
        let scene = room.build();
        let (u, v) = (Vec3::from(u.map(|x| x as f32)).normalize(), Vec3::from(v.map(|x| x as f32)).normalize());
        let (u, v) = if i == 3 { (v, -u) } else { (u, v) };
        for triangle in 0..2 {
            let point = scene.point_on_triangle(triangle, Vec2::splat(0.3));
            let (x, y, z) = (60.5 / 127.5, 40.5 / 127.5, 230.0 / 127.5 - 1.0);
            let length = Vec3::new(x, y, z).length();
            // The tangent is ∂p/∂u, the other axis is perpendicular to it on −v's side.
            let against_v = (u * v.dot(u) - v).normalize();
            let expected = (u * x + against_v * y + point.n_g * z) / length;
            assert!((point.n_s - expected).length() < 1e-5, "{} instead of {expected}", point.n_s);
            assert!((point.n_s - point.n_g).length() > 0.3, "the control: the map does lean it");
        }
    }
}
