//! Where a number is on a linear or a logarithmic scale, for false colours ([`super::colourmap`]).

/// A logarithmic scale spans no more than this: 10⁶.
const DECADES: f32 = 1e6;

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
