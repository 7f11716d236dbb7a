//! Numbers as colours: one scale for sizes, one for signs. Both are told apart by everybody: neither needs red against green.
//!
//! ```text
//! false colour    Viridis((log₂ Y − BOTTOM)/(TOP − BOTTOM))       Y = luminance of what is shown; nothing is black
//! signed          0 is black;  v > 0 orange, v < 0 blue, as bright as OETF(min(|v|, 1))
//! ```

use super::tonemap::encode_srgb;

/// log₂ of the luminance at the dark end of the false-colour scale.
pub const BOTTOM: f32 = -8.0;
/// The same at its bright end.
pub const TOP: f32 = 4.0;

/// Viridis (van der Walt and Smith 2015) at 0, 1/8, …, 1.
const VIRIDIS: [[u8; 3]; 9] = [
    [0x44, 0x01, 0x54],
    [0x47, 0x2d, 0x7b],
    [0x3b, 0x52, 0x8b],
    [0x2c, 0x72, 0x8e],
    [0x21, 0x91, 0x8c],
    [0x28, 0xae, 0x80],
    [0x5e, 0xc9, 0x62],
    [0xad, 0xdc, 0x30],
    [0xfd, 0xe7, 0x25],
];
/// What is too large.
const ABOVE: [u8; 3] = [0xE6, 0x9F, 0x00];
/// What is too small: as bright as the orange, so that equal sizes look equal.
const BELOW: [u8; 3] = [0x56, 0xB4, 0xE9];

/// Viridis; `t` in 0…1, what is outside is brought in, NaN is the dark end.
pub fn viridis(t: f32) -> [u8; 3] {
    let at = if t > 0.0 { t.min(1.0) * (VIRIDIS.len() - 1) as f32 } else { 0.0 };
    let below = (at as usize).min(VIRIDIS.len() - 2);
    let [low, high] = [VIRIDIS[below], VIRIDIS[below + 1]];
    std::array::from_fn(|c| (f32::from(low[c]) + (f32::from(high[c]) - f32::from(low[c])) * (at - below as f32)).round() as u8)
}

/// The false colour of a luminance, after exposure and offset. Nothing at all is black, and darker than the scale's end.
pub fn false_colour(luminance: f32) -> [u8; 3] {
    if luminance > 0.0 { viridis((luminance.log2() - BOTTOM) / (TOP - BOTTOM)) } else { [0; 3] }
}

/// The colour of a signed number, after exposure: orange above 0, blue below, black at it.
pub fn signed(value: f32) -> [u8; 3] {
    let size = if value.is_nan() { 0.0 } else { encode_srgb(value.abs().min(1.0)) };
    let colour = if value > 0.0 { ABOVE } else { BELOW };
    colour.map(|channel| (f32::from(channel) * size).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn brightness(rgb: [u8; 3]) -> f32 {
        let [r, g, b] = rgb.map(|c| (f32::from(c) / 255.0).powf(2.2));
        0.2126 * r + 0.7152 * g + 0.0722 * b
    }

    #[test]
    fn viridis_grows_brighter_from_end_to_end() {
        let steps: Vec<f32> = (0..=1000).map(|i| brightness(viridis(i as f32 / 1000.0))).collect();
        // Eight bits: a step may be rounded the wrong way, by less than half a code of one channel.
        assert!(steps.windows(2).all(|pair| pair[1] >= pair[0] - 2e-3), "it never grows darker");
        assert_eq!([viridis(0.0), viridis(0.5), viridis(1.0)], [[0x44, 0x01, 0x54], [0x21, 0x91, 0x8c], [0xfd, 0xe7, 0x25]]);
        assert_eq!([viridis(-3.0), viridis(f32::NAN), viridis(9.0)], [viridis(0.0), viridis(0.0), viridis(1.0)]);
    }

    #[test]
    fn false_colour_has_a_step_per_factor_and_black_for_nothing() {
        assert_eq!([false_colour(0.0), false_colour(-1.0), false_colour(f32::NAN)], [[0; 3]; 3]);
        assert_eq!(false_colour(BOTTOM.exp2()), viridis(0.0));
        assert_eq!(false_colour(TOP.exp2()), viridis(1.0));
        assert_eq!(false_colour(f32::INFINITY), viridis(1.0));
        assert_eq!(false_colour((0.5 * (BOTTOM + TOP)).exp2()), viridis(0.5));
        assert!(brightness(false_colour(1e-30)) > 0.0, "a little is not nothing");
    }

    #[test]
    fn signs_are_mirrored_and_sizes_ordered() {
        assert_eq!([signed(0.0), signed(-0.0), signed(f32::NAN)], [[0; 3]; 3]);
        assert_eq!([signed(7.0), signed(-7.0)], [ABOVE, BELOW]);
        for i in 1..=100 {
            let v = i as f32 / 100.0;
            // The same fraction of either end's colour.
            for (channel, (above, below)) in signed(v).into_iter().zip(signed(-v)).enumerate() {
                let part = |value: u8, of: u8| f32::from(value) / f32::from(of.max(1));
                assert!(ABOVE[channel] == 0 || (part(above, ABOVE[channel]) - part(below, BELOW[channel])).abs() < 0.012, "{v}");
            }
            assert!(brightness(signed(v)) > brightness(signed(v - 0.01)) - 1e-4);
        }
        assert!((brightness(ABOVE) - brightness(BELOW)).abs() < 0.05, "neither sign looks larger");
    }
}
