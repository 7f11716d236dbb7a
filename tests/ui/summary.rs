//! The summary in words says what the inspector says, in both languages, with the numbers in full beside.

use super::*;
use bdpt_explorer::ui::{Block, Row, Summary, summary_html};

fn summary(window: &Harness<'static, App>) -> Summary {
    window.state().summary().expect("a summary")
}

fn rows(summary: &Summary) -> Vec<Row> {
    let table = summary.path.iter().find_map(|block| if let Block::Table { rows, .. } = block { Some(rows) } else { None });
    table.expect("a table").clone()
}

fn data(data: &[(&'static str, String)], name: &str) -> String {
    data.iter().find(|(other, _)| *other == name).map(|(_, value)| value.clone()).unwrap_or_default()
}

#[test]
fn it_holds_the_record_in_full() {
    let mut window = cornell();
    until(&mut window, "a whole pass", |app| app.live().first_pass().is_none());
    window.state_mut().state_mut().select_pixel(20, 40);
    window.state_mut().state_mut().selection.sample = 3;
    window.run_steps(3);
    let found = summary(&window);
    assert_eq!((data(&found.data, "pixel"), data(&found.data, "sample")), ("20,40".to_owned(), "3".to_owned()));
    assert_eq!((data(&found.data, "renderer"), data(&found.data, "scene")), ("cpu".to_owned(), "cornell".to_owned()));
    assert!(data(&found.data, "spp").parse::<f64>().expect("a number") >= 1.0);
    let record = window.state().live().record(window.state().state()).expect("a record").clone();
    let rows = rows(&found);
    assert_eq!(rows.len(), record.strategies.len());
    for (row, strategy) in rows.iter().zip(&record.strategies) {
        assert_eq!((data(&row.data, "s"), data(&row.data, "t")), (strategy.s.to_string(), strategy.t.to_string()));
        assert_eq!(data(&row.data, "weight").parse::<f32>(), Ok(strategy.mis_weight));
        let parts: Vec<f32> = data(&row.data, "contribution").split(',').map(|part| part.parse().expect("a number")).collect();
        assert_eq!(parts, strategy.contribution);
        assert_eq!(data(&row.data, "feasible"), strategy.feasible.to_string());
        assert!(strategy.feasible || row.cells[2].chars().count() > 3, "it says why not: {row:?}");
    }
}

#[test]
fn it_reads_as_the_inspector_does() {
    let mut window = cornell();
    let record = window.state().live().record(window.state().state()).expect("a record").clone();
    let bright = record.strategies.iter().filter(|x| x.feasible && x.mis_weight > 0.01 && x.s > 1).max_by_key(|x| x.s + x.t).expect("one");
    window.state_mut().state_mut().select_strategy(bright.strategy());
    window.run_steps(2);
    for lang in [Lang::En, Lang::Zh] {
        window.state_mut().state_mut().prefs.lang = lang;
        window.run_steps(2);
        let found = summary(&window);
        let row = rows(&found).into_iter().find(|row| row.chosen).expect("the selected strategy's row");
        // The inspector's row says the same weight.
        let end = format!("{} {}: ", row.cells[0], row.cells[1]);
        let said = window.query_all_by_role(Role::Button).filter_map(|node| node.accesskit_node().label());
        assert!(said.into_iter().any(|label| label.starts_with(&end) && label.ends_with(&row.cells[3])), "{end}{}", row.cells[3]);
        assert!(
            found.now.contains(&row.cells[0]) && found.now.contains(&row.cells[3]) && found.now.contains(&row.cells[4]),
            "{}",
            found.now
        );
        let list = found.path.iter().find_map(|block| if let Block::List(items) = block { Some(items) } else { None }).expect("a list");
        assert_eq!(list.len(), bright.vertices.len());
        let html = summary_html(&found.path);
        assert!(html.contains("<caption>") && html.contains("aria-current=\"true\"") && html.contains("<ol start=\"0\">"));
        assert_eq!(html.chars().any(|c| ('\u{4e00}'..='\u{9fff}').contains(&c)), lang == Lang::Zh, "one language only");
    }
}

#[test]
fn what_is_read_out_changes_with_the_selection_and_not_with_the_rendering() {
    let mut window = cornell();
    until(&mut window, "a whole pass", |app| app.live().first_pass().is_none());
    let before = summary(&window);
    let spp = data(&before.data, "spp");
    until(&mut window, "more passes", |app| app.summary().is_some_and(|found| data(&found.data, "spp") != spp));
    let later = summary(&window);
    assert_eq!((&later.now, &later.path), (&before.now, &before.path));
    assert_ne!(later.rendering, before.rendering);
    press(&mut window, Key::N);
    assert_ne!(summary(&window).now, before.now);
    // A strategy that does not exist here says so.
    window.state_mut().state_mut().select_strategy(Strategy::new(3, 0));
    window.run_steps(2);
    assert!(summary(&window).now.contains("pinhole"), "{}", summary(&window).now);
}
