//! Films with sums, in files and out of them.

use super::super::Rect;
use super::*;
use crate::rng::pcg4d;

const WINDOW: Window = Window { film: [9, 8], rect: Rect { x: 2, y: 1, width: 5, height: 6 } };

/// A number with all the bits that f64 has, over many orders of magnitude.
fn number(i: u32) -> f64 {
    let [a, b, c, _] = pcg4d([i, 1, 2, 3]);
    let mantissa = 1.0 + (f64::from(a) + f64::from(b) / 4_294_967_296.0) / 4_294_967_296.0;
    mantissa * f64::from(c % 60).exp2() / f64::from(30).exp2()
}

fn film(seeds: &str, salt: u32) -> Sums {
    let facts = [("light-subpaths", "1"), ("max-edges", "6"), ("sampler", "hash"), ("scene.shapes", "12ab")];
    let facts = facts.into_iter().map(|(name, value)| (name.to_owned(), value.to_owned())).collect();
    let pixels = WINDOW.rect.width * WINDOW.rect.height;
    Sums {
        about: About::new("红房间.glb".to_owned(), WINDOW, facts, Runs::parse(seeds).unwrap()),
        values: (0..pixels).map(|i| [0, 1, 2].map(|c| number(salt + 3 * i + c))).collect(),
    }
}

#[test]
fn a_pair_holds_49_bits() {
    let errors = (0..1_000_000).map(|i| {
        let (sum, pair) = (number(i), split(number(i)).map(f64::from));
        assert_eq!((pair[0] + pair[1]) as f32, sum as f32);
        (pair[0] + pair[1] - sum).abs() / sum
    });
    let worst = errors.fold(0.0, f64::max).log2();
    // The bound is reached. A single f32 is off by up to 2⁻²⁴.
    assert!((-49.1..=-49.0).contains(&worst), "2^{worst}");
    assert_eq!((split(0.0), split(3.0)), ([0.0, 0.0], [3.0, 0.0]));
}

#[test]
fn a_film_is_read_as_it_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let film = film("0..4:16 4..5:3", 0);
    film.save(&path).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    film.save(&path).unwrap();
    assert!(bytes == std::fs::read(&path).unwrap(), "a film has one file");
    assert_eq!(About::open(&path).unwrap(), film.about);
    let read = Sums::open(&path).unwrap();
    assert_eq!(read.about, film.about);
    for (a, b) in read.values.iter().flatten().zip(film.values.iter().flatten()) {
        assert!((a - b).abs() <= b * f64::from(-49).exp2(), "{a} {b}");
    }
    // What was read is written as it is.
    read.save(&path).unwrap();
    assert!(Sums::open(&path).unwrap() == read);
    // The first films did not say how their samples go together.
    let (mut older, other) = (film.clone(), folder.path().join("b.exr"));
    for later in ["sampler", "light-subpaths"] {
        older.about.facts.remove(later);
    }
    older.save(&other).unwrap();
    assert_eq!(About::open(&other).unwrap(), film.about);
    // Any program sees the mean.
    let picture = super::super::picture::Picture::open(&path).unwrap();
    let mean = (film.values[0][1] / 67.0) as f32;
    assert_eq!((picture.size, picture.pixels[9 + 2].y), ([9, 8], mean));
}

#[test]
fn films_add_up_and_no_sample_counts_twice() {
    let (mut a, b) = (film("0..4:16", 0), film("4..5:3", 500));
    a.add(&b).unwrap();
    assert_eq!((a.about.runs.samples(), a.values[7][2]), (67, number(3 * 7 + 2) + number(500 + 3 * 7 + 2)));
    let before = a.clone();
    assert_eq!(a.add(&film("3..9:1", 9)), Err(3..4));
    assert!(a == before);
}

#[test]
fn the_first_difference_is_named_the_scene_before_the_settings() {
    let paths = [Path::new("a.exr"), Path::new("b.exr")];
    let refusal = |change: &dyn Fn(&mut Facts)| {
        let (a, mut b) = (film("0..4:16", 0), film("4..5:3", 0));
        change(&mut b.about.facts);
        a.about.check_same(&b.about, paths).map_err(|error| error.to_string())
    };
    assert_eq!(refusal(&|_| {}), Ok(()));
    let says = |change: &dyn Fn(&mut Facts)| refusal(change).unwrap_err();
    let shapes = |facts: &mut Facts| drop(facts.insert(format!("{SCENE}shapes"), "34cd".to_owned()));
    let edges = |facts: &mut Facts| drop(facts.insert("max-edges".to_owned(), "7".to_owned()));
    assert_eq!(
        says(&|facts| (shapes(facts), edges(facts)).0),
        "'a.exr' (红房间.glb) and 'b.exr' (红房间.glb) show different scenes: the shapes differ"
    );
    assert!(says(&edges).ends_with("different settings: max-edges is 6 in the first, 7 in the second"));
    assert!(says(&|facts| drop(facts.insert("max-edges".to_owned(), "7".repeat(99)))).ends_with("max-edges differ"));
    assert!(says(&|facts| drop(facts.remove("max-edges"))).ends_with("only one has max-edges"));
    assert!(says(&|facts| drop(facts.insert("new".to_owned(), "1".to_owned()))).ends_with("only one has new"));
}

