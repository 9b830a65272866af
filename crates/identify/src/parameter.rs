//! One parameter with its deviation, its interval, and whether the data determine it.

pub(crate) mod covariance;
pub(crate) mod physical;
mod quantile;

use crate::scatter::{HalfWidths, Variances};
use physical::Physical;
pub use quantile::NORMAL_Q95;
pub(crate) use quantile::quantile;
use stiction_number::{LARGEST_PERCENT, Percent};
use stiction_parameters::{Dimension, Name, Quantity};
use stiction_policy::interval;

/// What is added to the variances of some parameters.
#[derive(Debug, Default)]
pub(crate) struct Added(Vec<(Name, f64)>);

impl Added {
    /// What is added to that of a parameter.
    pub fn variance(&self, name: Name) -> f64 {
        let own = self.0.iter().find(|(own, _)| *own == name);
        own.map_or(0.0, |(_, variance)| *variance)
    }

    /// Adds to that of a parameter.
    pub fn add(&mut self, name: Name, variance: f64) {
        match self.0.iter_mut().find(|(own, _)| *own == name) {
            Some((_, own)) => *own += variance,
            None => self.0.push((name, variance)),
        }
    }
}

/// How a 95 % interval was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IntervalKind {
    /// From the curvature of the cost at the optimum.
    Linear,
    /// From the cost along the parameter, all others fitted again at each of its values.
    Profile,
    /// From the likelihood of the encoder's counts, whose samples are left out in turn.
    StateSpace,
    /// None: a search found the value, and no least squares followed.
    Searched,
}

impl IntervalKind {
    /// Name as written to files.
    pub fn name(self) -> &'static str {
        match self {
            IntervalKind::Linear => "linear",
            IntervalKind::Profile => "profile",
            IntervalKind::StateSpace => "state-space",
            IntervalKind::Searched => "none",
        }
    }
}

/// Why a parameter is not determined, from the half width of its interval relative to its size; `of` names that size.
pub(crate) fn too_uncertain(relative: f64, of: &str) -> String {
    let percent = Percent::deviation(100.0 * relative);
    if percent.is_bounded() {
        format!("its interval is +-{} of {of} wide", percent.decimals(0))
    } else {
        format!("its interval is not bounded (over {LARGEST_PERCENT} % of {of})")
    }
}

/// One parameter of the law.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Which parameter.
    pub name: Name,
    /// Best value, SI.
    pub value: f64,
    /// Standard deviation of a repeat of the test on another day; `None` where the data say nothing.
    pub std: Option<f64>,
    /// Half widths of its 95 % interval by what it is asked for, SI, of a parameter that is positive by nature the value times
    /// that of its logarithm; `None` where only one is known.
    pub half: Option<HalfWidths>,
    /// What encoder steps, filters and derivatives are estimated to have added, SI; `None` where that
    /// was not estimated. It is taken off the value up to 10 %; beyond, the interval allows for it.
    pub bias: Option<f64>,
    /// 95 % interval; `None` where the data bound it on neither side, an infinite end where they bound
    /// only the other side. A linear one is log-normal for parameters that are positive by nature.
    pub ci95: Option<(f64, f64)>,
    /// How the interval was found.
    pub interval: IntervalKind,
    /// Whether the data determine it: interval of a repeat at most 20 % to each side and not at a bound.
    pub identifiable: bool,
    /// Whether it was fitted; a given parameter has no deviation.
    pub identified: bool,
    /// Why it is not identifiable; empty if it is.
    pub reason: String,
    /// Parameters that are correlated with one that is not identifiable, the closest first, with their
    /// correlation in -1..1.
    pub moves_with: Vec<(Name, f64)>,
    /// What motion would determine a parameter that is not identifiable; empty if it is.
    pub advice: String,
}

impl Parameter {
    /// A parameter that was given, not fitted.
    pub fn given(name: impl Into<Name>, value: f64) -> Self {
        Self {
            name: name.into(),
            value,
            std: None,
            half: None,
            bias: None,
            ci95: None,
            interval: IntervalKind::Linear,
            identifiable: true,
            identified: false,
            reason: String::new(),
            moves_with: Vec::new(),
            advice: String::new(),
        }
    }

