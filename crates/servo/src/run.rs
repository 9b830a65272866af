//! An axis along a trajectory, recorded.

use crate::axis::{Axis, AxisSettings, Correction, Sample};
use crate::integrator::{Integrator, Mid};
use crate::path::Reference;
use crate::sampled::Sampled;
use crate::trajectory::{Lookahead, Trajectory};
use stiction_friction::{Held, ParamError};

/// Most samples of one run: with ten channels of `f64` it stays below a gigabyte.
const MAX_SAMPLES: f64 = 1e7;

/// How far the last sample may lie beyond the end of the trajectory, in control periods: rounding of the product of
/// duration and rate.
const PERIOD_ROUNDING: f64 = 1e-6;

/// Samples of a trajectory at a rate (Hz), if they are not too many.
pub fn sample_count(duration: f64, rate: f64) -> Result<usize, ParamError> {
    let samples = libm::floor(duration * rate + PERIOD_ROUNDING) + 1.0;
    if samples.is_nan() || samples > MAX_SAMPLES {
        let allowed = "at most 1e7 (duration times rate)";
        return Err(ParamError::new("samples", samples, allowed));
    }
    Ok(samples as usize)
}

/// Runs an axis from rest over the whole trajectory, with MID in one step per substep.
pub fn run<L: Held<f64>>(
    settings: &AxisSettings<L>,
    trajectory: &impl Trajectory,
) -> Result<Vec<Sample>, ParamError> {
    run_with(settings, trajectory, Mid::new(1)?)
}

/// [`run`] with another integrator.
pub fn run_with<L: Held<f64>, I: Integrator<L>>(
    settings: &AxisSettings<L>,
    trajectory: &impl Trajectory,
    integrator: I,
) -> Result<Vec<Sample>, ParamError> {
    follow(&mut Axis::new(settings.clone(), integrator)?, trajectory)
}

/// Runs an axis over the whole trajectory from its present state.
pub fn follow<L: Held<f64>, I: Integrator<L>>(
    axis: &mut Axis<L, I>,
    trajectory: &(impl Trajectory + ?Sized),
) -> Result<Vec<Sample>, ParamError> {
    let (rate, preview) = (axis.settings().rate, axis.settings().feedforward.preview);
    let n = sample_count(trajectory.duration(), rate)?;
    let mut reference = Lookahead::new(trajectory, rate, preview);
    Ok(record(axis, (0..n).map(|_| reference.sample())))
}

/// [`follow`] along a trajectory that was sampled at the rate of the axis: the same samples.
pub fn follow_sampled<L: Held<f64>, I: Integrator<L>>(
    axis: &mut Axis<L, I>,
    trajectory: &Sampled,
) -> Result<Vec<Sample>, ParamError> {
    let (rate, preview) = (axis.settings().rate, axis.settings().feedforward.preview);
    if rate != trajectory.rate() {
        return Err(ParamError::new("rate", rate, "that of the samples"));
    }
    Ok(record(axis, trajectory.with_preview(preview)))
}

#[inline]
fn record<L: Held<f64>, I: Integrator<L>>(
    axis: &mut Axis<L, I>,
    references: impl ExactSizeIterator<Item = (Reference, f64)>,
) -> Vec<Sample> {
    references
        .map(|(now, ahead)| axis.step(now, ahead, Correction::default()))
        .collect()
}
