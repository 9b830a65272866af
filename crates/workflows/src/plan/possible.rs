//! Limits from which no plan can follow: found before anything is simulated, or from what the pieces did.

use super::assume::Given;
use crate::error::Error;
use stiction_codes::Code;
use stiction_files::Axis;
use stiction_log::Motion;
use stiction_number::{full, short};
use stiction_plan::{Entry, Nameplate, Peaks, Rig};
use stiction_policy::plan;

/// Most samples of a motion at the rate of the log: set points are written at it.
const MOST_SAMPLES: f64 = 2.5e6;
/// Rate at which a faster log is simulated, Hz: its samples are taken together, and their noise is that of their mean.
const SIMULATED_RATE: f64 = 20e3;

/// An error at a key of the axis file, or about what is assumed where the file does not give it.
fn at(axis: &Axis, key: &str, found: String, allowed: String) -> Error {
    match axis.refuse(key, found.clone(), allowed.clone(), Code::BadConfig) {
        Some(error) => error.into(),
        None => Error::usage(format!("{key}: {found}"), allowed),
    }
}

/// Refuses a log of more samples than a plan can write.
pub(super) fn samples(axis: &Axis, rate: f64, longest: f64) -> Result<(), Error> {
    if rate * longest <= MOST_SAMPLES {
        return Ok(());
    }
    let found = format!(
        "{} Hz, in --time {} s {} samples",
        full(rate),
        full(longest),
        short(rate * longest)
    );
    let allowed = format!(
        "at most {MOST_SAMPLES} samples of the motion: a rate of at most {} Hz, or a shorter --time",
        (MOST_SAMPLES / longest) as u64
    );
    Err(at(axis, "rate", found, allowed))
}

/// The rig with a log as slow as simulations need it: the mean of some samples tells as much as they do.
pub(super) fn thinned(rig: Rig) -> Rig {
    let every = (rig.rate / SIMULATED_RATE).floor().max(1.0);
    let slower = Rig {
        rate: rig.rate / every,
        force_noise: rig.force_noise / every.sqrt(),
        ..rig
    };
    match slower.validate() {
        Ok(()) => slower,
        // A loop that needs the fast log keeps it.
        Err(_) => rig,
    }
}

/// Refuses limits that are not those of one machine: with each of them alone the axis moves over some encoder steps in
/// the time, and the force and the stroke allow what the acceleration and the speed say, within some powers of ten.
pub(super) fn reachable(
    axis: &Axis,
    plate: &Nameplate,
    motion: Motion,
    longest: f64,
) -> Result<(), Error> {
    let (limits, rig) = (&plate.limits, &plate.rig);
    let (length, speed_unit) = (motion.position().si_text(), motion.velocity().si_text());
    let stroke = limits.stroke[1] - limits.stroke[0];
    let seen = plan::MIN_STROKE_STEPS * rig.encoder_step;
    if stroke < seen {
        let found = format!("{} {length} in all", short(stroke));
        let allowed = format!(
            "at least {} {length}, two encoder steps of {} {length}",
            short(seen),
            short(rig.encoder_step)
        );
        return Err(at(axis, "limits.stroke", found, allowed));
    }
    // One way takes half of the time: speeding up for half of that, and the acceleration for half of that again.
    let way = 0.5 * longest;
    let pushed = limits.peak_force / plate.mass;
    let far = |key: &str, value: f64, unit: String, distance: f64| {
        if distance >= seen {
            return Ok(());
        }
        let found = format!(
            "{} {unit} moves the axis over {} {length} in {} s",
            short(value),
            short(distance),
            short(way)
        );
        let allowed = format!(
            "at least {} {unit}, for two encoder steps of {} {length}",
            short(value * seen / distance),
            short(rig.encoder_step)
        );
        Err(at(axis, key, found, allowed))
    };
    let ramp = 0.25 * way * way;
    let per_time = |powers: u32| format!("{length}/s^{powers}");
    far(
        "limits.speed",
        limits.speed,
        speed_unit.clone(),
        limits.speed * way,
    )?;
    far(
        "limits.acceleration",
        limits.acceleration,
        per_time(2),
        limits.acceleration * ramp,
    )?;
    far(
        "limits.jerk",
        limits.jerk,
        per_time(3),
        limits.jerk * ramp * way / 8.0,
    )?;
    // The drive has only its rated force where no peak is given.
    let force = match axis.gives("limits.peak_force") {
        true => "limits.peak_force",
        false => "limits.rated_force",
    };
    let newton = motion.force().si_text();
    let mass = match motion {
        Motion::Linear => "kg",
        Motion::Rotary => "kg m^2",
    };
    if pushed < plan::MIN_ACCELERATION * limits.acceleration {
        let found = format!(
            "{} {newton}, which moves {} {mass} with {} {}",
            short(limits.peak_force),
            short(plate.mass),
            short(pushed),
            per_time(2)
        );
        let allowed = format!(
            "at least {} {newton}, a hundredth of what limits.acceleration = {} {} needs",
            short(plan::MIN_ACCELERATION * limits.acceleration * plate.mass),
            short(limits.acceleration),
            per_time(2)
        );
        return Err(at(axis, force, found, allowed));
    }
    if rig.force_noise >= limits.peak_force {
        let found = format!("{} {newton}", short(rig.force_noise));
        let allowed = format!(
            "below the largest force, {} {newton}",
            short(limits.peak_force)
        );
        return Err(at(axis, "limits.force_noise", found, allowed));
    }
    let fastest = (limits.acceleration * stroke)
        .sqrt()
        .min(0.5 * limits.acceleration * way);
    if limits.speed * plan::MIN_STRIBECK > fastest {
        let found = format!("{} {speed_unit}", short(limits.speed));
        let allowed = format!(
            "at most {} {speed_unit}: acceleration and stroke allow {} {speed_unit}",
            short(fastest / plan::MIN_STRIBECK),
            short(fastest)
        );
        return Err(at(axis, "limits.speed", found, allowed));
    }
    Ok(())
}

