//! What encoder steps, filters and noise do to a fit with the steady curve held, measured on replicas as for a fit of
//! everything ([`crate::estimate`]): simulated logs of the fitted axis, conditioned and fitted alike, whose fits come out
//! as far from their truth as the fit of the log presumably is from the axis.
//!
//! With the curve held the shift is another one than that of a fit of everything: the levels cannot give way.

use super::dynamic::Held;
use super::statics::Statics;
use crate::conditioning::record::Record;
use crate::conditioning::{Conditioning, condition, condition_as};
use crate::estimate::Estimate;
use crate::law::physical::physical;
use crate::law::terms::{Delay, Terms};
use crate::parameter::Parameter;
use crate::refit::force_noise;
use crate::replica::{Axis, Replica};
use crate::scatter::Variances;
use crate::shifts::{REPLICA_COUNT, SHIFT_DOUBT, Shifts, TEN_REPLICAS_FACTOR, as_found, between};
use crate::watch::Watch;
use stiction_search::{Control, Observer, Stage};

/// First seed of them.
const FIRST_SEED: u64 = 3000;
/// First seed of the replicas of replicas.
const FIRST_SECOND_SEED: u64 = 4000;

/// Takes what the conditioning adds to the parameters that were fitted beside the curve off them, and counts in their
/// intervals what is not known of it, and the error of a delay that was held: `delay_deviation`, s, 0 where it is known. What
/// the conditioning adds is left where it cannot be measured: the motion does not come from a position, the axis cannot be
/// simulated, or the observer stops it.
pub fn dynamic_conditioned(
    record: &Record,
    statics: &Statics,
    estimate: &mut Estimate,
    delay_deviation: f64,
    observer: &mut dyn Observer,
) {
    let mut watch = Watch::new(observer, Stage::Calibration);
    let shifts = shifts(record, statics, estimate, &mut watch);
    let late = of_delay(record, statics, estimate, delay_deviation, &mut watch);
    estimate.fitted.counts.add(&watch.counts);
    let linear = estimate.terms.columns(&estimate.law);
    let (p, c) = (estimate.unknowns(), estimate.coefficients());
    let raw = physical(&estimate.law, &linear, record.step(), p, c);
    let level = statics.sides[0].coulomb;
    for (i, found) in raw.iter().enumerate() {
        let fitted = &mut estimate.fitted;
        let Some(place) = fitted.covariance.place(found.name) else {
            continue;
        };
        let Some(parameter) = fitted.parameters.iter_mut().find(|p| p.name == found.name) else {
            continue;
        };
        // What is held stays where it is, in every replica.
        let is_held = Statics::holds(found.name.quantity) || !parameter.identified;
        if is_held || parameter.std.is_none() {
            continue;
        }
        let stated = fitted.covariance.matrix[place][place];
        let (bias, conditioned) = match &shifts {
            Some([first, second]) => {
                let (bias, scatter) = (first.mean(i), first.variance(i));
                // What the residual states may be less than what replicas scatter by, since encoder steps repeat with the
                // motion.
                let doubt = SHIFT_DOUBT * bias;
                let variance = stated.max(TEN_REPLICAS_FACTOR * scatter)
                    + scatter / first.count()
                    + doubt * doubt
                    + second.change(first, i);
                (Some(bias), variance)
            }
            None => (None, stated),
        };
        let late = late.as_ref().map_or(0.0, |late| late[i]);
        let variance = conditioned + late * late;
        let widen = (variance / stated).sqrt();
        if !widen.is_finite() {
            continue;
        }
        *parameter = Parameter::judged(
            found,
            Variances::known(variance),
            bias,
            String::new(),
            level,
        );
        let matrix = &mut fitted.covariance.matrix;
        matrix[place].iter_mut().for_each(|x| *x *= widen);
        matrix.iter_mut().for_each(|row| row[place] *= widen);
    }
}

/// By how much each parameter moves with one deviation of the delay that is held; `None` where it is known.
fn of_delay(
    record: &Record,
    statics: &Statics,
    fitted: &Estimate,
    deviation: f64,
    watch: &mut Watch,
) -> Option<Vec<f64>> {
    let Delay::Given(delay) = fitted.terms.delay else {
        return None;
    };
    if deviation <= 0.0 {
        return None;
    }
    let mut at = |delay: f64| {
        let terms = Terms {
            delay: Delay::Given(delay),
            ..fitted.terms.clone()
        };
        let held = Held::new(record, statics, fitted.law, &terms);
        let (p, c, counts) = held.found_near(fitted.unknowns())?;
        watch.counts.add(&counts);
        let linear = terms.columns(&fitted.law);
        Some(physical(&fitted.law, &linear, record.step(), &p, &c))
    };
    let [early, late] = [at(delay - deviation)?, at(delay + deviation)?];
    let pairs = early.iter().zip(&late);
    Some(pairs.map(|(a, b)| 0.5 * (b.value - a.value)).collect())
}

/// By how much each parameter comes out beside its truth: replica by replica, and replica by replica of a replica.
fn shifts(
    record: &Record,
    statics: &Statics,
    fitted: &Estimate,
    watch: &mut Watch,
) -> Option<[Shifts; 2]> {
    let conditioning = record.conditioning?;
    let axis = Axis::of(record, fitted)?;
    let noise = force_noise(record, &axis, &conditioning, fitted, &mut watch.counts)?;
    let [mut first, mut second] = [Shifts::default(), Shifts::default()];
    for i in 0..REPLICA_COUNT {
        let replica = axis.replica(noise, FIRST_SEED + i)?;
        let found = once(&replica, &conditioning, statics, fitted, watch)?;
        // One that cannot be simulated again is left out.
        if let Ok(again) = condition(&replica.logs, &conditioning)
            && let Some(axis) = Axis::of(&again, &found.estimate)
            && let Some(next) = axis.replica(noise, FIRST_SECOND_SEED + i)
            && let Some(next) = once(&next, &conditioning, statics, &found.estimate, watch)
        {
            second.0.push(next.shift);
        }
        first.0.push(found.shift);
        watch.fraction = (i + 1) as f64 / REPLICA_COUNT as f64;
        if watch.report(f64::INFINITY) == Control::Stop {
            return None;
        }
    }
    Some([first, second])
}

/// What the fit of one replica found.
struct Found {
    shift: Vec<f64>,
    /// The estimate with these results in place of its own.
    estimate: Estimate,
}

fn once(
    replica: &Replica,
    conditioning: &Conditioning,
    statics: &Statics,
    fitted: &Estimate,
    watch: &mut Watch,
) -> Option<Found> {
    // The noise of the position is asked of a log that replicas are made of, not of a replica that is fitted.
    let record = condition_as(&replica.logs, conditioning, 0.0).ok()?;
    let held = Held::new(&record, statics, fitted.law, &replica.terms);
    let (p, c, counts) = held.found_near(&replica.p)?;
    watch.counts.add(&counts);
    let linear = fitted.terms.columns(&fitted.law);
    let at = |p: &[f64], c: &[f64]| physical(&fitted.law, &linear, record.step(), p, c);
    let truth = at(&replica.p, fitted.coefficients());
    let found = at(&p, &c);
    Some(Found {
        shift: between(&truth, &found),
        estimate: as_found(fitted, replica, (&p, &c), &found),
    })
}
