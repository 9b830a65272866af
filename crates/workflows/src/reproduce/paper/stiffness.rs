//! The same sine over the stiffness of the bristles, as far as ode4 with the published step is stable.

use super::compensation::Compensation;
use super::fault::Fault;
use super::stage::{Control, RATE, Stage};
use super::tracking::{counts_from, friction, sine};
use crate::reproduce::watch::Watch;
use rayon::prelude::*;
use stiction_friction::{LuGre, ParamError};
use stiction_servo::axis::{AxisSettings, Sample};
use stiction_servo::integrator::Ode4;
use stiction_servo::metrics::Tracking;
use stiction_servo::plant::Plant;
use stiction_servo::run::run_with;
use stiction_servo::trajectory::Trajectory;

/// Stiffnesses in parts of that of the axis, dimensionless.
pub(super) const PARTS: [f64; 7] = [0.03, 0.1, 0.3, 1.0, 1.5, 3.0, 10.0];

/// Part of the fastest reference up to which ode4 is checked, dimensionless: the axis overshoots.
const OVERSHOOT: f64 = 1.1;

/// What one stiffness makes of the sine.
#[derive(Clone, Debug)]
pub struct Stiffness {
    /// sigma0 of the axis, N/m (N m/rad).
    pub sigma0: f64,
    /// Largest step with which ode4 is stable along the sine, s, where it is shorter than the published one: nothing was
    /// run then.
    pub unstable: Option<f64>,
    /// Largest error at reversals without compensation and with the law of the axis at its own stiffness, m (rad).
    pub reversal_peak: [f64; 2],
    /// Position (m, rad) and friction (N, N m) without compensation.
    pub friction: [Vec<f64>; 2],
}

/// From soft to stiff; the compensation keeps the `law` that was identified at the stiffness of the axis.
pub(super) fn run(stage: &Stage, law: &LuGre<f64>, watch: &Watch) -> Result<Vec<Stiffness>, Fault> {
    let runs: Result<Vec<Stiffness>, ParamError> = PARTS
        .par_iter()
        .map(|part| one(stage, *part, law))
        .collect();
    let runs = runs?;
    watch.done()?;
    Ok(runs)
}

fn one(stage: &Stage, part: f64, identified: &LuGre<f64>) -> Result<Stiffness, ParamError> {
    let truth = &stage.truth.law;
    let sigma0 = part * truth.stiffness();
    let law = LuGre::new(sigma0, truth.damping(), *truth.curve())?;
    let settings = AxisSettings {
        plant: Plant::new(stage.truth.mass, law)?,
        ..stage.settings(Control::Fuzzy)?
    };
    let sine = sine(stage)?;
    let steps = (sine.duration() * RATE) as usize;
    let fastest = (0..=steps).map(|k| sine.at(k as f64 / RATE).velocity.abs());
    let fastest = OVERSHOOT * fastest.fold(0.0, f64::max);
    if let Err(unstable) = Ode4::check(&settings.plant, 1.0 / RATE, fastest) {
        return Ok(Stiffness {
            sigma0,
            unstable: Some(unstable.largest),
            reversal_peak: [f64::NAN; 2],
            friction: [Vec::new(), Vec::new()],
        });
    }
    let run = |of: Compensation| -> Result<Vec<Sample>, ParamError> {
        // In the published step, whatever the axis itself takes.
        let settings = of.compensate(settings.clone(), identified)?;
        run_with(&settings, &sine, Ode4::new(1)?)
    };
    let [bare, with] = [Compensation::Nothing, Compensation::Reference].map(run);
    let (bare, with) = (bare?, with?);
    let from = counts_from(&bare);
    Ok(Stiffness {
        sigma0,
        unstable: None,
        reversal_peak: [&bare, &with].map(|all| Tracking::of(&all[from..]).reversal_peak),
        friction: [
            bare[from..].iter().map(|s| s.position).collect(),
            friction(&law, &bare).split_off(from),
        ],
    })
}
