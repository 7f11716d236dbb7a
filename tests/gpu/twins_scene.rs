//! Twins: textures, points on surfaces, alpha. Bounds as in `twins`; where a function jumps (texels without interpolation, alpha
//! of a mask), an input counts only where Rust's own value is the same all around it.

use crate::compare::{Worst, random};
use crate::harness::{Work, gpu};
use crate::load::with_tangents;
use crate::table::{Table, bits};
use crate::{scenes, surface_scenes};
use bdpt_explorer::engine::Job;
use bdpt_explorer::gpu::Gpu;
use bdpt_explorer::math::{Vec2, Vec3};
use bdpt_explorer::scene::texture::{TextureUse, Wrap};
use bdpt_explorer::scene::{General, Hit, Material, Scene};
use std::sync::Arc;

/// Every wrap mode, interpolated or not, sRGB or not, with a transform; sets 0 and 1.
fn many_textures() -> Arc<Scene> {
    let mut room = scenes::Room::new("textures");
    let white = room.material(Material::lambert(Vec3::splat(0.5)));
    let byte = |x: u32, y: u32, k: u32| (x.wrapping_mul(2_654_435_761) ^ y.wrapping_mul(40_503) ^ k.wrapping_mul(977)) as u8;
    room.texture(8, true, |x, y| [byte(x, y, 1), byte(x, y, 2), byte(x, y, 3), byte(x, y, 4)]);
    room.texture(5, false, |x, y| [byte(x, y, 5), byte(x, y, 6), byte(x, y, 7), byte(x, y, 8)]);
    let parts = room.parts();
    parts.textures.clear();
    for i in 0..36u32 {
        let wrap = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp];
        let rows = if i % 4 < 2 { [Vec3::X, Vec3::Y] } else { [Vec3::new(1.3, -0.4, 0.2), Vec3::new(0.3, 0.9, -0.7)] };
        let wrap = [wrap[i as usize % 3], wrap[i as usize / 3 % 3]];
        parts.textures.push(TextureUse { wrap, nearest: i >= 18, set: i % 2, rows, ..TextureUse::of(i % 2, i % 2 == 0) });
    }
    room.quad([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], white);
    room.camera([0.0, 0.0, 4.0], [0.0; 3], 50.0);
    room.build()
}

#[test]
fn textures() {
    let Some(gpu) = gpu("textures") else { return };
    let body = "fn run_row(row: u32) {
        let v = texture_value(in_u(row, 0u), in_2(row, 1u));
        out_v(row, 0u, v.xyz);
        out_f(row, 3u, v.w);
    }";
    let work = Work::new(Job::new(many_textures()));
    let textures = &work.job.scene.textures;
    let mut inputs = Vec::new();
    for i in 0..7200 {
        let [u, v, ..] = random(1, i);
        let uv = (Vec2::new(u, v) - 0.5) * [1.0, 6.0, 50.0][i / 36 % 3];
        let texture = (i % 36) as u32;
        let value = textures.value(texture, uv);
        let jumps = [-1.0, 1.0].iter().any(|x| {
            [-1.0, 1.0].iter().any(|y| (textures.value(texture, uv + Vec2::new(*x, *y) * 1e-4) - value).abs().max_element() > 1e-2)
        });
        if !jumps {
            inputs.push((texture, uv));
        }
    }
    assert!(inputs.len() > 6500, "{}", inputs.len());
    let table: Vec<f32> = inputs.iter().flat_map(|&(texture, uv)| [bits(texture), uv.x, uv.y]).collect();
    let run = |change| {
        let out = Table { gpu, work: &work, change }.run(body, 3, 4, &table);
        // Places up to 50·8 texels carry 400 ε, the interpolation as much of the contrast between texels.
        let mut worst = Worst::new("texture_value", 2048.0);
        for (row, &(texture, uv)) in out.iter().zip(&inputs) {
            worst.within(row, &textures.value(texture, uv).to_array(), 1.0);
        }
        worst
    };
    run(None).finish();
    for change in
        [("2.0 * n - 1.0 - place", "2.0 * n - place"), ("SRGB) != 0u", "SRGB) == 0u"), ("floor(place - 0.5)", "floor(place - 0.4)")]
    {
        assert!(!run(Some(change)).holds(), "{change:?} goes unnoticed");
    }
}

const POINT: &str = "fn run_row(row: u32) {
    let triangle = in_u(row, 0u);
    let b = in_2(row, 1u);
    let p = surface_point(triangle, b);
    out_v(row, 0u, p.position);
    out_v(row, 3u, p.n_g);
    out_v(row, 6u, p.n_s);
    out_f(row, 9u, p.error);
    out_v(row, 10u, p.look.color);
    out_f(row, 13u, p.look.roughness);
    out_f(row, 14u, p.look.metallic);
    out_f(row, 15u, p.look.opacity);
    out_2(row, 16u, p.look.barycentric);
    out_f(row, 18u, opacity(Hit(triangle, 1.0, b.x, b.y)));
    out_v(row, 19u, emission_factor(triangle, p.material, b));
    out_u(row, 22u, p.material);
    out_u(row, 23u, p.light);
    out_f(row, 24u, survival_of(load_material(p.material), p.look.color, p.look.metallic));
}";

