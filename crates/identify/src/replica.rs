//! A simulated log like the real one, of an axis whose parameters are known.
//!
//! The fitted axis is simulated under the logged force, and a soft spring and damper keep it on the
//! recorded motion. The force that then acted on it and the position that it reached, read by an encoder
//! of the same resolution, form a log whose true parameters are known exactly. Fitting it again shows the
//! effect of conditioning and noise on the parameters: the parametric bootstrap (Efron and Tibshirani
//! 1993, ISBN 0-412-04231-2, section 6.5) with the recorded motion in place of resampled data.

mod beside;

use crate::conditioning::record::{Record, Samples, Segment};
use crate::conditioning::shift::Shift;
use crate::drive::Drive;
use crate::estimate::Estimate;
use crate::law::terms::{Delay, FirstDelay, Terms};
use crate::reaction::{AS_MEAN, Logging, Reaction, is_logged_as_mean};
use stiction_policy::delay;

use beside::{Beside, Stepped};
use std::borrow::Cow;
use stiction_friction::{Damping, Direction, LuGre, Stribeck};
use stiction_parameters::Quantity;
use stiction_servo::encoder::Encoder;
use stiction_servo::noise::Noise;
use stiction_servo::plant::{Motion, Plant};

/// Delay of a force that is logged where it is held, from its sample to the next, samples.
pub(crate) const HELD_DELAY: f64 = -0.5;
/// The spring that keeps the simulated axis on the recorded motion: its frequency over the sample rate.
const TRACKING_FREQUENCY: f64 = 0.01;
/// The same where the response of the controller keeps it there: a stiff spring with its damper would
/// damp the motion that an encoder step causes.
const ANSWERED_TRACKING_FREQUENCY: f64 = 0.0005;

/// Logs of a known axis.
pub(crate) struct Replica {
    /// One log for each segment of the record.
    pub logs: Vec<Samples>,
    /// Their forces before noise was added.
    pub quiet: Vec<Vec<f64>>,
    /// The nonlinear unknowns behind them.
    pub p: Vec<f64>,
    /// The terms to fit them with: those of the estimate, with the delay that the replica has.
    pub terms: Terms,
}

impl Replica {
    /// The same motion and counts, with a force that was logged without noise.
    pub fn without_noise(&self) -> Self {
        let logs = self.logs.iter().zip(&self.quiet);
        let logs = logs.map(|(log, force)| Samples {
            force: force.clone(),
            ..log.clone()
        });
        Self {
            logs: logs.collect(),
            quiet: self.quiet.clone(),
            p: self.p.clone(),
            terms: self.terms.clone(),
        }
    }
}

/// The axis of an estimate, ready to be simulated along its record any number of times.
pub(crate) struct Axis<'a> {
    record: &'a Record,
    /// Of each segment: logs may have levels of their own.
    plants: Vec<Plant>,
    fitted: &'a Estimate,
    /// How the force was logged, and what it passes before the axis feels it where it has a lag.
    logging: Logging,
    drive: Drive,
    stroke: f64,
    substeps: u32,
    /// Segment by segment what acts beside the law and inertia.
    others: Vec<Beside>,
    /// The response of the controller, and segment by segment the force that then acted on the axis.
    answered: Option<(Reaction, Vec<Vec<f64>>)>,
}

impl<'a> Axis<'a> {
    /// `None` for an axis that cannot be simulated: without inertia, or without a bristle.
    pub fn of(record: &'a Record, fitted: &'a Estimate) -> Option<Self> {
        Self::logged(record, fitted, late(record, fitted))
    }

    /// The same with a force that is logged so many samples later than it was held.
    pub fn logged(record: &'a Record, fitted: &'a Estimate, late: f64) -> Option<Self> {
        let first = plant(fitted)?;
        let plants = record.segments.iter();
        let plants = plants.map(|segment| of_log(first, fitted, segment.log));
        let plants = plants.collect::<Option<Vec<_>>>()?;
        let lag = fitted.lag_samples();
        // A force that acts a sample late without a lag may as well be one whose rows are a sample off.
        let (logging, drive) = match lag > 0.0 {
            true => (
                Logging::new(late.max(0.0)),
                Drive::new((-late).max(0.0), lag),
            ),
            false => (Logging::new(late), Drive::DIRECT),
        };
        let segments = &record.segments;
        let linear = fitted.terms.columns(&fitted.law);
        let beside = linear.iter().zip(fitted.coefficients());
        let others = segments
            .iter()
            .zip(&plants)
            .map(|(segment, plant)| Beside::of(segment, plant.law(), beside.clone()))
            .collect::<Option<_>>()?;
        let answered = Reaction::of(record, logging).and_then(|reaction| {
            let felt = segments.iter().map(|s| reaction.felt(s, logging));
            Some((reaction, felt.collect::<Option<_>>()?))
        });
        Some(Self {
            record,
            substeps: substeps(&plants, record.step()),
            plants,
            fitted,
            logging,
            drive,
            stroke: record.stroke(),
            others,
            answered,
        })
    }

