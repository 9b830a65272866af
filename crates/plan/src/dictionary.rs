//! The pieces to choose from.

use crate::atom::Atom;
use crate::limits::Limits;
use crate::rig::Rig;
use stiction_policy::plan;

/// Frequencies of the sines, Hz, as far as the loop follows them, and their durations, s.
const SINES: [(f64, f64); 6] = [
    (0.5, 2.0),
    (1.0, 1.0),
    (2.0, 1.0),
    (5.0, 0.6),
    (10.0, 0.5),
    (28.0, 0.5),
];
/// Speeds of the sines and moves: the largest and each of the following by this factor slower, down to 1e-4 of it.
const SPEEDS: i32 = 11;
const SPEED_RATIO: f64 = 2.511_886_431_509_58;
/// Speeds and durations (s) of moves there and back.
const MOVES: i32 = 13;
const MOVE_RATIO: f64 = 2.154_434_690_031_884;
const MOVE_TIMES: [f64; 2] = [1.0, 2.0];
/// Parts of the largest acceleration and speed of full strokes: the drive may lack the force for all of it.
const STROKES: [(f64, f64); 6] = [
    (0.3, 0.5),
    (0.3, 1.0),
    (0.6, 0.5),
    (0.6, 1.0),
    (0.9, 0.5),
    (0.9, 1.0),
];
/// Frequencies and speeds, as parts of the largest, of sines that grow.
const GROWING: [(f64, f64); 8] = [
    (1.0, 1.0),
    (1.0, 0.1),
    (1.0, 0.01),
    (5.0, 0.3),
    (5.0, 0.03),
    (5.0, 3e-3),
    (10.0, 0.1),
    (10.0, 0.01),
];
/// Part of the limits that is used: what is left is for the rounding of whoever samples the motion.
pub(crate) const MARGIN: f64 = 1.0 - 1e-6;
/// Highest frequency over the bandwidth of the loop, and over the rate of the log.
const OF_BANDWIDTH: f64 = 0.75;
const OF_RATE: f64 = 1.0 / 40.0;
/// Part of the duration in which a sine grows.
const GROWTH: f64 = 0.8;

/// Part of the largest speed that the fast pieces have: the speed of a real axis overshoots that of its reference.
pub(crate) const FAST: f64 = 0.95;

/// All pieces within the limits that the loop can follow and the encoder can see.
pub fn dictionary(limits: &Limits, rig: &Rig) -> Vec<Atom> {
    let limits = &Limits {
        speed: FAST * limits.speed,
        ..*limits
    };
    let highest = (OF_BANDWIDTH * rig.bandwidth()).min(OF_RATE * rig.rate);
    let mut all = Vec::new();
    let mut add = |atom: Atom| {
        let by = fits(&atom, limits);
        let atom = atom.scaled(by);
        let size = atom.extremes().position;
        let seen = (size[1] - size[0]) >= plan::MIN_AMPLITUDE_STEPS * rig.encoder_step;
        if by >= plan::MIN_SPEED_PART && seen && atom.validate().is_ok() {
            all.push(atom);
        }
    };
    for (frequency, duration) in SINES.into_iter().filter(|(f, _)| *f <= highest) {
        for k in 0..SPEEDS {
            let speed = limits.speed / power(SPEED_RATIO, k);
            add(sine(speed, frequency, duration));
        }
        // The largest that the limits allow, whatever its speed.
        let largest = sine(limits.speed, frequency, duration);
        if fits(&largest, limits) < plan::MIN_SPEED_PART {
            let largest = largest.scaled(fits(&largest, limits));
            add(largest);
        }
    }
    for (frequency, part) in GROWING.into_iter().filter(|(f, _)| *f <= highest) {
        let duration = (4.0 / frequency).max(1.0);
        let Atom::Sine { amplitude, .. } = sine(part * limits.speed, frequency, duration) else {
            continue;
        };
        let growing = Atom::Sine {
            amplitude,
            frequency,
            duration,
            fade_in: GROWTH * duration,
            fade_out: (1.0 - GROWTH) * duration,
        };
        add(growing);
    }
    for time in MOVE_TIMES {
        for k in 0..MOVES {
            let speed = limits.speed / power(MOVE_RATIO, k);
            if let Some(atom) = there_and_back(limits, (speed, limits.acceleration), 0.5 * time) {
                add(atom);
            }
        }
    }
    for (acceleration, speed) in STROKES {
        let part = limits.part(speed, acceleration);
        let atom = Atom::Move {
            distance: farther(limits),
            speed: part.velocity,
            acceleration: part.acceleration,
            jerk: part.jerk,
        };
        add(atom);
    }
    all
}

/// Moves there and back to several places of the stroke, as parts of the way to its ends, with the largest speeds that they have
/// there, as parts of the limit: for terms that depend on the position.
const PLACES: [f64; 3] = [1.0, 0.6, 0.3];
const PLACE_SPEEDS: [f64; 5] = [1.0, 0.4, 0.16, 0.06, 0.025];
/// Parts of the largest speed and acceleration with which slow moves reach their speed: they are for what they see on the way.
const PLACE_ACCELERATION: f64 = 0.6;
/// Longest of them, s.
const LONGEST_PLACE: f64 = 12.0;

