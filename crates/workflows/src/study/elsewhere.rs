//! A study on an axis that is not its model.

use super::diverged::Fault;
use super::learnt::Learnt;
use super::metrics::metrics;
use super::path::on_path;
use stiction_files::study::{Job, Study};
use stiction_friction::{LuGre, ParamError};
use stiction_servo::integrator::Integrator;

/// Metrics of a run by their names.
pub type Metrics = Vec<(&'static str, f64)>;

/// The metrics of each run along a path with the parameters of the model, by name, with everything as the study has it but
/// the axis: `axis` makes one at rest, which the force moves instead of the plant of the study.
///
/// # Errors
/// Where a run cannot be made.
pub fn simulate_on<I: Integrator<LuGre<f64>>>(
    study: &Study,
    axis: &dyn Fn() -> I,
) -> Result<Vec<(Job, Metrics)>, ParamError> {
    let learnt = Learnt::of(study);
    let of_paths =
        |job: &Job| job.path < study.paths.len() && study.families[job.family].kind == "exact";
    let jobs = study.jobs().into_iter().filter(of_paths);
    jobs.filter_map(|job| {
        let done = on_path::<LuGre<f64>, I>(study, job, None, &learnt, &|| Ok(axis()), &|| true);
        let names = metrics(study, job).iter().copied();
        match done {
            Ok(Some(done)) => Some(Ok((job, names.zip(done.metrics).collect()))),
            Ok(None) => None,
            Err(Fault::Refused(e)) => Some(Err(e)),
            Err(Fault::Diverged(at)) => {
                let allowed = "a run that stays on its path";
                Some(Err(ParamError::new("time", at, allowed)))
            }
        }
    })
    .collect()
}
