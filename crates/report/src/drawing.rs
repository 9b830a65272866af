//! A drawing that was made by hand.

use crate::text::Text;

/// A drawing in SVG, with the classes of the figures' style sheet for its lines and text (`line`, `blue`, `ink` and
/// others), so that it suits light and dark surroundings.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// What it shows: the start of the caption.
    pub title: Text,
    /// What the reader should see in it; may be empty.
    pub caption: Text,
    /// The whole `svg` element, of class `fig`. It becomes part of the page as it is, so it is fixed in the program.
    pub svg: &'static str,
    /// Whether it suits half the column of a document.
    pub half: bool,
}

impl Drawing {
    /// A drawing of full width.
    pub fn new(title: impl Into<Text>, svg: &'static str) -> Self {
        Self {
            title: title.into(),
            caption: Text::new(),
            svg,
            half: false,
        }
    }

    /// Sets the caption.
    pub fn caption(mut self, caption: impl Into<Text>) -> Self {
        self.caption = caption.into();
        self
    }

    /// Makes it half as wide.
    pub fn half(mut self) -> Self {
        self.half = true;
        self
    }
}
