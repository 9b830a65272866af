//! Identifies a measured recording as its case says and measures what must hold.

mod xl330;

use std::path::{Path, PathBuf};
use stiction_files::result::{LawEntry, ResultFile};
use stiction_identify::Silent;
use stiction_parameters::LawKind;
use stiction_testkit::{Case, DefaultRun, Limit, Metric, workspace};
use stiction_workflows::identify::{Files, Outcome, identify};
use stiction_workflows::identify::{Method, Options};

/// A limit with what was measured.
pub struct Measured {
    pub what: String,
    pub value: f64,
    pub most: f64,
}

impl Measured {
    pub fn holds(&self) -> bool {
        self.value <= self.most
    }
}

/// Identifies the recordings of a case below `data`.
pub fn run(case: &Case, data: &Path) -> Outcome {
    with(case, data, case.axis, case.law)
}

fn with(case: &Case, data: &Path, axis: &str, law: &str) -> Outcome {
    let made = tempfile::tempdir().expect("a temporary folder");
    let files = Files {
        logs: readable(case.logs, data, made.path()),
        axis: Some(workspace().join("validation").join(axis)),
        validate: readable(case.validate, data, made.path()),
    };
    let mut options = Options::default();
    options.law = Some(LawKind::from_name(law).expect("a law of the cases exists"));
    options.asymmetric = case.asymmetric;
    options.split = case.split;
    options.compare_laws = false;
    options.procedures.method =
        Method::from_name(case.method).expect("a method of the cases exists");
    identify(&files, &options, &mut Silent).unwrap_or_else(|e| panic!("{}: {e}", case.name))
}

/// Logs as stiction reads them: what is in a form of its own is written as a table to `made`.
fn readable(logs: &[&str], data: &Path, made: &Path) -> Vec<PathBuf> {
    let one = |log: &&str| match log.strip_prefix("xl330/") {
        None => data.join(log),
        Some(name) => {
            let path = made.join(name).with_extension("csv");
            std::fs::write(&path, xl330::table(&data.join(log))).expect("a table");
            path
        }
    };
    logs.iter().map(one).collect()
}

/// Identifies a recording with no option.
pub fn run_by_default(run: &DefaultRun, data: &Path) -> Outcome {
    let files = Files {
        logs: vec![data.join(run.log)],
        axis: Some(data.join(run.axis)),
        validate: Vec::new(),
    };
    identify(&files, &Options::default(), &mut Silent)
        .unwrap_or_else(|e| panic!("{}: {e}", run.name))
}

/// The law of a result in the table of laws, and the least held-out error of that table, percent.
pub fn reported(result: &ResultFile) -> (&LawEntry, f64) {
    // Several elements stand beside, and are not chosen from.
    let chosen = result.laws.iter().filter(|l| l.elements.is_none());
    let errors = chosen.filter_map(|l| l.held_out_error_percent);
    let least = errors.fold(f64::INFINITY, f64::min);
    let mut laws = result.laws.iter();
    (
        laws.find(|l| l.reported).expect("a law of the table"),
        least,
    )
}

/// Published errors are relative to the position as the encoder counts it.
fn rms(x: &[f64]) -> f64 {
    (x.iter().map(|x| x * x).sum::<f64>() / x.len() as f64).sqrt()
}

/// Measures one limit of a case.
pub fn measure(case: &Case, limit: &Limit, outcome: &Outcome, data: &Path) -> Measured {
    let result = &outcome.result;
    let unit = &result.fit.unit;
    let held_out = result.validation.last();
    let (what, value) = match limit.metric {
        Metric::OffPercent(name, reference) => {
            let p = result
                .parameters
                .iter()
                .find(|p| p.name == name)
                .expect("parameter");
            (
                format!("{name} {:.5} {}, off {reference} by (%)", p.value, p.unit),
                100.0 * (p.value / reference - 1.0).abs(),
            )
        }
        Metric::FitPercent => (
            "relative error (%)".into(),
            result.fit.relative_error_percent,
        ),
        Metric::HeldOutRms => (
            format!("residual on unseen data ({unit} rms)"),
            held_out.expect("validation").fit.rmse,
        ),
        Metric::HeldOutOver(axis) => {
            let other = with(case, data, axis, case.law);
            let unseen = |o: &Outcome| o.result.validation.last().expect("validation").fit.rmse;
            (
                format!(
                    "residual on unseen data over that with `{axis}` ({:.4} {unit} rms)",
                    unseen(&other)
                ),
                unseen(outcome) / unseen(&other),
            )
        }
        Metric::PositionPercent => {
            let simulation = result.simulation.as_ref().expect("a simulation");
            let position = &simulation.position;
            (
                format!(
                    "position error ({:.3e} {} rms), %",
                    position.rmse, position.unit
                ),
                100.0 * position.rmse / rms(&outcome.law().series.measured),
            )
        }
        Metric::ForcePercent => {
            let simulation = result.simulation.as_ref().expect("a simulation");
            let force = simulation.force.as_ref().expect("a closed loop");
            (
                format!("force error ({:.3} {} rms), %", force.rmse, force.unit),
                force.relative_error_percent,
            )
        }
        Metric::UnseenPosition => (
            format!("position residual on unseen runs, the largest ({unit} rms)"),
            result.validation.iter().fold(0.0, |m, v| v.fit.rmse.max(m)),
        ),
        Metric::LowSpeedOver(law) => {
            let other = with(case, data, case.axis, law);
            let slow = |o: &Outcome| o.result.low_speed.as_ref().expect("slow samples").fit.rmse;
            (low_speed_words(result, law), slow(outcome) / slow(&other))
        }
        Metric::HeldOutLowSpeedOver(law) => {
            let other = with(case, data, case.axis, law);
            let slow = |o: &Outcome| {
                let last = o.result.validation.last().expect("validation");
                last.low_speed.as_ref().expect("slow samples").fit.rmse
            };
            (low_speed_words(result, law), slow(outcome) / slow(&other))
        }
    };
    Measured {
        what,
        value,
        most: limit.most,
    }
}

fn low_speed_words(result: &stiction_files::result::ResultFile, law: &str) -> String {
    let low = result.low_speed.as_ref().expect("slow samples");
    let side = if result.asymmetric { "asymmetric " } else { "" };
    format!(
        "residual below {} {} over that of {side}{law}",
        low.bound, low.bound_unit
    )
}