/// No piece of a motion within the limits is one that the loop follows and the encoder sees.
pub(super) fn no_piece(axis: &Axis) -> Error {
    let found = "no piece of a motion within them goes over two encoder steps".into();
    let allowed = "a larger stroke, speed, acceleration or jerk, or a finer log.resolution".into();
    at(axis, "limits", found, allowed)
}

/// No piece that was chosen: none tells anything of the friction.
pub(super) fn tells_nothing(axis: &Axis, longest: f64) -> Error {
    let found = format!(
        "no piece of a motion within them and --time {} s tells anything of the friction",
        full(longest)
    );
    let allowed = "limits of one machine: look at the units of speed, acceleration, rated_force and mass, \
                   and at log.resolution and limits.force_noise";
    at(axis, "limits", found, allowed.into())
}

/// Every motion goes beyond a limit on some axis: the limit that the middle one of them breaks, with what it would need.
pub(super) fn beyond(axis: &Axis, given: &Given, all: &[Peaks]) -> Error {
    let limits = &given.nameplate.limits;
    let [low, high] = limits.stroke;
    let stroke = high - low;
    let past = |peaks: &Peaks| {
        let below = (low - peaks.position[0]).max(0.0);
        let above = (peaks.position[1] - high).max(0.0);
        (below, above, (peaks.speed - limits.speed).max(0.0))
    };
    let out = |(below, above, _): &(f64, f64, f64)| below.max(*above) / stroke;
    let weight = |parts: &(f64, f64, f64)| out(parts).max(parts.2 / limits.speed);
    let mut parts: Vec<_> = all.iter().map(past).collect();
    parts.sort_by(|a, b| weight(a).total_cmp(&weight(b)));
    // The slowest hardly move: what half of them need makes a plan.
    let Some(&middle) = parts.get(parts.len() / 2) else {
        return no_piece(axis);
    };
    if weight(&middle) == 0.0 {
        return too_long(axis, given, all);
    }
    let (below, above, fast) = middle;
    let motion = given.motion;
    let (length, speed) = (motion.position().si_text(), motion.velocity().si_text());
    let why = format!("on an axis that {} allows", given.known_by());
    if out(&middle) >= fast / limits.speed {
        let found = format!(
            "{} to {} {length}: every motion goes beyond it {why}, half of them by {} {length} and more",
            short(low),
            short(high),
            short(below.max(above))
        );
        let allowed = format!(
            "more room, such as from {} to {} {length}; an axis at the end of its stroke is brought away from it first",
            short(low - 2.0 * below),
            short(high + 2.0 * above)
        );
        return at(axis, "limits.stroke", found, allowed);
    }
    let found = format!(
        "{} {speed}: every motion is faster {why}, half of them by {} {speed} and more",
        short(limits.speed),
        short(fast)
    );
    let allowed = format!(
        "at least {} {speed}, or a controller.bandwidth that the axis really has",
        short(limits.speed + 2.0 * fast)
    );
    at(axis, "limits.speed", found, allowed)
}

/// Half of the motions stay within stroke and speed: what they break is the force that the drive can give for long.
fn too_long(axis: &Axis, given: &Given, all: &[Peaks]) -> Error {
    let rated = given.nameplate.limits.rated_force;
    let mut forces: Vec<f64> = all.iter().map(Peaks::rms_force).collect();
    forces.sort_by(f64::total_cmp);
    let middle = forces.get(forces.len() / 2).copied().unwrap_or(rated);
    let newton = given.motion.force().si_text();
    let found = format!(
        "{} {newton}: every motion that stays within stroke and speed takes more of the drive for long on an axis that {} allows, half of \
         them {} {newton} and more as root mean square",
        short(rated),
        given.known_by(),
        short(middle)
    );
    let allowed = "a smaller acceleration, which takes less force, or the rated force that the drive really has";
    at(axis, "limits.rated_force", found, allowed.into())
}

/// The peaks of each piece on all the axes.
pub(super) fn peaks(entries: &[Vec<Entry>]) -> Vec<Peaks> {
    let piece = |axes: &Vec<Entry>| axes.iter().map(|e| e.peaks).reduce(Peaks::with);
    entries.iter().filter_map(piece).collect()
}

#[cfg(test)]
mod tests {
    use super::thinned;
    use stiction_plan::{Loop, Rig};

    #[test]
    fn a_fast_log_is_simulated_slower_with_the_noise_of_the_mean() {
        let rig = |rate: f64, bandwidth: f64| Rig {
            rate,
            encoder_step: 1e-6,
            force_noise: 1.0,
            loop_: Loop::Tuned(bandwidth),
        };
        assert_eq!(thinned(rig(4e3, 60.0)), rig(4e3, 60.0));
        assert_eq!(thinned(rig(39e3, 60.0)), rig(39e3, 60.0));
        let slow = thinned(rig(1e6, 60.0));
        assert_eq!(slow.rate, 20e3);
        assert!((slow.force_noise - 50_f64.sqrt().recip()).abs() < 1e-15);
        // The loop is simulated at its own rate.
        assert!(slow.rate * slow.periods() as f64 >= 20.0 * 60.0);
        assert_eq!(thinned(rig(1e6, 1e5)), rig(1e6, 1e5));
    }
}