    /// Simulates it once; `None` if it does not follow the recorded motion.
    ///
    /// `force_noise` is the standard deviation of the white noise of the logged force.
    pub fn replica(&self, force_noise: f64, seed: u64) -> Option<Replica> {
        let answered = self.answered.as_ref();
        // A wrongly identified response, while the fit is still far off, may make the simulated axis oscillate.
        let both = self.logs(answered, force_noise, seed).or_else(|| {
            answered?;
            self.logs(None, force_noise, seed)
        })?;
        let delay = HELD_DELAY + self.logging.part - self.drive.late();
        let mut p = self.fitted.unknowns().to_vec();
        let mut terms = self.fitted.terms.clone();
        terms.first_delay = terms.first_delay.map(|first| of_replica(first, delay));
        match (terms.delay, p.last_mut()) {
            (Delay::Fitted, Some(own)) => *own = delay,
            _ => terms.delay = Delay::Given(delay * self.record.step()),
        }
        // Its fit is asked what conditioning does, not once more what was known before.
        terms.prior = terms.prior.map(|prior| prior.about(&self.fitted.law, &p));
        let (logs, quiet) = both.into_iter().unzip();
        Some(Replica {
            logs,
            quiet,
            p,
            terms,
        })
    }

    /// One log for each segment, with its force before noise was added; `None` if the axis does not follow one.
    fn logs(
        &self,
        answered: Option<&(Reaction, Vec<Vec<f64>>)>,
        force_noise: f64,
        seed: u64,
    ) -> Option<Vec<(Samples, Vec<f64>)>> {
        let mut noise = Noise::new(seed);
        let segments = self.record.segments.iter().zip(&self.others);
        segments
            .zip(&self.plants)
            .enumerate()
            .map(|(i, ((segment, other), plant))| {
                let answer = answered.map(|(reaction, felt)| (reaction, &felt[i][..]));
                self.run((segment, plant), other, answer, force_noise, &mut noise)
            })
            .collect()
    }

    fn run(
        &self,
        (segment, plant): (&Segment, &Plant),
        other: &Beside,
        answered: Option<(&Reaction, &[f64])>,
        force_noise: f64,
        noise: &mut Noise,
    ) -> Option<(Samples, Vec<f64>)> {
        let record = self.record;
        let h = segment.step;
        let steps = self.drive.substeps(self.substeps);
        let mut axis = Stepped::new(plant, other, steps)?;
        let n = segment.position.len();
        let tracking = match answered {
            Some(_) => ANSWERED_TRACKING_FREQUENCY,
            None => TRACKING_FREQUENCY,
        };
        let omega = std::f64::consts::TAU * tracking / h;
        let spring = plant.mass() * omega * omega;
        let damper = 1.4 * plant.mass() * omega;
        // Periodic motion crosses the encoder steps at the same places again and again: the position of
        // the steps is therefore one more random quantity of the log.
        let encoder = Encoder::new(record.resolution.unwrap_or(0.0)).ok()?;
        let encoder = encoder.with_phase(noise.uniform()).ok()?;
        // The part of the position noise that the encoder steps do not explain.
        let steps = encoder.resolution() / 12.0_f64.sqrt();
        let rest = (record.position_noise * record.position_noise - steps * steps).max(0.0);
        let rest = if rest > steps * steps {
            rest.sqrt()
        } else {
            0.0
        };
        let drive: Cow<[f64]> = match answered {
            Some((_, felt)) => felt.into(),
            None => {
                let earlier = Shift::earlier(-self.logging.late());
                (0..n).map(|k| earlier.at(&segment.drive, k)).collect()
            }
        };
        let part = self.logging.part;
        let mut before = drive.first().copied().unwrap_or(0.0);
        let mut behind = before;
        let mut commands = Vec::with_capacity(n);
        let mut motion = Motion {
            position: segment.position[0],
            velocity: segment.velocity[0],
            deflection: 0.0,
        };
        let (mut position, mut force) = (Vec::<f64>::with_capacity(n), Vec::with_capacity(n));
        let mut quiet = Vec::with_capacity(n);
        for k in 0..n {
            let error = segment.position[k] - motion.position;
            let slip = segment.velocity[k] - motion.velocity;
            if error.is_nan() || error.abs() > self.stroke {
                return None;
            }
            // Read beside the instant of its stamp.
            let beside = match record.timing_noise > 0.0 {
                true => motion.velocity * record.timing_noise * noise.normal(),
                false => 0.0,
            };
            let reading = encoder.read(motion.position + beside + rest * noise.normal());
            position.push(reading);
            let mut applied = drive[k] + spring * error + damper * slip;
            if let Some((reaction, _)) = answered {
                // The response to the logged readings is replaced by the response to the readings of the
                // replica.
                applied += reaction.force(|lag| {
                    let at = k.saturating_sub(lag);
                    position[at] - segment.reading[at]
                });
            }
            let logged = (1.0 - part) * applied + part * before;
            before = applied;
            quiet.push(logged);
            force.push(logged + force_noise * noise.normal());
            commands.push(applied);
            let acts = |part: f64, force: f64| {
                motion = axis.advance(k, motion, part * h, force);
            };
            self.drive
                .sample(&commands, self.substeps, &mut behind, acts);
        }
        if let Some(common) = record.common.as_ref().filter(|_| record.force_is_filtered) {
            force = common.zero_phase(&force).ok()?;
            quiet = common.zero_phase(&quiet).ok()?;
        }
        let samples = Samples {
            time: (0..n).map(|k| k as f64 * h).collect(),
            position: Some(position),
            force,
            valid: segment.valid.clone(),
            at_rest: segment.at_rest.clone(),
            load: logged(&segment.channels.load),
            temperature: logged(&segment.channels.temperature),
            external: logged(&segment.channels.external),
            ..Samples::default()
        };
        Some((samples, quiet))
    }
}

