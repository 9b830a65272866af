//! The law that was asked for, or the one that the data choose.

use super::ladder::{self, Climb, Ladder, Rung};
use super::trust::RICHER_LAW_WINS_BELOW;
use stiction_files::result::LawEntry;
use stiction_identify as engine;
use stiction_identify::{Estimate, Law, LawKind, Observer, Optimum, Settings, Status};

/// A fitted law and the laws it was compared with.
pub(super) struct Choice {
    pub estimate: Estimate,
    /// Empty where laws were not compared, or not to the end.
    pub laws: Vec<LawEntry>,
    /// Who chose the law, as written to `result.json`.
    pub by: &'static str,
}

impl Choice {
    /// A law that was asked for and compared with none.
    pub fn alone(estimate: Estimate) -> Self {
        Self {
            estimate,
            laws: Vec::new(),
            by: "user",
        }
    }
}

/// Fits the law that was asked for and, if wanted, others beside it.
pub(super) fn asked(
    law: Law,
    ladder: &Ladder,
    compare: bool,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<Choice, engine::Error> {
    let fitted = ladder.fit(law, settings, observer)?;
    Ok(fitted_already(fitted, ladder, compare, settings, observer))
}

/// States a law that was asked for and fitted and, if wanted, fits others beside it.
pub(super) fn fitted_already(
    (estimate, optimum): (Estimate, Optimum),
    ladder: &Ladder,
    compare: bool,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Choice {
    let law = estimate.law;
    let laws = if compare && optimum.status != Status::Interrupted {
        let known = Some((&estimate, &optimum));
        let climb = ladder.climb(&ladder::beside(&law), known, settings, observer);
        // A table with only some of the laws could name the wrong one as best.
        if climb.stopped {
            Vec::new()
        } else {
            climb.entries().0
        }
    } else {
        Vec::new()
    };
    Choice {
        estimate: stated(ladder, &optimum, estimate, observer),
        laws,
        by: "user",
    }
}

/// Fits every law and takes the one that the data support.
pub(super) fn auto(
    base: Law,
    ladder: &Ladder,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<Choice, engine::Error> {
    let climb = ladder.climb(&ladder::every(base), None, settings, observer);
    let (laws, best) = climb.entries();
    let at = best.map_or(0, |best| determined(&climb, &laws, best));
    let Climb { mut rungs, stopped } = climb;
    let held_out = laws.iter().all(|law| law.held_out_error_percent.is_some());
    let by = match (held_out, ladder.held_out.is_empty()) {
        (true, true) => "cross-validation",
        (true, false) => "validation",
        // Too few samples to hold some out.
        (false, _) => "bic",
    };
    if at >= rungs.len() {
        // Not one could be fitted: the simplest says why.
        let simplest = Law {
            kind: LawKind::CoulombViscous,
            asymmetric: false,
            ..base
        };
        return asked(simplest, ladder, false, settings, observer);
    }
    let Rung {
        estimate, optimum, ..
    } = rungs.swap_remove(at);
    let mut estimate = stated(ladder, &optimum, estimate, observer);
    if stopped {
        // Not all laws were tried, so even a converged one is only the best so far.
        estimate = estimate.interrupted();
    }
    Ok(Choice {
        estimate,
        laws: if stopped { Vec::new() } else { laws },
        by,
    })
}

/// The estimate with its intervals in full, unless the search was interrupted.
fn stated(
    ladder: &Ladder,
    optimum: &Optimum,
    mut estimate: Estimate,
    observer: &mut dyn Observer,
) -> Estimate {
    if estimate.status != Status::Interrupted {
        engine::intervals(ladder.record, optimum, &mut estimate, observer);
    }
    estimate
}

/// The best law or, if the log does not determine it, the best of those that it determines and whose error is not
/// much larger: a slightly smaller error is worth nothing if the parameters may not be used.
fn determined(climb: &Climb, laws: &[LawEntry], best: usize) -> usize {
    if laws[best].determined {
        return best;
    }
    let error = |law: &LawEntry| law.held_out_error_percent.unwrap_or(f64::INFINITY);
    let able: Vec<usize> = (0..laws.len())
        .filter(|&i| {
            laws[i].determined && RICHER_LAW_WINS_BELOW * error(&laws[i]) <= error(&laws[best])
        })
        .collect();
    climb.best_of(&able).unwrap_or(best)
}
