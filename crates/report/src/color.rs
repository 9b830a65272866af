//! The palette, distinguishable with any kind of colour vision, on light and dark backgrounds.

/// A colour of the palette (after Okabe and Ito, "Color Universal Design", 2008), by role rather
/// than by code: the style sheet holds one shade for light and one for dark surroundings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Color {
    /// First series.
    Blue,
    /// Second series; the strongest contrast to blue.
    Vermilion,
    /// Third series.
    Green,
    /// Fourth series.
    Purple,
    /// Fifth series.
    Orange,
    /// Sixth series.
    Sky,
    /// Background information: measured clouds, reference lines.
    Grey,
    /// The colour of the text.
    Ink,
}

impl Color {
    /// The colours that series without a colour of their own take in turn.
    pub const CYCLE: [Color; 6] = [
        Color::Blue,
        Color::Vermilion,
        Color::Green,
        Color::Purple,
        Color::Orange,
        Color::Sky,
    ];

    /// The class that sets `color`; see `figure.css`.
    pub(crate) fn class(self) -> &'static str {
        match self {
            Color::Blue => "blue",
            Color::Vermilion => "vermilion",
            Color::Green => "green",
            Color::Purple => "purple",
            Color::Orange => "orange",
            Color::Sky => "sky",
            Color::Grey => "grey",
            Color::Ink => "ink",
        }
    }
}
