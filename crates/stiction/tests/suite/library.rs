//! What the library says to a program: its own names, no options of a command, no files that are none.

use crate::common::Bench;
use stiction_files::{Axis, ModelFile};
use stiction_identify::Silent;
use stiction_parameters::LawKind;
use stiction_workflows::Error;
use stiction_workflows::export::{ExportOptions, Target, export};
use stiction_workflows::identify::identify_logs;
use stiction_workflows::identify::{CostKind, Method, Options};
use stiction_workflows::source::{Source, load};

fn said(options: &Options, logs: &[Source], validate: &[Source]) -> String {
    let error = identify_logs(
        options,
        &Axis::default(),
        logs.to_vec(),
        validate.to_vec(),
        &mut Silent,
    )
    .unwrap_err();
    assert_eq!(error.code().as_str(), "usage");
    error.to_string()
}

#[test]
fn options_are_named_as_fields() {
    let bench = Bench::new();
    let logs = [load(bench.good("a.csv", 1), &Axis::default()).unwrap()];
    let other = [load(bench.good("b.csv", 2), &Axis::default()).unwrap()];
    let with = |change: fn(&mut Options)| {
        let mut options = Options::default();
        change(&mut options);
        options
    };
    let mut found = vec![
        said(&with(|o| (o.law, o.asymmetric) = (None, true)), &logs, &[]),
        said(&with(|o| o.split = Some(2.0)), &logs, &[]),
        said(&with(|o| o.split = Some(1e-9)), &logs, &[]),
        said(
            &with(|o| o.searching.cost = Some(CostKind::Six)),
            &logs,
            &[],
        ),
    ];
    // Logs to validate on are of no use to a static map, and are not passed over.
    let statics = with(|o| {
        (o.law, o.procedures.method) = (Some(LawKind::Stribeck), Method::Static);
    });
    found.push(said(&statics, &logs, &other));
    let refused = identify_logs(
        &Options::default(),
        &Axis::default(),
        vec![],
        vec![],
        &mut Silent,
    )
    .unwrap_err();
    found.push(refused.to_string());
    insta::assert_snapshot!(found.join("\n"));
}

#[test]
fn a_model_in_memory_has_keys_and_no_lines() {
    let bench = Bench::new();
    let outcome = crate::common::options(&[&bench.good("a.csv", 1)], LawKind::Stribeck)
        .identify(&mut stiction_identify::Silent)
        .unwrap();
    let good = ModelFile::from_result(&outcome.result);
    let options = ExportOptions::new(Target::C, 1e-3);
    let refused = |change: &dyn Fn(&mut ModelFile)| {
        let mut model = good.clone();
        change(&mut model);
        export(&model, &options).unwrap_err().to_string()
    };
    let position = good.parameter.iter().position(|p| p.name == "coulomb");
    let coulomb = position.unwrap();
    let found = [
        refused(&|m| m.parameter[coulomb].value = -1.0),
        refused(&|m| m.parameter[coulomb].value = 1e20),
        refused(&|m| m.law = "gms".into()),
        refused(&|m| m.parameter[coulomb].name = "coulomb_load".into()),
    ];
    let place = format!(
        "model: parameter[{}].value: coulomb = -1.000; ",
        coulomb + 1
    );
    assert!(found[0].starts_with(&place), "{}", found[0]);
    for message in &found {
        assert!(message.starts_with("model: "), "{message}");
        assert!(
            !message.contains("line ") && !message.contains(".toml"),
            "{message}"
        );
    }
    let refused = compensator(&good, -1.0);
    assert_eq!(refused, "cycle time -1 s; allowed: 0.000001 s to 0.1 s");
}

fn compensator(model: &ModelFile, cycle_time: f64) -> String {
    let options = ExportOptions::new(Target::Rust, cycle_time);
    let refused: Result<_, Error> = stiction_workflows::export::compensator(model, &options);
    refused.unwrap_err().to_string()
}

#[test]
fn a_folder_that_is_taken_is_refused_without_options() {
    let bench = Bench::new();
    bench.write("mine.txt", "mine");
    let error = stiction_files::check_folder(bench.dir(), false).unwrap_err();
    let message = error.to_string();
    assert!(!message.contains("--"), "{message}");
    assert!(message.contains("choose another folder"), "{message}");
}
