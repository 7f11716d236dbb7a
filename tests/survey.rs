//! The statistics of strategies: the renderer's samples, counted; variances as brute force finds them; pictures on demand.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests may panic")]

use bdpt_explorer::bdpt::context::Context;
use bdpt_explorer::bdpt::render::Plan;
use bdpt_explorer::bdpt::survey::{Mode, Survey, pixel_outcomes};
use bdpt_explorer::bdpt::{Heuristic, HeuristicKind, PathRecord, Settings, Strategy};
use bdpt_explorer::engine::{Engine, Job, Picture, Session, Source, Study, Values, Wish, record};
use bdpt_explorer::math::Vec3;
use bdpt_explorer::scene::{Lens, builtin};
use statrs::distribution::{ContinuousCDF, Normal};
use std::sync::Arc;
use std::time::{Duration, Instant};

fn job(size: [u32; 2], max_edges: u32) -> Job {
    let scene = Arc::new(builtin::open("cornell").unwrap());
    let lens = Some(Lens { radius: 0.05, focus_distance: 3.0 });
    Job { lens, size, settings: Settings { max_edges, ..Settings::default() }, ..Job::new(scene) }
}

fn plan(job: &Job) -> Plan {
    Plan::new(&job.settings, job.existence(), false, false)
}

/// A survey of passes.
fn surveyed(job: &Job, passes: std::ops::Range<u32>, bytes: Option<usize>) -> Survey {
    let (view, mut survey) = (job.view(), Survey::new(&plan(job), job.size, bytes));
    let context = Context::new(&job.scene, &view, &job.settings);
    for pass in passes {
        (0..job.size[1]).for_each(|y| survey.add_row(&context, y, pass));
    }
    survey
}

fn pixels([width, height]: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]))
}

fn luminance(c: Vec3) -> f64 {
    0.2126 * f64::from(c.x) + 0.7152 * f64::from(c.y) + 0.0722 * f64::from(c.z)
}

#[test]
fn a_survey_counts_the_renderers_own_samples() {
    let mut job = Job { weighted_layers: true, raw_layers: true, ..job([40, 30], 4) };
    job.settings.light_subpaths = 2;
    let mut session = Session::new(job.clone()).unwrap();
    while session.passes() < 3 {
        session.step(Duration::from_secs(1));
    }
    let survey = surveyed(&job, 0..3, Some(usize::MAX));
    assert_eq!((survey.block(), survey.passes()), (1, 3.0));
    assert_eq!(survey.strategies(), session.layers());
    for (number, &strategy) in survey.strategies().iter().enumerate() {
        let (raw, weighted) = (session.layer(strategy, false).unwrap(), session.layer(strategy, true).unwrap());
        for (i, pixel) in pixels(job.size).enumerate() {
            let ours = survey.quotient(Mode::Raw, number, pixel).value().unwrap().map(|x| x as f32);
            let (ours, theirs) = (Vec3::from_array(ours), raw[i]);
            // A splat is rounded to a multiple of a small quantum.
            assert!((ours - theirs).abs().max_element() <= 1e-4 * theirs.max_element() + 1e-6, "{strategy} {pixel:?}: {ours} {theirs}");
            let ours = survey.quotient(Mode::Weighted, number, pixel).value().unwrap()[0];
            assert!((ours - luminance(weighted[i])).abs() <= 1e-4 * ours + 1e-6, "{strategy} {pixel:?}");
        }
        let outcomes = survey.outcomes(number);
        let failed: u64 = outcomes.reasons().iter().map(|(_, count)| count).sum();
        assert_eq!(outcomes.tries, 3 * 40 * 30 * u64::from(job.settings.tries(strategy)));
        assert_eq!(outcomes.carries + outcomes.non_finite + failed, outcomes.tries);
    }
}

