//! Links: what they show in another window, what is said where they cannot be followed, and how they are copied.

use super::*;
use bdpt_explorer::scene::environment::EnvironmentSource;
use bdpt_explorer::ui::state::{Maximised, Tab};
use bdpt_explorer::ui::text::LinkText;

fn settle(window: &mut Harness<'static, App>) {
    until(window, "the scene", |app| {
        app.live().loading().is_none() && app.state().open.is_none() && app.live().record(app.state()).is_some()
    });
    window.run_steps(3);
}

/// The window on what a link is about.
fn linked(text: &str) -> Harness<'static, App> {
    let mut window = start(SceneSource::Link(text.to_owned()));
    settle(&mut window);
    window
}

fn said(window: &Harness<'static, App>) -> String {
    window.state().state().messages.iter().map(|message| message.text.as_str()).collect::<Vec<_>>().join("\n")
}

fn scene(window: &Harness<'static, App>) -> String {
    window.state().live().scene().expect("a scene").name.clone()
}

/// Is it said that something of a link was not followed?
fn ignores(window: &Harness<'static, App>, lang: Lang) -> bool {
    let sentence = LinkText::Ignored.in_language(lang).split("{}").next().expect("a beginning");
    said(window).contains(sentence)
}

/// A window in which nearly everything is otherwise than at the first start.
fn chosen() -> Harness<'static, App> {
    let mut window = showing(Arc::new(builtin::open("bokeh").expect("a built-in scene opens")));
    let scene = window.state().live().scene().expect("a scene").clone();
    let state = window.state_mut().state_mut();
    state.resize([80, 60]);
    (state.settings.max_edges, state.settings.seed, state.settings.roulette) = (5, 77, false);
    (state.settings.heuristic.kind, state.settings.heuristic.cutoff) = (HeuristicKind::Cutoff, 0.25);
    state.settings.strategies.set(Strategy::new(0, 3), false);
    state.hidden.set(Strategy::new(1, 2), true);
    state.lens = Some(bdpt_explorer::scene::Lens { radius: 0.01, focus_distance: 2.0 });
    let pose = bdpt_explorer::scene::Pose::of(&scene, &scene.cameras[0]);
    state.pose = Some(pose.orbit(scene.origin, 0.05, 0.02));
    let name = scene.material_names[0].clone();
    let edit = bdpt_explorer::scene::edit::MaterialEdit { name, color: Some([0.3, 0.1, 0.9]), ..Default::default() };
    state.edit.edits.materials.insert(0, edit);
    state.select_pixel(31, 40);
    (state.selection.sample, state.exposure) = (12, 1.5);
    state.select_strategy(Strategy::new(1, 3));
    state.selection.vertex = 2;
    (state.prefs.tab, state.prefs.lang) = (Tab::Path, Lang::Zh);
    (state.prefs.pyramid_open, state.prefs.camera_open) = (false, true);
    settle(&mut window);
    window
}

#[test]
fn a_link_shows_the_same_path_and_the_same_numbers_elsewhere() {
    let source = chosen();
    let link = source.state().link();
    let record = source.state().live().record(source.state().state()).expect("a record").clone();
    assert_eq!((record.pixel, record.sample, record.seed, record.size, record.max_edges), ([31, 40], 12, 77, [80, 60], 5));
    assert!(record.pose.is_some() && record.edits.is_some());
    // A window that opens on it, one that shows another scene, and one in which everything is otherwise.
    let other = start(SceneSource::Named("furnace".to_owned()));
    let mut busy = cornell();
    busy.state_mut().state_mut().maximised = Maximised::Pyramid;
    busy.state_mut().state_mut().selection.sample = 5;
    for mut window in [linked(&link), other, busy] {
        settle(&mut window);
        window.state_mut().open_link(&format!("https://example.org/explorer/{link}"));
        settle(&mut window);
        let app = window.state();
        assert_eq!(**app.live().record(app.state()).expect("a record"), *record);
        assert_record(&window);
        assert_eq!((app.link(), ignores(&window, Lang::Zh)), (link.clone(), false));
        assert_eq!(app.state().hidden, source.state().state().hidden);
        window.get_by_role_and_label(Role::Button, LinkText::CopyLink.in_language(Lang::Zh));
    }
    // The control: another seed is another path, and what is not known is said.
    let window = linked(&link.replace("seed=77", "seed=78&foo=bar"));
    assert!(ignores(&window, Lang::Zh));
    assert_ne!(window.state().live().record(window.state().state()).expect("a record").eye, record.eye);
}

