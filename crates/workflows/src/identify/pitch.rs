//! The line of the axis file that takes a wave over the position into the fit.

use std::f64::consts::TAU;
use stiction_files::axis::MOST_PITCHES;
use stiction_files::symbols;
use stiction_identify::{FittedLaw, Wave};
use stiction_log::Motion;
use stiction_number::shortest;
use stiction_policy::effect;

/// Deviations of a 95 % interval.
const QUANTILE: f64 = 1.96;
/// Parts of a turn that are looked at.
const MOST_PARTS: f64 = 100_000.0;
/// Difference of two pitches, as a part, up to which they are one.
const SAME: f64 = 1e-9;
/// Digits in which a pitch is written, at least and at most.
const FEWEST_DIGITS: usize = 2;
const MOST_DIGITS: usize = 9;

/// A wave and how surely its pitch is known.
struct Ripple {
    pitch: f64,
    /// Standard deviation of the pitch, m or rad.
    deviation: f64,
    stroke: f64,
}

impl Ripple {
    /// By what part of a wave another pitch is off at one end of the stroke where it is right at the other.
    fn off_by(&self, pitch: f64) -> f64 {
        self.stroke * (1.0 / pitch - 1.0 / self.pitch).abs()
    }
}

/// The line of a key with the waves of the fit and a found one, whose pitch has this relative deviation; `None` where there are as many
/// as it may have.
pub(super) fn line(
    key: &str,
    wave: &Wave,
    deviation: f64,
    law: &FittedLaw,
    motion: Motion,
) -> Option<String> {
    let mut pitches = match key {
        "cogging" => law.terms.cogging.clone(),
        _ => law.terms.level_pitches(),
    };
    let ripple = &Ripple {
        pitch: wave.pitch,
        deviation: deviation.min(1.0) * wave.pitch,
        stroke: wave.stroke,
    };
    match wave.replaces.and_then(|place| pitches.get_mut(place)) {
        Some(own) => *own = instead_of(*own, ripple, motion),
        None => pitches.push(rounded(ripple, motion)),
    }
    of(key, &pitches, motion)
}

/// The same with a wave that is straight over the stroke, with which goes that no constant force is fitted: the wave has it too.
pub(super) fn straight(stroke: f64, law: &FittedLaw, motion: Motion) -> Option<String> {
    let mut pitches = law.terms.cogging.clone();
    // A second one would be the same.
    if pitches
        .iter()
        .any(|pitch| *pitch >= effect::MIN_BENT_PITCH * stroke)
    {
        return None;
    }
    // Nothing follows from how long it is.
    let pitch = effect::SPRING_PITCH * stroke;
    pitches.push(format!("{pitch:.1e}").parse().unwrap_or(pitch));
    // Levels for each direction stand for a constant force, which the law that follows may have again.
    let without = match law.terms.offset || law.law.asymmetric {
        true => "\noffset = false",
        false => "",
    };
    of("cogging", &pitches, motion).map(|line| line + without)
}

/// The line of a key with pitches; `None` where there are more than it may have.
fn of(key: &str, pitches: &[f64], motion: Motion) -> Option<String> {
    let pitches: Vec<_> = pitches
        .iter()
        .map(|pitch| format!("\"{}\"", written(*pitch, motion)))
        .collect();
    (pitches.len() <= MOST_PITCHES).then(|| format!("{key} = [{}]", pitches.join(", ")))
}

/// A pitch that takes the place of another one: rounded, unless that is the one that was off.
fn instead_of(own: f64, ripple: &Ripple, motion: Motion) -> f64 {
    let rounded = rounded(ripple, motion);
    match (rounded / own - 1.0).abs() > SAME {
        true => rounded,
        false => number(ripple),
    }
}

/// The pitch as a machine may have it: on a rotary axis the whole part of a turn that alone lies inside the interval, where one
/// does; else in as few digits as the interval and the stroke let it
/// have.
fn rounded(ripple: &Ripple, motion: Motion) -> f64 {
    let reach = QUANTILE * ripple.deviation;
    let inside = |pitch: f64| (pitch - ripple.pitch).abs() <= reach;
    let parts = libm::round(TAU / ripple.pitch);
    if motion == Motion::Rotary && (1.0..=MOST_PARTS).contains(&parts) {
        let part = TAU / parts;
        let others = [TAU / (parts - 1.0), TAU / (parts + 1.0)];
        if inside(part) && !others.into_iter().any(inside) {
            return part;
        }
    }
    number(ripple)
}

