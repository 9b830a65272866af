//! Cut-offs chosen from the data: those with which the parameters of a simulated replica of the axis are
//! recovered best.
//!
//! A low cut-off on the position rounds off the real motion; a high one lets encoder steps and noise
//! through, which shift the parameters too. The best compromise depends on encoder, rate, noise and on
//! the axis itself. So the axis is fitted with medium cut-offs, a [`replica`](crate::replica) of it is
//! made with the noise of the log, and pairs of cut-offs are tried on that replica, where the true
//! parameters are known. The best pair is used, and the whole is repeated from the better fit until the
//! choice no longer changes.
//!
//! The fit at the beginning also shows whether the force has a lag, which is then a part of every fit ([`lag`](crate::lag)).
//!
//! What encoder steps and filters shift is seen on replicas without force noise, and what that noise adds is
//! computed, so that no draw of it decides (decision 0048).

use crate::conditioning::record::{Record, Samples};
use crate::conditioning::{Conditioning, Cutoff, Source, condition, condition_as};
use crate::error::Error;
use crate::estimate::fitted::FittedLaw;
use crate::estimate::{Estimate, estimate};
use crate::lag::lag;
use crate::law::Law;
use crate::law::physical::physical;
use crate::law::terms::{FirstDelay, Lag, Terms};
use crate::refit::{FirstOrder, first_order, force_noise};
use crate::replica::{self, Axis, Replica};
use crate::separable::optimum::Optimum;
use crate::separable::settings::Settings;
use crate::separable::{follow, separable};
use stiction_parameters::Name;
use stiction_policy::conditioning;
use stiction_search::{Control, Counts, Observer, Progress, Stage, Status};

/// Replicas that each pair of cut-offs is tried on.
const REPLICA_COUNT: u64 = 4;
/// Replicas that the first, coarse look over the whole scale is made on.
const COARSE_REPLICAS: usize = 2;
/// Most times the choice is repeated from a better fit.
const MOST_ROUNDS: usize = 4;
/// Cut-offs on the position that are tried: the sample rate over 2.5 times a power of the square root of two.
const CUTOFF_STEPS: i32 = 20;
/// Steps of the coarse look, and how far the common cut-off lies below there.
const COARSE_STEP: usize = 4;
const COARSE_BELOW: [i32; 2] = [2, 5];
/// Largest error of a parameter that is told from larger ones, as a logarithm: a parameter that comes out a hundred times
/// too small is worse than one that comes out ten times too small, and both are of no use.
const LARGEST_ERROR: f64 = 5.0;
/// Where the search begins, on that scale.
const START: (i32, i32) = (6, 4);
/// Number of the same steps by which the cut-off of the common filter is below that of the position.
const BELOW: std::ops::RangeInclusive<i32> = 1..=6;

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
    /// The lag of the force, for the fits that follow.
    pub lag: Lag,
    /// The delay of the force in the first fit, whose common cut-off is low, for those fits too; `None` where none is fitted.
    pub first_delay: Option<FirstDelay>,
    /// Where the last fit of a round ended, for [`Settings::near`].
    pub near: Option<(Law, Vec<f64>)>,
    /// Whether the observer stopped it before the choice was made.
    pub interrupted: bool,
}

