//! `axis.toml`: what is known of the machine and its log. Raw as typed, then resolved to SI.

mod controller;
mod extend;
mod gain;
mod limits;
mod listed;
mod mark;
mod other;
mod resolve;
mod search;
mod template;
mod tied;
mod values;

pub use extend::{Addition, extend};
pub use limits::AxisLimits;
pub use listed::{ListedLog, Use};
pub use mark::{Marks, mark};
pub use other::OtherFile;
pub use resolve::MOST_PITCHES;
pub use template::{Found, entry, template};
pub use values::{Axis, JoinedColumn};
