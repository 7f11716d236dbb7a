//! What no strategy can make: that kinds of paths are what the renderer makes of them, and that the estimate of the light that is
//! missing is right, against closed forms, a lens that is opened, a lamp of some size, and pictures.

use crate::images::{job, mean, rendered};
use crate::scenes::{self, Room};
use crate::stats::{Moments, z_between, z_limit};
use crate::{emitters_scenes, surface_scenes};
use bdpt_explorer::bdpt::connect::Sample;
use bdpt_explorer::bdpt::context::Context;
use bdpt_explorer::bdpt::{Kind, Settings, Strategy, StrategySet};
use bdpt_explorer::engine::Job;
use bdpt_explorer::math::Vec3;
use bdpt_explorer::report::check::Control;
use bdpt_explorer::report::check::missing::{self, BLURS, Estimate, Lost};
use bdpt_explorer::report::check::sweep::{Budget, Merge, Task};
use bdpt_explorer::scene::{Lens, Material, Scene, builtin};
use bdpt_explorer::task::block_on;
use std::collections::{BTreeMap, HashSet};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// Every path that a strategy of the renderer makes is of a kind that it can make, and that kind says of every other strategy what
/// the renderer says; kinds that are lost never come up.
#[test]
fn kinds_of_paths_are_what_the_renderer_makes_of_them() {
    let mut list: Vec<Arc<Scene>> = builtin::list().iter().map(|entry| scenes::builtin(entry.name)).collect();
    list.extend([scenes::specular(), emitters_scenes::everything(), emitters_scenes::sky_and_glass(), surface_scenes::veils(false)]);
    let (mut names, mut losing) = (BTreeMap::<String, u64>::new(), 0);
    for (scene, radius) in list.iter().flat_map(|scene| [(scene, 0.0), (scene, 0.2 * scene.sphere.radius)]) {
        for fresh_ends in [true, false] {
            let settings = Settings { fresh_ends, max_edges: 5, ..Settings::default() };
            let lens = Some(Lens { radius, focus_distance: scene.sphere.radius });
            let job = Job { lens, ..job(scene, [32, 24], settings) };
            let (view, existence) = (job.view(), job.existence());
            let lost: HashSet<Kind> = existence.lost_kinds(&settings).collect();
            losing += usize::from(!lost.is_empty());
            let (context, mut sample) = (Context::new(scene, &view, &settings), Sample::default());
            for i in 0..768 {
                sample.trace(&context, settings.sample([i % 32, i / 32], 0), 6, 6);
                for strategy in Strategy::all(5, view.has_lens()) {
                    if sample.evaluate(&context, strategy).is_err() {
                        continue;
                    }
                    let kind = sample.kind(strategy);
                    let name = format!("{strategy} of {}: {}", scene.name, kind.name());
                    assert!(kind.k == strategy.edges() && kind.samplable(strategy.s, view.has_lens()), "{name}");
                    for s in 0..=kind.k + 1 {
                        assert_eq!(kind.samplable(s, view.has_lens()), sample.path.samplable[s as usize], "{name}, s = {s}");
                    }
                    assert!(!lost.contains(&kind), "{name} is lost");
                    *names.entry(kind.name()).or_default() += 1;
                }
            }
        }
    }
    println!("{names:?}");
    for name in ["LE", "LDE", "L₀DE", "LS⁺E", "L₀S⁺E", "L₀S⁺DE", "LS⁺DS⁺E", "L₀S⁺DS⁺E"] {
        assert!(names.contains_key(name), "{name} never came up");
    }
    assert!(losing >= 6, "{losing}");
}

/// The job's estimate from so many eye subpaths.
fn estimate(job: &Job, samples: u64) -> Estimate {
    let budget = Budget { samples, time: Duration::MAX };
    let (view, control, cancel) = (job.view(), Control::default(), AtomicBool::new(false));
    let mut task = Task { job, view, budget, control, cancel: &cancel, tell: &mut |_| {} };
    let settings = missing::settings(&task);
    let lost = Lost::of(&job.existence(), &settings);
    block_on(missing::estimate(&mut task, &settings, &lost))
}

/// A mirror at z = 0, a pinhole before it at z = 1, and a light.
fn in_a_mirror(light: impl Fn(&mut Room)) -> Arc<Scene> {
    let mut room = Room::new("light in a mirror");
    let mirror = room.material(Material::mirror(Vec3::ONE));
    room.quad([-2.0, -2.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], mirror);
    light(&mut room);
    room.camera([0.0, 0.0, 1.0], [0.0, 0.0, 0.0], 60.0);
    room.build()
}

