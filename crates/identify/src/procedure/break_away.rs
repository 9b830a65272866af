//! Break-away: the force at which an axis starts to move under a rising force, with the rise's rate.
//!
//! It is no point of the static map: the faster the force rises, the lower it is (Canudas de Wit et
//! al. 1995, doi 10.1109/9.376053, section III.C).
//!
//! **Criterion.** In presliding the axis moves too, and ever faster. The instant of break-away is the
//! last one at which the axis was slower than a threshold, before it stays faster. The threshold is the
//! given speed (a third of vs where a model is known), but never below what the position resolves: five
//! of its steps, or of the standard deviation of its noise at rest, within a hundredth of the ramp. The
//! force is that of the ramp at that instant. It accelerates the axis too: what friction takes of it is less by mass
//! times the acceleration there, which on fast ramps is more than friction falls.
//!
//! **Stick-slip.** An axis that slips and sticks again, once or many times, has broken away at its first slip: it is faster
//! than the threshold for a while, moves farther than all the way before, and comes to rest again.

use super::moments::Moments;
use super::stretch::Run;
use crate::error::Error;
use std::ops::Range;
use stiction_number::short;
use stiction_policy::procedure;
use stiction_servo::plant::{Load, Motion, Plant};

/// Share of the ramp over which the velocity is taken.
const WINDOW_SHARE: f64 = 0.01;
/// Most steps of a prediction.
const MOST_STEPS: f64 = 2e6;

/// One break-away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BreakAway {
    /// Instant of break-away, s.
    pub time: f64,
    /// Force there, with its sign.
    pub force: f64,
    /// Standard deviation of the force about the ramp.
    pub scatter: f64,
    /// Rate of the force until then, per second, with its sign.
    pub rate: f64,
    /// Displacement from rest until then, m or rad.
    pub displacement: f64,
    /// Speed that counts as broken away, m/s or rad/s.
    pub threshold: f64,
    /// Acceleration at that instant, m/s^2 or rad/s^2, with its sign.
    pub acceleration: f64,
    /// Slips after which the axis stuck again; 0 where it breaks away once and goes on.
    pub slips: usize,
}

/// What a model predicts of a break-away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Predicted {
    /// Force of the ramp when the axis passes the threshold: the criterion of the measurement.
    pub force: f64,
    /// Friction there: that force without what accelerates the axis.
    pub at_threshold: f64,
    /// First maximum of the friction force, which no sensor sees.
    pub friction: f64,
}

