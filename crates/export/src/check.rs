//! What an engineer should know before the code runs.

use crate::number::short;
use crate::{Error, Model, Target, check_identifier, hal, tf5200};
use stiction_friction::compensator::Friction;
use stiction_friction::{Damping, LuGre};

/// Shortest and longest cycle time, s.
pub(crate) const CYCLE_TIMES: (f64, f64) = (1e-6, 0.1);

/// Something to know, although the model is exported.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Advice {
    /// Stable code.
    pub code: &'static str,
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
                found.extend(limited(model, 1.0));
            }
            found.extend(rated(model));
        }
        _ => found.extend(limited(model, model.settings.gain)),
    }
    let short = hal::component(model);
    if target == Target::Hal && !short.starts_with(&model.identifier.to_ascii_lowercase()) {
        found.push(Advice {
            code: "export-name",
            message: format!(
                "names in LinuxCNC's HAL hold 47 characters with those of the pins: the component is called {short}"
            ),
        });
    }
    found
}

/// The share `gain` of the friction is beyond the limit.
fn limited(model: &Model, gain: f64) -> Option<Advice> {
    let (limit, unit) = (model.settings.limit, model.force_unit());
    let beyond = limit < gain * model.scale();
    let limit = short(limit);
    let message = if beyond {
        format!(
            "the force is limited to {limit} {unit}, below the share {gain} of the static friction of {} {unit}: what is beyond stays uncompensated",
            short(model.scale()),
        )
    } else {
        let from = model.saturates_from(gain)?;
        let (at, speed) = (short(from), model.speed_unit());
        let reached = format!(
            "the force is limited to {limit} {unit}, which the share {gain} of the friction reaches at {at} {speed}"
        );
        match model.top_speed {
            Some(top) if from > top => return None,
            Some(top) => format!(
                "{reached}, and the log goes to {} {speed}: give another --limit, or stay slower",
                short(top)
            ),
            None => format!("{reached}: if the axis moves faster, give another --limit"),
        }
    };
    Some(Advice {
        code: "export-limit",
        message,
    })
}

/// The friction is more than what the motor is rated for.
fn rated(model: &Model) -> Option<Advice> {
    let (rated, most) = (model.rated_force?, tf5200::largest_force(model));
    let most = most.min(model.settings.limit);
    (most > rated).then(|| Advice {
        code: "export-rated-force",
        message: format!(
            "the table goes to {} {unit}, {:.0} percent of the rated force of {rated} {unit}: is that in {unit}, and the motor's?",
            short(most),
            100.0 * most / rated,
            unit = model.force_unit(),
        ),
    })
}

/// The law as identified is not passive.
fn released(model: &Model, law: &LuGre<f64>, target: Target) -> Option<Advice> {
    let Damping::Constant(sigma1) = law.damping() else {
        return None;
    };
    // The cap falls with speed; its least value on a grid of 1 % to 10 000 % of the Stribeck velocity.
    let vs = law.curve().positive().stribeck_velocity;
    let speeds = (0..=80).map(|k| vs * libm::pow(10.0, -2.0 + 0.05 * f64::from(k)));
    let least = speeds
        .flat_map(|v| [law.passive_cap(v), law.passive_cap(-v)])
        .fold(f64::MAX, f64::min);
    let outcome = match target {
        Target::Mujoco => {
            "MuJoCo keeps it constant; if the joint trembles where it should stand, take a smaller one"
        }
        _ => {
            "The exported code limits sigma1 to what is passive at each speed, so its force differs from the identified law's where speed changes suddenly"
        }
    };
    (sigma1 > least).then(|| Advice {
        code: "export-damping",
        message: format!(
            "sigma1 = {} as a constant would release energy: at speed no more than {} {} s/{} is passive. {outcome}",
            short(sigma1),
            short(least),
            model.force_unit(),
            model.length_unit(),
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
    (path > length).then(|| Advice {
        code: "export-cycle-time",
        message: format!(
            "at the Stribeck velocity of {} {} a {cycle} of {} s moves {path:.3e} {unit}, more than the whole presliding length of {length:.3e} {unit}: \
             the force stays bounded and follows the steady curve, but a reversal is not resolved; ask for a {cycle} below {:.1e} s with --cycle-time",
            short(vs),
            model.speed_unit(),
            model.settings.cycle_time,
            length / vs,
            unit = model.length_unit(),
        ),
    })
}
