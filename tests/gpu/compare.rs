//! Inputs for tables, and how far two renderers' numbers lie apart.

use bdpt_explorer::math::{Vec2, Vec3, sample_sphere};
use bdpt_explorer::rng::SampleId;

/// Four numbers in [0, 1), the i-th of a stream.
pub fn random(stream: u32, i: usize) -> [f32; 4] {
    SampleId { x: 0, y: 0, sample: i as u32, seed: stream, ..SampleId::default() }.numbers(0)
}

/// A unit vector.
pub fn direction(stream: u32, i: usize) -> Vec3 {
    let [x, y, ..] = random(stream, i);
    sample_sphere(Vec2::new(x, y)).normalize()
}

/// The largest difference seen of one quantity, in units of f32's epsilon (1.2·10⁻⁷, an ulp of 1).
#[derive(Debug)]
pub struct Worst {
    name: &'static str,
    /// What a device may differ by that keeps to WGSL's accuracies, in the same units.
    bound: f32,
    largest: f32,
    at: String,
    count: usize,
    differ: usize,
}

impl Worst {
    pub fn new(name: &'static str, bound: f32) -> Self {
        Self { name, bound, largest: 0.0, at: String::new(), count: 0, differ: 0 }
    }

    /// Differences as parts of the largest component.
    pub fn relative(&mut self, gpu: &[f32], cpu: &[f32]) {
        let scale = cpu.iter().fold(0.0f32, |most, x| most.max(x.abs()));
        self.within(gpu, cpu, scale);
    }

    /// Differences as parts of `scale`.
    pub fn within(&mut self, gpu: &[f32], cpu: &[f32], scale: f32) {
        assert_eq!(gpu.len(), cpu.len());
        self.count += 1;
        self.differ += usize::from(gpu != cpu);
        for (a, b) in gpu.iter().zip(cpu) {
            // The same number (0 = −0, ∞ = ∞), or not.
            let error = if a == b { 0.0 } else { (a - b).abs() / (f32::EPSILON * scale) };
            if error.is_nan() || error > self.largest {
                self.largest = if error.is_nan() { f32::INFINITY } else { error };
                self.at = format!("row {}: {gpu:?} on the device, {cpu:?} here", self.count - 1);
            }
        }
    }

    /// Bits must be the same.
    pub fn exact(&mut self, gpu: &[u32], cpu: &[u32]) {
        self.count += 1;
        if gpu != cpu {
            self.differ += 1;
            self.largest = f32::INFINITY;
            self.at = format!("row {}: {gpu:x?} on the device, {cpu:x?} here", self.count - 1);
        }
    }

    /// Was nothing compared?
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Is every difference within the bound?
    pub fn holds(&self) -> bool {
        self.count > 0 && self.largest <= self.bound
    }

    /// Says what was seen, and fails if it was too much.
    pub fn finish(&self) {
        let Self { name, bound, largest, count, differ, .. } = self;
        println!("{name}: {count} inputs, {differ} not the same, largest difference {largest:.2} of {bound} ε");
        assert!(self.holds(), "{name}: {largest} ε, {}", self.at);
    }
}
