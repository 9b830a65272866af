//! The text of a URDF as an XML tree, within limits.

use super::{Lines, MOST_BYTES, MOST_ELEMENTS};
use crate::Error;

/// Elements, texts and comments.
const MOST_NODES: u32 = 100_000;
/// Attributes of one element: the XML parser compares each with each.
const MOST_ATTRIBUTES: usize = 1000;

/// The XML tree of a URDF whose root is `<robot>`.
pub(crate) fn scan<'t>(text: &'t str, lines: &Lines) -> Result<roxmltree::Document<'t>, Error> {
    let large = |what, most| Error::Large { what, most };
    if text.len() > MOST_BYTES {
        return Err(large("bytes", MOST_BYTES));
    }
    // No `<` is allowed in a tag, so that an element's attributes are between two of them.
    if text.split('<').any(|tag| attributes(tag) > MOST_ATTRIBUTES) {
        return Err(large("attributes in an element", MOST_ATTRIBUTES));
    }
    let options = roxmltree::ParsingOptions {
        nodes_limit: MOST_NODES,
        ..Default::default()
    };
    let xml = roxmltree::Document::parse_with_options(text, options).map_err(|e| match e {
        roxmltree::Error::NodesLimitReached => large("nodes", MOST_NODES as usize),
        roxmltree::Error::UnknownNamespace(prefix, at) if prefix == "xacro" => Error::Xacro {
            line: at.row as usize,
        },
        other => Error::NotXml {
            line: other.pos().row as usize,
            reason: other.to_string(),
        },
    })?;
    let line = |node: &roxmltree::Node| lines.number(node.range().start);
    let root = xml.root_element();
    if root.tag_name().name() != "robot" {
        return Err(Error::NoRobot {
            line: line(&root),
            found: root.tag_name().name().to_string(),
        });
    }
    let mut elements = 0;
    for node in root.descendants().filter(roxmltree::Node::is_element) {
        elements += 1;
        let space = node.tag_name().namespace();
        if space.is_some_and(|space| space.ends_with("xacro")) {
            return Err(Error::Xacro { line: line(&node) });
        }
    }
    if elements > MOST_ELEMENTS {
        return Err(large("elements", MOST_ELEMENTS));
    }
    Ok(xml)
}

/// How many attributes the text of a tag may have.
fn attributes(tag: &str) -> usize {
    let quoted = |value: &&str| value.trim_ascii_start().starts_with(['"', '\'']);
    tag.split('=').filter(quoted).count()
}
