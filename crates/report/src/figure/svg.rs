//! The `svg` element around a figure.

use crate::escape;

const STYLE: &str = include_str!("figure.css");

/// Where a figure is going to be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    /// In a file of its own, with its style sheet and its paper.
    Alone,
    /// In a document that holds [`style`].
    InDocument,
}

/// The style sheet of all figures.
pub(crate) fn style() -> &'static str {
    STYLE
}

/// A complete `svg` element of the given size (px) around `content`.
pub(crate) fn element(
    place: Place,
    (width, height): (f64, f64),
    title: &str,
    description: &str,
    content: &str,
) -> String {
    let (title, description) = (escape::escaped(title), escape::escaped(description));
    let (attributes, head) = match place {
        Place::Alone => (
            format!(" xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\""),
            format!(
                "<style>\n{STYLE}</style>\n<rect class=\"paper\" width=\"{width}\" height=\"{height}\"/>\n"
            ),
        ),
        Place::InDocument => (String::new(), String::new()),
    };
    format!(
        "<svg{attributes} class=\"fig\" viewBox=\"0 0 {width} {height}\" role=\"img\">\n\
         <title>{title}</title>\n<desc>{description}</desc>\n{head}{content}</svg>\n"
    )
}
