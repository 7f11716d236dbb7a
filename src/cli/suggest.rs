//! `suggest`: which strategies a scene needs, judged by a short pilot run.

use super::args::SuggestArgs;
use super::job::{own_choice, prepare};
use super::{Failure, print};
use crate::bdpt::pilot::Judged;
use std::fmt::Write;

/// Rows of the table.
const ROWS: usize = 10;

/// Carries out `suggest`.
pub fn run(args: &SuggestArgs) -> Result<(), Failure> {
    if let Some(other) = own_choice(&args.estimator) {
        return Err(Failure(format!(
            "suggest judges the strategies and how many light subpaths they get, so it does not go with {other}; leave that out"
        )));
    }
    let job = prepare(&args.estimator, false)?.job;
    job.check()?;
    print(&table(&args.estimator.scene, &job.judge_strategies()));
    Ok(())
}

/// The candidates, the best first, and what to do.
fn table(scene: &str, judged: &[Judged]) -> String {
    if judged.is_empty() {
        return "There is nothing to judge: no path that is short enough brings light here.\n".to_owned();
    }
    let mut text = "efficiency  variance    cost  strategies\n".to_owned();
    for x in judged.iter().take(ROWS) {
        let (low, high) = ((x.ln_gain - 2.0 * x.error).exp(), (x.ln_gain + 2.0 * x.error).exp());
        let _ = writeln!(text, "{low:4.2}–{high:4.2} ×  {:6.2} ×  {:4.2} ×  {}", x.variance, x.cost, x.family);
    }
    let candidates = judged.len();
    let _ = writeln!(
        text,
        "\nAll beside all strategies together; {candidates} sets that make every kind of path were judged by the same samples."
    );
    let _ = match judged.first().filter(|best| best.is_worth_it()) {
        Some(best) => writeln!(text, "Suggestion: {}. To render so: render {scene} --strategies suggested …", best.family),
        None => writeln!(text, "Suggestion: all strategies; no set is surely better by a tenth."),
    };
    text
}
