//! Many machines: films of ranges of seeds, and what they are together.

use super::{channels, program, run, skip, stdout, succeed};
use exr::prelude::{AttributeValue, MetaData, Text};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

/// A pair of f32 holds a sum to 2⁻⁴⁹ of it.
const PAIR: f64 = 1.0 / (1u64 << 49) as f64;
const SMALL: &str = "--size 40x30 --spp 4 --max-edges 4";

/// The sums of a film: hi + lo, of R, then G, then B.
fn sums(path: &Path) -> Vec<f64> {
    let (_, channels) = channels(path);
    let letters = ["R", "G", "B"].into_iter();
    let pairs = letters.flat_map(|letter| channels[&format!("sum.hi.{letter}")].iter().zip(&channels[&format!("sum.lo.{letter}")]));
    pairs.map(|(hi, lo)| f64::from(*hi) + f64::from(*lo)).collect()
}

/// What its header says.
fn label(path: &Path) -> serde_json::Value {
    let meta = MetaData::read_from_file(path, false).unwrap();
    match meta.headers[0].own_attributes.other.get(&Text::from("bdpt-explorer")) {
        Some(AttributeValue::Text(text)) => serde_json::from_slice(text.as_slice()).unwrap(),
        other => unreachable!("{other:?}"),
    }
}

/// The largest difference of two films' sums, in parts of the sum.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert!(a.len() == b.len() && a.iter().any(|x| *x > 0.0));
    a.iter().zip(b).map(|(a, b)| (a - b).abs() / a.abs().max(f64::MIN_POSITIVE)).fold(0.0, f64::max)
}

#[test]
fn parts_are_together_what_one_machine_renders_whatever_their_order() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let read = |name: &str| std::fs::read(path(name)).unwrap();
    for (name, seeds) in [("all", "0..6"), ("a", "0..2"), ("b", "2..3"), ("c", "3..6")] {
        succeed(folder.path(), &format!("render cornell-spheres -o {name}.exr --seed-range {seeds} {SMALL}"));
    }
    let said = stdout(&succeed(folder.path(), "merge a.exr b.exr c.exr -o abc.exr"));
    assert!(said.contains("cornell-spheres: 40×30 · 24 spp of the seeds 0..6 in 3 films") && said.contains("wrote abc.exr"), "{said}");
    succeed(folder.path(), "merge c.exr a.exr b.exr -o cab.exr");
    assert!(read("abc.exr") == read("cab.exr"), "the order changes nothing");
    // In two steps, either way: what was merged can be merged again, also into one of the films.
    succeed(folder.path(), "merge a.exr b.exr -o ab.exr");
    succeed(folder.path(), "merge c.exr ab.exr -o ab_c.exr");
    succeed(folder.path(), "merge b.exr c.exr -o c.exr");
    succeed(folder.path(), "merge a.exr c.exr -o a_bc.exr");
    let all = sums(&path("all.exr"));
    // Every file has rounded its sums to pairs: one machine's, the parts, what was merged, and again.
    for (name, roundings) in [("abc.exr", 3.0), ("ab_c.exr", 4.0), ("a_bc.exr", 4.0)] {
        let off = difference(&all, &sums(&path(name)));
        assert!(off <= roundings * PAIR, "{name}: {}", off / PAIR);
        assert_eq!(label(&path(name)), label(&path("all.exr")));
        let ((_, one), (_, merged)) = (channels(&path("all.exr")), channels(&path(name)));
        for letter in ["R", "G", "B"] {
            let close = |(a, b): (&f32, &f32)| (a - b).abs() <= f32::EPSILON * a;
            assert!(one[letter].iter().zip(&merged[letter]).all(close), "{name} {letter}");
        }
    }
    // The controls: without a part it is another film, and a single f32 would not do.
    assert!(difference(&all, &sums(&path("ab.exr"))) > 0.01);
    assert_ne!(label(&path("ab.exr")), label(&path("all.exr")));
    let single: Vec<f64> = all.iter().map(|sum| f64::from(*sum as f32)).collect();
    assert!(difference(&all, &single) > 1e6 * PAIR);
}

