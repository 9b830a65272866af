//! Constant-velocity stretches of a log; each gives a point of the static map with its standard error.

use super::moments::Moments;
use super::settle::transient;
use crate::conditioning::record::Samples;
use crate::error::Error;
use crate::fit::MOST_LAGS;
use stiction_policy::procedure;
use stiction_signal::effective_sample_size;

/// Most parts into which a stretch is divided to look for standstill.
const MOST_PARTS: usize = 128;
/// Share of a stretch that is cut off at either end, because the velocity is rounded off at corners.
const CORNER_SHARE: f64 = 0.03;
/// Number of points before and after a stretch that are compared with it for this purpose.
const MOST_NEIGHBOURS: usize = 32;

/// One log as a procedure sees it: unfiltered, with what it was asked to do where that is known.
#[derive(Clone, Copy, Debug)]
pub struct Run<'a> {
    /// The log.
    pub samples: &'a Samples,
    /// Position that was asked for, m or rad.
    pub reference: Option<&'a [f64]>,
    /// Step of the position, m or rad, where known.
    pub resolution: Option<f64>,
}

/// One constant-velocity stretch: a point of the static map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StaticPoint {
    /// Which log, counted from 0.
    pub log: usize,
    /// First and last instant that count, s.
    pub time: (f64, f64),
    /// Mean position, m or rad.
    pub position: f64,
    /// Mean velocity, m/s or rad/s; its sign is the direction.
    pub velocity: f64,
    /// Mean force.
    pub force: f64,
    /// Standard error of the mean force, the correlation of its samples counted.
    pub error: f64,
    /// Samples that count.
    pub samples: usize,
    /// Number of independent samples that carry the same information.
    pub effective: f64,
    /// Time dropped at the start as transient, s.
    pub dropped: f64,
    /// Whole cogging pitches averaged over; 0 where no pitch is given or the stretch is shorter.
    pub pitches: usize,
}

impl StaticPoint {
    /// Whether this is only a part of the approach to, or the departure from, another point of the same log.
    fn leads_to(&self, other: &Self) -> bool {
        let seconds = |time: (f64, f64)| time.1 - time.0;
        let longer = seconds(other.time);
        let gap = (other.time.0 - self.time.1).max(self.time.0 - other.time.1);
        seconds(self.time) < procedure::MAX_APPROACH_DURATION * longer
            && gap < procedure::MAX_NEIGHBOUR_GAP * longer
            && (self.velocity / other.velocity - 1.0).abs() < procedure::MAX_NEIGHBOUR_VELOCITY
    }
}

/// Why a stretch of nearly constant velocity gives no point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unsteady {
    /// The axis stops and goes on.
    StickSlip,
    /// The force has not settled by the middle.
    Unsettled,
}

impl Unsteady {
    /// The reason in words.
    pub fn name(self) -> &'static str {
        match self {
            Unsteady::StickSlip => "the axis stops and starts again",
            Unsteady::Unsettled => "the force does not settle",
        }
    }
}

/// A stretch that was found and left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rejected {
    /// Which log, counted from 0.
    pub log: usize,
    /// First and last instant, s.
    pub time: (f64, f64),
    /// Mean velocity, m/s or rad/s.
    pub velocity: f64,
    /// Why.
    pub reason: Unsteady,
}

/// What was found in the logs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stretches {
    /// Points, in the order of the logs.
    pub points: Vec<StaticPoint>,
    /// Stretches that were left out.
    pub rejected: Vec<Rejected>,
}

/// Finds the constant-velocity stretches of each log.
///
/// A stretch is steady if every quarter of it moves within 3 % of its mean velocity, beyond what the
/// steps of the position allow; it is grown as far as that holds, the longest first. Then its velocity
/// may not drift by more than [`procedure::MAX_VELOCITY_DRIFT`] from the first quarter to the last once at most half of it
/// is dropped at the start, nor may the axis stop in between.
/// Both ends are cut by 3 %, and further until the force has settled (marginal standard error rule;
/// at most half). With
/// `pitches` (m or rad, positive) the force is averaged over a whole number of the longest that fits.
///
/// Where a reference is given, the stretches are looked for in it, and the measured motion has only to
/// follow.
///
/// # Errors
/// For channels that do not fit together.
pub fn stretches(runs: &[Run], pitches: &[f64]) -> Result<Stretches, Error> {
    let mut out = Stretches::default();
    for (log, run) in runs.iter().enumerate() {
        crate::conditioning::check(log + 1, run.samples)?;
        if let Some(reference) = run.reference
            && reference.len() != run.samples.time.len()
        {
            return Err(Error::Length {
                log: log + 1,
                channel: "reference",
                found: reference.len(),
                expected: run.samples.time.len(),
            });
        }
        Search::new(log, run, pitches).collect(&mut out);
    }
    Ok(out)
}