#[test]
fn a_link_to_the_scene_on_show_reads_nothing_again_and_can_be_undone() {
    let mut window = cornell();
    let file = window.state().live().file_scene().expect("a scene").clone();
    let before = window.state().link();
    window.run_steps(2);
    window.state_mut().open_link(&before.replace("scene=cornell", "scene=cornell&k=3&n=9&lamp.0.name=light&lamp.0.power=2"));
    settle(&mut window);
    assert!(Arc::ptr_eq(window.state().live().file_scene().expect("a scene"), &file));
    assert_eq!((window.state().state().settings.max_edges, window.state().state().selection.sample), (3, 9));
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    settle(&mut window);
    assert_eq!(window.state().state().settings.max_edges, 6);
    // Another scene starts from its first sample, as ever.
    window.state_mut().state_mut().open = Some(Opening::of("furnace"));
    until(&mut window, "another scene", |app| app.live().scene().is_some_and(|scene| scene.name == "furnace"));
    settle(&mut window);
    assert_eq!(window.state().state().selection.sample, 0);
}

#[test]
fn a_broken_link_opens_the_default_scene_and_says_what_it_ignored() {
    let text = "#v=1&scene=nowhere&cam=3&k=1000&size=32x32&foo=bar&ev=nan&mat.0.color=1,1,1";
    let window = linked(text);
    assert_eq!(scene(&window), "cornell");
    let message = said(&window);
    for piece in ["scene=nowhere", "cam", "k=1000", "64", "foo=bar", "ev=nan", "mat.0.color"] {
        assert!(message.contains(piece), "{piece}: {message}");
    }
    assert_eq!(window.state().state().messages.len(), 1, "{message}");
    assert_eq!((window.state().state().settings.max_edges, window.state().state().size), (64, [32, 32]));
    // Noise, what is too long, and what the loader refuses: there is always something to look at.
    let long = format!("#v=1&scene=furnace&{}", "x".repeat(9000));
    for (text, named) in [("#\u{0}%%%&&==&", "%%%"), (long.as_str(), "8192"), ("#scene=spots&inside=attic&k=3", "inside")] {
        let window = linked(text);
        assert!(said(&window).contains(named), "{}", said(&window));
        assert_eq!(scene(&window), if named == "inside" { "spots" } else { "cornell" });
    }
    // The next link takes back what was said of the last one.
    let mut window = linked("#scene=nowhere");
    assert!(said(&window).contains("nowhere"));
    window.state_mut().open_link("#scene=cornell");
    settle(&mut window);
    assert!(said(&window).is_empty(), "{}", said(&window));
}

