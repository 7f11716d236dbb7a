//! A logarithmic axis of a plot: where numbers lie on it, and which of them stand there.

/// A logarithmic axis.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    /// log₁₀ of its lower end.
    pub low: f64,
    /// The same of its upper end.
    pub high: f64,
}

impl Axis {
    /// An axis that holds these values, with some room.
    pub fn over(values: impl Iterator<Item = f64>) -> Self {
        let logs = values.filter(|x| *x > 0.0 && x.is_finite()).map(f64::log10);
        let (low, high) = logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        if low > high { Self { low: 0.0, high: 1.0 } } else { Self { low: low - 0.1, high: high + 0.1 } }
    }

    /// 0…1 along it.
    pub fn place(self, value: f64) -> f64 {
        (value.log10() - self.low) / (self.high - self.low)
    }

    /// Where numbers stand: at every power of ten, and at 2 and 5 between them where these are few.
    pub fn ticks(self) -> Vec<f64> {
        let wide = self.high - self.low > 2.5;
        let steps: &[f64] = if wide { &[1.0] } else { &[1.0, 2.0, 5.0] };
        let decades = (self.low.floor() as i32)..=(self.high.ceil() as i32);
        let all = decades.flat_map(|decade| steps.iter().map(move |step| step * 10f64.powi(decade)));
        all.filter(|tick| (0.0..=1.0).contains(&self.place(*tick))).collect()
    }
}

/// A tick's number.
pub fn label(value: f64) -> String {
    // A power of ten that lies a little below itself counts as one.
    let decade = (value.log10() + 1e-9).floor() as i32;
    if (-3..4).contains(&decade) { format!("{value:.*}", (-decade).max(0) as usize) } else { format!("{value:.0e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_numbers_inside() {
        let axis = Axis::over([1.0, 64.0].into_iter());
        assert_eq!(axis.ticks(), [1.0, 2.0, 5.0, 10.0, 20.0, 50.0]);
        let wide = Axis::over([1e-4, 0.3].into_iter());
        assert_eq!(wide.ticks().iter().map(|tick| label(*tick)).collect::<Vec<_>>(), ["1e-4", "0.001", "0.01", "0.1"]);
        assert_eq!(Axis::over([0.0, f64::NAN].into_iter()).ticks().len(), 4, "nothing to show is no reason to fail");
    }
}
