//! Rung 7: hard cases by name.

use crate::images::{job, mean, mean_over_seeds, rendered};
use crate::stats::{z_between, z_limit};
use crate::{emitters_scenes, scenes};
use bdpt_explorer::bdpt::{Reason, Settings, Strategy, StrategySet};
use bdpt_explorer::engine::{Job, record};
use bdpt_explorer::math::Vec3;

/// The furnace's answer does not depend on its size or place. (A file's own f32 positions may: they are rounded before we
/// see them. Ours come in f64.)
#[test]
fn scale_and_offset_do_not_matter() {
    let settings = Settings { max_edges: 5, ..Settings::default() };
    let exact = 2.0 * (1.0 - 0.6f64.powi(5)) / 0.4;
    for (scale, offset) in [(1.0, 0.0), (1e-3, 0.0), (1e6, 0.0), (1.0, 1e6), (1e-3, 1e3)] {
        let session = rendered(job(&scenes::furnace_at(2.0, 0.6, scale, offset), [32, 32], settings), 24);
        let mean = mean(&session.image());
        println!("scale {scale:e} offset {offset:e}: {mean:.4} of {exact:.4}");
        assert!((mean / exact - 1.0).abs() < 0.01, "scale {scale:e} offset {offset:e}: {mean} instead of {exact}");
    }
}

/// Nor does the picture of lenses and of light from infinity: the same random numbers make the same image at every size (point
/// intensities grow with the square of it).
#[test]
fn scale_and_offset_do_not_matter_to_lenses_and_skies() {
    let settings = Settings { max_edges: 4, ..Settings::default() };
    let exact = 2.0 * (1.0 - 0.6f64.powi(4)) / 0.4;
    let image = |scale, offset| rendered(job(&emitters_scenes::sky_at(scale, offset), [24, 24], settings), 16).image();
    let reference = image(1.0, 0.0);
    for (scale, offset) in [(1e-3, 0.0), (1e6, 0.0), (1.0, 1e6), (1e-3, 1e3)] {
        let session = rendered(job(&emitters_scenes::furnace_with_lens_at(2.0, 0.6, scale, offset), [32, 32], settings), 24);
        let mean = mean(&session.image());
        println!("furnace with a lens, scale {scale:e} offset {offset:e}: {mean:.4} of {exact:.4}");
        assert!((mean / exact - 1.0).abs() < 0.01, "scale {scale:e} offset {offset:e}: {mean} instead of {exact}");
        // A rounded coordinate may turn one decision: most pixels are the same, not all.
        let mut off: Vec<f32> = image(scale, offset).iter().zip(&reference).map(|(a, b)| (*a - *b).abs().max_element()).collect();
        off.sort_by(f32::total_cmp);
        assert!(
            off[off.len() * 9 / 10] < 1e-3,
            "scale {scale:e} offset {offset:e}: a tenth of the pixels differ by {}",
            off[off.len() * 9 / 10]
        );
    }
    // Negative control: other random numbers make another image.
    let other = rendered(job(&emitters_scenes::sky_at(1.0, 0.0), [24, 24], Settings { seed: 1, ..settings }), 16).image();
    assert!(other.iter().zip(&reference).filter(|(a, b)| (**a - **b).abs().max_element() > 1e-3).count() > 24 * 24 / 2);
}

#[test]
fn a_scene_without_light_is_black_and_says_why() {
    let scene = scenes::dark();
    let session = rendered(job(&scene, [16, 16], Settings::default()), 2);
    assert!(session.image().iter().all(|c| *c == Vec3::ZERO));
    let record = record(session.job(), [8, 8], 0).unwrap();
    let next_event = record.strategies.iter().find(|s| s.strategy() == Strategy::new(1, 2)).unwrap();
    assert_eq!(next_event.reason, Some(Reason::NoLight));
    // The control: a room with light is neither.
    let lit = rendered(job(&scenes::furnace(1e-3, 0.8), [16, 16], Settings::default()), 2);
    assert!(lit.image().iter().all(|c| c.min_element() > 0.0));
}

#[test]
fn one_edge_shows_the_lamp_alone() {
    let scene = scenes::builtin("cornell");
    let image = rendered(job(&scene, [64, 64], Settings { max_edges: 1, ..Settings::default() }), 8).image();
    let lit: Vec<usize> = (0..image.len()).filter(|&i| image[i] != Vec3::ZERO).collect();
    assert!(!lit.is_empty() && lit.len() < image.len() / 4);
    // Well inside the lamp a pixel has exactly its radiance, up to the noise of the (1,1) splats.
    let radiance = scene.lights.list[0].radiance;
    let brightest = lit.iter().map(|&i| image[i].x).fold(0.0, f32::max);
    assert!(brightest > 0.9 * radiance.x && brightest < 1.3 * radiance.x, "{brightest} of {radiance}");
}

