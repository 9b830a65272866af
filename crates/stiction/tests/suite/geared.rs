//! Friction that grows with what a gear transmits: from columns of a log to parameters in files and inputs of the code.

use crate::common::{Asked, Bench, options};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use stiction_files::ModelFile;
use stiction_files::result::ParameterEntry;
use stiction_identify::Silent;
use stiction_parameters::LawKind;
use stiction_testkit::geared::Geared;
use stiction_workflows::export::{ExportOptions, Target, export};
use stiction_workflows::identify::Outcome;

/// A joint with a bristle, whose load a model of the robot says in a column of its own.
fn joint() -> Geared {
    Geared {
        per_torque: [0.15, 0.08],
        external: 1.0,
        stribeck: (1.5, 0.3),
        bristle: Some((400.0, 0.3)),
        ..Geared::default()
    }
}

fn log(bench: &Bench, name: &str, seed: u64) -> PathBuf {
    let recording = joint().record(12.0, seed);
    let mut text = String::from("Time [s],Position [rad],Motor torque [N m],Model [N m]\n");
    for i in 0..recording.time.len() {
        let _ = writeln!(
            text,
            "{:.4},{:.6},{:.5},{:.6}",
            recording.time[i], recording.position[i], recording.torque[i], recording.load[i]
        );
    }
    bench.write(name, &text)
}

const COLUMNS: &str = "[columns]\nposition = \"Position\"\nforce = \"Motor torque\"\n";
const EXTERNAL: &str = "external = { column = \"Model\", invert = true }\n";

fn asked(bench: &Bench, log: &Path, axis: &str) -> Asked {
    let mut options = options(&[log], LawKind::LuGre);
    options.files.axis = Some(bench.write("axis.toml", axis));
    options
}

fn parameter<'a>(outcome: &'a Outcome, name: &str) -> &'a ParameterEntry {
    let mut all = outcome.result.parameters.iter();
    all.find(|p| p.name == name).unwrap()
}

#[test]
fn what_a_gear_transmits_reaches_every_file() {
    let bench = Bench::new();
    let (file, other) = (log(&bench, "log.csv", 1), log(&bench, "other.csv", 2));
    let run = |terms: &str| {
        let mut asked = asked(&bench, &file, &format!("{COLUMNS}{EXTERNAL}{terms}"));
        asked.files.validate = vec![other.clone()];
        asked.identify(&mut Silent).unwrap()
    };
    let with = run("[terms]\ncoulomb_transmitted = true\ncoulomb_driven = true\n");
    let reference = parameter(&with, "transmitted_reference");
    assert_eq!(
        (reference.origin.name(), reference.unit.as_str()),
        ("given", "N*m")
    );
    for (name, truth) in [
        ("coulomb", 0.3 + 0.15 * reference.value),
        ("coulomb_transmitted", 0.15),
        ("coulomb_driven", 0.08 - 0.15),
    ] {
        let p = parameter(&with, name);
        // How often intervals hold the truth is counted in the tests of `stiction-identify`.
        let deviation = p.std.unwrap();
        assert!(
            (p.value - truth).abs() < 3.0 * deviation && p.identifiable,
            "{name}: {p:?}"
        );
        assert!((p.value / truth - 1.0).abs() < 0.03, "{name}: {p:?}");
    }
    // The other motion is explained as well, and without the terms it is not.
    let unseen = |outcome: &Outcome| outcome.result.validation[0].fit.relative_error_percent;
    let [with_it, without] = [&with, &run("")].map(unseen);
    assert!(with_it < 2.0 && without > 15.0, "{with_it} {without}");

    let [least, largest] = with.result.range.transmitted.unwrap();
    assert!(
        (0.0..0.1).contains(&least) && (3.0..7.0).contains(&largest),
        "{least} {largest}"
    );
    let bundle = stiction_pages::bundle::identification(&with);
    let text = |wanted: &str| {
        let mut files = bundle.files().iter();
        let (_, bytes) = files.find(|(name, _)| *name == wanted).unwrap();
        String::from_utf8(bytes.to_vec()).unwrap()
    };
    let report = text("report.html");
    stiction_testkit::assert_tables_fit(&report);
    assert!(report.contains("Coulomb friction per transmitted"));
    // It is an input of the code, of either sign, within what was seen.
    let model = ModelFile::parse(&text("model.toml")).unwrap();
    assert_eq!(model.range.transmitted, Some([least, largest]));
    let code = export(&model, &ExportOptions::new(Target::C, 1e-3)).unwrap();
    assert!(
        code.warnings
            .iter()
            .all(|w| !w.message.contains("coulomb_")),
        "{:?}",
        code.warnings
    );
    let header = code
        .files
        .iter()
        .find(|f| f.path.ends_with("friction.h"))
        .unwrap();
    let header = String::from_utf8(header.bytes.clone()).unwrap();
    assert!(
        header.contains("transmitted: the weight and what else the load asks of the motor"),
        "{header}"
    );
    // Where the target has no inputs, the friction of the mean is exported, and said to be that.
    let table = export(&model, &ExportOptions::new(Target::Mujoco, 1e-3)).unwrap();
    let said = table
        .warnings
        .iter()
        .map(|w| w.message.as_str())
        .collect::<Vec<_>>()
        .join("\n");
    assert!(
        said.contains("coulomb_transmitted = ") && said.contains("is transmitted"),
        "{said}"
    );
}

/// The words for what is missing or does not fit.
#[test]
fn what_is_refused_of_a_gear() {
    let bench = Bench::new();
    let file = log(&bench, "log.csv", 1);
    let said = |axis: &str| {
        let error = asked(&bench, &file, axis)
            .identify(&mut Silent)
            .unwrap_err();
        format!("{} [{}]\n", bench.plain(&error.to_string()), error.code())
    };
    let term = "[terms]\ncoulomb_transmitted = true\n";
    let scaled = EXTERNAL.replace("invert", "scale = \"2 A/(N m)\", invert");
    let text = [
        said(&format!("{COLUMNS}{term}")),
        said(&format!("{COLUMNS}{scaled}{term}")),
        said(&format!("{COLUMNS}external = \"Load\"\n{term}")),
        said(&format!("{COLUMNS}external = \"Position\"\n{term}")),
    ];
    insta::assert_snapshot!(text.concat());
}
