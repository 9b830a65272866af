//! Rich text: runs of characters with one emphasis each, written as HTML or as SVG.

use crate::escape;
use stiction_number::times_ten;

#[derive(Debug, Clone, PartialEq, Eq)]
enum Style {
    Plain,
    Bold,
    Italic,
    Code,
    Sub,
    Sup,
    Link(String),
}

/// A line or paragraph of rich text, built run by run. Whatever the strings hold is shown
/// literally; there is no markup to escape from.
///
/// ```
/// use stiction_report::Text;
/// let text = Text::from("Coulomb force ").italic("F").subscript("c").plain(" of ").code("axis.toml");
/// assert_eq!(text.to_plain(), "Coulomb force Fc of axis.toml");
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Text(Vec<(Style, String)>);

impl Text {
    /// Empty text.
    pub fn new() -> Self {
        Self::default()
    }

    /// A symbol as in a formula: italic `base`, upright subscript (none when empty).
    pub fn symbol(base: &str, subscript: &str) -> Self {
        let text = Self::new().italic(base);
        if subscript.is_empty() {
            text
        } else {
            text.subscript(subscript)
        }
    }

    /// A message as a terminal shows it, typeset: powers of ten as everywhere in a report, `1.2×10⁻⁵` for `1.2e-5`. What a
    /// reader would type, in quotes or as part of a name, stays as it is.
    ///
    /// ```
    /// use stiction_report::Text;
    /// let text = Text::of_message("off by 1.2e-5 N in run1e5.csv; say resolution = \"1e-6 m\"");
    /// assert_eq!(text.to_plain(), "off by 1.2×10⁻⁵ N in run1e5.csv; say resolution = \"1e-6 m\"");
    /// ```
    pub fn of_message(message: &str) -> Self {
        let mut out = String::new();
        for (i, part) in message.split('"').enumerate() {
            if i > 0 {
                out.push('"');
            }
            // Every second part stands between quotes.
            if i % 2 == 1 {
                out.push_str(part);
            } else {
                let words: Vec<String> = part.split(' ').map(typeset_word).collect();
                out.push_str(&words.join(" "));
            }
        }
        Self::from(out)
    }

    fn run(mut self, style: Style, text: impl Into<String>) -> Self {
        self.0.push((style, text.into()));
        self
    }

    /// Appends ordinary characters.
    pub fn plain(self, text: impl Into<String>) -> Self {
        self.run(Style::Plain, text)
    }

    /// Appends bold characters.
    pub fn bold(self, text: impl Into<String>) -> Self {
        self.run(Style::Bold, text)
    }

    /// Appends italic characters.
    pub fn italic(self, text: impl Into<String>) -> Self {
        self.run(Style::Italic, text)
    }

    /// Appends characters in a fixed-width face: file names, columns, codes.
    pub fn code(self, text: impl Into<String>) -> Self {
        self.run(Style::Code, text)
    }

    /// Appends a subscript.
    pub fn subscript(self, text: impl Into<String>) -> Self {
        self.run(Style::Sub, text)
    }

    /// Appends a superscript.
    pub fn superscript(self, text: impl Into<String>) -> Self {
        self.run(Style::Sup, text)
    }

    /// Appends a link. Targets other than http, https, mailto, anchors and relative paths are
    /// shown as their text only.
    pub fn link(self, text: impl Into<String>, target: impl Into<String>) -> Self {
        self.run(Style::Link(target.into()), text)
    }

    /// Appends all runs of `other`.
    pub fn then(mut self, other: impl Into<Text>) -> Self {
        self.0.extend(other.into().0);
        self
    }

    /// Whether there are no characters.
    pub fn is_empty(&self) -> bool {
        self.0.iter().all(|(_, text)| text.is_empty())
    }

    /// The characters alone.
    pub fn to_plain(&self) -> String {
        self.0.iter().map(|(_, text)| text.as_str()).collect()
    }

    /// Appends HTML phrasing content.
    pub(crate) fn push_html(&self, out: &mut String) {
        self.push_html_with(out, escape::push);
    }

    /// Appends HTML phrasing content with places in long words where a line may be broken.
    pub(crate) fn push_html_breaking(&self, out: &mut String) {
        self.push_html_with(out, |out, text| {
            let mut pieces = pieces(text).peekable();
            while let Some(piece) = pieces.next() {
                escape::push(out, piece);
                if pieces.peek().is_some() && !piece.ends_with(char::is_whitespace) {
                    out.push_str("<wbr/>");
                }
            }
        });
    }

    fn push_html_with(&self, out: &mut String, push: impl Fn(&mut String, &str)) {
        for (style, text) in &self.0 {
            let tag = match style {
                Style::Plain => "",
                Style::Bold => "strong",
                Style::Italic => "em",
                Style::Code => "code",
                Style::Sub => "sub",
                Style::Sup => "sup",
                Style::Link(target) if escape::is_safe_link(target) => {
                    out.push_str("<a href=\"");
                    escape::push(out, target.trim());
                    out.push_str("\">");
                    push(out, text);
                    out.push_str("</a>");
                    continue;
                }
                Style::Link(_) => "",
            };
            if tag.is_empty() {
                push(out, text);
            } else {
                out.push_str(&format!("<{tag}>"));
                push(out, text);
                out.push_str(&format!("</{tag}>"));
            }
        }
    }

    /// HTML phrasing content.
    pub(crate) fn to_html(&self) -> String {
        let mut out = String::new();
        self.push_html(&mut out);
        out
    }

