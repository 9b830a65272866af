//! What an engineer should know before the code runs.

use crate::{Error, Model, check_identifier};
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

/// Refuses what no target can express. Number ranges are checked with the number type of the target.
pub(crate) fn check(model: &Model) -> Result<(), Error> {
    check_identifier(&model.identifier)?;
    let found = model.settings.cycle_time;
    if !(found >= CYCLE_TIMES.0 && found <= CYCLE_TIMES.1) {
        return Err(Error::CycleTime { found });
    }
    model
        .compensator::<f64>(&model.settings, "double")
        .map(|_| ())
}

/// What would happen with this model at this cycle time.
pub fn advice(model: &Model) -> Vec<Advice> {
    let mut found = Vec::new();
    if let Friction::LuGre(law) = &model.friction {
        found.extend(released(model, law));
        found.extend(unresolved(model, law));
    }
    let settings = &model.settings;
    if settings.limit < settings.gain * model.scale() {
        found.push(Advice {
            code: "export-limit",
            message: format!(
                "the force is limited to {} {}, below the share {} of the static friction of {} {}: what is beyond stays uncompensated",
                settings.limit,
                model.force_unit(),
                settings.gain,
                model.scale(),
                model.force_unit(),
            ),
        });
    }
    found
}

/// The law as identified is not passive.
fn released(model: &Model, law: &LuGre<f64>) -> Option<Advice> {
    let Damping::Constant(sigma1) = law.damping() else {
        return None;
    };
    // The cap falls with speed; its least value on a grid of 1 % to 10 000 % of the Stribeck velocity.
    let vs = law.curve().positive().stribeck_velocity;
    let speeds = (0..=80).map(|k| vs * libm::pow(10.0, -2.0 + 0.05 * f64::from(k)));
    let least = speeds
        .flat_map(|v| [law.passive_cap(v), law.passive_cap(-v)])
        .fold(f64::MAX, f64::min);
    (sigma1 > least).then(|| Advice {
        code: "export-damping",
        message: format!(
            "sigma1 = {sigma1} as a constant would release energy: at speed no more than {least:.3} {} s/{} is passive. \
             The exported code limits sigma1 to what is passive at each speed, so its force differs from the identified law's where speed changes suddenly",
            model.force_unit(),
            model.length_unit(),
        ),
    })
}

/// The bristles are crossed within a cycle.
fn unresolved(model: &Model, law: &LuGre<f64>) -> Option<Advice> {
    let (vs, length) = (law.curve().positive().stribeck_velocity, law.bound());
    let path = vs * model.settings.cycle_time;
    (path > length).then(|| Advice {
        code: "export-cycle-time",
        message: format!(
            "at the Stribeck velocity of {vs} {} a cycle of {} s moves {path:.3e} {unit}, more than the whole presliding length of {length:.3e} {unit}: \
             the force stays bounded and follows the steady curve, but a reversal is not resolved; ask for a cycle time below {:.1e} s",
            model.speed_unit(),
            model.settings.cycle_time,
            length / vs,
            unit = model.length_unit(),
        ),
    })
}
