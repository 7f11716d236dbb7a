//! Numbers as colours: Viridis over a linear or a logarithmic scale.
//!
//! Viridis is by Nathaniel Smith and Stéfan van der Walt, published with matplotlib under CC0: equal steps look equal, darker is
//! less, and it is told apart by everybody. The table holds 33 of its colours, and a line is drawn between them.

/// Viridis at 0, 1/32, … 1; 0xRRGGBB.
const VIRIDIS: [u32; 33] = [
    0x440154, 0x470d60, 0x48186a, 0x482374, 0x472d7b, 0x453681, 0x424086, 0x3f4989, 0x3b528b, 0x375a8d, 0x33638d, 0x2f6a8e, 0x2c728e,
    0x297a8e, 0x26818e, 0x23898e, 0x21908c, 0x1f988b, 0x1f9f88, 0x21a685, 0x28ae80, 0x31b57b, 0x3ebc74, 0x4cc26c, 0x5dc963, 0x6ece58,
    0x82d34c, 0x96d83f, 0xabdc32, 0xc0df24, 0xd5e21a, 0xeae51a, 0xfde725,
];
/// A logarithmic scale spans no more than this: 10⁶.
const DECADES: f32 = 1e6;

/// The colour at `place`, 0…1 (beyond it: the end's).
pub fn viridis(place: f32) -> [u8; 3] {
    let steps = (VIRIDIS.len() - 1) as f32;
    // `max` drops a NaN.
    #[expect(clippy::manual_clamp)]
    let at = (place.max(0.0).min(1.0)) * steps;
    let first = (at as usize).min(VIRIDIS.len() - 2);
    let (a, b, part) = (VIRIDIS[first], VIRIDIS[first + 1], at - first as f32);
    [16, 8, 0].map(|shift| {
        let channel = |colour: u32| (colour >> shift & 0xff) as f32;
        (channel(a) + part * (channel(b) - channel(a))).round() as u8
    })
}

/// Where numbers are on a scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// The number at its lower end.
    pub low: f32,
    /// The number at its upper end.
    pub high: f32,
    /// Equal steps are equal factors.
    pub log: bool,
}

impl Scale {
    /// A linear scale of these numbers.
    pub fn linear([low, high]: [f32; 2]) -> Self {
        Self { low, high, log: false }
    }

    /// A logarithmic scale up to `high`, down to `low` or a millionth of it; `None` if nothing is above 0.
    pub fn logarithmic([low, high]: [f32; 2]) -> Option<Self> {
        (high > 0.0 && high.is_finite()).then(|| Self { low: low.max(high / DECADES).max(f32::MIN_POSITIVE), high, log: true })
    }

    /// Where a number is, 0…1; beyond the ends: there. `None` if it is no finite number.
    pub fn place(&self, value: f32) -> Option<f32> {
        if !value.is_finite() {
            return None;
        }
        let Self { low, high, log } = *self;
        let place = match log {
            true => (value.max(low) / low).ln() / (high / low).ln(),
            false => (value - low) / (high - low),
        };
        // A scale without extent: all of it is its upper end.
        Some(if place.is_finite() { place.clamp(0.0, 1.0) } else { 1.0 })
    }

    /// The number at a place.
    pub fn value(&self, place: f32) -> f32 {
        let Self { low, high, log } = *self;
        if log { low * (high / low).powf(place) } else { low + (high - low) * place }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_colours() {
        // Entries 20, 77, 137 and 201 of the 256 that matplotlib has.
        for (index, colour) in [(0, [68, 1, 84]), (20, [72, 29, 111]), (77, [52, 96, 141]), (137, [31, 153, 138]), (201, [115, 208, 86])] {
            let ours = viridis(index as f32 / 255.0);
            assert!(ours.iter().zip(colour).all(|(a, b): (&u8, u8)| a.abs_diff(b) <= 2), "{index}: {ours:?}");
        }
        assert_eq!([viridis(f32::NAN), viridis(-1.0), viridis(2.0)], [[68, 1, 84], [68, 1, 84], [253, 231, 37]]);
    }

    #[test]
    fn brighter_is_more() {
        let luminance = |place: f32| viridis(place).iter().zip([0.2126, 0.7152, 0.0722]).map(|(&c, k)| f32::from(c) * k).sum::<f32>();
        assert!((0..=64).map(|i| luminance(i as f32 / 64.0)).is_sorted());
    }

    #[test]
    fn numbers_have_their_places() {
        let linear = Scale::linear([2.0, 6.0]);
        assert_eq!([2.0, 3.0, 6.0, 9.0, 0.0].map(|v| linear.place(v)), [Some(0.0), Some(0.25), Some(1.0), Some(1.0), Some(0.0)]);
        let log = Scale::logarithmic([0.01, 100.0]).unwrap_or_else(|| panic!("a scale"));
        assert!((log.place(1.0).unwrap_or(0.0) - 0.5).abs() < 1e-6 && (log.value(0.5) - 1.0).abs() < 1e-5);
        assert_eq!([log.place(0.0), log.place(f32::NAN), log.place(f32::INFINITY)], [Some(0.0), None, None]);
        assert_eq!(Scale::logarithmic([0.0, 0.0]), None);
        assert_eq!(Scale::logarithmic([0.0, 1.0]).map(|scale| scale.low), Some(1e-6));
        assert_eq!(Scale::linear([3.0, 3.0]).place(3.0), Some(1.0), "a scale without extent");
    }
}
