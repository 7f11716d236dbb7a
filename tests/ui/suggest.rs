//! The suggestion of strategies, by labels.

use super::*;
use bdpt_explorer::bdpt::StrategySet;
use bdpt_explorer::ui::text::SuggestText;

#[test]
fn a_suggestion_can_be_looked_at_used_and_goes_out_of_date() {
    let mut window = showing(Arc::new(builtin::open("indirect").expect("a built-in scene opens")));
    window.state_mut().state_mut().suggest.open = true;
    window.run_steps(2);
    until(&mut window, "the pilot's answer", |app| app.state().suggest.is_answered());
    window.run_steps(2);
    assert!(window.query_by_label(SuggestText::Efficiency.in_language(Lang::En)).is_some());
    // Its lamp lights only indirectly: next event and chance hits are of no use.
    assert!(window.query_by_label_contains("Suggested: light tracer, inner connections").is_some());
    let buttons: Vec<_> = window.query_all_by_label_contains("Use: ").map(|node| node.accesskit_node().label()).collect();
    assert!(buttons.len() >= 10, "{buttons:?}");
    let first = window.query_all_by_label_contains("Use: ").next().unwrap();
    first.click();
    window.run_steps(3);
    assert_ne!(window.state().state().settings.strategies, StrategySet::ALL);
    let stale = SuggestText::Stale.in_language(Lang::En);
    assert!(window.query_by_label(stale).is_none(), "what it suggests does not depend on what is in use");
    window.state_mut().state_mut().settings.max_edges = 3;
    window.run_steps(3);
    assert!(window.query_by_label(stale).is_some());
    press(&mut window, Key::Escape);
    assert!(!window.state().state().suggest.open);
}
