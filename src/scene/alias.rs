//! Choosing one of many by their weights in constant time (Walker 1977, Vose 1991): pick a cell, keep it or take its alias.
//!
//! ```text
//! P(i) = ( threshold_i + Σ_{other_j = i} (1 − threshold_j) ) / N          N = number of cells, a power of two
//! ```
//!
//! Random numbers have 24 bits. N is a power of two and every threshold a multiple of 2⁻²⁴, so the table chooses with exactly
//! the probabilities that [`AliasTable::new`] returns: what is a density elsewhere is what happens here, to the last bit.

use crate::math::Vec2;
use crate::shared_struct;

/// Most cells a table may have: more could not be told apart by 24 bits.
pub const MAX_CELLS: usize = 1 << 24;

shared_struct! {
    /// One cell.
    pub struct AliasCell {
        /// Below it, the cell's own number is chosen.
        pub threshold: f32,
        /// Otherwise this one.
        pub other: u32,
    }
}

/// The table.
#[derive(Clone, Debug, Default)]
pub struct AliasTable {
    /// Its cells; their number is a power of two, or 0.
    pub cells: Vec<AliasCell>,
}

impl AliasTable {
    /// A table for these weights (finite, ≥ 0, not all 0, at most [`MAX_CELLS`]), and the probability of each index. A
    /// positive weight never has probability 0.
    pub fn new(weights: &[f64]) -> (Self, Vec<f32>) {
        const UNIT: f64 = MAX_CELLS as f64;
        let sum: f64 = weights.iter().sum();
        let n = weights.len().next_power_of_two();
        // Mean 1 over the cells; what is above gives to what is below.
        let mut mass: Vec<f64> = weights.iter().map(|w| w / sum * n as f64).collect();
        mass.resize(n, 0.0);
        let mut cells: Vec<AliasCell> = (0..n as u32).map(|other| AliasCell { threshold: 1.0, other }).collect();
        let (mut small, mut large): (Vec<usize>, Vec<usize>) = (0..n).partition(|&i| mass[i] < 1.0);
        while let (Some(&poor), Some(&rich)) = (small.last(), large.last()) {
            small.pop();
            let threshold = (mass[poor] * UNIT).ceil() / UNIT;
            cells[poor] = AliasCell { threshold: threshold as f32, other: rich as u32 };
            mass[rich] -= 1.0 - threshold;
            if mass[rich] < 1.0 {
                large.pop();
                small.push(rich);
            }
        }
        // Rounding may leave some of either kind: the large ones keep their whole cell; a small one of weight 0 must not.
        let heaviest = (0..weights.len()).max_by(|&a, &b| weights[a].total_cmp(&weights[b])).unwrap_or(0);
        for &i in small.iter().filter(|&&i| i >= weights.len() || weights[i] == 0.0) {
            cells[i] = AliasCell { threshold: 0.0, other: heaviest as u32 };
        }
        let mut pmf = vec![0.0f64; n];
        for (i, cell) in cells.iter().enumerate() {
            pmf[i] += f64::from(cell.threshold);
            pmf[cell.other as usize] += 1.0 - f64::from(cell.threshold);
        }
        (Self { cells }, pmf[..weights.len()].iter().map(|p| (p / n as f64) as f32).collect())
    }

    /// An index, by two numbers in [0, 1); 0 if the table is empty.
    #[inline]
    pub fn choose(&self, u: Vec2) -> u32 {
        // Exact: the number of cells is a power of two.
        let index = (u.x * self.cells.len() as f32) as u32;
        match self.cells.get(index as usize) {
            Some(cell) if u.y >= cell.threshold => cell.other,
            _ => index,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Counts every one of the table's 2²⁴ equally likely outcomes per cell.
    fn realised(table: &AliasTable, count: usize) -> Vec<f64> {
        let mut mass = vec![0.0; count];
        let n = table.cells.len();
        for (i, cell) in table.cells.iter().enumerate() {
            let own = (f64::from(cell.threshold) * MAX_CELLS as f64) as u32;
            assert_eq!(own as f32 / MAX_CELLS as f32, cell.threshold, "a multiple of 2⁻²⁴");
            let u = |k: u32| Vec2::new(i as f32 / n as f32, k as f32 / MAX_CELLS as f32);
            if own > 0 {
                mass[table.choose(u(own - 1)) as usize] += f64::from(cell.threshold);
            }
            if (own as usize) < MAX_CELLS {
                mass[table.choose(u(own)) as usize] += 1.0 - f64::from(cell.threshold);
            }
        }
        mass.iter().map(|m| m / n as f64).collect()
    }

    #[test]
    fn probabilities_are_what_the_table_does_and_what_was_asked() {
        let cases: [Vec<f64>; 6] = [
            vec![1.0],
            vec![1.0, 3.0],
            vec![0.0, 0.0, 1.0],
            vec![1e-12, 1.0, 5.0],
            (0..1000).map(|i| f64::from(i % 7)).collect(),
            (0..10_000).map(|i| f64::from(i * 7919 % 10_007).powi(3)).collect(),
        ];
        for weights in cases {
            let (table, pmf) = AliasTable::new(&weights);
            let (sum, n) = (weights.iter().sum::<f64>(), table.cells.len() as f64);
            for ((p, exact), w) in pmf.iter().zip(realised(&table, weights.len())).zip(&weights) {
                assert!((f64::from(*p) - exact).abs() <= 1e-7 * exact, "{p} {exact}");
                assert_eq!(*w > 0.0, *p > 0.0);
                // Each of the n thresholds is rounded up by at most 2⁻²⁴.
                assert!((exact - w / sum).abs() <= 6e-8 * (1.0 + weights.len() as f64 / n), "{exact} {}", w / sum);
            }
        }
    }
}
