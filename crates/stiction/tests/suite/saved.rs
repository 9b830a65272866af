//! A fit that is read from its folder is the fit that was written there.

use crate::common::Bench;
use stiction::{Fit, Identification, LawKind, Log, Recording, SavedFit};
use stiction_pages::bundle::fit_columns;

fn stribeck<'a>(log: impl Into<Recording<'a>>) -> Fit {
    let asked = Identification::of([log]).law(LawKind::Stribeck);
    asked.without_comparison().run().unwrap()
}

#[test]
fn a_folder_gives_back_what_was_written() {
    let bench = Bench::new();
    let log = Log::open(bench.good("a.csv", 1)).unwrap();
    let fit = stribeck(&log);
    let (folder, other) = (bench.path("fit"), bench.path("other"));
    fit.write(&folder).unwrap();

    let saved = SavedFit::read(&folder).unwrap();
    assert_eq!(saved.model(), fit.model());
    assert_eq!(saved.law().unwrap(), fit.law().unwrap());
    assert_eq!(saved.result(), fit.result());
    assert!(saved.parameters().eq(fit.parameters()));
    let written = stiction_pages::SavedFit::read(&folder).unwrap();
    let mut series = written.series().unwrap().into_iter();
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
    let fit = stribeck(&log);
    let folder = bench.path("fit");
    fit.write(&folder).unwrap();
    let result = folder.join("result.json");
    let whole = std::fs::read_to_string(&result).unwrap();
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
    // Changed by hand.
    for (from, to) in [
        ("\"seed\": 0", "\"seed\": \"0\""),
        ("\"seed\": 0", "\"seed\": -1"),
        ("\"law\": \"stribeck\"", "\"law\": \"glue\""),
    ] {
        let changed = whole.replacen(from, to, 1);
        assert_ne!(changed, whole, "{from}");
        std::fs::write(&result, changed).unwrap();
        let refused = SavedFit::read(&folder).unwrap_err();
        assert!(refused.place().contains("result.json: "), "{refused}");
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
    let of_file = Identification::of([&path]).check().unwrap();
    let of_log = Identification::of([&log]).check().unwrap();
    assert_eq!(of_log.result(), of_file.result());

    let of_file = stribeck(&path);
    assert_eq!(of_file.model().to_toml(), stribeck(&log).model().to_toml());
}
