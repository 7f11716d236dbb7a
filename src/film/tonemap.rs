//! From linear radiance to the eight bits of a screen: exposure, offset, a tone curve, the sRGB transfer function.
//!
//! ```text
//! rgb8 = round(255 · OETF(curve(2^EV · L + offset)))     OETF(x) = 12.92 x,  x ≤ 0.0031308;   1.055 x^(1/2.4) − 0.055 beyond
//! ```
//! Every input has an answer: NaN and negative radiance are black, infinite radiance is white (or the end of its scale).

use super::colourmap::false_colour;
use crate::math::Vec3;
use std::fmt;

/// How radiance beyond the screen's white is folded into it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneMap {
    /// Not at all: what is brighter than 1 is clipped. The only one in which equal steps of radiance stay equal.
    #[default]
    Srgb,
    /// A filmic S-curve per channel (Narkowicz 2015, a fit to the ACES reference transform).
    Aces,
    /// L/(1 + L) on the luminance, colours kept (Reinhard et al. 2002, eq. 3).
    Reinhard,
    /// No picture but a scale: Viridis of the logarithm of the luminance ([`false_colour`]).
    FalseColour,
}

/// How a picture is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Look {
    /// Exposure, stops.
    pub exposure_ev: f32,
    /// Added after the exposure; 1 is the screen's white.
    pub offset: f32,
    /// How radiance beyond white is shown.
    pub tonemap: ToneMap,
}

/// Radiance is cut off here before the curves, so that none of them meets ∞/∞.
const BRIGHTEST: f32 = 1e9;

impl ToneMap {
    /// All of them, in the order they are offered.
    pub const ALL: [Self; 4] = [Self::Srgb, Self::Aces, Self::Reinhard, Self::FalseColour];

    /// Its name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Srgb => "srgb",
            Self::Aces => "aces",
            Self::Reinhard => "reinhard",
            Self::FalseColour => "false-colour",
        }
    }

    /// The tone map of that name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|tonemap| tonemap.name() == name)
    }

    /// The eight bits for what is not negative and not infinite.
    fn rgb8(self, x: Vec3) -> [u8; 3] {
        let luminance = x.dot(Vec3::new(0.2126, 0.7152, 0.0722));
        let curved = match self {
            Self::Srgb => x,
            Self::Aces => x * (x * 2.51 + 0.03) / (x * (x * 2.43 + 0.59) + 0.14),
            Self::Reinhard => x / (1.0 + luminance),
            Self::FalseColour => return false_colour(luminance),
        };
        curved.to_array().map(|x| (255.0 * encode_srgb(x.clamp(0.0, 1.0))).round() as u8)
    }
}

impl fmt::Display for ToneMap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The sRGB transfer function of a value in 0…1.
pub(super) fn encode_srgb(x: f32) -> f32 {
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

/// What a screen shows for `radiance` at an exposure of `exposure_ev` stops.
pub fn to_srgb8(radiance: Vec3, exposure_ev: f32, tonemap: ToneMap) -> [u8; 3] {
    Look { exposure_ev, offset: 0.0, tonemap }.rgb8(radiance)
}

impl Look {
    /// What a screen shows for `radiance`.
    pub fn rgb8(&self, radiance: Vec3) -> [u8; 3] {
        let exposed = radiance * self.exposure_ev.exp2() + self.offset;
        // `max` drops a NaN where `clamp` would keep it.
        #[expect(clippy::manual_clamp)]
        let finite = exposed.to_array().map(|x| x.max(0.0).min(BRIGHTEST));
        self.tonemap.rgb8(Vec3::from_array(finite))
    }
}

/// The exposure, stops, that shows a picture's bright parts (its 99th percentile) just below white; 0 where there is no light.
pub fn fitting_exposure(pixels: &[Vec3]) -> f32 {
    let mut lit: Vec<f32> = pixels.iter().map(|p| p.max_element()).filter(|v| *v > 0.0 && v.is_finite()).collect();
    if lit.is_empty() {
        return 0.0;
    }
    let index = (lit.len() - 1) * 99 / 100;
    let (_, bright, _) = lit.select_nth_unstable_by(index, f32::total_cmp);
    (0.9 / *bright).log2()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values_of_the_srgb_curve() {
        for (linear, expected) in [(0.0, 0), (0.0031308, 10), (0.18, 118), (0.214, 127), (0.5, 188), (1.0, 255), (7.0, 255)] {
            assert_eq!(to_srgb8(Vec3::splat(linear), 0.0, ToneMap::Srgb), [expected; 3], "{linear}");
        }
    }

    #[test]
    fn a_stop_doubles() {
        for tonemap in ToneMap::ALL {
            assert_eq!(to_srgb8(Vec3::new(0.1, 0.2, 0.3), 1.0, tonemap), to_srgb8(Vec3::new(0.2, 0.4, 0.6), 0.0, tonemap));
        }
    }

    #[test]
    fn any_input_has_an_answer_and_brighter_is_never_darker() {
        let odd = [f32::NAN, f32::NEG_INFINITY, -1.0, -0.0, 0.0, 1e-40, 1e-3, 0.3, 1.0, 20.0, 1e30, f32::MAX, f32::INFINITY];
        for tonemap in ToneMap::ALL {
            for ev in [-200.0, -3.0, 0.0, 3.0, 200.0] {
                let greys = odd.map(|x| to_srgb8(Vec3::splat(x), ev, tonemap)[1]);
                assert!(greys.is_sorted(), "{tonemap} at {ev} EV: {greys:?}");
            }
            let brightest = if tonemap == ToneMap::FalseColour { false_colour(f32::MAX) } else { [255; 3] };
            assert_eq!(to_srgb8(Vec3::splat(f32::INFINITY), 0.0, tonemap), brightest);
            assert_eq!(to_srgb8(Vec3::splat(f32::NAN), 0.0, tonemap), [0; 3]);
        }
    }

    #[test]
    fn an_offset_is_added_after_the_exposure() {
        for tonemap in ToneMap::ALL {
            let look = Look { exposure_ev: 2.0, offset: 0.25, tonemap };
            assert_eq!(look.rgb8(Vec3::splat(0.125)), to_srgb8(Vec3::splat(0.75), 0.0, tonemap));
        }
        let dark = Look { offset: -0.5, ..Look::default() };
        assert_eq!([dark.rgb8(Vec3::splat(0.5)), dark.rgb8(Vec3::splat(0.1))], [[0; 3]; 2]);
    }

    #[test]
    fn a_picture_is_exposed_for_its_bright_parts() {
        assert_eq!(fitting_exposure(&[Vec3::ZERO; 4]), 0.0);
        assert_eq!(fitting_exposure(&[Vec3::NAN, Vec3::INFINITY]), 0.0);
        let pixels: Vec<Vec3> = (1..=100).map(|i| Vec3::splat(i as f32 * 1e-3)).collect();
        assert!((fitting_exposure(&pixels).exp2() * 0.099 - 0.9).abs() < 1e-3);
    }

    #[test]
    fn names_round_trip() {
        for tonemap in ToneMap::ALL {
            assert_eq!(ToneMap::parse(tonemap.name()), Some(tonemap));
        }
        assert_eq!(ToneMap::parse("agx"), None);
    }
}
