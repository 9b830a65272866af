//! Where the search starts and how far it may go, from the size of the measured signals.

use crate::estimate::Estimate;
use crate::law::terms::{Delay, Mass, Terms};
use crate::law::{Law, LawKind};
use crate::output_error::Simulation;
use crate::output_error::controller::Controller;
use crate::output_error::elements::{self, Element, Elements};
use crate::output_error::plant::{Axis, Curve, Wave};
use crate::output_error::run::{Hold, Run};
use crate::output_error::simulate::Initial;
use crate::output_error::unknowns::{Layout, Unknown};
use crate::separable::search_box::SearchBox;
use stiction_parameters::{Name, Quantity, Side};

/// Sizes of the signals of the runs, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scale {
    /// Longest way within one run.
    pub stroke: f64,
    /// Fastest mean speed over ten samples.
    pub speed: f64,
    /// Largest force either way.
    pub force: f64,
    /// Shortest sample time, s.
    pub step: f64,
    /// Longest run, s.
    pub length: f64,
    /// One encoder count where known, else a ten thousandth of the stroke.
    pub count: f64,
    /// Delay of the middle of a row's force against its instant, without any of its own, s: half a sample ahead where the
    /// force is held.
    pub centre: f64,
    /// Whether a controller asks for the force, which then cannot act before its row.
    pub is_closed: bool,
}

impl Scale {
    /// `None` where nothing moves, or nothing drives.
    pub fn of(runs: &[Run], simulation: &Simulation) -> Option<Self> {
        let mut out = Self {
            stroke: 0.0,
            speed: 0.0,
            force: 0.0,
            step: f64::INFINITY,
            length: 0.0,
            count: 0.0,
            centre: 0.0,
            is_closed: simulation.controller.is_some(),
        };
        for run in runs {
            let (low, high) = run
                .position
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &x| {
                    (l.min(x), h.max(x))
                });
            out.stroke = out.stroke.max(high - low);
            out.step = out.step.min(run.step);
            out.length = out.length.max(run.step * run.time.len() as f64);
            for (a, b) in run.position.iter().zip(run.position.iter().skip(10)) {
                out.speed = out.speed.max((b - a).abs() / (10.0 * run.step));
            }
            out.force = run.force.iter().fold(out.force, |m, f| m.max(f.abs()));
        }
        out.count = simulation
            .quantum
            .filter(|q| *q > 0.0)
            .unwrap_or(1e-4 * out.stroke)
            .min(0.5 * out.stroke);
        if simulation.hold == Hold::Held {
            out.centre = -0.5 * out.step;
        }
        if out.speed == 0.0 {
            out.speed = out.stroke / out.length;
        }
        let sound = |x: f64| x > 0.0 && x.is_finite();
        (sound(out.stroke) && sound(out.speed) && sound(out.force)).then_some(out)
    }

    /// Delays that are looked for, beyond what the way says in which the force is held, s: as far as in the fit of the force.
    fn delays(&self) -> (f64, f64) {
        let most = MOST_DELAY * self.step;
        (-most, if self.is_closed { 0.0 } else { most })
    }

    /// A delay within that range.
    fn possible(&self, delay: f64) -> f64 {
        let (low, high) = self.delays();
        delay.max(low).min(high)
    }

    /// Whether the force of a controller acts as soon as it can.
    pub fn acts_at_once(&self, delay: f64) -> bool {
        self.is_closed && delay >= -AT_ONCE * self.step
    }
}