    /// Appends the content of an SVG `text` element. Shifted runs use `dy`, because
    /// `baseline-shift` is not drawn by every browser.
    pub(crate) fn push_svg(&self, out: &mut String) {
        let mut lowered = 0.0;
        for (style, text) in &self.0 {
            let (shift, attributes) = match style {
                Style::Plain | Style::Link(_) => (0.0, ""),
                Style::Bold => (0.0, " font-weight=\"600\""),
                Style::Italic => (0.0, " font-style=\"italic\""),
                Style::Code => (0.0, " class=\"mono\""),
                Style::Sub => (3.0, " font-size=\"76%\""),
                Style::Sup => (-4.0, " font-size=\"76%\""),
            };
            if shift == lowered && attributes.is_empty() {
                escape::push(out, text);
                continue;
            }
            out.push_str("<tspan");
            if shift != lowered {
                out.push_str(&format!(" dy=\"{}\"", shift - lowered));
                lowered = shift;
            }
            out.push_str(attributes);
            out.push('>');
            escape::push(out, text);
            out.push_str("</tspan>");
        }
    }

    /// A cautious estimate of the width at `size` px: the fonts of the reader are not known here,
    /// so the widths are those of a wide sans serif.
    pub(crate) fn width(&self, size: f64) -> f64 {
        self.0
            .iter()
            .map(|(style, text)| style.width(text))
            .sum::<f64>()
            * size
    }

    /// The same of the widest part that is not broken in a table.
    pub(crate) fn widest_piece(&self, size: f64) -> f64 {
        let (mut widest, mut width) = (0.0_f64, 0.0);
        for (style, text) in &self.0 {
            let mut pieces = pieces(text).peekable();
            while let Some(piece) = pieces.next() {
                width += style.width(piece.trim_end());
                widest = widest.max(width);
                // A word may go on in the next run, such as a symbol and its subscript.
                if pieces.peek().is_some() || piece.ends_with(char::is_whitespace) {
                    width = 0.0;
                }
            }
        }
        widest * size
    }
}

/// A word that is a number with a power of ten, typeset; any other as it is.
fn typeset_word(word: &str) -> String {
    let is_bracket = |c: char| "()[];,:".contains(c) || c == '.';
    let inner = word.trim_matches(is_bracket);
    let typeset = inner.split_once('e').and_then(|(digits, power)| {
        let exponent: i32 = power.parse().ok()?;
        let unsigned = digits.trim_start_matches(['-', '+']);
        let is_number =
            !unsigned.is_empty() && unsigned.chars().all(|c| c.is_ascii_digit() || c == '.');
        is_number.then(|| format!("{}{}", digits.replace('-', "−"), times_ten(exponent)))
    });
    match typeset {
        Some(number) => word.replacen(inner, &number, 1),
        None => word.into(),
    }
}

impl Style {
    /// Width of characters over the size of the font.
    fn width(&self, text: &str) -> f64 {
        let ems = text.chars().map(em_width).sum::<f64>();
        match self {
            Style::Sub | Style::Sup => 0.76 * ems,
            Style::Bold => 1.08 * ems,
            Style::Code => 0.62 * text.chars().count() as f64,
            _ => ems,
        }
    }
}

/// Characters of a word from which on it may be broken in a table: file names, hashes.
const LONG_WORD: usize = 24;

/// The parts of a text between which a line of a table may be broken, blanks at their ends.
fn pieces(text: &str) -> impl Iterator<Item = &str> {
    text.split_inclusive([' ', '\n', '\t']).flat_map(|word| {
        let long = word.chars().count() > LONG_WORD;
        let mut letters = 0;
        word.split_inclusive(move |c: char| {
            letters += 1;
            let end = long && ("/\\_.-,=".contains(c) || letters == LONG_WORD);
            if end {
                letters = 0;
            }
            end
        })
    })
}

fn em_width(c: char) -> f64 {
    match c {
        'i' | 'j' | 'l' | 't' | 'f' | 'r' | 'I' | ' ' | '.' | ',' | ':' | ';' | '\'' | '|'
        | '!' | '(' | ')' | '[' | ']' | '/' => 0.37,
        '⁰'..='⁹' | '²' | '³' | '¹' | '⁻' | '₀'..='₉' => 0.42,
        'm' | 'w' | 'M' | 'W' | '@' | '%' => 0.92,
        'A'..='Z' => 0.7,
        '\u{300}'..='\u{36f}' => 0.0,
        '\u{2e80}'.. => 1.05,
        _ => 0.6,
    }
}

impl From<&str> for Text {
    fn from(text: &str) -> Self {
        Self::new().plain(text)
    }
}

impl From<String> for Text {
    fn from(text: String) -> Self {
        Self::new().plain(text)
    }
}

impl From<&Text> for Text {
    fn from(text: &Text) -> Self {
        text.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn html_and_svg_show_the_same_characters() {
        let text = Text::symbol("F", "c")
            .plain(" < 5")
            .superscript("2")
            .bold("!")
            .link("x", "javascript:y");
        assert_eq!(
            text.to_html(),
            "<em>F</em><sub>c</sub> &lt; 5<sup>2</sup><strong>!</strong>x"
        );
        let mut svg = String::new();
        text.push_svg(&mut svg);
        let tree = format!("<t>{svg}</t>");
        let tree = roxmltree::Document::parse(&tree).unwrap();
        let shown: String = tree
            .root()
            .descendants()
            .filter_map(|n| n.text().filter(|_| n.is_text()))
            .collect();
        assert_eq!(shown, text.to_plain());
        let shifts: f64 = tree
            .root()
            .descendants()
            .filter_map(|n| n.attribute("dy"))
            .map(|dy| dy.parse::<f64>().unwrap())
            .sum();
        assert_eq!(shifts, 0.0, "the last run is back on the base line");
    }

    #[test]
    fn safe_links_are_links() {
        assert_eq!(
            Text::new().link("a", "b.html?c&d").to_html(),
            "<a href=\"b.html?c&amp;d\">a</a>"
        );
    }
}
