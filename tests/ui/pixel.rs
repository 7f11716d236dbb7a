//! The pixel's page: the strategies' means sum to the pixel's own, and absurd numbers are refused.

use super::*;
use bdpt_explorer::ui::state::Tab;

#[test]
fn the_strategies_means_sum_to_the_pixel() {
    let mut window = cornell();
    let pixel = [20, 50];
    window.state_mut().state_mut().selection.pixel = pixel;
    window.state_mut().state_mut().prefs.tab = Tab::Pixel;
    let lit = |f: &Frame| f.pixel.means.iter().any(|(_, mean)| mean.max_element() > 0.0);
    until(&mut window, "light", |app| app.live().frame().is_some_and(|f| f.stats.spp >= 4.0 && f.pixel.pixel == pixel && lit(f)));
    window.state_mut().state_mut().paused = true;
    window.run_steps(2);
    std::thread::sleep(Duration::from_millis(300));
    window.run_steps(2);
    let frame = window.state().live().frame().expect("a frame").clone();
    let sum: Vec3 = frame.pixel.means.iter().map(|(_, mean)| *mean).sum();
    let whole = frame.image[(pixel[1] * SIZE[0] + pixel[0]) as usize];
    assert!((sum - whole).abs().max_element() <= 1e-5 * whole.max_element(), "{sum} and {whole}");
    assert!(whole.max_element() > 0.0);
    // The largest one is listed with its share.
    let lightness = |mean: &Vec3| mean.dot(Vec3::new(0.2126, 0.7152, 0.0722));
    let (largest, _) = *frame.pixel.means.iter().max_by(|a, b| lightness(&a.1).total_cmp(&lightness(&b.1))).expect("some");
    let name = format!("({},{}): ", largest.s, largest.t);
    let spoken = |node: &egui_kittest::Node<'_>| node.accesskit_node().label().is_some_and(|l| l.contains(&name) && l.ends_with('%'));
    assert!(window.query_all_by_role(Role::Button).any(|node| spoken(&node)), "{name}");
}

#[test]
fn a_number_that_is_none_changes_nothing() {
    let mut window = cornell();
    for (field, number) in [("β", "nan"), ("β", "inf"), ("x", "nan"), ("K", "nan")] {
        let before = format!("{:?} {:?}", window.state().state().settings, window.state().state().selection.pixel);
        type_number(&mut window, field, number);
        assert_eq!(
            format!("{:?} {:?}", window.state().state().settings, window.state().state().selection.pixel),
            before,
            "{field} {number}"
        );
    }
    type_number(&mut window, "β", "1.5");
    assert_eq!(window.state().state().settings.heuristic.beta, 1.5);
}
