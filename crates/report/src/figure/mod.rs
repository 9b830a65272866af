//! Figures: panels of layers over labelled axes, written as SVG.

mod axis;
mod band;
mod cloud;
mod draw;
mod layer;
mod layout;
mod legend;
mod path;
pub(crate) mod svg;
mod ticks;
mod trace;

pub use axis::{Axis, Range, Scale};
pub(crate) use draw::round;
pub use layer::{Dash, Layer, Samples, Shape};

use crate::text::Text;

/// One plot: two axes and what is drawn over them.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Shown above the plot; may be empty.
    pub title: Text,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// What is drawn, from back to front.
    pub layers: Vec<Layer>,
    /// Height of the plot area in px, 40 to 4000.
    pub height: f64,
    /// Whether the plot area is as high as it is wide, in place of the height: a plane with axes of equal span is then drawn to one
    /// scale.
    pub square: bool,
}

impl Panel {
    /// An empty panel, 240 px high.
    pub fn new(x: Axis, y: Axis) -> Self {
        Self {
            title: Text::new(),
            x,
            y,
            layers: Vec::new(),
            height: 240.0,
            square: false,
        }
    }

    /// Adds a layer in front of the others.
    pub fn layer(mut self, layer: Layer) -> Self {
        self.layers.push(layer);
        self
    }

    /// Sets the title.
    pub fn title(mut self, title: impl Into<Text>) -> Self {
        self.title = title.into();
        self
    }

    /// Makes the plot area as high as it is wide.
    pub fn square(mut self) -> Self {
        self.square = true;
        self
    }

    /// Sets the height of the plot area in px.
    pub fn height(mut self, height: f64) -> Self {
        self.height = height;
        self
    }
}

/// One or more panels under one another, with a caption.
///
/// ```
/// use stiction_report::{Axis, Figure, Layer, Panel};
/// let v = [-0.2, -0.1, 0.1, 0.2];
/// let friction = Panel::new(Axis::new("Velocity", "m/s"), Axis::new("Friction force", "N"))
///     .layer(Layer::line(v, [-25.0, -21.0, 21.0, 25.0]).label("Model"));
/// let svg = Figure::new("Friction over velocity").panel(friction).to_svg();
/// assert!(svg.starts_with("<svg"));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// What it shows, in a few words: the start of the caption, and the name read out by screen
    /// readers.
    pub title: Text,
    /// What the reader should see in it; may be empty.
    pub caption: Text,
    /// The panels, from top to bottom.
    pub panels: Vec<Panel>,
    /// Whether all panels share the horizontal axis of the first.
    pub shared_x: bool,
    /// Width in px at natural size, 240 to 4000. Documents scale figures to their column;
    /// [`Figure::HALF`] suits two side by side.
    pub width: f64,
}

impl Figure {
    /// Width that fills the column of a document, in px.
    pub const FULL: f64 = 860.0;
    /// Width of two figures side by side, in px.
    pub const HALF: f64 = 420.0;

    /// A figure without panels, of full width.
    pub fn new(title: impl Into<Text>) -> Self {
        Self {
            title: title.into(),
            caption: Text::new(),
            panels: Vec::new(),
            shared_x: false,
            width: Self::FULL,
        }
    }

    /// Adds a panel below the others.
    pub fn panel(mut self, panel: Panel) -> Self {
        self.panels.push(panel);
        self
    }

    /// Sets the caption.
    pub fn caption(mut self, caption: impl Into<Text>) -> Self {
        self.caption = caption.into();
        self
    }

    /// Lets all panels share the horizontal axis of the first.
    pub fn shared_x(mut self) -> Self {
        self.shared_x = true;
        self
    }

    /// Makes it half as wide.
    pub fn half(mut self) -> Self {
        self.width = Self::HALF;
        self
    }

    /// A complete SVG file with its own style, for light and dark surroundings.
    pub fn to_svg(&self) -> String {
        layout::render(self, svg::Place::Alone)
    }

    /// The `svg` element for a document that holds the style.
    pub(crate) fn to_inline_svg(&self) -> String {
        layout::render(self, svg::Place::InDocument)
    }
}