/// A channel that the log has.
fn logged(channel: &[f64]) -> Option<Vec<f64>> {
    (!channel.is_empty()).then(|| channel.to_vec())
}

/// Samples by which the force is logged later than it was held; negative where it acts later than it was logged. A drive logs
/// the force of this sample or of one before, or the mean of two: a fitted delay that chance may have moved from there is taken
/// as that, unless there is a lag. Where it may be either, the response of the controller to its readings tells which (decision
/// 0108).
///
/// The higher the cut-offs, the more of what a controller answers to its encoder is taken for a delay, and a replica with that
/// delay is as biased as the fit. Where a first fit with low cut-offs surely had another one, it is that of the log (decision
/// 0082).
pub(crate) fn late(record: &Record, fitted: &Estimate) -> f64 {
    let own = fitted.delay_samples();
    let is_sought = fitted.terms.delay == Delay::Fitted && fitted.lag_samples() == 0.0;
    if !is_sought {
        return own - HELD_DELAY;
    }
    let deviation = deviation(fitted, record.step());
    held_late(own, deviation, fitted.terms.first_delay, || {
        is_logged_as_mean(record)
    })
}

/// The same from the delay of a fit with its standard deviation, where it has one, and that of a first fit, samples; `is_mean`
/// says whether the log has the mean of two.
fn held_late(
    own: f64,
    deviation: Option<f64>,
    first: Option<FirstDelay>,
    is_mean: impl FnOnce() -> bool,
) -> f64 {
    let moved = |first: &FirstDelay| {
        (own - first.delay).abs() > delay::MIN_SURE_DEVIATIONS * first.deviation
    };
    let (delay, deviation) = match first.filter(moved) {
        Some(first) => (first.delay, Some(first.deviation)),
        None => (own, deviation),
    };
    let late = delay - HELD_DELAY;
    let Some(deviation) = deviation else {
        return late;
    };
    let within = |times: f64, near: f64| (late - near).abs() <= times * deviation;
    let (whole, half) = (late.round(), late.floor() + 0.5);
    let [is_whole, is_half] = [whole, half].map(|near| within(delay::MAX_CHANCE_DEVIATIONS, near));
    // A mean of the sample and the one before, unless it surely acts whole samples later besides.
    let mean = if within(delay::MIN_SURE_DEVIATIONS, AS_MEAN) {
        AS_MEAN
    } else {
        half
    };
    if is_whole && within(delay::MIN_SURE_DEVIATIONS, mean) && is_mean() {
        return mean;
    }
    match (is_whole, is_half) {
        (true, _) => whole,
        (false, true) => half,
        (false, false) => late,
    }
}

