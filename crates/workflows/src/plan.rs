//! The motion to record, within the limits of an axis.

mod asked;
mod assume;
mod band;
mod block;
mod carried;
mod design;
mod judged;
mod known;
mod outcome;
mod possible;
mod wanted;

pub use assume::Given;
pub use band::Band;
pub use block::limits_to_fill_in;
pub use known::Known;
pub use outcome::Planned;
pub use stiction_plan::carrier::Carrier;
pub use wanted::Want;

use crate::error::Error;
use std::path::Path;
use stiction_files::Axis;
use stiction_files::plan::InputEntry;
use stiction_search::Observer;

/// What is to be planned.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlanOptions {
    /// Longest motion, s; `None`: 9 s, of a probe 3 s, with wishes 60 s.
    pub time: Option<f64>,
    /// A first, careful motion at half the speed and acceleration, whose log a second plan is made from.
    pub probe: bool,
    /// Whether each direction of motion has parameters of its own; those of a model that is so have it anyway.
    pub asymmetric: bool,
    /// What is known of the axis beside its nameplate.
    pub known: Option<Known>,
    /// What is to be known how well: the shortest motion is taken that is enough. Empty: the best of the longest time.
    pub wants: Vec<Want>,
    /// Of the axes that it is made for.
    pub seed: u64,
    /// Forms for a controller beside `setpoints.csv`.
    pub carriers: Vec<Carrier>,
    /// Position at which the axis stands when the motion starts, with its unit, such as `120 mm`; `None`: 0.
    pub start: Option<String>,
}

/// Shortest and longest motion that is planned, s.
pub const TIMES: [f64; 2] = [2.0, 600.0];

/// Longest motion where none is given, s.
const TIME: f64 = 9.0;
const PROBE_TIME: f64 = 3.0;

impl PlanOptions {
    /// Longest motion, s.
    pub fn longest(&self) -> f64 {
        let usual = match (self.probe, self.wants.is_empty()) {
            (true, _) => PROBE_TIME,
            (false, true) => TIME,
            (false, false) => wanted::LONGEST,
        };
        self.time.unwrap_or(usual)
    }
}

/// Plans a motion for the axis of a file. The observer sees progress and may stop the work; `None` where it did so before there
/// was any motion. Results do not depend on the number of threads.
///
/// # Errors
/// Where the axis file lacks its limits, each key by its name, or where no motion keeps within them.
pub fn plan(
    axis_file: &Path,
    options: &PlanOptions,
    observer: &mut dyn Observer,
) -> Result<Option<Planned>, Error> {
    let [least, most] = TIMES;
    if !(least..=most).contains(&options.longest()) {
        let found = format!("--time {} s", stiction_number::full(options.longest()));
        return Err(Error::usage(found, format!("{least} s to {most} s")));
    }
    let axis = Axis::read(axis_file)?;
    let kind = axis.limits.as_ref().map(|limits| limits.motion);
    let told = match (&options.known, kind) {
        (Some(known), Some(kind)) => {
            let law = (kind, options.asymmetric);
            Some(known::told(known, axis_file, law, observer)?)
        }
        _ => None,
    };
    // Of exactly what was read: the files may change while it is planned.
    let mut inputs = Vec::new();
    let known = options.known.as_ref().zip(told.as_ref());
    let known = known.map(|(known, told)| (known.file(), told.sha256.clone()));
    let own = axis.sha256().map(|sha256| (axis_file, sha256.to_string()));
    for (path, sha256) in own.into_iter().chain(known) {
        inputs.push(InputEntry {
            path: stiction_files::shell::text(path),
            sha256,
        });
    }
    let given = assume::given(&axis, told, options)?;
    wanted::are_planned(&options.wants, &given.subject)?;
    let start = given.start;
    carried::tried(&given, options, start)?;
    let planned = design::design(&axis, given, inputs, options, observer)?;
    planned
        .map(|planned| carried::carried(planned, start))
        .transpose()
}
