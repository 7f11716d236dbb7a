//! Every number the inspector shows is the one `inspect --json` prints. Each carries its place in the JSON (`ui/cite.rs`); here all of
//! them are read off the pages for random records of every built-in scene and compared with what the program itself prints for the
//! same scene, pixel, sample, seed, size and K: a number shown with n digits is the number of the JSON rounded to them.

use super::*;
use bdpt_explorer::ui::state::{Bars, Tab, Walk};
use serde_json::Value;
use std::process::Command;

/// Records per scene; with 13 scenes, more than a hundred.
const PER_SCENE: u32 = 8;

/// A number as it stands on the screen, with its place.
struct Shown {
    place: String,
    text: String,
}

/// A window tall enough that every row of every page is in sight.
fn tall(scene: &str) -> Harness<'static, App> {
    let source = SceneSource::Ready(Arc::new(builtin::open(scene).expect("a built-in scene opens")));
    let mut window = Harness::builder()
        .with_size(egui::vec2(1200.0, 6000.0))
        .allow_missing_glyphs()
        .build_eframe(|context| App::new(Start { source, size: SIZE }, &context.egui_ctx, None));
    until(&mut window, "a record", |app| app.live().record(app.state()).is_some());
    let state = window.state_mut().state_mut();
    (state.paused, state.prefs.space_open, state.prefs.pyramid_open) = (true, false, false);
    window
}

/// Everything on the page that has a place.
fn numbers(window: &Harness<'static, App>) -> Vec<Shown> {
    let mut found = Vec::new();
    let mut stack = vec![window.root()];
    while let Some(node) = stack.pop() {
        let inner = node.accesskit_node();
        if let Some(place) = inner.data().author_id() {
            let text = inner.value().or_else(|| inner.label()).unwrap_or_default();
            found.push(Shown { place: place.to_owned(), text });
        }
        stack.extend(node.children());
    }
    found
}

/// Every number in a text, with half a unit of its last digit.
fn parse(text: &str) -> Vec<(f64, f64)> {
    let text = text.replace("10^", " ");
    let is_part = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | 'e');
    let words = text.split(|c: char| !is_part(c));
    let number = |word: &str| {
        let value: f64 = word.parse().ok()?;
        let (mantissa, exponent) = word.split_once('e').map_or((word, 0), |(m, e)| (m, e.parse().unwrap_or(0)));
        let decimals = mantissa.split_once('.').map_or(0, |(_, d)| d.len() as i32);
        Some((value, 0.5 * 10f64.powi(exponent - decimals)))
    };
    words.filter(|word| word.chars().any(|c| c.is_ascii_digit())).filter_map(number).collect()
}

fn list(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(values) => values.iter().flat_map(list).collect(),
        Value::Number(number) => number.as_f64().into_iter().collect(),
        _ => Vec::new(),
    }
}

fn luminance(rgb: &[f64]) -> f64 {
    0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
}

fn degrees(a: &[f64], b: &[f64]) -> f64 {
    let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let dot: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
    cross.iter().map(|c| c * c).sum::<f64>().sqrt().atan2(dot).to_degrees()
}

