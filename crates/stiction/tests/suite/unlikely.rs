//! Units that make an axis which nobody can have built.

use crate::common::{Bench, options};
use stiction_codes::Code;
use stiction_identify::Silent;
use stiction_parameters::LawKind;
use stiction_testkit::worlds::{Machine, Motion, World, record};
use stiction_workflows::identify::Outcome;

/// A log of an axis whose header says another unit.
fn identified(bench: &Bench, axis: &str, unit: [&str; 2], columns: &str) -> Outcome {
    let mut machines = Machine::all(1).into_iter();
    let (_, machine) = machines.find(|(name, _)| *name == axis).unwrap();
    let log = record(&machine, Motion::Commissioning, World::Faithful, 1);
    let text = log.to_csv(machine.kind).replacen(unit[0], unit[1], 1);
    let log = bench.write("log.csv", &text);
    let mut asked = options(&[&log], LawKind::LuGre);
    if !columns.is_empty() {
        asked.files.axis = Some(bench.write("axis.toml", columns));
    }
    asked.identify(&mut Silent).unwrap()
}

#[test]
fn an_axis_that_nobody_can_build_names_the_unit() {
    let bench = Bench::new();
    let unit = ["position [m]", "position [mm]"];
    let line = "position = { column = \"position\", unit = \"m\" }";
    for axis in ["stage", "screw"] {
        let found = identified(&bench, axis, unit, "");
        let trust = &found.result.trust;
        assert!(!trust.trustworthy, "{axis}");
        assert!(trust.constants.is_empty(), "{:?}", trust.constants);
        let mut warnings = found.result.warnings.iter();
        let own = warnings.find(|w| w.code == Code::UnlikelySize).unwrap();
        assert!(own.message.contains(line), "{}", own.message);
        assert!(trust.reasons.contains(&own.message.to_string()));
        // With the line that it names all is well.
        let right = identified(&bench, axis, unit, &format!("[columns]\n{line}\n"));
        let trust = &right.result.trust;
        assert!(trust.trustworthy, "{:?}", trust.reasons);
        assert!(!trust.constants.is_empty());
    }
}
