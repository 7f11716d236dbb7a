//! Links by themselves: what is written is read, what is pinned stays, and no text does any harm.

mod dice;

use self::dice::{Dice, opening, random_state};
use super::words::{Codec, encode};
use super::*;
use crate::engine::{self, Job};
use crate::math::Vec3;
use crate::rng::Sampler;
use crate::scene::edit::MaterialEdit;
use crate::scene::environment::EnvironmentSource;
use crate::scene::{Scene, builtin, edit};
use crate::ui::preferences::Preferences;
use crate::ui::state::{ChosenEnvironment, Opening, State};
use eframe::egui::vec2;
use std::sync::Arc;

fn file(name: &str) -> Arc<Scene> {
    Arc::new(builtin::open(name).unwrap())
}

#[test]
fn random_states_travel_whole() {
    let mut dice = Dice(0);
    let scenes = ["cornell", "spots", "bokeh"].map(|name| (name, file(name)));
    for round in 0..300 {
        let (name, scene) = &scenes[round % 3];
        let state = random_state(&mut dice, scene);
        let opened = opening(&mut dice, name);
        let link = Link::of(&state, &opened);
        let text = link.to_text();
        assert!(text.len() < 4000 && text.bytes().all(|byte| byte.is_ascii_graphic()), "{text}");
        assert_eq!(Link::parse(&format!("https://example.org/x/{text}")), Ok((link.clone(), Vec::new())), "{text}");
        // Another person's window, in which everything is otherwise.
        let mut other = random_state(&mut dice, scene);
        other.prefs.lang = link.lang.unwrap();
        assert_ne!(Link::of(&other, &opened), link);
        assert_eq!(arrive(&link, &mut other, scene, false), [], "{text}");
        assert_eq!(Link::of(&other, &opened), link, "{text}");
    }
}

#[test]
fn what_travels_is_all_that_is_on_show_and_nothing_private() {
    let mut state = State::new(Preferences::default(), [512, 512]);
    assert_eq!(Link::of(&state, &Opening::of("cornell")).to_text(), format!("#v=1&est={RECORD_VERSION}&lang=en&scene=cornell"));
    let sky = EnvironmentSource::File("/home/anna/secret/sky.hdr".into());
    let opened =
        Opening { environment: Some(ChosenEnvironment { source: sky, rotation: 90.0 }), ..Opening::of("/home/anna/secret/room.glb") };
    (state.scene_field, state.environment_field) = ("/home/anna".to_owned(), "/home/anna".to_owned());
    state.prefs.recent.push("/home/anna/secret/room.glb".to_owned());
    (state.export.path, state.compare.field) = ("/home/anna/a.png".to_owned(), "/home/anna/b.exr".to_owned());
    let text = Link::of(&state, &opened).to_text();
    assert!(text.ends_with("&lang=en&file=room.glb&envfile=sky.hdr&turn=90"), "{text}");
    assert_eq!(of::file_name(r"C:\Users\anna\room.glb"), "room.glb");
    // Nor does a link that is received name a folder.
    for text in ["#file=/etc/passwd", "#file=..%2Fx.glb", r"#envfile=C:%5Cx.hdr"] {
        let (link, ignored) = Link::parse(text).unwrap();
        assert_eq!((link.scene, link.environment, ignored.len()), (Shared::Known("cornell".to_owned()), None, 1), "{text}");
    }
}

