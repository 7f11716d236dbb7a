//! The pieces an SVG diagram is drawn from: text that is safe in XML, the marks of the roles (the shapes and colours of the
//! window: light square and orange, eye round and blue, connection green and dashed, blocked grey and dotted with a cross).

use std::fmt::Write;

/// Eye subpath.
pub const EYE: &str = "#0072B2";
/// Light subpath.
pub const LIGHT: &str = "#E69F00";

/// A place on the drawing.
pub type At = [f64; 2];

/// Text as XML takes it; characters it forbids are left out.
pub fn escape(text: &str) -> String {
    let allowed = |c: &char| matches!(c, '\t' | '\n' | ' '..='\u{d7ff}' | '\u{e000}'..='\u{fffd}' | '\u{10000}'..);
    let text: String = text.chars().filter(allowed).collect();
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A name with its index below: "y₁₂".
pub fn indexed(letter: char, index: usize) -> String {
    let low = index.to_string().bytes().filter_map(|digit| char::from_u32(0x2080 + u32::from(digit - b'0'))).collect::<String>();
    format!("{letter}{low}")
}

/// Four digits, short.
pub fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        size if (1e-3..1e4).contains(&size) => format!("{value:.*}", (3 - size.log10().floor() as i32).max(0) as usize),
        _ => format!("{value:.2e}"),
    }
}

/// A drawing under way.
#[derive(Default)]
pub struct Drawing {
    /// The elements so far.
    pub body: String,
}

impl Drawing {
    /// Adds a line of markup.
    pub fn add(&mut self, markup: &str) {
        self.body += markup;
        self.body.push('\n');
    }

    /// Opens a group with what a person and a machine may know of it.
    pub fn open(&mut self, attributes: &str, title: &str) {
        let _ = writeln!(self.body, "<g {attributes}><title>{}</title>", escape(title));
    }

    /// Closes it.
    pub fn close(&mut self) {
        self.add("</g>");
    }

    /// A line of text; `style` is one of the classes of the style sheet.
    pub fn text(&mut self, [x, y]: At, style: &str, text: &str) {
        let _ = writeln!(self.body, r#"<text x="{x:.1}" y="{y:.1}" class="{style}">{}</text>"#, escape(text));
    }

    /// A line along points; `style` is a class.
    pub fn path(&mut self, points: &[At], style: &str) {
        let points: Vec<_> = points.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        let _ = writeln!(self.body, r#"<polyline points="{}" class="{style}"/>"#, points.join(" "));
    }

    /// The mark of a vertex: light square, eye round; open where it was drawn for one connection alone.
    pub fn mark(&mut self, [x, y]: At, light: bool, fresh: bool) {
        let colour = if light { LIGHT } else { EYE };
        let paint = if fresh { format!(r#"fill="white" stroke="{colour}" stroke-width="3""#) } else { format!(r#"fill="{colour}""#) };
        let _ = if light {
            writeln!(self.body, r#"<rect x="{:.1}" y="{:.1}" width="16" height="16" {paint}/>"#, x - 8.0, y - 8.0)
        } else {
            writeln!(self.body, r#"<circle cx="{x:.1}" cy="{y:.1}" r="9" {paint}/>"#)
        };
    }

    /// A cross: here the way is barred.
    pub fn cross(&mut self, [x, y]: At) {
        for (width, colour) in [(5, "white"), (2, "black")] {
            let _ = writeln!(
                self.body,
                r#"<path d="M{:.1} {:.1}l10 10m0 -10l-10 10" stroke="{colour}" stroke-width="{width}" fill="none"/>"#,
                x - 5.0,
                y - 5.0
            );
        }
    }

    /// The whole document.
    pub fn finish(&self, size: At, [title, description]: [&str; 2]) -> String {
        let [width, height] = size;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" viewBox=\"0 0 {width:.0} {height:.0}\" role=\"img\" aria-labelledby=\"title description\">\n<title id=\"title\">{}</title>\n<desc id=\"description\">{}</desc>\n<style>{STYLE}</style>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{}</svg>\n",
            escape(title),
            escape(description),
            self.body
        )
    }
}

/// Text is ink, or weak (w, c); a line is of the light or eye subpath, a connection (join), a blocked one, or the chosen path's.
const STYLE: &str = "text{font-family:sans-serif;font-size:12px;fill:#202020}.h{font-size:18px;font-weight:bold}.n{font-size:14px;font-weight:bold}.w{fill:#5c5c5c;font-size:11px}.m{text-anchor:middle}.b{font-weight:bold}.c{fill:#5c5c5c;font-size:11px;text-anchor:middle}.nc{font-size:14px;font-weight:bold;text-anchor:middle}polyline{fill:none}.light{stroke:#E69F00;stroke-width:3}.eye{stroke:#0072B2;stroke-width:3}.join{stroke:#009E73;stroke-width:2;stroke-dasharray:7 4}.block{stroke:#707070;stroke-width:2;stroke-dasharray:1 4;stroke-linecap:round}.none{stroke:#c8c8c8;stroke-width:1}.pick{stroke:#B0447E;stroke-width:3.5}";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_safe_in_xml() {
        assert_eq!(escape("<a & \"b\">\u{0}\u{1f}"), "&lt;a &amp; &quot;b&quot;&gt;");
        assert_eq!(indexed('z', 10), "z₁₀");
        assert_eq!([0.0, 0.25, 12345.0, 1e-5].map(number), ["0", "0.2500", "1.23e4", "1.00e-5"]);
    }
}