#[test]
fn a_film_shows_its_mean_and_says_what_it_is_of() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    succeed(folder.path(), &format!("render cornell -o film.exr --seed-range 7..8 {SMALL} --pyramid p --stats s.json"));
    succeed(folder.path(), &format!("render cornell -o plain.exr --seed 7 {SMALL}"));
    let ((size, film), (_, plain)) = (channels(&path("film.exr")), channels(&path("plain.exr")));
    assert_eq!((size, film.len(), plain.len()), ((40, 30), 9, 3));
    for (c, letter) in ["R", "G", "B"].into_iter().enumerate() {
        let sums = &sums(&path("film.exr"))[c * 1200..][..1200];
        for ((mean, plain), sum) in film[letter].iter().zip(&plain[letter]).zip(sums) {
            assert!((mean - plain).abs() <= 2.0 * f32::EPSILON * plain && *mean == (sum / 4.0) as f32, "{mean} {plain} {sum}");
        }
    }
    let said = label(&path("film.exr"));
    assert_eq!(
        (&said["format"], &said["samples"], &said["seeds"], &said["scene"]),
        (&1.into(), &4.into(), &"7..8:4".into(), &"cornell".into())
    );
    let keys: Vec<&str> = said["settings"].as_object().unwrap().keys().map(String::as_str).collect();
    let expected = "beta crop estimator fresh-ends heuristic integrator lens light-subpaths max-edges roulette sampler scene.cameras scene.lights scene.materials scene.shapes scene.textures shown size strategies";
    assert_eq!(keys.join(" "), expected);
    // All seeds are in the other files, too.
    succeed(folder.path(), &format!("render cornell -o film.png --seed-range 7..9 {SMALL} --pyramid p --stats s.json"));
    let stats: serde_json::Value = serde_json::from_slice(&std::fs::read(path("s.json")).unwrap()).unwrap();
    assert_eq!((stats["spp"].as_f64(), stats["pairs"].as_u64()), (Some(8.0), Some(9600)));
}

#[test]
fn every_sample_counts_the_same_however_they_are_divided() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let brightness = |name: &str| {
        let sum: f64 = channels(&path(name)).1["R"].iter().map(|x| f64::from(*x)).sum();
        sum / (24.0 * 24.0)
    };
    // The closed room: 0.25 (1 − 0.5⁶)/(1 − 0.5).
    let exact = 0.492_187_5;
    for (name, seeds, spp) in [("one", "0..1", 64), ("many", "100..164", 1), ("few", "200..204", 16), ("thin", "300..301", 1)] {
        succeed(folder.path(), &format!("render furnace -o {name}.exr --size 24x24 --seed-range {seeds} --spp {spp}"));
    }
    // Three standard deviations of such a picture's mean (measured over 24 films: 0.00103).
    for name in ["one.exr", "many.exr", "few.exr"] {
        assert!((brightness(name) - exact).abs() < 0.0031, "{name}: {}", brightness(name));
    }
    // Films of 64 samples and of one: the mean is that of the samples, not of the films.
    let output = succeed(folder.path(), "merge one.exr thin.exr -o both.exr");
    assert!(String::from_utf8_lossy(&output.stderr).contains("the seeds have different numbers of samples"));
    let weighted = (64.0 * brightness("one.exr") + brightness("thin.exr")) / 65.0;
    assert!((brightness("both.exr") - weighted).abs() < 1e-6, "{} {weighted}", brightness("both.exr"));
    let unweighted = 0.5 * (brightness("one.exr") + brightness("thin.exr"));
    assert!((brightness("both.exr") - unweighted).abs() > 1e-5, "the control passes");
    // What is missing between them is told.
    assert!(String::from_utf8_lossy(&output.stderr).contains("the seeds 1..300 between them are in no film"));
}