/// Mean weights and counts from the records, one by one. The control is the weight image that others show: the mean of weight
/// times contribution.
#[test]
fn the_weight_is_the_weight_and_every_outcome_is_the_records() {
    let (job, passes) = (job([12, 9], 3), 20);
    let survey = surveyed(&job, 0..passes, Some(usize::MAX));
    let view = job.view();
    let context = Context::new(&job.scene, &view, &job.settings);
    let (mut differs, mut judged) = (0, 0);
    for pixel in [[3, 4], [6, 7], [10, 2], [5, 5], [8, 6], [2, 7]] {
        let records: Vec<PathRecord> = (0..passes).map(|sample| record(&job, pixel, sample).unwrap()).collect();
        let outcomes = pixel_outcomes(&context, &plan(&job), pixel, passes);
        for (number, (strategy, outcomes)) in outcomes.iter().enumerate() {
            let found = || records.iter().map(|r| r.strategies.iter().find(|x| x.strategy() == *strategy).unwrap());
            assert_eq!(outcomes.carries, found().filter(|x| x.feasible).count() as u64, "{strategy}");
            for (reason, count) in outcomes.reasons() {
                assert_eq!(count, found().filter(|x| x.reason == Some(reason)).count() as u64, "{strategy} {reason:?}");
            }
            if !strategy.stays_in_pixel() {
                continue;
            }
            let lit: Vec<_> = found().filter(|x| x.feasible).collect();
            let weight = survey.quotient(Mode::Weight, number, pixel).value();
            assert_eq!(weight.is_some(), !lit.is_empty(), "no sample, no weight");
            assert_eq!(survey.quotient(Mode::Count, number, pixel).value().unwrap()[0], lit.len() as f64 / f64::from(passes));
            let Some([weight, ..]) = weight else { continue };
            let expected = lit.iter().map(|x| f64::from(x.mis_weight)).sum::<f64>() / lit.len() as f64;
            assert!((weight - expected).abs() < 1e-6, "{strategy}: {weight} instead of {expected}");
            let control = lit.iter().map(|x| luminance(Vec3::from(x.contribution))).sum::<f64>() / f64::from(passes);
            (differs, judged) = (differs + u32::from((weight - control).abs() > 1e-3), judged + 1);
        }
    }
    assert!(judged >= 10 && differs * 10 >= judged * 9, "weight times contribution is something else: {differs} of {judged}");
}

/// The variance of a pass, against passes rendered one by one under other seeds: level 10⁻³ over all strategies (Bonferroni).
/// The controls are each formula in the other's place.
#[test]
fn variances_are_those_of_passes_rendered_one_by_one() {
    [1, 3].into_iter().for_each(variances_with);
}

fn variances_with(light_subpaths: u32) {
    const GROUPS: u32 = 120;
    const PASSES: u32 = 8;
    let mut base = job([8, 6], 3);
    base.settings.light_subpaths = light_subpaths;
    let strategies: Vec<Strategy> = plan(&base).strategies().collect();
    let pixel_count = 48.0;
    // Per strategy and group: formula − brute force, and the same of the wrong formula.
    let mut right = vec![Vec::new(); strategies.len()];
    let mut wrong = vec![Vec::new(); strategies.len()];
    for group in 0..GROUPS {
        let seeded = |seed| Job { settings: Settings { seed, ..base.settings }, ..base.clone() };
        let survey = surveyed(&seeded(2 * group), 0..PASSES, Some(usize::MAX));
        let singles: Vec<Survey> = (0..PASSES).map(|pass| surveyed(&seeded(2 * group + 1), pass..pass + 1, Some(usize::MAX))).collect();
        for (number, strategy) in strategies.iter().enumerate() {
            let (mut formula, mut other, mut brute) = (0.0, 0.0, 0.0);
            for pixel in pixels(base.size) {
                formula += survey.quotient(Mode::Variance, number, pixel).value().unwrap()[0];
                let (tally, n) = (survey.tally(number, pixel).unwrap(), f64::from(PASSES));
                let (mean, square) = (tally.weighted / n, tally.square / n);
                other += if strategy.stays_in_pixel() { square - mean * mean / pixel_count } else { square - mean * mean };
                let values = singles.iter().map(|single| single.quotient(Mode::Weighted, number, pixel).value().unwrap()[0]);
                let (sum, squares) = values.fold((0.0, 0.0), |(a, b), x| (a + x, b + x * x));
                brute += (squares - sum * sum / n) / (n - 1.0);
            }
            right[number].push(formula - brute);
            wrong[number].push(other - brute);
        }
    }
    let z = |differences: &[f64]| {
        let n = differences.len() as f64;
        let mean = differences.iter().sum::<f64>() / n;
        let variance = differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / (n - 1.0);
        mean / (variance / n).sqrt().max(1e-300)
    };
    let limit = Normal::standard().inverse_cdf(1.0 - 1e-3 / (4.0 * strategies.len() as f64));
    let mut caught = [0, 0];
    for (number, strategy) in strategies.iter().enumerate() {
        let (ours, control) = (z(&right[number]), z(&wrong[number]));
        println!("{light_subpaths}: {strategy}: z = {ours:.2}, the other formula {control:.2}");
        assert!(ours.abs() < limit, "{light_subpaths}: {strategy}: z = {ours:.2}");
        caught[usize::from(strategy.stays_in_pixel())] += u32::from(control.abs() > limit);
    }
    assert!(caught[0] >= 1 && caught[1] >= 1, "the wrong formulas are found out: {caught:?}");
}