    /// A fitted parameter with its linear interval, and in `reason` what is already known against it.
    /// `bias` is what the conditioning adds to it; `level` is the value with which a parameter that may
    /// be zero is compared: the Coulomb level, or the sample time for a delay.
    pub(crate) fn judged(
        p: &Physical,
        variances: Variances,
        bias: Option<f64>,
        mut reason: String,
        level: f64,
    ) -> Self {
        let variance = variances.repeat;
        let known = reason.is_empty() && variance.is_finite() && variance >= 0.0;
        let std = known.then(|| variance.sqrt());
        if reason.is_empty() && std.is_none() {
            reason = "its deviation is beyond the range of numbers".into();
        }
        let sized = |value: f64| match p.name.dimension() {
            _ if p.is_positive() => (value.abs(), "its value"),
            Dimension::Time => (
                value
                    .abs()
                    .max(interval::MAX_DELAY_HALF_WIDTH / interval::MAX_HALF_WIDTH * level),
                "its value or of two and a half samples",
            ),
            _ => (value.abs().max(level), "its value or of the Coulomb level"),
        };
        let (size, _) = sized(p.value);
        let shift = bias.filter(|b| known && b.is_finite()).unwrap_or(0.0);
        let corrected = shift.abs() <= interval::MAX_CORRECTED_SHIFT * size;
        let value = if !corrected || shift == 0.0 {
            p.value
        } else if p.is_share() {
            let odds = shift / (p.value * (1.0 - p.value));
            share_at(p.value, -odds)
        } else if p.is_positive() {
            p.value * libm::exp(-shift / p.value)
        } else {
            p.value - shift
        };
        let left = if corrected { 0.0 } else { shift };
        let student = variances.half_widths();
        let biased = |half: f64| half * quantile(left, half / NORMAL_Q95) / NORMAL_Q95;
        let half = std.map(|_| HalfWidths {
            at_once: biased(student.at_once),
            repeat: biased(student.repeat),
            transfer: biased(student.transfer),
        });
        let reach = half.map(|half| half.repeat);
        // A difference of two dampings is mostly nothing, and there is no size to compare it with; of a map what counts is the sum of
        // its parts.
        let has_size = !matches!(
            p.name.quantity,
            Quantity::Sigma1Log(_) | Quantity::CoulombMap(_)
        );
        if let Some(reach) = reach {
            // Relative to the value that is stated, so that a table of both is consistent.
            let (size, of) = sized(value);
            let relative = reach / size;
            if has_size && (relative > interval::MAX_HALF_WIDTH || relative.is_nan()) {
                reason = too_uncertain(relative, of);
            } else if !corrected {
                reason = format!(
                    "encoder steps and filters shift it by about {} of {of}",
                    Percent::error(100.0 * shift.abs() / size).decimals(0)
                );
            }
        }
        let ci95 = reach.and_then(|reach| {
            if p.is_share() {
                // Normal in the logarithm of the odds, so that it stays between 0 and 1.
                let r = reach / (p.value * (1.0 - p.value));
                (r.is_finite() && r <= interval::MAX_LOG_HALF_WIDTH)
                    .then(|| (share_at(value, -r), share_at(value, r)))
            } else if p.is_positive() {
                // Wider than a factor of e^4 to each side, the interval counts as no bound on either side.
                let r = reach / p.value;
                (r.is_finite() && r <= interval::MAX_LOG_HALF_WIDTH)
                    .then(|| (value * libm::exp(-r), value * libm::exp(r)))
            } else {
                Some((value - reach, value + reach))
            }
        });
        // For a share near one a small relative error of the value can be any error of its odds.
        if ci95.is_none() && reason.is_empty() {
            reason = "the data bound it on no side".into();
        }
        Self {
            std,
            half: half.filter(|_| variances.freedom.is_finite()),
            bias: bias.filter(|_| known),
            ci95,
            identifiable: reason.is_empty(),
            identified: true,
            reason,
            ..Self::given(p.name, value)
        }
    }
}

impl Parameter {
    /// Scatters from day to day and from motion to motion as the same parameter of another fit does, whose interval of the same test
    /// again, now, is another one.
    pub(crate) fn scatter_as(&mut self, other: &Self) {
        let (Some(half), Some((low, high))) = (other.half, self.ci95) else {
            return;
        };
        let is_relative = self.name.quantity.allowed().is_never_negative();
        let [now, then] = match is_relative {
            true => [self.value, other.value],
            false => [1.0, 1.0],
        };
        let own = match is_relative {
            true => 0.5 * now * libm::log(high / low),
            false => 0.5 * (high - low),
        };
        let more = |half: f64, less: f64| (half * half - less * less).max(0.0).sqrt() * now / then;
        let repeat = libm::hypot(own, more(half.repeat, half.at_once));
        self.half = Some(HalfWidths {
            at_once: own,
            repeat,
            transfer: libm::hypot(own, more(half.transfer, half.at_once)),
        });
        self.std = Some(repeat / NORMAL_Q95);
        let reach = repeat / now;
        self.ci95 = match is_relative {
            true => Some((now * libm::exp(-reach), now * libm::exp(reach))),
            false => Some((self.value - repeat, self.value + repeat)),
        };
        if is_relative && self.identifiable && reach > interval::MAX_HALF_WIDTH {
            self.identifiable = false;
            self.reason = too_uncertain(reach, "its value");
        }
    }
}

/// The share that results when its odds are multiplied by a factor, given as a logarithm.
fn share_at(share: f64, odds: f64) -> f64 {
    1.0 / (1.0 + libm::exp(-odds) * (1.0 - share) / share)
}
