//! The inspector's depth: what-if weights against the records of jobs that have them, the vertex card, one selection, the search.

use super::*;
use bdpt_explorer::bdpt::record::{PathRecord, VertexRecord};
use bdpt_explorer::bdpt::{Heuristic, Settings};
use bdpt_explorer::engine::{Job, Probe};
use bdpt_explorer::ui::inspector_weights;
use bdpt_explorer::ui::state::{Bars, Tab, Walk};

fn record(window: &Harness<'static, App>) -> Arc<PathRecord> {
    window.state().live().record(window.state().state()).expect("a record").clone()
}

/// Selects the feasible strategy with the most edges of the first sample that has one of at least `edges`.
fn select_long(window: &mut Harness<'static, App>, edges: u32) -> Strategy {
    for sample in 0..500 {
        window.state_mut().state_mut().selection.sample = sample;
        window.run_steps(1);
        let record = record(window);
        if let Some(found) = record.strategies.iter().find(|x| x.feasible && x.strategy().edges() >= edges && x.s > 1 && x.t > 1) {
            let strategy = found.strategy();
            window.state_mut().state_mut().select_strategy(strategy);
            window.run_steps(2);
            return strategy;
        }
    }
    panic!("no sample has a path of {edges} edges");
}

fn heuristics() -> Vec<Heuristic> {
    let of = |kind, beta, cutoff| Heuristic { kind, beta, cutoff };
    let mut all: Vec<_> = [0.0, 0.5, 1.0, 2.0, 3.7, 8.0].map(|beta| of(HeuristicKind::Power, beta, 0.1)).to_vec();
    all.extend([0.0, 0.01, 0.5, 1.0].map(|cutoff| of(HeuristicKind::Cutoff, 2.0, cutoff)));
    all.extend([HeuristicKind::Balance, HeuristicKind::Max, HeuristicKind::Uniform].map(|kind| of(kind, 2.0, 0.1)));
    all
}

/// Weighing the splits of a record by another heuristic gives what a job with that heuristic records, to 1e-6: for every scene,
/// several samples and all heuristics. The control: by another exponent it does not.
#[test]
fn what_if_weights_are_those_of_a_job_that_has_them() {
    let (mut compared, mut moved) = (0, 0);
    for scene in builtin::list() {
        let scene = Arc::new(builtin::open(scene.name).expect("a built-in scene opens"));
        let job = |heuristic| Job { size: SIZE, settings: Settings { heuristic, ..Settings::default() }, ..Job::new(scene.clone()) };
        for sample in 0..4 {
            let pixel = [11 + 13 * sample, 40 - 7 * sample];
            let base = engine::record(&job(Heuristic::default()), pixel, sample).expect("a record");
            for heuristic in heuristics() {
                let other = engine::record(&job(heuristic), pixel, sample).expect("a record");
                for (a, b) in base.strategies.iter().zip(&other.strategies).filter(|(a, _)| a.feasible) {
                    let what_if = inspector_weights(&a.splits, 1, &heuristic);
                    for ((weight, now), then) in what_if.iter().zip(&a.splits).zip(&b.splits) {
                        assert!((weight - then.weight).abs() <= 1e-6, "{} {heuristic:?}: {weight} against {}", scene.name, then.weight);
                        compared += 1;
                        moved += u32::from((now.weight - then.weight).abs() > 1e-3);
                    }
                    let own = b.splits[b.s as usize].weight;
                    assert!((own - f64::from(b.mis_weight)).abs() < 1e-4, "{own} against the renderer's {}", b.mis_weight);
                }
            }
        }
    }
    assert!(compared > 10_000 && moved > 500, "{compared} compared, {moved} of them changed");
}

