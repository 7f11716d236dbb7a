//! From linear radiance to the eight bits of a screen: exposure, a tone curve, the sRGB transfer function.
//!
//! ```text
//! rgb8 = round(255 · OETF(curve(2^EV · L)))          OETF(x) = 12.92 x,  x ≤ 0.0031308;   1.055 x^(1/2.4) − 0.055 beyond
//! ```
//! Every input has an answer: NaN and negative radiance are black, infinite radiance is white.

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
}

/// Radiance is cut off here before the curves, so that none of them meets ∞/∞.
const BRIGHTEST: f32 = 1e9;

impl ToneMap {
    /// All of them, in the order they are offered.
    pub const ALL: [Self; 3] = [Self::Srgb, Self::Aces, Self::Reinhard];

    /// Its name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Srgb => "srgb",
            Self::Aces => "aces",
            Self::Reinhard => "reinhard",
        }
    }

    /// The tone map of that name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|tonemap| tonemap.name() == name)
    }

    /// The curve: linear in, linear out; the result still has to be clipped to 0…1.
    fn curve(self, x: Vec3) -> Vec3 {
        match self {
            Self::Srgb => x,
            Self::Aces => x * (x * 2.51 + 0.03) / (x * (x * 2.43 + 0.59) + 0.14),
            Self::Reinhard => x / (1.0 + x.dot(Vec3::new(0.2126, 0.7152, 0.0722))),
        }
    }
}

impl fmt::Display for ToneMap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The sRGB transfer function of a value in 0…1.
fn encode_srgb(x: f32) -> f32 {
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

/// What a screen shows for `radiance` at an exposure of `exposure_ev` stops.
pub fn to_srgb8(radiance: Vec3, exposure_ev: f32, tonemap: ToneMap) -> [u8; 3] {
    let exposed = radiance * exposure_ev.exp2();
    // `max` drops a NaN where `clamp` would keep it.
    #[expect(clippy::manual_clamp)]
    let finite = exposed.to_array().map(|x| x.max(0.0).min(BRIGHTEST));
    tonemap.curve(Vec3::from_array(finite)).to_array().map(|x| (255.0 * encode_srgb(x.clamp(0.0, 1.0))).round() as u8)
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
            assert_eq!(to_srgb8(Vec3::splat(f32::INFINITY), 0.0, tonemap), [255; 3]);
            assert_eq!(to_srgb8(Vec3::splat(f32::NAN), 0.0, tonemap), [0; 3]);
        }
    }

    #[test]
    fn names_round_trip() {
        for tonemap in ToneMap::ALL {
            assert_eq!(ToneMap::parse(tonemap.name()), Some(tonemap));
        }
        assert_eq!(ToneMap::parse("agx"), None);
    }
}
