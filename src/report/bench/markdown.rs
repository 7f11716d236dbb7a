//! The report of a comparison for people: Markdown, with what is measured before what was found, and for every table and figure the
//! command and the date.

use super::plot::Along;
use super::stats::Interval;
use super::strategies::Study;
use super::summary::{Moment, Row, SLOPE_TOLERANCE, Slope, TOLERABLE_NOISE};
use super::{MethodResult, SceneResult};
use crate::report::export::svg_parts::number;
use crate::report::role_name;
use std::fmt::Write;
use web_time::{SystemTime, UNIX_EPOCH};

/// Where and how it was measured.
#[derive(Clone, Debug)]
pub struct Origin {
    /// The machine, in words.
    pub machine: String,
    /// The command line.
    pub command: String,
    /// The day, UTC.
    pub date: String,
    /// Was it stopped before all was done?
    pub stopped: bool,
}

impl Origin {
    /// "date, command", for below a figure.
    pub fn line(&self) -> String {
        format!("{}, {}", self.date, self.command)
    }
}

/// A moment's date, UTC: "2026-11-28".
pub fn date(moment: SystemTime) -> String {
    let days = moment.duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs() / 86_400);
    // From days to the date (Howard Hinnant's algorithm): years begin in March, and 400 of them have 146 097 days.
    let z = days + 719_468;
    let (era, day_of_era) = (z / 146_097, z % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    let year = year_of_era + 400 * era + u64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02}")
}

/// The report.
pub fn report(scenes: &[SceneResult], origin: &Origin) -> String {
    let mut text = format!("# Speed against error\n\n{}\n\n```\n{}\n```\n\n", origin.date, origin.command);
    let _ = writeln!(text, "Machine: {}.\n", origin.machine);
    if origin.stopped {
        text += "**Stopped before all was measured.** What follows was finished; every row says of how many seeds.\n\n";
    }
    text += DEFINITIONS;
    for scene in scenes {
        scene_section(&mut text, scene, origin);
    }
    text
}

