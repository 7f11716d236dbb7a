//! Twins that read the scene: textures, points on surfaces, alpha, the environment, lights, the camera.
//!
//! Bounds as in `twins`. Where a function jumps (the texel without interpolation, the cell of a map, the edge of the lens), an
//! input counts only where Rust's own value is the same all around it.

use crate::compare::{Worst, direction, random};
use crate::harness::{Work, gpu};
use crate::table::{Table, bits};
use crate::{emitters_scenes, scenes, surface_scenes};
use bdpt_explorer::engine::Job;
use bdpt_explorer::gpu::Gpu;
use bdpt_explorer::math::{Vec2, Vec3};
use bdpt_explorer::scene::texture::{TextureUse, Wrap};
use bdpt_explorer::scene::{General, Hit, Material, Scene};
use std::sync::Arc;

fn scene_work(scene: Arc<Scene>) -> Work {
    Work::new(Job { size: [48, 32], ..Job::new(scene) })
}

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
    let work = scene_work(many_textures());
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
    let work = scene_work(scene);
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
        scenes::specular(),
    ];
    for scene in scenes {
        println!("{}", scene.name);
        surface_points(gpu, scene, None).iter().for_each(Worst::finish);
    }
    for change in [("MIN_COS: f32 = 1e-3", "MIN_COS: f32 = 0.99"), ("look.roughness *= values[1].y", "look.roughness *= values[1].z")] {
        assert!(surface_points(gpu, surface_scenes::textured(), Some(change)).iter().any(|worst| !worst.holds()), "{change:?}");
    }
}

const ENVIRONMENT: &str = "fn run_row(row: u32) {
    let w = in_v(row, 0u);
    out_v(row, 0u, environment_radiance(w));
    out_f(row, 3u, environment_pdf_sa(w));
    let place = vec2<f32>(in_f(row, 5u), in_f(row, 6u));
    out_v(row, 4u, environment_sample(in_2(row, 3u), place));
    out_u(row, 7u, choose(control.params.environment_choice, control.params.environment_cells, in_2(row, 3u)));
    out_u(row, 8u, choose(control.params.light_choice, control.params.light_cells, in_2(row, 3u)));
    let x = sphere_before(w, place);
    out_v(row, 9u, x);
    out_f(row, 12u, sphere_beyond(x));
}";

fn environment(gpu: &Gpu, scene: Arc<Scene>, change: Option<(&str, &str)>) -> [Worst; 6] {
    let work = scene_work(scene);
    let (scene, sphere) = (&work.job.scene, &work.view.sphere);
    let map = scene.lights.environment.as_ref().unwrap();
    let axes = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
    let inputs: Vec<_> = (0..3000).map(|i| (axes.get(i).copied().unwrap_or_else(|| direction(3, i)), random(4, i))).collect();
    let table: Vec<f32> = inputs.iter().flat_map(|(w, u)| [&w.to_array()[..], u].concat()).collect();
    let out = Table { gpu, work: &work, change }.run(ENVIRONMENT, 7, 13, &table);
    let brightest = map.texels.iter().map(|texel| texel.radiance.max_element()).fold(0.0, f32::max);
    let mut all = [
        // A place is known to 16 ε turns of `turn_of`; a map of n texels has n times that.
        Worst::new("environment_radiance", 1024.0),
        Worst::new("environment_pdf_sa", 0.0),
        Worst::new("environment_sample", 64.0),
        Worst::new("choose", 0.0),
        Worst::new("sphere_before", 64.0),
        Worst::new("sphere_beyond", 64.0),
    ];
    for (row, &(w, u)) in out.iter().zip(&inputs) {
        let [radiance, pdf, sample, choose, before, beyond] = &mut all;
        radiance.within(&row[..3], &map.radiance(w).to_array(), brightest);
        // At the edge of a texel a rounding decides.
        let around = |d: Vec3| map.pdf_sa((w + d * 1e-5).normalize());
        if axes.iter().all(|&d| around(d) == map.pdf_sa(w)) {
            pdf.relative(&row[3..4], &[map.pdf_sa(w)]);
        }
        let (choice, place) = (Vec2::new(u[0], u[1]), Vec2::new(u[2], u[3]));
        sample.within(&row[4..7], &map.sample(choice, place).to_array(), 1.0);
        choose.exact(&[row[7].to_bits(), row[8].to_bits()], &[map.choice.choose(choice), scene.lights.choice.choose(choice)]);
        let x = sphere.before(w, place);
        before.within(&row[9..12], &x.to_array(), sphere.radius);
        beyond.relative(&row[12..], &[sphere.beyond(x)]);
    }
    all
}

