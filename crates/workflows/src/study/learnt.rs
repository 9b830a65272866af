//! What a watchdog has learnt before a run: the error without compensation, on the same motion as often as it takes.

use std::sync::OnceLock;
use stiction_files::study::{Job, Scheme, Study};
use stiction_friction::compensator::{
    Compensator, Friction, Input, Settings, Source, Watch, Watchdog,
};
use stiction_friction::{CoulombViscous, ParamError};
use stiction_servo::axis::Sample;

/// What a watchdog knows, for each axis of a motion.
type Watches = Vec<Watch<f64>>;

/// What the watchdogs of a study have learnt on each motion under each controller, for all runs that share it.
pub(super) struct Learnt {
    /// For each compensator.
    cells: Vec<OnceLock<Result<Vec<Watches>, ParamError>>>,
}

impl Learnt {
    /// Nothing yet.
    pub fn of(study: &Study) -> Self {
        let motions = study.paths.len() + study.contours.len();
        let cells = 2 * motions * study.controllers.len();
        Learnt {
            cells: (0..cells).map(|_| OnceLock::new()).collect(),
        }
    }

    /// What the watchdog of a run has learnt on each axis; `without` runs the motion without compensation. A run in which
    /// another mass than that of the axis is fed forward has learnt with that mass, for itself alone.
    pub fn before(
        &self,
        study: &Study,
        job: Job,
        without: impl Fn() -> Result<Vec<Vec<Sample>>, ParamError>,
    ) -> Result<Watches, ParamError> {
        let watchdog = |compensator: usize| match &study.compensators[compensator].value {
            Scheme::Model(model) => model.watchdog,
            _ => None,
        };
        let learn = |watchdog: Watchdog<f64>, axes: &[Vec<Sample>]| -> Result<_, ParamError> {
            let rate = study.machine.rate;
            axes.iter()
                .map(|axis| learn(watchdog, axis, rate))
                .collect()
        };
        let Some(mine) = watchdog(job.compensator) else {
            return Ok(vec![Watch::default(); 2]);
        };
        if study.learns_alone(job) {
            return learn(mine, &without()?);
        }
        let place = 2 * (job.path * study.controllers.len() + job.controller);
        let cell = self.cells[place + usize::from(job.coupled)].get_or_init(|| {
            let axes = without()?;
            let each = (0..study.compensators.len()).map(|i| match watchdog(i) {
                Some(watchdog) => learn(watchdog, &axes),
                None => Ok(Vec::new()),
            });
            each.collect()
        });
        match cell {
            Ok(all) => Ok(all[job.compensator].clone()),
            Err(e) => Err(*e),
        }
    }
}

/// Passes of a motion without compensation, one after the other, until the watchdog knows what is normal.
pub(super) fn learn(
    watchdog: Watchdog<f64>,
    samples: &[Sample],
    rate: f64,
) -> Result<Watch<f64>, ParamError> {
    // Only its watchdog is asked, which knows nothing of the law.
    let law = Friction::Coulomb(CoulombViscous::new([1.0; 2], [0.0; 2], 0.0)?);
    let settings = Settings {
        watchdog: Some(watchdog),
        ..Settings::new(1.0 / rate, 1.0)
    };
    let mut compensator = Compensator::new(law, Source::Reference, settings)?;
    let moving = samples.iter().filter(|s| s.reference.velocity != 0.0);
    let inputs: Vec<Input<f64>> = moving
        .map(|s| Input {
            reference_velocity: s.reference.velocity,
            tracking_error: s.reference.position - s.measured,
            ..Input::default()
        })
        .collect();
    // It learns over five windows, each of which ends after ten times its length at the latest; time before the first
    // reversal does not count.
    let longest = 5 * ((10.0 * watchdog.window * rate) as usize + 2 * inputs.len() + 2);
    for input in inputs.iter().cycle().take(longest) {
        compensator.step(*input);
        if compensator.state().watch.allows() {
            break;
        }
    }
    Ok(compensator.state().watch)
}
