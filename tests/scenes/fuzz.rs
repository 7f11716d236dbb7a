//! Files with random changes (by `proptest`, which shrinks what fails to a few), some thousands always, many on demand; the other readers are
//! in `fuzz_readers`:
//!
//! ```text
//! BDPT_FUZZ_SECONDS=600 cargo test --release --test scenes fuzz -- --ignored --nocapture --test-threads 1
//! ```

use super::*;
use bdpt_explorer::engine::{Job, Session};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::{Config, TestRunner};
use std::cell::Cell;
use std::time::{Duration, Instant};

/// Longest time one small file may take to load or to be refused.
pub const PATIENCE: Duration = Duration::from_secs(20);

/// A file in which everything occurs that the loader reads.
pub fn everything() -> Glb {
    let mut paint = json!({
        "name": "paint",
        "alphaMode": "MASK", "alphaCutoff": 0.5, "doubleSided": true,
        "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 }, "metallicRoughnessTexture": { "index": 1, "texCoord": 1 }, "metallicFactor": 0.5 },
        "normalTexture": { "index": 1, "scale": 0.75, "extensions": { "KHR_texture_transform": { "rotation": 0.5, "texCoord": 0 } } },
        "emissiveTexture": { "index": 0 }, "emissiveFactor": [0.5, 0.25, 1.0],
        "occlusionTexture": { "index": 1 },
        "extensions": { "KHR_materials_specular": { "specularFactor": 0.5 }, "KHR_materials_ior": { "ior": 1.25 },
            "KHR_materials_emissive_strength": { "emissiveStrength": 3.0 } },
    });
    paint["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] =
        json!({ "KHR_texture_transform": { "offset": [0.25, 0.5], "scale": [2.0, 3.0] } });
    let mut glb = with_coordinates(paint);
    let picture = image::RgbImage::from_fn(16, 8, |x, y| image::Rgb([(x * 16) as u8, (y * 32) as u8, 99])).into();
    glb.texture(
        &png([4, 4], &(0..16).map(|i| [i * 16, 255 - i, 7, i * 17]).collect::<Vec<_>>()),
        json!({ "wrapS": 33648, "magFilter": 9728 }),
    );
    glb.texture(&encoded(&picture, image::ImageFormat::Jpeg), json!({ "wrapT": 33071 }));
    let normals = glb.vec3s(&[[0.0, 0.0, 1.0]; 4], false);
    glb.attribute(1, "NORMAL", normals);
    let tangents: Vec<u8> = [[127i8, 0, 0, 127]; 4].iter().flatten().map(|&x| x as u8).collect();
    let tangents = glb.accessor(&tangents, json!({ "componentType": 5120, "normalized": true, "count": 4, "type": "VEC4" }));
    glb.attribute(1, "TANGENT", tangents);
    let colors =
        glb.accessor(&[255, 99, 7, 200].repeat(4), json!({ "componentType": 5121, "normalized": true, "count": 4, "type": "VEC4" }));
    glb.attribute(1, "COLOR_0", colors);
    let (at, values) = (glb.view(&[0, 2, 3, 0]), glb.floats(&[[0.5f32, 0.25], [1.0, 2.0], [3.0, -4.0]]));
    let values = glb.json["accessors"][values]["bufferView"].clone();
    let sparse = json!({ "count": 3, "indices": { "bufferView": at, "componentType": 5121 }, "values": { "bufferView": values } });
    let second = glb.push("accessors", json!({ "componentType": 5126, "count": 4, "type": "VEC2", "sparse": sparse }));
    glb.attribute(1, "TEXCOORD_1", second);
    let clear = glb.material(glass("pane", 1.5));
    glb.object("ball", &Shape::sphere([0.0; 3], 0.5, 4, 5), clear);
    let mut sign = lambert("sign", GREY);
    sign["extensions"] = json!({ "KHR_materials_unlit": {} });
    sign["alphaMode"] = json!("BLEND");
    sign["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": 0 });
    let sign = glb.material(sign);
    let mesh = glb.mesh("sign", &Shape::quad(SQUARE.map(|[x, y, z]| [x + 2.0, y, z])), sign);
    let uvs: Vec<u8> = [0u16, 65535, 65535, 65535, 65535, 0, 0, 0].iter().flat_map(|x| x.to_le_bytes()).collect();
    let uvs = glb.accessor(&uvs, json!({ "componentType": 5123, "normalized": true, "count": 4, "type": "VEC2" }));
    glb.attribute(mesh, "TEXCOORD_0", uvs);
    glb.node(json!({ "mesh": mesh, "scale": [-1.0, 2.0, 1.0], "rotation": [0.0, 0.7, 0.0, 0.7] }));
    let spot = glb.light(json!({ "type": "spot", "intensity": 5.0, "spot": { "innerConeAngle": 0.1, "outerConeAngle": 0.9 } }));
    glb.node(json!({ "translation": [1.0, 2.0, 3.0], "extensions": { "KHR_lights_punctual": { "light": spot } } }));
    let sky = glb.view(&super::environment::hdr([4, 2], &[[0.5, 1.0, 2.0]; 8]));
    glb.json["scenes"][0]["extras"] = json!({ "environment": { "bufferView": sky }, "environmentRotation": 123.0 });
    glb.json["cameras"][0]["extras"] = json!({ "lensRadius": 0.015, "focusDistance": 4.25 });
    glb.push("scenes", json!({ "name": "other" }));
    glb
}

