//! How numbers are written, the same everywhere.

use crate::bdpt::record::Measure;

/// Scientific, four digits: "3.142e-2"; zero is "0".
pub fn sci(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value:.3e}") }
}

/// Three channels, scientific.
pub fn rgb(value: [f32; 3]) -> String {
    if value[0] == value[1] && value[1] == value[2] {
        return sci(f64::from(value[0]));
    }
    value.map(|v| sci(f64::from(v))).join("  ")
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
pub fn unit(measure: Measure) -> &'static str {
    match measure {
        Measure::Area => "m⁻²",
        Measure::SolidAngle => "sr⁻¹",
        Measure::Discrete => "(discrete)",
    }
}

/// A small index below the line: "y₁₂".
pub fn indexed(name: char, index: usize) -> String {
    let digits = index.to_string();
    let low = digits.bytes().filter_map(|digit| char::from_u32(0x2080 + u32::from(digit - b'0')));
    std::iter::once(name).chain(low).collect()
}

/// The brightness of a colour as one number (Rec. 709 luminance).
pub fn luminance(rgb: [f32; 3]) -> f32 {
    0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_the_same_everywhere() {
        assert_eq!(sci(0.0), "0");
        assert_eq!(sci(0.031_415_9), "3.142e-2");
        assert_eq!(rgb([0.5; 3]), "5.000e-1");
        assert_eq!(rgb([1.0, 0.0, 2.0]), "1.000e0  0  2.000e0");
        assert_eq!(weight(0.25), "0.250");
        assert_eq!(weight(2e-5), "2e-5");
        assert_eq!(percent(0.123_4), "12.3 %");
        assert_eq!(percent(1e-6), "<0.1 %");
        assert_eq!(indexed('y', 12), "y₁₂");
    }
}
