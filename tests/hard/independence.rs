//! The light's and the eye's walk of a sample know nothing of each other.

use crate::lab::{LEVEL, each_sample, job};
use crate::scenes;
use crate::stats::z_limit;
use bdpt_explorer::bdpt::{Settings, Subpath};
use bdpt_explorer::rng::Sampler;

/// What is looked at of a walk: the place of its second and third vertex.
type Traits = [f64; 6];

/// Of a sample's light walk and eye walk, where they are long enough.
type Walks = (Option<Traits>, Option<Traits>);

fn traits(walk: &Subpath) -> Option<Traits> {
    let [a, b] = [walk.vertices.get(1)?.position, walk.vertices.get(2)?.position];
    Some([a.x, a.y, a.z, b.x, b.y, b.z].map(f64::from))
}

/// The largest |r| √n over pairs of traits: about the largest of so many standard normal numbers where they are independent.
fn correlation(rows: &[(Traits, Traits)]) -> f64 {
    let n = rows.len() as f64;
    let moments = |values: &dyn Fn(usize) -> f64| {
        let mean = (0..rows.len()).map(values).sum::<f64>() / n;
        let deviation = ((0..rows.len()).map(|i| (values(i) - mean).powi(2)).sum::<f64>() / n).sqrt();
        (mean, deviation)
    };
    let mut largest = 0.0f64;
    for (a, b) in (0..6).flat_map(|a| (0..6).map(move |b| (a, b))) {
        let ((mean_a, dev_a), (mean_b, dev_b)) = (moments(&|i| rows[i].0[a]), moments(&|i| rows[i].1[b]));
        let covariance = rows.iter().map(|(x, y)| (x[a] - mean_a) * (y[b] - mean_b)).sum::<f64>() / n;
        largest = largest.max((covariance / (dev_a * dev_b).max(1e-12)).abs() * n.sqrt());
    }
    largest
}

/// Would have caught: one sequence of numbers for both walks, so that E[α^L α^E] is not E[α^L] E[α^E] (LuxCore 32eba928e, 0611fa081).
#[test]
fn light_and_eye_walks_are_uncorrelated() {
    let scene = scenes::furnace(1.0, 0.7);
    let walks = |seed: u32, sampler: Sampler| {
        let mut walks: Vec<Walks> = Vec::new();
        let settings = Settings { max_edges: 3, roulette: false, seed, sampler, ..Settings::default() };
        each_sample(&job(&scene, [64, 64], settings), 40_000, |_, sample| walks.push((traits(&sample.light), traits(&sample.eye))));
        walks
    };
    let limit = z_limit(LEVEL, 2 * 2 * 36);
    let pairs =
        |of: &[Walks], with: &[Walks]| -> Vec<(Traits, Traits)> { of.iter().zip(with).filter_map(|(a, b)| Some((a.0?, b.1?))).collect() };
    for sampler in Sampler::ALL {
        let (own, other) = (walks(1, sampler), walks(2, sampler));
        // Of one sample, and of samples of the same place under neighbouring seeds.
        for (rows, what) in [(pairs(&own, &own), "one sample"), (pairs(&own, &other), "two seeds")] {
            let found = correlation(&rows);
            println!("{sampler:?}, {what}: {} pairs of walks, largest r√n {found:.2} of {limit:.2}", rows.len());
            assert!(rows.len() > 30_000 && found < limit, "{sampler:?}, {what}: {found}");
        }
        // Negative control: the light walk's numbers reach the eye's in one sample of twenty.
        let mut mixed = pairs(&own, &own);
        mixed.iter_mut().step_by(20).for_each(|(light, eye)| *eye = *light);
        assert!(correlation(&mixed) > limit, "{}", correlation(&mixed));
    }
}