/// Chooses the cut-offs that `wanted` leaves open, and the distance that an axis must have slid before its samples count
/// ([`Conditioning::settling`]). The cut-offs stay as they are where the position does not
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
        lag: Lag::NONE,
        first_delay: None,
        near: None,
        interrupted: false,
    };
    let open = |cutoff| cutoff == Cutoff::Auto;
    let from_position = match wanted.source {
        Some(source) => source == Source::Position,
        None => logs.iter().all(|log| log.position.is_some()),
    };
    if !from_position || !(open(wanted.source_cutoff) || open(wanted.common_cutoff)) {
        return settle(logs, wanted, law, terms, settings, observer);
    }
    let untuned = condition_as(logs, wanted, 0.0)?;
    let rate = 1.0 / untuned.step();
    let mut wanted = *wanted;
    let mut at = START;
    let mut last: Option<Vec<f64>> = None;
    let mut late = None;
    for round in 0..MOST_ROUNDS {
        let mut trial = cutoffs(&wanted, rate, at);
        let Ok(mut record) = condition(logs, &trial) else {
            break;
        };
        let mut terms = terms.about(&record);
        terms.lag = tuned.lag;
        let mut found = match &last {
            // The law is the same, so the fit of the round before is near.
            Some(start) => follow(start, &record, law, &terms, settings, observer)?,
            None => separable(&record, law, &terms, settings, observer)?,
        };
        // Asked of every round: the ends of a filter with a low cut-off may hide the beginning of a stretch.
        if wanted.settling <= 0.0 {
            let settled = Conditioning {
                settling: found.settling(),
                ..trial
            };
            let later = condition(logs, &settled)?;
            if depends_on_before(&record, &later, &found) {
                tuned.counts.add(&found.counts);
                wanted.settling = settled.settling;
                tuned.conditioning.settling = settled.settling;
                trial = settled;
                record = later;
                found = follow(&found.p, &record, law, &terms, settings, observer)?;
            }
        }
        if last.is_none() {
            let near = (&wanted, &record);
            if let Some((lag, counts)) = lag(logs, near, &terms, &found, settings, observer)? {
                tuned.counts.add(&counts);
                tuned.counts.add(&found.counts);
                (tuned.lag, terms.lag) = (lag, lag);
                found = follow(&found.p, &record, law, &terms, settings, observer)?;
            }
        }
        last = Some(found.p[..law.nonlinear()].to_vec());
        tuned.near = Some((law, found.p.clone()));
        tuned.counts.add(&found.counts);
        if wanted.settling > 0.0 {
            wanted.settling = found.settling();
        }
        let fitted = estimate(&record, law, &terms, &found, 0.0);
        tuned.interrupted = found.status == Status::Interrupted;
        if tuned.interrupted {
            break;
        }
        if !worth(&fitted) {
            // Replicas of a fit with low cut-offs know nothing of what the axis does above them.
            tuned.conditioning = wanted;
            tuned.trials.clear();
            break;
        }
        // The delay of the first fit, whose common cut-off is low. The higher the cut-off, the more of what a controller answers
        // to its encoder is taken for a delay, and a replica with that delay is as biased as the fit: nothing would come
        // out wrong there, however far the choice has led.
        if round == 0 {
            tuned.first_delay = replica::first_delay(&fitted, record.step());
        }
        let late = *late.get_or_insert_with(|| replica::late(&record, &fitted));
        let Some(axis) = Axis::logged(&record, &fitted, late) else {
            break;
        };
        let Some(noise) = force_noise(&record, &axis, &trial, &fitted, &mut tuned.counts) else {
            break;
        };
        let mut search = Walk {
            least: condition_as(logs, &wanted, 0.0)?
                .kept()
                .min(conditioning::MIN_SAMPLES),
            fitted: &fitted,
            replicas: Vec::new(),
            force_noise: noise,
            round,
            wanted: &wanted,
            rate,
            seen: Vec::new(),
            counts: Counts::default(),
            stopped: false,
        };
        let found = search
            .simulated(&axis, observer)
            .and_then(|()| search.coarse(at, observer))
            .and_then(|start| search.walk(start, observer));
        let Some(best) = found else {
            tuned.interrupted = search.stopped;
            break;
        };
        tuned.counts.add(&search.counts);
        tuned.trials = search.trials();
        tuned.conditioning = cutoffs(&wanted, rate, best);
        if best == at {
            break;
        }
        at = best;
    }
    Ok(tuned)
}

/// Whether a fit of a record leaves more in the samples that the same record, settled, has no more: there the bristles did not
/// begin undeflected, as the law assumes.
fn depends_on_before(record: &Record, settled: &Record, found: &Optimum) -> bool {
    let flags = |record: &Record| -> Vec<bool> {
        let segments = record.segments.iter();
        segments.flat_map(|s| s.keep.iter().copied()).collect()
    };
    let mut residual = found.evaluation.residual().iter();
    let (mut early, mut rest) = ((0.0, 0.0), (0.0, 0.0));
    for (kept, late) in flags(record).into_iter().zip(flags(settled)) {
        if let Some(r) = kept.then(|| residual.next()).flatten() {
            let of = if late { &mut rest } else { &mut early };
            of.0 += r * r;
            of.1 += 1.0;
        }
    }
    early.0 * rest.1 > conditioning::MIN_START_ERROR * rest.0 * early.1
}

