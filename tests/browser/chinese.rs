//! Chinese in the page, with and without a font for it on the system: no glyph is missing, neither on the canvas nor in the HTML.

use super::driver::{Fonts, Mode};
use super::page::{DESKTOP, PHONE, Page, Visit};
use super::twin::Twin;
use image::RgbaImage;

/// The inspector has the window for itself: text from edge to edge.
const LINK: &str = "#v=1&lang=zh&scene=cornell&size=64x64&px=20,40&max=inspector&tab=strategies";

/// The characters of a text that the page draws as it draws one that no font has.
const MISSING: &str = r#"((selector) => {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [48, 48];
  const pen = canvas.getContext("2d", { willReadFrequently: true });
  const draw = (letter, family) => {
    pen.clearRect(0, 0, 48, 48);
    pen.font = `32px ${family}`;
    pen.fillText(letter, 4, 38);
    return pen.getImageData(0, 0, 48, 48).data.join();
  };
  const missing = new Set();
  for (const element of document.querySelectorAll(selector)) {
    const family = getComputedStyle(element).fontFamily;
    const nothing = draw("\u{10fffd}", family);
    for (const letter of new Set(element.textContent)) if (letter.trim() && draw(letter, family) === nothing) missing.add(letter);
  }
  return [...missing].join("");
})"#;

/// How much of two pictures differs in what is drawn with letters: all but the image and the status bar.
fn apart(a: &RgbaImage, b: &RgbaImage) -> f64 {
    let upper = |picture: &RgbaImage| image::imageops::crop_imm(picture, 0, 0, picture.width(), picture.height() * 3 / 4).to_image();
    super::different(&upper(a), &upper(b))
}

#[test]
fn chinese_has_no_missing_glyph_with_and_without_the_systems_fonts() {
    for (size, scale) in [(DESKTOP, 1.0), (PHONE, 2.0)] {
        let mut shown: Vec<RgbaImage> = Vec::new();
        for fonts in [Fonts::System, Fonts::Latin] {
            let visit = Visit { fonts, size, phone: size == PHONE, locale: "zh-CN", ..Visit::new(Mode::WebGl, LINK) };
            let Some(mut page) = Page::open("chinese_has_no_missing_glyph_with_and_without_the_systems_fonts", visit) else { return };
            page.interactive();
            page.until_spp(2.0);
            page.press("p");
            page.sleep(2000);
            page.shot(if fonts == Fonts::System { "chinese" } else { "chinese-latin-fonts" });
            assert_eq!(page.eval("document.documentElement.lang"), "zh-Hans");
            // What is HTML. The control: a character that nobody says and no font of the page has.
            let missing = |page: &mut Page| page.eval(&format!("document.fonts.ready.then(() => {MISSING}('#summary, #probe'))"));
            let text = page.eval("document.querySelector('#summary').textContent");
            let chinese = text.as_str().unwrap_or_default().chars().filter(|c| ('\u{4e00}'..'\u{a000}').contains(c)).count();
            assert!(chinese > 10, "{text}");
            assert_eq!(missing(&mut page), "", "{fonts:?}");
            page.eval("document.body.insertAdjacentHTML('beforeend', '<p id=probe>\u{10ffff}</p>')");
            assert_eq!(missing(&mut page), "\u{10ffff}", "{fonts:?}");
            page.eval("document.querySelector('#probe').remove()");
            shown.push(page.look(None));
        }
        // The canvas is as the window is, whose letters `cargo test --lib fonts` holds against its fonts.
        let window = Twin::drawn(size, scale, LINK).look();
        let english = Twin::drawn(size, scale, &LINK.replace("lang=zh", "lang=en")).look();
        for picture in &shown {
            let (same, other) = (apart(picture, &window), apart(picture, &english));
            assert!(same < 0.02 && other > 2.0 * same + 0.01, "{size:?}: {same} apart from the window, {other} from one in English");
        }
        assert!(apart(&shown[0], &shown[1]) < 0.002, "the system's fonts change nothing");
    }
}