/// Moves to several places within the limits, both ways from where the axis stands.
pub fn places(limits: &Limits, rig: &Rig) -> Vec<Atom> {
    let limits = &Limits {
        speed: FAST * limits.speed,
        ..*limits
    };
    let mut all: Vec<Atom> = Vec::new();
    for end in limits.reach() {
        for (part, speed) in PLACES
            .into_iter()
            .flat_map(|part| PLACE_SPEEDS.map(|speed| (part, speed)))
        {
            let most = limits.part(speed, PLACE_ACCELERATION);
            let atom = Atom::Move {
                distance: MARGIN * part * end,
                speed: most.velocity,
                acceleration: most.acceleration,
                jerk: most.jerk,
            };
            let seen = (part * end).abs() >= plan::MIN_AMPLITUDE_STEPS * rig.encoder_step;
            if !seen || atom.validate().is_err() || atom.duration() > LONGEST_PLACE {
                continue;
            }
            let atom = atom.scaled(fits(&atom, limits));
            // A way too short for a higher speed is the same move.
            if !all.iter().any(|other| {
                (other.duration() - atom.duration()).abs() < 1e-9
                    && other.extremes() == atom.extremes()
            }) {
                all.push(atom);
            }
        }
    }
    all
}

/// Frequencies of nested reversals, Hz, as far as the loop follows them, and their durations, s: some reversals of each.
const NESTED: [(f64, f64); 3] = [(1.0, 3.0), (3.0, 1.5), (10.0, 0.8)];
/// Depths of nested reversals: from this part of the shortest to this multiple of the longest yield deflection, and between
/// neighbours. An element has turned over after twice its yield deflection, an amplitude of one; deeper ones are for what friction holds
/// back of the motion.
const SHALLOWEST: f64 = 0.7;
const DEEPEST: f64 = 4.0;
const DEPTH_RATIO: f64 = 2.0;
/// Over more the deflections of no axis spread.
const MOST_DEPTHS: usize = 20;

/// Nested reversals for Maxwell-slip elements that yield at deflections between these two, m (rad): sines that grow from rest to a depth, and
/// such that shrink from it, at depths that reach across the deflections.
pub fn nested(limits: &Limits, rig: &Rig, [shortest, longest]: [f64; 2]) -> Vec<Atom> {
    let limits = &Limits {
        speed: FAST * limits.speed,
        ..*limits
    };
    let highest = (OF_BANDWIDTH * rig.bandwidth()).min(OF_RATE * rig.rate);
    let mut depths = vec![DEEPEST * longest];
    while depths[depths.len() - 1] > SHALLOWEST * shortest && depths.len() < MOST_DEPTHS {
        depths.push(depths[depths.len() - 1] / DEPTH_RATIO);
    }
    let mut all = Vec::new();
    for (frequency, duration) in NESTED.into_iter().filter(|(f, _)| *f <= highest) {
        for &amplitude in &depths {
            for grows in [true, false] {
                let (long, short) = (GROWTH * duration, (1.0 - GROWTH) * duration);
                let (fade_in, fade_out) = if grows { (long, short) } else { (short, long) };
                let atom = Atom::Sine {
                    amplitude,
                    frequency,
                    duration,
                    fade_in,
                    fade_out,
                };
                let by = fits(&atom, limits);
                let atom = atom.scaled(by);
                let size = atom.extremes().position;
                let seen = size[1] - size[0] >= plan::MIN_AMPLITUDE_STEPS * rig.encoder_step;
                if by >= plan::MIN_SPEED_PART && seen && atom.validate().is_ok() {
                    all.push(atom);
                }
            }
        }
    }
    all
}

/// A sine of this speed amplitude with fades of half a period.
pub(crate) fn sine(speed: f64, frequency: f64, duration: f64) -> Atom {
    let fade = (0.5 / frequency).min(0.5 * duration);
    Atom::Sine {
        amplitude: speed / (std::f64::consts::TAU * frequency),
        frequency,
        duration,
        fade_in: fade,
        fade_out: fade,
    }
}

/// There and back at a speed and acceleration, each way in `time` s or as far as the stroke allows; `None` where the ramps alone
/// take longer.
pub(crate) fn there_and_back(
    limits: &Limits,
    (speed, acceleration): (f64, f64),
    time: f64,
) -> Option<Atom> {
    let ramp = speed / acceleration + acceleration / limits.jerk;
    let ramp = ramp.max(2.0 * libm::sqrt(speed / limits.jerk));
    if ramp >= time {
        return None;
    }
    let far = farther(limits);
    let distance = (speed * (time - ramp)).min(far.abs()) * far.signum();
    Some(Atom::Move {
        distance,
        speed,
        acceleration,
        jerk: limits.jerk,
    })
}

/// The way to the farther end of the stroke, m (rad).
fn farther(limits: &Limits) -> f64 {
    let [low, high] = limits.reach();
    let far = if high >= -low { high } else { low };
    MARGIN * far
}

/// By what a piece has to be made smaller to be within the limits: at most 1.
pub(crate) fn fits(atom: &Atom, limits: &Limits) -> f64 {
    let found = atom.extremes();
    let [low, high] = limits.reach();
    let part = |found: f64, limit: f64| {
        if found > 0.0 {
            MARGIN * limit / found
        } else {
            1.0
        }
    };
    let most = part(found.position[1], high)
        .min(part(-found.position[0], -low))
        .min(part(found.speed, limits.speed))
        .min(part(found.acceleration, limits.acceleration))
        .min(part(found.jerk, limits.jerk));
    most.clamp(0.0, 1.0)
}

fn power(x: f64, n: i32) -> f64 {
    (0..n).fold(1.0, |product, _| product * x)
}