#[test]
fn a_file_is_asked_for_by_its_name_and_then_shown_as_the_link_says() {
    let folder = tempfile::tempdir().expect("a folder");
    let (room, sky) = (folder.path().join("room.glb"), surroundings::sky(folder.path()));
    let bytes = builtin::list().iter().find(|x| x.name == "cornell").expect("a built-in scene").bytes;
    std::fs::write(&room, bytes).expect("a file");
    let text = "#v=1&est=3&lang=en&file=room.glb&envfile=sky.hdr&turn=90&size=48x32&k=4&px=7,9&n=5&sky.strength=2";
    let mut window = linked(text);
    assert_eq!(scene(&window), "cornell");
    assert!(said(&window).contains("room.glb") && !said(&window).contains("sky.hdr"), "{}", said(&window));
    assert_eq!((window.state().link().as_str(), window.state().state().size), (text, SIZE), "the link is not lost meanwhile");
    drop_file(&mut window, &room);
    until(&mut window, "the room", |app| app.live().scene().is_some_and(|scene| scene.name.contains("room")));
    settle(&mut window);
    let state = window.state().state();
    assert_eq!((state.size, state.settings.max_edges, state.selection.pixel, state.selection.sample), ([48, 32], 4, [7, 9], 5));
    assert!(!said(&window).contains("drop it on the window, and") && said(&window).contains("sky.hdr"), "{}", said(&window));
    assert_eq!(window.state().link(), text);
    drop_file(&mut window, &sky);
    until(&mut window, "the sky", |app| {
        app.live().opened().and_then(|opening| opening.environment.as_ref()).is_some_and(|chosen| chosen.rotation == 90.0)
    });
    settle(&mut window);
    assert!(!said(&window).contains("sky.hdr"), "{}", said(&window));
    let app = window.state();
    assert_eq!((app.link().as_str(), app.state().edit.edits.environment.strength), (text, Some(2.0)));
    let source = &app.live().opened().expect("a scene").environment.as_ref().expect("a sky").source;
    assert_eq!(*source, EnvironmentSource::File(sky));
    // With both at hand, the same link is followed at once.
    window.state_mut().open_link(&text.replace("n=5", "n=6"));
    settle(&mut window);
    assert_eq!((window.state().state().selection.sample, said(&window).as_str()), (6, ""));
}

#[test]
fn whoever_opens_something_else_is_not_held_up_by_a_link() {
    let mut window = linked("#file=room.glb&n=5");
    window.state_mut().state_mut().open = Some(Opening::of("furnace"));
    until(&mut window, "another scene", |app| app.live().scene().is_some_and(|scene| scene.name == "furnace"));
    settle(&mut window);
    assert!(said(&window).is_empty(), "{}", said(&window));
    assert_eq!(window.state().state().selection.sample, 0);
    assert!(window.state().link().contains("scene=furnace"));
}

fn copied(window: &mut Harness<'static, App>) -> Option<String> {
    (0..6).find_map(|_| {
        window.step();
        let commands = &window.output().platform_output.commands;
        commands.iter().find_map(|command| if let egui::OutputCommand::CopyText(text) = command { Some(text.clone()) } else { None })
    })
}

#[test]
fn a_link_is_copied_by_button_and_key_and_that_is_said_for_a_moment() {
    let mut window = cornell();
    window.get_by_role_and_label(Role::Button, "Copy link").click();
    let text = copied(&mut window).expect("a copy");
    assert_eq!(text, window.state().link());
    assert!(text.starts_with("#v=1&est=3&lang=en&scene=cornell&size=64x64"), "{text}");
    window.run_steps(2);
    window.get_by_label_contains("Link copied");
    window.state_mut().set_link_base("https://example.org/x/".to_owned(), true);
    window.state_mut().state_mut().selection.sample = 3;
    window.state_mut().state_mut().compare.keep = true;
    window.run_steps(2);
    let kept = window.state().state().compare.kept.first().map(|kept| bdpt_explorer::ui::state::Source::Kept(kept.id));
    window.state_mut().state_mut().compare.b = kept;
    let (key, modifiers) = (Key::U, Modifiers::NONE);
    window.event(egui::Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers });
    let text = copied(&mut window).expect("a copy");
    assert_eq!(text, format!("https://example.org/x/{}", window.state().link()));
    assert!(text.contains("&n=3"));
    window.run_steps(2);
    window.get_by_label_contains("Kept pictures do not travel");
    std::thread::sleep(Duration::from_millis(4100));
    window.run_steps(2);
    assert!(window.query_by_label_contains("Link copied").is_none());
}

#[test]
fn where_nothing_can_be_copied_the_address_bar_is_named_instead() {
    let mut window = cornell();
    window.state_mut().set_link_base("http://192.168.0.7/x/".to_owned(), false);
    window.get_by_role_and_label(Role::Button, "Copy link").click();
    assert_eq!(copied(&mut window), None);
    window.get_by_label_contains("from the address bar");
    assert!(window.query_by_label_contains("Link copied").is_none());
}

