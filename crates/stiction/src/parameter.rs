//! A parameter of a fit, as a programmer asks for it.

use stiction_files::result::{Origin, ParameterEntry};
use stiction_parameters::{Name, Quantity, Side};

/// One parameter of an identified law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter<'a> {
    entry: &'a ParameterEntry,
    name: Name,
}

/// A value that may be used as a constant of the machine.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Determined {
    /// The value, in the unit of the parameter.
    pub value: f64,
    /// Its 95 % interval for the same test on another day, least and largest value; the value itself twice where it was given.
    pub interval: (f64, f64),
}

/// Half widths of a 95 % interval, in the unit of the value.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct HalfWidths {
    /// The same test again, now.
    pub at_once: f64,
    /// The same test on another day.
    pub repeat: f64,
    /// Another motion of the same kind.
    pub transfer: f64,
}

impl<'a> Parameter<'a> {
    pub(crate) fn of(entry: &'a ParameterEntry) -> Option<Self> {
        let name = entry.name.parse().ok()?;
        Some(Self { entry, name })
    }

    /// What it is, and of which direction; displayed as `coulomb` or `coulomb_pos`.
    pub fn name(&self) -> Name {
        self.name
    }

    /// What it is, whichever direction of motion it belongs to.
    pub fn quantity(&self) -> Quantity {
        self.name.quantity
    }

    /// The direction of motion that it belongs to.
    pub fn side(&self) -> Side {
        self.name.side
    }

    /// Symbol for people, such as `σ₀`.
    pub fn symbol(&self) -> &'a str {
        &self.entry.symbol
    }

    /// The value with its interval where the log determines it within one, or where it was given; `None` of a number that is not to be
    /// used.
    pub fn determined(&self) -> Option<Determined> {
        let value = self.entry.value;
        let interval = match self.entry.origin {
            _ if !self.entry.identifiable => None,
            Origin::Given => Some((value, value)),
            _ => self.interval(),
        };
        interval.map(|interval| Determined { value, interval })
    }

    /// Value in [`unit`](Self::unit) as the fit has it, determined or not: what the law is run with. See
    /// [`determined`](Self::determined).
    pub fn value(&self) -> f64 {
        self.entry.value
    }

    /// SI unit; a force that the log has in A or V stays in it.
    pub fn unit(&self) -> &'a str {
        &self.entry.unit
    }

    /// Standard deviation, in the unit of the value; `None` where the data say nothing, or where the value was given.
    pub fn std(&self) -> Option<f64> {
        self.entry.std
    }

    /// The 95 % interval; an end is infinite where the data bound the value on one side only, `None` where on neither.
    pub fn interval(&self) -> Option<(f64, f64)> {
        self.entry.range()
    }

    /// Half widths of the 95 % interval by what it is asked for; `None` where only [`interval`](Self::interval) is known.
    pub fn half_widths(&self) -> Option<HalfWidths> {
        self.entry.half_width.map(|half| HalfWidths {
            at_once: half.at_once,
            repeat: half.repeat,
            transfer: half.transfer,
        })
    }

    /// Whether the log determines it, or it was given.
    pub fn is_identifiable(&self) -> bool {
        self.entry.identifiable
    }

    /// Whether it was identified or given.
    pub fn origin(&self) -> Origin {
        self.entry.origin
    }

    /// Why it is not identifiable; empty if it is.
    pub fn reason(&self) -> &'a str {
        &self.entry.reason
    }

    /// What to record so that it becomes identifiable; empty if it is.
    pub fn advice(&self) -> &'a str {
        &self.entry.advice
    }

    /// The parameters that a parameter which is not identifiable moves together with, and the correlations, -1 to 1.
    pub fn moves_with(&self) -> impl Iterator<Item = (Name, f64)> + use<'a> {
        let partners = self.entry.moves_with.iter();
        partners.filter_map(|partner| Some((partner.name.parse().ok()?, partner.correlation)))
    }
}
