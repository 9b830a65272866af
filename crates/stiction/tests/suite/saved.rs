//! A fit that is read from its folder is the fit that was written there.

use crate::common::Bench;
use stiction::{
    Axis, LawKind, Log, Options, SavedFit, Silent, check, fit_columns, identify, identify_files,
};

fn stribeck() -> Options {
    let mut options = Options::default();
    (options.law, options.compare_laws) = (Some(LawKind::Stribeck), false);
    options
}

#[test]
fn a_folder_gives_back_what_was_written() {
    let bench = Bench::new();
    let log = Log::open(bench.good("a.csv", 1)).unwrap();
    let fit = identify(&[log], &Axis::default(), &stribeck()).unwrap();
    let (folder, other) = (bench.path("fit"), bench.path("other"));
    fit.write(&folder).unwrap();

    let saved = SavedFit::read(&folder).unwrap();
    assert_eq!(saved.model(), &fit.model());
    assert_eq!(saved.law().unwrap().unwrap(), fit.law().unwrap());
    let mut series = saved.series().unwrap().into_iter();
    let residual = series.find(|column| column.name == "residual").unwrap();
    assert_eq!(residual.unit.as_deref(), Some("N"));
    assert_eq!(residual.values, fit.series().residual());

    saved.write(&other).unwrap();
    for file in std::fs::read_dir(&folder).unwrap() {
        let file = file.unwrap();
        let again = std::fs::read(other.join(file.file_name())).unwrap();
        assert_eq!(again, std::fs::read(file.path()).unwrap(), "{file:?}");
    }
}

#[test]
fn a_folder_that_is_none_is_refused_by_file() {
    let bench = Bench::new();
    let log = Log::open(bench.good("a.csv", 1)).unwrap();
    let fit = identify(&[log], &Axis::default(), &stribeck()).unwrap();
    let folder = bench.path("fit");
    fit.write(&folder).unwrap();
    let result = folder.join("result.json");
    for damaged in [
        "",
        "{}",
        "[1",
        "{\"schema\": \"stiction.result/9\"}",
        "{\"schema\": 1}",
    ] {
        std::fs::write(&result, damaged).unwrap();
        let refused = SavedFit::read(&folder).unwrap_err();
        assert_eq!(refused.code().as_str(), "bad-config");
        assert!(refused.to_string().contains("result.json"), "{refused}");
    }
    std::fs::remove_file(&result).unwrap();
    assert!(SavedFit::read(&folder).is_err());
    for text in [
        "",
        "time [s],residual [N]\n1,x\n",
        "time [s],residual [N]\n1\n",
    ] {
        let none =
            fit_columns(text).is_none_or(|columns| columns.iter().all(|c| c.values.is_empty()));
        assert!(none, "{text:?}");
    }
}

#[test]
fn logs_in_memory_are_checked_and_identified_as_files_are() {
    let bench = Bench::new();
    let path = bench.good("a.csv", 1);
    let log = Log::open(&path).unwrap();
    let axis = Axis::default();
    let mut silent = Silent;
    let of_file =
        stiction::commands::check::check(std::slice::from_ref(&path), None, &mut silent).unwrap();
    let of_log = check(std::slice::from_ref(&log), &axis, &mut silent).unwrap();
    let json = |found: &_| serde_json::to_value(found).unwrap();
    assert_eq!(json(&of_log), json(&of_file));

    let files = stiction::Files {
        logs: vec![path],
        ..Default::default()
    };
    let of_file = identify_files(&files, &stribeck(), &mut silent).unwrap();
    let of_log = identify(&[log], &axis, &stribeck()).unwrap();
    assert_eq!(of_file.model().to_toml(), of_log.model().to_toml());
}
