//! What an axis file states and a log contradicts.

use crate::common::identified::identified;
use stiction_files::Axis;
use stiction_testkit::gate;
use stiction_testkit::worlds::{Machine, Motion, World, record};
use stiction_workflows::identify::Options;

const SEED: u64 = 1;

/// A stated mass that is not the true one is named, with the true one inside of what is said, and nothing else is blamed for the inertia
/// that is missing or too much; a true one is not, whatever else is wrong.
#[test]
fn a_wrong_mass_in_the_axis_file_is_named() {
    let cases = [
        ("stage", Motion::Commissioning, World::Faithful, 0.5),
        ("joint", Motion::Sine, World::Faithful, 2.0),
        ("screw", Motion::Commissioning, World::Filtered(3e-3), 1.0),
        ("joint", Motion::Commissioning, World::Faithful, 1.0),
        ("screw", Motion::Trapezoid, World::Faithful, 0.5),
        ("joint", Motion::Trapezoid, World::Faithful, 0.8),
        ("stage", Motion::Sine, World::ResonanceAtMotor, 1.0),
        ("joint", Motion::Trapezoid, World::Late(10), 1.0),
    ];
    let others = [
        "resonance",
        "backlash",
        "law-shape",
        "force-filtered",
        "force-late",
        "motion-late",
        "delay-out-of-range",
    ];
    for (name, motion, world, factor) in gate(2, cases) {
        let mut machines = Machine::all(SEED).into_iter();
        let machine = machines.find(|(own, _)| *own == name).unwrap().1;
        let unit = if machine.kind == "rotary" {
            "kg m2"
        } else {
            "kg"
        };
        let file = format!("mass = \"{} {unit}\"\n", factor * machine.mass);
        let log = record(&machine, motion, world, SEED);
        let axis = Axis::parse(&file).unwrap();
        let fit = identified(&machine, &[log], &axis, &Options::default()).unwrap();
        let mut warnings = fit.warnings().iter();
        let found = warnings.find(|w| w.code.as_str() == "mass-disagrees");
        let found = found.map(|w| w.message.clone());
        if factor == 1.0 {
            assert_eq!(found, None, "{name}, {motion:?}, {world:?}");
            continue;
        }
        let message = found.unwrap_or_else(|| panic!("{name}: {:#?}", fit.warnings()));
        let between = message.split(['(', ')']).nth(1).unwrap();
        let (low, high) = between.split_once(" to ").unwrap();
        let [low, high]: [f64; 2] = [low, high].map(|x| x.parse().unwrap());
        // An interval of 95 %, with some room for the other seeds that this one might have been.
        let room = 0.5 * (high - low);
        let inside = (low - room..high + room).contains(&machine.mass);
        assert!(inside && high < 1.1 * low, "{name}: {message}");
        let trust = &fit.result().trust;
        assert!(
            !trust.trustworthy && trust.constants.is_empty(),
            "{trust:#?}"
        );
        assert!(trust.reasons[0] == message, "{trust:#?}");
        let codes = fit.warnings().iter().map(|w| w.code.as_str());
        let blamed: Vec<&str> = codes.filter(|code| others.contains(code)).collect();
        assert_eq!(blamed, [""; 0], "{name}, {motion:?}");
    }
}

