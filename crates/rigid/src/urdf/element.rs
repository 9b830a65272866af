//! An XML element whose attributes are numbers.

use super::Lines;
use crate::Error;

/// Largest length, mass, inertia or ratio: products of some of them are finite.
const LARGEST: f64 = 1e50;

#[derive(Clone, Copy)]
pub(crate) struct Element<'a> {
    pub node: roxmltree::Node<'a, 'a>,
    lines: &'a Lines,
}

impl<'a> Element<'a> {
    pub fn root(xml: &'a roxmltree::Document<'a>, lines: &'a Lines) -> Self {
        let node = xml.root_element();
        Self { node, lines }
    }

    pub fn name(&self) -> &'a str {
        self.node.tag_name().name()
    }

    pub fn line(&self) -> usize {
        self.lines.number(self.node.range().start)
    }

    /// The elements in it, without those of other namespaces.
    pub fn children(&self) -> impl Iterator<Item = Self> + use<'a> {
        let lines = self.lines;
        let space = self.node.tag_name().namespace();
        let elements = self.node.children().filter(roxmltree::Node::is_element);
        let own = elements.filter(move |node| node.tag_name().namespace() == space);
        own.map(move |node| Self { node, lines })
    }

    /// The first element of that name in it.
    pub fn child(&self, name: &str) -> Option<Self> {
        self.children().find(|child| child.name() == name)
    }

    pub fn needed_child(&self, own: &'static str, name: &'static str) -> Result<Self, Error> {
        self.child(name).ok_or_else(|| self.missing(own, name))
    }

    pub fn attribute(&self, name: &str) -> Option<&'a str> {
        self.node.attribute(name)
    }

    pub fn needed(&self, own: &'static str, name: &'static str) -> Result<&'a str, Error> {
        self.attribute(name).ok_or_else(|| self.missing(own, name))
    }

    pub fn missing(&self, element: &'static str, missing: &'static str) -> Error {
        Error::Missing {
            line: self.line(),
            element,
            missing,
        }
    }

    /// The error of an attribute's value.
    pub fn refused(&self, attribute: &'static str, allowed: &'static str) -> Error {
        let found = self.attribute(attribute).unwrap_or_default();
        let line = self.line();
        if found.contains("${") {
            return Error::Xacro { line };
        }
        Error::Number {
            line,
            attribute,
            found: found.chars().take(80).collect(),
            allowed,
        }
    }

    /// A finite number.
    pub fn number(&self, name: &'static str) -> Result<Option<f64>, Error> {
        let Some(text) = self.attribute(name) else {
            return Ok(None);
        };
        match text.trim().parse::<f64>() {
            Ok(x) if x.is_finite() => Ok(Some(x)),
            _ => Err(self.refused(name, "a finite number")),
        }
    }

    /// A length, mass, inertia or ratio.
    pub fn size(&self, name: &'static str, default: f64) -> Result<f64, Error> {
        let x = self.number(name)?.unwrap_or(default);
        if x.abs() <= LARGEST {
            Ok(x)
        } else {
            Err(self.refused(name, "-1e50 to 1e50"))
        }
    }

    /// Three numbers.
    pub fn vector(&self, name: &'static str) -> Result<Option<[f64; 3]>, Error> {
        let Some(text) = self.attribute(name) else {
            return Ok(None);
        };
        let mut words = text.split_ascii_whitespace();
        let mut next = || words.next()?.parse::<f64>().ok();
        let numbers = [next(), next(), next()];
        let [Some(x), Some(y), Some(z)] = numbers else {
            return Err(self.refused(name, "three numbers"));
        };
        if words.next().is_some() || ![x, y, z].iter().all(|x| x.abs() <= LARGEST) {
            return Err(self.refused(name, "three numbers, -1e50 to 1e50"));
        }
        Ok(Some([x, y, z]))
    }
}
