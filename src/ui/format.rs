//! How numbers are written, the same everywhere.

use super::text::{Lang, Text};
use crate::bdpt::record::Measure;

/// Four digits: "0.03142"; scientific where that would be long: "3.142e-4". Zero is "0".
pub fn number(value: f64) -> String {
    digits(value, 4)
}

/// Three digits, for a narrow column.
pub fn short(value: f64) -> String {
    digits(value, 3)
}

fn digits(value: f64, count: i32) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".to_owned()
    } else if (0.001..=9999.0).contains(&size) {
        let decimals = (count - 1 - size.log10().floor() as i32).max(0) as usize;
        format!("{value:.decimals$}")
    } else {
        format!("{value:.*e}", (count - 1) as usize)
    }
}

/// How many MiB, rounded up.
pub fn mebibytes(bytes: u64) -> String {
    bytes.div_ceil(1 << 20).to_string()
}

/// Three channels.
pub fn rgb(value: [f32; 3]) -> String {
    rgb_f64(value.map(f64::from))
}

/// The same.
pub fn rgb_f64(value: [f64; 3]) -> String {
    if value[0] == value[1] && value[1] == value[2] {
        return number(value[0]);
    }
    value.map(number).join("  ")
}

/// The angle between two unit vectors, degrees: small ones, too, keep their digits.
pub fn angle(a: [f32; 3], b: [f32; 3]) -> f64 {
    let [a, b] = [a, b].map(|v| v.map(f64::from));
    let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let dot: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
    cross.iter().map(|c| c * c).sum::<f64>().sqrt().atan2(dot).to_degrees()
}

/// A unit vector.
pub fn direction(value: [f32; 3]) -> String {
    value.map(|v| format!("{v:.4}")).join("  ")
}

/// A position, metres, to 0.1 mm near 1 m.
pub fn position(value: [f64; 3]) -> String {
    value.map(|v| format!("{v:.4}")).join("  ")
}

/// A weight or another number in [0, 1].
pub fn weight(value: f64) -> String {
    if value > 0.0 && value < 0.0005 { format!("{value:.0e}") } else { format!("{value:.3}") }
}

/// A share in percent.
pub fn percent(value: f64) -> String {
    let percent = value * 100.0;
    if percent > 0.0 && percent < 0.05 { "<0.1 %".to_owned() } else { format!("{percent:.1} %") }
}

/// The unit of a density.
pub fn unit(measure: Measure, lang: Lang) -> &'static str {
    match measure {
        Measure::Area => "m⁻²",
        Measure::SolidAngle => "sr⁻¹",
        Measure::Discrete => Text::Probability.in_language(lang),
    }
}

/// A small index below the line: "y₁₂".
pub fn indexed(name: char, index: usize) -> String {
    let digits = index.to_string();
    let low = digits.bytes().filter_map(|digit| char::from_u32(0x2080 + u32::from(digit - b'0')));
    std::iter::once(name).chain(low).collect()
}

/// The name of a light end drawn for one connection alone (the built-in fonts have no prime).
pub const FRESH_LIGHT: &str = "y₀'";

/// The same of the lens.
pub const FRESH_LENS: &str = "z₀'";

/// The brightness of a colour as one number (Rec. 709 luminance).
pub fn luminance(rgb: [f32; 3]) -> f32 {
    0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
}

/// The same.
pub fn luminance_f64(rgb: [f64; 3]) -> f64 {
    0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_the_same_everywhere() {
        assert_eq!(number(0.0), "0");
        assert_eq!(number(0.031_415_9), "0.03142");
        assert_eq!(number(-0.000_314_159), "-3.142e-4");
        assert_eq!(number(123_456.0), "1.235e5");
        assert_eq!([0.109, 2.05, 1234.0, 1.09e-7].map(short), ["0.109", "2.05", "1234", "1.09e-7"]);
        assert_eq!(rgb([0.5; 3]), "0.5000");
        assert_eq!(rgb([1.0, 0.0, 2.0]), "1.000  0  2.000");
        assert_eq!(weight(0.25), "0.250");
        assert_eq!(weight(2e-5), "2e-5");
        assert_eq!(percent(0.123_4), "12.3 %");
        assert_eq!(percent(1e-6), "<0.1 %");
        assert_eq!(indexed('y', 12), "y₁₂");
    }
}
