//! A parameter of a fit, as a programmer asks for it.

use stiction_files::result::{HalfWidthEntry, ParameterEntry};

/// One parameter of an identified law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter<'a>(pub(crate) &'a ParameterEntry);

impl<'a> Parameter<'a> {
    /// Name, such as `sigma0`, `coulomb`, `static`, `stribeck_velocity`; with `_pos` or `_neg` where each direction has its
    /// own.
    pub fn name(&self) -> &'a str {
        &self.0.name
    }

    /// Symbol for people, such as `σ₀`.
    pub fn symbol(&self) -> &'a str {
        &self.0.symbol
    }

    /// Value in [`unit`](Self::unit). Ask [`is_identifiable`](Self::is_identifiable) before it is used.
    pub fn value(&self) -> f64 {
        self.0.value
    }

    /// SI unit; a force that the log has in A or V stays in it.
    pub fn unit(&self) -> &'a str {
        &self.0.unit
    }

    /// Standard deviation, in the unit of the value; `None` where the data say nothing, or where the value was given.
    pub fn std(&self) -> Option<f64> {
        self.0.std
    }

    /// The 95 % interval; an end is infinite where the data bound the value on one side only, `None` where on neither.
    pub fn interval(&self) -> Option<(f64, f64)> {
        self.0.range()
    }

    /// Half widths of the 95 % interval by what it is asked for: the same test again, on another day, another motion; `None` where
    /// only [`interval`](Self::interval) is known.
    pub fn half_widths(&self) -> Option<HalfWidthEntry> {
        self.0.half_width
    }

    /// Whether the log determines it, or it was given. A value that is not identifiable is not to be used.
    pub fn is_identifiable(&self) -> bool {
        self.0.identifiable
    }

    /// Whether it was given rather than identified.
    pub fn is_given(&self) -> bool {
        self.0.origin == "given"
    }

    /// Why it is not identifiable; empty if it is.
    pub fn reason(&self) -> &'a str {
        &self.0.reason
    }

    /// What to record so that it becomes identifiable; empty if it is.
    pub fn advice(&self) -> &'a str {
        &self.0.advice
    }
}
