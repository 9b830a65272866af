//! Wishes: how well a parameter is to be known.

use super::design::half_interval;
use crate::error::Error;
use crate::wording::Setting;
use stiction_files::plan::WantedEntry;
use stiction_number::full;
use stiction_parameters::{Name, Quantity, Side};
use stiction_plan::{Expected, NAMES, Subject};
use stiction_policy::plan;

/// How well a parameter is to be known on nine of ten axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Want {
    /// Its name; `None` for each of those that are planned for.
    parameter: Option<Name>,
    /// Half of the 95 % interval, percent of the value.
    percent: f64,
}

/// What stands for every parameter.
const ALL: &str = "all";
/// Least and largest wish, percent.
const RANGE: [f64; 2] = [1e-3, 100.0];
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
            let allowed = [
                format!(
                    "a parameter, < and a percentage from {} to {}, such as ",
                    full(RANGE[0]),
                    full(RANGE[1])
                )
                .into(),
                Setting::Want.is("all < 2 %"),
                format!("; parameters: {}, or {ALL}", NAMES.join(", ")).into(),
            ];
            Error::usage(Setting::Want.is(text), allowed)
        };
        let (name, percent) = text.split_once('<').ok_or_else(refused)?;
        let (name, percent) = (name.trim(), percent.trim());
        let number = percent.strip_suffix('%').ok_or_else(refused)?;
        let percent: f64 = number.trim().parse().map_err(|_| refused())?;
        let parameter = name.parse::<Name>().ok().filter(|name| is_planned(*name));
        if (parameter.is_none() && name != ALL) || !(RANGE[0]..=RANGE[1]).contains(&percent) {
            return Err(refused());
        }
        Ok(Self { parameter, percent })
    }

    /// The wish beside what is expected of the parameters of these names: of all, the worst.
    fn entry(&self, expected: &Expected, names: &[String]) -> WantedEntry {
        let at =
            |parameter: usize| half_interval(expected.quantile(parameter, plan::MIN_AXES_SHARE));
        let name = self.name();
        let own = |parameter: &usize| self.parameter.is_none() || names[*parameter] == name;
        let found = (0..names.len()).filter(own).map(at).fold(0.0, f64::max);
        WantedEntry {
            name,
            percent: self.percent,
            expected90_percent: found,
            met: found <= self.percent,
        }
    }

    fn name(&self) -> String {
        self.parameter.map_or(ALL.into(), |name| name.to_string())
    }
}

/// As it is read.
impl std::fmt::Display for Want {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} < {} %", self.name(), full(self.percent))
    }
}

/// Whether there are axes whose plan has the parameter.
fn is_planned(name: Name) -> bool {
    use Quantity as Q;
    let has_sides = matches!(
        name.quantity,
        Q::Sigma2
            | Q::Coulomb
            | Q::Static
            | Q::StribeckVelocity
            | Q::QuadraticViscous
            | Q::CoulombPosition
            | Q::CoulombPitch(..)
    );
    let has_none = matches!(
        name.quantity,
        Q::Sigma0
            | Q::Sigma1
            | Q::Mass
            | Q::Gravity(_)
            | Q::Cogging(..)
            | Q::ElementStiffness(_)
            | Q::ElementYield(_)
            | Q::Attraction
    );
    has_sides || (has_none && name.side == Side::Both)
}

/// Refuses wishes for parameters that the axis is not planned for.
pub(super) fn are_planned(wants: &[Want], subject: &Subject) -> Result<(), Error> {
    let names = subject.names();
    let lacks = |want: &&Want| want.parameter.is_some() && !names.contains(&want.name());
    match wants.iter().find(lacks) {
        Some(want) => {
            let found = Setting::Want.is(want);
            let allowed = format!(
                "what this axis is planned for: {}, or {ALL}",
                names.join(", ")
            );
            Err(Error::usage(found, allowed))
        }
        None => Ok(()),
    }
}

/// Every wish beside what is expected of the parameters of these names.
pub(super) fn entries(wants: &[Want], expected: &Expected, names: &[String]) -> Vec<WantedEntry> {
    let each = wants.iter();
    each.map(|want| want.entry(expected, names)).collect()
}

/// Whether every wish is met.
pub(super) fn are_met(wants: &[Want], expected: &Expected, names: &[String]) -> bool {
    let mut each = wants.iter();
    each.all(|want| want.entry(expected, names).met)
}

/// Lengths to try, rising, of which the last is the longest.
pub(super) fn times(wants: &[Want], longest: f64) -> Vec<f64> {
    let shorter = TIMES
        .into_iter()
        .filter(|t| *t < longest && !wants.is_empty());
    shorter.chain([longest]).collect()
}
