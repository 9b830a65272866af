//! The law that makes the counts of a log most likely, started from the fit of the force.

use crate::conditioning::record::Record;
use crate::estimate::Estimate;
use crate::exponential::exp;
use crate::law::LawKind;
use crate::law::terms::{ColumnKind, Delay};
use crate::parameter::Parameter;
use crate::replica::HELD_DELAY;
use crate::state_space::axis::GAUSSIAN;
use crate::state_space::climb::{Problem, Top};
use crate::state_space::covariance::{Sureness, sureness};
use crate::state_space::data::Data;
use crate::state_space::filter::{Start, Stretch};
use crate::state_space::unknowns::{
    COULOMB, DAMPING, DISTURBANCE, EACH_SIDE, MASS, MEMORY, OFFSET, RATIO, STIFFNESS, UNKNOWNS,
    VELOCITY, VISCOUS, WHITE, lanes,
};
use crate::watch::Watch;
use libm::log;
use stiction_parameters::{Quantity, Side};
use stiction_policy::encoder;
use stiction_search::Control;

/// Parts of the samples that the jackknife leaves out in turn.
const BLOCKS: usize = 20;
/// Most samples of a log: each costs some 25 us, with all that a fit evaluates.
const MOST_SAMPLES: usize = 120_000;
/// Distance between the delays that are tried, samples: a force is logged at its sample, at one later, or as the mean of two.
const DELAYS_APART: f64 = 0.5;
/// How far the delay may be from the one that is taken, samples, 95 % of what lies evenly within half of that distance: which of the
/// delays between is not known, since the likelihood has it up to a quarter of a sample early (decision 0060). A fit of the force
/// that has about the same delay may know it closer.
const DELAY_REACH: f64 = 0.5 * DELAYS_APART * 1.96 / 1.732;
/// Most delays that are tried.
const MOST_DELAYS: usize = 6;
/// Stribeck velocities that climbs start from, parts of the top speed, and Fs/Fc there.
const START_VELOCITIES: [f64; 4] = [0.003, 0.01, 0.03, 0.1];
const START_RATIO: f64 = 1.3;
/// What counts too stiff or too soft an axis is started from: factors of sigma0 and sigma1.
const START_BRISTLES: [[f64; 2]; 2] = [[1.25, 0.5], [0.8, 2.0]];
/// Steps of a climb from each start, from the best two, and at other delays, on a third of the samples; on all of them.
const FIRST_STEPS: usize = 3;
const SECOND_STEPS: usize = 15;
const DELAY_STEPS: usize = 15;
const CURVE_STEPS: usize = 15;
const LAST_STEPS: usize = 30;
/// Rise of the log likelihood in a step after which nothing is left to gain, on a part of the samples and on all of them.
const LEAST_RISES: [f64; 2] = [0.3, 0.02];
/// Part of the search that is done after the starts, after the delays, and before all samples are asked; and by which part of what
/// is left until then each climb brings it on, since nobody knows how many there will be.
const DONE: [f64; 3] = [0.4, 0.7, 0.9];
const STEP_ON: f64 = 0.3;
/// Parts that each stretch is cut into, the middle third of which is taken.
const PARTS: usize = 3;
/// Where the errors of the force start: white error and disturbance in parts of its noise, memory in samples.
const START_WHITE: f64 = 0.05;
const START_DISTURBANCE: f64 = 0.2;
const START_MEMORY: f64 = 10.0;
/// Least noise that a force is taken to have, parts of Coulomb friction.
const LEAST_NOISE: f64 = 1e-9;
/// Least damping that is started from, in parts of sqrt(sigma0 M): a fit of the force spoiled by rests may end without any, where
/// no slope leads back.
const LEAST_DAMPING: f64 = 0.2;
/// Stribeck exponent that a Gaussian curve is held against: that of an exponential one.
const EXPONENTIAL: f64 = 1.0;
/// Lowest logarithm of a parameter that is zero.
const NOTHING: f64 = -30.0;

/// Why a top is not believed where more of the force is left than noise.
const MORE_ACTS: &str = "they leave more of the force than its noise, as where something acts on the axis that the law does not describe";

