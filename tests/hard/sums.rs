//! Sums of ten million samples per pixel: pixels and splats of the CPU, the two levels of the GPU, and the renderer itself.
//!
//! An f32 sum of 0.3 stops growing: it is 10 % low after 10⁷ (mitsuba2 #82: a mean that drifts from 0.5 to 1 at 10⁸).

use crate::lab::{LEVEL, job, mean, rendered};
use crate::scenes::{self, Room};
use crate::stats::z_limit;
use bdpt_explorer::bdpt::context::Context;
use bdpt_explorer::bdpt::render::{Plan, image_mean, render_rows, splat_quantum};
use bdpt_explorer::bdpt::{Settings, Strategy, StrategySet};
use bdpt_explorer::film::{Film, Layers, Rect, SplatBatch};
use bdpt_explorer::gpu::MOST_PASSES;
use bdpt_explorer::math::Vec3;
use bdpt_explorer::rng::{pcg4d, unit_f32};
use bdpt_explorer::scene::Material;

const SAMPLES: u32 = 10_000_000;

/// Samples of known sums: a constant, noise of 24 bits, and rare large ones among zeros.
fn value(n: u32) -> ([f32; 3], [u32; 4]) {
    let words = pcg4d([n, 5, 6, 7]);
    let noise = unit_f32(words[0]);
    ([0.3, noise, if words[1] < 1 << 22 { 1000.0 * noise } else { 0.0 }], words)
}

/// Their sums in f64, which the rounding of 10⁷ additions moves by 10⁻⁹ of them at most.
#[derive(Default)]
struct Exact {
    f64: [f64; 3],
    /// The mistake.
    f32: [f32; 3],
}

impl Exact {
    fn add(&mut self, value: [f32; 3]) {
        for (c, v) in value.into_iter().enumerate() {
            self.f64[c] += f64::from(v);
            self.f32[c] += v;
        }
    }

    /// All three channels within `allowed` of the exact means; the mistake is not.
    #[track_caller]
    fn holds(&self, found: Vec3, allowed: [f64; 3]) {
        let error = |c: usize| (f64::from(found[c]) - self.f64[c] / f64::from(SAMPLES)).abs();
        println!(
            "{found} instead of {:?}; f32 {:?}",
            self.f64.map(|sum| sum / f64::from(SAMPLES)),
            self.f32.map(|sum| sum / SAMPLES as f32)
        );
        // The mean itself is shown in f32.
        (0..3).for_each(|c| assert!(error(c) < allowed[c] + 6e-8 * f64::from(found[c]), "channel {c}: off by {:e}", error(c)));
        let drift = (f64::from(self.f32[0]) / self.f64[0] - 1.0).abs();
        assert!(drift > 0.05, "the control: f32 is off by {drift} only");
    }
}

#[test]
fn pixels_keep_their_mean_over_ten_million_samples() {
    let mut film = Film::new([1, 1], Layers { pixel: 1, splat: 0 }, 1.0);
    let mut exact = Exact::default();
    let (mut rows, _) = film.rows(&[0]);
    for n in 0..SAMPLES {
        let (value, _) = value(n);
        rows[0].add(0, 0, Vec3::from(value));
        rows[0].count_sample();
        exact.add(value);
    }
    drop(rows);
    exact.holds(film.means().pixel(0, 0), [1e-9; 3]);
}

