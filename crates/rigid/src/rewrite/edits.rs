//! Changes of attributes and elements in the text of an XML file.

use crate::urdf::Element;
use std::ops::Range;

/// An element of attributes alone.
pub(super) struct Part {
    tag: &'static str,
    attributes: Vec<(&'static str, String)>,
}

impl Part {
    pub fn new(tag: &'static str, attributes: &[(&'static str, String)]) -> Self {
        let attributes = attributes.to_vec();
        Self { tag, attributes }
    }

    /// The element as text, its name after the prefix of a namespace.
    fn text(&self, prefix: &str) -> String {
        let attributes = self
            .attributes
            .iter()
            .map(|(name, value)| format!(" {name}=\"{value}\""));
        format!("<{prefix}{}{}/>", self.tag, attributes.collect::<String>())
    }
}

/// Changes that are not yet made.
pub(super) struct Edits<'t> {
    text: &'t str,
    edits: Vec<(Range<usize>, String)>,
}

impl<'t> Edits<'t> {
    pub fn new(text: &'t str) -> Self {
        let edits = Vec::new();
        Self { text, edits }
    }

    /// The text with all changes.
    pub fn done(mut self) -> String {
        self.edits
            .sort_by_key(|(range, _)| (range.start, range.end));
        let mut out = String::with_capacity(self.text.len() + 64 * self.edits.len());
        let mut at = 0;
        for (range, new) in &self.edits {
            out.push_str(&self.text[at..range.start]);
            out.push_str(new);
            at = range.end;
        }
        out.push_str(&self.text[at..]);
        out
    }

    /// Sets attributes of a child, or inserts it after the other children.
    pub fn set(&mut self, parent: &Element, part: &Part) {
        match parent.child(part.tag) {
            Some(child) => {
                let attributes = part.attributes.iter();
                attributes.for_each(|(name, value)| self.attribute(&child, name, value));
            }
            None => self.insert(parent, |prefix, _, _| part.text(prefix)),
        }
    }

    /// Inserts an element with these parts in it, a line each, after the other children.
    pub fn insert_around(&mut self, parent: &Element, tag: &str, parts: &[Part]) {
        self.insert(parent, |prefix, line, unit| {
            let inner = parts
                .iter()
                .map(|part| format!("{line}{unit}{}", part.text(prefix)));
            let inner: String = inner.collect();
            format!("<{prefix}{tag}>{inner}{line}</{prefix}{tag}>")
        });
    }

    fn attribute(&mut self, element: &Element, name: &str, value: &str) {
        let attribute = element.node.attribute_node(name);
        match attribute {
            Some(attribute) if same_numbers(attribute.value(), value) => {}
            Some(attribute) => self
                .edits
                .push((attribute.range_value(), value.to_string())),
            // Without a rotation it is 0.
            None if name == "rpy" => {}
            None => {
                let last = element.node.attributes().next_back();
                let (at, quote) = match last {
                    Some(last) => (
                        last.range().end,
                        &self.text[last.range().end - 1..last.range().end],
                    ),
                    None => (self.name(element).end, "\""),
                };
                self.edits
                    .push((at..at, format!(" {name}={quote}{value}{quote}")));
            }
        }
    }

    /// Inserts an element made from the prefix of its name, the line break and indentation before it, and the indentation of
    /// one level; these are empty where elements do not stand on lines of their own.
    fn insert(&mut self, parent: &Element, made: impl Fn(&str, &str, &str) -> String) {
        let name = &self.text[self.name(parent)];
        let prefix = name.find(':').map_or("", |colon| &name[..=colon]);
        let own = self.line_before(parent.node.range().start);
        let outer = parent.node.parent_element().map(|node| node.range().start);
        let outer = outer.map_or("", |start| self.line_before(start));
        // Deeper than the element around it by one level, unless that is not indented as is usual.
        let unit = own
            .strip_prefix(outer)
            .filter(|unit| !unit.trim_matches(['\r', '\n']).is_empty());
        let unit = unit.map_or("  ", |unit| unit.trim_matches(['\r', '\n']));
        if let Some(last) = parent.node.last_element_child() {
            let line = self.line_before(last.range().start);
            let unit = if line.is_empty() { "" } else { unit };
            let at = last.range().end;
            self.edits
                .push((at..at, format!("{line}{}", made(prefix, line, unit))));
            return;
        }
        let unit = if own.is_empty() { "" } else { unit };
        let line = format!("{own}{unit}");
        let inner = format!("{line}{}", made(prefix, &line, unit));
        let range = parent.node.range();
        let whole = &self.text[range.clone()];
        if let Some(open) = whole.strip_suffix("/>") {
            let at = range.start + open.trim_end().len();
            self.edits
                .push((at..range.end, format!(">{inner}{own}</{name}>")));
        } else {
            let close = whole.rfind("</").unwrap_or(whole.len());
            let at = range.start + whole[..close].trim_end().len();
            self.edits
                .push((at..range.start + close, format!("{inner}{own}")));
        }
    }

    /// Where the name of an element is, with its prefix.
    fn name(&self, element: &Element) -> Range<usize> {
        let start = element.node.range().start + 1;
        let rest = &self.text[start..];
        let length = rest.find(|c: char| c.is_ascii_whitespace() || c == '/' || c == '>');
        start..start + length.unwrap_or(rest.len())
    }

    /// Line break and indentation before a place, if there is nothing else in its line before.
    fn line_before(&self, at: usize) -> &'t str {
        let before = &self.text[..at];
        let line = before.trim_end_matches([' ', '\t']);
        match line.strip_suffix("\r\n").or(line.strip_suffix('\n')) {
            Some(rest) => &before[rest.len()..],
            None => "",
        }
    }
}

/// Whether two texts are the same numbers.
fn same_numbers(a: &str, b: &str) -> bool {
    let numbers = |text: &str| -> Option<Vec<f64>> {
        text.split_ascii_whitespace()
            .map(|word| word.parse().ok())
            .collect()
    };
    numbers(a).is_some_and(|a| Some(a) == numbers(b))
}