/// The top of the likelihood.
pub(super) struct Likely {
    pub at: [f64; UNKNOWNS],
    /// The unknowns that were free, those beside the law last.
    pub free: Vec<usize>,
    pub sureness: Sureness,
    /// Delay of the force behind the motion, samples, and its 95 % reach, where it was looked for.
    pub delay: Option<[f64; 2]>,
    /// 95 % reach of the logarithm of the micro-damping by where the delay is; nothing where that is given.
    pub delayed: f64,
    /// The top with a Stribeck curve of another shape, where that is about as likely, or likelier.
    pub other: Option<[f64; UNKNOWNS]>,
    /// The Stribeck exponent that is likelier than that of the law, where there is one.
    pub exponent: Option<f64>,
    /// Whether so much is left on the force that the search was given up.
    pub hopeless: bool,
    /// Why it is not believed; empty if it is.
    pub against: &'static str,
}

/// Whether a law and a log are of the kind that is simulated here.
pub(super) fn can_be_asked(record: &Record, fitted: &Estimate) -> bool {
    let samples: usize = record.segments.iter().map(|s| s.reading.len()).sum();
    let law = &fitted.law;
    let columns = fitted.terms.columns(law);
    let simulated = law.kind == LawKind::LuGre
        && law.exponent == 2.0
        && !law.exponent_fitted
        && columns.iter().all(|term| is_simulated(term.column));
    simulated && samples <= MOST_SAMPLES
}

/// `None` where there is no such law, or the observer stops it.
pub(super) fn most_likely(
    record: &Record,
    fitted: &Estimate,
    stated: Option<&Parameter>,
    watch: &mut Watch,
) -> Option<Likely> {
    let law = &fitted.law;
    let mut search = Search {
        record,
        fitted,
        free: free(fitted),
        noise: f64::INFINITY,
        until: DONE[0],
        watch,
    };
    let begun = start(fitted)?;
    let looked_for = fitted.terms.delay == Delay::Fitted;
    let late = fitted.delay_samples() - HELD_DELAY;
    let nearest = match looked_for {
        true => DELAYS_APART * libm::round(late / DELAYS_APART),
        false => late,
    };
    let first = search.many_starts(&begun, nearest)?;
    if Left::of(&first.top, search.noise).is_beyond(encoder::MAX_PART_EXCESS) {
        return Some(Likely {
            sureness: sureness(&first.top, &search.free)?,
            at: first.top.at,
            free: search.free,
            delay: None,
            delayed: 0.0,
            hopeless: true,
            other: None,
            exponent: None,
            against: MORE_ACTS,
        });
    }
    search.until = DONE[1];
    let (best, delay) = match looked_for {
        true => search.best_delay(first)?,
        false => (first, None),
    };
    let Tried { late, data, top } = best;
    search.until = DONE[2];
    let other = search.with_another_curve(&data, &top)?;
    let problem = problem(
        &data,
        &data.stretches,
        &top.at,
        record.step(),
        law.asymmetric,
    );
    let top = problem.climb_on(&top.at, &search.free, LAST_STEPS, LEAST_RISES[1]);
    search.until = 1.0;
    search.asked(&top)?;
    // An error of the force that there is not says nothing of its size.
    let faint = |lane: usize| top.at[lane] <= problem.faintest();
    let known = |lane: &usize| match *lane {
        WHITE => !faint(WHITE),
        DISTURBANCE | MEMORY => !faint(DISTURBANCE),
        _ => true,
    };
    let free: Vec<usize> = search.free.into_iter().filter(known).collect();
    let beside = delay.map_or(0.0, |d: Fine| d.beside.abs() / DELAYS_APART);
    let other = other.filter(|other| other.gain >= -encoder::MAX_EQUAL_LIKELIHOOD);
    let likelier = other
        .as_ref()
        .is_some_and(|other| other.gain > encoder::MAX_EQUAL_LIKELIHOOD);
    let other = other.map(|other| other.at);
    let against = if !top.converged {
        "the search for its maximum did not end"
    } else if Left::of(&top, search.noise).is_beyond(1.0) {
        MORE_ACTS
    } else if fitted.terms.lag.square > 0.0 {
        "the axis is simulated under a force without the lag that this one has"
    } else if fitted.terms.low_pass_undone {
        "the noise of a force whose low-pass was undone is not white"
    } else if beside.is_nan() || beside > encoder::MAX_DELAY_OFFSET {
        "the delay of the force is no half of a sample"
    } else if likelier {
        "with another Stribeck exponent they are likelier"
    } else {
        ""
    };
    let open = DELAY_REACH.min(reach_from(late + HELD_DELAY, stated, record.step()));
    Some(Likely {
        at: top.at,
        sureness: sureness(&top, &free)?,
        free,
        delay: delay.map(|d| {
            [
                late + HELD_DELAY,
                libm::hypot(d.reach + d.beside.abs(), open),
            ]
        }),
        delayed: delay.map_or(0.0, |d| open * d.slope.abs()),
        hopeless: false,
        other,
        exponent: likelier.then_some(EXPONENTIAL),
        against,
    })
}