#[test]
fn a_part_of_the_picture_and_of_the_strategies_can_be_merged() {
    let folder = tempfile::tempdir().unwrap();
    let options = "--size 40x30 --max-edges 3 --spp 2 --crop 5,6,20,10 --strategies s1t2,s2t1 --strategies-mode hide";
    for (name, seeds) in [("all", "0..2"), ("a", "0..1"), ("b", "1..2")] {
        succeed(folder.path(), &format!("render cornell -o {name}.exr --seed-range {seeds} {options}"));
    }
    succeed(folder.path(), "merge a.exr b.exr -o m.exr");
    let path = |name: &str| folder.path().join(name);
    assert_eq!(channels(&path("m.exr")).0, (20, 10));
    assert!(difference(&sums(&path("all.exr")), &sums(&path("m.exr"))) <= 3.0 * PAIR);
    let settings = &label(&path("m.exr"))["settings"];
    assert_eq!((&settings["shown"], &settings["crop"], &settings["strategies"]), (&"s1t2,s2t1".into(), &"5,6,20,10".into(), &"all".into()));
    succeed(folder.path(), "merge a.exr b.exr -o m.png --exposure 1 --tonemap aces");
    let png = image::open(path("m.png")).unwrap().to_rgb8();
    assert!(png.dimensions() == (20, 10) && png.pixels().any(|pixel| pixel.0[0] > 50));
}

#[test]
fn the_gpu_goes_through_the_same_seeds() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    for (name, seeds, backend) in [("gpu", "3..5", "gpu"), ("cpu", "3..5", "cpu"), ("less", "3..4", "cpu")] {
        let line = format!("render cornell -o {name}.exr --seed-range {seeds} {SMALL} --backend {backend} --stats {name}.json");
        succeed(folder.path(), &line);
    }
    let stats: serde_json::Value = serde_json::from_slice(&std::fs::read(path("gpu.json")).unwrap()).unwrap();
    if stats["backend"] == "cpu" {
        assert!(!skip::required("BDPT_REQUIRE_GPU"), "{}", stats["fallback"]);
        return skip::skipped("the_gpu_goes_through_the_same_seeds", stats["fallback"].as_str().unwrap_or(""));
    }
    let (gpu, cpu, less) = (sums(&path("gpu.exr")), sums(&path("cpu.exr")), sums(&path("less.exr")));
    let same = |other: &[f64]| gpu.iter().zip(other).filter(|(a, b)| (*a - *b).abs() <= 1e-4 * b.abs()).count() as f64;
    // A quarter of the pixels is black, or has no light of the second seed.
    assert!(same(&cpu) > 0.99 * gpu.len() as f64 && same(&less) < 0.5 * gpu.len() as f64, "{} {}", same(&cpu), same(&less));
    assert_eq!(label(&path("gpu.exr")), label(&path("cpu.exr")));
}

#[test]
fn what_does_not_belong_together_is_refused_in_one_line_that_names_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let base = "--size 16x12 --spp 1 --max-edges 3";
    succeed(folder.path(), &format!("render cornell -o a.exr --seed-range 0..2 {base}"));
    let (same, seeds) = (("", ""), "--seed-range 7..8");
    let others = [
        ("cornell", same, "--seed-range 1..3", "'a.exr' and 'b.exr' both hold samples of the seeds 1..2"),
        ("furnace", same, seeds, "'a.exr' (cornell) and 'b.exr' (furnace) show different scenes: the cameras differ"),
        ("cornell", same, "--environment 1,1,1", "show different scenes: the lights differ"),
        ("cornell", same, "--lens-radius 0.02 --focus-distance 1", "lens is pinhole in the first, 0.02 m, focus 1.0 m in the second"),
        ("cornell", ("16x12", "16x13"), seeds, "size is 16x12 in the first, 16x13 in the second"),
        ("cornell", same, "--crop 1,2,3,4", "crop is none in the first, 1,2,3,4 in the second"),
        ("cornell", ("edges 3", "edges 4"), seeds, "max-edges is 3 in the first, 4 in the second"),
        ("cornell", same, "--heuristic balance", "heuristic is power in the first, balance in the second"),
        ("cornell", same, "--beta 1.5", "beta is 2.0 in the first, 1.5 in the second"),
        ("cornell", same, "--sampler sobol", "sampler is hash in the first, sobol in the second"),
        ("cornell", same, "--roulette off", "roulette is on in the first, off in the second"),
        ("cornell", same, "--integrator pt", "integrator is bdpt in the first, pt in the second"),
        ("cornell", same, "--strategies s1t2,s0t2", "strategies is all in the first, s0t2,s1t2 in the second"),
        ("cornell", same, "--strategies s1t2 --strategies-mode hide", "shown is all in the first, s1t2 in the second"),
    ];
    for (scene, (from, to), options, expected) in others {
        let seeds = if options.contains("--seed-range") { "" } else { seeds };
        let base = if from.is_empty() { base.to_owned() } else { base.replace(from, to) };
        succeed(folder.path(), &format!("render {scene} -o b.exr {base} {seeds} {options}"));
        refused(folder.path(), "merge a.exr b.exr -o c.exr", expected);
    }
    // The third of three, and one twice.
    succeed(folder.path(), &format!("render cornell -o b.exr --seed-range 2..3 {base}"));
    succeed(folder.path(), &format!("render cornell -o d.exr --seed-range 0..1 {base}"));
    refused(folder.path(), "merge a.exr b.exr d.exr -o c.exr", "'a.exr' and 'd.exr' both hold samples of the seeds 0..1");
    refused(folder.path(), "merge a.exr ./a.exr -o c.exr", "'a.exr' and './a.exr' both hold samples of the seeds 0..2");
    // What is no film.
    succeed(folder.path(), &format!("render cornell -o plain.exr {base}"));
    refused(folder.path(), "merge a.exr plain.exr -o c.exr", "'plain.exr' holds no sums; give an .exr that `render --seed-range` or");
    std::fs::write(path("text.exr"), "hello").unwrap();
    refused(folder.path(), "merge a.exr text.exr -o c.exr", "'text.exr' is no .exr file");
    let bytes = std::fs::read(path("a.exr")).unwrap();
    std::fs::write(path("cut.exr"), &bytes[..bytes.len() / 2]).unwrap();
    refused(folder.path(), "merge b.exr cut.exr -o c.exr", "'cut.exr' cannot be decoded");
    refused(folder.path(), "merge a.exr none.exr -o c.exr", "'none.exr' is not there");
    refused(folder.path(), "merge a.exr . -o c.exr", "'.' is a folder");
    refused(folder.path(), "merge a.exr b.exr -o no/c.exr", "there is no folder 'no'");
}

