//! What an engineer should know before the code runs.

use crate::number::short;
use crate::{Error, Model, Target, check_identifier, hal, tf5200};
use stiction_codes::Code;
use stiction_friction::compensator::Friction;
use stiction_friction::{Damping, LuGre};

/// Shortest and longest cycle time, s.
pub(crate) const CYCLE_TIMES: (f64, f64) = (1e-6, 0.1);

/// Something to know, although the model is exported.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Advice {
    /// Stable code.
    pub code: Code,
    /// What would happen, with figures.
    pub message: String,
}

/// Refuses what a target cannot express whose narrowest number type is `number_type`.
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

/// What would happen with this model in a target at this cycle time; numbers as an engineer reads them.
pub fn advice(model: &Model, target: Target) -> Vec<Advice> {
    let mut found = Vec::new();
    if let (Friction::LuGre(law), true) = (&model.friction, target != Target::Tf5200) {
        found.extend(released(model, law, target));
        found.extend(unresolved(model, law, target));
    }
    match target {
        Target::Mujoco => {}
        Target::Tf5200 => {
            // Beyond its last speed the table has nothing to say.
            if tf5200::largest_force(model) > model.settings.limit {
                found.extend(limited(model, 1.0, &|v| tf5200::mean(model, v)));
            }
            found.extend(rated(model));
        }
        _ => found.extend(limited(model, model.settings.gain, &|v| model.larger(v))),
    }
    let short = hal::component(model);
    if target == Target::Hal && !short.starts_with(&model.identifier.to_ascii_lowercase()) {
        found.push(Advice {
            code: Code::ExportName,
            message: format!(
                "names in LinuxCNC's HAL hold 47 characters with those of the pins: the component is called {short}"
            ),
        });
    }
    found
}

/// The friction, `force` at a speed, is beyond the limit: its share `gain`, or the whole of it, to which the gain may be
/// raised.
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
            "{head}, below {share}the friction at standstill of {} {unit}: what is beyond stays uncompensated",
            short(rest)
        )
    } else if limit < rest || whole == 0.0 {
        let until = by_gain.map_or(String::new(), |v| format!(" up to {}", speed(v)));
        format!(
            "{head}, no more than the friction at standstill of {} {unit}: enough for a gain of {gain}{until}, but with a gain of 1 what is beyond stays \
             uncompensated; give another --limit before the gain is raised",
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
                "{reached}, and the log goes to {}: give another --limit, or stay slower",
                speed(top)
            ),
            None => format!("{reached}: if the axis moves faster, give another --limit"),
        }
    };
    Some(Advice {
        code: Code::ExportLimit,
        message,
    })
}

/// The friction is more than what the motor is rated for, at the speeds of the log where they are known.
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
            "{at}the table goes to {} {unit}, {:.0} percent of the rated force of {rated} {unit}: see that this is in {unit}, and the motor's",
            short(most),
            100.0 * most / rated,
            unit = model.force_unit(),
        ),
    })
}

/// The law as identified is not passive at the speeds of the log, or where those are not known, below a hundred Stribeck
/// velocities.
fn released(model: &Model, law: &LuGre<f64>, target: Target) -> Option<Advice> {
    let Damping::Constant(sigma1) = law.damping() else {
        return None;
    };
    let cap = |v: f64| law.passive_cap(v).min(law.passive_cap(-v));
    let fast = 100.0 * law.curve().positive().stribeck_velocity;
    let top = model.top_speed.unwrap_or(fast);
    let least = cap(top);
    if sigma1 <= least {
        return None;
    }
    // The cap falls with speed, and is beyond all numbers at rest.
    let (mut low, mut high) = (1e-15 * top, top);
    while high > 1.0001 * low {
        let middle = libm::sqrt(low * high);
        *if cap(middle) < sigma1 {
            &mut high
        } else {
            &mut low
        } = middle;
    }
    let outcome = match target {
        Target::Mujoco => {
            "MuJoCo keeps it constant; if the joint trembles where it should stand, take a smaller one"
        }
        _ => {
            "The exported code limits sigma1 to what is passive at each speed, so its force differs from the identified law's where speed changes suddenly"
        }
    };
    let whose = match model.top_speed {
        Some(_) => "the largest of the log",
        None => "a hundred Stribeck velocities",
    };
    Some(Advice {
        code: Code::ExportDamping,
        message: format!(
            "sigma1 = {} {unit} as a constant would release energy: from {} {speed} on only less is passive, at {} {speed} ({whose}) no more than {} {unit}. {outcome}",
            short(sigma1),
            short(high),
            short(top),
            short(least),
            unit = format_args!("{} s/{}", model.force_unit(), model.length_unit()),
            speed = model.speed_unit(),
        ),
    })
}

/// The bristles are crossed within a cycle.
fn unresolved(model: &Model, law: &LuGre<f64>, target: Target) -> Option<Advice> {
    // A law whose level does not fall has no speed of its own.
    let (vs, length) = (model.stribeck_velocity(), law.bound());
    let path = vs * model.settings.cycle_time;
    let cycle = match target {
        Target::Mujoco => "time step",
        _ => "cycle",
    };
    let below = two_digits(length / vs);
    let remedy = if below > CYCLE_TIMES.0 {
        format!("ask for a {cycle} below {below:.1e} s with --cycle-time")
    } else {
        format!(
            "no {cycle} that is allowed, {:?} s or more, resolves it",
            CYCLE_TIMES.0
        )
    };
    (path > length).then(|| Advice {
        code: Code::ExportCycleTime,
        message: format!(
            "at the Stribeck velocity of {} {} a {cycle} of {} s moves {path:.3e} {unit}, more than the whole presliding length of {length:.3e} {unit}: \
             the force stays bounded and follows the steady curve, but a reversal is not resolved; {remedy}",
            short(vs),
            model.speed_unit(),
            model.settings.cycle_time,
            unit = model.length_unit(),
        ),
    })
}

/// Cut to two digits: never more than the number, but for rounding.
fn two_digits(x: f64) -> f64 {
    let unit = libm::pow(10.0, libm::floor(libm::log10(x)) - 1.0);
    libm::floor(x / unit * (1.0 + 1e-9)) * unit
}
