//! The list of hard cases, `tests/hard-cases.md`: every test that it names exists, is a test, and is run as the list says.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use syn::visit::{self, Visit};

/// The numbered cases.
const CASES: u32 = 28;
/// The cases that are named.
const NAMED: [&str; 17] = [
    "zero-length connections",
    "grazing cosines",
    "tiny and huge lights",
    "point light + pinhole + mirror",
    "light inside glass",
    "SDS",
    "aperture → 0",
    "crop and tiles",
    "10⁷ spp",
    "scale 10⁻³…10⁶",
    "far offsets",
    "sliver triangles",
    "mirrored transforms",
    "coplanar overlaps",
    "one-sided emitters",
    "no lights",
    "K = 1",
];

/// A row: case, test, negative control, result.
struct Row([String; 4]);

fn rows(list: &str) -> Vec<Row> {
    let cells = |line: &str| -> Option<[String; 4]> {
        let cells: Vec<String> = line.strip_prefix('|')?.strip_suffix('|')?.split('|').map(|cell| cell.trim().to_owned()).collect();
        cells.try_into().ok()
    };
    let rows = list.lines().filter(|line| line.starts_with("| ")).map(|line| cells(line).unwrap_or_else(|| panic!("four cells: {line}")));
    rows.filter(|row| row[0] != "case").map(Row).collect()
}

/// `file::test`, wherever it stands between back quotes.
fn references(text: &str) -> Vec<(String, String)> {
    let quoted = text.split('`').skip(1).step_by(2);
    quoted.filter_map(|name| name.split_once(".rs::")).map(|(file, test)| (format!("{file}.rs"), test.to_owned())).collect()
}

/// The functions with `#[test]` of a source, and whether they are ignored.
#[derive(Default)]
struct Tests(BTreeMap<String, bool>);

impl<'ast> Visit<'ast> for Tests {
    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        let has = |name: &str| item.attrs.iter().any(|attribute| attribute.path().is_ident(name));
        if has("test") {
            self.0.insert(item.sig.ident.to_string(), has("ignore"));
        }
        visit::visit_item_fn(self, item);
    }
}

fn tests_of(file: &str) -> Option<Tests> {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(file)).ok()?;
    let mut tests = Tests::default();
    tests.visit_file(&syn::parse_file(&text).ok()?);
    Some(tests)
}

/// What is wrong with the list.
fn findings(list: &str) -> Vec<String> {
    let (mut findings, mut numbers, mut names) = (Vec::new(), BTreeSet::new(), BTreeSet::new());
    for Row([case, test, control, result]) in rows(list) {
        if let Some(number) = case.split_whitespace().next().and_then(|word| word.parse::<u32>().ok()) {
            numbers.insert(number);
        }
        names.insert(case.clone());
        let (tests, applies) = (references(&test), !test.starts_with("does not apply, because "));
        if applies && (tests.is_empty() || control.is_empty()) || result.is_empty() {
            findings.push(format!("{case}: a test, its negative control and a result, or why it does not apply"));
        }
        let mut run = false;
        for (file, name) in tests.iter().chain(&references(&control)) {
            match tests_of(file).map(|tests| tests.0.get(name).copied()) {
                None => findings.push(format!("{case}: there is no {file}")),
                Some(None) => findings.push(format!("{case}: {file} has no test {name}")),
                Some(Some(ignored)) => run |= !ignored,
            }
        }
        if applies && !tests.is_empty() && !run {
            findings.push(format!("{case}: only tests that are not run"));
        }
    }
    findings.extend((1..=CASES).filter(|n| !numbers.contains(n)).map(|n| format!("case {n} is missing")));
    findings.extend(NAMED.iter().filter(|name| !names.contains(**name)).map(|name| format!("'{name}' is missing")));
    findings
}

#[test]
fn the_list_of_hard_cases_names_tests_that_there_are() {
    let list = include_str!("../hard-cases.md");
    let found = findings(list);
    assert!(found.is_empty(), "\n{}\n", found.join("\n"));
    // Negative controls: a test by another name, a file that is gone, a row without a control, one that is missing.
    let (file, test) = references(list)[0].clone();
    let row = list.lines().find(|line| line.starts_with("| 7 ")).unwrap();
    for (from, to) in [
        (test.as_str(), "no_such_test".to_owned()),
        (file.as_str(), "tests/none.rs".to_owned()),
        (row, "| 7 a case | `tests/hard/list.rs::the_list_of_hard_cases_names_tests_that_there_are` | | passes |".to_owned()),
        (row, String::new()),
        (row, row.replace("::", ":")),
    ] {
        assert!(!findings(&list.replacen(from, &to, 1)).is_empty(), "{from} → {to} goes unnoticed");
    }
}
