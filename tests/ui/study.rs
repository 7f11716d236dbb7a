//! The pyramid's modes, why a cell is black, and how sure the pixel is.

use super::*;
use bdpt_explorer::engine::Mode;
use bdpt_explorer::scene::Lens;
use bdpt_explorer::ui::state::{Gain, Maximised};

/// Pictures to look at: every mode, in both languages and themes; `BDPT_SHOT` is a part of the wanted names.
#[test]
#[ignore = "pictures to look at: set BDPT_SCREENSHOT_DIR"]
fn modes_to_look_at() {
    let wanted = std::env::var("BDPT_SHOT").unwrap_or_default();
    let sizes = [([1440.0, 900.0], Lang::En, true), ([1280.0, 800.0], Lang::Zh, false), ([1024.0, 768.0], Lang::En, true)];
    for (size, lang, dark) in sizes {
        for mode in Mode::ALL {
            for (name, why, gain) in [("plain", false, Gain::Each), ("why", true, Gain::Same)] {
                let file = format!("{mode:?}-{name}-{}", size[0]);
                if !file.contains(&wanted) {
                    continue;
                }
                let mut window = screenshots::drawn(screenshots::cornell_scene(), size);
                let state = window.state_mut().state_mut();
                (state.prefs.lang, state.prefs.dark, state.prefs.gain) = (lang, dark, gain);
                (state.study.mode, state.study.why) = (mode, why);
                if size[0] == 1280.0 {
                    state.maximised = Maximised::Pyramid;
                }
                state.select_strategy(if why { Strategy::new(2, 1) } else { Strategy::new(1, 2) });
                until(&mut window, "a study", |app| {
                    mode == Mode::Weighted && !why || app.live().study().is_some_and(|study| study.mode == mode && study.spp >= 4.0)
                });
                window.run_steps(12);
                screenshots::picture(&mut window, &file);
            }
        }
    }
}
