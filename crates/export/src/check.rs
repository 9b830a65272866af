//! Advice before the code runs.

use crate::number::short;
use crate::{
    Error, Model, Target, backlash, bam, check_identifier, cogging_map, drive_table, hal, joint,
    mujoco, terms, tf5200,
};
use stiction_codes::Code;
use stiction_friction::{Damping, LuGre};

/// Shortest and longest cycle time, s.
pub(crate) const CYCLE_TIMES: (f64, f64) = (1e-6, 0.1);

/// Fast motion where the speed of the log is not known, in Stribeck velocities.
pub(crate) const FAST_STRIBECK_VELOCITIES: f64 = 100.0;
/// Lower end of the speeds at which the law may turn active, relative to the top speed.
const SLOWEST: f64 = 1e-15;
/// Accuracy of that speed, a ratio; messages show four digits.
const SPEED_ACCURACY: f64 = 1.0001;

/// Advice about a model that is exported all the same.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Advice {
    /// Stable code.
    pub code: Code,
    /// What will happen, with figures.
    pub message: String,
}

/// Refuses what a target with the narrowest number type `number_type` cannot express.
pub(crate) fn check(model: &Model, number_type: &'static str) -> Result<(), Error> {
    check_identifier(&model.identifier)?;
    let found = model.settings.cycle_time;
    if !(found >= CYCLE_TIMES.0 && found <= CYCLE_TIMES.1) {
        return Err(Error::CycleTime { found });
    }
    model
        .compensator::<f64>(&model.settings, number_type)
        .map(|_| ())
}

/// Advice on this model in a target at its cycle time.
pub fn advice(model: &Model, target: Target) -> Vec<Advice> {
    let mut found = Vec::new();
    let table = matches!(target, Target::Tf5200 | Target::DriveTable);
    let steady = table || target.is_map() || target.is_joint();
    if !steady && target != Target::Modelica {
        let bristle = model.friction.bristle();
        found.extend(bristle.and_then(|law| released(model, law, target)));
        let length = model.friction.presliding();
        found.extend(length.and_then(|length| unresolved(model, length, target)));
    }
    match target {
        Target::Mujoco => {
            found.extend(mujoco::simplified(model));
            found.extend(shaking(model));
            found.extend(crossing(model));
        }
        // A solver chooses its steps, and the micro-damping is limited.
        Target::Modelica => {}
        Target::DomainJson => {}
        Target::Bam => found.extend(bam::simplified(model)),
        target if target.is_joint() => found.push(joint::simplified(model)),
        Target::DriveTable => found.extend(drive_table::simplified(model)),
        Target::CoggingMap => found.extend(cogging_map::simplified(model)),
        Target::Backlash => found.extend(backlash::uncertain(model)),
        Target::Tf5200 => {
            // The table ends at its last speed.
            if tf5200::largest_force(model) > model.settings.limit {
                found.extend(limited(model, 1.0, &|v| tf5200::mean(model, v)));
            }
            found.extend(rated(model));
        }
        _ if terms::has(&model.terms) => found.extend(limited_sum(model)),
        _ => found.extend(limited(model, model.settings.gain, &|v| model.larger(v))),
    }
    let short = hal::component(model);
    if target == Target::Hal && !short.starts_with(&model.identifier.to_ascii_lowercase()) {
        found.push(Advice {
            code: Code::ExportName,
            message: format!(
                "names in LinuxCNC's HAL have at most 47 characters, pins included: the component is called {short}"
            ),
        });
    }
    found
}

