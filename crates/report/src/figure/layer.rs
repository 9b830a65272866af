//! What is drawn in a panel.

use std::sync::Arc;

use crate::color::Color;
use crate::text::Text;

/// Samples, shared rather than copied between layers. Made from a `Vec<f64>` or a slice.
pub type Samples = Arc<[f64]>;

/// The geometry of a layer. Where it holds several columns, the shortest counts. Values that are not
/// finite (or not positive on a logarithmic axis) have no place: lines break there, points and bars
/// are left out.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// Samples joined in their order. Long ones are reduced to what can be seen.
    Line {
        /// Horizontal values.
        x: Samples,
        /// Vertical values.
        y: Samples,
    },
    /// Each value held until the next sample.
    Steps {
        /// Horizontal values.
        x: Samples,
        /// Vertical values.
        y: Samples,
    },
    /// One dot a sample; large clouds become a density map.
    Points {
        /// Horizontal values.
        x: Samples,
        /// Vertical values.
        y: Samples,
    },
    /// One bar a sample, from `base` to the value.
    Bars {
        /// Horizontal values: the middle of each bar.
        x: Samples,
        /// Vertical values.
        y: Samples,
        /// Where bars start.
        base: f64,
    },
    /// The area between two curves, in order of `x`. An infinite edge reaches the end of the axis.
    Band {
        /// Horizontal values.
        x: Samples,
        /// Lower edge.
        low: Samples,
        /// Upper edge.
        high: Samples,
    },
    /// Vertical intervals with caps.
    ErrorBars {
        /// Horizontal values.
        x: Samples,
        /// Lower ends.
        low: Samples,
        /// Upper ends.
        high: Samples,
    },
    /// Horizontal intervals with caps.
    Intervals {
        /// Vertical values.
        y: Samples,
        /// Left ends.
        low: Samples,
        /// Right ends.
        high: Samples,
    },
    /// A horizontal line across the panel.
    HLine(f64),
    /// A vertical line across the panel.
    VLine(f64),
    /// A horizontal stripe across the panel, such as the band of white noise.
    HBand(f64, f64),
    /// A vertical stripe across the panel, such as a window in time.
    VBand(f64, f64),
    /// The label of the layer, written at a place in the panel.
    Note {
        /// Horizontal place.
        x: f64,
        /// Vertical place.
        y: f64,
    },
}

/// How a line is interrupted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dash {
    /// Not at all.
    Solid,
    /// Dashes.
    Dashed,
    /// Dots.
    Dotted,
}

/// One layer of a panel; later layers cover earlier ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// What it is, for the legend; without one it is not listed.
    pub label: Option<Text>,
    /// Its colour; without one the next of [`Color::CYCLE`] for data, grey for lines and stripes
    /// across the panel.
    pub color: Option<Color>,
    /// Width of lines, diameter of dots, in px.
    pub width: f64,
    /// Interruption of lines.
    pub dash: Dash,
    /// 0 (invisible) to 1.
    pub opacity: f64,
    /// The geometry.
    pub shape: Shape,
}

impl Layer {
    /// A layer of the given shape with the usual width and opacity.
    pub fn new(shape: Shape) -> Self {
        let (width, opacity) = match shape {
            Shape::Points { .. } => (3.0, 0.7),
            Shape::Band { .. } | Shape::HBand(..) | Shape::VBand(..) => (0.0, 0.2),
            Shape::Bars { .. } => (0.0, 1.0),
            Shape::HLine(_) | Shape::VLine(_) => (1.0, 1.0),
            _ => (1.5, 1.0),
        };
        Self {
            label: None,
            color: None,
            width,
            dash: Dash::Solid,
            opacity,
            shape,
        }
    }

    /// A [`Shape::Line`].
    pub fn line(x: impl Into<Samples>, y: impl Into<Samples>) -> Self {
        Self::new(Shape::Line {
            x: x.into(),
            y: y.into(),
        })
    }

    /// A [`Shape::Steps`].
    pub fn steps(x: impl Into<Samples>, y: impl Into<Samples>) -> Self {
        Self::new(Shape::Steps {
            x: x.into(),
            y: y.into(),
        })
    }

    /// A [`Shape::Points`].
    pub fn points(x: impl Into<Samples>, y: impl Into<Samples>) -> Self {
        Self::new(Shape::Points {
            x: x.into(),
            y: y.into(),
        })
    }

    /// A [`Shape::Bars`] from 0.
    pub fn bars(x: impl Into<Samples>, y: impl Into<Samples>) -> Self {
        Self::new(Shape::Bars {
            x: x.into(),
            y: y.into(),
            base: 0.0,
        })
    }