/// Next-event estimation can reach nothing here; what can (s = 0, light tracing, connections outside) must agree.
#[test]
fn a_lamp_inside_glass_lights_the_room_by_the_strategies_that_can() {
    let scene = scenes::lamp_in_glass();
    let base = Settings { max_edges: 5, ..Settings::default() };
    let eye_only = StrategySet::where_(|x| x.s == 0);
    let light_only = StrategySet::where_(|x| x.s == 0 || x.t == 1);
    let reference = mean_over_seeds(&scene, base, 24, 24);
    for (name, strategies) in [("eye paths", eye_only), ("eye paths and light tracer", light_only)] {
        let other = mean_over_seeds(&scene, Settings { strategies, ..base }, 24, 24);
        let z = z_between(&reference, &other);
        println!("{name}: {:.5} ± {:.5} against {:.5}, z = {z:.2}", other.mean(), other.error2().sqrt(), reference.mean());
        assert!(z.abs() < z_limit(1e-3, 2), "{name}: z = {z}");
    }
}

#[test]
fn where_one_strategy_alone_can_it_weighs_exactly_one_and_the_others_zero() {
    let scene = scenes::only_a_mirror();
    let job = Job { weighted_layers: true, raw_layers: true, ..job(&scene, [16, 16], Settings { max_edges: 3, ..Settings::default() }) };
    let session = rendered(job, 8);
    let only = Strategy::new(0, 3);
    assert!(mean(&session.layer(only, true).unwrap()) > 0.1);
    assert_eq!(session.layer(only, true), session.layer(only, false), "its weight is exactly 1");
    for k in [2, 3] {
        for s in 0..=k {
            let strategy = Strategy::new(s, k + 1 - s);
            if strategy != only {
                // What cannot exist here has no layer at all.
                let layer = session.layer(strategy, false);
                assert!(layer.is_none_or(|layer| layer.iter().all(|c| *c == Vec3::ZERO)), "{strategy}");
            }
        }
    }
    let record = record(session.job(), [8, 8], 0).unwrap();
    let entry = record.strategies.iter().find(|s| s.strategy() == only).unwrap();
    assert!(entry.feasible && entry.mis_weight == 1.0);
    assert!(entry.splits.iter().all(|split| (split.weight == 1.0) == (split.s == 0) && split.samplable == (split.s == 0)));
    assert!(entry.splits.iter().filter(|split| !split.samplable).all(|split| split.reason.is_some() && split.weight == 0.0));
}

#[test]
fn extremes_stay_finite() {
    for max_edges in [3, 64] {
        let session = rendered(job(&scenes::extremes(), [24, 24], Settings { max_edges, ..Settings::default() }), 4);
        assert!(session.image().iter().all(|c| c.is_finite() && c.min_element() >= 0.0));
    }
    let session = rendered(job(&scenes::furnace(1.0, 0.9), [4, 4], Settings { max_edges: 64, roulette: false, ..Settings::default() }), 2);
    assert!(mean(&session.image()) > 5.0);
}

/// Σw = 1 in every record, by the definition, and the renderer's own weight is that weight.
#[test]
fn records_carry_the_renderers_weight_and_all_splits() {
    for scene in [scenes::builtin("cornell"), scenes::specular(), scenes::tilted(), scenes::lamp_in_glass()] {
        let job = job(&scene, [32, 32], Settings::default());
        let mut feasible = 0;
        for i in 0..200 {
            let record = record(&job, [i % 32, i * 7 % 32], i).unwrap();
            for entry in record.strategies.iter().filter(|entry| entry.feasible) {
                feasible += 1;
                let sum: f64 = entry.splits.iter().map(|split| split.weight).sum();
                assert!((sum - 1.0).abs() < 1e-9);
                let own = &entry.splits[entry.s as usize];
                assert!((own.weight - f64::from(entry.mis_weight)).abs() < 1e-5);
                assert!(own.samplable && (own.p.unwrap() - entry.p.unwrap()).abs() < 1e-4);
                assert_eq!(entry.splits.len() as u32, entry.s + entry.t + 1);
            }
            for entry in record.strategies.iter().filter(|entry| !entry.feasible) {
                assert!(entry.reason.is_some() && entry.contribution == [0.0; 3]);
            }
        }
        assert!(feasible > 300, "{}: {feasible}", scene.name);
    }
}
