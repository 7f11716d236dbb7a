//! What is said of light that no strategy in use can bring.

use super::*;
use bdpt_explorer::bdpt::{Strategy, StrategySet};
use bdpt_explorer::report::check::Phrase;
use bdpt_explorer::scene::Lens;

fn missing(job: &Job) -> CheckResult {
    one(job, Check::Missing, 0.2, Control::default())
}

fn with(job: &Job, strategies: StrategySet) -> Job {
    let mut job = job.clone();
    job.settings.strategies = strategies;
    job
}

#[test]
fn a_pinhole_a_point_and_a_mirror_miss_a_named_part_of_the_light() {
    let pinhole = job("point-mirror");
    let result = missing(&pinhole);
    assert_eq!(result.verdict, Verdict::LightMissing);
    let (share, said) = (result.figure.unwrap(), result.measured.as_ref().unwrap().to_string());
    assert!((0.005..0.5).contains(&share), "{share}");
    assert!(said.contains("L₀S⁺E ") && said.contains("L₀S⁺DS⁺E ") && said.contains("blurred"), "{said}");
    assert!(result.findings[0].meaning.to_string().contains("L₀S⁺E, L₀S⁺DS⁺E"), "{:?}", result.findings);
    // A path tracer misses the caustics as well, and no blur is needed to find them.
    let by_eye = missing(&with(&pinhole, StrategySet::path_tracer()));
    assert!(by_eye.figure.unwrap() > share && by_eye.measured.as_ref().unwrap().to_string().contains("L₀S⁺DE "));
    // What helps is what would: not what is there already, or what is of no use to these strategies.
    let helps = |result: &CheckResult| result.findings[0].look.to_string();
    let [aperture, extent, take_in] = [Phrase::LookAperture, Phrase::LookExtent, Phrase::LookTakeIn].map(|phrase| phrase.text());
    assert_eq!((helps(&result), helps(&by_eye)), (format!("{aperture} {extent}"), format!("{extent} {take_in}")));
    // With a lens nothing is missing, but without t = 0 it is what it was (seen through the lens).
    let lens = Job { lens: Some(Lens { radius: 0.08, focus_distance: 2.9 }), ..pinhole.clone() };
    assert_eq!(missing(&lens).verdict, Verdict::Pass);
    let closed = missing(&with(&lens, StrategySet::where_(|x| x.t > 0)));
    assert!((closed.figure.unwrap() / share - 1.0).abs() < 0.3, "{closed:?} beside {share}");
    assert_eq!(helps(&closed), format!("{extent} {take_in}"));
}

#[test]
fn what_is_taken_out_is_missing_and_too_few_samples_are_no_verdict() {
    let spheres = job("cornell-spheres");
    let result = one(&with(&spheres, StrategySet::where_(|x| x.s > 0)), Check::Missing, 1.5, Control::default());
    assert_eq!(result.verdict, Verdict::LightMissing);
    let said = result.measured.unwrap().to_string();
    assert!(said.contains("LS⁺") && !said.contains("blurred"), "{said}");
    let few = one(&with(&spheres, StrategySet::where_(|x| x.s > 0)), Check::Missing, 1e-4, Control::default());
    assert_eq!((few.verdict, few.measured.unwrap().phrase), (Verdict::NotEnoughSamples, Phrase::MeasuredMissingTooRare));
}

/// Negative controls: where every kind can be made, nothing runs; and light that is found twice as bright is a larger part.
#[test]
fn where_nothing_is_missing_nothing_is_estimated() {
    for name in ["cornell", "cornell-spheres", "spots", "bokeh"] {
        let result = missing(&job(name));
        assert_eq!((&result.verdict, result.figure, result.samples), (&Verdict::Pass, Some(0.0), 0), "{name}");
    }
    // Neither is one of the other ways to make a path missed.
    assert_eq!(missing(&with(&job("cornell"), StrategySet::where_(|x| x.t != 1))).verdict, Verdict::Pass);
    let mut long = with(&job("cornell"), StrategySet::where_(|x| x.edges() != 11));
    assert_eq!(missing(&long).verdict, Verdict::Pass);
    long.settings.max_edges = 12;
    assert_eq!(missing(&long).reason().unwrap().phrase, Phrase::OnlyLongOnesMissing);
    let eye = |x: Strategy| if x.s == 0 { 2.0 } else { 1.0 };
    let [right, wrong] = [Control::default(), Control { factor: eye, ..Control::default() }]
        .map(|control| one(&job("point-mirror"), Check::Missing, 0.2, control).figure.unwrap());
    let odds = |share: f64| share / (1.0 - share);
    assert!((odds(wrong) / odds(right) - 2.0).abs() < 0.01, "{wrong} beside {right}");
}