/// Runs, and expects one line and no file c.exr.
fn refused(folder: &Path, line: &str, expected: &str) {
    let output = run(folder, line);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code() == Some(2) && said.starts_with("error: ") && said.contains(expected), "{line}: {said}");
    assert!(said.matches('\n').count() == 1 && !said.contains("panicked") && output.stdout.is_empty(), "{line}: {said}");
    assert!(!folder.join("c.exr").exists());
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_what_is_done_and_claims_no_more() {
    let folder = tempfile::tempdir().unwrap();
    // One seed that is not done, and many of which some are.
    for (seeds, spp, name) in [("5..7", 100_000_000, "long"), ("5..4000000", 64, "many")] {
        let line = format!("render cornell -o {name}.exr --size 32x24 --seed-range {seeds} --spp {spp} --backend cpu");
        let child = program(folder.path()).args(line.split(' ')).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        std::thread::sleep(Duration::from_secs(2));
        assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
        let output = child.wait_with_output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        let path = folder.path().join(format!("{name}.exr"));
        let label = label(&path);
        let runs = label["seeds"].as_str().unwrap();
        assert!(output.status.success() && said.contains(&format!("samples per pixel that are done: {runs}")), "{said}");
        // Those very samples again are that very film.
        let (mut parts, mut samples) = (Vec::new(), 0);
        for (i, run) in runs.split(' ').enumerate() {
            let (seeds, spp) = run.split_once(':').unwrap();
            succeed(folder.path(), &format!("render cornell -o part{i}.exr --size 32x24 --seed-range {seeds} --spp {spp}"));
            let (start, end) = seeds.split_once("..").unwrap();
            samples += (end.parse::<u64>().unwrap() - start.parse::<u64>().unwrap()) * spp.parse::<u64>().unwrap();
            parts.push(format!("part{i}.exr"));
        }
        assert!(parts.len() <= 2 && (name == "many" || parts.len() == 1), "{runs}");
        succeed(folder.path(), &format!("merge {} -o again.exr", parts.join(" ")));
        let again = folder.path().join("again.exr");
        assert!(difference(&sums(&path), &sums(&again)) <= 3.0 * PAIR, "{runs}");
        assert_eq!((&self::label(&again), label["samples"].as_u64()), (&label, Some(samples)));
    }
}