/// What a split would add is what that strategy itself adds when it is given this very path (its own walks, its own join).
#[test]
fn a_splits_contribution_is_what_its_strategy_computes_itself() {
    use bdpt_explorer::bdpt::connect::Sample;
    use bdpt_explorer::bdpt::context::Context;
    use bdpt_explorer::bdpt::replay::replay;
    let mut compared = 0;
    for name in ["cornell", "rough-metal", "bokeh"] {
        let job = Job { size: SIZE, ..Job::new(Arc::new(builtin::open(name).expect("a built-in scene opens"))) };
        let view = job.view();
        let context = Context::new(&job.scene, &view, &job.settings);
        for sample in 0..30 {
            let pixel = [20, 40];
            let record = engine::record(&job, pixel, sample).expect("a record");
            let mut traced = Sample::default();
            let k = job.settings.max_edges as usize;
            let id = job.settings.sample(pixel, sample);
            traced.trace(&context, id, k + usize::from(view.has_lens()), k + 1);
            for entry in record.strategies.iter().filter(|x| x.feasible) {
                traced.evaluate(&context, entry.strategy()).expect("it carries light");
                let (y, z) = (traced.light_vertices(entry.strategy()).to_vec(), traced.eye_vertices(entry.strategy()).to_vec());
                let x: Vec<_> = y.into_iter().chain(z.into_iter().rev()).collect();
                for split in entry.splits.iter().filter(|x| x.samplable) {
                    let Ok(replayed) = replay(&context, &x, split.s as usize) else { continue };
                    let own = replayed.contribution.contribution_unweighted.to_array().map(f64::from);
                    let ours = split.contribution_unweighted.expect("it can be sampled");
                    let largest = own.iter().copied().fold(0.0, f64::max);
                    for (a, b) in own.iter().zip(ours) {
                        assert!((a - b).abs() <= 2e-4 * largest, "{name} {}: {own:?} against {ours:?}", entry.strategy());
                    }
                    compared += usize::from(split.s != entry.s);
                }
            }
        }
    }
    assert!(compared > 200, "{compared} compared");
}

#[test]
fn what_if_shows_both_weights_at_once_and_the_image_goes_on() {
    let mut window = cornell();
    let strategy = select_long(&mut window, 3);
    click(&mut window, Role::Button, "Splits");
    let before = generation(&window);
    let rows = window.query_all_by_label("what if").count();
    assert_eq!(rows, 0);
    window.get_by_role_and_label(Role::ComboBox, "What-if weights").click();
    window.run_steps(3);
    click(&mut window, Role::Button, "uniform");
    let what_if = window.state().state().inspect.what_if.expect("a heuristic");
    assert_eq!(what_if.kind, HeuristicKind::Uniform);
    assert_eq!(generation(&window), before, "nothing is rendered again");
    let record = record(&window);
    let splits = &record.strategies.iter().find(|x| x.strategy() == strategy).expect("a record").splits;
    let samplable = splits.iter().filter(|x| x.samplable).count();
    let share = format!("{:.3}", 1.0 / samplable as f64);
    assert!(window.query_all_by_label(&share).count() >= samplable, "{share} in every row that can make the path");
    // The bars can show each of the quantities.
    for (name, bars) in [("density", Bars::Density), ("contribution", Bars::Contribution), ("weight", Bars::Weight)] {
        click(&mut window, Role::Button, name);
        assert_eq!(window.state().state().inspect.bars, bars);
    }
    click(&mut window, Role::Button, "Apply to the image");
    assert_eq!(window.state().state().settings.heuristic.kind, HeuristicKind::Uniform);
    assert_eq!(window.state().state().inspect.what_if, None);
    window.run_steps(2);
    assert_eq!(generation(&window), before + 1);
    assert!(window.query_by_label("Apply to the image").is_none());
}

#[test]
fn beta_is_a_slider_on_the_splits_page() {
    let mut window = cornell();
    select_long(&mut window, 2);
    click(&mut window, Role::Button, "Splits");
    let before = generation(&window);
    window.get_by_role_and_label(Role::Slider, "β").focus();
    window.run_steps(2);
    for _ in 0..5 {
        window.key_press(Key::ArrowRight);
        window.run_steps(1);
    }
    let beta = window.state().state().inspect.what_if.expect("another β").beta;
    assert!(beta > 2.0, "{beta}");
    click(&mut window, Role::Button, "As in the image");
    assert_eq!((window.state().state().inspect.what_if, generation(&window)), (None, before));
}

#[test]
fn the_selected_vertex_shows_everything_and_is_copied_as_json() {
    let mut window = cornell();
    let strategy = select_long(&mut window, 3);
    click(&mut window, Role::Button, "Path");
    window.state_mut().state_mut().selection.vertex = 1;
    window.run_steps(3);
    for row in ["n_g", "n_s", "n_g to n_s", "p forward", "p reverse", "x₀ to x₁", "x₁ to x₂", "q", "a"] {
        assert!(window.query_all_by_label(row).next().is_some(), "{row}");
    }
    assert_eq!(window.query_all_by_label("G").count(), 2);
    window.get_by_label_contains("Diffuse: scatters evenly");
    let hit = window.state().state().selection;
    window.get_by_role_and_label(Role::Button, "Copy JSON").click();
    let copied = (0..6).find_map(|_| {
        window.step();
        let commands = &window.output().platform_output.commands;
        commands.iter().find_map(|command| if let egui::OutputCommand::CopyText(text) = command { Some(text.clone()) } else { None })
    });
    let copied = copied.expect("a copy");
    let copied: serde_json::Value = serde_json::from_str(&copied).expect("JSON");
    let record = record(&window);
    let entry = record.strategies.iter().find(|x| x.strategy() == strategy).expect("a record");
    let printed = serde_json::to_string(&entry.vertices[hit.vertex]).expect("JSON");
    assert_eq!(copied, serde_json::from_str::<serde_json::Value>(&printed).expect("JSON"));
    // Stepping, by button and by key.
    click(&mut window, Role::Button, "x₂ →");
    assert_eq!(window.state().state().selection.vertex, 2);
    click(&mut window, Role::Button, "← x₁");
    assert_eq!(window.state().state().selection.vertex, 1);
    press(&mut window, Key::Space);
    assert_eq!(window.state().state().selection.vertex, 2);
}

