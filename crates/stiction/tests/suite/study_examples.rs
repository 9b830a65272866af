//! The examples of studies, run: what they are there to show.

use stiction_files::study::Study;
use stiction_files::study::result::ResultRow;
use stiction_identify::Silent;
use stiction_workflows::study::StudyOutcome;

fn example(name: &str) -> StudyOutcome {
    let folder = stiction_testkit::workspace().join("examples/stage");
    let outcome =
        stiction_workflows::study::simulate(&Study::read(folder.join(name)).unwrap(), &mut Silent);
    assert_eq!(outcome.file.status, "complete");
    let warnings = &outcome.file.warnings;
    assert!(warnings.is_empty(), "{warnings:?}");
    let html =
        String::from_utf8(stiction_pages::bundle::study(&outcome).files()[0].1.clone()).unwrap();
    stiction_testkit::assert_tables_fit(&html);
    outcome
}

/// Three controllers, none and four compensators, on every kind of motion, on contours with coupling too. LuGre leaves the
/// least everywhere: the axes follow that law.
#[test]
fn every_controller_and_compensation_on_every_motion() {
    let file = example("comparison.toml").file;
    let kinds = [
        "sine",
        "chirp",
        "move",
        "staircase",
        "constant-velocity",
        "crawl",
        "hold",
        "excitation",
        "circle",
        "corner",
    ];
    for kind in kinds {
        assert!(file.paths.iter().any(|path| path.kind == kind), "{kind}");
    }
    let names = ["none", "Coulomb", "Stribeck", "simplified", "LuGre"];
    let mut compared = 0;
    for path in &file.paths {
        for controller in ["PID", "fuzzy PID", "cascade"] {
            for coupled in [false, true] {
                let of = |r: &&ResultRow| {
                    (&r.path, r.controller.as_str(), r.coupled) == (&path.name, controller, coupled)
                };
                let rows: Vec<&ResultRow> = file.results.iter().filter(of).collect();
                let contour = ["circle", "corner"].contains(&path.kind.as_str());
                if coupled && !contour {
                    assert!(rows.is_empty());
                    continue;
                }
                let found: Vec<&str> = rows.iter().map(|r| r.compensator.as_str()).collect();
                assert_eq!(found, names);
                let metric = if contour {
                    "contour_peak"
                } else {
                    "peak_error"
                };
                let peak = |row: &ResultRow| row.metric(metric).unwrap().mean;
                for row in &rows[..4] {
                    let name = &row.compensator;
                    assert!(
                        peak(rows[4]) < peak(row),
                        "{}, {controller}: {name}",
                        path.name
                    );
                }
                compared += 1;
            }
        }
    }
    // Ten paths and two contours, these twice.
    assert_eq!(compared, (10 + 2 * 2) * 3);
}

/// Stiffer bristles, larger and faster motion: more error without compensation; and a load that is found.
#[test]
fn influences_and_a_load() {
    let outcome = example("influence.toml");
    let keys: Vec<&str> = outcome.file.sweeps.iter().map(|s| s.key.as_str()).collect();
    assert_eq!(
        keys,
        [
            "law.sigma0",
            "path.amplitude",
            "path.frequency",
            "event.friction"
        ]
    );
    for sweep in &outcome.file.sweeps[1..] {
        let none = sweep.results.iter().find(|r| r.compensator == "none");
        let errors = &none.unwrap().metric("peak_error").unwrap().values;
        assert!(
            errors.windows(2).all(|pair| pair[0] < pair[1]),
            "{}: {errors:?}",
            sweep.key
        );
    }
    let found = outcome
        .traces
        .iter()
        .find(|t| t.compensator == "LuGre, load estimate");
    let load = found.unwrap().load.as_ref().unwrap();
    let last = *load.found_mass.last().unwrap();
    assert!((last / 6.9 - 1.0).abs() < 0.02, "{last}");
}