/// The friction, `force` at a speed, is beyond the limit: at the gain `gain`, or at a gain of 1, to which it may be raised.
fn limited(model: &Model, gain: f64, force: &dyn Fn(f64) -> f64) -> Option<Advice> {
    let (limit, rest) = (model.settings.limit, force(0.0));
    let (unit, speed_unit) = (model.force_unit(), model.speed_unit());
    let speed = |v: f64| match v {
        0.0 => "standstill".into(),
        v => format!("{} {speed_unit}", short(v)),
    };
    let head = format!("the force is limited to {} {unit}", short(limit));
    let whole = model
        .saturates_from(force)
        .or((limit < rest).then_some(0.0))?;
    let by_gain = model
        .saturates_from(&|v| gain * force(v))
        .filter(|_| gain < 1.0);
    let share = match gain {
        1.0 => String::new(),
        gain => format!("the share {gain} of "),
    };
    let message = if limit < gain * rest {
        format!(
            "{head}, below {share}the friction at standstill of {} {unit}: the rest stays uncompensated",
            short(rest)
        )
    } else if limit < rest || whole == 0.0 {
        let until = by_gain.map_or(String::new(), |v| format!(" up to {}", speed(v)));
        format!(
            "{head}, not above the friction at standstill of {} {unit}: enough for a gain of {gain}{until}, but with a gain of 1 the rest stays \
             uncompensated; give a higher limit before raising the gain",
            short(rest)
        )
    } else {
        let with_gain = by_gain.map_or(String::new(), |v| {
            format!(" with a gain of 1, at {} with {gain}", speed(v))
        });
        let reached = format!(
            "{head}, which the friction reaches at {}{with_gain}",
            speed(whole)
        );
        match model.top_speed {
            Some(top) if whole > top => return None,
            Some(top) => format!(
                "{reached}, and the log goes to {}: give a higher limit, or stay below that speed",
                speed(top)
            ),
            None => format!("{reached}: if the axis moves faster, give a higher limit"),
        }
    };
    Some(Advice {
        code: Code::ExportLimit,
        message,
    })
}

/// The same of friction that changes with more than velocity, with weight and cogging beside it: the limit is that of the sum.
fn limited_sum(model: &Model) -> Option<Advice> {
    let gain = model.settings.gain;
    let (unit, speed_unit) = (model.force_unit(), model.speed_unit());
    let whole = model.saturates_from(&|v| model.largest(1.0, v))?;
    if model.top_speed.is_some_and(|top| whole > top) {
        return None;
    }
    let reached = |from: f64, gain: f64| match from {
        0.0 => format!(
            "at standstill with a gain of {gain} ({} {unit})",
            short(model.largest(gain, 0.0))
        ),
        v => format!("at {} {speed_unit} with a gain of {gain}", short(v)),
    };
    let by_gain = model.saturates_from(&|v| model.largest(gain, v));
    let by_gain = by_gain.filter(|_| gain < 1.0);
    let by_gain = by_gain.map_or(String::new(), |v| format!(", {}", reached(v, gain)));
    let until = match model.top_speed {
        Some(top) if whole > 0.0 => format!(
            ", and the log goes to {} {speed_unit}: give a higher limit, or stay below that speed",
            short(top)
        ),
        None if whole > 0.0 => ": if the axis moves faster, give a higher limit".into(),
        _ => ": the rest stays uncompensated; give a higher limit".into(),
    };
    let mass = match model.terms.mass > 0.0 {
        true => ". What the mass needs comes on top",
        false => "",
    };
    let what = model.what_is_largest();
    Some(Advice {
        code: Code::ExportLimit,
        message: format!(
            "the force is limited to {} {unit}, which {what}, where most of it adds up, goes beyond {}{by_gain}{until}{mass}",
            short(model.settings.limit),
            reached(whole, 1.0),
        ),
    })
}

/// The friction exceeds the rated force of the motor, within the speeds of the log where they are known.
fn rated(model: &Model) -> Option<Advice> {
    let rated = model.rated_force?;
    let upto = model.top_speed.unwrap_or(f64::MAX);
    let most = tf5200::largest_upto(model, upto).min(model.settings.limit);
    let at = model.top_speed.map_or(String::new(), |top| {
        let top = short(top);
        format!("up to the log's top speed of {top} {} ", model.speed_unit())
    });
    (most > rated).then(|| Advice {
        code: Code::ExportRatedForce,
        message: format!(
            "{at}the table goes to {} {unit}, {:.0} percent of the rated force of {rated} {unit}: check that it is that of the motor, in {unit}",
            short(most),
            100.0 * most / rated,
            unit = model.force_unit(),
        ),
    })
}

