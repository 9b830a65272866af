//! Every threshold that steers a verdict, a warning or a choice, by meaning, with its unit and where its value comes from.
//!
//! A number is a threshold if another value would decide otherwise: of a law, of what is said of a log or a fit, of which samples count.
//! Tolerances and bounds of solvers and searches, grids, sizes, constants of physics or mathematics, what is believed before a log, and
//! ranges of what users may write are none; they stand where they are used.
//!
//! ```
//! let choice = stiction_policy::TABLES.iter().find(|(name, _)| *name == "choice").unwrap();
//! assert!(choice.1.iter().all(|row| !row.source.is_empty()));
//! ```

/// Thresholds of one meaning: constants, and rows to print.
macro_rules! thresholds {
    ($($name:ident: $type:ty = $value:expr, $unit:literal, $meaning:literal, $source:literal;)*) => {
        $(#[doc = concat!($meaning, "\n\nUnit: ", $unit, ". Source: ", $source, ".")] pub const $name: $type = $value;)*

        pub(crate) const ROWS: &[crate::Row] = &[$(crate::Row {
            name: stringify!($name),
            value: stringify!($value),
            unit: $unit,
            meaning: $meaning,
            source: $source,
        },)*];
    };
}

/// The tables, a file each.
macro_rules! tables {
    ($($table:ident),*) => {
        $(pub mod $table;)*

        /// Every table with its name.
        pub const TABLES: &[(&str, &[Row])] = &[$((stringify!($table), $table::ROWS)),*];
    };
}

mod same;

pub use same::{SAME, Same};

tables! { agreement, choice, clock, comparison, conditioning, delay, drift, effect, encoder, export, force, interval, join, motion, plan, position, procedure, rest, robot, signal, simulation, tracking, verdict }

/// A threshold, to be printed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Its name.
    pub name: &'static str,
    /// Its value, as it is written.
    pub value: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// What it decides.
    pub meaning: &'static str,
    /// Where its value comes from.
    pub source: &'static str,
}
