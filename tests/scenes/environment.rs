//! Pictures as environments: what of them is seen in which direction, what is repaired, what is refused.

use super::*;
use bdpt_explorer::scene::Environment;
use bdpt_explorer::scene::environment::EnvironmentSource;
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, IntegerBounds, Layer, LayerAttributes, SmallVec, WritableImage,
};
use std::f64::consts::{PI, TAU};

/// A Radiance picture. Values keep 8 bits of the largest channel's mantissa.
pub fn hdr([width, height]: [usize; 2], texels: &[[f32; 3]]) -> Vec<u8> {
    let (mut bytes, texels) = (Vec::new(), texels.iter().map(|&texel| image::Rgb(texel)).collect::<Vec<_>>());
    image::codecs::hdr::HdrEncoder::new(&mut bytes).encode(&texels, width, height).unwrap();
    bytes
}

/// An OpenEXR picture of layers, each a list of channels.
pub fn exr(size: [usize; 2], layers: &[&[(&str, &[f32])]]) -> Vec<u8> {
    let layer = |(index, channels): (usize, &&[(&str, &[f32])])| {
        let channels: SmallVec<_> =
            channels.iter().map(|(name, samples)| AnyChannel::new(*name, FlatSamples::F32(samples.to_vec()))).collect();
        let attributes = LayerAttributes::named(format!("layer {index}").as_str());
        Layer::new((size[0], size[1]), attributes, Encoding::FAST_LOSSLESS, AnyChannels::sort(channels))
    };
    let layers: SmallVec<[Layer<AnyChannels<FlatSamples>>; 2]> = layers.iter().enumerate().map(layer).collect();
    let mut bytes = std::io::Cursor::new(Vec::new());
    let attributes = ImageAttributes::new(IntegerBounds::new((0, 0), (size[0], size[1])));
    Image::from_layers(attributes, layers).write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

/// The picture, and what is told of it.
fn decode(bytes: &[u8], rotation: f64) -> (Environment, Vec<String>) {
    let mut notes = Vec::new();
    let environment = Environment::decode(bytes, rotation, &mut notes).unwrap();
    (environment, notes)
}

fn radiances(environment: &Environment) -> Vec<Vec3> {
    environment.texels.iter().map(|texel| texel.radiance).collect()
}

/// 8 × 4 texels that all differ.
fn numbered() -> Vec<[f32; 3]> {
    (0..32).map(|i| [i as f32, 32.0 - i as f32, 0.5]).collect()
}

/// The direction of a place in the map by the convention: φ = 2π(u − ½), θ = πv.
fn direction(u: f64, v: f64) -> Vec3 {
    let (phi, theta) = (TAU * (u - 0.5), PI * v);
    DVec3::new(phi.sin() * theta.sin(), theta.cos(), -phi.cos() * theta.sin()).as_vec3()
}

#[test]
fn every_texel_of_both_formats_is_seen_where_the_convention_says() {
    let texels = numbered();
    let channel = |c: usize| texels.iter().map(|texel| texel[c]).collect::<Vec<_>>();
    let exr = exr([8, 4], &[&[("R", &channel(0)), ("G", &channel(1)), ("B", &channel(2))]]);
    for bytes in [hdr([8, 4], &texels), exr] {
        let (environment, notes) = decode(&bytes, 0.0);
        assert!(notes.is_empty(), "{notes:?}");
        assert_eq!(radiances(&environment), texels.iter().map(|&texel| Vec3::from(texel)).collect::<Vec<_>>());
        for (i, texel) in texels.iter().enumerate() {
            let w = direction(((i % 8) as f64 + 0.5) / 8.0, ((i / 8) as f64 + 0.5) / 4.0);
            assert!((environment.radiance(w) - Vec3::from(*texel)).length() < 1e-3, "{i}: {} {texel:?}", environment.radiance(w));
        }
        // In words: −Z between the two middle columns, +X to its right, +Z at the seam, +Y on top.
        let between = |texels: [f32; 4]| texels.iter().sum::<f32>() / 4.0;
        for (w, expected) in [
            (Vec3::NEG_Z, between([11.0, 12.0, 19.0, 20.0])),
            (Vec3::X, between([13.0, 14.0, 21.0, 22.0])),
            (Vec3::NEG_X, between([9.0, 10.0, 17.0, 18.0])),
            (Vec3::Z, between([8.0, 15.0, 16.0, 23.0])),
        ] {
            assert!((environment.radiance(w).x - expected).abs() < 1e-3, "{w}: {} {expected}", environment.radiance(w));
        }
        assert!(environment.radiance(Vec3::Y).x < 8.0 && environment.radiance(Vec3::NEG_Y).x >= 24.0);
    }
}

#[test]
fn rotation_is_counter_clockwise_seen_from_above() {
    let bytes = hdr([8, 4], &numbered());
    let (straight, _) = decode(&bytes, 0.0);
    for (degrees, ahead) in [(90.0, Vec3::NEG_X), (180.0, Vec3::Z), (-90.0, Vec3::X), (270.0, Vec3::X), (-360.0, Vec3::NEG_Z)] {
        let (turned, _) = decode(&bytes, degrees);
        assert!((turned.radiance(ahead) - straight.radiance(Vec3::NEG_Z)).length() < 1e-3, "{degrees}");
    }
    let (turned, _) = decode(&bytes, 30.0);
    for i in 0..100 {
        let (u, v) = ((f64::from(i) * 0.618).fract(), (f64::from(i) + 0.5) / 100.0);
        let (a, b) = (turned.radiance(direction(u - 30.0 / 360.0, v)), straight.radiance(direction(u, v)));
        assert!((a - b).length() < 1e-3, "{a} {b}");
    }
}

#[test]
fn layers_and_headers_are_understood() {
    // The first layer with R, G and B, whatever stands before them; plain names come first.
    let (a, b, c) = ([1.0f32; 2], [2.0f32; 2], [4.0f32; 2]);
    let depth: &[(&str, &[f32])] = &[("Z", &a)];
    let named: &[(&str, &[f32])] = &[("sky.R", &a), ("sky.G", &b), ("sky.B", &c), ("sky.A", &a)];
    let plain: &[(&str, &[f32])] = &[("AO.R", &c), ("AO.G", &c), ("AO.B", &c), ("R", &a), ("G", &b), ("B", &c)];
    for layers in [&[depth, named][..], &[plain], &[depth, plain, named]] {
        assert_eq!(radiances(&decode(&exr([2, 1], layers), 0.0).0), [Vec3::new(1.0, 2.0, 4.0); 2]);
    }
    // A .hdr may be called RGBE, and say by what it was multiplied.
    let bytes = hdr([2, 1], &[[2.0, 4.0, 6.0]; 2]);
    let text = [b"#?RGBE\nEXPOSURE=4\nEXPOSURE=0.5\nSOFTWARE=unknown\n", &bytes[b"#?RADIANCE\n".len()..]].concat();
    let (environment, notes) = decode(&text, 0.0);
    assert_eq!(radiances(&environment), [Vec3::new(1.0, 2.0, 3.0); 2]);
    says(&notes[0], &["divided by the exposure in its header", "2"]);
}

#[test]
fn what_is_no_radiance_is_repaired_and_counted() {
    let (nan, inf) = (f32::NAN, f32::INFINITY);
    let r = [nan, 1.0, inf, 1e35, 0.0, 2.0, 3.0, 4.0];
    let g = [1.0, -1.0, 5.0, 1.0, 0.0, 2.0, -inf, 4.0];
    let (environment, notes) = decode(&exr([4, 2], &[&[("R", &r), ("G", &g), ("B", &[0.0; 8])]]), 0.0);
    let fixed = radiances(&environment);
    assert_eq!(fixed[0], Vec3::new(0.0, 1.0, 0.0));
    assert_eq!(fixed[1], Vec3::new(1.0, 0.0, 0.0));
    assert_eq!(fixed[2], Vec3::new(5.0, 5.0, 0.0));
    assert_eq!(fixed[3], Vec3::new(1e30, 1.0, 0.0));
    assert_eq!(fixed[6], Vec3::new(3.0, 0.0, 0.0));
    assert_eq!(
        notes,
        [
            "The environment map has 3 texels with values that are negative or no numbers: 0 was put there instead.",
            "The environment map has 1 texel of infinite radiance: its largest finite value, 5, was put there instead.",
            "The environment map has 1 texel above 1e30 W m⁻² sr⁻¹: that was put there instead.",
        ]
    );
    // Sums of the largest values there may be stay finite, and the densities are those of a constant.
    let (environment, _) = decode(&exr([4, 2], &[&[("R", &[1e38; 8]), ("G", &[1e38; 8]), ("B", &[1e38; 8])]]), 0.0);
    assert!(environment.integral.is_finite() && environment.radiance(Vec3::X).is_finite());
    assert!(environment.texels.iter().all(|texel| (texel.pdf_sa * (4.0 * PI) as f32 - 1.0).abs() < 1e-5));
    // All infinite or all black: no light, and no harm.
    let (dark, _) = decode(&exr([4, 2], &[&[("R", &[inf; 8]), ("G", &[0.0; 8]), ("B", &[nan; 8])]]), 0.0);
    assert!(!dark.emits() && dark.radiance(Vec3::Z) == Vec3::ZERO && dark.pdf_sa(Vec3::Z) == 0.0);
}

#[test]
fn odd_shapes_are_told() {
    let (_, notes) = decode(&hdr([3, 3], &[[1.0; 3]; 9]), 0.0);
    assert_eq!(notes, ["The environment map has 3×3 texels: as it is not twice as wide as high, it was stretched."]);
    // More texels than can be chosen from: halved, and the power is kept.
    let row = [vec![1.0f32; 4100], vec![3.0f32; 4100]].concat();
    let map: Vec<f32> = (0..4100).flat_map(|_| &row).copied().collect();
    let (environment, notes) = decode(&exr([8200, 4100], &[&[("R", &map), ("G", &map), ("B", &map)]]), 0.0);
    assert_eq!([environment.width, environment.height], [4100, 2050]);
    assert_eq!(notes, ["The environment map has 8200×4100 texels: it was reduced to 4100×2050."]);
    assert!((environment.integral.y / (8.0 * PI) as f32 - 1.0).abs() < 1e-5);
}

#[test]
fn constants_and_paths_are_told_apart() {
    let parse = EnvironmentSource::parse;
    assert_eq!(parse("0.5"), Ok(EnvironmentSource::Constant(Vec3::splat(0.5))));
    assert_eq!(parse("1,2.5, 0"), Ok(EnvironmentSource::Constant(Vec3::new(1.0, 2.5, 0.0))));
    for path in ["sky.hdr", "1,2,sky.exr", "./1", "a b.exr"] {
        assert_eq!(parse(path), Ok(EnvironmentSource::File(path.into())));
    }
    for (text, part) in [
        ("", "give a radiance R,G,B or a .hdr or .exr file"),
        ("1,2", "give one number, or three as R,G,B"),
        ("1,2,3,4", "give one number, or three as R,G,B"),
        ("-1", "from 0 to 1e30"),
        ("1,-2,3", "from 0 to 1e30"),
        ("NaN", "from 0 to 1e30"),
        ("inf", "from 0 to 1e30"),
        ("1,1e31,1", "from 0 to 1e30"),
    ] {
        says(&parse(text).unwrap_err(), &[part]);
    }
    let error = EnvironmentSource::Constant(Vec3::NEG_ONE).open(0.0, &mut Vec::new()).unwrap_err().to_string();
    assert_eq!(error, "the environment: a radiance must be a number from 0 to 1e30 in each channel");
}

#[test]
fn bad_pictures_are_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let open = |name: &str, bytes: Option<&[u8]>| {
        let path = folder.path().join(name);
        if let Some(bytes) = bytes {
            std::fs::write(&path, bytes).unwrap();
        }
        let message = EnvironmentSource::File(path).open(0.0, &mut Vec::new()).unwrap_err().to_string();
        assert!(!message.contains('\n') && message.contains(name), "{message}");
        message
    };
    says(&open("none.hdr", None), &["there is no such file", ".hdr or .exr"]);
    says(&open("", None), &["this is a folder"]);
    let good = hdr([16, 8], &[[0.25, 0.5, 1.0]; 128]);
    let fine = exr([16, 8], &[&[("R", &[1.0; 128]), ("G", &[1.0; 128]), ("B", &[1.0; 128])]]);
    for bytes in [&b""[..], b"solid cube", &[0x89, b'P', b'N', b'G', 13, 10, 26, 10], &[0xff, 0xd8, 0xff], &fine[1..]] {
        says(&open("a.hdr", Some(bytes)), &["neither a Radiance nor an OpenEXR picture; give a .hdr or .exr file"]);
    }
    for (name, bytes) in [("cut.hdr", &good), ("cut.exr", &fine)] {
        for length in [5, 20, 40, 60, bytes.len() / 2, bytes.len() - 1] {
            says(&open(name, Some(&bytes[..length])), &["cannot be decoded", "damaged, cut short"]);
        }
    }
    let header = |line: &str| [b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n", line.as_bytes(), b"\n"].concat();
    says(&open("zero.hdr", Some(&header("-Y 0 +X 16"))), &["the picture is empty (16×0 texels)"]);
    says(&open("huge.hdr", Some(&header("-Y 20000 +X 40000"))), &["40000×20000 texels", "make it smaller"]);
    says(&open("huge.hdr", Some(&header("-Y 4294967295 +X 1"))), &["1×4294967295 texels", "make it smaller"]);
    says(&open("turned.hdr", Some(&header("+X 16 -Y 8"))), &["cannot be decoded"]);
    says(&open("xyz.hdr", Some(b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n1234")), &["cannot be decoded", "xyze"]);
    says(&open("grey.exr", Some(&exr([2, 1], &[&[("Y", &[1.0; 2])]]))), &["no layer with the channels R, G and B"]);
}

#[test]
fn hostile_pictures_make_errors_not_panics() {
    let small = [0.5f32, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0];
    let files = [
        hdr([8, 4], &numbered()),
        hdr([4, 2], &[[1.0, 2.0, 3.0]; 8]),
        exr([4, 2], &[&[("R", &small), ("G", &small), ("B", &small)]]),
        exr([4, 2], &[&[("Z", &small)], &[("a.R", &small), ("a.G", &small), ("a.B", &small)]]),
    ];
    let mut state = 1u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) as usize) % below
    };
    for (number, bytes) in files.iter().enumerate() {
        for round in 0..5000 {
            let mut broken = bytes.clone();
            for _ in 0..=random(3) {
                let at = random(broken.len());
                broken[at] = if broken[at].is_ascii_digit() { b'0' + random(10) as u8 } else { random(256) as u8 };
            }
            broken.truncate(if random(4) == 0 { random(broken.len()) } else { broken.len() });
            let result = std::panic::catch_unwind(|| Environment::decode(&broken, 0.0, &mut Vec::new()));
            let result = result.unwrap_or_else(|_| panic!("file {number}, round {round}: it panicked"));
            assert!(result.map_or(true, |map| map.texels.iter().all(|texel| texel.radiance.is_finite() && texel.pdf_sa.is_finite())));
        }
    }
}