/// Loads bytes: a scene whose numbers can be used, or an error of one line, in time. Did it load?
fn survives(bytes: &[u8], what: &str) -> bool {
    let start = Instant::now();
    let result = std::panic::catch_unwind(|| {
        let scene = gltf::load_bytes("fuzz.glb", bytes, &Overrides::default()).map_err(|e| e.to_string())?;
        assert!(!scene.cameras.is_empty() && (!scene.triangles.is_empty() || scene.lights.environment.is_some()));
        assert!(scene.lights.list.iter().all(|light| light.pmf > 0.0 && light.pmf <= 1.0));
        assert!(scene.cameras.iter().all(|camera| camera.lens.radius.is_finite() && camera.lens.focus_distance > 0.0));
        for triangle in 0..scene.triangles.len().min(50) as u32 {
            let at = scene.point_on_triangle(triangle, Vec2::new(0.25, 0.5));
            assert!(at.n_s.is_normalized() && at.n_g.is_normalized() && at.n_s.dot(at.n_g) > 0.0, "{at:?}");
            let look = at.look;
            let unit = [look.roughness, look.metallic, look.opacity, look.color.min_element(), look.color.max_element()];
            assert!(unit.iter().all(|x| (-1e-5..=1.0 + 1e-5).contains(x)), "{look:?}");
            let emitted = scene.emission_factor::<General>(triangle, at.material, look.barycentric);
            assert!(emitted.is_finite() && emitted.min_element() >= -1e-5, "{emitted}");
        }
        shows_something(scene);
        Ok::<_, String>(())
    });
    match &result {
        Ok(Err(message)) => assert!(message.starts_with("fuzz.glb: ") && !message.contains('\n'), "{what}: {message}"),
        Ok(Ok(())) => {}
        Err(_) => {
            let path = std::env::temp_dir().join("bdpt-fuzz-failure.glb");
            let _ = std::fs::write(&path, bytes);
            panic!("{what}: it panicked; the file is {}", path.display());
        }
    }
    assert!(start.elapsed() < PATIENCE, "{what}: it took {:?}", start.elapsed());
    matches!(result, Ok(Ok(())))
}

/// A pass of a few pixels holds nothing infinite, undefined or negative.
fn shows_something(scene: Scene) {
    let mut session = Session::new(Job { size: [4, 3], ..Job::new(scene.into()) }).unwrap();
    while session.passes() < 1 {
        session.step(Duration::from_secs(1));
    }
    assert!(session.image().iter().all(|c| c.is_finite() && c.min_element() >= 0.0), "{:?}", session.image());
}