/// A stated delay that is not the true one is named, with the true one near what is said; a true one is not, whatever else is wrong.
#[test]
fn a_wrong_delay_in_the_axis_file_is_named() {
    // Each with the samples by which the stated delay is beside the true one.
    let cases = [
        ("stage", Motion::Commissioning, World::Faithful, 4.0),
        ("screw", Motion::Commissioning, World::Late(1), -1.0),
        ("joint", Motion::Commissioning, World::Faithful, 0.0),
        ("screw", Motion::Commissioning, World::Backlash, 0.0),
        ("stage", Motion::Trapezoid, World::Faithful, -2.0),
        ("screw", Motion::Trapezoid, World::Faithful, 2.0),
        ("joint", Motion::Commissioning, World::Faithful, 1.0),
        ("joint", Motion::Sine, World::Faithful, -3.0),
        ("stage", Motion::Trapezoid, World::Late(1), 0.0),
        ("stage", Motion::Sine, World::ResonanceAtMotor, 0.0),
        ("joint", Motion::Commissioning, World::MaxwellSlip, 0.0),
        ("screw", Motion::Trapezoid, World::Exponent, 0.0),
    ];
    for (name, motion, world, beside) in gate(2, cases) {
        let mut machines = Machine::all(SEED).into_iter();
        let machine = machines.find(|(own, _)| *own == name).unwrap().1;
        let log = record(&machine, motion, world, SEED);
        let step = log.time[1] - log.time[0];
        let late = if world == World::Late(1) { 1.0 } else { 0.0 };
        // A command is held from its sample to the next.
        let truth = 1e3 * step * (late - 0.5);
        let file = format!("[terms]\ndelay = \"{} ms\"\n", truth + 1e3 * step * beside);
        let axis = Axis::parse(&file).unwrap();
        let fit = identified(&machine, &[log], &axis, &Options::default()).unwrap();
        let mut warnings = fit.warnings().iter();
        let found = warnings.find(|w| w.code.as_str() == "delay-disagrees");
        let found = found.map(|w| w.message.clone());
        if beside == 0.0 {
            assert_eq!(found, None, "{name}, {motion:?}, {world:?}");
            continue;
        }
        let message = found.unwrap_or_else(|| panic!("{name}: {:#?}", fit.warnings()));
        let shown = message.split("the log shows ").nth(1).unwrap();
        let shown: f64 = shown.split(' ').next().unwrap().parse().unwrap();
        let off = (shown - truth).abs() / (1e3 * step);
        assert!(
            off < 0.25,
            "{name}, {motion:?}: {off:.2} samples: {message}"
        );
        let trust = &fit.result().trust;
        assert!(
            !trust.trustworthy && trust.constants.is_empty(),
            "{trust:#?}"
        );
        assert!(trust.reasons[0] == message, "{trust:#?}");
    }
}

/// A stated Stribeck exponent that is not the true one is named with the true one; a true one is not.
#[test]
fn a_wrong_exponent_in_the_axis_file_is_named() {
    let cases = [
        ("screw", Motion::Commissioning, World::Faithful, 4.0),
        ("joint", Motion::Commissioning, World::Faithful, 2.0),
        ("stage", Motion::Commissioning, World::Faithful, 10.0),
        ("joint", Motion::Commissioning, World::Faithful, 1.0),
        ("stage", Motion::Trapezoid, World::Faithful, 2.0),
    ];
    for (name, motion, world, stated) in gate(2, cases) {
        let mut machines = Machine::all(SEED).into_iter();
        let machine = machines.find(|(own, _)| *own == name).unwrap().1;
        let truth = 2.0;
        let log = record(&machine, motion, world, SEED);
        let axis = Axis::parse(&format!("[terms]\nstribeck_exponent = {stated}\n")).unwrap();
        let fit = identified(&machine, &[log], &axis, &Options::default()).unwrap();
        let mut warnings = fit.warnings().iter();
        let found = warnings.find(|w| w.code.as_str() == "exponent-disagrees");
        let found = found.map(|w| w.message.clone());
        if stated == truth {
            assert_eq!(found, None, "{name}, {motion:?}, {world:?}");
            continue;
        }
        let message = found.unwrap_or_else(|| panic!("{name}: {:#?}", fit.warnings()));
        let shown = message.split("the log shows ").nth(1).unwrap();
        let shown: f64 = shown.split(' ').next().unwrap().parse().unwrap();
        assert!((shown / truth - 1.0).abs() < 0.2, "{name}: {message}");
        assert!(!fit.result().trust.trustworthy, "{name}");
    }
}