#[test]
fn a_light_says_what_it_emits() {
    let mut window = showing(scenes::point_and_mirror());
    click(&mut window, Role::Button, "Path");
    window.state_mut().state_mut().select_strategy(Strategy::new(1, 2));
    window.run_steps(3);
    window.get_by_label_contains("W sr⁻¹");
    window.get_by_label("Light leaves a point here, the same in all directions.");
    let mut window = cornell();
    click(&mut window, Role::Button, "Path");
    window.state_mut().state_mut().select_strategy(Strategy::new(1, 2));
    window.run_steps(3);
    assert!(window.query_by_label("L_e").is_some());
    window.get_by_label_contains("Light leaves an area light here");
}

/// Edges: lengths are the distances of the positions, G the cosines over their square.
#[test]
fn edges_are_what_their_ends_say() {
    let scene = Arc::new(builtin::open("cornell").expect("a built-in scene opens"));
    let job = Job { size: SIZE, ..Job::new(scene) };
    let mut checked = 0;
    for sample in 0..20 {
        let record = engine::record(&job, [30, 40], sample).expect("a record");
        let pairs = record.strategies.iter().flat_map(|x| x.vertices.windows(2)).map(|pair| [&pair[0].vertex, &pair[1].vertex]);
        for [a, b] in pairs {
            let edge = b.edge.expect("an edge");
            let d: Vec<f64> = (0..3).map(|i| b.position[i] - a.position[i]).collect();
            let length = d.iter().map(|d| d * d).sum::<f64>().sqrt();
            let cosine = |v: &VertexRecord| (0..3).map(|i| f64::from(v.n_g[i]) * d[i] / length).sum::<f64>().abs();
            assert!((f64::from(edge.length.expect("both ends are near")) - length).abs() < 1e-5 * length.max(1.0));
            let g = cosine(a) * cosine(b) / (length * length);
            assert!((f64::from(edge.geometry_term.expect("a number")) - g).abs() < 1e-4 * g.max(1e-3), "{edge:?} against {g}");
            checked += 1;
        }
    }
    assert!(checked > 200);
}

#[test]
fn marks_in_the_image_select_strategy_and_vertex() {
    let mut window = cornell();
    window.state_mut().state_mut().prefs.pyramid_open = false;
    window.state_mut().state_mut().prefs.space_open = false;
    let strategy = select_long(&mut window, 4);
    window.run_steps(3);
    let before = window.state().state().selection;
    // z₁ is what the pixel shows: its mark is on the pixel.
    let at = window.state().on_screen(before.pixel);
    click_at(&mut window, at);
    let after = window.state().state().selection;
    assert_eq!((after.pixel, after.strategy), (before.pixel, strategy), "the path goes through it: the strategy stays");
    assert_eq!(after.vertex, strategy.edges() as usize - 1);
    // With Ctrl held, the pixel below is selected instead.
    let other = [before.pixel[0] + 1, before.pixel[1]];
    let at = window.state().on_screen(other);
    window.hover_at(at);
    let modifiers = Modifiers::COMMAND | Modifiers::CTRL;
    window.event(egui::Event::ModifiersChanged(modifiers));
    for pressed in [true, false] {
        window.event(egui::Event::PointerButton { pos: at, button: PointerButton::Primary, pressed, modifiers });
    }
    window.run_steps(3);
    window.event(egui::Event::ModifiersChanged(Modifiers::NONE));
    window.run_steps(1);
    assert_eq!(window.state().state().selection.pixel, other);
}

