//! Parts of a record by its time.

/// What the setting is called; an axis file says it as the parts that are fitted or validated.
pub(crate) const KEY: &str = "log.parts";

/// Stretches of a record: what lies in them is kept, or what lies outside of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Parts {
    stretches: Vec<(f64, f64)>,
    inside: bool,
}

impl Parts {
    /// What lies in any of these stretches: each from its first time, s from the first sample of the file, up to its second.
    pub fn inside(stretches: Vec<(f64, f64)>) -> Self {
        Self {
            stretches,
            inside: true,
        }
    }

    /// What lies in none of them.
    pub fn outside(stretches: Vec<(f64, f64)>) -> Self {
        Self {
            stretches,
            inside: false,
        }
    }

    /// The stretches, whichever side of them is kept.
    pub fn stretches(&self) -> &[(f64, f64)] {
        &self.stretches
    }

    /// Whether the stretches themselves are kept.
    pub fn are_inside(&self) -> bool {
        self.inside
    }

    /// Whether a time is kept.
    pub fn keep(&self, time: f64) -> bool {
        let within = self.stretches.iter().any(|stretch| holds(*stretch, time));
        within == self.inside
    }
}

/// Tolerance of the ends, relative to them, so that decimal limits keep the samples that they name.
const ROUNDING: f64 = 1e-9;

/// Whether a stretch holds a time: the first end is in it, the second is not.
pub(crate) fn holds((from, to): (f64, f64), time: f64) -> bool {
    let slack = ROUNDING * from.abs().max(to.abs()).min(1e9);
    time >= from - slack && time < to - slack
}
