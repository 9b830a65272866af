//! Wishes: how well a parameter is to be known.

use super::design::half_interval;
use crate::error::Error;
use stiction_files::plan::WantedEntry;
use stiction_number::full;
use stiction_plan::{Expected, NAMES};

/// How well a parameter is to be known on nine of ten axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Want {
    /// Its place in [`NAMES`]; `None` for each of them.
    parameter: Option<usize>,
    /// Half of the 95 % interval, percent of the value.
    percent: f64,
}

/// What stands for every parameter.
const ALL: &str = "all";
/// Least and largest wish, percent.
const RANGE: [f64; 2] = [1e-3, 100.0];
/// Part of the axes for which a wish is to hold.
const PART: f64 = 0.9;
/// Lengths that are tried, s, the shortest that is enough is taken.
const TIMES: [f64; 8] = [3.0, 5.0, 9.0, 15.0, 25.0, 40.0, 60.0, 100.0];
/// Longest motion for a wish where none is given, s.
pub(super) const LONGEST: f64 = 60.0;

impl Want {
    /// Reads `sigma0 < 2 %`, or `all < 1 %`.
    ///
    /// # Errors
    /// Where it is none, with what is allowed.
    pub fn parse(text: &str) -> Result<Self, Error> {
        let refused = || {
            let allowed = format!(
                "a parameter, < and a percentage from {} to {}, such as \"sigma0 < 2 %\"; parameters: {}, or {ALL}",
                full(RANGE[0]),
                full(RANGE[1]),
                NAMES.join(", ")
            );
            Error::usage(format!("--want {text:?}"), allowed)
        };
        let (name, percent) = text.split_once('<').ok_or_else(refused)?;
        let (name, percent) = (name.trim(), percent.trim());
        let number = percent.strip_suffix('%').ok_or_else(refused)?;
        let percent: f64 = number.trim().parse().map_err(|_| refused())?;
        let parameter = NAMES.iter().position(|own| *own == name);
        if (parameter.is_none() && name != ALL) || !(RANGE[0]..=RANGE[1]).contains(&percent) {
            return Err(refused());
        }
        Ok(Self { parameter, percent })
    }

    /// The wish beside what is expected: of all parameters, the worst.
    fn entry(&self, expected: &Expected) -> WantedEntry {
        let at = |parameter: usize| half_interval(expected.quantile(parameter, PART));
        let (name, found) = match self.parameter {
            Some(parameter) => (NAMES[parameter], at(parameter)),
            None => (ALL, (0..NAMES.len()).map(at).fold(0.0, f64::max)),
        };
        WantedEntry {
            name: name.into(),
            percent: self.percent,
            expected90_percent: found,
            met: found <= self.percent,
        }
    }
}

/// Every wish beside what is expected.
pub(super) fn entries(wants: &[Want], expected: &Expected) -> Vec<WantedEntry> {
    wants.iter().map(|want| want.entry(expected)).collect()
}

/// Whether every wish is met.
pub(super) fn are_met(wants: &[Want], expected: &Expected) -> bool {
    entries(wants, expected).iter().all(|entry| entry.met)
}

/// Lengths to try, rising, of which the last is the longest.
pub(super) fn times(wants: &[Want], longest: f64) -> Vec<f64> {
    let shorter = TIMES
        .into_iter()
        .filter(|t| *t < longest && !wants.is_empty());
    shorter.chain([longest]).collect()
}