#[test]
fn what_is_selected_elsewhere_comes_into_sight() {
    let mut window = cornell();
    window.state_mut().state_mut().settings.max_edges = 10;
    window.run_steps(3);
    let name = |strategy: Strategy| format!("({},{})", strategy.s, strategy.t);
    let row = |window: &Harness<'static, App>, strategy: Strategy| {
        let inspector = window.query_all_by_role(Role::Button).filter(|node| node.rect().width() > 250.0);
        inspector.filter(|node| node.accesskit_node().label().is_some_and(|l| l.contains(&name(strategy)))).map(|node| node.rect()).next()
    };
    for strategy in [Strategy::new(9, 2), Strategy::new(1, 1), Strategy::new(4, 6)] {
        window.state_mut().state_mut().select_strategy(strategy);
        window.run_steps(30);
        let rect = row(&window, strategy).expect("a row");
        assert!(rect.min.y > 100.0 && rect.max.y < 880.0, "{strategy} is at {rect:?}");
    }
}

#[test]
fn the_next_sample_with_light_and_the_brightest_are_found() {
    let mut window = cornell();
    let strategy = Strategy::new(3, 3);
    window.state_mut().state_mut().select_strategy(strategy);
    window.run_steps(2);
    let job = window.state().live().engine().expect("an engine").job().clone();
    let pixel = window.state().state().selection.pixel;
    let carries = |sample: u32| {
        let record = engine::record(&job, pixel, sample).expect("a record");
        record.strategies.iter().any(|x| x.strategy() == strategy && x.feasible)
    };
    for _ in 0..3 {
        let from = window.state().state().selection.sample;
        let expected = (from + 1..from + 5000).find(|sample| carries(*sample)).expect("one carries light");
        press(&mut window, Key::L);
        until(&mut window, "the sample", |app| app.state().inspect.search.is_none());
        assert_eq!(window.state().state().selection.sample, expected);
        assert_record(&window);
    }
    // The brightest of 256, by the records themselves.
    let from = window.state().state().selection.sample;
    let adds = |sample: u32| {
        let record = engine::record(&job, pixel, sample).expect("a record");
        let here = |raster: [f32; 2]| raster.map(|v| v.floor() as i64) == pixel.map(i64::from);
        let lands = record.strategies.iter().filter(|x| x.feasible && x.raster.is_some_and(here));
        lands.map(|x| 0.2126 * x.contribution[0] + 0.7152 * x.contribution[1] + 0.0722 * x.contribution[2]).sum::<f32>()
    };
    let mut probe = Probe::new(&job, pixel).expect("a pixel of the film");
    let brightest = (from + 1..=from + 256).max_by(|a, b| adds(*a).total_cmp(&adds(*b))).expect("a sample");
    let found = probe.on_its_pixel(brightest).dot(Vec3::new(0.2126, 0.7152, 0.0722));
    assert!((found - adds(brightest)).abs() <= 1e-5 * found, "the probe adds up what the record says");
    click(&mut window, Role::Button, "Brightest of 256");
    until(&mut window, "the sample", |app| app.state().inspect.search.is_none());
    let sample = window.state().state().selection.sample;
    assert!(adds(sample) >= 0.999_99 * adds(brightest), "{sample} adds {}, {brightest} {}", adds(sample), adds(brightest));
}

#[test]
fn a_search_can_be_stopped_and_says_when_there_is_nothing() {
    let mut window = showing(scenes::point_and_mirror());
    // No eye subpath can hit a point light, however long one looks.
    window.state_mut().state_mut().select_strategy(Strategy::new(0, 3));
    window.run_steps(2);
    click(&mut window, Role::Button, "Next with light");
    assert!(window.state().state().inspect.search.is_some());
    let sample = window.state().state().selection.sample;
    click(&mut window, Role::Button, "Stop");
    assert!(window.state().state().inspect.search.is_none());
    press(&mut window, Key::L);
    window.key_press(Key::Escape);
    window.run_steps(2);
    assert!(window.state().state().inspect.search.is_none(), "Escape stops it as well");
    // Another selection ends it, too.
    press(&mut window, Key::L);
    press(&mut window, Key::ArrowLeft);
    assert!(window.state().state().inspect.search.is_none());
    press(&mut window, Key::L);
    until(&mut window, "the answer", |app| app.state().inspect.search.is_none());
    window.run_steps(2);
    assert!(window.query_by_label_contains("carry light.").is_some() || window.query_by_label_contains("In none of the next").is_some());
    assert_eq!(window.state().state().selection.sample, sample);
}

#[test]
fn the_inspector_is_named_in_both_languages() {
    let mut window = cornell();
    select_long(&mut window, 3);
    for lang in [Lang::En, Lang::Zh] {
        for tab in [Tab::Strategies, Tab::Path, Tab::Splits] {
            for walk in [Walk::Full, Walk::Light, Walk::Eye] {
                let state = window.state_mut().state_mut();
                (state.prefs.lang, state.prefs.tab, state.walk) = (lang, tab, walk);
                window.run_steps(3);
                window.check_accessibility();
                assert!(window.query_by_label_contains("{}").is_none());
            }
        }
    }
}
