//! The program as a user meets it: the real binary, its files, its exit status, its one-line errors.

#![allow(clippy::unwrap_used)]

#[path = "cli/merge.rs"]
mod merge;
#[path = "cli/no_window.rs"]
mod no_window;
#[path = "common/skip.rs"]
mod skip;
#[path = "cli/suggest.rs"]
mod suggest;

use exr::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};
use std::time::{Duration, Instant};

/// The program, to be run in `folder`, where there is no display.
fn program(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bdpt-explorer"));
    command.current_dir(folder).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    command
}

/// Runs a line; whatever it does not say about it, on the CPU, which is the same everywhere.
fn run(folder: &Path, line: &str) -> Output {
    let cpu: &[&str] = if line.starts_with("render") && !line.contains("--backend") { &["--backend", "cpu"] } else { &[] };
    program(folder).args(line.split_whitespace()).args(cpu).output().unwrap()
}

/// Runs and expects success.
fn succeed(folder: &Path, line: &str) -> Output {
    let output = run(folder, line);
    assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
    output
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// An EXR's channels by name, with its size.
fn channels(path: &Path) -> ((usize, usize), BTreeMap<String, Vec<f32>>) {
    let reader = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes();
    let layer = reader.from_file(path).unwrap().layer_data;
    let list = layer.channel_data.list.into_iter();
    ((layer.size.0, layer.size.1), list.map(|channel| (channel.name.to_string(), channel.sample_data.values_as_f32().collect())).collect())
}

#[test]
fn bad_input_is_one_line_and_status_2_and_leaves_nothing() {
    let cases = [
        ("inspect cornell --pixel 512,0", "512x512"),
        ("inspect cornell --pixel 0,512", "512x512"),
        ("inspect cornell --pixel -1,0", "--pixel"),
        ("inspect cornell --pixel 1", "--pixel"),
        ("inspect cornell", "--pixel"),
        ("inspect cornell --pixel 1,1 --sample -1", "--sample"),
        ("inspect cornell --pixel 1,1 --sample 4294967296", "--sample"),
        ("cornell --link #v=1", "--link"),
        ("--link #v=1 render cornell -o a.exr", "--link opens the window"),
        ("--link #file=room.glb", "it shows room.glb, a file"),
        ("--link #envfile=sky.hdr", "it needs sky.hdr, a file"),
        ("--link #scene=nowhere", "'nowhere'"),
        ("render cornell -o a.exr --spp 0", "--spp"),
        ("render cornell -o a.png --stats ./a.png", "two outputs"),
        ("render cornell -o ./pyramid.exr --pyramid .", "two outputs"),
        ("render ./ -o a.exr", "folder"),
        ("render cornell -o a.exr --spp 1.5", "--spp"),
        ("render cornell -o a.exr --spp 1 --time 1", "--time"),
        ("render cornell -o a.exr --time 0", "--time"),
        ("render cornell -o a.exr --time NaN", "--time"),
        ("render cornell -o a.exr --time inf", "--time"),
        ("render cornell -o a.exr --time -3", "--time"),
        ("render cornell -o a.exr --seed-range 4..4", "give first..end, such as 0..4"),
        ("render cornell -o a.exr --seed-range 0..4 --seed 1", "--seed"),
        ("render cornell -o a.exr --seed-range 0..4 --time 1", "--time"),
        ("render cornell -o a.exr --seed-range 0..70000 --spp 70000", "divide the range and `merge` the films"),
        ("merge a.exr", "--output"),
        ("merge -o a.exr", "<FILE>"),
        ("merge none.exr -o a.jpg", ".exr"),
        ("render cornell -o a.exr --max-edges 0", "--max-edges"),
        ("render cornell -o a.exr --max-edges 100000", "--max-edges"),
        ("render cornell -o a.exr --size 0x0", "--size"),
        ("render cornell -o a.exr --size 512", "--size"),
        ("render cornell -o a.exr --size 100000x100000", "100000x100000"),
        ("render cornell -o a.exr --size 99999999999x1", "--size"),
        ("render cornell -o a.exr --size 32768x32768", "budget"),
        ("render cornell -o a.exr --crop 0,0,0,5", "--crop"),
        ("render cornell -o a.exr --crop 500,0,20,20", "crop 500,0,20,20"),
        ("render cornell -o a.exr --crop 4294967295,0,4294967295,1", "crop"),
        ("render cornell -o a.exr --crop 1,2,3", "--crop"),
        ("render cornell -o a.exr --strategies s1t1,nonsense", "nonsense"),
        ("render cornell -o a.exr --strategies s9t9", "s9t9"),
        ("render cornell -o a.exr --strategies s65t65", "s65t65"),
        ("render cornell -o a.exr --strategies s2t0", "s2t0 makes no path in cornell: a pinhole has no area"),
        ("render cornell -o a.exr --lens-radius -1", "--lens-radius"),
        ("render cornell -o a.exr --lens-radius wide", "give a radius in metres"),
        ("render cornell -o a.exr --lens-radius inf", "--lens-radius"),
        ("render cornell -o a.exr --lens-radius 1e6", "the lens radius 1000000.0 m must be 0 (a pinhole) to"),
        ("render cornell -o a.exr --lens-radius 0.1 --focus-distance 0", "--focus-distance"),
        ("render cornell -o a.exr --focus-distance -2", "give a distance in metres above 0, or inf"),
        ("inspect cornell --pixel 1,1 --focus-distance NaN", "--focus-distance"),
        ("render cornell -o a.exr --environment none.hdr", "none.hdr: there is no such file"),
        ("render cornell -o a.exr --environment .", "this is a folder"),
        ("render cornell -o a.exr --environment /dev/zero", "/dev/zero: "),
        ("render cornell -o a.exr --environment 1,2", "give one number, or three as R,G,B"),
        ("render cornell -o a.exr --environment -1,0,0", "--environment"),
        ("render cornell -o a.exr --environment NaN", "--environment"),
        ("render cornell -o a.exr --environment 1,inf,1", "--environment"),
        ("render cornell -o a.exr --environment-rotation 90", "cornell: it has no environment that could be turned"),
        ("render cornell -o a.exr --environment 1 --environment-rotation east", "--environment-rotation"),
        ("render cornell -o a.exr --strategies s2t2 --integrator pt", "--integrator pt"),
        ("render cornell -o a.exr --strategies-mode blur", "--strategies-mode"),
        ("render cornell -o a.exr --beta NaN", "--beta"),
        ("render cornell -o a.exr --beta -1", "--beta"),
        ("render cornell -o a.exr --beta inf", "--beta"),
        ("render cornell -o a.exr --beta 1e6", "--beta"),
        ("render cornell -o a.exr --cutoff 1.5", "--cutoff"),
        ("render cornell -o a.exr --exposure nan", "--exposure"),
        ("render cornell -o a.exr --tonemap sepia", "--tonemap"),
        ("render cornell -o a.exr --heuristic best", "--heuristic"),
        ("render cornell -o a.exr --seed -1", "--seed"),
        ("render cornell -o a.exr --sampler halton", "--sampler"),
        ("render cornell -o a.exr --camera nobody", "'nobody'"),
        ("render cornell -o a.exr --scene nothing", "the scene 'nothing' is not in it; it has '0'"),
        ("render cornell -o a.exr --backend abacus", "--backend"),
        ("render cornell -o a.jpg", ".exr"),
        ("render cornell -o no/such/folder/a.exr", "no/such/folder"),
        ("render cornell -o a.exr --stats no/stats.json", "no/stats.json"),
        ("render cornell", "--output"),
        ("render", "<SCENE>"),
        ("render nowhere.glb -o a.exr", "nowhere.glb"),
        ("nowhere.glb", "nowhere.glb"),
        ("cornell render cornell -o a.exr", "'cornell'"),
        ("--no-such-option", "--no-such-option"),
    ];
    let folder = tempfile::tempdir().unwrap();
    for (line, expected) in cases {
        let output = run(folder.path(), line);
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{line}: {stderr}");
        assert!(stderr.starts_with("error: ") && stderr.contains(expected), "{line}: {stderr}");
        assert_eq!(stderr.matches('\n').count(), 1, "{line}: {stderr}");
        assert!(!stderr.contains("panicked") && output.stdout.is_empty(), "{line}: {stderr}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "{line}");
    }
}

#[test]
fn help_and_version_are_no_errors() {
    let folder = tempfile::tempdir().unwrap();
    for line in ["--help", "--version", "render --help", "merge --help", "inspect -h", "help render"] {
        let output = succeed(folder.path(), line);
        assert!(!output.stdout.is_empty() && output.stderr.is_empty(), "{line}");
    }
    let scenes = stdout(&succeed(folder.path(), "scenes"));
    assert!(scenes.contains("cornell") && scenes.contains("triangles"), "{scenes}");
}

#[test]
fn the_weighted_layers_add_up_to_the_image() {
    let folder = tempfile::tempdir().unwrap();
    succeed(folder.path(), "render cornell -o a.exr --size 40x30 --spp 4 --max-edges 4 --pyramid p --stats s.json");
    let (size, image) = channels(&folder.path().join("a.exr"));
    assert_eq!(size, (40, 30));
    assert_eq!(image.keys().collect::<Vec<_>>(), ["B", "G", "R"]);
    let (_, layers) = channels(&folder.path().join("p/pyramid.exr"));
    assert_eq!(layers.len(), 2 * 3 * (4 * 7 / 2));
    assert!(layers.contains_key("raw.s2t1.R") && layers.contains_key("weighted.s0t2.B"));
    for letter in ["R", "G", "B"] {
        let largest = image[letter].iter().copied().fold(0.0, f32::max);
        assert!(largest > 0.0);
        let weighted: Vec<_> = layers.iter().filter(|(name, _)| name.starts_with("weighted.") && name.ends_with(letter)).collect();
        for (i, &pixel) in image[letter].iter().enumerate() {
            let sum: f32 = weighted.iter().map(|(_, layer)| layer[i]).sum();
            assert!((sum - pixel).abs() <= 1e-5 * largest, "{letter} {i}: {sum} {pixel}");
        }
    }
    let sheet = std::fs::read(folder.path().join("p/contact-sheet.png")).unwrap();
    assert!(image::load_from_memory(&sheet).unwrap().width() > 600);
}

#[test]
fn stats_have_the_agreed_keys() {
    let folder = tempfile::tempdir().unwrap();
    succeed(folder.path(), "render cornell --size 16x16 --spp 3 --stats s.json");
    let stats: serde_json::Value = serde_json::from_slice(&std::fs::read(folder.path().join("s.json")).unwrap()).unwrap();
    let keys = "backend adapter width height spp max_edges pairs rays_closest rays_shadow seconds cpu_seconds ms_per_dispatch threads non_finite peak_memory_bytes features lens_radius lost_paths";
    for key in keys.split(' ') {
        assert!(!stats[key].is_null(), "{key}");
    }
    assert_eq!((&stats["backend"], stats["width"].as_u64(), stats["spp"].as_f64()), (&"cpu".into(), Some(16), Some(3.0)));
    assert_eq!((stats["pairs"].as_u64(), stats["non_finite"].as_u64()), (Some(768), Some(0)));
}

#[test]
fn the_gpu_renders_the_same_picture_or_says_why_not() {
    let folder = tempfile::tempdir().unwrap();
    let stats = |backend: &str| {
        let line = format!("render cornell -o {backend}.exr --size 24x20 --max-edges 4 --spp 4 --backend {backend} --stats {backend}.json");
        let output = succeed(folder.path(), &line);
        let stats: serde_json::Value =
            serde_json::from_slice(&std::fs::read(folder.path().join(format!("{backend}.json"))).unwrap()).unwrap();
        (stats, String::from_utf8_lossy(&output.stderr).into_owned())
    };
    stats("cpu");
    for backend in ["gpu", "auto"] {
        let (stats, said) = stats(backend);
        assert_eq!(stats["spp"].as_f64(), Some(4.0));
        if stats["backend"] == "cpu" {
            // No adapter, or for auto only one that runs on the processor: it is said, here and there.
            let why = stats["fallback"].as_str().unwrap();
            assert!(said.contains(&format!("note: {why} The CPU renders.")), "{said}");
            if backend == "gpu" {
                assert!(!skip::required("BDPT_REQUIRE_GPU"), "{why}");
                skip::skipped("the_gpu_renders_the_same_picture_or_says_why_not", why);
            }
        }
        let (_, a) = channels(&folder.path().join("cpu.exr"));
        let (_, b) = channels(&folder.path().join(format!("{backend}.exr")));
        let pixels = || a.iter().flat_map(|(name, values)| values.iter().zip(&b[name]));
        let close = pixels().filter(|(a, b)| (**a - **b).abs() <= 1e-4 * a.abs()).count();
        assert!(close as f64 > 0.99 * pixels().count() as f64, "{backend}: {close} of {}", pixels().count());
    }
}

#[test]
fn a_crop_is_the_same_pixels() {
    let folder = tempfile::tempdir().unwrap();
    succeed(folder.path(), "render cornell -o full.exr --size 40x30 --spp 3");
    succeed(folder.path(), "render cornell -o crop.exr --size 40x30 --spp 3 --crop 11,7,16,9");
    let ((_, full), (size, crop)) = (channels(&folder.path().join("full.exr")), channels(&folder.path().join("crop.exr")));
    assert_eq!(size, (16, 9));
    for letter in ["R", "G", "B"] {
        let cut: Vec<_> = (7..16).flat_map(|y| full[letter][y * 40 + 11..][..16].iter().copied()).collect();
        assert!(cut.iter().any(|&x| x > 0.0));
        assert_eq!(cut, crop[letter]);
    }
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    for threads in ["1", "2", "5"] {
        let line = format!("render cornell -o {threads}.exr --size 48x40 --spp 4 --backend cpu --pyramid {threads}");
        let output = program(folder.path()).args(line.split(' ')).env("RAYON_NUM_THREADS", threads).output().unwrap();
        assert!(output.status.success());
    }
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    for threads in ["2", "5"] {
        assert!(read(&format!("{threads}.exr")) == read("1.exr"));
        assert!(read(&format!("{threads}/pyramid.exr")) == read("1/pyramid.exr"));
    }
}

#[test]
fn hide_keeps_the_weights_and_remove_shares_them_again() {
    let folder = tempfile::tempdir().unwrap();
    let common = "render cornell --size 32x24 --spp 16 --max-edges 2";
    succeed(folder.path(), &format!("{common} -o all.exr --pyramid all"));
    succeed(folder.path(), &format!("{common} -o hide.exr --strategies s1t2 --strategies-mode hide"));
    succeed(folder.path(), &format!("{common} -o remove.exr --strategies s1t2 --strategies-mode remove --pyramid remove"));
    let red = |name: &str, channel: &str| channels(&folder.path().join(name)).1.remove(channel).unwrap();
    assert_eq!(red("hide.exr", "R"), red("all/pyramid.exr", "weighted.s1t2.R"));
    // Alone, the strategy has weight 1, so its weighted and its raw image are the same.
    assert_eq!(red("remove/pyramid.exr", "weighted.s1t2.R"), red("all/pyramid.exr", "raw.s1t2.R"));
    let sum = |pixels: Vec<f32>| pixels.iter().map(|&x| f64::from(x)).sum::<f64>();
    assert!(sum(red("remove.exr", "R")) > 1.1 * sum(red("hide.exr", "R")));
}

#[test]
fn integrators_are_sets_of_strategies() {
    let folder = tempfile::tempdir().unwrap();
    for (name, expected) in [("pt", "s0t2 s0t3 s0t4 s1t1 s1t2 s1t3"), ("lt", "s1t1 s2t1 s3t1")] {
        succeed(folder.path(), &format!("render cornell --integrator {name} --size 8x8 --spp 1 --max-edges 3 --pyramid {name}"));
        let (_, layers) = channels(&folder.path().join(name).join("pyramid.exr"));
        let names: Vec<_> = layers.keys().filter_map(|name| name.strip_prefix("raw.")?.strip_suffix(".R")).collect();
        assert_eq!(names.join(" "), expected);
    }
}

#[test]
fn inspect_says_the_same_every_time_and_its_json_has_the_agreed_keys() {
    let folder = tempfile::tempdir().unwrap();
    let line = "inspect cornell --pixel 200,300 --sample 7 --seed 3 --json";
    let (first, second) = (succeed(folder.path(), line), succeed(folder.path(), line));
    assert_eq!(first.stdout, second.stdout);
    let record: serde_json::Value = serde_json::from_slice(&first.stdout).unwrap();
    for key in ["scene", "pixel", "sample", "seed", "sampler", "size", "light", "eye", "strategies"] {
        assert!(!record[key].is_null(), "{key}");
    }
    let strategies = record["strategies"].as_array().unwrap();
    assert_eq!(strategies.len(), 27);
    for key in
        ["s", "t", "feasible", "reason", "raster", "vertices", "connection_term", "contribution_unweighted", "mis_weight", "contribution"]
    {
        assert!(strategies.iter().all(|entry| entry.get(key).is_some()), "{key}");
    }
    let even: serde_json::Value = serde_json::from_slice(&succeed(folder.path(), &format!("{line} --sampler sobol")).stdout).unwrap();
    assert!(even["sampler"] == "sobol" && record["sampler"] == "hash" && even["eye"] != record["eye"]);
    let table = stdout(&succeed(folder.path(), "inspect cornell --pixel 200,300 --sample 7 --seed 3"));
    for word in ["Light subpath", "Eye subpath", "next event", "light tracer", "(1,2)", "y0", "z1"] {
        assert!(table.contains(word), "{word}\n{table}");
    }
    assert!(!table.contains("  → "), "no vertex of it is at infinity\n{table}");
    let sky = stdout(&succeed(folder.path(), "inspect sunlit-room --pixel 60,250"));
    assert!(sky.lines().any(|line| line.contains("z1  environment") && line.contains("  → ") && line.contains("sr⁻¹")), "{sky}");
}

#[test]
fn a_lens_blurs_what_is_out_of_focus_and_adds_the_strategies_that_hit_it() {
    let folder = tempfile::tempdir().unwrap();
    let common = "render cornell --size 32x32 --spp 8 --max-edges 2";
    let own = run(folder.path(), &format!("{common} -o own.exr"));
    assert!(own.status.success() && own.stderr.is_empty(), "{}", String::from_utf8_lossy(&own.stderr));
    // The same pinhole, said in words; a focus distance alone changes nothing, and that is told.
    let output = succeed(folder.path(), &format!("{common} -o pinhole.exr --lens-radius 0 --focus-distance 3"));
    assert!(String::from_utf8_lossy(&output.stderr).contains("--focus-distance changes nothing"));
    let read = |name: &str| channels(&folder.path().join(name)).1;
    assert_eq!(read("own.exr"), read("pinhole.exr"));
    let output = succeed(folder.path(), &format!("{common} -o lens.exr --lens-radius 0.02 --focus-distance inf --pyramid lens"));
    assert!(output.stderr.is_empty() && read("own.exr") != read("lens.exr"));
    let layers = read("lens/pyramid.exr");
    assert!(layers.contains_key("raw.s2t0.R") && layers.contains_key("raw.s3t0.R"));
    // What is not said is the camera's own: focused on what the middle of the picture shows, the back of the box.
    let line = "inspect cornell --pixel 16,16 --size 32x32 --lens-radius 0.02 --json";
    let record: serde_json::Value = serde_json::from_slice(&succeed(folder.path(), line).stdout).unwrap();
    let focus = record["focus_distance"].as_f64().unwrap();
    assert!((1.0..1.4).contains(&focus) && (record["lens_radius"].as_f64().unwrap() - 0.02).abs() < 1e-6, "{focus}");
}

#[test]
fn the_environment_may_be_a_radiance_or_a_picture_and_can_be_turned() {
    let folder = tempfile::tempdir().unwrap();
    // Left of the middle of the map 1, right of it 3: behind the open side of the box, which is seen from +z, the seam.
    let sky = folder.path().join("sky.exr");
    write_rgb_file(&sky, 64, 32, |x, _| if x < 32 { (1.0f32, 1.0f32, 1.0f32) } else { (3.0, 3.0, 3.0) }).unwrap();
    // Nothing but the environment: one edge, and no lamp in sight at the border, which looks past the box.
    let border = |options: &str| {
        let line = format!("render cornell -o a.exr --size 48x16 --spp 2 --max-edges 1 {options}");
        let output = succeed(folder.path(), &line);
        assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
        let red = channels(&folder.path().join("a.exr")).1.remove("R").unwrap();
        [red[8 * 48], red[8 * 48 + 47]]
    };
    // The camera looks along +z: the left of the picture shows +x, the map's right half.
    for (options, [left, right]) in [
        ("", [0.0, 0.0]),
        ("--environment 0.25,0,0", [0.25, 0.25]),
        ("--environment sky.exr", [3.0, 1.0]),
        ("--environment sky.exr --environment-rotation 180", [1.0, 3.0]),
        ("--environment sky.exr --environment-rotation -90", [3.0, 3.0]),
    ] {
        // Up to the noise of the splats of (1,1).
        let near = |seen: f32, expected: f32| (seen - expected).abs() <= 0.2 * expected;
        let seen = border(options);
        assert!(near(seen[0], left) && near(seen[1], right), "{options}: {seen:?}");
    }
    // What the picture had to be repaired of is told.
    write_rgb_file(&sky, 2, 1, |_, _| (1.0f32, -1.0f32, 1.0f32)).unwrap();
    let output = succeed(folder.path(), "inspect cornell --pixel 1,1 --environment sky.exr");
    assert!(String::from_utf8_lossy(&output.stderr).contains("note: The environment map has 2 texels"));
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_the_rendering_and_keeps_it() {
    let folder = tempfile::tempdir().unwrap();
    let line = "render cornell -o a.exr --size 64x64 --time 300";
    let child = program(folder.path())
        .args(line.split(' '))
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_secs(2));
    let start = Instant::now();
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success() && start.elapsed() < Duration::from_secs(20));
    assert!(String::from_utf8_lossy(&output.stderr).contains("samples per pixel"));
    assert_eq!(channels(&folder.path().join("a.exr")).0, (64, 64));
}