/// Writes something that is not quite a film.
fn written(path: &Path, label: &str, names: [&str; 2], change: impl Fn(&mut Vec<f32>)) {
    let film = film("0..4:16", 0);
    let parts = [0, 1].map(|i| ["R", "G", "B"].into_iter().enumerate().map(move |(c, letter)| (i, c, letter)));
    let channels = parts.into_iter().flatten().map(|(i, c, letter)| {
        let mut values: Vec<f32> = film.values.iter().map(|sum| split(sum[c])[i]).collect();
        change(&mut values);
        (format!("{}.{letter}", names[i]), values)
    });
    std::fs::write(path, encode(WINDOW, channels, Some((LABEL, label))).unwrap()).unwrap();
}

#[test]
fn what_is_no_film_is_refused_in_a_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let good =
        |crop: &str| format!(r#"{{"format":1,"scene":"x","samples":64,"seeds":"0..4:16","settings":{{"size":"9x8","crop":"{crop}"}}}}"#);
    let (crop, same) = ("2,1,5,6", |_: &mut Vec<f32>| {});
    written(&path, &good(crop), LAYERS, same);
    assert_eq!(Sums::open(&path).unwrap().about.runs.samples(), 64);
    let refused = |label: &str, names: [&str; 2], change: &dyn Fn(&mut Vec<f32>), expected: &str| {
        written(&path, label, names, change);
        let said = Sums::open(&path).unwrap_err().to_string();
        assert!(said.contains(expected) && said.contains("a.exr'") && !said.contains('\n'), "{said}");
    };
    refused("", LAYERS, &same, "it is damaged or cut short");
    refused("{}", LAYERS, &same, "missing field `format`");
    refused(&good(crop).replace("64", "63"), LAYERS, &same, "contradict each other");
    refused(&good(crop).replace("0..4:16", "4..0:16"), LAYERS, &same, "contradict each other");
    refused(&good(crop).replace(r#""format":1"#, r#""format":2"#), LAYERS, &same, "another version of this program (format 2");
    refused(&good("none"), LAYERS, &same, "cropped or scaled");
    refused(&good(crop), ["sum.hi", "sum.low"], &same, "sum.lo.R is missing");
    refused(&good(crop), LAYERS, &|values| values[7] = f32::NAN, "pixel 4,2 has no sum");
    refused(&good(crop), LAYERS, &|values| values[29] = f32::INFINITY, "pixel 6,6 has no sum");
    // A number that no pair has: the same in both halves.
    refused(&good(crop), LAYERS, &|values| values[0] = 1.0, "pixel 2,1 has no sum");
    let mut bright = film("0..4:16", 0);
    bright.values[8][0] = 1e39;
    assert!(bright.save(&path).unwrap_err().to_string().starts_with("the sum of pixel 5,2 is more than an .exr can hold"));
}

#[test]
fn no_broken_file_breaks_the_reader() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    film("0..4:16", 0).save(&path).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let whole = Sums::open(&path).unwrap();
    for length in 0..bytes.len() {
        std::fs::write(&path, &bytes[..length]).unwrap();
        let said = Sums::open(&path).unwrap_err().to_string();
        assert!(said.contains("is no .exr file") || said.contains("damaged or cut short"), "{length}: {said}");
    }
    // Any of its bytes may be another one: then it is refused, or is still a film. (Only its pixels have a check sum.)
    let mut refused = 0;
    for i in 0..4000 {
        let [at, value, more, _] = pcg4d([i, 7, 7, 7]);
        let mut broken = bytes.clone();
        broken[at as usize % bytes.len()] ^= (value % 255 + 1) as u8;
        if i % 2 == 0 {
            broken[more as usize % bytes.len()] = value as u8;
        }
        std::fs::write(&path, &broken).unwrap();
        match Sums::open(&path) {
            Ok(film) => assert_eq!(film.values.len(), whole.values.len(), "{i}"),
            Err(_) => refused += 1,
        }
    }
    assert!(refused > 1000, "{refused}");
}
