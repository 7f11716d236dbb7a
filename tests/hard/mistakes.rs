//! Mistakes of other renderers, made on purpose: the comparison of strategies, or the replay of paths, finds each of them, and nothing
//! where none is made.

use crate::lab::{Mistake, compare, job};
use crate::scenes::{self, Room};
use crate::{emitters_scenes, surface_scenes};
use bdpt_explorer::bdpt::connect::Sample;
use bdpt_explorer::bdpt::path::FullPath;
use bdpt_explorer::bdpt::vertex::{AT_INFINITY, DISCRETE};
use bdpt_explorer::bdpt::{Settings, Strategy, Vertex};
use bdpt_explorer::engine::Job;
use bdpt_explorer::math::Vec3;
use bdpt_explorer::report::check::Control;
use bdpt_explorer::report::check::replay::{Findings, sweep};
use bdpt_explorer::report::check::sweep::{Budget, Task};
use bdpt_explorer::scene::{DIELECTRIC, Material, Scene};
use bdpt_explorer::task::block_on;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// |w·n_s| / |w·n_g|.
fn normal_ratio(v: &Vertex, w: Vec3) -> f64 {
    f64::from((w.dot(v.n_s) / w.dot(v.n_g)).abs())
}

/// What f̄ of the light's vertex i is wrong by if it has the ratio of normals for ω_E where it belongs to ω_L.
fn uncorrected(sample: &Sample, x: Strategy, i: usize) -> f64 {
    let (y, z) = (sample.light_vertices(x), sample.eye_vertices(x));
    let Some(next) = y.get(i + 1).or(z.last()) else { return 1.0 };
    let v = &y[i];
    normal_ratio(v, (next.position - v.position).normalize()) / normal_ratio(v, v.w_prev)
}

/// Case 3. A light walk that scatters about the shading normal as an eye walk does (pbrt-v4 #385, #526), and one that is right but
/// for its connections (pbrt-v3 #87, #94).
#[test]
fn shading_normals_are_corrected_on_the_light_side() {
    let everywhere: Mistake = |_, sample, x, value| (1..sample.light_vertices(x).len()).fold(value, |v, i| v * uncorrected(sample, x, i));
    let connections: Mistake = |_, sample, x, value| match sample.light_vertices(x).len() {
        s if s >= 2 && x.t >= 1 => value * uncorrected(sample, x, s - 1),
        _ => value,
    };
    let job = job(&surface_scenes::glossy_tilted(), [24, 24], Settings { max_edges: 3, ..Settings::default() });
    compare(&job, 150_000, everywhere).holds("uncorrected");
    compare(&job, 150_000, connections).holds("uncorrected in connections");
}

/// Radiance that is refracted without (η_E/η_L)²: seen from outside into a glass ball with a lamp in it, eye paths differ from light
/// paths by n².
#[test]
fn radiance_is_compressed_and_importance_is_not() {
    let uncompressed: Mistake = |context, sample, x, value| {
        let z = sample.eye_vertices(x);
        (1..z.len().saturating_sub(1)).fold(value, |value, j| {
            let (v, material) = (&z[j], &context.scene.materials[z[j].material as usize]);
            let (before, after) = (v.w_prev.dot(v.n_g), (z[j + 1].position - v.position).dot(v.n_g));
            let n2 = f64::from(material.ior * material.ior);
            match material.kind == DIELECTRIC && before * after < 0.0 {
                true if before > 0.0 => value * n2,
                true => value / n2,
                false => value,
            }
        })
    };
    let mut room = Room::new("a large lamp in a large ball");
    let white = room.material(Material::lambert(Vec3::splat(0.6)));
    let glass = room.material(Material::dielectric(Vec3::ONE, 1.5, false));
    let lamp = room.emitter(2.0, 0.2, true);
    room.cuboid([-1.0; 3], [1.0; 3], true, [white; 6]);
    room.sphere([0.0, 0.0, -0.2], 0.75, 24, true, glass);
    room.quad([-0.4, 0.0, -0.6], [0.8, 0.0, 0.0], [0.0, 0.1, 0.8], lamp);
    room.camera([0.0, 0.0, 0.95], [0.6, 0.1, -0.2], 80.0);
    let job = job(&room.build(), [24, 24], Settings { max_edges: 4, ..Settings::default() });
    compare(&job, 120_000, uncompressed).holds("uncompressed");
}