struct Search<'a> {
    log: usize,
    samples: &'a Samples,
    pitches: &'a [f64],
    position: Vec<f64>,
    /// Of the motion that is searched: reference or position.
    asked: Moments,
    moved: Moments,
    /// Largest error of one position, m or rad, in what is searched and in what was measured.
    asked_step: f64,
    step: f64,
}

impl<'a> Search<'a> {
    fn new(log: usize, run: &Run<'a>, pitches: &'a [f64]) -> Self {
        let samples = run.samples;
        let position = match (&samples.position, &samples.velocity) {
            (Some(x), _) => x.clone(),
            (None, Some(v)) => integral(&samples.time, v),
            (None, None) => vec![0.0; samples.time.len()],
        };
        let step = run.resolution.unwrap_or(0.0);
        let moved = Moments::new(&samples.time, &position);
        let (asked, asked_step) = match run.reference {
            Some(reference) => (Moments::new(&samples.time, reference), 0.0),
            None => (Moments::new(&samples.time, &position), step),
        };
        Self {
            log,
            samples,
            pitches,
            position,
            asked,
            moved,
            asked_step,
            step,
        }
    }

    fn collect(&self, out: &mut Stretches) {
        let n = self.samples.time.len();
        let mut free = self.usable();
        let mut length = n;
        let first = out.points.len();
        let first_rejected = out.rejected.len();
        while length >= procedure::MIN_STRETCH_SAMPLES {
            let hop = (length / 8).max(1);
            let mut from = 0;
            while from + length <= n {
                // Some of these samples already belong to another stretch: continue behind the last of them.
                if let Some(taken) = free[from..from + length].iter().rposition(|f| !f) {
                    from += taken + 1;
                    continue;
                }
                if self.steady(from, from + length) {
                    let (a, b) = self.grow(from, from + length, hop, &free);
                    free[a..b].fill(false);
                    match self.point(a, b) {
                        Ok(point) => out.points.push(point),
                        Err(Some(reason)) => out.rejected.push(self.rejected(a, b, reason)),
                        Err(None) => {}
                    }
                    from = b;
                } else {
                    from += hop;
                }
            }
            length = length * 3 / 4;
        }
        let mut own = out.points.split_off(first);
        own.sort_by(|a, b| a.time.0.total_cmp(&b.time.0));
        let near = |i: usize| {
            &own[i.saturating_sub(MOST_NEIGHBOURS)..(i + MOST_NEIGHBOURS).min(own.len())]
        };
        let kept = (0..own.len()).filter(|&i| !near(i).iter().any(|q| own[i].leads_to(q)));
        out.points.extend(kept.map(|i| own[i]));
        // A rejected stretch much shorter than the accepted ones is only the transition between two
        // speeds and is not reported.
        let seconds = |time: (f64, f64)| time.1 - time.0;
        let shortest = out.points[first..]
            .iter()
            .map(|p| seconds(p.time))
            .fold(f64::INFINITY, f64::min);
        if shortest.is_finite() {
            let mut index = 0;
            out.rejected.retain(|r| {
                index += 1;
                index <= first_rejected
                    || seconds(r.time) >= procedure::MAX_APPROACH_DURATION * shortest
            });
        }
        out.rejected[first_rejected..].sort_by(|a, b| a.time.0.total_cmp(&b.time.0));
    }

    /// Samples that may belong to a stretch: not excluded, and not across a break.
    fn usable(&self) -> Vec<bool> {
        let n = self.samples.time.len();
        let mut free = if self.samples.valid.is_empty() {
            vec![true; n]
        } else {
            self.samples.valid.clone()
        };
        for &at in &self.samples.breaks {
            if let Some(sample) = free.get_mut(at) {
                *sample = false;
            }
        }
        free
    }