/// Leaves the cut-offs as they are, and finds the distance alone that an axis must have slid before its samples count: by a
/// fit of some of the samples.
///
/// # Errors
/// Those of [`condition`] and [`separable`].
pub fn settle(
    logs: &[Samples],
    wanted: &Conditioning,
    law: Law,
    terms: &Terms,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<Tuned, Error> {
    let record = condition_as(logs, wanted, 0.0)?;
    let rough = record.rough(settings.thin);
    let rough = rough.as_ref().unwrap_or(&record);
    let found = separable(rough, law, &terms.about(rough), settings, observer)?;
    let settled = Conditioning {
        settling: found.settling(),
        ..*wanted
    };
    let later = condition_as(logs, &settled, 0.0)?;
    let later = later.rough(settings.thin).unwrap_or(later);
    Ok(Tuned {
        conditioning: match depends_on_before(rough, &later, &found) {
            true => settled,
            false => *wanted,
        },
        trials: Vec::new(),
        counts: found.counts,
        lag: Lag::NONE,
        first_delay: None,
        near: Some((law, found.p)),
        interrupted: found.status == Status::Interrupted,
    })
}

/// Whether a fit is near enough to the axis to represent it.
fn worth(fitted: &Estimate) -> bool {
    fitted.fit.r2 > conditioning::MIN_R2
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
    least: usize,
    fitted: &'a Estimate,
    replicas: Vec<Replica>,
    /// Standard deviation of the noise of the logged force.
    force_noise: f64,
    round: usize,
    wanted: &'a Conditioning,
    rate: f64,
    seen: Vec<((i32, i32), f64)>,
    counts: Counts,
    stopped: bool,
}

impl Walk<'_> {
    /// Makes the replicas; `None` where one cannot be simulated, or if the observer stopped it.
    fn simulated(&mut self, axis: &Axis, observer: &mut dyn Observer) -> Option<()> {
        for seed in 0..REPLICA_COUNT {
            self.replicas.push(axis.replica(0.0, seed)?);
            self.report(f64::INFINITY, observer)?;
        }
        Some(())
    }

    /// The best of `start` and of some places all over the scale, on few replicas; `None` if the observer stopped it.
    fn coarse(&mut self, start: (i32, i32), observer: &mut dyn Observer) -> Option<(i32, i32)> {
        if self.round > 0 {
            return Some(start);
        }
        let own = self.tried(start, COARSE_REPLICAS, observer)?;
        let mut best = (start, conditioning::MAX_OTHER_VALLEY_ERROR * own);
        for source in (0..=CUTOFF_STEPS).step_by(COARSE_STEP) {
            for below in COARSE_BELOW {
                let error = self.tried((source, below), COARSE_REPLICAS, observer)?;
                if error < best.1 {
                    best = ((source, below), error);
                }
            }
        }
        Some(best.0)
    }

    /// The best place near `start`; `None` if there is none, or if the observer stopped the walk.
    fn walk(&mut self, start: (i32, i32), observer: &mut dyn Observer) -> Option<(i32, i32)> {
        let mut best = (start, self.error(start, observer)?);
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
                let error = self.error(next, observer)?;
                let least = if best.0 == before.0 {
                    conditioning::MAX_BETTER_ERROR
                } else {
                    1.0
                };
                if error < least * best.1 {
                    best = (next, error);
                }
            }
            if best.0 == before.0 {
                return best.1.is_finite().then_some(best.0);
            }
        }
    }

    /// Tells the observer how far it is; `None` if that stops it.
    fn report(&mut self, best: f64, observer: &mut dyn Observer) -> Option<()> {
        let progress = Progress {
            stage: Stage::Tuning,
            fraction: (self.round as f64 + 0.5) / MOST_ROUNDS as f64,
            counts: self.counts,
            best,
        };
        self.stopped = observer.progress(&progress) == Control::Stop;
        (!self.stopped).then_some(())
    }

    /// The error at a place; `None` if the observer stopped it.
    fn error(&mut self, at: (i32, i32), observer: &mut dyn Observer) -> Option<f64> {
        if let Some((_, error)) = self.seen.iter().find(|(place, _)| *place == at) {
            return Some(*error);
        }
        let error = self.tried(at, self.replicas.len(), observer)?;
        self.seen.push((at, error));
        Some(error)
    }

    /// The same on some of the replicas, not remembered.
    fn tried(
        &mut self,
        at: (i32, i32),
        replicas: usize,
        observer: &mut dyn Observer,
    ) -> Option<f64> {
        let conditioning = cutoffs(self.wanted, self.rate, at);
        let mut sum = 0.0;
        for i in 0..replicas {
            let replica = &self.replicas[i];
            let found = first_order(replica, &conditioning, self.fitted, &mut self.counts);
            match found.filter(|found| found.kept >= self.least) {
                Some(found) => sum += self.distance(replica, &found),
                None => return Some(f64::INFINITY),
            }
            self.report((sum / (i + 1) as f64).sqrt(), observer)?;
        }
        Some((sum / replicas as f64).sqrt())
    }

    /// Mean square of the errors of the parameters that the log determines, as logarithms: that of the replica, and the
    /// variance that the noise of the force adds.
    fn distance(&self, replica: &Replica, found: &FirstOrder) -> f64 {
        let FittedLaw { law, terms, .. } = &self.fitted.fitted;
        let linear = terms.columns(law);
        let truth = physical(law, &linear, 1.0, &replica.p, self.fitted.coefficients());
        let fits = physical(law, &linear, 1.0, &found.p, &found.c);
        let known = |name: Name| self.fitted.parameter(name).is_some_and(|p| p.identifiable);
        let power = self.force_noise * self.force_noise;
        let errors: Vec<f64> = truth
            .iter()
            .zip(&fits)
            .filter(|(t, _)| t.is_positive() && t.value > 0.0 && known(t.name))
            .map(|(t, f)| {
                let shift = libm::log((f.value / t.value).max(0.0));
                let relative = power * f.variance(&found.covariance) / (t.value * t.value);
                let square = shift * shift + relative;
                if square.is_nan() {
                    return LARGEST_ERROR * LARGEST_ERROR;
                }
                square.min(LARGEST_ERROR * LARGEST_ERROR)
            })
            .collect();
        if errors.is_empty() {
            return f64::INFINITY;
        }
        errors.iter().sum::<f64>() / errors.len() as f64
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