/// How far a delay, samples, is from the ends of the interval in which a fit of the force has it; without end where that has none.
fn reach_from(delay: f64, stated: Option<&Parameter>, step: f64) -> f64 {
    let interval = stated.and_then(|own| own.ci95);
    interval.map_or(f64::INFINITY, |(low, high)| {
        (delay - low / step).abs().max((high / step - delay).abs())
    })
}

/// What is left on the force, in parts of its noise.
struct Left {
    disturbance: f64,
    density: f64,
}

impl Left {
    fn of(top: &Top, noise: f64) -> Self {
        let disturbance = exp(top.at[DISTURBANCE]) / noise;
        Self {
            disturbance,
            // Of a process of the first order, each side of zero counted.
            density: 2.0 * disturbance * disturbance * exp(top.at[MEMORY]),
        }
    }

    /// Whether it is more than these times what may be left; also where the force has no noise that it could be part of.
    fn is_beyond(&self, times: f64) -> bool {
        let within = self.disturbance <= times * encoder::MAX_DISTURBANCE
            && self.density <= times * encoder::MAX_DISTURBANCE_DENSITY;
        !within
    }
}

/// A climb at a delay.
struct Tried {
    late: f64,
    data: Data,
    top: Top,
}

/// The top with another Stribeck exponent.
struct Other {
    at: [f64; UNKNOWNS],
    /// By how much its log likelihood, on a part of the samples, is higher.
    gain: f64,
}

/// What the likelihood says of the delay beside the best one that was tried, samples.
#[derive(Clone, Copy)]
struct Fine {
    beside: f64,
    /// 95 % reach.
    reach: f64,
    /// By how much the logarithm of the micro-damping, which a delay moves most, changes with a sample of it.
    slope: f64,
}

struct Search<'a, 'o> {
    record: &'a Record,
    fitted: &'a Estimate,
    free: Vec<usize>,
    /// Noise of the force sensor, N (N m), at the delay that leaves the least: at others it hides what the response misses.
    noise: f64,
    /// Part of the whole that is done when what goes on has ended.
    until: f64,
    watch: &'a mut Watch<'o>,
}

impl Search<'_, '_> {
    /// Counts the evaluations of a climb; `None` if the observer stops it.
    fn asked(&mut self, top: &Top) -> Option<()> {
        self.watch.counts.derivatives += top.evaluations as u64;
        self.watch.fraction += STEP_ON * (self.until - self.watch.fraction);
        (self.watch.report(f64::INFINITY) == Control::Continue).then_some(())
    }

