//! What the command line is made of: the same work from paths to outcomes, the texts and reports of it, and the rules of
//! output folders.

/// Many logs, and the table of what was identified of each.
pub mod batch {
    pub use stiction_files::batch::{
        BatchFile, COLUMNS, Listed, LogRow, ParameterRow, RESULTS, Results, SCHEMA, is_list,
        read_list, read_results, rows_while, seconds_of,
    };
    pub use stiction_formats::Cells;
    pub use stiction_workflows::batch::{Batch, Called, Done, batch_of};
}

/// Friction over time, from the table of a batch.
pub mod drift {
    pub use stiction_files::drift_file::{Alarm, DriftFile, NoiseEntry, SCHEMA};
    pub use stiction_workflows::drift::{
        DriftOutcome, Limit, Shown, Times, drift, drift_of_rows_while, drift_while,
    };
}

/// Recording from a device, read-only.
pub mod record {
    pub use stiction_record::{Device, End, Error, Fault, Options, Recorded, Source, record};
}

/// A recording in SI with how its columns were understood.
pub mod recording {
    pub use stiction_log::{Channel, Log, Mapping, Motion, Role, Selector, Understood};
}

/// Why a recording was refused.
pub use stiction_formats::{Error as LogError, Kind as LogKind, is_recording_folder, is_regular};

/// A table as its file has it.
pub mod log_table {
    pub use stiction_formats::Table;
}

/// Forms of files, and how they are written.
pub use stiction_files::{
    Bundle, Error as FileError, Kept, Looks, Runs, axis, check_apart, check_folder,
    check_folder_of, check_inputs, compare_file, has_runs, looks, plan, refuse_as_log,
    reproduce_file, sha256, shell, study, visible, write_atomic,
};
/// What is being done, in the words of the terminal.
pub fn stage(stage: stiction_identify::Stage) -> &'static str {
    use stiction_identify::Stage;
    match stage {
        Stage::Tuning => "choosing cut-offs",
        Stage::Calibration => "measuring the bias",
        Stage::Counts => "asking the encoder counts",
        Stage::Search => "searching",
        Stage::Scan => "scanning the box",
        Stage::Coarse => "first descents",
        Stage::Fine | Stage::Finish => "least squares",
        Stage::CrossValidation => "comparing laws",
        Stage::Recording => "recording",
        Stage::Logs { .. } => "identifying",
        Stage::Experiments { .. } => "simulating",
    }
}

/// How well a model fits; the reversal that shows most of presliding.
pub use stiction_identify::Fit as Quality;
/// Integration steps of a simulated candidate.
pub use stiction_identify::candidates::Scheme;
/// Numbers as people read them.
pub use stiction_number as number;
/// Reports, and text for a terminal.
pub use stiction_pages::{report, text};
/// Searches beside each other.
pub use stiction_workflows::compare::{
    CompareOptions, Comparison, Cost, Excitation, Input, ONE_START, compare,
};
/// An identification from paths.
pub use stiction_workflows::identify::{Files, Outcome, Simulated, identify};
pub use stiction_workflows::identify::{presliding_length, slowest_turn};
/// Forms in which a controller takes a planned motion, and how well a parameter is to be known.
pub use stiction_workflows::plan::{Carrier, Want};
/// A planned motion, from an axis file.
pub use stiction_workflows::plan::{
    Known, PLANNED, PlanOptions, Planned, limits_to_fill_in, plan as plan_motion,
};
/// Logs with the files they came from.
pub use stiction_workflows::source::{Source, load, table};
/// Exported C beside the compensator of a study's model; runs of a study that are kept as they are done.
pub use stiction_workflows::study::{ExportedC, compare_exported, keep, simulate_keeping};
/// A short simulation of a study with other parameters, while somebody waits.
pub mod trial {
    pub use stiction_files::study::{Knob, Range};
    pub use stiction_workflows::study::{NotTried, Tried, TriedRun, Which, trial};
}
/// A run on a contour, and how its deviations are drawn.
pub mod contour {
    pub use stiction_workflows::study::{ContourTrace, Line, Plane};
}
/// How an error names options.
pub use stiction_workflows::{Part, Setting, Wording};
/// Further workflows, and what an outcome is worth.
pub use stiction_workflows::{check, demo, export, reproduce, verdict};
