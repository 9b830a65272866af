//! Whether a number that is estimated again and again has changed.
//!
//! Each estimate has an interval, and from log to log there is more than intervals say: scatter that is not normal, slow wandering,
//! what temperature does. [`Noise::of`] finds how much of each from all machines together, [`Limits::of`] from which deviation on
//! a number has changed, so that of machines in which nothing changes no more than a given part is alarmed over a horizon, whatever
//! the number of parameters, and [`judge`] follows one machine: the reference is the median of its first logs, and it has changed
//! where the median of the last 5, 10 or 20 is further from that than its limit. Each log counts by its interval.
//!
//! ```
//! use stiction_drift::{Limits, Noise, Point, Settings, judge};
//!
//! const DAY: f64 = 86_400.0; // s
//! // Coulomb friction of 20 N with 1 % of noise, a log a day; from day 40 on it is 15 % higher.
//! let noise = |day: u32| 0.2 * (f64::from(day * day) * 1.234).sin();
//! let one = |day: u32, step: f64| Point {
//!     time: DAY * f64::from(day),
//!     value: 20.0 * (1.0 + step) + noise(day),
//!     std: 0.1,
//!     temperature: None,
//! };
//! let quiet: Vec<Point> = (0..60).map(|day| one(day, 0.0)).collect();
//! let stepped: Vec<Point> = (0..60).map(|day| one(day, if day < 40 { 0.0 } else { 0.15 })).collect();
//!
//! let noise = Noise::of(&[&quiet, &stepped]).expect("long enough");
//! let limits = Limits::of(&noise, 1, &Settings::default());
//! assert!(judge(&quiet, &noise, &limits).unwrap().changes.is_empty());
//! let change = judge(&stepped, &noise, &limits).unwrap().changes[0];
//! assert!((40..45).contains(&change.found));
//! assert!(change.low < 0.15 && 0.15 < change.high);
//! ```

mod course;
mod judge;
mod limits;
mod noise;
mod random;
mod robust;

pub use course::{Measure, Point};
pub use judge::{Change, Judged, Kind, judge, plain};
pub use limits::{Limits, Settings, WINDOWS};
pub use noise::Noise;
