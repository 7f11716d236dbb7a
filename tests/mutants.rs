//! The list of slips by which the suite is tested, `tests/mutants/slips.json`: each still fits its file, so that `tests/mutants/run.py`
//! can make it. And the report: it is of this list, and whatever survives is accepted for a reason.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs, reason = "tests may panic")]

use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::Path;

/// The fewest slips, and the fewest of them in shaders.
const FEWEST: [usize; 2] = [50, 15];
const LIST: &str = include_str!("mutants/slips.json");
const REPORT: &str = include_str!("mutants/report.md");

/// A mistake that could be made.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Slip {
    name: String,
    /// Below the repository's root.
    file: String,
    /// What it is, in words.
    mistake: String,
    /// A text of the file, which it has once; `from` if that is it.
    at: Option<String>,
    /// What is right: an expression (or a statement) of Rust, or any text of a shader; once in `at`.
    from: String,
    /// What stands there instead.
    to: String,
    #[serde(default)]
    statement: bool,
    /// Why it may survive.
    accepted: Option<String>,
}

impl Slip {
    fn in_shader(&self) -> bool {
        self.file.starts_with("shaders/")
    }

    /// Where it stands in its file, or what is wrong with it.
    fn place(&self) -> Result<Range<usize>, String> {
        let text =
            std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(&self.file)).map_err(|_| "no such file".to_owned())?;
        let at = self.at.as_ref().unwrap_or(&self.from);
        let found: Vec<usize> = text.match_indices(at.as_str()).map(|(start, _)| start).collect();
        let inside: Vec<usize> = at.match_indices(self.from.as_str()).map(|(start, _)| start).collect();
        match (&found[..], &inside[..]) {
            ([start], [within]) => Ok(start + within..start + within + self.from.len()),
            _ => Err(format!("its file has the text {} times, which has what is right {} times", found.len(), inside.len())),
        }
    }

    /// Do both texts parse as what they replace?
    fn parses(&self) -> bool {
        let statement = |text: &str| syn::parse_str::<syn::Block>(&format!("{{ {text} }}")).is_ok();
        let expression = |text: &str| syn::parse_str::<syn::Expr>(text).is_ok();
        let parses = |text: &str| if self.statement { statement(text) } else { expression(text) };
        self.in_shader() || parses(&self.from) && parses(&self.to)
    }
}

/// What is wrong with a list and its report.
fn findings(list: &str, report: &str) -> Vec<String> {
    let slips: Vec<Slip> = match serde_json::from_str(list) {
        Ok(slips) => slips,
        Err(error) => return vec![error.to_string()],
    };
    let (mut findings, mut names) = (Vec::new(), BTreeSet::new());
    let mut taken: BTreeMap<&str, Vec<Range<usize>>> = BTreeMap::new();
    let rows: BTreeMap<&str, &str> = report.lines().filter_map(|line| Some((line.strip_prefix("| `")?.split_once('`')?.0, line))).collect();
    for slip in &slips {
        let mut find = |what: String| findings.push(format!("{}: {what}", slip.name));
        match slip.place() {
            Err(what) => find(what),
            Ok(place) => {
                let others = taken.entry(&slip.file).or_default();
                if others.iter().any(|other| place.start < other.end && other.start < place.end) {
                    find("another slip changes the same text".to_owned());
                }
                others.push(place);
            }
        }
        if !names.insert(slip.name.as_str()) || slip.from == slip.to || slip.mistake.is_empty() {
            find("a name of its own, a change, and what the mistake is".to_owned());
        }
        if !slip.parses() {
            find("no expression, or no statement".to_owned());
        }
        match rows.get(slip.name.as_str()) {
            None => find("not in the report: run tests/mutants/run.py --only with its name".to_owned()),
            Some(row) if row.contains("**survives**") && slip.accepted.is_none() => find("survives, and nobody says why it may".to_owned()),
            Some(row) if row.contains("not run to the end") => {
                find("not judged yet: run tests/mutants/run.py --only with its name".to_owned());
            }
            Some(_) => {}
        }
    }
    findings.extend(rows.keys().filter(|name| !names.contains(**name)).map(|name| format!("{name} is in the report alone")));
    let counts = [slips.len(), slips.iter().filter(|slip| slip.in_shader()).count()];
    if counts[0] < FEWEST[0] || counts[1] < FEWEST[1] {
        findings.push(format!("{counts:?} slips, in shaders, are fewer than {FEWEST:?}"));
    }
    findings
}

#[test]
fn every_slip_fits_its_file_and_is_in_the_report() {
    let found = findings(LIST, REPORT);
    assert!(found.is_empty(), "\n{}\n", found.join("\n"));
    // Negative controls: texts that are gone, no expression, twice the same name, an unknown field; a slip that was not run, or not to the end,
    // one that survives, one that is none; an empty list.
    let slips: Vec<Slip> = serde_json::from_str(LIST).unwrap();
    let report: String = slips.iter().map(|slip| format!("| `{}` | killed |\n", slip.name)).collect();
    assert!(findings(LIST, &report).is_empty());
    let (first, second) = (&slips[0], &slips[1]);
    for (from, to) in [
        (first.from.as_str(), "no_such_text".to_owned()),
        (&first.to, format!("{} +", first.to)),
        (&first.name, second.name.clone()),
        ("\"mistake\"", "\"misteak\"".to_owned()),
    ] {
        assert!(!findings(&LIST.replacen(from, &to, 1), &report).is_empty(), "{from} → {to} goes unnoticed");
    }
    for (from, to) in [
        (format!("`{}`", first.name), "`no-such-slip`".to_owned()),
        ("killed".to_owned(), "**survives**".to_owned()),
        ("killed".to_owned(), "not run to the end".to_owned()),
    ] {
        assert!(!findings(LIST, &report.replacen(&from, &to, 1)).is_empty(), "{from} → {to} goes unnoticed");
    }
    assert!(!findings("[]", "").is_empty());
}
