//! Where no window can be opened: the program renders, and says so.

use super::{channels, stdout, succeed};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

#[test]
fn without_a_display_the_program_renders_and_says_what_next() {
    let folder = tempfile::tempdir().unwrap();
    let start = Instant::now();
    let output = succeed(folder.path(), "");
    assert!(start.elapsed() < Duration::from_secs(60));
    assert!(String::from_utf8_lossy(&output.stderr).contains("no window"));
    let text = stdout(&output);
    assert!(text.contains("spp") && text.contains("bdpt-explorer render") && text.contains("bdpt-explorer inspect"), "{text}");
    for file in ["cornell.png", "cornell.exr", "contact-sheet.png"] {
        assert!(folder.path().join("bdpt-explorer-out").join(file).is_file(), "{file}");
    }
}

#[test]
fn without_a_display_a_link_is_followed() {
    let folder = tempfile::tempdir().unwrap();
    let hash = "#v=1&lang=zh&scene=furnace&size=48x32&k=2&hide=none,s1t2&env=0.5,0.5,0.5&inside=0&px=900,9&foo=1";
    let output = succeed(folder.path(), &format!("--link https://example.org/bdpt/{hash}"));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("no window") && said.contains("rendering furnace") && said.contains("foo=1"), "{said}");
    assert!(said.contains("47,9"), "{said}");
    assert!(stdout(&output).contains("48×32"));
    let (size, hidden) = channels(&folder.path().join("bdpt-explorer-out/furnace.exr"));
    assert_eq!(size, (48, 32));
    // The closed room has an answer: 0.25 (1 + 0.5) of K = 2; without next event of two edges some of the second half is missing.
    let mean = |channels: &BTreeMap<String, Vec<f32>>| channels["R"].iter().sum::<f32>() / (48.0 * 32.0);
    succeed(folder.path(), &format!("--link {}", hash.replace("&hide=none,s1t2", "")));
    let (_, whole) = channels(&folder.path().join("bdpt-explorer-out/furnace.exr"));
    assert!((mean(&whole) - 0.375).abs() < 0.01 && mean(&hidden) < 0.97 * mean(&whole), "{} {}", mean(&whole), mean(&hidden));
}