/// Case 24. Throughput divided by the survival of a vertex at which no roulette was played yet: the connected ends (LuxCore, 7 to 12 %
/// too bright).
#[test]
fn the_roulette_of_connected_ends_is_not_played() {
    let divided: Mistake = |_, sample, x, value| {
        let (y, z) = (sample.light_vertices(x), sample.eye_vertices(x));
        let q = |v: Option<&Vertex>| v.map_or(1.0, |v| f64::from(v.survival));
        if x.s >= 1 && x.t >= 1 { value / (q(y.last()) * q(z.last())) } else { value }
    };
    let job = job(&scenes::furnace(1.0, 0.9), [24, 24], Settings { max_edges: 3, ..Settings::default() });
    compare(&job, 60_000, divided).holds("divided");
}

/// Case 22. Next-event estimation that believes its light was chosen with another probability than it was (pbrt-v3 9192918, 5c67509).
#[test]
fn the_light_is_chosen_with_one_probability() {
    let uniform: Mistake = |context, sample, x, value| {
        let lights = &context.scene.lights.list;
        match sample.light_vertices(x).first() {
            Some(y) if x.s == 1 && x.t >= 2 => value * f64::from(lights[y.light as usize].pmf) * lights.len() as f64,
            _ => value,
        }
    };
    let job = job(&emitters_scenes::everything(), [24, 24], Settings { max_edges: 3, ..Settings::default() });
    compare(&job, 120_000, uniform).holds("as if all lights were as likely");
}

/// Case 6 and 28. A clamp of unweighted contributions: what is rare and bright is missing from one strategy and not from the other.
#[test]
fn a_clamp_is_a_loss() {
    let clamped: Mistake = |_, _, _, value| value.min(0.3);
    let job = job(&scenes::builtin("cornell"), [24, 24], Settings { max_edges: 3, ..Settings::default() });
    compare(&job, 80_000, clamped).holds("clamped");
}

/// Spoils a rebuilt path, given its vertices and the s of the strategy that rebuilt it.
type Spoil = fn(&mut FullPath, &[Vertex], usize);

fn replay(scene: &Arc<Scene>, spoil: Spoil) -> Findings {
    let job = Job { settings: Settings { max_edges: 5, seed: 3, ..Settings::default() }, ..job(scene, [48, 36], Settings::default()) };
    let (cancel, view, settings) = (AtomicBool::new(false), job.view(), job.settings);
    let (budget, control) = (Budget { samples: 1500, time: Duration::MAX }, Control { path: spoil, ..Control::default() });
    block_on(sweep(&mut Task { job: &job, view, budget, control, cancel: &cancel, tell: &mut |_| {} }, &settings)).0
}

/// What a mistake in the weights alone does cannot be seen in a picture's mean; paths rebuilt by every strategy show it.
#[test]
fn replay_finds_the_mistakes_that_pictures_hide() {
    /// Case 5: a directional light taken for one that an eye path can hit (pbrt-v3 #69).
    const DIRECTIONAL: Spoil = |path, x, _| {
        if x[0].has(DISCRETE) && x[0].has(AT_INFINITY) {
            path.active[0] = true;
        }
    };
    /// Case 12: at infinity, a density per solid angle taken for one per projected solid angle.
    const MEASURE: Spoil = |path, x, s| {
        if x[0].has(AT_INFINITY) && s >= 1 {
            path.p_eye[0] /= x[1].n_g.dot(x[0].n_g).abs();
        }
    };
    /// Case 24: roulette left out of the densities of the other side.
    const ROULETTE: Spoil = |path, x, s| {
        if s >= 1 && s + 1 < x.len() {
            path.p_eye[s - 1] /= x[s].survival;
        }
    };
    /// Case 8: strategies that would have to connect at a mirror or at glass take part.
    const DIRAC: Spoil = |path, _, _| {
        let k = path.k;
        path.active[1..=k].fill(true);
    };
    /// Case 22: a probability of choosing the light that only one side knows.
    const CHOICE: Spoil = |path, _, s| {
        if s == 0 {
            path.p_light[0] *= 1.1;
        }
    };
    let mistakes: [(&str, Spoil, Arc<Scene>); 5] = [
        ("directional", DIRECTIONAL, emitters_scenes::dirac_lights()),
        ("measure", MEASURE, emitters_scenes::under_the_sky()),
        ("roulette", ROULETTE, scenes::furnace(1.0, 0.7)),
        ("dirac", DIRAC, scenes::specular()),
        ("choice", CHOICE, emitters_scenes::under_the_sky()),
    ];
    for (name, spoil, scene) in mistakes {
        let (right, wrong) = (replay(&scene, |_, _, _| {}), replay(&scene, spoil));
        println!("{name}: Σw is off by {:e}, with the mistake {:e}", right.weights.value, wrong.weights.value);
        assert!(!right.disagree() && right.weights.value < 1e-5, "{name}: {right:?}");
        assert!(wrong.disagree() && wrong.weights.value > 1e-3, "{name}: {wrong:?}");
    }
}