#[test]
fn light_from_infinity() {
    let Some(gpu) = gpu("light_from_infinity") else { return };
    for scene in [emitters_scenes::under_the_sky(), scenes::builtin("normal-map")] {
        println!("{}", scene.name);
        environment(gpu, scene, None).iter().for_each(Worst::finish);
    }
    for change in [("environment_rotation + 0.5", "environment_rotation + 0.501"), ("u.y >= cell.threshold", "u.y >= cell.threshold * 0.9")]
    {
        assert!(environment(gpu, emitters_scenes::under_the_sky(), Some(change)).iter().any(|worst| !worst.holds()), "{change:?}");
    }
}

const LIGHTS: &str = "fn run_row(row: u32) {
    let light = load_light(in_u(row, 0u));
    let n = in_v(row, 1u);
    let w = in_v(row, 4u);
    out_f(row, 0u, l_e_1(light, n, w));
    out_f(row, 1u, light_pdf_direction_psa(light, n, w, 0.25));
    out_v(row, 2u, l_e_0(light));
    out_v(row, 5u, l_e(light, n, w));
    out_f(row, 8u, pdf_origin(light, w));
    if !is_infinite(light) { out_v(row, 9u, light_sample_direction(light, n, in_2(row, 7u), in_f(row, 9u))); }
}";

#[test]
fn lights() {
    let Some(gpu) = gpu("lights") else { return };
    let work = scene_work(emitters_scenes::everything());
    let lights = &work.job.scene.lights;
    let kinds: std::collections::BTreeSet<u32> = lights.list.iter().map(|light| light.kind).collect();
    assert_eq!(kinds.len(), 5, "every kind");
    let inputs: Vec<_> = (0..3000)
        .map(|i| {
            let light = i % lights.list.len();
            let (n, mut w) = (direction(5, i), direction(6, i));
            if i % 2 == 0 && lights.list[light].axis != Vec3::ZERO {
                w = (lights.list[light].axis + w * 0.6 * random(7, i)[3]).normalize();
            }
            (light as u32, n, w, random(7, i))
        })
        .filter(|(_, n, w, _)| n.dot(*w).abs() > 1e-4)
        .collect();
    let table: Vec<f32> =
        inputs.iter().flat_map(|(light, n, w, u)| [&[bits(*light)][..], &n.to_array(), &w.to_array(), &u[..3]].concat()).collect();
    let run = |change| {
        let out = Table { gpu, work: &work, change }.run(LIGHTS, 10, 12, &table);
        let mut all = [
            // A spot's falloff is a difference of versines, 0.02 apart: 8 ε become 400.
            Worst::new("l_e_1", 2048.0),
            Worst::new("pdf_direction_psa", 2048.0),
            Worst::new("l_e_0", 16.0),
            Worst::new("l_e", 1024.0),
            Worst::new("pdf_origin", 16.0),
            Worst::new("sample_direction", 64.0),
        ];
        for (row, &(index, n, w, u)) in out.iter().zip(&inputs) {
            let light = &lights.list[index as usize];
            let [e1, pdf, e0, emitted, origin, sample] = &mut all;
            let greatest = light.l_e_1(n, if light.axis == Vec3::ZERO { w } else { light.axis }).max(0.01);
            e1.within(&row[..1], &[light.l_e_1(n, w)], greatest);
            pdf.within(&row[1..2], &[light.pdf_direction_psa(n, w, 0.25)], greatest);
            e0.relative(&row[2..5], &light.l_e_0().to_array());
            let map = lights.environment.as_ref().unwrap();
            let edge = light.kind == bdpt_explorer::scene::light::ENVIRONMENT
                && [Vec3::X, Vec3::Y, Vec3::Z].iter().any(|d| map.pdf_sa(-(w + *d * 1e-5).normalize()) != map.pdf_sa(-w));
            emitted.relative(&row[5..8], &lights.l_e(light, n, w).to_array());
            if light.area > 0.0 || light.kind == bdpt_explorer::scene::light::ENVIRONMENT && !edge {
                origin.relative(&row[8..9], &[lights.pdf_origin(light, w)]);
            }
            if !light.is_infinite() {
                sample.within(&row[9..12], &light.sample_direction(n, Vec2::new(u[0], u[1]), u[2]).to_array(), 1.0);
            }
        }
        all
    };
    run(None).iter().for_each(Worst::finish);
    for change in [
        ("return 0.25 * INV_PI", "return 0.26 * INV_PI"),
        ("return ramp * ramp", "return ramp"),
        ("inner + fall * (1.0 / 3.0)", "inner + fall * (1.0 / 3.1)"),
    ] {
        assert!(run(Some(change)).iter().any(|worst| !worst.holds()), "{change:?} goes unnoticed");
    }
}

