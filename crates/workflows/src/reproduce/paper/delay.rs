//! The sine over the delay of the loop: the law fed by the measured velocity and by the reference velocity.

use super::compensation::Compensation;
use super::fault::Fault;
use super::stage::{Control, RATE, Stage};
use super::tracking::{counts_from, sine};
use crate::reproduce::watch::Watch;
use rayon::prelude::*;
use stiction_friction::{LuGre, ParamError};
use stiction_servo::metrics::Tracking;

/// Delays from the controller to the amplifier, in control periods.
const PERIODS: [u32; 4] = [0, 1, 2, 4];

/// What one delay makes of the sine.
#[derive(Clone, Debug)]
pub struct Delayed {
    /// Control periods.
    pub periods: u32,
    /// Tracking without compensation, with the law on the reference velocity, and on the measured one.
    pub tracking: [Tracking; 3],
}

pub(super) fn run(stage: &Stage, law: &LuGre<f64>, watch: &Watch) -> Result<Vec<Delayed>, Fault> {
    let runs: Result<Vec<Delayed>, ParamError> =
        PERIODS.par_iter().map(|p| one(stage, *p, law)).collect();
    let runs = runs?;
    watch.done()?;
    Ok(runs)
}

fn one(stage: &Stage, periods: u32, law: &LuGre<f64>) -> Result<Delayed, ParamError> {
    let mut settings = stage.settings(Control::Fuzzy)?;
    settings.drive.delay = f64::from(periods) / RATE;
    let track = |of: Compensation| {
        let settings = of.compensate(settings.clone(), law)?;
        let all = stage.along(&settings, &sine(stage)?)?;
        Ok(Tracking::of(&all[counts_from(&all)..]))
    };
    let [bare, reference, measured] = [
        Compensation::Nothing,
        Compensation::Reference,
        Compensation::Measured,
    ]
    .map(track);
    Ok(Delayed {
        periods,
        tracking: [bare?, reference?, measured?],
    })
}