/// What stands at a place of the JSON, or follows from it.
fn expected(json: &Value, place: &str) -> Vec<f64> {
    let at = |pointer: &str| json.pointer(pointer).unwrap_or_else(|| panic!("{pointer} is nowhere in the JSON"));
    let strategies = || at("/strategies").as_array().expect("a list");
    match place.split_once(':') {
        None => list(at(place)),
        Some(("luminance", pointer)) => vec![luminance(&list(at(pointer)))],
        Some(("floor", pointer)) => list(at(pointer)).into_iter().map(f64::floor).collect(),
        Some(("rough-metal", pointer)) => vec![list(&at(pointer)["roughness"])[0], list(&at(pointer)["metallic"])[0]],
        Some(("angle", pointer)) => vec![degrees(&list(&at(pointer)["n_g"]), &list(&at(pointer)["n_s"]))],
        Some(("sum", pointer)) => {
            let splits = at(pointer.strip_suffix("/*/weight").expect("weights")).as_array().expect("a list");
            vec![splits.iter().map(|split| list(&split["weight"])[0]).sum()]
        }
        Some(("count", _)) => {
            let feasible = strategies().iter().filter(|x| x["feasible"] == true).count() as f64;
            vec![feasible]
        }
        Some(("adds", _)) => {
            let pixel = list(at("/pixel"));
            let lands = |x: &&Value| x["feasible"] == true && list(&x["raster"]).iter().map(|v| v.floor()).eq(pixel.iter().copied());
            let mut sum = [0.0; 3];
            strategies().iter().filter(lands).for_each(|x| (0..3).for_each(|i| sum[i] += list(&x["contribution"])[i]));
            sum.to_vec()
        }
        Some((rule, _)) => panic!("no such rule: {rule}"),
    }
}

/// What is wrong with a number on the screen, if anything.
fn wrong(json: &Value, shown: &Shown) -> Option<String> {
    let (expected, found) = (expected(json, &shown.place), parse(&shown.text));
    let fault = |why: &str| Some(format!("{}: {:?} on the screen, {expected:?} in the JSON: {why}", shown.place, shown.text));
    // Three equal channels are one number; "4 of 27" has the count first; what is not there is a dash or a word.
    let wanted = match (&expected[..], found.len()) {
        ([a, b, c], 1) if a == b && b == c => vec![*a],
        (_, 2) if shown.place.starts_with("count:") => expected.clone(),
        ([], 0) => return None,
        _ => expected.clone(),
    };
    if wanted.len() != found.len() && !shown.place.starts_with("count:") {
        return fault("another number of numbers");
    }
    for (value, (number, half)) in wanted.iter().zip(&found) {
        // Sums are added up in single precision there.
        let slack = if shown.place.starts_with("adds:") { 1e-5 } else { 2e-7 };
        if (value - number).abs() > half * 1.000_001 + slack * value.abs() {
            return fault("not the same");
        }
    }
    None
}

