//! The window's fonts: egui's own, and the Chinese characters of the window's own texts, so that these can be read on any machine.
//! (What else is Chinese, such as the name of a file, comes from the system's fonts.) `assets/fonts/subset.py` makes the file.

use eframe::egui::epaint::text::{FontInsert, FontPriority, InsertFontFamily};
use eframe::egui::{Context, FontData, FontFamily};

/// A part of Noto Sans CJK SC.
const INTERFACE_ZH: &[u8] = include_bytes!("../../assets/fonts/interface-zh.otf");

/// Gives them to a context.
pub fn install(ctx: &Context) {
    let family = |family| InsertFontFamily { family, priority: FontPriority::Lowest };
    let families = vec![family(FontFamily::Proportional), family(FontFamily::Monospace)];
    ctx.add_font(FontInsert::new("interface-zh", FontData::from_static(INTERFACE_ZH), families));
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::FontId;
    use std::collections::BTreeSet;
    use std::path::Path;

    /// Every character of the code (comments apart) below a folder.
    fn letters(folder: &Path, found: &mut BTreeSet<char>) {
        for entry in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if entry.is_dir() {
                letters(&entry, found);
            } else if entry.extension().is_some_and(|end| end == "rs") {
                let source = std::fs::read_to_string(&entry).unwrap();
                let code = source.split("#[cfg(test)]").next().unwrap_or_default();
                found.extend(code.lines().filter(|line| !line.trim_start().starts_with("//")).flat_map(str::chars));
            }
        }
    }

    fn missing<'a>(ctx: &Context, letters: impl IntoIterator<Item = &'a char>) -> String {
        let font = FontId::proportional(14.0);
        letters.into_iter().filter(|c| !c.is_control() && !ctx.fonts_mut(|fonts| fonts.has_glyph(&font, **c))).collect()
    }

    #[test]
    fn whatever_the_window_says_can_be_drawn_without_the_systems_fonts() {
        let ctx = Context::default();
        install(&ctx);
        drop(ctx.run_ui(Default::default(), |_| {}));
        let mut found = BTreeSet::new();
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
        for part in ["ui", "bdpt", "engine", "report"] {
            letters(&source.join(part), &mut found);
        }
        // What the page says when there is no program.
        let page = std::fs::read_to_string(source.join("../web/texts.js")).unwrap();
        found.extend(page.chars().filter(|c| *c >= '\u{2e80}'));
        assert!(found.iter().filter(|c| **c >= '\u{4e00}').count() > 400, "there is Chinese in it");
        assert_eq!(missing(&ctx, &found), "", "run assets/fonts/subset.py, or choose another character");
        assert_eq!(missing(&ctx, &['\u{946b}', '\u{9f98}']).chars().count(), 2, "nobody says these, and they are not in the file");
    }
}
