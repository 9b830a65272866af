//! The runs with exported C: the axis of the study under each controller along each path, without compensation, with the
//! compensator in Rust and with the C.

use super::ExportedC;
use super::kept::{self, Kept, METRICS};
use super::process::Process;
use crate::error::Error;
use crate::study::changing::Changing;
use crate::study::course;
use crate::study::diverged::{Fault, stayed};
use crate::study::learnt::learn;
use crate::study::machine::{self, largest_force};
use crate::study::metrics::{metrics, of_path};
use crate::study::outcome::StudyOutcome;
use crate::study::path::along;
use crate::study::trace::Trace;
use stiction_files::study::result::ExportedEntry;
use stiction_files::study::{Belief, Job, Scheme, Study};
use stiction_files::{Runs, Warning};
use stiction_friction::compensator::{Compensator, Input, Watch};
use stiction_friction::{ElastoPlastic, LuGre, MaxwellSlip, ParamError};
use stiction_number::four_digits;
use stiction_policy::export;
use stiction_say::{Notice, Origin};
use stiction_servo::axis::{Axis, Correction, Sample};
use stiction_servo::controller::Controller;
use stiction_servo::integrator::{Integrator, Mid, Quick};
use stiction_servo::law::{AxisLaw, OfAxis};
use stiction_servo::levelled::{Depending, Levelled};
use stiction_servo::path::Reference;
use stiction_servo::trajectory::MAX_PREVIEW;

/// What the runs are called in tables, figures and `trajectories.csv`.
const NAMES: [&str; 3] = ["none", "in Rust", "exported C"];

/// Time at standstill in which compensation comes in before a run, beyond its ramp, s.
const SETTLED: f64 = 0.01;

/// One run: its samples, and whether the watchdog has switched off.
type Ran = (Vec<Sample>, bool);

/// Puts the runs with exported C beside an outcome: their metrics, courses and the largest difference of the force. C that gives
/// another force is warned of. Runs that an earlier call has kept in `runs` are taken, others are kept there.
///
/// # Errors
/// Where the program ends before its inputs do.
pub fn compare_exported(
    outcome: &mut StudyOutcome,
    study: &Study,
    exported: &ExportedC,
    runs: &Runs,
) -> Result<(), Error> {
    let mut rows = Vec::new();
    for (place, job) in kept::jobs(study).enumerate() {
        if let Some(kept) = Kept::taken(runs, study, (place, job), &exported.id()) {
            rows.push(kept.told(outcome, study));
            continue;
        }
        match on_path(study, job, exported) {
            Ok(compared) => {
                let kept = compared.kept(study, job, exported.id());
                kept.add(runs, study, place);
                rows.push(kept.told(outcome, study));
            }
            Err(Failed::Program(found)) => {
                return Err(Error::usage(
                    format!("--exported-c {}: {found}", exported.folder),
                    format!("C as this writes it: {}", exported.again),
                ));
            }
            // The study itself says of the run without compensation why it cannot be made.
            Err(Failed::Run(fault)) => {
                let notice = Notice::ExportedNotRun {
                    path: study.path_name(job).to_string(),
                    controller: study.controllers[job.controller].name.clone(),
                    why: fault.no_run(),
                };
                outcome.file.warnings.push(notice.into());
            }
        }
    }
    let entry = ExportedEntry {
        folder: exported.folder.clone(),
        files: exported.files.clone(),
        same_model: exported.same_model,
        allowed_difference: export::MAX_FORCE_DIFFERENCE,
        runs: rows,
    };
    outcome.file.warnings.extend(differing(&entry, exported));
    outcome.file.exported_c = Some(entry);
    Ok(())
}

/// What is said of C that gives another force.
fn differing(entry: &ExportedEntry, exported: &ExportedC) -> Option<Warning> {
    let beyond = entry.runs.iter().filter(|row| row.differs);
    let worst = beyond.max_by(|a, b| a.force_difference.total_cmp(&b.force_difference))?;
    let model = exported.rust.friction();
    let same_law = exported.settled.key == f64::from(exported.rust.key());
    let notice = Notice::ExportedDiffers {
        folder: entry.folder.clone(),
        difference: worst.force_difference,
        unit: worst.force_unit.clone(),
        seconds: worst.at_s,
        path: worst.path.clone(),
        controller: worst.controller.clone(),
        part: worst.force_difference / model.scale(),
        origin: match (exported.same_model, same_law) {
            (_, false) => Origin::AnotherLaw,
            (false, true) => Origin::SameLaw,
            (true, true) => Origin::Model,
        },
        again: exported.again.clone(),
    };
    Some(notice.into())
}