    /// Climbs on a part of the samples at a delay, from each start in a few steps and from the best two in more.
    fn climbed(
        &mut self,
        starts: &[[f64; UNKNOWNS]],
        late: f64,
        [first, second]: [usize; 2],
    ) -> Option<Tried> {
        let data = Data::of(self.record, late)?;
        self.noise = self.noise.min(data.noise);
        let parts = parts(&data.stretches, self.record.step());
        let problem = problem(
            &data,
            &parts,
            starts.first()?,
            self.record.step(),
            self.fitted.law.asymmetric,
        );
        let mut tops = Vec::new();
        for start in starts {
            let mut start = *start;
            if first > 0 {
                start[WHITE] = log(START_WHITE * problem.noise);
                start[DISTURBANCE] = log(START_DISTURBANCE * problem.noise);
                start[MEMORY] = log(START_MEMORY);
            }
            let top = problem.climb(&start, &self.free, first, LEAST_RISES[0]);
            self.asked(&top)?;
            tops.push(top);
        }
        let higher = |a: &Top, b: &Top| b.whole.value.total_cmp(&a.whole.value);
        tops.sort_by(higher);
        tops.truncate(2);
        for top in &mut tops {
            *top = problem.climb_on(&top.at, &self.free, second, LEAST_RISES[0]);
            self.asked(top)?;
        }
        tops.sort_by(higher);
        Some(Tried {
            late,
            data,
            top: tops.into_iter().next()?,
        })
    }

    fn many_starts(&mut self, begun: &[f64; UNKNOWNS], late: f64) -> Option<Tried> {
        let sides: &[usize] = if self.fitted.law.asymmetric {
            &[0, EACH_SIDE]
        } else {
            &[0]
        };
        let mut starts = vec![*begun];
        if self.free.contains(&VELOCITY) {
            let top_speed = self.record.top_speed();
            starts.extend(START_VELOCITIES.iter().map(|share| {
                let mut start = *begun;
                for side in sides {
                    start[VELOCITY + side] = log(share * top_speed);
                    start[RATIO + side] = log(START_RATIO);
                }
                start
            }));
        }
        starts.extend(START_BRISTLES.iter().map(|[stiffness, damping]| {
            let mut start = *begun;
            start[STIFFNESS] += log(*stiffness);
            start[DAMPING] += log(*damping);
            start
        }));
        self.climbed(&starts, late, [FIRST_STEPS, SECOND_STEPS])
    }

    /// The top with an exponential Stribeck curve, climbed to on a part of the samples from that with a Gaussian one; nothing for
    /// a law without a curve.
    fn with_another_curve(&mut self, data: &Data, top: &Top) -> Option<Option<Other>> {
        if !self.free.contains(&VELOCITY) {
            return Some(None);
        }
        let step = self.record.step();
        let parts = parts(&data.stretches, step);
        let own = problem(data, &parts, &top.at, step, self.fitted.law.asymmetric);
        let other = Problem {
            exponent: EXPONENTIAL,
            ..own
        };
        let found = other.climb(&top.at, &self.free, CURVE_STEPS, LEAST_RISES[0]);
        self.asked(&found)?;
        Some(Some(Other {
            at: found.at,
            gain: found.whole.value - top.whole.value,
        }))
    }

    /// The delay at which the likelihood is higher than at its neighbours, from the first one that was tried.
    fn best_delay(&mut self, first: Tried) -> Option<(Tried, Option<Fine>)> {
        let mut tried = vec![first];
        for _ in 1..MOST_DELAYS {
            let value = |t: &Tried| t.top.whole.value;
            let best =
                (0..tried.len()).max_by(|&i, &j| value(&tried[i]).total_cmp(&value(&tried[j])))?;
            let own = tried[best].late;
            let at = |late: f64| {
                tried
                    .iter()
                    .position(|t| (t.late - late).abs() < 0.5 * DELAYS_APART)
            };
            let (below, above) = (own - DELAYS_APART, own + DELAYS_APART);
            let next = match [at(below), at(above)] {
                [None, _] => below,
                [_, None] => above,
                [Some(below), Some(above)] => {
                    let [earlier, later] = [below, above].map(|i| tried[i].top.at[DAMPING]);
                    let [below, above] =
                        [below, above].map(|i| value(&tried[best]) - value(&tried[i]));
                    let curvature = (below + above) / (DELAYS_APART * DELAYS_APART);
                    let fine = Fine {
                        beside: 0.5 * DELAYS_APART * (below - above) / (below + above),
                        reach: 1.96 / (curvature * PARTS as f64).sqrt(),
                        slope: (later - earlier) / (2.0 * DELAYS_APART),
                    };
                    return Some((tried.swap_remove(best), Some(fine)));
                }
            };
            let start = tried[best].top.at;
            let more = self.climbed(&[start], next, [0, DELAY_STEPS])?;
            tried.push(more);
        }
        None
    }
}