#[test]
fn a_link_that_waits_is_copied_as_it_came() {
    let text = "#v=1&est=3&lang=en&file=room.glb&envfile=sky.hdr&px=7,9";
    let mut window = linked(text);
    // What is on show meanwhile is not what is copied: nor are the remarks about it.
    until(&mut window, "a whole pass", |app| app.live().frame().is_some() && app.live().first_pass().is_none());
    window.state_mut().state_mut().compare.keep = true;
    window.run_steps(2);
    assert!(window.state().state().compare.b.is_some());
    window.get_by_role_and_label(Role::Button, "Copy link").click();
    assert_eq!(copied(&mut window).as_deref(), Some(text));
    window.run_steps(2);
    for name in ["room.glb does not travel", "sky.hdr does not travel"] {
        window.get_by_label_contains(name);
    }
    assert!(window.query_by_label_contains("Kept pictures").is_none());
}

#[test]
fn only_what_cannot_be_is_left_out_of_what_is_loaded() {
    let window = linked("#scene=spots&inside=attic&env=0.5,0.5,0.5&turn=20&k=3");
    let app = window.state();
    let chosen = app.live().opened().expect("a scene").environment.clone().expect("an environment");
    assert_eq!((chosen.source, chosen.rotation), (EnvironmentSource::Constant(bdpt_explorer::math::Vec3::splat(0.5)), 20.0));
    assert!(said(&window).contains("“inside” was left out") && !said(&window).contains("“env”"), "{}", said(&window));
    assert!(app.link().contains("&env=0.5,0.5,0.5&turn=20") && !app.link().contains("inside"), "{}", app.link());
}

#[test]
fn a_file_on_show_meanwhile_is_told_from_another_of_its_name() {
    use bdpt_explorer::scene::files::{File, Files};
    let given = |own: &str| {
        let bytes = builtin::list().iter().find(|x| x.name == own).expect("a built-in scene").bytes;
        let name = "meanwhile.glb";
        Opening { files: Some(Files::new(File::new(name, bytes.to_vec()), Vec::new())), ..Opening::of(name) }
    };
    for (next, waits) in [("spots", true), ("furnace", false)] {
        let mut window = cornell();
        window.state_mut().state_mut().open = Some(given("spots"));
        window.state_mut().open_link("#file=room.glb&n=5");
        until(&mut window, "the first file", |app| app.live().opened() == Some(&given("spots")));
        settle(&mut window);
        assert!(said(&window).contains("room.glb"), "it is still asked for: {}", said(&window));
        window.state_mut().state_mut().open = Some(given(next));
        until(&mut window, "the next file", |app| app.live().opened() == Some(&given(next)) && app.live().loading().is_none());
        settle(&mut window);
        assert_eq!(said(&window).contains("room.glb"), waits, "{next}: {}", said(&window));
    }
}

#[test]
fn panels_take_the_room_a_link_gives_them_in_a_window_of_any_size() {
    let mut window = cornell();
    let width = |window: &Harness<'static, App>| window.state().state().shares[0];
    assert_eq!(window.state().state().shares, [None; 3]);
    let link = format!("{}&inspector=400&pyramid=300", window.state().link());
    window.state_mut().open_link(&link);
    settle(&mut window);
    assert_eq!((width(&window), window.state().state().shares[1]), (Some(400), Some(300)));
    assert!(window.state().link().contains("&inspector=400&pyramid=300"), "{}", window.state().link());
    let left = |window: &Harness<'static, App>| window.get_by_role_and_label(Role::Button, "Splits").rect().left();
    let wide = left(&window);
    window.state_mut().open_link(&link.replace("&inspector=400&pyramid=300", ""));
    settle(&mut window);
    assert_eq!(width(&window), None);
    assert!(left(&window) > wide + 40.0, "{} {wide}", left(&window));
}