/// The axis that an earlier fit found, where it found all that this law needs.
pub(crate) fn from_estimate(
    found: &Estimate,
    law: &Law,
    terms: &Terms,
    layout: &Layout,
    scale: &Scale,
) -> Option<Axis> {
    let known = found.values();
    let value = |quantity, side: usize| {
        let side = [Side::Positive, Side::Negative][side];
        known.on(quantity, side).filter(|x| x.is_finite())
    };
    let mut sides = [Curve {
        coulomb: 0.0,
        fixed: 0.0,
        velocity: scale.speed,
        viscous: 0.0,
    }; 2];
    for (i, side) in sides.iter_mut().enumerate() {
        side.coulomb = value(Quantity::Coulomb, i).filter(|x| *x > 0.0)?;
        side.fixed = side.coulomb;
        if law.kind.has_stribeck() {
            side.fixed = value(Quantity::Static, i)?.max(1.02 * side.coulomb);
            side.velocity = value(Quantity::StribeckVelocity, i).filter(|x| *x > 0.0)?;
        }
        side.viscous = value(Quantity::Sigma2, i).unwrap_or(0.0).max(0.0);
    }
    let elements = match law.kind.has_elements() {
        true => Some(elements_of(found, law, scale)?),
        false => None,
    };
    let mass = match terms.mass {
        Mass::Given(mass) => mass,
        _ => found.value(Quantity::Mass).filter(|m| *m > 0.0)?,
    };
    let mut axis = Axis {
        stiffness: found.value(Quantity::Sigma0).unwrap_or(0.0),
        micro_damping: found.value(Quantity::Sigma1).unwrap_or(0.0),
        sides,
        exponent: law.exponent,
        mass,
        offset: found.value(Quantity::Offset).unwrap_or(0.0),
        delay: match terms.delay {
            Delay::Fitted => found
                .value(Quantity::Delay)
                .map_or(0.0, |delay| scale.possible(delay - scale.centre)),
            Delay::Given(delay) => given_delay(delay, scale),
        },
        waves: waves(layout, |name| found.value(name).unwrap_or(0.0)),
        elements,
    };
    axis.follow_curves();
    complete(&mut axis, law, scale);
    Some(axis)
}

/// The elements that an earlier fit found; they are scaled to its curves later.
fn elements_of(found: &Estimate, law: &Law, scale: &Scale) -> Option<Elements> {
    let positive = |name: Quantity| found.value(name).filter(|x| *x > 0.0 && x.is_finite());
    let all: Option<Vec<Element>> = (1..=law.elements as u32)
        .map(|i| {
            let reach = positive(Quantity::ElementYield(i))?;
            let stiffness = positive(Quantity::ElementStiffness(i))?;
            Some(Element {
                reach,
                force: stiffness * reach,
            })
        })
        .collect();
    Some(Elements {
        all: all?,
        ratio: 1.0,
        attraction: match law.kind.has_stribeck() {
            true => positive(Quantity::Attraction).unwrap_or(attractions(scale).1),
            false => f64::INFINITY,
        },
    })
}

/// Range of the rate at which slipping elements follow the curve, 1/s, as in the fit of the force: from one over the time of a
/// stroke to one over a sample time.
fn attractions(scale: &Scale) -> (f64, f64) {
    let slowest = (scale.stroke / scale.speed).max(100.0 * scale.step);
    (1.0 / slowest, 1.0 / scale.step)
}

/// Yield deflections of the last element over that of the first, for elements that are not known yet.
const WIDTHS: [f64; 2] = [5.0, 50.0];

/// An axis with its sliding friction and elements that load like bristles of one length, m or rad.
fn with_elements_of(axis: &Axis, law: &Law, scale: &Scale, length: f64, wide: f64) -> Axis {
    let mut new = axis.clone();
    new.exponent = law.exponent;
    let (slow, fast) = attractions(scale);
    new.elements = Some(Elements {
        all: elements::spread(law.elements, new.sides[0].fixed, length, wide),
        ratio: 1.0,
        attraction: match law.kind.has_stribeck() {
            true => (slow * fast).sqrt(),
            false => f64::INFINITY,
        },
    });
    new.follow_curves();
    new
}

/// The same axis with every attraction of its elements that the runs can show; as it is where it has none.
pub(crate) fn with_attractions(axis: &Axis, scale: &Scale) -> Vec<Axis> {
    let attracted = axis.elements.as_ref().map(|e| e.attraction.is_finite());
    if attracted != Some(true) {
        return vec![axis.clone()];
    }
    let (slow, fast) = attractions(scale);
    let mut out = Vec::new();
    for part in [0.2, 0.5, 0.8] {
        let mut new = axis.clone();
        if let Some(elements) = &mut new.elements {
            elements.attraction = slow * libm::pow(fast / slow, part);
        }
        out.push(new);
    }
    out
}

/// A given axis with elements in the place of its bristles, that load like them; and on the main loop, where a bristle lets go
/// twice as fast as elements that load like it.
pub(crate) fn with_elements(axis: &Axis, law: &Law, scale: &Scale) -> Vec<Axis> {
    let length = axis.sides[0].coulomb / axis.stiffness;
    let mut out = Vec::new();
    for factor in [0.5, 1.0, 2.0] {
        for wide in WIDTHS {
            out.push(with_elements_of(axis, law, scale, factor * length, wide));
        }
    }
    out
}

