//! Plain data to SVG figures and a self-contained HTML document.
//!
//! Start with [`Document`] and add blocks, or with [`Figure`] for a single SVG file.
//!
//! A [`Document`] is a list of [`Block`]s: paragraphs, tables, figures, formulas, messages. It becomes
//! one HTML file without scripts and without anything to load, in light and dark, on screen and on
//! paper. A [`Figure`] is a stack of [`Panel`]s with [`Layer`]s; it and the [`Heatmap`] also stand
//! alone as SVG files.
//!
//! - Strings are shown literally, whatever they hold: column names and paths from outside cannot
//!   become markup.
//! - Numbers may be anything: empty, constant, not finite, from 1e-300 to 1e300, of unequal lengths.
//! - Millions of samples become some tens of kilobytes, and every peak stays visible.
//! - The same input gives the same bytes on every machine.
//!
//! ```
//! use stiction_report::{Axis, Document, Figure, Layer, Panel, Text};
//! let v = [-0.2, -0.1, 0.1, 0.2];
//! let map = Panel::new(Axis::new("Velocity", "m/s"), Axis::new("Friction force", "N"))
//!     .layer(Layer::points(v, [-25.1, -20.8, 21.0, 24.9]).label("Measured"));
//! let html = Document::new("Friction of the X axis")
//!     .heading(2, "Result")
//!     .paragraph(Text::from("The log is ").code("x-axis.csv").plain("."))
//!     .block(Figure::new("Friction over velocity").panel(map))
//!     .to_html();
//! assert!(html.starts_with("<!DOCTYPE html>"));
//! ```

mod color;
mod document;
mod drawing;
mod escape;
mod figure;
mod heatmap;
pub mod math;
pub use stiction_number as number;
mod text;

pub use color::Color;
pub use document::{Align, Block, Callout, Document, KeyFigure, Row, Severity, Table};
pub use drawing::Drawing;
pub use figure::{Axis, Dash, Figure, Layer, Panel, Range, Samples, Scale, Shape};
pub use heatmap::Heatmap;
pub use math::Math;
pub use text::Text;
