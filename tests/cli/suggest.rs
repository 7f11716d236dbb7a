//! `suggest`, and rendering with what it suggests.

use super::*;

#[test]
fn a_pilot_run_suggests_strategies_and_rendering_obeys() {
    let folder = tempfile::tempdir().unwrap();
    let text = stdout(&succeed(folder.path(), "suggest indirect --size 24x24"));
    let rows: Vec<_> = text.lines().take_while(|line| !line.is_empty()).collect();
    assert!(rows.len() == 11 && rows[0].starts_with("efficiency"), "{text}");
    // A lamp that lights only indirectly: next event and chance hits are of no use.
    let suggestion = text.lines().find_map(|line| line.strip_prefix("Suggestion: ")).unwrap();
    assert!(suggestion.starts_with("light tracer, inner connections") && suggestion.contains("--strategies suggested"), "{text}");

    let line = "render indirect --size 24x24 --spp 1 --strategies suggested --pyramid pyramid";
    let said = String::from_utf8(succeed(folder.path(), line).stderr).unwrap();
    assert!(said.contains("note: rendering with light tracer, inner connections"), "{said}");
    let (_, channels) = channels(&folder.path().join("pyramid/pyramid.exr"));
    assert!(channels.keys().any(|name| name.contains("s2t2")) && !channels.keys().any(|name| name.contains("s1t2")), "{channels:?}");
}

#[test]
fn where_no_path_is_made_there_is_nothing_to_suggest() {
    let folder = tempfile::tempdir().unwrap();
    let text = stdout(&succeed(folder.path(), "suggest point-mirror --size 8x8 --max-edges 1"));
    assert_eq!((text.lines().count(), text.starts_with("There is nothing to judge")), (1, true), "{text}");
}

#[test]
fn a_suggestion_does_not_go_with_another_choice() {
    let folder = tempfile::tempdir().unwrap();
    for line in [
        "render cornell -o a.exr --size 8x8 --strategies suggested --integrator pt",
        "render cornell -o a.exr --size 8x8 --strategies suggested --strategies-mode hide",
        "render cornell -o a.exr --size 8x8 --strategies suggested --light-subpaths 3",
        "suggest cornell --size 8x8 --light-subpaths 3",
        "suggest cornell --size 8x8 --integrator lt",
        "suggest cornell --size 8x8 --strategies s0t2,s1t2",
        "suggest nowhere.glb",
        "suggest",
    ] {
        let output = run(folder.path(), line);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!((output.status.code(), said.trim_end().lines().count()), (Some(2), 1), "{line}: {said}");
    }
}
