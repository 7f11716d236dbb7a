//! Figures for the README: how long checks take, and how often one fails although nothing is wrong.

use super::*;

fn wanted(name: &str, default: &str) -> String {
    std::env::var(name).unwrap_or(default.to_owned())
}

/// Over many seeds: `CHECK` is a check's id, `SCENE` a part of a scene's name, `SHARE` how many samples, `SEEDS` how often.
#[test]
#[ignore = "a measurement"]
fn false_alarms() {
    let check = Check::parse(&wanted("CHECK", "pairwise")).expect("an id of --list");
    let share = wanted("SHARE", "0.25").parse().expect("a number");
    for entry in builtin::list().iter().filter(|entry| entry.name.contains(&wanted("SCENE", ""))) {
        let (mut failed, mut judged, mut largest) = (0, 0, 0.0f64);
        for seed in 0..wanted("SEEDS", "40").parse().expect("a number") {
            let mut job = job(entry.name);
            job.settings.seed = seed;
            let result = run(&job, &Wanted::new([check], Effort::Samples(share))).remove(0);
            if result.verdict == Verdict::Fail {
                show(&job, &result);
            }
            failed += u32::from(result.verdict == Verdict::Fail);
            judged += u32::from(matches!(result.verdict, Verdict::Fail | Verdict::Pass));
            largest = largest.max(result.figure.unwrap_or(0.0) / result.bound.unwrap_or(1.0));
        }
        println!("{}: {failed} of {judged} failed, largest figure over bound {largest:.3}", entry.name);
    }
}

/// A quick run of all checks on every built-in scene, at the program's size.
#[test]
#[ignore = "a measurement"]
fn times() {
    for entry in builtin::list() {
        let job = Job::new(Arc::new(scene(entry.name)));
        let results = run(&job, &Wanted::new(Check::ALL, Effort::Quick));
        results.iter().for_each(|result| show(&job, result));
        println!("{}: {:.1} s", entry.name, results.iter().map(|result| result.seconds).sum::<f64>());
    }
}
