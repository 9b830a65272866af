//! Cut-offs chosen from the data: those with which the parameters of a simulated replica of the axis are
//! recovered best.
//!
//! A low cut-off on the position rounds off the real motion; a high one lets encoder steps and noise
//! through, which shift the parameters too. The best compromise depends on encoder, rate, noise and on
//! the axis itself. So the axis is fitted with medium cut-offs, a [`replica`](crate::replica) of it is
//! made with the noise of the log, and pairs of cut-offs are tried on that replica, where the true
//! parameters are known. The best pair is used, and the whole is repeated from the better fit until the
//! choice no longer changes.

use crate::conditioning::record::{Record, Samples};
use crate::conditioning::{Conditioning, Cutoff, Source, condition};
use crate::error::Error;
use crate::estimate::fitted::FittedLaw;
use crate::estimate::{Estimate, estimate};
use crate::law::Law;
use crate::law::physical::physical;
use crate::law::terms::Terms;
use crate::refit::{force_noise, refitted};
use crate::replica::{Replica, replica};
use crate::separable::separable;
use crate::separable::settings::Settings;
use stiction_parameters::Name;
use stiction_search::{Control, Counts, Observer, Progress, Stage, Status};

/// Replicas that each pair of cut-offs is tried on.
const REPLICA_COUNT: u64 = 4;
/// Most times the choice is repeated from a better fit.
const MOST_ROUNDS: usize = 4;
/// Cut-offs on the position that are tried: the sample rate over 2.5 times a power of the square root of two.
const CUTOFF_STEPS: i32 = 14;
/// Where the search begins, on that scale.
const START: (i32, i32) = (6, 2);
/// Number of the same steps by which the cut-off of the common filter is below that of the position.
const BELOW: std::ops::RangeInclusive<i32> = 1..=6;

/// Thinned samples that the cut-offs must leave, or as many as the default ones leave if that is fewer: a
/// low cut-off leaves few samples of a short log, and a law with many elements needs ten for each
/// unknown.
const FEWEST_SAMPLES: usize = 300;

/// A pair of cut-offs and its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// Cut-off on the position, Hz.
    pub source_hz: f64,
    /// Cut-off on force and regressors, Hz.
    pub common_hz: f64,
    /// Root mean square of the relative errors of the parameters.
    pub error: f64,
}

/// What was chosen.
#[derive(Clone, Debug, PartialEq)]
pub struct Tuned {
    /// The conditioning with its cut-offs filled in.
    pub conditioning: Conditioning,
    /// Every pair of cut-offs of the last round, in the order tried; empty where none could be.
    pub trials: Vec<Trial>,
    /// Evaluations that it took.
    pub counts: Counts,
    /// Whether the observer stopped it before the choice was made.
    pub interrupted: bool,
}

/// Chooses the cut-offs that `wanted` leaves open. They stay as they are where the position does not
/// drive the law, or where the axis cannot be simulated: no inertia, no bristle, a fit that explains
/// little.
///
/// # Errors
/// Those of [`condition`] and [`separable`].
pub fn tune(
    logs: &[Samples],
    wanted: &Conditioning,
    law: Law,
    terms: &Terms,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<Tuned, Error> {
    let mut tuned = Tuned {
        conditioning: *wanted,
        trials: Vec::new(),
        counts: Counts::default(),
        interrupted: false,
    };
    let open = |cutoff| cutoff == Cutoff::Auto;
    let from_position = match wanted.source {
        Some(source) => source == Source::Position,
        None => logs.iter().all(|log| log.position.is_some()),
    };
    if !from_position || !(open(wanted.source_cutoff) || open(wanted.common_cutoff)) {
        return Ok(tuned);
    }
    let untuned = condition(logs, wanted)?;
    let rate = 1.0 / untuned.step();
    let least = untuned.kept().min(FEWEST_SAMPLES);
    let mut at = START;
    for round in 0..MOST_ROUNDS {
        let trial = cutoffs(wanted, rate, at);
        let Ok(record) = condition(logs, &trial) else {
            break;
        };
        let found = separable(&record, law, terms, settings, observer)?;
        tuned.counts.add(&found.counts);
        let fitted = estimate(&record, law, terms, &found, 0.0);
        tuned.interrupted = found.status == Status::Interrupted;
        if tuned.interrupted || !worth(&fitted) {
            break;
        }
        let Some(noise) = force_noise(&record, &trial, &fitted, &mut tuned.counts) else {
            break;
        };
        let replicas: Option<Vec<Replica>> = (0..REPLICA_COUNT)
            .map(|seed| replica(&record, &fitted, noise, seed))
            .collect();
        let Some(replicas) = replicas else { break };
        let mut search = Walk {
            logs,
            least,
            fitted: &fitted,
            replicas: &replicas,
            wanted,
            rate,
            seen: Vec::new(),
            counts: Counts::default(),
            stopped: false,
        };
        let Some(best) = search.walk(at, round, observer) else {
            tuned.interrupted = search.stopped;
            break;
        };
        tuned.counts.add(&search.counts);
        tuned.trials = search.trials();
        tuned.conditioning = cutoffs(wanted, rate, best);
        if best == at {
            break;
        }
        at = best;
    }
    Ok(tuned)
}

/// Part of the variance that a fit must explain to represent the axis. The rest is taken as noise of the
/// force, and a law that does not describe the axis would lead to far too low a cut-off.
const LEAST_R2: f64 = 0.99;

/// Whether a fit is near enough to the axis to represent it.
fn worth(fitted: &Estimate) -> bool {
    fitted.fit.r2 > LEAST_R2
}

/// The conditioning at a place on the scale: the cut-off of the position, and how many steps the common
/// one lies below it.
fn cutoffs(wanted: &Conditioning, rate: f64, (source, below): (i32, i32)) -> Conditioning {
    let hertz = |step: i32| Cutoff::Hz(rate / (2.5 * libm::exp2(0.5 * f64::from(step))));
    let fill = |cutoff, step| match cutoff {
        Cutoff::Auto => hertz(step),
        other => other,
    };
    Conditioning {
        source_cutoff: fill(wanted.source_cutoff, source),
        common_cutoff: fill(wanted.common_cutoff, source + below),
        ..*wanted
    }
}

/// A search over the scale, downhill in the error on the replicas.
struct Walk<'a> {
    logs: &'a [Samples],
    least: usize,
    fitted: &'a Estimate,
    replicas: &'a [Replica],
    wanted: &'a Conditioning,
    rate: f64,
    seen: Vec<((i32, i32), f64)>,
    counts: Counts,
    stopped: bool,
}