/// The quantum is coarse, 2⁻¹²: 0.3 lies between two multiples, and what rounding adds is noise of a known size.
#[test]
fn splats_keep_their_mean_over_ten_million_samples() {
    let quantum = (-12.0f32).exp2();
    let mut film = Film::new([1, 1], Layers { pixel: 1, splat: 1 }, quantum);
    let (mut exact, mut cut, mut batch) = (Exact::default(), 0.0f64, SplatBatch::default());
    // Eight samples to a pass: what is folded are integers of any size.
    for first in (0..SAMPLES).step_by(8) {
        let (mut rows, splats) = film.rows(&[0]);
        for n in first..first + 8 {
            let (value, words) = value(n);
            splats.add(&mut batch, [0, 0], 0, Vec3::from(value), [words[1], words[2], words[3]].map(unit_f32));
            rows[0].count_sample();
            exact.add(value);
            cut += f64::from((value[0] / quantum).floor() * quantum);
        }
        assert_eq!(splats.take(&mut batch), 0);
        drop(rows);
        film.fold();
    }
    // Each rounding is off by half a quantum at most, in either direction with the right odds.
    let noise = z_limit(LEVEL, 3) * 0.5 * f64::from(quantum) / f64::from(SAMPLES).sqrt();
    exact.holds(film.means().splat(0, 0), [noise; 3]);
    // Negative control: cut off instead of rounded stochastically.
    assert!((cut - exact.f64[0]).abs() / f64::from(SAMPLES) > 10.0 * noise);
}

/// On the device f32 sums of at most [`MOST_PASSES`] passes, and 64-bit integers for splats; in the film f64.
#[test]
fn the_gpus_two_levels_keep_their_mean_over_ten_million_samples() {
    let quantum = (-12.0f32).exp2();
    let mut film = Film::new([1, 1], Layers { pixel: 1, splat: 1 }, quantum);
    let (mut exact, mut done) = (Exact::default(), 0);
    while done < SAMPLES {
        let passes = MOST_PASSES.min(SAMPLES - done);
        let (mut sums, mut quanta) = ([0.0f32; 3], [0u64; 3]);
        for n in done..done + passes {
            let (value, words) = value(n);
            for c in 0..3 {
                sums[c] += value[c];
                quanta[c] += bdpt_explorer::film::quanta(value[c], unit_f32(words[c + 1]), quantum);
            }
            exact.add(value);
        }
        let words: Vec<u32> = quanta.iter().flat_map(|&q| [q as u32, (q >> 32) as u32]).collect();
        film.absorb_pixels(0, 1, &sums);
        film.absorb_splats(0, 1, &words);
        film.count_samples(&[passes]);
        done += passes;
    }
    // Each of the f32 sums is off by a few roundings of its size, and they do not all go one way: 10⁻⁶ of the mean.
    exact.holds(film.means().pixel(0, 0), [3e-6, 3e-6, 3e-5]);
    let noise = z_limit(LEVEL, 3) * 0.5 * f64::from(quantum) / f64::from(SAMPLES).sqrt();
    exact.holds(film.means().splat(0, 0), [noise; 3]);
}

/// A lamp of a tenth of a metre close to the camera, on a floor a kilometre wide: what it adds to its pixel in the most passes that are
/// summed up at once fits the counters. Would have caught: a quantum from the scene's power and size alone, of which the counters hold
/// 2⁶³ (splats beyond them are left out, and the lamp becomes darker).
#[test]
fn a_lamp_near_the_camera_fits_the_counters_of_a_wide_scene() {
    let mut room = Room::new("wide");
    let (white, lamp) = (room.material(Material::lambert(Vec3::splat(0.5))), room.emitter(1000.0, 0.0, true));
    room.quad([-500.0, 0.0, -500.0], [0.0, 0.0, 1000.0], [1000.0, 0.0, 0.0], white);
    room.quad([-0.05, 0.95, -1.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0], lamp);
    room.camera([0.0, 1.0, 0.0], [0.0, 1.0, -1.0], 40.0);
    let scene = room.build();
    let job = job(&scene, [9, 9], Settings { max_edges: 2, ..Settings::default() });
    let (view, passes) = (job.view(), 64);
    let quantum = f64::from(splat_quantum(&Context::new(&job.scene, &view, &job.settings)));
    let brightest = rendered(job, passes).image().iter().map(|c| f64::from(c.x)).fold(0.0, f64::max);
    let (most, room_for) = (brightest * f64::from(MOST_PASSES), 2f64.powi(63) * quantum);
    println!("{brightest} in a pixel, {most:e} in {MOST_PASSES} passes, {room_for:e} fit");
    assert!(brightest > 100.0 && most * 4.0 < room_for, "{most:e} of {room_for:e}");
    // Negative control: the scene's power and size alone.
    let radius = f64::from(scene.sphere.radius);
    let alone = f64::from(scene.lights.power.max_element()) / (f64::from(view.film_area()) * radius * radius) * 2f64.powi(63 - 30);
    assert!(most * 4.0 > alone, "{most:e} of {alone:e}");
}

