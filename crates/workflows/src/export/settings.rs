//! Settings of the compensator: what follows from the law, and what was asked for in its place.

use super::ExportOptions;
use stiction_files::ModelFile;
use stiction_files::model::Lowered;
use stiction_friction::compensator::{Friction, Levels, Settings, Watchdog};

/// Dead zone of a law without a Stribeck velocity, of the top speed of the recordings.
const SLOW: f64 = 1e-3;

/// What follows from the law.
pub(super) fn settings_of_law(
    friction: &Friction<f64>,
    file: &ModelFile,
    lowered: &[Lowered],
) -> Settings<f64> {
    let top_speed = file.top_speed();
    // The cycle time is put in later.
    let mut settings = Settings::for_law(friction, 1e-3);
    if let (Friction::Coulomb(_), Some(top)) = (friction, top_speed) {
        settings.dead_zone = SLOW * top;
    }
    if !lowered.is_empty() {
        let levels = file.dependences(friction.coulomb()).levels;
        settings.limit = seen(friction, top_speed, levels.unwrap_or_default());
    }
    settings
}

/// The largest friction up to the speeds of the log; at standstill where those are not known.
fn seen(friction: &Friction<f64>, top_speed: Option<f64>, levels: Levels<f64>) -> f64 {
    let top = top_speed.unwrap_or(0.0);
    let (coulomb, viscous) = (friction.coulomb(), friction.viscous());
    let statics = friction.curve().map_or(coulomb, |curve| {
        [curve.positive(), curve.negative()].map(|side| side.static_friction)
    });
    let of = |i: usize| {
        let bent = levels.quadratic_force(viscous, [top, -top][i]).abs();
        statics[i].max(coulomb[i] + viscous[i] * top + bent)
    };
    of(0).max(of(1)) + friction.offset().abs()
}

/// What was asked for in the place of what follows from the model.
pub(super) fn asked(mut settings: Settings<f64>, options: &ExportOptions) -> Settings<f64> {
    settings.cycle_time = options.cycle_time;
    let safety = &options.safety;
    for (setting, asked) in [
        (&mut settings.limit, options.limit),
        (&mut settings.gain, options.gain),
        (&mut settings.ramp, safety.ramp),
        (&mut settings.dead_zone, safety.dead_zone),
        (&mut settings.slew, safety.slew),
    ] {
        *setting = asked.unwrap_or(*setting);
    }
    if let Some(window) = safety.window {
        settings.watchdog = (window != 0.0).then(|| Watchdog {
            window,
            ..Watchdog::default()
        });
    }
    settings
}