    /// Whether every quarter moves as the whole does, beyond what the steps of the position allow.
    fn steady(&self, from: usize, to: usize) -> bool {
        let quarter = (to - from) / 4;
        let mean = self.asked.slope(from, to);
        let seconds = self.samples.time[to - 1] - self.samples.time[from];
        let travel = mean.abs() * seconds / 4.0;
        if !(travel > procedure::MIN_QUARTER_COUNTS * self.asked_step && travel > 0.0) {
            return false;
        }
        // The encoder steps cause an error of the slope that falls with the square of the number of steps.
        let counts = travel / self.asked_step;
        let allowed = mean.abs() * (procedure::MAX_VELOCITY_ERROR + 2.0 / (counts * counts));
        (0..4).all(|k| {
            let a = from + k * quarter;
            (self.asked.slope(a, a + quarter) - mean).abs() <= allowed
        })
    }

    /// The longest steady range around a steady one, in ever smaller moves of either end.
    fn grow(&self, from: usize, to: usize, hop: usize, free: &[bool]) -> (usize, usize) {
        let (mut a, mut b) = (from, to);
        let mut hop = hop;
        while hop > 0 {
            let left = a.saturating_sub(hop);
            let right = (b + hop).min(free.len());
            let mut moved = false;
            if left < a && free[left..a].iter().all(|&f| f) && self.edge(left, b, hop, true) {
                a = left;
                moved = true;
            }
            if right > b && free[b..right].iter().all(|&f| f) && self.edge(a, right, hop, false) {
                b = right;
                moved = true;
            }
            if !moved {
                hop /= 2;
            }
        }
        (a, b)
    }

    /// Whether a range is still steady with what was added at one end, and the end itself is on the
    /// line of the rest, so that a corner is not rounded off.
    fn edge(&self, from: usize, to: usize, hop: usize, left: bool) -> bool {
        if !self.steady(from, to) {
            return false;
        }
        let (core, added) = if left {
            ((from + hop, to), (from, from + hop))
        } else {
            ((from, to - hop), (to - hop, to))
        };
        let slope = self.asked.slope(core.0, core.1);
        let at = self.asked.instant(added.0, added.1) - self.asked.instant(core.0, core.1);
        let line = self.asked.mean(core.0, core.1) + slope * at;
        let added_time = self.samples.time[added.1 - 1] - self.samples.time[added.0];
        let allowed =
            procedure::MAX_VELOCITY_ERROR * slope.abs() * added_time.max(0.0) + self.asked_step;
        (self.asked.mean(added.0, added.1) - line).abs() <= allowed
    }

    /// The point of a stretch, or why it is rejected; `None` where it is too short to be reported.
    fn point(&self, from: usize, to: usize) -> Result<StaticPoint, Option<Unsteady>> {
        let corner = (CORNER_SHARE * (to - from) as f64) as usize;
        let to = to - corner;
        // The reference may jump to its speed at once while the axis only approaches it, so both are checked.
        let from = self.after_drift(&self.asked, from, to).ok_or(None)?;
        let from = self
            .after_drift(&self.moved, from, to)
            .ok_or(Some(Unsteady::StickSlip))?;
        let start = from + corner;
        if to < start + procedure::MIN_STRETCH_SAMPLES {
            return Err(None);
        }
        let mean = self.moved.slope(start, to);
        // A reference that the axis does not follow is a standstill too.
        let follows = mean * self.asked.slope(start, to) > 0.0;
        if !follows || self.stops(start, to, mean) {
            return Err(Some(Unsteady::StickSlip));
        }
        let (a, b) = self.settled(start, to).ok_or(Some(Unsteady::Unsettled))?;
        let (a, b, pitches) = self.whole_pitches(a, b);
        if b - a < procedure::MIN_STRETCH_SAMPLES {
            return Err(None);
        }
        let force = &self.samples.force[a..b];
        let n = force.len() as f64;
        let level = force.iter().sum::<f64>() / n;
        let variance = force.iter().map(|f| (f - level) * (f - level)).sum::<f64>() / (n - 1.0);
        let effective = effective_sample_size(force, MOST_LAGS.min(force.len() / 4))
            .map_or(n, |e| e.size)
            .max(1.0);
        Ok(StaticPoint {
            log: self.log,
            time: (self.samples.time[a], self.samples.time[b - 1]),
            position: self.moved.mean(a, b),
            velocity: self.moved.slope(a, b),
            force: level,
            error: (variance / effective).sqrt(),
            samples: b - a,
            effective,
            dropped: self.seconds(from, a + 1),
            pitches,
        })
    }