/// Links of version 1 that somebody may have kept.
const KEPT: [&str; 3] = [
    "#v=1&est=3&lang=zh&scene=spots&env=0.5,0.25,0.001&turn=-12.5&cam=1&pose=0,1,2.5,1,0,0,0,1,0,0,0,-1,0.7&lens=0.03,inf&size=640x360\
     &k=8&seed=7&sampler=sobol&weights=balance&beta=1.5&cutoff=0.2&roulette=off&fresh=off&light=4&use=pt,s2t1&hide=none,s1t2&px=256,300&n=3&strategy=s2t2\
     &vertex=3&ev=1.5&offset=-0.1&tone=aces&view=3,100,50.5&picture=s1t2.raw&other=image&compare=split&metric=relative&split=0.25\
     &flipped=on&draw=eye,splats&max=image&panels=inspector,camera&front=space&beside=pyramid&inspector=357&pyramid=200&space=400&tab=path\
     &sort=weight&walk=light&bars=density&whatif=power,3,0.1&cells=variance&why=on&gain=same&cell=100\
     &orbit=0.1,0.2,0.3,4,0.5,0.6,0.7&through=on&cull=off&follow=on&lobe=off&samples=64&which=role&length=3&sides=eye\
     &mat.2.color=1,0.5,0&mat.2.name=red%20wall&lamp.0.name=lamp&lamp.0.offset=0.1,0,-0.25&lamp.0.power=2&light.1.cone=10,20\
     &light.1.name=%E7%81%AF&sky.strength=2",
    "#v=1&est=3&lang=en&file=room.glb&inside=night&envfile=sky.hdr",
    "#v=1&est=3&lang=en&scene=cornell&hide=bits,AAB3",
];

#[test]
fn links_of_version_1_mean_what_they_meant() {
    for text in KEPT {
        let (link, ignored) = Link::parse(text).unwrap();
        assert_eq!(ignored, [], "{text}");
        if !text.contains("bits") {
            assert_eq!(link.to_text(), text);
        }
    }
    let (link, _) = Link::parse(KEPT[0]).unwrap();
    // Everything in it is said.
    for piece in pieces::TABLE.iter().filter(|piece| !["file", "envfile", "inside"].contains(&piece.key)) {
        assert!(KEPT[0].contains(&format!("{}=", piece.key)), "{} is not pinned", piece.key);
        assert!(piece.always || (piece.write)(&link) != (piece.write)(&Link::default()), "{}", piece.key);
    }
    assert_eq!((link.version, link.estimator, link.lang, &link.scene), (1, Some(3), Some(Lang::Zh), &Shared::Known("spots".to_owned())));
    assert_eq!((link.environment, link.turn, link.camera), (Some(Shared::Known([0.5, 0.25, 1e-3])), -12.5, 1));
    let pose = link.pose.unwrap();
    assert_eq!((pose.position, pose.right, pose.up), ([0.0, 1.0, 2.5], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]));
    assert_eq!((pose.axis, pose.yfov, link.size), ([0.0, 0.0, -1.0], 0.7, [640, 360]));
    assert_eq!(link.lens, Some(Lens { radius: 0.03, focus_distance: f32::INFINITY }));
    let Settings { max_edges, seed, sampler, heuristic, roulette, light_subpaths, strategies, fresh_ends } = link.settings;
    // What is older than the choice has independent numbers.
    let older = |text: &str| Link::parse(text).unwrap().0.settings.sampler;
    assert_eq!((sampler, older(KEPT[1])), (Sampler::Sobol, Sampler::Hash));
    assert_eq!((max_edges, seed, roulette, fresh_ends, heuristic.beta, heuristic.cutoff), (8, 7, false, false, 1.5, 0.2));
    assert_eq!((light_subpaths, Link::parse(KEPT[1]).unwrap().0.settings.light_subpaths), (4, 1));
    assert_eq!(heuristic.kind, crate::bdpt::HeuristicKind::Balance);
    assert!(
        strategies.contains(Strategy::new(2, 1)) && strategies.contains(Strategy::new(0, 5)) && !strategies.contains(Strategy::new(2, 2))
    );
    assert_eq!(link.hidden, StrategySet::where_(|x| x == Strategy::new(1, 2)));
    assert_eq!((link.pixel, link.sample, link.strategy, link.vertex), (Some([256, 300]), 3, Strategy::new(2, 2), 3));
    let picture = link.picture;
    assert_eq!((picture.exposure, picture.offset, picture.tonemap), (1.5, -0.1, ToneMap::Aces));
    assert_eq!(picture.placement, Placement::Free { zoom: 3.0, centre: vec2(100.0, 50.5) });
    assert_eq!((picture.source, picture.other), (Source::Strategy(Strategy::new(1, 2), Mode::Raw), Some(Source::Image)));
    assert_eq!((picture.compare, picture.metric, picture.split), (Some(CompareMode::Split), Metric::RelativeSquared, 0.25));
    assert_eq!((picture.flipped, picture.drawn), (true, [true, false, false, false, true, false, false]));
    let layout = link.layout;
    assert_eq!((layout.maximised, layout.beside, layout.space_in_front), (Maximised::Image, Maximised::Pyramid, true));
    assert_eq!(layout.panels, [true, false, false, true]);
    assert_eq!((layout.shares, layout.tab, layout.sort), ([Some(357), Some(200), Some(400)], Tab::Path, Sort::Weight));
    assert_eq!((layout.walk, layout.bars, layout.mode, layout.why), (Walk::Light, Bars::Density, Mode::Variance, true));
    assert_eq!((layout.what_if.unwrap().beta, layout.gain, layout.cell), (3.0, Gain::Same, 100.0));
    let orbit = link.space.orbit.unwrap();
    assert_eq!((orbit.pivot, orbit.distance, orbit.yaw), (Vec3::new(0.1, 0.2, 0.3), 4.0, 0.5));
    assert_eq!((orbit.pitch, orbit.yfov), (0.6, 0.7));
    let space = link.space;
    assert_eq!([space.through, space.cull, space.follow, space.lobe], [true, false, true, false]);
    assert_eq!((space.samples, space.which, space.length, space.sides), (64, Which::Role, Some(3), [false, true, false]));
    let edits = link.edits;
    assert_eq!((edits.materials[&2].name.as_str(), edits.materials[&2].color), ("red wall", Some([1.0, 0.5, 0.0])));
    assert_eq!((edits.lamps[&0].power, edits.lamps[&0].offset), (Some(2.0), Some([0.1, 0.0, -0.25])));
    assert_eq!((edits.lights[&1].name.as_str(), edits.lights[&1].cone, edits.environment.strength), ("灯", Some([10.0, 20.0]), Some(2.0)));
    let (link, _) = Link::parse(KEPT[2]).unwrap();
    assert_eq!((link.hidden.words()[0][0], link.lang), (1 << 12 | 0b110_111 << 18, Some(Lang::En)));
}

