//! How well a parameter is known, as tables say it.

use stiction_files::result::{Origin, ParameterEntry, ResultFile};
use stiction_number::{Percent, sig};
use stiction_parameters::{Dimension, Name, Quantity};
use stiction_policy::interval;

/// 97.5 % quantile of the normal distribution.
const NORMAL: f64 = 1.96;

/// Half width of a 95 % interval of a parameter in a form that a reader can use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Deviation {
    /// It was not fitted.
    Given,
    /// In the unit of the parameter: relative to a value that may be zero it says nothing.
    Absolute(f64),
    /// Relative to the value.
    Relative(Percent),
    /// There is none to state.
    Unknown,
    /// Ten times the value or more: neither value nor interval say anything.
    Unbounded,
}

impl Deviation {
    /// As a cell of a table, with the unit of the parameter where it needs one.
    pub fn cell(self, unit: &str) -> String {
        match self {
            Self::Given => "given".into(),
            Self::Absolute(half) => format!("± {} {unit}", sig(half, 3)),
            Self::Relative(part) => format!("± {}", part.digits(2)),
            Self::Unknown => String::new(),
            Self::Unbounded => "not bounded".into(),
        }
    }

    /// Of a parameter of a result: for the same test on another day.
    pub fn of(p: &ParameterEntry, result: &ResultFile) -> Self {
        let half = p.half_width.map(|half| half.repeat);
        Self::of_half(p, half.or(p.std.map(|std| NORMAL * std)), result)
    }

    /// The same for another motion; `Unknown` where only one interval is known.
    pub fn of_transfer(p: &ParameterEntry, result: &ResultFile) -> Self {
        Self::of_half(p, p.half_width.map(|half| half.transfer), result)
    }

    fn of_half(p: &ParameterEntry, half: Option<f64>, result: &ResultFile) -> Self {
        let Some(half) = half.filter(|_| p.origin != Origin::Given) else {
            return match p.origin {
                Origin::Given => Self::Given,
                _ => Self::Unknown,
            };
        };
        let size = p.value.abs();
        let name: Option<Name> = p.name.parse().ok();
        let may_be_zero = name.is_some_and(|n| !n.quantity.allowed().is_never_negative());
        if may_be_zero && half > interval::MAX_HALF_WIDTH * size {
            // The scale by which it is judged: the Coulomb level where the parameter is a force, the sample time for
            // a delay.
            let level = match name.map(|n| n.dimension()) {
                Some(Dimension::Force) => coulomb(result),
                Some(Dimension::Time) => result.inputs.first().map_or(0.0, |i| 1.0 / i.rate_hz),
                _ => 0.0,
            };
            let part = Percent::deviation(100.0 * half / size.max(level));
            return match p.identifiable || part.is_bounded() {
                true => Self::Absolute(half),
                false => Self::Unbounded,
            };
        }
        if size == 0.0 {
            return Self::Unknown;
        }
        let part = Percent::deviation(100.0 * half / size);
        match p.identifiable || part.is_bounded() {
            true => Self::Relative(part),
            false => Self::Unbounded,
        }
    }
}

/// The largest Coulomb level of a result; 0 for a law without.
fn coulomb(result: &ResultFile) -> f64 {
    let is_level = |p: &&ParameterEntry| {
        let name: Option<Name> = p.name.parse().ok();
        name.is_some_and(|n| n.quantity == Quantity::Coulomb)
    };
    let levels = result.parameters.iter().filter(is_level);
    levels.map(|p| p.value.abs()).fold(0.0, f64::max)
}