#[test]
fn what_does_not_fit_is_summed_over_blocks() {
    let job = job([30, 22], 3);
    let (whole, blocks) = (surveyed(&job, 0..2, Some(usize::MAX)), surveyed(&job, 0..2, Some(60_000)));
    assert!(blocks.block() > 1 && blocks.block() < 12, "{}", blocks.block());
    for number in 0..whole.strategies().len() {
        assert_eq!(whole.outcomes(number), blocks.outcomes(number));
        for mode in [Mode::Raw, Mode::Weight, Mode::Count, Mode::Weighted] {
            // A block's value is that of all its pixels together; that of the film does not change.
            let film = |survey: &Survey| {
                let corners = pixels(job.size).filter(|p| p.iter().all(|v| v % survey.block() == 0));
                corners
                    .map(|p| survey.quotient(mode, number, p))
                    .fold(Default::default(), bdpt_explorer::bdpt::survey::Quotient::plus)
                    .value()
            };
            let (a, b) = (film(&whole), film(&blocks));
            assert_eq!(a.is_some(), b.is_some());
            if let (Some(a), Some(b)) = (a, b) {
                assert!((0..3).all(|c| (a[c] - b[c]).abs() <= 1e-9 * a[c].abs()), "{mode:?}: {a:?} {b:?}");
            }
        }
    }
}

#[test]
fn outcomes_alone_take_no_room_and_a_weight_of_zero_is_told() {
    let mut job = job([16, 16], 3);
    job.settings.heuristic = Heuristic { kind: HeuristicKind::Max, ..Heuristic::default() };
    let survey = surveyed(&job, 0..2, None);
    assert!(!survey.has_sums() && survey.tally(0, [0, 0]).is_none());
    let weightless = (0..survey.strategies().len()).filter(|&n| survey.outcomes(n).weightless > 0).count();
    assert!(weightless >= 3, "the densest strategy takes all: {weightless}");
}

#[test]
fn a_survey_used_again_is_as_good_as_a_new_one() {
    let before = job([12, 9], 3);
    let after = Job { settings: Settings { seed: 7, ..before.settings }, ..before.clone() };
    let mut again = surveyed(&before, 0..2, Some(usize::MAX)).renewed(&plan(&after), after.size).unwrap();
    assert_eq!((again.passes(), again.has_sums(), again.has_row(0)), (0.0, true, false));
    let view = after.view();
    let context = Context::new(&after.scene, &view, &after.settings);
    (0..9).for_each(|y| again.add_row(&context, y, 0));
    let new = surveyed(&after, 0..1, Some(usize::MAX));
    for number in 0..new.strategies().len() {
        assert_eq!(again.outcomes(number), new.outcomes(number));
        assert!(pixels(after.size).all(|pixel| again.tally(number, pixel) == new.tally(number, pixel)));
    }
    again.drop_sums();
    assert!(!again.has_sums() && again.outcomes(0).tries == 12 * 9);
    // One of other strategies, or another size, does not fit.
    let other = job([12, 9], 4);
    assert!(surveyed(&before, 0..1, None).renewed(&plan(&other), [12, 9]).is_none());
    assert!(surveyed(&before, 0..1, None).renewed(&plan(&before), [9, 12]).is_none());
}