/// Why a run gives nothing.
enum Failed {
    Program(String),
    Run(Fault),
}

impl From<ParamError> for Failed {
    fn from(e: ParamError) -> Self {
        Failed::Run(Fault::Refused(e))
    }
}

/// The three runs of a path under a controller.
struct Compared {
    runs: [Ran; 3],
    /// Largest difference of the forces of C and Rust on the inputs of the run with C, N (N m), and when, s.
    difference: f64,
    at: f64,
    /// Whether somewhere it is more than is allowed.
    differs: bool,
}

fn on_path(study: &Study, job: Job, exported: &ExportedC) -> Result<Compared, Failed> {
    match study.machine.law {
        AxisLaw::LuGre(_) if study.machine.depends.is_none() => {
            moved::<LuGre<f64>, _>(study, job, exported, &|| Quick::new(1))
        }
        AxisLaw::LuGre(_) => stepped::<LuGre<f64>>(study, job, exported),
        AxisLaw::ElastoPlastic(_) => stepped::<ElastoPlastic<f64>>(study, job, exported),
        AxisLaw::MaxwellSlip(_) => stepped::<MaxwellSlip<f64>>(study, job, exported),
    }
}

fn stepped<L: OfAxis>(study: &Study, job: Job, exported: &ExportedC) -> Result<Compared, Failed> {
    match &study.machine.depends {
        None => moved::<L, _>(study, job, exported, &|| Mid::new(1)),
        Some(depends) => moved::<Levelled<L>, _>(study, job, exported, &|| {
            Ok(Depending::new(Mid::new(1)?, depends.clone()))
        }),
    }
}

fn moved<L: OfAxis, I: Integrator<L>>(
    study: &Study,
    job: Job,
    exported: &ExportedC,
    integrator: &dyn Fn() -> Result<I, ParamError>,
) -> Result<Compared, Failed> {
    let machine = &study.machine;
    let own = Belief {
        law: machine.law,
        mass: machine.mass,
    };
    let controller = study.controllers[job.controller].value;
    let coming_in = exported.settled.ramp + SETTLED;
    let run = |controller: Controller, force: Force| -> Result<Vec<Sample>, Failed> {
        let settings = machine::settings::<L>(machine, own, controller, study.seed)?;
        let samples = follow(
            study,
            job,
            Axis::new(settings, integrator()?)?,
            own,
            (coming_in, force),
        )?;
        stayed(samples.iter().map(|s| [s])).map_err(Failed::Run)?;
        Ok(samples)
    };
    let without = run(controller, &mut |_| 0.0)?;
    let watch = match exported.rust.settings().watchdog {
        Some(watchdog) => learn(watchdog, &without, machine.rate)?,
        None => Watch::default(),
    };
    // Where the block feeds the mass forward the controller does not.
    let controller = match exported.source.feeds("mass") {
        true => controller.with_mass_feedforward(0.0),
        false => controller,
    };
    let mut rust = ready(&exported.rust, &watch);
    let alone = run(controller, &mut |input| rust.step(input))?;
    let alone = (alone, rust.state().watch.tripped());
    let mut beside = ready(&exported.rust, &watch);
    let (mut process, _) =
        Process::start(&exported.place, Some(&watch)).map_err(Failed::Program)?;
    let scale = exported.rust.friction().scale();
    // The last digit of a sum may be beyond it.
    let most = exported.rust.settings().limit * (1.0 + f64::EPSILON * 8.0);
    let mut ended = None;
    let (mut difference, mut at, mut differs, mut tripped) = (0.0_f64, 0.0, false, false);
    let mut count = 0_u64;
    let with = run(controller, &mut |input| {
        let expected = beside.step(input);
        match process.step(&input) {
            _ if ended.is_some() => 0.0,
            Err(found) => {
                ended = Some(found);
                0.0
            }
            Ok((force, _)) if force.is_nan() || force.abs() > most => {
                let at = match count as f64 / machine.rate - coming_in {
                    at if at < 0.0 => "before the motion begins".into(),
                    at => format!("at {} s", four_digits(at)),
                };
                ended = Some(format!(
                    "it gives a force of {} {at}, beyond its limit of {}",
                    four_digits(force),
                    four_digits(most)
                ));
                0.0
            }
            Ok((force, off)) => {
                let apart = (force - expected).abs();
                if apart.is_nan() || apart > difference {
                    (difference, at) = (apart, count as f64 / machine.rate - coming_in);
                }
                let within = apart <= export::MAX_FORCE_DIFFERENCE * scale.max(expected.abs());
                differs |= !within;
                tripped = off;
                count += 1;
                force
            }
        }
    });
    if let Some(found) = ended {
        return Err(Failed::Program(found));
    }
    Ok(Compared {
        runs: [(without, false), alone, (with?, tripped)],
        difference,
        at,
        differs,
    })
}