/// A change of a file.
#[derive(Clone, Debug)]
pub enum Change {
    /// A digit of the JSON becomes another, so that it still parses and its numbers lie.
    Digit(Index, u8),
    /// A byte becomes another.
    Byte(Index, u8),
    /// A bit is turned.
    Bit(Index, u8),
    /// A run of bytes comes from elsewhere: other types of numbers, other pictures.
    Run(Index, Index, usize),
    /// A whole number of the JSON is another, as long as it fits.
    Number(Index, &'static str),
    /// The file is cut short.
    Cut(Index),
}

const NUMBERS: [&str; 10] = ["0", "-1", "1e9", "65535", "4294967295", "1e39", "0.5", "7", "-1e-9", "99999999999999999999"];

pub fn change() -> impl Strategy<Value = Change> {
    let at = any::<Index>;
    prop_oneof![
        6 => (at(), b'0'..=b'9').prop_map(|(at, digit)| Change::Digit(at, digit)),
        3 => (at(), any::<u8>()).prop_map(|(at, byte)| Change::Byte(at, byte)),
        3 => (at(), 0..8u8).prop_map(|(at, bit)| Change::Bit(at, bit)),
        3 => (at(), at(), 1..64usize).prop_map(|(to, from, length)| Change::Run(to, from, length)),
        3 => (at(), prop::sample::select(&NUMBERS[..])).prop_map(|(at, number)| Change::Number(at, number)),
        1 => at().prop_map(Change::Cut),
    ]
}

impl Change {
    /// Changes a file whose JSON ends at `json_end`.
    pub fn apply(&self, bytes: &mut Vec<u8>, json_end: usize) {
        let json_end = json_end.min(bytes.len());
        let places = |bytes: &[u8], number: bool| -> Vec<usize> {
            let starts = |i: &usize| bytes[*i].is_ascii_digit() && (!number || b":[,".contains(&bytes[i - 1]));
            (21..json_end).filter(starts).collect()
        };
        match self {
            _ if bytes.is_empty() => {}
            Self::Digit(at, digit) => {
                let digits = places(bytes, false);
                if !digits.is_empty() {
                    bytes[*at.get(&digits)] = *digit;
                }
            }
            Self::Byte(at, byte) => {
                let at = at.index(bytes.len());
                bytes[at] = *byte;
            }
            Self::Bit(at, bit) => {
                let at = at.index(bytes.len());
                bytes[at] ^= 1 << bit;
            }
            Self::Run(to, from, length) => {
                let run: Vec<u8> = bytes[from.index(bytes.len())..].iter().copied().take(*length).collect();
                let to = to.index(bytes.len());
                bytes.iter_mut().skip(to).zip(run).for_each(|(byte, new)| *byte = new);
            }
            Self::Number(at, number) => {
                let starts = places(bytes, true);
                if starts.is_empty() {
                    return;
                }
                let start = *at.get(&starts);
                let end = (start..json_end).find(|&i| b",]}".contains(&bytes[i])).unwrap_or(start);
                if number.len() <= end - start {
                    bytes[start..end].fill(b' ');
                    bytes[start..start + number.len()].copy_from_slice(number.as_bytes());
                }
            }
            Self::Cut(at) => bytes.truncate(at.index(bytes.len())),
        }
    }
}

/// Loads `cases` changed files; the same every time for the same `seed`.
fn run(seed: u64, cases: u32) {
    let original = everything().bytes();
    let json_end = 20 + u32::from_le_bytes([original[12], original[13], original[14], original[15]]) as usize;
    let config = Config { cases, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(seed), ..Config::default() };
    let loaded = Cell::new(0);
    let result = TestRunner::new(config).run(&vec(change(), 1..5), |changes| {
        let mut bytes = original.clone();
        changes.iter().for_each(|change| change.apply(&mut bytes, json_end));
        loaded.set(loaded.get() + u32::from(survives(&bytes, "a changed file")));
        Ok(())
    });
    if let Err(error) = result {
        panic!("seed {seed}: {error}");
    }
    // Enough of them load, and enough are refused, for either to be tried.
    println!("{} of {cases} load", loaded.get());
    assert!(loaded.get() * 10 > cases && (cases - loaded.get()) * 10 > cases, "{loaded:?} of {cases}");
}

#[test]
fn changed_files_make_errors_not_panics() {
    let original = everything().bytes();
    let scene = gltf::load_bytes("fuzz.glb", &original, &Overrides::default()).unwrap();
    assert!(scene.features.alpha_mask && scene.features.normal_maps && scene.features.unlit && scene.features.vertex_colors);
    assert!(survives(&original, "the file itself"));
    run(1 << 32, 5_000);
}

#[test]
#[ignore = "as long as BDPT_FUZZ_SECONDS says"]
fn changed_files_for_long() {
    for_long(|seed| {
        run(seed, 10_000);
        10_000
    });
}

/// Runs batches, each with a seed of its own, for as long as `BDPT_FUZZ_SECONDS` says; a batch returns how many files it had.
pub fn for_long(batch: impl Fn(u64) -> u32) {
    let seconds = std::env::var("BDPT_FUZZ_SECONDS").ok().and_then(|text| text.parse().ok()).unwrap_or(600);
    let start = Instant::now();
    let files: u64 = (0..).take_while(|_| start.elapsed() < Duration::from_secs(seconds)).map(|seed| u64::from(batch(seed))).sum();
    println!("{files} files in {:.0?}", start.elapsed());
}