/// The JSON that the program prints.
fn printed(scene: &str, window: &Harness<'static, App>) -> Value {
    let state = window.state().state();
    let ([x, y], [width, height]) = (state.selection.pixel, state.size);
    let arguments = [
        format!("--pixel={x},{y}"),
        format!("--sample={}", state.selection.sample),
        format!("--size={width}x{height}"),
        format!("--seed={}", state.settings.seed),
        format!("--max-edges={}", state.settings.max_edges),
        "--json".to_owned(),
    ];
    let output =
        Command::new(env!("CARGO_BIN_EXE_bdpt-explorer")).args(["inspect", scene]).args(&arguments).output().expect("the program runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// Every page of the inspector.
const PAGES: [(Tab, Walk); 5] =
    [(Tab::Strategies, Walk::Full), (Tab::Path, Walk::Full), (Tab::Path, Walk::Light), (Tab::Path, Walk::Eye), (Tab::Splits, Walk::Full)];

/// Goes through all pages; the faults, and how many numbers were compared.
fn walk(window: &mut Harness<'static, App>, json: &Value) -> (Vec<String>, usize) {
    let (mut faults, mut count) = (Vec::new(), 0);
    for (tab, walk) in PAGES {
        let state = window.state_mut().state_mut();
        (state.prefs.tab, state.walk) = (tab, walk);
        window.run_steps(2);
        let found = numbers(window);
        assert!(!found.is_empty());
        count += found.len();
        faults.extend(found.iter().filter_map(|shown| wrong(json, shown)));
        assert!(window.query_by_label_contains("NaN").is_none() && window.query_by_label_contains("inf ").is_none());
    }
    (faults, count)
}

fn random(state: &mut u64, below: u32) -> u32 {
    // A multiplicative congruential generator with Knuth's factor: any spread of records will do.
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    ((*state >> 33) % u64::from(below)) as u32
}

/// Shows a random record; selects the strategy and vertex so that the pages have something to show.
fn show_random(window: &mut Harness<'static, App>, dice: &mut u64) {
    let before = generation(window);
    let state = window.state_mut().state_mut();
    (state.settings.seed, state.settings.max_edges) = (random(dice, 1_000_000), 1 + random(dice, 8));
    state.selection.pixel = [random(dice, SIZE[0]), random(dice, SIZE[1])];
    state.selection.sample = random(dice, 100_000);
    state.inspect.bars = [Bars::Density, Bars::Weight, Bars::Contribution][random(dice, 3) as usize];
    window.run_steps(2);
    until(window, "the record", |app| {
        app.live().engine().is_some_and(|engine| engine.generation() > before) && app.live().record(app.state()).is_some()
    });
    let record = window.state().live().record(window.state().state()).expect("a record").clone();
    let feasible: Vec<_> = record.strategies.iter().filter(|x| x.feasible).collect();
    let all: Vec<_> = record.strategies.iter().collect();
    let from = if feasible.is_empty() { &all } else { &feasible };
    let chosen = from[random(dice, from.len() as u32) as usize];
    let state = window.state_mut().state_mut();
    state.select_strategy(chosen.strategy());
    state.selection.vertex = random(dice, chosen.s + chosen.t) as usize;
}

#[test]
fn every_number_on_the_screen_is_the_one_inspect_prints() {
    let (mut dice, mut records, mut total) = (7, 0, 0);
    for scene in builtin::list() {
        let mut window = tall(scene.name);
        for _ in 0..PER_SCENE {
            show_random(&mut window, &mut dice);
            let json = printed(scene.name, &window);
            let (faults, count) = walk(&mut window, &json);
            assert!(faults.is_empty(), "{}:\n{}", scene.name, faults.join("\n"));
            (records, total) = (records + 1, total + count);
        }
    }
    println!("{total} numbers of {records} records of {} scenes", builtin::list().len());
    assert!(records >= 100 && total > 30 * records, "{total} numbers of {records} records");
}

/// The control: a number that is off by as little as the screen can show is found, in every kind of place; so is another record.
#[test]
fn a_wrong_number_would_be_found() {
    let mut window = tall("cornell");
    let mut dice = 3;
    show_random(&mut window, &mut dice);
    let json = printed("cornell", &window);
    assert_eq!(walk(&mut window, &json).0, Vec::<String>::new());
    // Every number of the JSON, one tenth of a percent larger: every number on the screen that is not zero must be found.
    fn larger(value: &mut Value) {
        match value {
            Value::Array(list) => list.iter_mut().for_each(larger),
            Value::Object(map) => map.values_mut().for_each(larger),
            Value::Number(number) if number.is_f64() => *value = serde_json::json!(number.as_f64().expect("a number") * 1.02),
            _ => {}
        }
    }
    let mut perturbed = json.clone();
    larger(&mut perturbed);
    let (tab, full) = PAGES[1];
    let state = window.state_mut().state_mut();
    (state.prefs.tab, state.walk) = (tab, full);
    window.run_steps(2);
    let found = numbers(&window);
    let nonzero: Vec<&Shown> = found.iter().filter(|x| x.place.starts_with('/') && parse(&x.text).iter().any(|(v, _)| *v != 0.0)).collect();
    assert!(nonzero.len() > 20);
    // A coordinate of a few tenths of a millimetre has fewer digits than two percent of it.
    let digits = |x: &&&Shown| parse(&x.text).iter().any(|(value, half)| value.abs() * 0.02 > 2.1 * half);
    for shown in nonzero.iter().filter(digits) {
        assert!(wrong(&perturbed, shown).is_some(), "{} {:?} passes although it is wrong", shown.place, shown.text);
    }
    window.state_mut().state_mut().selection.sample += 1;
    window.run_steps(3);
    let (faults, _) = walk(&mut window, &json);
    assert!(faults.len() > 10, "another sample's numbers pass");
}
