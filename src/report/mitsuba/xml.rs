//! Just enough XML for Mitsuba: elements with attributes and children, indented and escaped.

use crate::math::{DVec3, Vec3};
use std::fmt::Write;

/// An element, or a comment.
#[derive(Clone, Debug)]
pub struct Element {
    tag: &'static str,
    attributes: Vec<(&'static str, String)>,
    children: Vec<Element>,
}

/// The tag of comments; their text is the value of their only attribute.
const COMMENT: &str = "!--";

impl Element {
    /// `<tag>`.
    pub fn new(tag: &'static str) -> Self {
        Self { tag, attributes: Vec::new(), children: Vec::new() }
    }

    /// `<tag type="kind">`: one of Mitsuba's plugins.
    pub fn plugin(tag: &'static str, kind: &str) -> Self {
        Self::new(tag).with("type", kind)
    }

    /// A comment.
    pub fn comment(text: &str) -> Self {
        // Neither two hyphens nor one at the end may stand in it.
        Self::new(COMMENT).with("", text.replace("--", "- -"))
    }

    /// With an attribute.
    #[must_use]
    pub fn with(mut self, name: &'static str, value: impl Into<String>) -> Self {
        self.attributes.push((name, value.into()));
        self
    }

    /// Under the name its parent knows it by.
    #[must_use]
    pub fn named(self, name: &str) -> Self {
        self.with("name", name)
    }

    /// With a child.
    #[must_use]
    pub fn child(mut self, child: Self) -> Self {
        self.children.push(child);
        self
    }

    /// With more children.
    #[must_use]
    pub fn children(mut self, children: impl IntoIterator<Item = Self>) -> Self {
        self.children.extend(children);
        self
    }

    /// With a property.
    #[must_use]
    pub fn property(self, kind: &'static str, name: &str, value: impl ToString) -> Self {
        self.child(Self::new(kind).named(name).with("value", value.to_string()))
    }

    /// With a colour, or a radiometric quantity per channel.
    #[must_use]
    pub fn rgb(self, name: &str, value: Vec3) -> Self {
        self.property("rgb", name, format!("{}, {}, {}", value.x, value.y, value.z))
    }

    /// With a place or a direction.
    #[must_use]
    pub fn point(self, kind: &'static str, name: &str, at: Vec3) -> Self {
        let [x, y, z] = at.to_array().map(|x| x.to_string());
        self.child(Self::new(kind).named(name).with("x", x).with("y", y).with("z", z))
    }

    /// With what takes local coordinates, whose axes are these and whose zero is `place`, to the scene's.
    #[must_use]
    pub fn placed(self, axes: [Vec3; 3], place: Vec3) -> Self {
        let [x, y, z] = axes;
        let rows = (0..3).map(|i| format!("{} {} {} {} ", x[i], y[i], z[i], place[i]));
        self.transform("to_world", rows.collect::<String>() + "0 0 0 1")
    }

    /// With what takes the mesh's texture coordinates to the texture's: two rows of (u, v, 1).
    #[must_use]
    pub fn uv_rows(self, [u, v]: [DVec3; 2]) -> Self {
        self.transform("to_uv", format!("{} {} 0 {} {} {} 0 {} 0 0 1 0 0 0 0 1", u.x, u.y, u.z, v.x, v.y, v.z))
    }

    fn transform(self, name: &str, matrix: String) -> Self {
        self.child(Self::new("transform").named(name).child(Self::new("matrix").with("value", matrix)))
    }

    /// The file.
    pub fn document(&self) -> String {
        let mut text = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n".to_owned();
        self.write(&mut text, 0);
        text
    }

    fn write(&self, out: &mut String, depth: usize) {
        let indent = "    ".repeat(depth);
        // A string takes whatever is written to it.
        if self.tag == COMMENT {
            let _ = writeln!(out, "{indent}<!-- {} -->", self.attributes.iter().map(|(_, text)| plain(text)).collect::<String>());
            return;
        }
        let attributes: String = self.attributes.iter().map(|(name, value)| format!(" {name}=\"{}\"", escaped(value))).collect();
        if self.children.is_empty() {
            let _ = writeln!(out, "{indent}<{}{attributes}/>", self.tag);
            return;
        }
        let _ = writeln!(out, "{indent}<{}{attributes}>", self.tag);
        self.children.iter().for_each(|child| child.write(out, depth + 1));
        let _ = writeln!(out, "{indent}</{}>", self.tag);
    }
}

/// Text with the characters that may not stand in XML, and line ends, as spaces.
fn plain(text: &str) -> String {
    text.chars().map(|c| if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') { ' ' } else { c }).collect()
}

/// The value of an attribute.
fn escaped(text: &str) -> String {
    plain(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_back() {
        let odd = "a<b> & \"c\" -- d\u{1}-";
        let scene = Element::new("scene")
            .with("version", "3.0.0")
            .child(Element::comment(odd))
            .child(Element::plugin("bsdf", "diffuse").with("id", odd).rgb("reflectance", Vec3::new(0.5, 1e-20, 3.0)))
            .child(Element::plugin("sensor", "perspective").placed([Vec3::X, Vec3::Y, Vec3::Z], Vec3::new(1.0, 2.0, -3.0)));
        let text = scene.document();
        let read = roxmltree::Document::parse(&text).unwrap();
        let bsdf = read.descendants().find(|x| x.has_tag_name("bsdf")).unwrap();
        assert_eq!(bsdf.attribute("id"), Some("a<b> & \"c\" -- d -"));
        let value = bsdf.first_element_child().unwrap().attribute("value").unwrap();
        let numbers: Vec<f32> = value.split(", ").map(|x| x.parse().unwrap()).collect();
        assert_eq!(numbers, [0.5, 1e-20, 3.0]);
        let matrix = read.descendants().find(|x| x.has_tag_name("matrix")).unwrap();
        assert_eq!(matrix.attribute("value"), Some("1 0 0 1 0 1 0 2 0 0 1 -3 0 0 0 1"));
    }
}