    /// The first sample from which the velocity no longer drifts; `None` where that is beyond the
    /// middle: a piece of a ramp, not the end of an approach.
    fn after_drift(&self, motion: &Moments, from: usize, to: usize) -> Option<usize> {
        let hop = ((to - from) / 32).max(1);
        (from..=from + (to - from) / 2).step_by(hop).find(|&from| {
            let quarter = (to - from) / 4;
            let mean = motion.slope(from, to).abs();
            let first = motion.slope(from, from + quarter);
            let last = motion.slope(to - quarter, to);
            let counts = mean * self.seconds(from, to) / 4.0 / self.step;
            (last - first).abs() <= mean * (procedure::MAX_VELOCITY_DRIFT + 2.0 / (counts * counts))
        })
    }

    /// Whether the axis stands still in some part of a stretch, as far as the position can tell.
    fn stops(&self, from: usize, to: usize, mean: f64) -> bool {
        let travel = mean.abs() * self.seconds(from, to);
        let told = if self.step > 0.0 {
            travel / (4.0 * self.step)
        } else {
            f64::INFINITY
        };
        let parts = MOST_PARTS.min((to - from) / 8).min(told as usize);
        if parts < 4 {
            return false;
        }
        let part = (to - from) / parts;
        (0..parts).any(|k| {
            let a = from + k * part;
            self.moved.slope(a, a + part) / mean < procedure::MAX_STANDSTILL_SPEED
        })
    }

    /// The part of a stretch over which the force has settled; `None` if it has not by the middle.
    fn settled(&self, from: usize, to: usize) -> Option<(usize, usize)> {
        let force = &self.samples.force[from..to];
        let mut back = force.to_vec();
        back.reverse();
        match (transient(force), transient(&back)) {
            (Some(start), Some(end)) if start + end <= force.len() / 2 => {
                Some((from + start, to - end))
            }
            // A slow ripple has no transient at the start that could be dropped.
            _ => (!drifts(force)).then_some((from, to)),
        }
    }

    /// The end of a stretch that covers a whole number of the longest pitch that fits into it.
    fn whole_pitches(&self, from: usize, to: usize) -> (usize, usize, usize) {
        let travel = (self.position[to - 1] - self.position[from]).abs();
        let fits = self.pitches.iter().copied().filter(|p| *p <= travel);
        let Some(pitch) = fits.reduce(f64::max) else {
            return (from, to, 0);
        };
        let whole = libm::floor(travel / pitch);
        let start = to - 1;
        let reached = (from..start)
            .rev()
            .find(|&i| (self.position[start] - self.position[i]).abs() >= whole * pitch);
        // The force has settled best at the end of a stretch, so whole pitches are counted back from there.
        (reached.unwrap_or(from), to, whole as usize)
    }

    fn seconds(&self, from: usize, to: usize) -> f64 {
        self.samples.time[to - 1] - self.samples.time[from]
    }

    fn rejected(&self, from: usize, to: usize, reason: Unsteady) -> Rejected {
        Rejected {
            log: self.log,
            time: (self.samples.time[from], self.samples.time[to - 1]),
            velocity: self.moved.slope(from, to),
            reason,
        }
    }
}

/// Whether the two halves of a signal differ by more than its own correlation explains, or hold too few
/// independent samples to decide.
fn drifts(signal: &[f64]) -> bool {
    let (a, b) = signal.split_at(signal.len() / 2);
    let of = |x: &[f64]| {
        let n = x.len() as f64;
        let mean = x.iter().sum::<f64>() / n;
        let variance = x.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n;
        let size = effective_sample_size(x, MOST_LAGS.min(x.len() / 2)).map_or(1.0, |e| e.size);
        (mean, variance / size.max(1.0), size)
    };
    let (first, second) = (of(a), of(b));
    let apart = (first.0 - second.0).abs();
    let told = apart > 3.0 * (first.1 + second.1).sqrt()
        || first.2.min(second.2) < procedure::MIN_INDEPENDENT_SAMPLES;
    told && apart > procedure::MAX_FORCE_DRIFT * (first.0 + second.0).abs()
}

fn integral(time: &[f64], velocity: &[f64]) -> Vec<f64> {
    let mut x = 0.0;
    let mut out = Vec::with_capacity(time.len());
    for i in 0..time.len() {
        if i > 0 {
            x += 0.5 * (velocity[i - 1] + velocity[i]) * (time[i] - time[i - 1]);
        }
        out.push(x);
    }
    out
}