/// What was ignored, as pairs.
fn ignored(text: &str, scene: &Arc<Scene>) -> Vec<(String, Why)> {
    let (link, mut ignored) = Link::parse(text).unwrap();
    let mut state = State::new(Preferences::default(), [512, 512]);
    ignored.extend(arrive(&link, &mut state, scene, false));
    ignored.into_iter().map(|ignored| (ignored.piece, ignored.why)).collect()
}

#[test]
fn absurd_pieces_are_named_and_the_rest_is_followed() {
    let cornell = file("cornell");
    let instead = |value: &str| Why::Instead(value.to_owned());
    let cases = [
        ("size=32x32&k=1000", vec![("k=1000", instead("64"))]),
        ("size=1000000000x5", vec![("size=1000000000x5", instead("8192x5"))]),
        ("beta=nan&seed=-1&n=1e39", vec![("beta=nan", Why::Unreadable), ("seed=-1", instead("0")), ("n=1e39", instead("4294967295"))]),
        ("ev=inf", vec![("ev=inf", instead("20"))]),
        ("px=600,900", vec![("px=600,900", instead("511,511"))]),
        ("strategy=s7t9", vec![("strategy=s7t9", instead("s1t6"))]),
        ("strategy=s1t2&vertex=64", vec![("vertex=64", instead("2"))]),
        ("k=1", vec![]),
        ("foo=bar&k", vec![("foo=bar", Why::Unknown), ("k", Why::Unreadable)]),
        ("k=3&k=4", vec![("k=4", Why::Twice)]),
        ("scene=%ff", vec![("scene=%ff", Why::Unreadable)]),
        ("v=2", vec![("v=2", Why::Newer)]),
        ("est=2", vec![("est=2", Why::OtherPaths)]),
        ("mat.0.name=nobody&mat.0.color=1,1,1", vec![("nobody", Why::NoPlace)]),
        ("sky.strength=2", vec![("sky", Why::NoPlace)]),
        ("", vec![]),
        ("&&&", vec![]),
    ];
    for (text, expected) in cases {
        let expected: Vec<(String, Why)> = expected.into_iter().map(|(piece, why)| (piece.to_owned(), why)).collect();
        assert_eq!(ignored(&format!("#v=1&{text}").replace("#v=1&v=2", "#v=2"), &cornell), expected, "{text}");
    }
    // What only the scene knows; the reason is its own.
    for (text, piece) in [
        ("cam=5", "cam=5"),
        ("lens=1e30,1", "lens=1e30,1"),
        ("lens=0.01,0", "lens=0.01,0"),
        ("size=8192x8192", "size=8192x8192"),
        ("size=2000x2000&k=64", "k=64"),
        ("pose=0,0,0,1,1,1,1,1,1,1,1,1,1", "pose=0,0,0,1,1,1,1,1,1,1,1,1,1"),
        ("pose=1e300,0,0,1,0,0,0,1,0,0,0,-1,1", "pose=1e300,0,0,1,0,0,0,1,0,0,0,-1,1"),
    ] {
        let found = ignored(&format!("#v=1&{text}"), &cornell);
        assert!(matches!(found.as_slice(), [(name, Why::Refused(_))] if name == piece), "{text}: {found:?}");
    }
    // One change that cannot be does not cost the others.
    let (name, lamp) = (encode(&cornell.material_names[0]), encode(&cornell.lamps()[0].name));
    let text = format!("#mat.0.name={name}&mat.0.roughness=7&lamp.0.name={lamp}&lamp.0.power=2");
    assert!(matches!(ignored(&text, &cornell).as_slice(), [(name, Why::Refused(_))] if name == "mat.0"));
    let mut state = State::new(Preferences::default(), [512, 512]);
    arrive(&Link::parse(&text).unwrap().0, &mut state, &cornell, false);
    assert_eq!((state.edit.edits.materials.len(), state.edit.edits.lamps[&0].power), (0, Some(2.0)));
}