fn surface_points(gpu: &Gpu, scene: Arc<Scene>, change: Option<(&str, &str)>) -> [Worst; 8] {
    let work = Work::new(Job::new(scene));
    let scene = &work.job.scene;
    let mut inputs = Vec::new();
    for i in 0..scene.triangles.len().max(1500) {
        let [mut x, mut y, ..] = random(2, i);
        if x + y > 1.0 {
            (x, y) = (1.0 - x, 1.0 - y);
        }
        let (triangle, b) = ((i % scene.triangles.len()) as u32, Vec2::new(x, y));
        let hit = |b: Vec2| Hit { triangle, distance: 1.0, b1: b.x, b2: b.y };
        // Alpha of a mask, and texels without interpolation, jump.
        let look = scene.surface_point(&hit(b)).look;
        let jumps = [Vec2::X, Vec2::NEG_X, Vec2::Y, Vec2::NEG_Y].iter().any(|d| {
            let other = scene.surface_point(&hit(b + *d * 1e-4)).look;
            (other.opacity - look.opacity).abs() > 0.05 || (other.color - look.color).abs().max_element() > 0.05
        });
        if !jumps {
            inputs.push((triangle, b));
        }
    }
    let table: Vec<f32> = inputs.iter().flat_map(|&(triangle, b)| [bits(triangle), b.x, b.y]).collect();
    let out = Table { gpu, work: &work, change }.run(POINT, 3, 25, &table);
    let mut all = [
        Worst::new("surface_point: position", 8.0),
        Worst::new("surface_point: n_g", 32.0),
        // A normal map: a texel at 400 ε of its place, three normalisations.
        Worst::new("surface_point: n_s", 2048.0),
        Worst::new("surface_point: error", 16.0),
        Worst::new("surface_point: look", 2048.0),
        Worst::new("opacity", 2048.0),
        Worst::new("emission_factor", 2048.0),
        Worst::new("survival_of", 2048.0),
    ];
    let mut indices = Worst::new("surface_point: material, light", 0.0);
    for (row, &(triangle, b)) in out.iter().zip(&inputs) {
        let hit = Hit { triangle, distance: 1.0, b1: b.x, b2: b.y };
        let p = scene.surface_point(&hit);
        let corners = &scene.triangles[triangle as usize];
        let size = [corners.p0, corners.p1, corners.p2].map(|p| p.abs().max_element()).into_iter().fold(0.0, f32::max);
        let [position, n_g, n_s, error, look, alpha, emission, survival] = &mut all;
        position.within(&row[..3], &p.position.to_array(), size);
        n_g.within(&row[3..6], &p.n_g.to_array(), 1.0);
        n_s.within(&row[6..9], &p.n_s.to_array(), 1.0);
        error.relative(&row[9..10], &[p.error]);
        let l = &p.look;
        let expected = [l.color.x, l.color.y, l.color.z, l.roughness, l.metallic, l.opacity, l.barycentric.x, l.barycentric.y];
        look.within(&row[10..18], &expected, 1.0);
        alpha.within(&row[18..19], &[scene.opacity(&hit)], 1.0);
        emission.within(&row[19..22], &scene.emission_factor::<General>(triangle, p.material, b).to_array(), 1.0);
        indices.exact(&[row[22].to_bits(), row[23].to_bits()], &[p.material, p.light]);
        let material = &scene.materials[p.material as usize];
        survival.within(&row[24..], &[material.survival_of(l.color, l.metallic)], 1.0);
    }
    assert!(indices.holds(), "{indices:?}");
    all
}

#[test]
fn points_on_surfaces() {
    let Some(gpu) = gpu("points_on_surfaces") else { return };
    let scenes = [
        surface_scenes::textured(),
        surface_scenes::holes(),
        surface_scenes::veils(false),
        scenes::builtin("normal-map"),
        with_tangents(),
        scenes::specular(),
    ];
    for scene in scenes {
        println!("{}", scene.name);
        surface_points(gpu, scene, None).iter().for_each(Worst::finish);
    }
    for change in [
        ("MIN_COS: f32 = 1e-3", "MIN_COS: f32 = 0.99"),
        ("copysign(1.0, -det)", "copysign(1.0, det)"),
        ("look.roughness *= values[1].y", "look.roughness *= values[1].z"),
    ] {
        assert!(surface_points(gpu, surface_scenes::textured(), Some(change)).iter().any(|worst| !worst.holds()), "{change:?}");
    }
}