/// The middle third of each part of the stretches, each with a start of its own.
fn parts(stretches: &[Stretch], step: f64) -> Vec<Stretch> {
    let mut out = Vec::new();
    for stretch in stretches {
        let part = stretch.force.len() / PARTS;
        for i in 0..PARTS {
            let begin = i * part + part / 3;
            let end = begin + part / 3;
            let around = [begin.saturating_sub(5), begin + 5];
            let span = (around[1] - around[0]) as f64 * step;
            out.push(Stretch {
                force: stretch.force[begin..end].to_vec(),
                reading: stretch.reading[begin..end]
                    .iter()
                    .map(|x| x - stretch.reading[begin])
                    .collect(),
                variance: stretch.variance[begin..end].to_vec(),
                velocity: (stretch.reading[around[1]] - stretch.reading[around[0]]) / span,
            });
        }
    }
    out
}

/// Whether a term is one of the law, the inertia or the constant force.
fn is_simulated(column: ColumnKind) -> bool {
    matches!(
        column,
        ColumnKind::Level
            | ColumnKind::Rate
            | ColumnKind::Speed(_)
            | ColumnKind::Acceleration
            | ColumnKind::One
    )
}

/// The unknowns of a law that were fitted, micro-damping that it holds at nothing, because the others depend on it, and those of
/// the errors of the force.
fn free(fitted: &Estimate) -> Vec<usize> {
    let identified = fitted.parameters.iter().filter(|p| p.identified);
    let own = identified.filter_map(|p| lanes(p.name)?.last().copied());
    let held = fitted.law.undamped.then_some(DAMPING);
    own.chain(held)
        .chain([WHITE, DISTURBANCE, MEMORY])
        .collect()
}

/// The unknowns at a fit; `None` where it lacks one that is simulated.
fn start(fitted: &Estimate) -> Option<[f64; UNKNOWNS]> {
    let values = fitted.values();
    let size = |value: f64| {
        if value > 0.0 {
            log(value).max(NOTHING)
        } else {
            NOTHING
        }
    };
    let mut at = [0.0; UNKNOWNS];
    at[STIFFNESS] = size(values.get(Quantity::Sigma0)?);
    at[MASS] = size(values.get(Quantity::Mass)?);
    let least = log(LEAST_DAMPING) + 0.5 * (at[STIFFNESS] + at[MASS]);
    at[DAMPING] = size(values.get(Quantity::Sigma1).unwrap_or(0.0)).max(least);
    at[OFFSET] = values.get(Quantity::Offset).unwrap_or(0.0);
    for (side, shift) in [(Side::Positive, 0), (Side::Negative, EACH_SIDE)] {
        let coulomb = values.on(Quantity::Coulomb, side)?;
        let most = values.on(Quantity::Static, side).unwrap_or(coulomb);
        at[COULOMB + shift] = size(coulomb);
        at[RATIO + shift] = (size(most) - size(coulomb)).max(0.0);
        at[VELOCITY + shift] = size(values.on(Quantity::StribeckVelocity, side).unwrap_or(1.0));
        at[VISCOUS + shift] = size(values.on(Quantity::Sigma2, side)?);
    }
    at.iter().all(|x| x.is_finite()).then_some(at)
}

fn problem<'a>(
    data: &Data,
    stretches: &'a [Stretch],
    at: &[f64; UNKNOWNS],
    step: f64,
    directed: bool,
) -> Problem<'a> {
    let frequency = exp(0.5 * (at[STIFFNESS] - at[MASS]));
    Problem {
        stretches,
        start: Start {
            velocity: data.count / step,
            deflection: 0.5 * exp(at[COULOMB] - at[STIFFNESS]),
        },
        step,
        substeps: (step * frequency / 0.1).ceil().clamp(2.0, 4.0) as u32,
        directed,
        exponent: GAUSSIAN,
        blocks: BLOCKS,
        noise: data.noise.max(LEAST_NOISE * exp(at[COULOMB])),
    }
}