/// The pitch in as few digits as are within its deviation and small against a wave over the stroke.
fn number(ripple: &Ripple) -> f64 {
    let near = |pitch: &f64| {
        (pitch - ripple.pitch).abs() <= ripple.deviation
            && ripple.off_by(*pitch) <= effect::MAX_ROUNDED_PITCH_SHIFT
    };
    let digits = FEWEST_DIGITS..=MOST_DIGITS;
    let written = digits.filter_map(|n| format!("{:.*e}", n - 1, ripple.pitch).parse().ok());
    written.into_iter().find(near).unwrap_or(ripple.pitch)
}

/// A pitch with its unit as it is typed: a whole part of a turn in degrees.
fn written(pitch: f64, motion: Motion) -> String {
    let parts = libm::round(TAU / pitch);
    let is_a_part = (parts * pitch / TAU - 1.0).abs() <= SAME;
    if motion == Motion::Rotary && is_a_part && (1.0..=MOST_PARTS).contains(&parts) {
        let degrees: f64 = format!("{:.11e}", 360.0 / parts)
            .parse()
            .unwrap_or(360.0 / parts);
        return format!("{} deg", shortest(degrees));
    }
    format!("{} {}", shortest(pitch), symbols::length_unit(motion))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ripple(pitch: f64, deviation: f64, stroke: f64) -> Ripple {
        Ripple {
            pitch,
            deviation,
            stroke,
        }
    }

    fn text(pitch: f64, deviation: f64, stroke: f64, motion: Motion) -> String {
        written(rounded(&ripple(pitch, deviation, stroke), motion), motion)
    }

    #[test]
    fn a_pitch_is_a_whole_part_of_a_turn_where_it_may_be_one() {
        assert_eq!(text(0.2612, 0.0008, 0.52, Motion::Rotary), "15 deg");
        assert_eq!(text(0.2628, 0.004, 0.52, Motion::Rotary), "15 deg");
        assert_eq!(
            text(0.8976, 0.001, 3.0, Motion::Rotary),
            "51.4285714286 deg"
        );
        // Outside the interval, or one of several inside it.
        assert_eq!(text(0.2612, 0.008, 0.52, Motion::Rotary), "0.261 rad");
        assert_eq!(text(0.2605, 0.0002, 0.52, Motion::Rotary), "0.2605 rad");
        assert_eq!(text(0.0300, 0.0002, 3.0, Motion::Rotary), "0.03 rad");
        // A length is no part of a turn.
        assert_eq!(text(0.015403, 1e-5, 0.1, Motion::Linear), "0.0154 m");
    }

    #[test]
    fn digits_are_enough_for_the_stroke() {
        // 62 waves: four digits would be off by a sixth of a wave.
        let found = ripple(0.0160123, 1e-4, 1.0);
        assert!(found.off_by(number(&found)) <= effect::MAX_ROUNDED_PITCH_SHIFT);
        assert!(found.off_by(0.01601) > effect::MAX_ROUNDED_PITCH_SHIFT);
    }

    #[test]
    fn what_is_written_reads_back_as_the_pitch() {
        for parts in [1.0, 7.0, 18.0, 24.0, 84.0, 1001.0] {
            let text = written(TAU / parts, Motion::Rotary);
            let degrees: f64 = text.strip_suffix(" deg").unwrap().parse().unwrap();
            assert!(
                (degrees.to_radians() * parts / TAU - 1.0).abs() < 1e-10,
                "{text}"
            );
        }
        assert_eq!(written(0.0154, Motion::Linear), "0.0154 m");
    }

    /// A part of a turn that was tried and is off is not proposed again.
    #[test]
    fn a_pitch_that_is_off_is_not_proposed_again() {
        let found = ripple(0.2612, 0.0008, 0.52);
        let other = instead_of(TAU / 24.0, &found, Motion::Rotary);
        assert!((other - 0.2612).abs() < 3e-4, "{other}");
    }
}