/// Finds the break-away in a log in which the force rises steadily from rest.
///
/// # Errors
/// [`Error::NoBreakAway`] where the force does not rise in a line from rest, or the axis moves from the start or never.
pub fn break_away(run: &Run, threshold: Option<f64>, log: usize) -> Result<BreakAway, Error> {
    crate::conditioning::check(log + 1, run.samples)?;
    let none = |reason: &str| Error::NoBreakAway {
        log: log + 1,
        reason: reason.into(),
    };
    let (time, force) = (&run.samples.time, &run.samples.force);
    let position = run
        .samples
        .position
        .as_ref()
        .ok_or(none("the log has no position"))?;
    let top = (0..force.len())
        .max_by(|&a, &b| force[a].abs().total_cmp(&force[b].abs()))
        .unwrap_or(0);
    let sign = force[top].signum();
    // The ramp begins where the force rises above a twentieth of its final value for the last time.
    let start = (0..top)
        .rposition(|i| force[i] * sign <= 0.05 * force[top].abs())
        .unwrap_or(0);
    if top - start < procedure::MIN_RAMP_SAMPLES {
        return Err(none("the ramp has fewer than 50 samples"));
    }
    let window = (((top - start) as f64 * WINDOW_SHARE) as usize).max(4);
    let moved = Moments::new(time, position);
    let width = time[(start + window).min(top)] - time[start];
    let rest = &position[start.saturating_sub(window)..start + window];
    let low = rest.iter().copied().fold(f64::INFINITY, f64::min);
    let high = rest.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    // The position hardly moves at the start, so its range there shows its noise.
    let noise = run.resolution.unwrap_or((high - low) / 4.0);
    let speed = |i: usize| sign * moved.slope(i - window / 2, i - window / 2 + window);
    let range = (start + window)..(top.saturating_sub(window));
    if range.len() < procedure::MIN_RAMP_SAMPLES / 2 {
        return Err(none("the ramp is too short for the noise of its position"));
    }
    let fastest = range.clone().map(speed).fold(0.0, f64::max);
    let threshold = threshold
        .unwrap_or_else(|| {
            let early = range.clone().take(range.len() / 5).map(speed);
            let elastic = procedure::BREAK_AWAY_OF_ELASTIC_SPEED * median(early.collect());
            (procedure::BREAK_AWAY_OF_TOP_SPEED * fastest).max(elastic.min(0.5 * fastest))
        })
        .max(procedure::MIN_RAMP_STEPS * noise / width);
    if fastest <= threshold {
        return Err(none(
            "the axis does not break away: it stays slower than the threshold",
        ));
    }
    let slow = range
        .clone()
        .rposition(|i| speed(i) < threshold)
        .ok_or(none("the axis moves from the start of the ramp"))?;
    let place = |i: usize| moved.mean(i - window / 2, i - window / 2 + window);
    // The way before the first slip; every slip is longer.
    let mut presliding = None;
    let slips = slips(
        range.clone(),
        |i| speed(i) >= threshold,
        |from, to| {
            let before = (place(from) - mean(rest))
                .abs()
                .max(procedure::MIN_RAMP_STEPS * noise);
            let slipped = (place(to) - place(from)).abs() > presliding.unwrap_or(before);
            if slipped && to - from >= window {
                presliding.get_or_insert(before);
                return true;
            }
            false
        },
    );
    let i = slips.first().map_or(range.start + slow, |slip| *slip);
    if i + 1 >= range.end {
        return Err(none(
            "the axis does not go on moving until the end of the ramp",
        ));
    }
    // Linear interpolation between the two samples around the threshold.
    let (a, b) = (speed(i), speed(i + 1));
    let share = ((threshold - a) / (b - a)).clamp(0.0, 1.0);
    let instant = time[i] + share * (time[i + 1] - time[i]);
    // Over the shortest time in which the path bends clearly: the axis is about to go off, and accelerates ever more.
    let bent = |reach: usize| {
        let around = |at: usize| moved.mean(at - reach / 4, at + reach / 4 + 1);
        around(i + reach) - 2.0 * around(i) + around(i - reach)
    };
    let most = (2 * window).min((i - start) / 2).min((top - i) / 2).max(1);
    let reaches = std::iter::successors(Some(4), |reach| Some(reach + reach / 4));
    let reach = reaches
        .take_while(|reach| *reach < most)
        .find(|&reach| bent(reach).abs() > procedure::MIN_RAMP_STEPS * noise)
        .unwrap_or(most);
    let half = 0.5 * (time[i + reach] - time[i - reach]);
    let acceleration = bent(reach) / (half * half);
    let ramp = Moments::new(time, force);
    let rate = ramp.slope(start, i + 1);
    let line = |t: f64| ramp.mean(start, i + 1) + rate * (t - ramp.instant(start, i + 1));
    let off = (start..=i)
        .map(|k| (force[k] - line(time[k])).powi(2))
        .sum::<f64>();
    let scatter = (off / (i + 1 - start) as f64).sqrt();
    let at = line(instant);
    let risen = (rate * (instant - time[start])).abs();
    if scatter.is_nan() || scatter > procedure::MAX_RAMP_BEND * risen {
        return Err(none("the force does not rise linearly until break-away"));
    }
    // What the axis did before, for as long as the ramp took.
    let before = start - start.min(i - start);
    let held = force[before..start].iter();
    let most = held.fold(0.0_f64, |a, f| if f.abs() > a.abs() { *f } else { a });
    if most.abs() > procedure::MAX_FORCE_BEFORE * at.abs() {
        let reason = format!(
            "what rises to {} at {} s began at {} s after a force of {}",
            short(at),
            short(instant),
            short(time[start]),
            short(most)
        );
        return Err(none(&reason));
    }
    let late = start - (start - before) / 4;
    let way = |from: usize, to: usize| (place(to) - place(from)).abs();
    if late > window && start - late >= window {
        let (came, went) = (way(late, start), (place(i) - mean(rest)).abs());
        let slower = came * (time[i] - time[start]) <= went * (time[start] - time[late]);
        if came > procedure::MIN_RAMP_STEPS * noise && !slower {
            let reason = format!(
                "the axis still moves when the force begins to rise, at {} s",
                short(time[start])
            );
            return Err(none(&reason));
        }
    }
    Ok(BreakAway {
        time: instant,
        force: at,
        scatter,
        rate,
        displacement: place(i) - mean(rest),
        threshold,
        acceleration,
        slips: slips.len(),
    })
}

