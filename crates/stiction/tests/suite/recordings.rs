//! What must hold on measured recordings.

use crate::measure;
use stiction_files::ModelFile;
use stiction_testkit::{CASES, Case, DEFAULT_RUNS, recordings};
use stiction_workflows::export::{ExportOptions, Target, export};

#[test]
fn every_limit_holds() {
    limits_hold(|case| !is_long(case));
}

#[test]
#[ignore = "soak: LuGre simulated on whole recordings, a minute and a half"]
fn every_limit_of_simulated_bristles_holds() {
    limits_hold(is_long);
}

fn is_long(case: &Case) -> bool {
    (case.method, case.law) == ("output-error", "lugre")
}

fn limits_hold(wanted: impl Fn(&Case) -> bool) {
    let Some(data) = recordings() else {
        return;
    };
    let mut broken = Vec::new();
    for case in CASES.iter().filter(|case| wanted(case)) {
        let outcome = measure::run(case, &data);
        for limit in case.limits {
            let found = measure::measure(case, limit, &outcome, &data);
            let line = format!(
                "{} {}: {} = {:.5} (at most {})",
                case.name, case.law, found.what, found.value, found.most
            );
            println!("{line}");
            if !found.holds() {
                broken.push(line);
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

/// Every recording, with columns and units and no option, ends in a law that may be used and can be exported, and that
/// leaves at most a tenth more on held-out samples than the best law of the table.
#[test]
fn default_runs_end_in_code() {
    let Some(data) = recordings() else {
        return;
    };
    for run in &DEFAULT_RUNS {
        let outcome = measure::run_by_default(run, &data);
        let result = &outcome.result;
        assert!(result.trust.trustworthy, "{}: {:?}", run.name, result.trust);
        let (law, least) = measure::reported(result);
        let error = law.held_out_error_percent.unwrap();
        assert!(error <= 1.1 * least, "{}: {error} {least}", run.name);
        let model = ModelFile::from_result(result);
        let code = export(&model, &ExportOptions::new(Target::C, 1e-3)).unwrap();
        assert!(code.trustworthy, "{}: {:?}", run.name, code.warnings);
    }
}

#[test]
fn damiao_reports_its_gaps() {
    let Some(data) = recordings() else {
        return;
    };
    let axis =
        stiction_files::Axis::read(stiction_testkit::workspace().join("validation/damiao.toml"))
            .unwrap();
    let source = stiction_workflows::source::load(data.join("damiao/motor_2.npz"), &axis).unwrap();
    let longest = source
        .log
        .gaps
        .iter()
        .map(|g| g.seconds)
        .fold(0.0, f64::max);
    assert!((4.5..5.5).contains(&longest), "longest gap {longest} s");
    assert!(
        source
            .log
            .findings
            .iter()
            .any(|f| f.code().as_str() == "gap")
    );
}

/// A wrist that swings through half a turn, whose weight looks like friction that is another in each direction.
#[test]
fn a_weight_is_taken_where_friction_would_be_another_in_each_direction() {
    let Some(data) = recordings() else {
        return;
    };
    let run = DEFAULT_RUNS.iter().find(|run| run.name == "UR10e joint 4");
    let result = measure::run_by_default(run.unwrap(), &data).result;
    assert!(!result.asymmetric, "{}", result.law);
    assert!(result.parameters.iter().any(|p| p.name == "gravity_cos"));
    let said = |note: &String| note.starts_with("gravity is fitted beside friction");
    assert!(
        result.axis.conditioning.iter().any(said),
        "{:?}",
        result.axis.conditioning
    );
}
