//! The window's "Save" menu: what is written is read back and held against what is shown.

use super::*;
use bdpt_explorer::engine::{Mode, Values};
use bdpt_explorer::film::tonemap::ToneMap;
use bdpt_explorer::report::export::{diagram_svg, record_json, strategies_csv, vertices_csv};
use bdpt_explorer::ui::state::{CompareMode, Source, What};
use exr::prelude::{ReadChannels, ReadLayers};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The window on the Cornell box, standing still after some passes.
fn still() -> Harness<'static, App> {
    let mut window = cornell();
    until(&mut window, "some light", |app| app.live().frame().is_some_and(|f| f.stats.spp >= 2.0));
    window.state_mut().state_mut().paused = true;
    window.run_steps(2);
    // The frame of the last slice is still on its way.
    std::thread::sleep(Duration::from_millis(400));
    window.run_steps(3);
    window
}

/// Saves through the menu, as a person would; the path is put into its field.
fn save(window: &mut Harness<'static, App>, what: What, path: &Path) {
    click(window, Role::Button, "Save");
    let state = window.state_mut().state_mut();
    (state.export.what, state.export.path, state.export.typed) = (what, path.display().to_string(), true);
    window.run_steps(2);
    click(window, Role::Button, "Save this");
}

fn written(window: &mut Harness<'static, App>, path: &Path) {
    let said = format!("Saved {}", path.display());
    until(window, "the file", |app| app.state().export.underway == 0 && app.state().messages.iter().any(|m| m.text == said));
    assert_eq!(window.state().state().messages.iter().filter(|m| m.text.starts_with("Saved")).count(), 1, "one message");
}

fn channels(path: &Path) -> BTreeMap<String, Vec<f32>> {
    let reader = exr::prelude::read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes();
    let layer = reader.from_file(path).expect("an EXR file").layer_data;
    let list = layer.channel_data.list.into_iter();
    list.map(|channel| (channel.name.to_string(), channel.sample_data.values_as_f32().collect())).collect()
}

#[test]
fn everything_that_can_be_saved_is_what_is_shown() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| -> PathBuf { folder.path().join(name) };
    let mut window = still();
    let state = window.state_mut().state_mut();
    (state.exposure, state.view.offset, state.tonemap) = (1.0, 0.05, ToneMap::Aces);
    window.run_steps(2);
    for (what, name) in [
        (What::Seen, "a.png"),
        (What::Radiance, "a.exr"),
        (What::Layers, "l.exr"),
        (What::Json, "a.json"),
        (What::Diagram, "a.svg"),
        (What::Strategies, "s.csv"),
        (What::Vertices, "v.csv"),
    ] {
        save(&mut window, what, &at(name));
        written(&mut window, &at(name));
    }
    let frame = window.state().live().frame().expect("a frame").clone();
    let png = image::open(at("a.png")).expect("a PNG").to_rgb8();
    assert_eq!((png.width(), png.height()), (SIZE[0], SIZE[1]));
    let look = window.state().state().look();
    let shown: Vec<u8> = frame.image.iter().flat_map(|pixel| look.rgb8(*pixel)).collect();
    assert_eq!(png.into_raw(), shown);
    let radiance = channels(&at("a.exr"));
    for (i, channel) in ["R", "G", "B"].into_iter().enumerate() {
        assert_eq!(radiance[channel], frame.image.iter().map(|pixel| pixel[i]).collect::<Vec<_>>());
    }
    // The weighted layers add up to the picture.
    let layers = channels(&at("l.exr"));
    assert_eq!(layers.keys().filter(|name| name.starts_with("weighted.") && name.ends_with(".R")).count(), frame.thumbnails.len());
    let mut sum = vec![0.0f64; frame.image.len()];
    for (_, pixels) in layers.iter().filter(|(name, _)| name.starts_with("weighted.") && name.ends_with(".G")) {
        sum.iter_mut().zip(pixels).for_each(|(sum, v)| *sum += f64::from(*v));
    }
    let off = |sum: &[f64]| {
        sum.iter().zip(&frame.image).filter(|(sum, pixel)| (**sum - f64::from(pixel.y)).abs() > 1e-4 * sum.abs().max(1e-3)).count()
    };
    assert_eq!(off(&sum), 0, "pixels whose layers do not add up");
    // The control: without one layer they do not.
    layers["weighted.s1t2.G"].iter().zip(&mut sum).for_each(|(v, sum)| *sum -= f64::from(*v));
    assert!(off(&sum) > sum.len() / 10);
    let record = window.state().live().record(window.state().state()).expect("a record").clone();
    let read = |name: &str| std::fs::read_to_string(at(name)).expect("a file");
    assert_eq!(read("a.json"), record_json(&record).expect("JSON"));
    assert_eq!(read("a.svg"), diagram_svg(&record, Some(window.state().state().selection.strategy)));
    assert_eq!((read("s.csv"), read("v.csv")), (strategies_csv(&record), vertices_csv(&record)));
    assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 7, "nothing else is left there");
}

