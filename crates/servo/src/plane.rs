//! Contours of two axes: their shapes, the motion along them, and the deviation of a point from them.

mod along;
mod curve;
mod shapes;

pub use along::{Along, FreeForm, PlaneMotion, Station};
pub use curve::{Curve, Deviation, Foot, Place, foot};
pub use shapes::{Circle, FigureEight, Polygon};
