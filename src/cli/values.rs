//! Parsers of single values; every refusal says what would do.

use crate::bdpt::strategy::MAX_EDGES;
use crate::engine::Crop;
use crate::film::runs::parse_range;
use std::ops::Range;
use std::path::PathBuf;

/// A whole number from 0 on.
pub fn natural(text: &str) -> Result<u32, String> {
    text.parse().map_err(|_| format!("give a whole number from 0 to {}", u32::MAX))
}

/// A whole number from 1 on.
pub fn positive(text: &str) -> Result<u32, String> {
    text.parse().ok().filter(|&n| n > 0).ok_or(format!("give a whole number from 1 to {}", u32::MAX))
}

/// `A..B`, seeds.
pub fn seed_range(text: &str) -> Result<Range<u32>, String> {
    parse_range(text).ok_or("give first..end, such as 0..4 for the seeds 0, 1, 2, 3; the end is not among them".to_owned())
}

/// A number of seeds: with one there is no interval, and seeds from 2³¹ − 1 on are not measured.
pub fn seeds(text: &str) -> Result<u32, String> {
    text.parse().ok().filter(|n| (2..=1_000_000).contains(n)).ok_or("give a whole number from 2 to 1000000".to_owned())
}

/// K.
pub fn edges(text: &str) -> Result<u32, String> {
    text.parse().ok().filter(|k| (1..=MAX_EDGES as u32).contains(k)).ok_or(format!("give a whole number from 1 to {MAX_EDGES}"))
}

/// A number in a range; NaN is in none.
fn number(text: &str, low: f32, high: f32) -> Result<f32, String> {
    text.parse().ok().filter(|x| (low..=high).contains(x)).ok_or(format!("give a number from {low} to {high}"))
}

/// β; far beyond the upper end it is the maximum heuristic.
pub fn beta(text: &str) -> Result<f32, String> {
    number(text, 0.0, 100.0)
}

/// A number from 0 to 1.
pub fn fraction(text: &str) -> Result<f32, String> {
    number(text, 0.0, 1.0)
}

/// An exposure in stops.
pub fn stops(text: &str) -> Result<f32, String> {
    number(text, -64.0, 64.0)
}

/// A time.
pub fn seconds(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|s| *s > 0.0 && *s <= 1e7).ok_or("give a number of seconds above 0, at most 10000000".to_owned())
}

/// The radius of a lens, m.
pub fn lens_radius(text: &str) -> Result<f32, String> {
    let good = |radius: &f32| *radius >= 0.0 && radius.is_finite();
    text.parse().ok().filter(good).ok_or("give a radius in metres, 0 (a pinhole) or more".to_owned())
}

/// A focus distance, m.
pub fn focus_distance(text: &str) -> Result<f32, String> {
    text.parse().ok().filter(|distance: &f32| *distance > 0.0).ok_or("give a distance in metres above 0, or inf".to_owned())
}

/// An angle.
pub fn degrees(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|angle: &f64| angle.abs() <= 3600.0).ok_or("give degrees from -3600 to 3600".to_owned())
}

/// `WxH`.
pub fn size(text: &str) -> Result<[u32; 2], String> {
    let parse = || text.split_once('x').and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
    parse().filter(|size| !size.contains(&0)).ok_or("give width x height in pixels, both at least 1, such as 512x512".to_owned())
}

/// `X,Y`.
pub fn pixel(text: &str) -> Result<[u32; 2], String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|n| n.parse().ok()).collect();
    numbers.and_then(|n| n.try_into().ok()).ok_or("give column,row counted from 0, such as 100,200".to_owned())
}

/// `X,Y,W,H`.
pub fn crop(text: &str) -> Result<Crop, String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|n| n.parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[_, _, width, height]) if width == 0 || height == 0 => {
            Err("the window is empty; give a width and a height of at least 1".to_owned())
        }
        Some(&[x, y, width, height]) => Ok(Crop { x, y, width, height }),
        _ => Err("give left,top,width,height in pixels, such as 100,200,64,64".to_owned()),
    }
}

/// The name of a picture.
pub fn picture_path(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase).as_deref() {
        Some("exr" | "png") => Ok(path),
        _ => Err("name a file that ends in .exr (linear radiance) or .png (tone-mapped)".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn good_values() {
        assert_eq!(size("512x384"), Ok([512, 384]));
        assert_eq!(pixel("3,4"), Ok([3, 4]));
        assert_eq!(crop("1,2,3,4"), Ok(Crop { x: 1, y: 2, width: 3, height: 4 }));
        assert_eq!((edges("64"), positive("1"), natural("0"), seeds("2")), (Ok(64), Ok(1), Ok(0), Ok(2)));
        assert_eq!((beta("0.5"), fraction("1"), stops("-2"), seconds("1e-3")), (Ok(0.5), Ok(1.0), Ok(-2.0), Ok(1e-3)));
        assert_eq!((lens_radius("0"), lens_radius("0.05"), degrees("-90")), (Ok(0.0), Ok(0.05), Ok(-90.0)));
        assert_eq!((focus_distance("1e-3"), focus_distance("inf")), (Ok(1e-3), Ok(f32::INFINITY)));
        assert_eq!((seed_range("0..4"), seed_range("4294967294..4294967295")), (Ok(0..4), Ok(u32::MAX - 1..u32::MAX)));
        assert!(picture_path("a.b.EXR").is_ok() && picture_path("x/y.png").is_ok());
    }

    #[test]
    fn bad_values() {
        for text in ["", "0x0", "512", "-1x5", "1x", "x", "1x2x3", "1.5x2", "99999999999x1", " 1x1"] {
            assert!(size(text).is_err(), "{text}");
        }
        for text in ["", "1", "1,2,3", "-1,0", "1, 2", "a,b"] {
            assert!(pixel(text).is_err(), "{text}");
        }
        for text in ["", "4", "..", "0..", "..4", "4..4", "5..4", "0..4294967296", "-1..4", "0...4", "0..=4", "0-4", "0.. 4"] {
            assert!(seed_range(text).is_err(), "{text}");
        }
        for text in ["", "1,2,3", "1,2,0,4", "1,2,3,0", "1,2,3,4,5", "-1,2,3,4"] {
            assert!(crop(text).is_err(), "{text}");
        }
        for text in ["NaN", "nan", "inf", "-inf", "-1", "1e39", "", "two"] {
            assert!(beta(text).is_err() && fraction(text).is_err() && seconds(text).is_err(), "{text}");
        }
        for text in ["", "-1", "NaN", "wide", "1e-60"] {
            assert!(focus_distance(text).is_err() && (text == "1e-60" || lens_radius(text).is_err()), "{text}");
        }
        assert!(lens_radius("inf").is_err() && focus_distance("0").is_err() && degrees("NaN").is_err() && degrees("inf").is_err());
        assert!(stops("NaN").is_err() && stops("inf").is_err() && seconds("0").is_err() && positive("0").is_err());
        assert!(seeds("1").is_err() && seeds("1000001").is_err() && seeds("two").is_err());
        assert!(edges("0").is_err() && edges("65").is_err() && edges("100000").is_err());
        assert!(picture_path("a.jpg").is_err() && picture_path("exr").is_err());
    }
}
