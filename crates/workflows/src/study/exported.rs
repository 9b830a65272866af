//! The C that was exported, run in the study beside the compensator that it was written from.
//!
//! A study file is untrusted and never starts a compiler: the folder of the C comes from the caller alone.

mod kept;
mod process;
mod run;
mod source;

pub(super) use kept::runs;
pub use run::compare_exported;

use crate::error::Error;
use crate::export::{ExportOptions, Feedforward, Target, compensator_of};
use process::{Process, Settled};
use source::Source;
use std::path::Path;
use stiction_files::shell::{free_folder, quoted, quoted_path};
use stiction_files::study::Study;
use stiction_files::study::result::StudyInput;
use stiction_friction::compensator::Compensator;
use stiction_number::{four_digits, shortest};
use tempfile::TempDir;

/// An exported compensator as a program, and the same in Rust.
pub struct ExportedC {
    folder: String,
    source: Source,
    files: Vec<StudyInput>,
    /// The command that writes C for this study, into a folder beside it.
    again: String,
    /// The settings that the C has.
    settled: Settled,
    /// The compensator that an export of the model of the study has with these settings.
    rust: Compensator<f64>,
    /// Whether the C was written from the model of the study.
    same_model: bool,
    place: TempDir,
}

/// Cycle times that differ by rounding, relative.
const SAME_TIME: f64 = 1e-9;

impl ExportedC {
    /// Compiles the double-precision C in `folder`, which `stiction export --target c` wrote, and starts it once. The study has a
    /// model, is sampled at the cycle time of the C, and has a path of one axis.
    ///
    /// # Errors
    /// Where one of these is not so, there is no gcc, or it does not compile the C.
    pub fn open(folder: &Path, study: &Study) -> Result<Self, Error> {
        let name = stiction_files::shell::text(folder);
        let refuse = |found: String, allowed: String| Error::usage(found, allowed);
        let Some(read) = study.machine.model.file() else {
            return Err(refuse(
                format!("--exported-c {name} for a study whose axis has no model file"),
                "a study with [axis] model = \"MODEL.toml\", the model that was exported".into(),
            ));
        };
        if study.paths.is_empty() {
            return Err(refuse(
                format!("--exported-c {name} for a study without a [[path]]"),
                "a motion of one axis: the C is the compensator of one".into(),
            ));
        }
        let into = |folder: &str| {
            format!(
                "stiction export {} --target c --cycle-time {}{folder}",
                quoted_path(read.file()),
                shortest(1.0 / study.machine.rate),
            )
        };
        // What is there and no folder takes no files.
        let is_other = folder.symlink_metadata().is_ok() && !folder.is_dir();
        let beside = match is_other {
            true => quoted_path(&free_folder(Path::new("exported-c"))),
            false => quoted(&format!("{}-new", name.trim_end_matches('/'))),
        };
        let again = into(&format!(" --out {beside}"));
        let source = Source::find(folder).map_err(|found| {
            refuse(
                format!("--exported-c {name}: {found}"),
                format!("a folder that this wrote: {again}"),
            )
        })?;
        let failed = |found: String| {
            let allowed = format!(
                "C as this writes it: {again}; and gcc on the path (Debian: sudo apt-get install gcc)"
            );
            refuse(format!("--exported-c {name}: {found}"), allowed)
        };
        let place = source.compile().map_err(failed)?;
        let (_, settled) = Process::start(&place, None).map_err(failed)?;
        let options = settled.options(&source);
        let period = 1.0 / study.machine.rate;
        if (settled.cycle_time - period).abs() > SAME_TIME * period {
            return Err(refuse(
                format!(
                    "--exported-c {name}: C for a cycle time of {} s in a study of {} Hz",
                    shortest(settled.cycle_time),
                    four_digits(study.machine.rate)
                ),
                format!("the same: {again}{}", fed(options.feedforward)),
            ));
        }
        // A ramp of years would be waited for.
        crate::export::check(&options)
            .map_err(|e| refuse(format!("--exported-c {name}: {e}"), again.clone()))?;
        let rust = compensator_of(read, &options)?;
        Ok(ExportedC {
            same_model: source.model_sha256.as_deref() == Some(read.sha256.as_str()),
            files: source.inputs(),
            folder: name,
            again,
            source,
            settled,
            rust,
            place,
        })
    }
}

/// The option that has these parts fed forward; nothing where that is friction alone.
fn fed(parts: Feedforward) -> String {
    let all = [
        (parts.mass, ",mass"),
        (parts.gravity, ",gravity"),
        (parts.cogging, ",cogging"),
    ];
    let fed = all.into_iter().filter(|(fed, _)| *fed);
    let fed: String = fed.map(|(_, name)| name).collect();
    match fed.is_empty() {
        true => fed,
        false => format!(" --feedforward friction{fed}"),
    }
}

impl Settled {
    /// The options of an export with these settings.
    fn options(&self, source: &Source) -> ExportOptions {
        let mut options = ExportOptions::new(Target::C, self.cycle_time);
        options.limit = Some(self.limit);
        options.gain = Some(self.gain);
        options.safety.ramp = Some(self.ramp);
        options.safety.dead_zone = Some(self.dead_zone);
        options.safety.slew = Some(self.slew);
        options.safety.window = Some(self.window);
        options.adapt = source.adapts;
        options.feedforward = Feedforward {
            mass: source.feeds("mass"),
            gravity: source.feeds("gravity"),
            cogging: source.feeds("cogging"),
            rigid: false,
        };
        options
    }
}