/// The law as identified is not passive within the speeds of the log, or where those are not known, within
/// [`FAST_STRIBECK_VELOCITIES`].
fn released(model: &Model, law: &LuGre<f64>, target: Target) -> Option<Advice> {
    let Damping::Constant(sigma1) = law.damping() else {
        return None;
    };
    let cap = |v: f64| law.passive_cap(v).min(law.passive_cap(-v));
    let fast = FAST_STRIBECK_VELOCITIES * law.curve().positive().stribeck_velocity;
    let top = model.top_speed.unwrap_or(fast);
    let least = cap(top);
    if sigma1 <= least {
        return None;
    }
    // The cap falls with speed, and is infinite at rest.
    let (mut low, mut high) = (SLOWEST * top, top);
    while high > SPEED_ACCURACY * low {
        let middle = libm::sqrt(low * high);
        *if cap(middle) < sigma1 {
            &mut high
        } else {
            &mut low
        } = middle;
    }
    let whose = match model.top_speed {
        Some(_) => "the largest speed of the log",
        None => "a hundred Stribeck velocities",
    };
    let at = format!(
        "{} {speed} ({whose})",
        short(top),
        speed = model.speed_unit()
    );
    let unit = format!("{} s/{}", model.force_unit(), model.length_unit());
    let outcome = match target {
        Target::Mujoco => format!(
            "{} {unit} would be at {at}; MuJoCo keeps it constant: if the joint trembles where it should stand still, take a smaller one",
            short(least)
        ),
        _ => format!(
            "the code has at most {} {unit} at {at}: nothing to do",
            short(least)
        ),
    };
    Some(Advice {
        code: Code::ExportDamping,
        message: format!(
            "sigma1 = {} {unit} is passive up to {} {} only; {outcome}",
            short(sigma1),
            short(high),
            model.speed_unit(),
        ),
    })
}

/// The axis moves farther than the presliding length within a cycle.
fn unresolved(model: &Model, length: f64, target: Target) -> Option<Advice> {
    // A law whose level does not fall has no Stribeck velocity.
    let vs = model.stribeck_velocity();
    let path = vs * model.settings.cycle_time;
    let cycle = match target {
        Target::Mujoco => "time step",
        _ => "cycle",
    };
    let below = two_digits(length / vs);
    let remedy = if below > CYCLE_TIMES.0 {
        format!("ask for a {cycle} below {below:.1e} s")
    } else {
        format!(
            "no allowed {cycle} ({:?} s or more) resolves it",
            CYCLE_TIMES.0
        )
    };
    (path > length).then(|| Advice {
        code: Code::ExportCycleTime,
        message: format!(
            "at the Stribeck velocity of {} {} a {cycle} of {} s moves {} {unit}, more than the whole presliding length of {} {unit}: \
             the force stays bounded and follows the steady curve, but a reversal is not resolved; {remedy}",
            short(vs),
            model.speed_unit(),
            model.settings.cycle_time,
            stiction_number::short(path),
            stiction_number::short(length),
            unit = model.length_unit(),
        ),
    })
}

/// A joint in MuJoCo that sticks would not come to rest with the time step that was asked for.
fn shaking(model: &Model) -> Option<Advice> {
    let asked = model.settings.cycle_time;
    let mujoco::Steps {
        longest, written, ..
    } = mujoco::steps(model)?;
    let outcome = if written < asked {
        format!("the file has a timestep of {written} s in place of {asked} s")
    } else {
        format!(
            "no allowed timestep ({:?} s or more) is short enough, the file has {asked} s",
            CYCLE_TIMES.0
        )
    };
    (asked >= longest).then(|| Advice {
        code: Code::ExportCycleTime,
        message: format!(
            "with a timestep of {} s or more a joint that sticks shakes and does not come to rest, since MuJoCo takes the force \
             of the beginning of a step: {outcome}; a longer one needs a larger sigma1 or a smaller sigma0",
            short(longest)
        ),
    })
}

/// A gap in MuJoCo would be crossed within too few of the time steps that were asked for.
fn crossing(model: &Model) -> Option<Advice> {
    let steps = mujoco::steps(model)?;
    let most = steps.of_gap?;
    (most < model.settings.cycle_time.min(steps.longest)).then(|| Advice {
        code: Code::ExportCycleTime,
        message: format!(
            "the gap between motor and load needs a timestep of at most {} s: the file has {} s",
            short(two_digits(most)),
            steps.written
        ),
    })
}

/// Rounded down to two digits.
pub(crate) fn two_digits(x: f64) -> f64 {
    let unit = libm::pow(10.0, libm::floor(libm::log10(x)) - 1.0);
    libm::floor(x / unit * (1.0 + 1e-9)) * unit
}