/// Samples through the renderer, where every path of one edge carries L_e: what (0,2) and (1,1) share is L_e in the mean.
fn through_the_renderer(passes: u32) {
    let settings = Settings { max_edges: 1, ..Settings::default() };
    let image = |strategies| rendered(job(&scenes::furnace(0.3, 0.6), [1, 1], Settings { strategies, ..settings }), passes).image();
    // Alone, (0,2) has no noise at all.
    let hit = image([Strategy::new(0, 2)].into_iter().collect());
    let error = hit.iter().map(|c| (c.x / 0.3 - 1.0).abs()).fold(0.0, f32::max);
    assert!(error < 1e-6, "{error}");
    let both = mean(&image(settings.strategies));
    // A walk that starts behind or beside the film adds nothing: the splats' spread is about their mean.
    let noise = 2.0 * z_limit(LEVEL, 1) * 0.3 / f64::from(passes).sqrt();
    println!("{passes} passes: {both} ± {noise}");
    assert!((both - 0.3).abs() < noise, "{both}");
    // Negative control: the same sum in f32.
    let sum = (0..passes).fold(0.0f32, |sum, _| sum + 0.3) / passes as f32;
    assert!((f64::from(sum) / 0.3 - 1.0).abs() > if passes >= SAMPLES { 0.05 } else { 5e-4 }, "{sum}");
}

#[test]
fn the_renderer_keeps_the_mean_over_many_samples() {
    through_the_renderer(100_000);
}

#[test]
#[ignore = "the long form"]
fn the_renderer_keeps_the_mean_over_ten_million_samples() {
    through_the_renderer(SAMPLES);
}

/// In the middle of a pass the picture is as bright as ever: what the pass has splatted counts, and so does the part of it that is done.
/// The controls are the picture without the pass's splats, and with the pass counted as a whole.
#[test]
fn a_picture_in_the_middle_of_a_pass_is_as_bright_as_ever() {
    let job = job(&scenes::patches(), [32, 32], Settings { strategies: StrategySet::light_tracer(), max_edges: 3, ..Settings::default() });
    let (view, crop) = (job.view(), Rect::full(job.size));
    let context = Context::new(&job.scene, &view, &job.settings);
    let plan = Plan::new(&job.settings, job.existence(), false, false);
    let brightness = |film: &Film| {
        let means = film.means();
        (0..32 * 32).map(|pixel| f64::from(image_mean(&means, pixel).element_sum())).sum::<f64>()
    };
    let (rows, mut sums) = ((0..32).collect::<Vec<u32>>(), [0.0; 4]);
    for first in (0..1000).step_by(2) {
        let mut film = Film::new(job.size, plan.layers, splat_quantum(&context));
        render_rows(&context, &plan, &mut film, crop, first, &rows);
        film.fold();
        let whole = brightness(&film);
        render_rows(&context, &plan, &mut film, crop, first + 1, &rows[..16]);
        assert_eq!((film.mean_samples(), film.most_samples()), (1.5, 2));
        let half = brightness(&film);
        let unseen: f64 = (0..32 * 32).map(|pixel| film.splat_sum(0, pixel).iter().sum::<f64>()).sum();
        let found = [whole, half, unseen / film.mean_samples(), half * film.mean_samples() / f64::from(film.most_samples())];
        sums.iter_mut().zip(found).for_each(|(sum, x)| *sum += x);
    }
    let [_, half, unseen, whole] = sums.map(|sum| sum / sums[0]);
    println!("of a whole pass: {half:.4}; without its splats {unseen:.4}, counted as a whole {whole:.4}");
    assert!((half - 1.0).abs() < 0.02, "{half}");
    assert!(unseen < 0.9 && whole < 0.9, "{unseen} {whole}");
}