/// Longest delay that is looked for, either way, in samples.
const MOST_DELAY: f64 = 4.0;
/// Dead time, in samples, below which a force acts at once.
const AT_ONCE: f64 = 1e-6;

/// A given delay beyond what the way says in which the force is held; none leaves it at that. The force of a controller
/// acts at once at the earliest.
fn given_delay(delay: f64, scale: &Scale) -> f64 {
    match (delay == 0.0, scale.is_closed) {
        (true, _) => 0.0,
        (false, true) => (delay - scale.centre).min(0.0),
        (false, false) => delay - scale.centre,
    }
}

/// Axes that such runs could come from: presliding length, time constant, level and damping over the
/// range that the runs can show.
pub(crate) fn guesses(law: &Law, terms: &Terms, layout: &Layout, scale: &Scale) -> Vec<Axis> {
    let mut out = Vec::new();
    let spread = |low: f64, high: f64, n: usize| -> Vec<f64> {
        let ratio = libm::log((high / low).max(1.0)) / (n - 1) as f64;
        (0..n).map(|i| low * libm::exp(ratio * i as f64)).collect()
    };
    let lengths = if law.kind.has_bristle() {
        spread(scale.count, 3.0 * scale.stroke, 5)
    } else {
        vec![scale.count]
    };
    let zetas: &[f64] = if law.kind == LawKind::LuGre {
        &[0.1, 0.7]
    } else {
        &[0.0]
    };
    for level in [0.3, 0.8, 2.5].map(|x| x * scale.force) {
        for &length in &lengths {
            let stiffness = level / length;
            let masses = match terms.mass {
                Mass::Given(mass) => vec![mass],
                _ => spread(6.0 / scale.length, 0.5 / scale.step, 4)
                    .iter()
                    .map(|w| stiffness / (w * w))
                    .collect(),
            };
            for &mass in &masses {
                for zeta in zetas {
                    let excess = if law.kind.has_stribeck() { 1.3 } else { 1.0 };
                    let side = Curve {
                        coulomb: level,
                        fixed: excess * level,
                        velocity: 0.1 * scale.speed,
                        viscous: 0.1 * scale.force / scale.speed,
                    };
                    let mut axis = Axis {
                        stiffness,
                        micro_damping: 2.0 * zeta * (stiffness * mass).sqrt(),
                        sides: [side; 2],
                        exponent: law.exponent,
                        mass,
                        offset: 0.0,
                        delay: match terms.delay {
                            Delay::Fitted => 0.0,
                            Delay::Given(delay) => given_delay(delay, scale),
                        },
                        waves: waves(layout, |_| 0.0),
                        elements: None,
                    };
                    if law.kind.has_elements() {
                        axis = with_elements_of(&axis, law, scale, length, 10.0);
                    }
                    complete(&mut axis, law, scale);
                    out.push(axis);
                }
            }
        }
    }
    out
}

/// A given axis with correct sliding friction, combined with bristles of every length and damping that the runs can show.
pub(crate) fn with_bristles(axis: &Axis, law: &Law, scale: &Scale) -> Vec<Axis> {
    let level = axis.sides[0].coulomb;
    let mut out = Vec::new();
    let part = libm::pow(3.0 * scale.stroke / scale.count, 1.0 / 8.0);
    let zetas: &[f64] = if law.kind == LawKind::LuGre {
        &[0.1, 0.7]
    } else {
        &[0.0]
    };
    for i in 0..if law.kind.has_bristle() { 8 } else { 1 } {
        for zeta in zetas {
            let mut new = axis.clone();
            new.exponent = law.exponent;
            new.stiffness = level / (scale.count * libm::pow(part, f64::from(i)));
            new.micro_damping = 2.0 * zeta * (new.stiffness * new.mass).sqrt();
            if law.kind.has_elements() {
                let length = level / new.stiffness;
                new = with_elements_of(&new, law, scale, length, 10.0);
            }
            complete(&mut new, law, scale);
            out.push(new);
        }
    }
    out
}