/// The compensator with what its watchdog has learnt, as C takes it.
fn ready(compensator: &Compensator<f64>, watch: &Watch<f64>) -> Compensator<f64> {
    let mut compensator = *compensator;
    if watch.without >= 0.0 {
        let mut memory = compensator.memory();
        (memory[3], memory[4]) = (watch.without, watch.peak_without);
        (memory[9], memory[10]) = (-watch.without, -watch.peak_without);
        // It is its own memory.
        let _ = compensator.recall(&memory);
    }
    compensator
}

/// What gives the force of a sample.
type Force<'a> = &'a mut dyn FnMut(Input<f64>) -> f64;

/// Runs the axis along a path with a force that is given from outside; before, the compensation is enabled at standstill for as
/// long as it takes to come in.
fn follow<L: OfAxis, I: Integrator<L>>(
    study: &Study,
    job: Job,
    mut axis: Axis<L, I>,
    own: Belief,
    (coming_in, force): (f64, Force),
) -> Result<Vec<Sample>, Failed> {
    let machine = &study.machine;
    let path = &study.paths[job.path];
    let period = 1.0 / machine.rate;
    let preview = machine.drive.preview(period).min(MAX_PREVIEW);
    let peak = machine.drive.peak_force();
    let told = |reference: Reference| {
        let surroundings = machine.depends.as_ref().map(|d| d.surroundings);
        let [load, temperature, position] = match surroundings {
            Some(surroundings) => surroundings.seen(reference.position),
            None => [f64::NAN, f64::NAN, reference.position],
        };
        Input {
            load,
            temperature,
            position,
            enable: true,
            ..Input::default()
        }
    };
    for _ in 0..(coming_in * machine.rate) as usize {
        force(told(path.trajectory.at(0.0)));
    }
    let mut command = 0.0_f64;
    let mut count = 0_u64;
    let mut step = |axis: &mut Axis<L, I>, reference: Reference, ahead: f64| {
        let measured = axis.measure();
        let instant = (count as f64 + preview) * period;
        count += 1;
        let given = force(Input {
            reference_velocity: ahead,
            tracking_error: reference.position - measured,
            reference_acceleration: path.trajectory.at(instant).acceleration,
            drive_force: command,
            learn: command.abs() < peak,
            ..told(reference)
        });
        let correction = Correction {
            force: given,
            ..Correction::default()
        };
        let sample = axis.step(reference, ahead, correction);
        command = sample.command;
        Sample {
            compensation: given,
            ..sample
        }
    };
    let references = along(path, machine.rate, preview)?;
    let samples = match Changing::of(study, &Scheme::None, own, own, own.mass) {
        Some(changing) => changing.follow_by(&mut axis, references, &mut step)?.0,
        None => references
            .map(|(now, ahead)| step(&mut axis, now, ahead))
            .collect(),
    };
    Ok(samples)
}

impl Compared {
    /// What an outcome shows of them.
    fn kept(&self, study: &Study, job: Job, of: String) -> Kept {
        let [path, controller, _] = study.names(job);
        let skip = study.paths[job.path].skip;
        let largest = largest_force(&study.machine, &study.controllers[job.controller].value);
        let names = metrics(study, job);
        let (mut values, mut traces, mut course) = (Vec::new(), Vec::new(), String::new());
        for (i, (samples, _)) in self.runs.iter().enumerate() {
            let counted = &samples[samples.partition_point(|s| s.time < skip)..];
            let all = of_path(counted, largest, None);
            let of = |name: &&str| names.iter().position(|n| n == name).map(|k| all[k]);
            values.extend(METRICS.iter().filter_map(of));
            let called = [path, controller, NAMES[i]];
            if study.keeps_courses {
                traces.push(Trace::of(called, counted));
                // Without compensation it is there already.
                if i > 0 {
                    let most = course::rows_of_a_run(study);
                    course.push_str(&course::rows(called, samples, most));
                }
            }
        }
        let [_, (rust, _), (c, tripped)] = &self.runs;
        let apart = rust.iter().zip(c);
        let apart = apart.map(|(a, b)| (a.position - b.position).abs());
        Kept {
            of,
            job,
            metrics: values,
            apart: vec![self.difference, self.at, apart.fold(0.0, f64::max)],
            differs: self.differs,
            switched_off: *tripped,
            traces,
            course,
        }
    }
}
