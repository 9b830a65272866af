//! The motion to record, within the limits of an axis.

mod asked;
mod assume;
mod band;
mod block;
mod carried;
mod design;
mod judged;
mod known;
mod law;
mod outcome;
mod possible;
mod wanted;

pub use assume::Given;
pub use band::Band;
pub use block::limits_to_fill_in;
pub use known::Known;
pub use law::PLANNED;
pub use outcome::Planned;
pub use stiction_plan::carrier::Carrier;
pub use wanted::Want;

use crate::error::Error;
use crate::wording::Setting;
use std::path::Path;
use stiction_files::Axis;
use stiction_files::plan::InputEntry;
use stiction_parameters::LawKind;
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
    /// The law that is fitted; `None`: that of the model, of a log Maxwell slip with a curve where the axis file has elements, else LuGre.
    pub law: Option<LawKind>,
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
        let asked = options.longest();
        let nearest = if asked.is_finite() {
            asked.clamp(least, most)
        } else {
            most
        };
        let found = Setting::Time.is(format!("{} s", stiction_number::full(asked)));
        let allowed = [
            format!("{least} s to {most} s, such as ").into(),
            Setting::Time.is(format!("{nearest}s")),
        ];
        return Err(Error::usage(found, allowed));
    }
    let axis = Axis::read(axis_file)?;
    let law = law::asked(&axis, axis_file, options)?;
    let kind = axis.limits.as_ref().map(|limits| limits.motion);
    let told = match (&options.known, kind) {
        (Some(known), Some(kind)) => {
            let asked = (kind, law, options.asymmetric);
            Some(known::told(known, axis_file, asked, observer)?)
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
    let given = assume::given(&axis, axis_file, told, options)?;
    wanted::are_planned(&options.wants, &given.subject)?;
    let start = given.start;
    carried::tried(&given, options, start)?;
    let planned = design::design(&axis, given, inputs, options, observer)?;
    planned
        .map(|planned| carried::carried(planned, start))
        .transpose()
}

#[cfg(test)]
mod tests {
    use super::{PlanOptions, plan};
    use stiction_search::{Control, Progress, Silent, Stage};

    const AXIS: &str = r#"
kind = "linear"
rate = "500 Hz"
[limits]
stroke = ["-20 mm", "30 mm"]
speed = "0.1 m/s"
acceleration = "2 m/s2"
rated_force = "40 N"
peak_force = "60 N"
mass = "4 kg"
[controller]
bandwidth = "20 Hz"
"#;

    /// Whoever stops while pieces are chosen has what was chosen, simulated as any other.
    #[test]
    fn a_choice_that_is_stopped_is_simulated_and_kept() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("axis.toml");
        std::fs::write(&file, AXIS).unwrap();
        let mut is_stopped = false;
        let mut stop = |progress: &Progress| {
            is_stopped |= progress.stage == Stage::Search;
            match is_stopped {
                true => Control::Stop,
                false => Control::Continue,
            }
        };
        let options = PlanOptions {
            time: Some(4.0),
            ..PlanOptions::default()
        };
        let planned = plan(&file, &options, &mut stop).unwrap().unwrap();
        assert_eq!(planned.file.status, "interrupted");
        assert!(planned.motion.duration() > 2.0 && planned.motion.duration() <= 4.0);
        let limits = &planned.given.nameplate.limits;
        assert!(planned.motion.holds(limits) && planned.expected.peaks.within(limits));
    }

    /// A drive that could not give for long what the motion takes gets a slower one.
    #[test]
    fn the_drive_can_give_for_long_what_a_motion_takes() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("axis.toml");
        let weak = AXIS.replace("\"40 N\"", "\"1.5 N\"");
        std::fs::write(&file, weak).unwrap();
        let options = PlanOptions {
            time: Some(4.0),
            ..PlanOptions::default()
        };
        let planned = plan(&file, &options, &mut Silent).unwrap().unwrap();
        let largest = &planned.file.largest;
        assert!(
            largest.force_rms <= 1.5 && largest.force <= 60.0,
            "{largest:?}"
        );
        // The force is what slows it down: with a stronger drive it is faster.
        assert!(largest.speed < 0.08, "{largest:?}");
    }
}
