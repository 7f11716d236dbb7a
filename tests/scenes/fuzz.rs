//! Files with random bytes changed, a short run of them always, a long one on demand:
//!
//! ```text
//! BDPT_FUZZ_SECONDS=600 cargo test --release --test scenes fuzz -- --ignored --nocapture
//! ```
//!
//! Every change is a function of the seed it prints, so that a failure can be had again: `BDPT_FUZZ_SEED=…`.

use super::*;
use std::time::{Duration, Instant};

/// Longest time one small file may take to load or to be refused.
const PATIENCE: Duration = Duration::from_secs(20);

/// SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }
}

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

/// Loads bytes: a scene whose numbers can be used, or an error of one line, in time.
fn survives(bytes: &[u8], what: &str) {
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
        Ok::<_, String>(())
    });
    match result {
        Ok(Err(message)) => assert!(message.starts_with("fuzz.glb: ") && !message.contains('\n'), "{what}: {message}"),
        Ok(Ok(())) => {}
        Err(_) => {
            let path = std::env::temp_dir().join("bdpt-fuzz-failure.glb");
            let _ = std::fs::write(&path, bytes);
            panic!("{what}: it panicked; the file is {}", path.display());
        }
    }
    assert!(start.elapsed() < PATIENCE, "{what}: it took {:?}", start.elapsed());
}

/// The file with a few changes that `seed` decides.
fn mutated(original: &[u8], json_end: usize, seed: u64) -> Vec<u8> {
    const NUMBERS: [&[u8]; 10] = [b"0", b"-1", b"1e9", b"65535", b"4294967295", b"1e39", b"0.5", b"7", b"-1e-9", b"99999999999999999999"];
    let mut random = Random(seed);
    let mut bytes = original.to_vec();
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len());
        match random.below(6) {
            // Digits become other digits, so that the JSON still parses and its numbers lie.
            0 | 1 => {
                let digits: Vec<usize> = (20..json_end).filter(|&i| bytes[i].is_ascii_digit()).collect();
                let at = digits[random.below(digits.len())];
                bytes[at] = b'0' + random.below(10) as u8;
            }
            2 => bytes[at] = random.next() as u8,
            3 => bytes[at] ^= 1 << random.below(8),
            // A run of bytes comes from elsewhere: other types of numbers, other pictures.
            4 => {
                let (from, length) = (random.below(bytes.len()), random.below(64));
                let run: Vec<u8> = bytes[from..].iter().copied().take(length).collect();
                bytes.iter_mut().skip(at).zip(run).for_each(|(byte, new)| *byte = new);
            }
            // A whole number of the JSON is another, as long as it fits.
            _ => {
                let starts: Vec<usize> = (21..json_end).filter(|&i| bytes[i].is_ascii_digit() && b":[,".contains(&bytes[i - 1])).collect();
                let start = starts[random.below(starts.len())];
                let end = (start..json_end).find(|&i| b",]}".contains(&bytes[i])).unwrap_or(start);
                let number = NUMBERS[random.below(NUMBERS.len())];
                if number.len() <= end - start {
                    bytes[start..end].fill(b' ');
                    bytes[start..start + number.len()].copy_from_slice(number);
                }
            }
        }
    }
    bytes.truncate(if random.below(50) == 0 { random.below(bytes.len()) } else { bytes.len() });
    bytes
}

fn json_end(bytes: &[u8]) -> usize {
    20 + u32::from_le_bytes([bytes[12], bytes[13], bytes[14], bytes[15]]) as usize
}

/// Runs until `enough` says so; how many files that were.
fn run(first: u64, mut enough: impl FnMut(u64) -> bool) -> u64 {
    let original = everything().bytes();
    let scene = gltf::load_bytes("fuzz.glb", &original, &Overrides::default()).unwrap();
    assert!(scene.features.alpha_mask && scene.features.normal_maps && scene.features.unlit && scene.features.vertex_colors);
    survives(&original, "the file itself");
    let mut count = 0;
    while !enough(count) {
        let seed = first + count;
        survives(&mutated(&original, json_end(&original), seed), &format!("seed {seed}"));
        count += 1;
    }
    count
}

#[test]
fn changed_files_make_errors_not_panics() {
    run(1 << 32, |count| count == 5_000);
}

#[test]
#[ignore = "as long as BDPT_FUZZ_SECONDS says"]
fn changed_files_for_long() {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    if let Some(seed) = number("BDPT_FUZZ_SEED") {
        let original = everything().bytes();
        survives(&mutated(&original, json_end(&original), seed), &format!("seed {seed}"));
        return;
    }
    let (seconds, start) = (number("BDPT_FUZZ_SECONDS").unwrap_or(600), Instant::now());
    let count = run(0, |_| start.elapsed() > Duration::from_secs(seconds));
    println!("{count} files in {:.0?}", start.elapsed());
}
