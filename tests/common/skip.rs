//! How a test says that it did not run: past libtest, which hides what a passing test prints.

use std::io::Write;

/// Says on the terminal that a test was skipped, and why.
pub fn skipped(test: &str, why: &str) {
    // A closed terminal is no reason to fail.
    let _ = writeln!(std::io::stderr(), "SKIPPED {test}: {why}");
}

/// Did the caller ask for a failure instead (`BDPT_REQUIRE_…=1`)?
#[allow(dead_code, reason = "not every test that skips has such a switch")]
pub fn required(variable: &str) -> bool {
    std::env::var(variable).is_ok_and(|value| value == "1")
}
