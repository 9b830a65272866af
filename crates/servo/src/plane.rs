//! Contours of two axes: what they are, the way along them, and how far from them a point is.

mod along;
mod curve;
mod shapes;

pub use along::{Along, FreeForm, PlaneMotion, Station};
pub use curve::{Curve, Deviation, Foot, Place, foot};
pub use shapes::{Circle, FigureEight, Polygon};
