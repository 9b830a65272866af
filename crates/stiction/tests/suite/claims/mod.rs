//! What the default identification claims of a simulated log, and how much of it is true. Also for the example `worlds`.
//!
//! A value is claimed where a result may be used and lists it as a constant of the machine. A run is silent where a claimed
//! value is off by more than the width of its interval for another motion.

use std::fmt;
use stiction_files::result::HalfWidthEntry;
use stiction_testkit::worlds::Case;
use stiction_workflows::identify::Outcome;

/// What a run claims, and what of it holds.
#[derive(Clone, Debug, Default)]
pub struct Run {
    pub refused: Option<String>,
    pub trusted: bool,
    pub law: String,
    /// Every claimed value.
    pub claims: Vec<Claim>,
    /// Values that are listed as open.
    pub open: usize,
    pub codes: Vec<&'static str>,
    /// Effects that the residual shows: code, percent that it explains, and percent to which its size is known.
    pub effects: Vec<(&'static str, f64, f64)>,
    /// Frequency (Hz) or width (m, rad) of what lies between motor and load, and its standard deviation, percent.
    pub coupling: Option<(f64, f64)>,
}

/// A claimed value: its error in parts of the truth, and in half widths of the intervals for the same test again, for another day and
/// for another motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Claim {
    pub name: String,
    pub part: f64,
    pub at_once: f64,
    pub repeat: f64,
    pub transfer: f64,
}

impl Claim {
    /// Whether it is off by more than the width of the widest.
    pub fn is_silent(&self) -> bool {
        self.transfer.abs() > 2.0
    }
}

impl Run {
    /// Whether a claimed value is off by more than the width of its interval for another motion.
    pub fn is_silent(&self) -> bool {
        self.claims.iter().any(Claim::is_silent)
    }

    /// Whether a cause is named, or the result is refused or not to be used: a false alarm where nothing is to be named.
    pub fn is_alarm(&self) -> bool {
        !self.trusted || self.codes.iter().any(|code| !FLAGS.contains(code))
    }
}

impl fmt::Display for Run {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if let Some(why) = &self.refused {
            return write!(f, "refused: {why}");
        }
        write!(
            f,
            "{} {}",
            self.law,
            if self.trusted {
                "trusted"
            } else {
                "not trusted"
            }
        )?;
        for claim in &self.claims {
            let Claim {
                name, part, repeat, ..
            } = claim;
            let halves = repeat;
            let mark = if claim.is_silent() {
                "!!"
            } else if halves.abs() > 1.0 {
                "!"
            } else {
                ""
            };
            write!(f, ", {name} {:+.1} % ({halves:+.1}){mark}", 100.0 * part)?;
        }
        write!(f, "; {} open; {}", self.open, self.codes.join(" "))?;
        for (code, explains, std) in &self.effects {
            write!(f, "; {code} {explains:.0} % (std {std:.1} %)")?;
        }
        match self.coupling {
            Some((value, std)) => write!(f, "; coupled at {value:.3e} (std {std:.1} %)"),
            None => Ok(()),
        }
    }
}

/// Judges a fit by what is true, by name; a claim about several machines holds as far as it does for the one that it holds least
/// for.
pub fn judged_by(
    truths: &[(&'static str, f64)],
    found: Result<Outcome, stiction_workflows::Error>,
) -> Run {
    let outcome = match found {
        Ok(outcome) => outcome,
        Err(e) => {
            return Run {
                refused: Some(e.to_string()),
                ..Run::default()
            };
        }
    };
    let result = &outcome.result;
    let trust = &result.trust;
    let mut run = Run {
        trusted: trust.trustworthy,
        law: result.law.clone(),
        open: trust.open.len(),
        coupling: result.effects.iter().find_map(|effect| {
            let value = effect.size("frequency").or(effect.size("lost_motion"))?;
            Some((value, effect.std_percent?))
        }),
        effects: (result.effects.iter())
            .map(|own| {
                let std = own.std_percent.unwrap_or(f64::NAN);
                (own.code.as_str(), own.explains_percent, std)
            })
            .collect(),
        codes: result.warnings.iter().map(|w| w.code.as_str()).collect(),
        ..Run::default()
    };
    run.codes.sort_unstable();
    run.codes.dedup();
    if !run.trusted {
        return run;
    }
    for p in (result.parameters.iter()).filter(|p| trust.constants.contains(&p.name)) {
        let base = p.name.trim_end_matches("_pos").trim_end_matches("_neg");
        let Some((low, high)) = p.range() else {
            continue;
        };
        let centre = 0.5 * (low + high);
        let claims = truths.iter().filter(|t| t.0 == base).map(|(_, truth)| {
            let repeat = (centre - truth) / (0.5 * (high - low));
            // Those of positive parameters are of logarithms.
            let off = match truth * p.value > 0.0 {
                true => p.value * (p.value / truth).ln(),
                false => p.value - truth,
            };
            let half = p.half_width;
            let beside = |of: fn(HalfWidthEntry) -> f64| half.map_or(repeat, |half| off / of(half));
            Claim {
                name: p.name.clone(),
                part: p.value / truth - 1.0,
                at_once: beside(|half| half.at_once),
                repeat,
                transfer: beside(|half| half.transfer),
            }
        });
        let least = claims.max_by(|a, b| a.repeat.abs().total_cmp(&b.repeat.abs()));
        run.claims.extend(least);
    }
    run
}

/// Warnings that flag a value instead of naming a cause.
const FLAGS: [&str; 2] = ["not-identifiable", "large-shift"];

/// What many runs come to.
#[derive(Clone, Copy, Debug, Default)]
pub struct Figures {
    pub runs: usize,
    /// Runs that claim something false without a word.
    pub lies: usize,
    /// Claimed values, and those whose interval for the same test again holds the truth.
    pub claimed: usize,
    pub inside: usize,
    /// Runs in worlds where nothing is to be named, and those of them that name a cause, are refused or not to be used.
    pub as_assumed: usize,
    pub named: usize,
    /// Values there, and those of them that are flagged as open.
    pub values: usize,
    pub flagged: usize,
}

impl Figures {
    pub fn of<'a>(runs: impl IntoIterator<Item = (&'a Case, &'a Run)>) -> Self {
        let mut sum = Self::default();
        for (case, run) in runs {
            sum.runs += 1;
            sum.lies += usize::from(run.is_silent());
            sum.claimed += run.claims.len();
            sum.inside += run.claims.iter().filter(|c| c.at_once.abs() <= 1.0).count();
            if case.is_as_assumed {
                sum.as_assumed += 1;
                sum.named += usize::from(run.is_alarm());
                sum.values += run.claims.len() + run.open;
                sum.flagged += run.open;
            }
        }
        sum
    }

    /// Share of the claimed intervals that hold the truth.
    pub fn coverage(&self) -> f64 {
        self.inside as f64 / self.claimed.max(1) as f64
    }
}

impl fmt::Display for Figures {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(
            f,
            "{} runs: coverage {:.3} of {} claimed values, {} lies; where nothing is to be named, {} of {} runs name a cause or are \
             not to be used, {} of {} values are flagged",
            self.runs,
            self.coverage(),
            self.claimed,
            self.lies,
            self.named,
            self.as_assumed,
            self.flagged,
            self.values,
        )
    }
}
