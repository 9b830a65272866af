//! A motor whose voltage or duty is logged: the same axis as from its force.

use crate::common::identified::{Fit, identified, identify};
use stiction_files::Axis;
use stiction_log::Column;
use stiction_testkit::worlds::{Machine, Motion, World, record};
use stiction_workflows::identify::Options;
use stiction_workflows::source::{Source, in_memory};

const SEED: u64 = 1;
/// N/A, ohm, V: back EMF and resistance brake the axis more than its own viscous friction.
const CONSTANT: f64 = 50.0;
const RESISTANCE: f64 = 2.0;
const SUPPLY: f64 = 320.0;

/// The machine, its log, and the voltage that the force takes at the speed of the axis, smoothed over nine counts.
fn logged() -> (Machine, stiction_testkit::worlds::Recording, Vec<f64>) {
    let mut machines = Machine::all(SEED).into_iter();
    let (_, machine) = machines.find(|(name, _)| *name == "stage").unwrap();
    let log = record(&machine, Motion::Commissioning, World::Faithful, SEED);
    let x = log.position.as_ref().unwrap();
    let last = x.len() - 1;
    let speed = |i: usize| {
        let (a, b) = (i.saturating_sub(4), (i + 4).min(last));
        (x[b] - x[a]) / (log.time[b] - log.time[a])
    };
    let volts = log.force.iter().enumerate();
    let volts = volts.map(|(i, f)| RESISTANCE / CONSTANT * f + CONSTANT * speed(i));
    let volts = volts.collect();
    (machine, log, volts)
}

/// The log with this column in the place of its force.
fn with(
    log: &stiction_testkit::worlds::Recording,
    (unit, values): (&str, &[f64]),
    axis: &Axis,
) -> Result<Source, stiction_workflows::Error> {
    let of = |name: &str, unit: &str, values: &[f64]| Column {
        name: name.into(),
        unit: Some(unit.into()),
        values: values.to_vec(),
        ..Column::default()
    };
    let columns = vec![
        of("time", "s", &log.time),
        of("position", "m", log.position.as_ref().unwrap()),
        of("force", unit, values),
    ];
    in_memory("log.csv", columns, axis)
}

fn fitted(log: &stiction_testkit::worlds::Recording, column: (&str, &[f64]), axis: &str) -> Fit {
    let axis = Axis::parse(axis).unwrap();
    let log = with(log, column, &axis).unwrap();
    identify(&[log], &axis, &Options::default()).unwrap()
}

#[test]
fn a_voltage_and_a_duty_tell_what_the_force_tells() {
    let (machine, log, volts) = logged();
    let force = identified(
        &machine,
        std::slice::from_ref(&log),
        &Axis::default(),
        &Options::default(),
    );
    let force = force.unwrap();
    let drive = "[drive]\nforce_constant = \"50 N/A\"\nresistance = \"2 ohm\"\n";
    let duty: Vec<f64> = volts.iter().map(|u| u / SUPPLY).collect();
    let cases = [
        fitted(&log, ("V", &volts), drive),
        fitted(&log, ("1", &duty), &format!("{drive}supply = \"320 V\"\n")),
    ];
    for fit in &cases {
        for name in [
            "sigma0",
            "sigma2",
            "coulomb",
            "static",
            "stribeck_velocity",
            "mass",
        ] {
            let (own, of_force) = (fit.parameter(name).unwrap(), force.parameter(name).unwrap());
            let (low, high) = of_force.interval().unwrap();
            let off = (own.value() - of_force.value()).abs();
            assert!(
                off < 0.5 * (high - low),
                "{name}: {} {}",
                own.value(),
                of_force.value()
            );
            assert_eq!(own.unit(), of_force.unit(), "{name}");
        }
    }
    // Taken for a force by a scale, the voltage of the motor itself is viscous friction.
    let scaled = "[columns]\nforce = { column = \"force\", scale = \"25 N/V\" }\n";
    let scaled = fitted(&log, ("V", &volts), scaled);
    let sigma2 = |fit: &Fit| fit.parameter("sigma2").unwrap().value();
    let braked = CONSTANT * CONSTANT / RESISTANCE;
    let off = sigma2(&scaled) - sigma2(&force) - braked;
    assert!(off.abs() < 0.02 * braked, "{off}");
}

#[test]
fn a_drive_that_does_not_go_with_its_log_is_refused() {
    let (_, log, volts) = logged();
    let refused = |unit: &str, axis: &str| {
        let axis = Axis::parse(axis).unwrap();
        let refused = with(&log, (unit, &volts), &axis);
        refused.unwrap_err().to_string()
    };
    insta::assert_snapshot!([
        refused("V", "[drive]\nforce_constant = \"50 N/A\"\n"),
        refused("1", "[drive]\nforce_constant = \"50 N/A\"\nresistance = \"2 ohm\"\n"),
        refused("N", "[drive]\nforce_constant = \"50 N/A\"\n"),
        refused("V", "[drive]\nforce_constant = \"50 N m/A\"\nresistance = \"2 ohm\"\n"),
        refused("V", "[log]\nforce_limit = \"10 V\"\n[drive]\nforce_constant = \"50 N/A\"\nresistance = \"2 ohm\"\n"),
    ]
    .join("\n\n"));
}