/// Each kind of light without extent, mirrored: I/(A_film D² cos³θ), and E/(A_film cos³θ) from infinity.
#[test]
fn a_light_in_a_mirror_carries_what_the_mirrored_light_does() {
    let film = (2.0 * 30.0f64.to_radians().tan()).powi(2);
    let place = [0.1, 0.0, 1.2];
    let distance = f64::hypot(0.1, 2.2);
    let seen = 1.0 / (film * distance.powi(2) * (2.2 / distance).powi(3));
    let versine = |cos: f64| 1.0 - cos;
    // The mirror's image of a cone of 10° around −z, which falls off from its middle on.
    let ramp = 1.0 - versine(2.2 / distance) / versine(10.0f64.to_radians().cos());
    let tan = 0.2f64;
    let cases = [
        (in_a_mirror(|room| room.point(place, Vec3::splat(3.0))), 3.0 * seen),
        (in_a_mirror(|room| room.spot(place, [0.0, 0.0, -1.0], Vec3::splat(3.0), [0.0, 10.0])), 3.0 * seen * ramp * ramp),
        (in_a_mirror(|room| room.directional([tan, 0.0, -1.0], Vec3::splat(2.0))), 2.0 / film * (1.0 + tan * tan).powf(1.5)),
    ];
    for (scene, exact) in cases {
        let job = job(&scene, [64, 64], Settings { max_edges: 3, seed: 3, ..Settings::default() });
        let found = estimate(&job, 2_000_000);
        assert_eq!(found.share(0)[0], 1.0, "a pinhole sees nothing else here");
        for (blur, moments) in BLURS.iter().zip(&found.eye.blurred) {
            let (value, z) = (moments.mean() / 3.0, moments.z(3.0 * exact));
            println!(
                "{}: blurred to {blur}: {value:.5} ± {:.5} instead of {exact:.5}, z = {z:.2}",
                scene.lights.list[0].kind_name(),
                moments.error() / 3.0
            );
            assert!(z.abs() < z_limit(1e-3, 6), "{value} instead of {exact}");
            assert!(moments.z(3.0 * 1.3 * exact).abs() > z_limit(1e-3, 6), "an error of 30 % would pass");
        }
        assert!(found.eye.blurred[0].z(3.0 * 1.15 * exact).abs() > z_limit(1e-3, 6), "an error of 15 % would pass");
    }
}

/// The light that hits an open lens on paths of these kinds, from so many light subpaths.
fn by_light(job: &Job, kinds: &HashSet<Kind>, samples: u64) -> Moments {
    #[derive(Default)]
    struct Found(Moments);
    impl Merge for Found {
        fn merge(&mut self, later: Self) {
            self.0.merge(&later.0);
        }
    }
    let budget = Budget { samples, time: Duration::MAX };
    let (view, control, cancel) = (job.view(), Control::default(), AtomicBool::new(false));
    let mut task = Task { job, view, budget, control, cancel: &cancel, tell: &mut |_| {} };
    let settings = job.settings;
    let sweep = task.sweep_untraced(&settings, |context, id, sample, found: &mut Found| {
        sample.trace(context, id, settings.max_edges as usize + 1, 0);
        let mut sum = 0.0;
        for s in sample.crossings.iter().map(|crossing| crossing.s).collect::<Vec<_>>() {
            if let Ok(c) = sample.evaluate(context, Strategy::new(s, 0))
                && kinds.contains(&sample.kind(Strategy::new(s, 0)))
            {
                assert_eq!(c.mis_weight, 1.0, "nobody else can");
                sum += f64::from(c.contribution_unweighted.element_sum());
            }
        }
        found.0.add(sum);
    });
    block_on(sweep).0.0
}

/// On point-mirror: half the blur is the same, and so is what a small lens brings back.
#[test]
fn what_is_missing_in_point_mirror_is_what_a_lens_brings_back() {
    let settings = Settings { seed: 7, ..Settings::default() };
    let pinhole = job(&scenes::builtin("point-mirror"), [64, 64], settings);
    let found = estimate(&pinhole, 1_000_000);
    let ([share, error], [half, half_error]) = (found.share(0), found.share(1));
    println!("point-mirror: {share:.4} ± {error:.4} is missing, {half:.4} ± {half_error:.4} with half the blur");
    assert!((0.005..0.5).contains(&share) && error < 0.1 * share, "{share} ± {error}");
    assert!((share - half).abs() < z_limit(1e-3, 1) * half_error, "{share} or {half}");

    let lost: HashSet<Kind> = pinhole.existence().lost_kinds(&pinhole.settings).collect();
    let lens = Job { lens: Some(Lens { radius: 0.1, focus_distance: 2.9 }), ..pinhole.clone() };
    let lens = by_light(&lens, &lost, 3_000_000);
    let blurred = &found.eye.blurred[0];
    let z = z_between(&lens, blurred);
    println!(
        "a lens brings {:.5} ± {:.5}, the estimate is {:.5} ± {:.5}, z = {z:.2}",
        lens.mean(),
        lens.error(),
        blurred.mean(),
        blurred.error()
    );
    assert!(z.abs() < z_limit(1e-3, 1) && lens.non_zero > 100);
    // Negative control: half as much again.
    assert!(
        (1.5 * blurred.mean() - lens.mean()) / lens.error().hypot(1.5 * blurred.error()) > z_limit(1e-3, 1),
        "50 % too much would pass"
    );
}

