//! A session's film as one that can be added to others, and all that its samples depend on.

use super::{Crop, Job, Session};
use crate::bdpt::record::RECORD_VERSION;
use crate::bdpt::render::{IMAGE, LayerId};
use crate::bdpt::{HeuristicKind, Settings, Strategy, StrategySet};
use crate::film::runs::Runs;
use crate::film::save::Window;
use crate::film::sums::{About, Facts, SCENE, Sums};

impl Job {
    /// The pixels that are wanted.
    pub fn window(&self) -> Window {
        Window { film: self.size, rect: self.crop.unwrap_or(Crop::full(self.size)) }
    }

    /// What the samples of the picture that `shown` add up to depend on, but for their numbers and the window: by name, as text.
    /// Jobs with equal facts sample the same integral the same way.
    pub fn facts(&self, shown: &[Strategy]) -> Facts {
        let settings = &self.settings;
        let mut facts = Facts::new();
        let mut say = |name: &str, value: String| drop(facts.insert(name.to_owned(), value));
        self.scene.digests().iter().for_each(|(part, digest)| say(&format!("{SCENE}{part}"), digest.to_string()));
        // Of the scene, as the others: it is named first.
        say(&format!("{SCENE}cameras"), self.posed_camera().digest().to_string());
        let lens = self.lens();
        let pinhole = lens.radius == 0.0;
        say("lens", if pinhole { "pinhole".to_owned() } else { format!("{:?} m, focus {:?} m", lens.radius, lens.focus_distance) });
        say("estimator", RECORD_VERSION.to_string());
        say("max-edges", settings.max_edges.to_string());
        say("sampler", settings.sampler.name().to_owned());
        let heuristic = &settings.heuristic;
        say("heuristic", heuristic.kind.name().to_owned());
        match heuristic.kind {
            HeuristicKind::Power => say("beta", format!("{:?}", heuristic.beta)),
            HeuristicKind::Cutoff => say("cutoff", format!("{:?}", heuristic.cutoff)),
            _ => {}
        }
        let switch = |on: bool| if on { "on" } else { "off" }.to_owned();
        say("roulette", switch(settings.roulette));
        say("light-subpaths", settings.light_subpaths.to_string());
        say("fresh-ends", switch(settings.fresh_ends));
        let active =
            |strategies: StrategySet| -> Vec<Strategy> { self.existence().active(&Settings { strategies, ..*settings }).collect() };
        let own = active(settings.strategies);
        let families = [("bdpt", StrategySet::ALL), ("pt", StrategySet::path_tracer()), ("lt", StrategySet::light_tracer())];
        let family = families.into_iter().find(|(_, set)| active(*set) == own);
        say("integrator", family.map_or("bdpt", |(name, _)| name).to_owned());
        say("strategies", family.map_or_else(|| listed(&own), |_| "all".to_owned()));
        say("shown", if shown == own { "all".to_owned() } else { listed(shown) });
        facts
    }
}

fn listed(strategies: &[Strategy]) -> String {
    strategies.iter().map(Strategy::to_string).collect::<Vec<_>>().join(",")
}

impl Session {
    /// The sums of the picture that `shown` add up to; `runs`: the seeds whose whole passes are in the film. (Where strategies
    /// are not shown, their images are needed apart.)
    pub fn sums(&self, shown: &[Strategy], runs: Runs) -> Sums {
        let (film, plan) = self.parts();
        let job = self.job();
        let all = plan.strategies().count() == shown.len();
        let layers: Vec<LayerId> =
            if all { IMAGE.to_vec() } else { shown.iter().filter_map(|&strategy| plan.layer(strategy, true)).collect() };
        let window = job.window();
        let Crop { x, y, width, height } = window.rect;
        let pixels = (y..y + height).flat_map(|y| (x..x + width).map(move |x| y as usize * job.size[0] as usize + x as usize));
        let values = pixels.map(|pixel| {
            let sums = layers.iter().map(|layer| layer.sum(film, pixel));
            sums.fold([0.0; 3], |[r, g, b], [dr, dg, db]| [r + dr, g + dg, b + db])
        });
        Sums { values: values.collect(), about: About::new(job.scene.name.clone(), window, job.facts(shown), runs) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bdpt::Heuristic;
    use crate::rng::Sampler;
    use crate::scene::{Lens, builtin};
    use std::sync::Arc;

    fn shown(job: &Job) -> Vec<Strategy> {
        job.existence().active(&job.settings).collect()
    }

    /// The facts in which two jobs differ.
    fn differing(a: &Job, b: &Job) -> Vec<String> {
        let (a, b) = (a.facts(&shown(a)), b.facts(&shown(b)));
        let names: std::collections::BTreeSet<_> = a.keys().chain(b.keys()).collect();
        names.into_iter().filter(|name| a.get(*name) != b.get(*name)).cloned().collect()
    }

    #[test]
    fn what_the_image_depends_on_is_a_fact_and_what_it_does_not_is_none() {
        let job = Job::new(Arc::new(builtin::open("cornell").unwrap()));
        let with = |change: &dyn Fn(&mut Settings)| {
            let mut changed = job.clone();
            change(&mut changed.settings);
            differing(&job, &changed)
        };
        assert_eq!(with(&|_| {}), [""; 0]);
        assert_eq!(with(&|x| x.seed = 7), [""; 0], "a seed is no setting");
        assert_eq!(with(&|x| x.sampler = Sampler::Sobol), ["sampler"]);
        assert_eq!(with(&|x| x.max_edges = 5), ["max-edges"]);
        assert_eq!(with(&|x| x.roulette = false), ["roulette"]);
        assert_eq!(with(&|x| x.fresh_ends = false), ["fresh-ends"]);
        assert_eq!(with(&|x| x.light_subpaths = 2), ["light-subpaths"]);
        assert_eq!(with(&|x| x.heuristic.beta = 3.0), ["beta"]);
        assert_eq!(with(&|x| x.heuristic.cutoff = 0.5), [""; 0], "the power heuristic has no threshold");
        let heuristic = |kind| move |x: &mut Settings| x.heuristic = Heuristic { kind, ..x.heuristic };
        assert_eq!(with(&heuristic(HeuristicKind::Max)), ["beta", "heuristic"]);
        assert_eq!(with(&heuristic(HeuristicKind::Cutoff)), ["beta", "cutoff", "heuristic"]);
        assert_eq!(with(&|x| x.strategies = StrategySet::path_tracer()), ["integrator"]);
        assert_eq!(with(&|x| x.strategies.set(Strategy::new(2, 2), false)), ["strategies"]);
        // The same strategies, said in another way; a pinhole cannot be hit.
        assert_eq!(with(&|x| x.strategies.set(Strategy::new(2, 0), false)), [""; 0]);
        let lens = |radius, focus_distance| Job { lens: Some(Lens { radius, focus_distance }), ..job.clone() };
        assert_eq!(differing(&job, &lens(0.0, 7.0)), [""; 0], "a pinhole has no focus");
        assert_eq!(differing(&job, &lens(0.01, 1.0)), ["lens"]);
        assert_eq!(differing(&lens(0.01, 1.0), &lens(0.01, 1.5)), ["lens"]);
        let whole = job.facts(&shown(&job));
        let part = job.facts(&[Strategy::new(1, 2)]);
        assert!(whole["shown"] == "all" && part["shown"] == "s1t2");
        let other = Job::new(Arc::new(builtin::open("furnace").unwrap()));
        assert!(differing(&job, &other).iter().all(|name| name.starts_with(SCENE)));
    }
}