const DEFINITIONS: &str = "\
- **relMSE**: mean over pixels and channels of (a − b)²/(b² + 0.01), b the reference; *trimmed*: without the 0.1 % of the pixels where it is
  largest. Mean over the seeds ± 95 % interval (Student's t); the reference is the same for all seeds, so its noise is in no interval.
- **less noise**: relMSE less the reference's own noise: the error, unbiased while that noise is small beside 1. It is not used in any other column. **noise**: the
  reference's noise as a part of relMSE; ⚠ where that is more than 10 %, or not known.
- **ln(relMSE · time)**: natural logarithm, time in seconds, per seed; mean ± 95 % interval. Lower is better; a difference of 0.69 is a factor of 2.
- **slope** of log relMSE over log samples, 1 sample to the last: least squares per seed, mean ± 95 % interval over the seeds. −1 ± 0.05, or
  the reason.
- Time is that of rendering alone, without loading the scene and comparing pictures: CPU time is user + system, all threads.
- *Equal samples* and *equal time* are read off the same renderings; equal time ends with the pass in which the budget is reached.
- `points.csv`, `summary.csv` and `strategies.csv` hold the same numbers with all their digits.

";

/// A command and its date, below what they made.
fn made_by(text: &mut String, origin: &Origin) {
    let _ = writeln!(text, "<sub>{}, `{}`</sub>\n", origin.date, origin.command);
}

fn scene_section(text: &mut String, scene: &SceneResult, origin: &Origin) {
    let [width, height] = scene.size;
    let _ = writeln!(text, "## {}\n\n{width}×{height} pixels, K = {}, {} seeds wanted.\n", scene.scene, scene.max_edges, scene.seeds);
    let noise = scene.reference.noise.map_or("not known".to_owned(), |noise| format!("relMSE {}", number(noise)));
    let _ = writeln!(text, "Reference: {}. Its own noise: {noise}.\n", scene.reference.origin);
    for result in &scene.methods {
        for note in notes(result) {
            let _ = writeln!(text, "- {}: {note}", result.method.label());
        }
    }
    if !text.ends_with("\n\n") {
        text.push('\n');
    }
    for moment in Moment::ALL {
        rows(text, scene, moment, origin);
    }
    slopes(text, scene, origin);
    for along in Along::ALL {
        let _ = writeln!(text, "![{}: error against {}]({}-{}.svg)\n", scene.scene, along.name(), scene.stem, along.name());
        made_by(text, origin);
    }
    for study in &scene.studies {
        strategies(text, study, origin);
    }
}

/// What must be known of a method's figures.
fn notes(result: &MethodResult) -> Vec<String> {
    let mut notes = Vec::new();
    if let Some(why) = &result.refused {
        notes.push(format!("not measured, as it was not rendered where it should be: {why}"));
    }
    if !result.lost.is_empty() {
        let lost = result.lost.join(", ");
        notes.push(format!("light is missing: no strategy in use makes paths such as {lost}; its error holds that light"));
    }
    if result.left_out > 0 {
        notes.push(format!("{} contributions were no finite numbers or too bright to count, and were left out", result.left_out));
    }
    notes
}

fn rows(text: &mut String, scene: &SceneResult, moment: Moment, origin: &Origin) {
    let clock = scene.clock.name();
    let what = match moment {
        Moment::EqualSamples => format!("{} samples per pixel", scene.spp),
        Moment::EqualTime => format!("{} s of {clock} for each seed", number(scene.budget)),
    };
    let _ = writeln!(text, "### {}: {what}\n", moment.names()[0]);
    let _ = writeln!(
        text,
        "| method | seeds | samples per pixel | CPU time, s | wall-clock time, s | relMSE | trimmed | less noise | noise | ln(relMSE · {clock}/s) |"
    );
    text.push_str("|---|---|---|---|---|---|---|---|---|---|\n");
    for result in &scene.methods {
        let label = result.method.label();
        let Some(row) = Row::of(scene, result, moment) else {
            let _ = writeln!(text, "| {label} | 0 | – | – | – | – | – | – | – | – |");
            continue;
        };
        let share = row.noise_share.map_or("not known".to_owned(), |share| format!("{:.2} %", 100.0 * share));
        let warning = if row.is_doubtful() { " ⚠" } else { "" };
        let _ = writeln!(
            text,
            "| {label} | {} | {} | {} | {} | {} | {} | {} | {share}{warning} | {} |",
            row.seeds,
            plain(row.spp),
            number(row.cpu),
            number(row.wall),
            interval(row.error),
            interval(row.trimmed),
            row.less_noise.map_or("–".to_owned(), number),
            fixed(row.log_cost, 2)
        );
    }
    text.push('\n');
    if scene.methods.iter().filter_map(|result| Row::of(scene, result, moment)).any(|row| row.is_doubtful()) {
        let _ = writeln!(
            text,
            "⚠ The reference's noise is not known, or more than {} % of relMSE: take *less noise*, or a better reference.\n",
            100.0 * TOLERABLE_NOISE
        );
    }
    made_by(text, origin);
}

fn slopes(text: &mut String, scene: &SceneResult, origin: &Origin) {
    text.push_str("### Slopes\n\n| method | slope | of the trimmed relMSE | of relMSE less noise | −1 ± 0.05? |\n|---|---|---|---|---|\n");
    for result in &scene.methods {
        let slope = Slope::of(scene, result);
        let verdict = match (&slope.all, slope.reason) {
            (None, _) => "–".to_owned(),
            (Some(_), None) => "yes".to_owned(),
            (Some(_), Some(reason)) => format!("no: {reason}"),
        };
        let [all, trimmed, less] = [slope.all, slope.trimmed, slope.less_noise].map(|slope| fixed(slope, 3));
        let _ = writeln!(text, "| {} | {all} | {trimmed} | {less} | {verdict} |", result.method.label());
    }
    let _ = writeln!(text, "\nA slope within {SLOPE_TOLERANCE} of −1 counts as −1.\n");
    made_by(text, origin);
}

fn strategies(text: &mut String, study: &Study, origin: &Origin) {
    let [seeds, spp] = study.made_of;
    let _ = writeln!(text, "### Strategy by strategy: {}\n", study.method.label());
    let sum = study.summed_variance();
    let _ = writeln!(
        text,
        "Variance of one sample per pixel in relMSE's measure, of the weighted contribution, from {seeds} seeds of {spp} samples per pixel each. \
         Their sum is {}, that of the image {}: strategies share subpaths, and the difference is their covariances. Cost: time of one thread \
         for one try, timed by itself (ends, visibility, densities, weight); walking a pair of subpaths takes {} µs more, for all strategies \
         together. Efficiency: 1/(variance · cost); where a strategy has little to do it is large, so read it beside the share of the energy.\n",
        number(sum),
        number(study.image_variance),
        number(1e6 * study.walk_cost)
    );
    text.push_str(
        "| (s,t) | what it does | share of the energy | variance | share of Σ | cost, µs | visibility rays | efficiency, 1/s |\n",
    );
    text.push_str("|---|---|---|---|---|---|---|---|\n");
    for figures in &study.strategies {
        let x = figures.strategy;
        let share = if sum > 0.0 { figures.variance / sum } else { 0.0 };
        let _ = writeln!(
            text,
            "| ({},{}) | {} | {:.2} % | {} | {:.2} % | {} | {} | {} |",
            x.s,
            x.t,
            role_name(x),
            100.0 * figures.share,
            number(figures.variance),
            100.0 * share,
            number(1e6 * figures.cost),
            number(figures.shadow_rays),
            figures.efficiency().map_or("–".to_owned(), number)
        );
    }
    text.push('\n');
    made_by(text, origin);
}

/// Whole where it is whole.
fn plain(value: f64) -> String {
    if value.fract() == 0.0 { format!("{value:.0}") } else { format!("{value:.1}") }
}

fn interval(value: Option<Interval>) -> String {
    written(value, &number)
}

fn fixed(value: Option<Interval>, digits: usize) -> String {
    written(value, &|x| format!("{x:.digits$}"))
}

fn written(value: Option<Interval>, number: &dyn Fn(f64) -> String) -> String {
    match value {
        None => "–".to_owned(),
        Some(Interval { mean, half: None }) => number(mean),
        Some(Interval { mean, half: Some(half) }) => format!("{} ± {}", number(mean), number(half)),
    }
}

#[cfg(test)]
mod tests {
    use super::super::summary::tests::scene;
    use super::*;
    use std::time::Duration;

    fn origin() -> Origin {
        Origin { machine: "a machine".to_owned(), command: "bdpt-explorer bench".to_owned(), date: "2026-11-28".to_owned(), stopped: false }
    }

    #[test]
    fn dates_are_right_over_leap_years() {
        for (days, expected) in
            [(0, "1970-01-01"), (59, "1970-03-01"), (11_016, "2000-02-29"), (19_782, "2024-02-29"), (20_785, "2026-11-28")]
        {
            assert_eq!(date(UNIX_EPOCH + Duration::from_secs(86_400 * days + 5)), expected);
        }
    }

    #[test]
    fn tables_are_tables_and_every_one_has_its_command_and_date() {
        let good = scene(Some(1e-4), |seed, n| (1.0 + 0.01 * f64::from(seed)) / n);
        let text = report(std::slice::from_ref(&good), &origin());
        // Two moments, the slopes, two figures.
        assert_eq!(text.matches("<sub>2026-11-28, `bdpt-explorer bench`</sub>").count(), 5, "{text}");
        for part in
            ["| bdpt power cpu | 10 | 16 | 8.000 | 4.000 | 0.065", "Equal time: 5.000 s of CPU time", "| -1.000 ± 0.000 |", "| yes |"]
        {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert!(!text.contains("no: ") && !text.contains("Stopped") && !text.contains("take *less noise*"), "{text}");
        let mut fields = 0;
        for line in text.lines() {
            let count = line.matches('|').count();
            assert!(count == 0 || fields == 0 || count == fields, "{line}");
            fields = count;
        }
    }

    #[test]
    fn what_is_wrong_is_said() {
        let mut bad = scene(Some(0.05), |_, n| 0.2 / n + 0.05);
        bad.methods[0].lost = vec!["LS⁺E".to_owned()];
        bad.methods[0].left_out = 3;
        let text = report(&[bad.clone()], &Origin { stopped: true, ..origin() });
        for part in ["Stopped", "⚠ |", "take *less noise*", "no: light is missing", "3 contributions"] {
            assert!(text.contains(part), "{part}: {text}");
        }
        bad.methods[0].refused = Some("No adapter.".to_owned());
        bad.methods[0].runs.clear();
        let text = report(&[bad], &origin());
        assert!(text.contains("not measured") && text.contains("| bdpt power cpu | 0 | – |"), "{text}");
    }
}
