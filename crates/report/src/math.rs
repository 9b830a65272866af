//! Formulas as MathML, which every current browser draws and screen readers read out.
//!
//! ```
//! use stiction_report::math::{frac, id, num, op, row, sub};
//! // F = F_c · v / |v|
//! let f = row([id("F"), op("="), sub(id("F"), id("c")), frac(id("v"), row([op("|"), id("v"), op("|")]))]);
//! ```

use crate::escape;

/// A formula or a part of one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Math {
    /// A name: one letter is set italic, several (`exp`, `sgn`) upright.
    Id(String),
    /// A number, written as it should appear.
    Num(String),
    /// An operator, sign or bracket.
    Op(String),
    /// A unit or words, set upright with a space before.
    Unit(String),
    /// Parts side by side.
    Row(Vec<Math>),
    /// A base with a subscript. A name in the subscript is set upright.
    Sub(Box<Math>, Box<Math>),
    /// A base with an exponent.
    Sup(Box<Math>, Box<Math>),
    /// A fraction.
    Frac(Box<Math>, Box<Math>),
    /// The derivative with respect to time: a dot above.
    Dot(Box<Math>),
    /// A part between brackets that grow with it.
    Fence(&'static str, Box<Math>, &'static str),
}

/// A name.
pub fn id(name: impl Into<String>) -> Math {
    Math::Id(name.into())
}

/// A number as it should appear, such as one made by [`stiction_number`].
pub fn num(number: impl Into<String>) -> Math {
    Math::Num(number.into())
}

/// An operator, sign or bracket.
pub fn op(sign: impl Into<String>) -> Math {
    Math::Op(sign.into())
}

/// A number with its unit.
pub fn quantity(number: impl Into<String>, unit: impl Into<String>) -> Math {
    let unit = unit.into();
    if unit.is_empty() {
        num(number)
    } else {
        row([num(number), Math::Unit(unit)])
    }
}

/// Parts side by side.
pub fn row(parts: impl IntoIterator<Item = Math>) -> Math {
    Math::Row(parts.into_iter().collect())
}

/// A base with a subscript.
pub fn sub(base: Math, below: Math) -> Math {
    Math::Sub(Box::new(base), Box::new(below))
}

/// A base with an exponent.
pub fn sup(base: Math, above: Math) -> Math {
    Math::Sup(Box::new(base), Box::new(above))
}

/// A fraction.
pub fn frac(above: Math, below: Math) -> Math {
    Math::Frac(Box::new(above), Box::new(below))
}

/// A dot above: the derivative with respect to time.
pub fn dot(base: Math) -> Math {
    Math::Dot(Box::new(base))
}

/// A part in round brackets.
pub fn paren(inner: Math) -> Math {
    Math::Fence("(", Box::new(inner), ")")
}

/// The absolute value of a part.
pub fn abs(inner: Math) -> Math {
    Math::Fence("|", Box::new(inner), "|")
}

impl Math {
    /// A `math` element on a line of its own.
    pub(crate) fn to_mathml(&self) -> String {
        let mut out = String::from("<math display=\"block\">");
        self.push(&mut out, false);
        out.push_str("</math>");
        out
    }

    fn push(&self, out: &mut String, upright: bool) {
        let leaf = |out: &mut String, tag: &str, attributes: &str, text: &str| {
            out.push_str(&format!(
                "<{tag}{attributes}>{}</{tag}>",
                escape::escaped(text)
            ));
        };
        let several = |out: &mut String, tag: &str, parts: &[(&Math, bool)]| {
            out.push_str(&format!("<{tag}>"));
            for (part, upright) in parts {
                part.push(out, *upright);
            }
            out.push_str(&format!("</{tag}>"));
        };
        match self {
            Math::Id(name) if upright => leaf(out, "mi", " mathvariant=\"normal\"", name),
            // A function name keeps its distance from what stands before it.
            Math::Id(name) if name.chars().nth(1).is_some() => {
                out.push_str("<mrow><mspace width=\"0.17em\"></mspace>");
                leaf(out, "mi", "", name);
                out.push_str("</mrow>");
            }
            Math::Id(name) => leaf(out, "mi", "", name),
            Math::Num(number) => leaf(out, "mn", "", number),
            Math::Op(sign) => leaf(out, "mo", "", sign),
            Math::Unit(unit) => {
                out.push_str("<mrow><mspace width=\"0.22em\"></mspace>");
                leaf(out, "mtext", "", &crate::number::unit(unit));
                out.push_str("</mrow>");
            }
            Math::Row(parts) => {
                let parts: Vec<_> = parts.iter().map(|part| (part, upright)).collect();
                several(out, "mrow", &parts);
            }
            Math::Sub(base, below) => several(out, "msub", &[(base, upright), (below, true)]),
            Math::Sup(base, above) => several(out, "msup", &[(base, upright), (above, upright)]),
            Math::Frac(above, below) => {
                several(out, "mfrac", &[(above, upright), (below, upright)])
            }
            Math::Dot(base) => {
                out.push_str("<mover accent=\"true\">");
                base.push(out, upright);
                out.push_str("<mo>˙</mo></mover>");
            }
            Math::Fence(open, inner, close) => {
                let bracket = |out: &mut String, sign: &str, form: &str| {
                    let attributes = format!(" stretchy=\"true\" form=\"{form}\"");
                    leaf(out, "mo", &attributes, sign);
                };
                out.push_str("<mrow>");
                bracket(out, open, "prefix");
                inner.push(out, upright);
                bracket(out, close, "postfix");
                out.push_str("</mrow>");
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nested_and_escaped() {
        let f = row([
            dot(id("z")),
            op("<"),
            frac(abs(id("v")), sup(sub(id("F"), id("s")), num("2"))),
        ]);
        let xml = f.to_mathml();
        let tree = roxmltree::Document::parse(&xml).unwrap();
        let shown: String = tree
            .descendants()
            .filter(|n| n.is_text())
            .filter_map(|n| n.text())
            .collect();
        assert_eq!(shown, "z˙<|v|Fs2");
    }

    #[test]
    fn every_script_and_fraction_has_two_parts() {
        let parts = [
            id("F"),
            id("exp"),
            num("1"),
            op("+"),
            quantity("5", "N"),
            Math::Unit("m".into()),
            row([]),
            dot(id("z")),
            abs(id("v")),
        ];
        for a in &parts {
            for b in &parts {
                let two = |f: fn(Math, Math) -> Math| f(a.clone(), b.clone());
                let f = row([two(sub), two(sup), two(frac), dot(b.clone())]);
                let xml = f.to_mathml();
                let tree = roxmltree::Document::parse(&xml).unwrap();
                for node in tree.descendants() {
                    if ["msub", "msup", "mfrac", "mover"].contains(&node.tag_name().name()) {
                        assert_eq!(node.children().count(), 2, "{xml}");
                    }
                }
            }
        }
    }
}