impl Walk<'_> {
    /// The best place near `start`; `None` if there is none, or if the observer stopped the walk.
    fn walk(
        &mut self,
        start: (i32, i32),
        round: usize,
        observer: &mut dyn Observer,
    ) -> Option<(i32, i32)> {
        let mut best = (start, self.error(start));
        loop {
            let (s, b) = best.0;
            let before = best;
            for next in [
                (s - 1, b),
                (s + 1, b),
                (s - 1, b + 1),
                (s + 1, b - 1),
                (s, b - 1),
                (s, b + 1),
            ] {
                if !(0..=CUTOFF_STEPS).contains(&next.0) || !BELOW.contains(&next.1) {
                    continue;
                }
                let error = self.error(next);
                if error < best.1 {
                    best = (next, error);
                }
                let progress = Progress {
                    stage: Stage::Tuning,
                    fraction: (round as f64 + 0.5) / MOST_ROUNDS as f64,
                    counts: self.counts,
                    best: best.1,
                };
                if observer.progress(&progress) == Control::Stop {
                    self.stopped = true;
                    return None;
                }
            }
            if best.0 == before.0 {
                return best.1.is_finite().then_some(best.0);
            }
        }
    }

    fn error(&mut self, at: (i32, i32)) -> f64 {
        if let Some((_, error)) = self.seen.iter().find(|(place, _)| *place == at) {
            return *error;
        }
        let error = self.tried(&cutoffs(self.wanted, self.rate, at));
        self.seen.push((at, error));
        error
    }

    fn tried(&mut self, conditioning: &Conditioning) -> f64 {
        let enough = |record: Record| record.kept() >= self.least;
        if !condition(self.logs, conditioning).is_ok_and(enough) {
            return f64::INFINITY;
        }
        let mut sum = 0.0;
        for replica in self.replicas {
            sum += match refitted(
                replica,
                conditioning,
                self.fitted,
                1,
                false,
                &mut self.counts,
            ) {
                Some(refit) => self.distance(replica, &refit.p, &refit.c),
                None => f64::INFINITY,
            };
        }
        (sum / self.replicas.len() as f64).sqrt()
    }

    /// Mean square of the relative errors of the parameters that the log determines.
    fn distance(&self, replica: &Replica, p: &[f64], c: &[f64]) -> f64 {
        let FittedLaw { law, terms, .. } = &self.fitted.fitted;
        let linear = terms.columns(law);
        let truth = physical(law, &linear, 1.0, &replica.p, self.fitted.coefficients());
        let found = physical(law, &linear, 1.0, p, c);
        let errors: Vec<f64> = truth
            .iter()
            .zip(&found)
            .filter(|(t, _)| {
                let known =
                    |name: Name| self.fitted.parameter(name).is_some_and(|p| p.identifiable);
                t.is_positive() && t.value > 0.0 && known(t.name)
            })
            .map(|(t, f)| (f.value / t.value - 1.0).clamp(-1.0, 1.0))
            .collect();
        if errors.is_empty() {
            return f64::INFINITY;
        }
        errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64
    }

    fn trials(&self) -> Vec<Trial> {
        let hertz = |cutoff| match cutoff {
            Cutoff::Hz(f) => f,
            Cutoff::Auto | Cutoff::Off => f64::NAN,
        };
        self.seen
            .iter()
            .map(|&(at, error)| {
                let c = cutoffs(self.wanted, self.rate, at);
                Trial {
                    source_hz: hertz(c.source_cutoff),
                    common_hz: hertz(c.common_cutoff),
                    error,
                }
            })
            .collect()
    }
}