#[test]
fn a_link_that_is_too_long_is_not_read() {
    let long = format!("#v=1&{}", "a".repeat(MOST_BYTES));
    assert_eq!(Link::parse(&long), Err(MOST_BYTES + 5));
    assert!(Link::parse(&long[..MOST_BYTES]).is_ok());
    // Nor is one written: the changes of the scene stay behind.
    let mut link = Link::default();
    let edit = MaterialEdit { name: "x".repeat(40), color: Some([0.5; 3]), ..MaterialEdit::default() };
    link.edits.materials.insert(0, edit.clone());
    assert_eq!(copy::bounded(&link), (link.to_text(), false));
    link.edits.materials.extend((1..300).map(|index| (index, edit.clone())));
    assert_eq!(copy::bounded(&link), (Link::default().to_text(), true));
}

/// Links that are nearly right: letters changed, pieces moved, doubled and cut.
fn mutated(dice: &mut Dice, text: &str) -> String {
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..=dice.below(6) {
        let (at, other) = (dice.below(bytes.len()), dice.below(bytes.len()));
        match dice.below(5) {
            0 => bytes[at] = dice.below(256) as u8,
            1 => bytes[at] = dice.of(b"0123456789-.,=&%#einfa"),
            2 => bytes.truncate(at.max(1)),
            3 => drop(bytes.splice(at..at, dice.of(&["1e39", "nan", "-", "999999999999", "inf", "%", "&k=", ",,"]).bytes())),
            _ => {
                let piece = bytes[at.min(other)..at.max(other)].to_vec();
                bytes.extend(piece);
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[test]
fn no_text_does_any_harm_and_what_comes_of_it_can_be_rendered() {
    let mut dice = Dice(77);
    let scenes = ["cornell", "spots"].map(file);
    let (mut followed, mut whole) = (0, 0);
    for round in 0..1200 {
        let scene = &scenes[round % 2];
        let text = match round % 3 {
            0 => {
                let bytes: Vec<u8> = (0..dice.below(300)).map(|_| dice.below(256) as u8).collect();
                String::from_utf8_lossy(&bytes).into_owned()
            }
            1 => mutated(&mut dice, KEPT[0]),
            _ => {
                let text = Link::of(&random_state(&mut dice, scene), &Opening::of("cornell")).to_text();
                mutated(&mut dice, &text)
            }
        };
        let Ok((link, mut ignored)) = Link::parse(&text) else { continue };
        let mut state = random_state(&mut dice, scene);
        ignored.extend(arrive(&link, &mut state, scene, false));
        let sentence = super::ignored::sentence(&ignored, Lang::En);
        assert_eq!(sentence.is_some(), !ignored.is_empty());
        assert!(sentence.is_none_or(|text| text.len() < 12_000));
        let edited = Arc::new(edit::apply(scene, &state.edit.edits).expect("edits that can be made"));
        let State { camera, pose, lens, size, settings, selection, .. } = state;
        let job = Job { camera, pose, lens, size, settings, weighted_layers: true, ..Job::new(edited) };
        assert_eq!(job.check(), Ok(()), "{text}");
        assert!(selection.pixel[0] < size[0] && selection.pixel[1] < size[1]);
        assert!(engine::record(&job, selection.pixel, selection.sample).is_ok(), "{text}");
        let again = Link::of(&state, &Opening::of("cornell"));
        assert_eq!(Link::parse(&again.to_text()), Ok((again.clone(), Vec::new())), "{text}");
        followed += 1;
        whole += usize::from(ignored.is_empty());
    }
    assert!(followed > 1000 && whole > 20, "{followed} {whole}");
}

#[test]
fn every_piece_has_a_name_of_its_own() {
    let mut keys: Vec<&str> = pieces::TABLE.iter().map(|piece| piece.key).collect();
    let count = keys.len();
    keys.sort_unstable();
    keys.dedup();
    assert_eq!(keys.len(), count);
    assert!(keys.iter().all(|key| !edits::is_one(key) && encode(key) == *key));
    assert_eq!(words::SWITCH.write(&true), "on");
}

#[test]
fn a_smaller_film_shows_the_same_view() {
    let text = "#v=1&scene=spots&size=641x360&px=640,90&view=3,100,50&n=7";
    let half = Link::parse(text).unwrap().0.halved();
    assert_eq!((half.size, half.pixel, half.sample), ([320, 180], Some([319, 45]), 7));
    let Placement::Free { zoom, centre } = half.picture.placement else { panic!("it was moved") };
    let scale = 320.0 / 641.0;
    assert!((zoom - 3.0 / scale).abs() < 1e-4 && (centre - vec2(100.0 * scale, 25.0)).length() < 1e-3, "{zoom} {centre}");
    // All else is as it was, and what says nothing of the film says nothing of half of it.
    let back = Link { size: [641, 360], pixel: Some([640, 90]), picture: Link::parse(text).unwrap().0.picture, ..half };
    assert_eq!(back, Link::parse(text).unwrap().0);
    let least = Link::parse("#size=1x2&px=0,1").unwrap().0.halved();
    assert_eq!((least.size, least.pixel, least.picture.placement), ([1, 1], Some([0, 0]), Placement::Fit));
    assert_eq!(Link::default().halved(), Link { size: [256, 256], ..Link::default() });
}

/// `cargo test --lib measure_the_text -- --ignored --nocapture`: what a page does twice in a second.
#[test]
#[ignore = "it measures"]
fn measure_the_text_of_a_link() {
    let mut dice = Dice(5);
    let scene = file("cornell");
    let chosen: Vec<Link> = (0..20).map(|_| Link::of(&random_state(&mut dice, &scene), &Opening::of("cornell"))).collect();
    for (name, links) in [("first start", vec![Link::default()]), ("anything", chosen)] {
        let start = std::time::Instant::now();
        let letters: usize = (0..20).map(|_| links.iter().map(|link| link.to_text().len()).sum::<usize>()).sum();
        let each = start.elapsed().as_secs_f64() * 1e6 / (20 * links.len()) as f64;
        println!("{name}: {each:.0} µs a text of {} letters", letters / (20 * links.len()));
    }
}