/// The last slow sample before each slip that ends in rest again, where `is_slip` says so of its beginning and end.
fn slips(
    range: Range<usize>,
    is_fast: impl Fn(usize) -> bool,
    mut is_slip: impl FnMut(usize, usize) -> bool,
) -> Vec<usize> {
    let mut out = Vec::new();
    let mut slow = None;
    for i in range {
        if is_fast(i) {
            continue;
        }
        // Fast samples lie between this slow one and the last.
        if let Some(last) = slow.replace(i)
            && i - last > 1
            && is_slip(last, i)
        {
            out.push(last);
        }
    }
    out
}

/// What a plant with LuGre friction does under a ramp of `rate` (> 0, force per second) from rest: the
/// force at which it passes the speed `threshold` (m/s, rad/s), and the first maximum of friction.
///
/// `None` where that takes more than two million steps, or never comes.
pub fn predict_break_away(plant: &Plant, rate: f64, threshold: f64) -> Option<Predicted> {
    let law = plant.law();
    let level = law.curve().static_level(1.0);
    let natural = (plant.mass() / law.stiffness()).sqrt();
    // Up to more than twice the static level, because inertia and viscous friction add to the force.
    let whole = 3.0 * level / rate + 100.0 * natural;
    let h = (0.02 * natural).max(whole / MOST_STEPS);
    if !(rate > 0.0 && threshold > 0.0 && h.is_finite() && h < natural) {
        return None;
    }
    let mut motion = Motion::default();
    let (mut friction, mut peak) = (0.0_f64, None);
    let mut crossed = None;
    for k in 0..MOST_STEPS as usize {
        let t = k as f64 * h;
        let next = plant
            .step(motion, h, Load::force(rate * (t + 0.5 * h)))
            .motion;
        if crossed.is_none() && next.velocity >= threshold {
            let share = (threshold - motion.velocity) / (next.velocity - motion.velocity);
            let [before, after] = [motion, next].map(|m| law.force(m.deflection, m.velocity));
            crossed = Some((rate * (t + share * h), before + share * (after - before)));
        }
        motion = next;
        let now = law.force(motion.deflection, motion.velocity);
        // Friction rises again when viscous friction takes over: the first maximum counts.
        if peak.is_none() && now < friction * (1.0 - 1e-9) {
            peak = Some(friction);
        }
        friction = now;
        if let (Some((force, at_threshold)), Some(friction)) = (crossed, peak) {
            return Some(Predicted {
                force,
                at_threshold,
                friction,
            });
        }
        if t > whole {
            break;
        }
    }
    // If overdamped, friction has no maximum: its value at the threshold is taken.
    crossed.map(|(force, at_threshold)| Predicted {
        force,
        at_threshold,
        friction: peak.unwrap_or(friction),
    })
}

fn median(mut x: Vec<f64>) -> f64 {
    x.sort_by(f64::total_cmp);
    x.get(x.len() / 2).copied().unwrap_or(0.0)
}

fn mean(x: &[f64]) -> f64 {
    x.iter().sum::<f64>() / x.len().max(1) as f64
}