    /// A [`Shape::Band`].
    pub fn band(x: impl Into<Samples>, low: impl Into<Samples>, high: impl Into<Samples>) -> Self {
        Self::new(Shape::Band {
            x: x.into(),
            low: low.into(),
            high: high.into(),
        })
    }

    /// A [`Shape::ErrorBars`].
    pub fn error_bars(
        x: impl Into<Samples>,
        low: impl Into<Samples>,
        high: impl Into<Samples>,
    ) -> Self {
        Self::new(Shape::ErrorBars {
            x: x.into(),
            low: low.into(),
            high: high.into(),
        })
    }

    /// A [`Shape::Intervals`].
    pub fn intervals(
        y: impl Into<Samples>,
        low: impl Into<Samples>,
        high: impl Into<Samples>,
    ) -> Self {
        Self::new(Shape::Intervals {
            y: y.into(),
            low: low.into(),
            high: high.into(),
        })
    }

    /// A [`Shape::HLine`].
    pub fn hline(y: f64) -> Self {
        Self::new(Shape::HLine(y))
    }

    /// A [`Shape::VLine`].
    pub fn vline(x: f64) -> Self {
        Self::new(Shape::VLine(x))
    }

    /// A [`Shape::HBand`].
    pub fn hband(low: f64, high: f64) -> Self {
        Self::new(Shape::HBand(low, high))
    }

    /// A [`Shape::VBand`].
    pub fn vband(low: f64, high: f64) -> Self {
        Self::new(Shape::VBand(low, high))
    }

    /// A [`Shape::Note`].
    pub fn note(x: f64, y: f64, text: impl Into<Text>) -> Self {
        Self::new(Shape::Note { x, y }).label(text)
    }

    /// Names it in the legend.
    pub fn label(mut self, label: impl Into<Text>) -> Self {
        self.label = Some(label.into());
        self
    }

    /// Sets the colour.
    pub fn color(mut self, color: Color) -> Self {
        self.color = Some(color);
        self
    }

    /// Sets the width of lines or the diameter of dots, in px.
    pub fn width(mut self, width: f64) -> Self {
        self.width = width;
        self
    }

    /// Sets the interruption of lines.
    pub fn dash(mut self, dash: Dash) -> Self {
        self.dash = dash;
        self
    }

    /// Sets the opacity, 0 to 1.
    pub fn opacity(mut self, opacity: f64) -> Self {
        self.opacity = opacity;
        self
    }

    /// Whether it is data rather than a reference across the panel.
    pub(crate) fn is_data(&self) -> bool {
        !matches!(
            self.shape,
            Shape::HLine(_)
                | Shape::VLine(_)
                | Shape::HBand(..)
                | Shape::VBand(..)
                | Shape::Note { .. }
        )
    }

    /// The columns that an automatic range spans: horizontal, vertical.
    pub(crate) fn columns(&self) -> (Vec<&[f64]>, Vec<&[f64]>) {
        use std::slice::from_ref;
        match &self.shape {
            Shape::Line { x, y } | Shape::Steps { x, y } | Shape::Points { x, y } => {
                let [x, y] = shortest([x, y]);
                (vec![x], vec![y])
            }
            Shape::Bars { x, y, base } => {
                let [x, y] = shortest([x, y]);
                (vec![x], vec![y, from_ref(base)])
            }
            Shape::Band { x, low, high } | Shape::ErrorBars { x, low, high } => {
                let [x, low, high] = shortest([x, low, high]);
                (vec![x], vec![low, high])
            }
            Shape::Intervals { y, low, high } => {
                let [y, low, high] = shortest([y, low, high]);
                (vec![low, high], vec![y])
            }
            Shape::HLine(y) => (vec![], vec![from_ref(y)]),
            Shape::VLine(x) => (vec![from_ref(x)], vec![]),
            Shape::HBand(low, high) => (vec![], vec![from_ref(low), from_ref(high)]),
            Shape::VBand(low, high) => (vec![from_ref(low), from_ref(high)], vec![]),
            Shape::Note { x, y } => (vec![from_ref(x)], vec![from_ref(y)]),
        }
    }
}

/// Columns cut to the length of the shortest.
pub(crate) fn shortest<const N: usize>(columns: [&Samples; N]) -> [&[f64]; N] {
    let length = columns.iter().map(|c| c.len()).min().unwrap_or(0);
    columns.map(|c| &c[..length])
}