#[test]
fn what_is_saved_as_shown_is_the_picture_in_the_view() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = still();
    let saved = |window: &mut Harness<'static, App>, name: &str| {
        let path = folder.path().join(name);
        save(window, What::Seen, &path);
        written(window, &path);
        image::open(path).expect("a PNG").to_rgb8().into_raw()
    };
    let image = saved(&mut window, "image.png");
    // A strategy in large.
    let source = bdpt_explorer::engine::Source::Strategy(Strategy::new(1, 2), Mode::Weighted);
    window.state_mut().state_mut().open_large(Strategy::new(1, 2), Mode::Weighted);
    until(&mut window, "the strategy's picture", |app| app.live().engine().is_some_and(|engine| engine.picture(source).is_some()));
    let picture = window.state().live().engine().and_then(|engine| engine.picture(source)).expect("a picture");
    let Values::Colour(values) = &picture.values else { panic!("colours") };
    let look = window.state().state().look();
    let strategy = saved(&mut window, "strategy.png");
    assert_eq!(strategy, values.iter().flat_map(|pixel| look.rgb8(*pixel)).collect::<Vec<u8>>());
    assert_ne!(strategy, image);
    // Compared with the image: B, and the difference.
    let compare = &mut window.state_mut().state_mut().compare;
    (compare.open, compare.b, compare.flipped) = (true, Some(Source::Image), true);
    window.run_steps(2);
    assert_eq!(saved(&mut window, "b.png"), image);
    window.state_mut().state_mut().compare.mode = CompareMode::Difference;
    window.run_steps(2);
    let difference = saved(&mut window, "difference.png");
    assert!(difference != image && difference != strategy);
}

#[test]
fn an_existing_file_is_replaced_only_when_that_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("there.json");
    std::fs::write(&path, "old").expect("a file");
    let mut window = still();
    save(&mut window, What::Json, &path);
    window.get_by_label("This file exists.");
    click(&mut window, Role::Button, "Keep it");
    assert!(window.query_by_label("This file exists.").is_none());
    assert_eq!(std::fs::read_to_string(&path).expect("a file"), "old");
    click(&mut window, Role::Button, "Save this");
    click(&mut window, Role::Button, "Replace it");
    written(&mut window, &path);
    assert!(std::fs::read_to_string(&path).expect("a file").starts_with('{'));
}

#[test]
fn a_failure_is_one_message_with_the_path_and_leaves_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("none/a.png");
    let mut window = still();
    save(&mut window, What::Seen, &path);
    until(&mut window, "the failure", |app| app.state().messages.iter().any(|m| m.error));
    let state = window.state().state();
    let said: Vec<_> = state.messages.iter().filter(|m| m.error).collect();
    assert!(
        said.len() == 1 && said[0].text.contains(&path.display().to_string()) && said[0].text.contains("there is no folder"),
        "{said:?}"
    );
    assert_eq!((state.export.underway, std::fs::read_dir(folder.path()).expect("a folder").count()), (0, 0));
    // The next one that works takes the failure back.
    let path = folder.path().join("a.png");
    save(&mut window, What::Seen, &path);
    written(&mut window, &path);
    assert!(!window.state().state().messages.iter().any(|m| m.error));
}

#[test]
fn a_name_is_proposed_that_says_what_it_is() {
    let mut window = still();
    window.state_mut().state_mut().selection.pixel = [20, 41];
    window.state_mut().state_mut().selection.sample = 7;
    window.run_steps(2);
    click(&mut window, Role::Button, "Save");
    assert_eq!(window.state().state().export.path, "cornell.png");
    for (name, path) in [
        ("Diagram of this sample (SVG)", "cornell-x20y41-s7.svg"),
        ("Table of strategies (CSV)", "cornell-x20y41-s7-strategies.csv"),
        ("All strategies (layered EXR)", "cornell-strategies.exr"),
    ] {
        click(&mut window, Role::Button, name);
        assert_eq!(window.state().state().export.path, path);
    }
    window.check_accessibility();
    // What was typed stays; its folder is kept for what is chosen next.
    window.state_mut().state_mut().export.path = "pictures/mine.exr".to_owned();
    window.state_mut().state_mut().export.typed = true;
    window.run_steps(3);
    assert_eq!(window.state().state().export.path, "pictures/mine.exr");
    click(&mut window, Role::Button, "Picture as shown (PNG)");
    assert_eq!(Path::new(&window.state().state().export.path), Path::new("pictures").join("cornell.png"));
}