/// A floor before a mirror and a glass ball on it, lit by a small light: a point, or a ball of this radius and radiance.
fn floor_and_mirror(ball: Option<[f64; 2]>) -> Arc<Scene> {
    let mut room = Room::new("floor and mirror");
    let (mirror, white) = (room.material(Material::mirror(Vec3::splat(0.9))), room.material(Material::lambert(Vec3::splat(0.7))));
    let glass = room.material(Material::dielectric(Vec3::ONE, 1.5, false));
    room.quad([-2.0, 0.0, -1.0], [4.0, 0.0, 0.0], [0.0, 2.0, 0.0], mirror);
    room.quad([-2.0, 0.0, 2.0], [4.0, 0.0, 0.0], [0.0, 0.0, -3.0], white);
    room.sphere([0.4, 0.35, -0.1], 0.35, 24, true, glass);
    match ball {
        None => room.point([-0.3, 0.9, 0.2], Vec3::ONE),
        Some([radius, radiance]) => {
            let lamp = room.emitter(radiance as f32, 0.0, false);
            room.sphere([-0.3, 0.9, 0.2], radius, 12, false, lamp);
        }
    }
    room.camera([0.0, 1.2, 2.0], [0.0, 0.5, -0.5], 50.0);
    room.build()
}

/// What is missing of a point is what only s = 0 brings of a ball as small as the blur makes of it, and as bright.
#[test]
fn what_is_missing_of_a_point_is_what_eye_paths_bring_of_a_small_ball() {
    let point = floor_and_mirror(None);
    let radius = f64::from(BLURS[1] * point.sphere.radius);
    let area: f64 = floor_and_mirror(Some([radius, 1.0])).lights.list.iter().map(|light| f64::from(light.area)).sum();
    // Seen from all sides, a convex body shows a quarter of its surface.
    let ball = floor_and_mirror(Some([radius, 4.0 / area]));
    let settings = Settings { seed: 11, ..Settings::default() };
    let missing = estimate(&job(&point, [64, 64], settings), 2_000_000);
    let without = Settings { seed: 12, strategies: StrategySet::where_(|x| x.s > 0), ..settings };
    let taken_out = estimate(&job(&ball, [64, 64], without), 12_000_000);
    assert_eq!((taken_out.eye.samples(), missing.joined.taken_out.non_zero), (0, 0), "each has its own way");
    for blurred in &missing.eye.blurred {
        let z = z_between(blurred, &taken_out.joined.taken_out);
        let [a, b] = [blurred, &taken_out.joined.taken_out].map(|m| (m.mean(), m.error()));
        println!("a point: {a:.5?}, a ball: {b:.5?}, z = {z:.2}");
        assert!(z.abs() < z_limit(1e-3, 2) && blurred.non_zero > 100 && taken_out.joined.taken_out.non_zero > 100);
        assert!((1.6 * a.0 - b.0) / b.1.hypot(1.6 * a.1) > z_limit(1e-3, 2), "60 % too much would pass");
    }
}

/// What is made and what is not are the means of pictures with and without the strategies that were removed.
#[test]
fn what_removed_strategies_would_bring_is_what_their_pictures_lack() {
    let light_hits = StrategySet::where_(|x| x.s > 0);
    for (name, strategies) in [("cornell-spheres", light_hits), ("point-mirror", StrategySet::path_tracer())] {
        let scene = scenes::builtin(name);
        let mean_of = |strategies, first: u32| {
            let mut moments = Moments::default();
            for seed in first..first + 12 {
                let settings = Settings { max_edges: 5, seed, strategies, ..Settings::default() };
                moments.add(3.0 * mean(&rendered(job(&scene, [32, 32], settings), 24).image()));
            }
            moments
        };
        let (part, all) = (mean_of(strategies, 100), mean_of(StrategySet::ALL, 200));
        let found = estimate(&job(&scene, [32, 32], Settings { max_edges: 5, seed: 1, strategies, ..Settings::default() }), 800_000).joined;
        let [z_part, z_removed] = [z_between(&found.made, &part), {
            let lack = all.mean() - part.mean();
            (found.taken_out.mean() - lack) / (found.taken_out.error2() + all.error2() + part.error2()).sqrt()
        }];
        println!(
            "{name}: {:.4} made, picture {:.4}, z {z_part:.2}; {:.4} not, z {z_removed:.2}",
            found.made.mean(),
            part.mean(),
            found.taken_out.mean()
        );
        assert!(z_part.abs() < z_limit(1e-3, 4) && z_removed.abs() < z_limit(1e-3, 4));
        // Negative control: nothing missing would not do.
        assert!(found.taken_out.z(0.0) > z_limit(1e-3, 4));
    }
}

/// Where every kind can be made there is nothing to estimate, and a sample finds nothing of it.
#[test]
fn where_nothing_is_lost_nothing_is_found() {
    for name in ["cornell", "cornell-spheres", "bokeh", "spots"] {
        let found = estimate(&job(&scenes::builtin(name), [32, 32], Settings::default()), 8_000);
        assert_eq!((found.share(0), found.eye.samples()), ([0.0, 0.0], 0), "{name}");
        assert!(found.joined.made.mean() > 0.0);
    }
}