/// What a first fit of a replica with this delay, samples, would find: its delay is that of the log but for whole samples.
fn of_replica(first: FirstDelay, delay: f64) -> FirstDelay {
    FirstDelay { delay, ..first }
}

/// The delay of a fit with its standard deviation; `None` where it has none.
pub(crate) fn first_delay(fitted: &Estimate, step: f64) -> Option<FirstDelay> {
    Some(FirstDelay {
        delay: fitted.delay_samples(),
        deviation: deviation(fitted, step)?,
    })
}

/// Standard deviation of a fitted delay, samples.
pub(crate) fn deviation(fitted: &Estimate, step: f64) -> Option<f64> {
    let delay = fitted.parameter(Quantity::Delay)?;
    delay.std.map(|std| std / step)
}

/// Plant steps in a sample: the implicit midpoint has a relative error of a twelfth of `(h omega)^2` in
/// the frequency of the mass on its bristles, which should be a small part of a percent.
fn substeps(plants: &[Plant], h: f64) -> u32 {
    let squares = plants.iter().map(|p| p.law().stiffness() / p.mass());
    let omega = squares.fold(0.0, f64::max).sqrt();
    (h * omega / 0.05).ceil().clamp(1.0, 8.0) as u32
}

/// The plant of an estimate: the law as it was fitted, sigma1 constant. The offset is among the forces beside it.
fn plant(fitted: &Estimate) -> Option<Plant> {
    let law = fitted.values().without(Quantity::Offset).lugre().ok()?;
    Plant::new(fitted.value(Quantity::Mass)?, law).ok()
}

/// The plant of one log where logs have levels of their own: the whole bristle, and so static friction and stiffness with it,
/// goes with the Coulomb level.
fn of_log(first: Plant, fitted: &Estimate, log: usize) -> Option<Plant> {
    let number = log as u32 + 1;
    let beyond = |quantity: Quantity| fitted.value(quantity).unwrap_or(0.0);
    let level = beyond(Quantity::CoulombLog(number));
    let damping = beyond(Quantity::Sigma1Log(number));
    let viscous = beyond(Quantity::Sigma2Log(number));
    if [level, damping, viscous] == [0.0; 3] {
        return Some(first);
    }
    let law = first.law();
    let curve = law.curve();
    let by = 1.0 + level / curve.positive().coulomb;
    let [positive, negative] = [curve.positive(), curve.negative()].map(|side| Direction {
        coulomb: by * side.coulomb,
        static_friction: by * side.static_friction,
        viscous: viscous + side.viscous,
        ..*side
    });
    let curve = Stribeck::new(curve.shape(), positive, negative, curve.offset()).ok()?;
    // What is not determined may come out below zero.
    let damping = (law.damping().at_rest() + damping).max(0.0);
    let law = LuGre::new(by * law.stiffness(), Damping::Constant(damping), curve).ok()?;
    Plant::new(first.mass(), law).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fit of a short log hardly tells a force that was logged as it was held from the mean of two.
    #[test]
    fn the_answer_decides_where_the_delay_does_not() {
        let late = |own, deviation, is_mean| held_late(own, Some(deviation), None, || is_mean);
        assert_eq!(late(-0.3, 0.3, false), 0.0);
        assert_eq!(late(-0.3, 0.3, true), 0.5);
        assert_eq!(late(-0.6, 0.3, true), 0.5);
        // Surely another delay, whatever was answered.
        assert_eq!(late(-0.49, 0.01, true), 0.0);
        assert_eq!(late(-1.1, 0.2, true), -0.5);
        assert_eq!(late(-1.18, 0.01, false), -1.18 - HELD_DELAY);
    }

    /// The force of a log acts 0.09 samples later than it was held; rows of a replica are a whole sample later, and a fit of it
    /// finds a delay as far beside the truth as that of the log.
    #[test]
    fn a_replica_of_a_replica_has_the_delay_of_its_own_log() {
        let first = FirstDelay {
            delay: -0.586,
            deviation: 0.094,
        };
        let late = held_late(-0.591, Some(0.02), Some(first), || false);
        assert!((late + 0.091).abs() < 1e-12, "{late}");
        let delay = HELD_DELAY + Logging::new(late).part;
        let found = delay - 0.044;
        let again = held_late(found, Some(0.02), Some(of_replica(first, delay)), || false);
        assert!((again - 0.865).abs() < 1e-12, "{again}");
    }
}