const CAMERA: &str = "fn run_row(row: u32) {
    let u = in_2(row, 0u);
    let raster = in_2(row, 2u);
    let lens = sample_lens(u);
    out_v(row, 0u, lens);
    let w = camera_direction(raster, lens);
    out_v(row, 3u, w);
    let back = project(w, lens);
    out_2(row, 6u, back.at);
    out_f(row, 8u, pdf_direction_psa_on_film(w));
    out_f(row, 9u, w_e_1_on_film(w));
    out_u(row, 10u, u32(inside_film(back.at)));
    let crossed = cross_lens(in_v(row, 4u), in_v(row, 7u));
    out_u(row, 11u, u32(crossed.some));
    out_v(row, 12u, crossed.point);
    out_f(row, 15u, inside_cell(u32(raster.x), u.x));
}";

#[test]
fn the_camera() {
    let Some(gpu) = gpu("the_camera") else { return };
    for (scene, pinhole) in [(emitters_scenes::wide_lens(), false), (scenes::builtin("cornell"), true)] {
        let work = scene_work(scene);
        let view = &work.view;
        let radius = view.lens.radius;
        let mut inputs = Vec::new();
        for i in 0..3000 {
            let [u, v, x, y] = random(8, i);
            let raster = Vec2::new(x * 48.0, y * 32.0);
            // From a point in front, to about the lens.
            let to = view.position + direction(9, i) * (radius * 1.5);
            let origin = view.position + view.axis * 2.0 + direction(10, i);
            inputs.push((Vec2::new(u, v), raster, origin, (to - origin).normalize() * if i % 9 == 0 { -1.0 } else { 1.0 }));
        }
        let table: Vec<f32> = inputs
            .iter()
            .flat_map(|(u, raster, origin, w)| [&u.to_array()[..], &raster.to_array(), &origin.to_array(), &w.to_array()].concat())
            .collect();
        let run = |change| {
            let out = Table { gpu, work: &work, change }.run(CAMERA, 10, 16, &table);
            let mut all = [
                Worst::new("sample_lens", 32.0),
                Worst::new("direction", 64.0),
                Worst::new("project", 64.0),
                Worst::new("pdf_direction_psa", 64.0),
                Worst::new("cross_lens at all", 0.0),
                // A pinhole is met by no ray at random, and its point is its place.
                Worst::new("cross_lens", 128.0),
                Worst::new("inside_cell", 0.0),
            ];
            for (row, &(u, raster, origin, w)) in out.iter().zip(&inputs) {
                let [lens, direction, project, pdf, crosses, point, cell] = &mut all;
                let at = view.sample_lens(u);
                let size = view.position.abs().max_element() + radius;
                lens.within(&row[..3], &at.to_array(), size);
                let out_w = view.direction(raster, at);
                direction.within(&row[3..6], &out_w.to_array(), 1.0);
                project.within(&row[6..8], &view.project(out_w, at).unwrap().to_array(), 48.0);
                pdf.relative(&row[8..10], &[view.pdf_direction_psa_on_film(out_w), view.w_e_1_on_film(out_w)]);
                let crossed = view.cross_lens(origin, w);
                // How far from the middle of the lens: its very rim is a matter of rounding.
                let towards = (view.position - origin).dot(view.axis) / w.dot(view.axis);
                let from_middle = (origin + w * towards - view.position).length();
                if (from_middle - radius).abs() > 1e-3 * radius {
                    crosses.exact(&[row[11].to_bits()], &[u32::from(crossed.is_some())]);
                    if let Some(crossed) = crossed {
                        point.within(&row[12..15], &crossed.to_array(), size);
                    }
                }
                let x = raster.x as u32;
                cell.relative(&row[15..], &[(x as f32 + u.x).min(((x + 1) as f32).next_down())]);
            }
            all
        };
        println!("{}", work.job.scene.name);
        run(None).iter().filter(|worst| !pinhole || !worst.is_empty()).for_each(Worst::finish);
        if !pinhole {
            for change in [
                ("sample_disk(u) * control.params.lens_radius", "sample_disk(u) * 0.69"),
                ("(1.0 - at.y) * 0.5", "(1.0 - at.y) * 0.501"),
                ("distance > 0.0)", "distance > 2.0)"),
            ] {
                assert!(run(Some(change)).iter().any(|worst| !worst.holds()), "{change:?} goes unnoticed");
            }
        }
    }
}