/// A given axis with every damping of its bristles that the runs can show, for a law that has one.
pub(crate) fn with_damping(axis: &Axis, law: &Law, scale: &Scale) -> Vec<Axis> {
    if law.kind != LawKind::LuGre {
        return Vec::new();
    }
    let damped = |zeta: f64| {
        let mut new = axis.clone();
        new.exponent = law.exponent;
        new.micro_damping = 2.0 * zeta * (new.stiffness * new.mass).sqrt();
        complete(&mut new, law, scale);
        new
    };
    [0.1, 0.7].map(damped).to_vec()
}

fn waves(layout: &Layout, factor: impl Fn(Name) -> f64) -> Vec<Wave> {
    layout
        .waves
        .iter()
        .map(|(wave, name)| Wave {
            factor: factor(*name),
            ..*wave
        })
        .collect()
}

/// Bristle parameters for simulating a law without a bristle of its own (or with one that the data left
/// at zero): as stiff as the step can follow or the encoder can resolve, and damped.
fn complete(axis: &mut Axis, law: &Law, scale: &Scale) {
    if axis.elements.is_some() {
        axis.micro_damping = 0.0;
        return;
    }
    let level = axis.sides[0].coulomb.min(axis.sides[1].coulomb);
    let followed = axis.mass / (scale.step * scale.step);
    let stiff = (level / scale.count).min(followed);
    if !law.kind.has_bristle() || axis.stiffness <= 0.0 {
        axis.stiffness = stiff;
    }
    let critical = 2.0 * (axis.stiffness * axis.mass).sqrt();
    axis.micro_damping = match law.kind {
        LawKind::Dahl => 0.0,
        LawKind::LuGre => axis.micro_damping.max(1e-3 * critical),
        _ => 0.7 * critical,
    };
}

/// How far the search may go from where it starts.
pub(crate) fn bounds(layout: &Layout, axis: &Axis, scale: &Scale) -> SearchBox {
    let ln = |x: f64| libm::log(x.max(f64::MIN_POSITIVE));
    let about = layout.read(axis);
    let critical = ln(2.0 * (axis.stiffness * axis.mass).sqrt());
    let mut low = Vec::with_capacity(layout.len());
    let mut high = Vec::with_capacity(layout.len());
    for (unknown, &start) in layout.unknowns.iter().zip(&about) {
        let (a, b) = match unknown {
            Unknown::Stiffness => (
                ln(0.01 * scale.force / scale.stroke),
                ln(100.0 * scale.force / scale.count),
            ),
            Unknown::MicroDamping => (critical - ln(1e4), critical + ln(1e3)),
            Unknown::Viscous(_) => (0.0, 1e3 * scale.force / scale.speed),
            Unknown::Coulomb(_) => (ln(1e-3 * scale.force), ln(100.0 * scale.force)),
            Unknown::Excess(_) => (ln(0.02), ln(3.0)),
            Unknown::Velocity(_) => (ln(1e-4 * scale.speed), ln(scale.speed)),
            // As in the fit of the force: an element that yields after more than half the stroke is not certain to slip.
            Unknown::Reach(_) => (ln(scale.count), ln(0.5 * scale.stroke)),
            Unknown::Yield(_) => (ln(1e-4 * scale.force), ln(100.0 * scale.force)),
            Unknown::Ratio => (ln(0.1), ln(10.0)),
            Unknown::Attraction => {
                let (slow, fast) = attractions(scale);
                (ln(slow), ln(fast))
            }
            Unknown::Mass => (start - ln(1e3), start + ln(1e3)),
            Unknown::Delay => scale.delays(),
            Unknown::Offset | Unknown::Wave(_) => (-10.0 * scale.force, 10.0 * scale.force),
        };
        low.push(a.min(start));
        high.push(b.max(start));
    }
    SearchBox::between(low, high)
}

/// Where each run starts if nothing better is known: at the measured position, the bristle undeflected,
/// the integral such that it gives the first force.
pub(crate) fn rest(runs: &[Run], controller: Option<&Controller>) -> Vec<Initial> {
    let has_integral = controller.is_some_and(Controller::has_integral);
    runs.iter()
        .map(|run| {
            let integral = if has_integral { run.force[0] } else { 0.0 };
            Initial([run.position[0], run.first_velocity(), 0.0, integral])
        })
        .collect()
}
