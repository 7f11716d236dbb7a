//! The tables of a comparison as CSV (RFC 4180; heads with units): every point of every seed, what is said of the methods, and the
//! strategies. A script finds the same numbers here as a reader in the report, with all their digits.

use super::stats::Interval;
use super::summary::{Moment, Row, Slope};
use super::{MethodResult, Point, SceneResult};
use crate::report::export::csv::Table;
use crate::report::role_name;

fn head(table: &mut Table, names: &[&str]) {
    names.iter().for_each(|name| table.field(name));
    table.end();
}

fn method(table: &mut Table, scene: &SceneResult, result: &MethodResult) {
    let method = result.method;
    let names = [method.integrator.name(), method.heuristic.name(), method.backend.name(), method.sampler.name()];
    [&[scene.scene.as_str()][..], &names].concat().iter().for_each(|x| table.field(x));
}

/// Mean and half the 95 % interval.
fn interval(table: &mut Table, value: Option<Interval>) {
    table.maybe(value.map(|value| value.mean));
    table.maybe(value.and_then(|value| value.half));
}

/// Every point: a line each.
pub fn points_csv(scenes: &[SceneResult]) -> String {
    let mut table = Table::default();
    let names = ["scene", "integrator", "heuristic", "backend", "sampler", "seed", "moment", "spp", "cpu_time [s]", "wall_time [s]"];
    head(&mut table, &[&names[..], &["relmse", "relmse_trimmed", "top_share", "reference_noise"]].concat());
    for scene in scenes {
        for result in &scene.methods {
            for run in &result.runs {
                let curve = run.curve.iter().map(|point| ("curve", point));
                for (moment, point) in curve.chain([(Moment::EqualTime.names()[1], &run.timed)]) {
                    method(&mut table, scene, result);
                    table.field(run.seed);
                    table.field(moment);
                    of_point(&mut table, point);
                    table.maybe(scene.reference.noise);
                    table.end();
                }
            }
        }
    }
    table.text
}

fn of_point(table: &mut Table, point: &Point) {
    table.field(point.spp);
    [point.cpu, point.wall, point.error.all, point.error.trimmed, point.error.top_share].iter().for_each(|x| table.field(x));
}

/// What is said of the methods: two lines each.
pub fn summary_csv(scenes: &[SceneResult]) -> String {
    let mut table = Table::default();
    let names =
        ["scene", "integrator", "heuristic", "backend", "sampler", "moment", "clock", "seeds", "spp", "cpu_time [s]", "wall_time [s]"];
    let errors = ["relmse", "relmse_half", "relmse_trimmed", "relmse_trimmed_half", "reference_noise", "relmse_less_noise"];
    let costs = ["ln(relmse*time/s)", "ln(relmse*time/s)_half", "slope", "slope_half", "slope_trimmed", "slope_trimmed_half"];
    head(&mut table, &[&names[..], &errors, &costs, &["slope_less_noise", "slope_less_noise_half", "slope_reason"]].concat());
    for scene in scenes {
        for result in &scene.methods {
            let slope = Slope::of(scene, result);
            for moment in Moment::ALL {
                let Some(row) = Row::of(scene, result, moment) else { continue };
                method(&mut table, scene, result);
                table.field(moment.names()[1]);
                table.field(scene.clock.name());
                table.field(row.seeds);
                [row.spp, row.cpu, row.wall].iter().for_each(|x| table.field(x));
                interval(&mut table, row.error);
                interval(&mut table, row.trimmed);
                table.maybe(scene.reference.noise);
                table.maybe(row.less_noise);
                [row.log_cost, slope.all, slope.trimmed, slope.less_noise].iter().for_each(|x| interval(&mut table, *x));
                table.maybe(slope.reason.as_deref());
                table.end();
            }
        }
    }
    table.text
}

/// The strategies: a line each.
pub fn strategies_csv(scenes: &[SceneResult]) -> String {
    let mut table = Table::default();
    let names =
        ["scene", "heuristic", "sampler", "s", "t", "role", "energy_share", "variance", "variance_share", "cost [us]", "shadow_rays"];
    head(&mut table, &[&names[..], &["efficiency [1/s]", "image_variance", "walk_cost [us]"]].concat());
    for scene in scenes {
        for study in &scene.studies {
            let sum = study.summed_variance();
            for figures in &study.strategies {
                let method = study.method;
                [scene.scene.as_str(), method.heuristic.name(), method.sampler.name()].iter().for_each(|x| table.field(x));
                [figures.strategy.s, figures.strategy.t].iter().for_each(|x| table.field(x));
                table.field(role_name(figures.strategy));
                let share = if sum > 0.0 { figures.variance / sum } else { 0.0 };
                [figures.share, figures.variance, share, 1e6 * figures.cost, figures.shadow_rays].iter().for_each(|x| table.field(x));
                table.maybe(figures.efficiency());
                [study.image_variance, 1e6 * study.walk_cost].iter().for_each(|x| table.field(x));
                table.end();
            }
        }
    }
    table.text
}

#[cfg(test)]
mod tests {
    use super::super::summary::tests::scene;
    use super::*;

    #[test]
    fn every_line_has_as_many_fields_as_the_head() {
        let scenes = [scene(Some(0.01), |seed, n| (1.0 + 0.01 * f64::from(seed)) / n), scene(None, |_, _| 0.0)];
        for (text, lines) in [(points_csv(&scenes), 121), (summary_csv(&scenes), 5), (strategies_csv(&scenes), 1)] {
            assert_eq!(text.matches("\r\n").count(), lines, "{text}");
            // The scene's name holds a comma and quotes.
            let plain = text.replace("\"made up, \"\"<scene>\"\"\"", "name");
            let fields: Vec<usize> = plain.lines().map(|line| line.matches(',').count()).collect();
            assert!(!plain.contains('"') && fields.iter().all(|count| *count == fields[0]), "{plain}");
        }
    }
}