/// Waits for something.
fn wait<T>(what: &str, mut look: impl FnMut() -> Option<T>) -> T {
    let end = Instant::now() + Duration::from_secs(60);
    while Instant::now() < end {
        if let Some(found) = look() {
            return found;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    panic!("waited in vain for {what}");
}

#[test]
fn the_engine_counts_only_what_is_wished_for() {
    let mut engine = Engine::start(job([40, 30], 4), || {}).unwrap();
    wait("a pass", || engine.frame().filter(|frame| frame.stats.spp >= 2.0));
    assert!(engine.study().is_none(), "nobody asked");
    // Why cells are black takes a pass, and no sums.
    engine.set_wish(Wish { outcomes: true, ..Wish::default() });
    let study: Arc<Study> = wait("outcomes", || engine.study().filter(|study| study.spp >= 1.0));
    std::thread::sleep(Duration::from_millis(50));
    assert_eq!((engine.study().unwrap().spp, study.cells[0].outcomes.tries), (1.0, 40 * 30));
    // A pixel: its own outcomes, and what landed there.
    engine.set_wish(Wish { pixel: Some([20, 15]), ..Wish::default() });
    let study = wait("a pixel", || engine.study().filter(|study| study.pixel.is_some() && study.spp >= 8.0));
    let pixel = study.pixel.as_ref().unwrap();
    assert!(pixel.outcomes.iter().all(|(_, outcomes)| outcomes.tries == u64::from(bdpt_explorer::engine::PIXEL_SAMPLES)));
    let (strategy, landed) = pixel.landed.iter().find(|(_, landed)| landed.count > 0).unwrap();
    // The sample it names does land there.
    let (from, sample) = landed.last.unwrap();
    let record = record(engine.job(), from, sample).unwrap();
    let raster = record.strategies.iter().find(|x| x.strategy() == *strategy).unwrap().raster.unwrap();
    assert_eq!(raster.map(|v| v.floor() as u32), [20, 15]);
    // A mode: pictures of all cells. Standing still, it stops soon.
    engine.set_wish(Wish { mode: Mode::Variance, paused: true, ..Wish::default() });
    let study = wait("variances", || engine.study().filter(|study| study.mode == Mode::Variance && study.spp >= 8.0));
    assert!((study.cells.iter().filter_map(|cell| cell.share).sum::<f64>() - 1.0).abs() < 1e-9);
    std::thread::sleep(Duration::from_millis(50));
    assert_eq!(engine.study().unwrap().spp, 8.0);
    // Another job has nothing of it.
    engine.restart(job([20, 20], 2)).unwrap();
    assert!(engine.study().is_none());
}

#[test]
fn pictures_come_when_they_are_asked_for() {
    let mut engine = Engine::start(job([40, 30], 4), || {}).unwrap();
    let strategy = Strategy::new(1, 2);
    let look = |engine: &Engine, source| -> Arc<Picture> { wait("a picture", || engine.picture(source).filter(|p| p.spp >= 2.0)) };
    for mode in Mode::ALL {
        let picture = look(&engine, Source::Strategy(strategy, mode));
        assert_eq!((picture.size, picture.source), ([40, 30], Source::Strategy(strategy, mode)));
        match &picture.values {
            Values::Colour(values) => {
                assert!(mode.is_colour() && values.len() == 40 * 30 && values.iter().any(|v| *v != Vec3::ZERO));
                assert!(values.iter().all(|v| v.is_finite()));
            }
            Values::Scalar(values) => {
                let [low, high] = picture.range.unwrap();
                assert!(!mode.is_colour() && values.len() == 40 * 30 && 0.0 < low && low < high);
                assert!(values.iter().all(|v| v.is_nan() || (0.0..=high).contains(v)));
            }
        }
    }
    let image = look(&engine, Source::Image);
    let Values::Colour(values) = &image.values else { panic!("an image has colours") };
    assert!(values.iter().copied().sum::<Vec3>().x > 0.0);
    // A strategy that does not take part has none; paused, a picture still comes.
    assert!(engine.picture(Source::Strategy(Strategy::new(9, 9), Mode::Weighted)).is_none());
    engine.set_paused(true);
    look(&engine, Source::Strategy(Strategy::new(2, 1), Mode::Weighted));
}

/// What a survey costs, in processor time, beside the renderer: figures to read.
#[test]
#[ignore = "a measurement"]
fn what_a_survey_costs() {
    let job = Job { size: [512, 512], ..Job::new(Arc::new(builtin::open("cornell").unwrap())) };
    let time = |what: &str, work: &mut dyn FnMut()| {
        let start = cpu_time::ThreadTime::now();
        work();
        println!("{what}: {:.0} ms", start.elapsed().as_secs_f64() * 1e3);
    };
    let mut survey = None;
    time("two passes with sums", &mut || survey = Some(surveyed(&job, 0..2, Some(1 << 30))));
    time("two passes, outcomes alone", &mut || drop(surveyed(&job, 0..2, None)));
    let survey = survey.unwrap();
    let all = || (0..survey.strategies().len()).flat_map(|n| pixels(job.size).map(move |pixel| (n, pixel)));
    let mut sum = 0.0;
    time("a look at all cells", &mut || {
        sum = all().filter_map(|(n, pixel)| survey.quotient(Mode::Variance, n, pixel).value()).map(|v| v[0]).sum();
    });
    assert!(sum > 0.0);
    let context = job.view();
    let context = Context::new(&job.scene, &context, &job.settings);
    time("the outcomes of a pixel's 256 samples", &mut || drop(pixel_outcomes(&context, &plan(&job), [256, 256], 256)));
    let mut session = Session::new(job.clone()).unwrap();
    while session.passes() < 2 {
        session.step(Duration::from_secs(1));
    }
    println!("two passes of the renderer, all threads together: {:.0} ms", session.stats().cpu_seconds * 1e3);
}
