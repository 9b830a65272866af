//! The forces on the axis of a study beside friction, against closed forms: friction is a millionth of them, and the
//! controller a stiffness and a damper.

use crate::study::{AXIS, CASCADE, Desk, SHORT, WHOLE, row, together};
use std::f64::consts::TAU;
use stiction_files::study::result::StudyFile;

pub(crate) const FRICTIONLESS: &str = r#"
[axis]
parameters = { sigma0 = "1 N/m", sigma1 = "0 N s/m", sigma2 = "0 N s/m", coulomb = "1 uN", static = "1 uN", stribeck_velocity = "1 mm/s" }
mass  = "4.6 kg"
rate  = "10 kHz"
delay = "0 s"
"#;

/// kg, N s/m and N/m of the loop below.
const MASS: f64 = 4.6;
const DAMPER: f64 = 920.0;
pub(crate) const STIFFNESS: f64 = 920.0 * 50.0;
pub(crate) const LOOP: &str = r#"
[[controller]]
kind          = "cascade"
position_gain = "50 1/s"
speed_gain    = "920 N s/m"
integral_gain = "0 N/m"
force_limit   = "1 kN"
"#;

/// There, and a second of rest at 10 mm, which ends the run.
pub(crate) const REST: &str = r#"
[[path]]
kind = "file"
file = "rest.csv"
skip = "2 s"
"#;

const GLIDE: &str = r#"
[[path]]
kind         = "constant-velocity"
hold         = "1 s"
velocity     = "50 mm/s"
acceleration = "5 m/s2"
jerk         = "500 m/s3"
"#;

pub(crate) fn desk() -> Desk {
    let desk = Desk::new();
    desk.write(
        "rest.csv",
        "t [s],x [mm]\n0,0\n0.5,5\n1,10\n1.5,10\n2,10\n2.5,10\n",
    );
    desk
}

fn largest(file: &StudyFile) -> f64 {
    // Motors on a voltage are braked by their own.
    let braked = file.warnings.iter().all(|w| w.code.as_str() == "back-emf");
    assert!(braked, "{:?}", file.warnings);
    row(file, "none", "exact")
        .metric("peak_error")
        .unwrap()
        .mean
}

fn close(found: f64, expected: f64, part: f64) {
    assert!(
        (found / expected - 1.0).abs() < part,
        "{found:.6e}, expected {expected:.6e}"
    );
}

fn error(desk: &Desk, axis: &str, path: &str) -> f64 {
    largest(&desk.run(&together(&[FRICTIONLESS, axis, path, LOOP])))
}

/// At rest the controller's stiffness carries the force: of the spring at 10 mm, of a weight, both.
#[test]
fn forces_at_rest_are_carried_by_the_controller() {
    let desk = desk();
    let spring = error(&desk, "spring = \"30 N/mm\"\n", REST);
    // The axis stops where both springs balance.
    close(spring, 0.01 * 30e3 / (STIFFNESS + 30e3), 1e-6);
    let weight = "disturbance = { kind = \"constant\", force = \"23 N\" }\n";
    let held = desk.run(&together(&[FRICTIONLESS, weight, REST, LOOP]));
    close(largest(&held), 23.0 / STIFFNESS, 1e-6);
    // Against the positive direction.
    let outcome = desk.study(&together(&[FRICTIONLESS, weight, REST, LOOP]));
    let outcome =
        stiction_workflows::study::simulate(&outcome.unwrap(), &mut stiction_identify::Silent);
    assert!(outcome.traces[0].whole.error.iter().all(|e| *e > 0.0));
    // The same weight from a file, in other units, is the same run.
    desk.write("weight.csv", "t [s],load [kN]\n5,0.023\n6,0.023\n");
    let from_file = "disturbance = { kind = \"file\", file = \"weight.csv\" }\n";
    let from_file = desk.run(&together(&[FRICTIONLESS, from_file, REST, LOOP]));
    assert_eq!(from_file.results, held.results);
    assert_eq!(from_file.inputs.len(), held.inputs.len() + 1);
}

/// Along a constant velocity: of the damper, and of a motor on a voltage, whose voltage of motion is a damper Kf k/R.
#[test]
fn forces_of_motion_are_carried_by_the_controller() {
    let desk = desk();
    let damper = error(&desk, "viscous = \"200 N s/m\"\n", GLIDE);
    close(damper, 0.05 * 200.0 / STIFFNESS, 0.01);
    let motor = "voltage = { force_constant = \"96 N/A\", back_emf = \"60 V s/m\", resistance = \"24 ohm\" }\n";
    close(
        error(&desk, motor, GLIDE),
        0.05 * 96.0 * 60.0 / 24.0 / STIFFNESS,
        0.01,
    );
    // Without a constant of its own, that of the force.
    let usual = motor.replace("back_emf = \"60 V s/m\", ", "");
    close(
        error(&desk, &usual, GLIDE),
        0.05 * 96.0 * 96.0 / 24.0 / STIFFNESS,
        0.01,
    );
    // An inductance changes the way there, not the end, where its time constant is short.
    let inductive = motor.replace("24 ohm", "24 ohm\", inductance = \"5 mH");
    let late = GLIDE.replace("hold         = \"1 s\"", "skip = \"0.5 s\"\nhold = \"1 s\"");
    let rms = |axis: &str| error(&desk, axis, &late);
    close(rms(&inductive), rms(motor), 0.05);
}

/// A sine of 12 Hz: its force over |K - M w^2 + i D w|.
#[test]
fn a_sine_is_answered_by_mass_damper_and_stiffness() {
    let desk = desk();
    let sine = "disturbance = { kind = \"sine\", amplitude = \"23 N\", frequency = \"12 Hz\", phase = \"30 deg\" }\n";
    let omega = TAU * 12.0;
    let (real, imaginary) = (STIFFNESS - MASS * omega * omega, DAMPER * omega);
    close(error(&desk, sine, REST), 23.0 / real.hypot(imaginary), 0.01);
}

/// An amplifier that makes a current of its command gives what a force gives, up to its limit.
#[test]
fn a_command_in_volts() {
    let desk = Desk::new();
    let plain = together(&[AXIS, SHORT, CASCADE]);
    let volts = plain.replace(
        "peak_force   = \"1248 N\"",
        "voltage = { force_constant = \"96 N/A\", amplifier_gain = \"1.8 A/V\", limit = \"10 V\" }",
    );
    let [plain, volts] = [plain, volts].map(|text| desk.run(&text));
    close(largest(&volts), largest(&plain), 1e-9);
    close(volts.axis.peak_force.unwrap(), 1728.0, 1e-12);
    let entry = volts.axis.voltage.unwrap();
    assert_eq!((entry.force_constant, entry.back_emf), (96.0, 0.0));
    close(entry.limit.unwrap(), 10.0, 1e-12);
}

/// A motor whose current lags by more than a compensator can look ahead is compensated as well as that goes.
#[test]
fn a_slow_current_is_compensated_late() {
    let slow = "voltage = { force_constant = \"96 N/A\", resistance = \"2 ohm\", inductance = \"10 mH\", limit = \"48 V\" }";
    let axis = AXIS
        .replace("current_loop = \"1 kHz\"", slow)
        .replace("peak_force   = \"1248 N\"", "");
    let gentle = CASCADE.replace("60 Hz", "8 Hz");
    let file = Desk::new().run(&together(&[&axis, SHORT, &gentle, WHOLE]));
    // Its own voltage brakes it with 96^2/2 N s/m.
    let [warning] = &file.warnings[..] else {
        panic!("{:?}", file.warnings);
    };
    assert_eq!(warning.code.as_str(), "back-emf");
    assert!(
        warning
            .message
            .contains(" 4608 N·s/m, viscous friction with 30 N·s/m:"),
        "{warning:?}"
    );
    assert_eq!(file.results.len(), 2);
    close(file.axis.current_lag_s, 5e-3, 1e-12);
}

#[test]
fn what_is_refused_of_forces_on_the_axis() {
    let desk = Desk::new();
    desk.write("short.csv", "t [s]\n0\n1\n2\n");
    let good = together(&[AXIS, SHORT, CASCADE]);
    let mut out = String::new();
    for axis in [
        "viscous = \"-1 N s/m\"",
        "viscous = \"1 N/m\"",
        "spring = 5",
        "disturbance = \"5 N\"",
        "disturbance = { kind = \"step\" }",
        "disturbance = { force = \"5 N\" }",
        "disturbance = { kind = \"constant\" }",
        "disturbance = { kind = \"constant\", force = \"5 mm\" }",
        "disturbance = { kind = \"constant\", force = \"5 N\", from = \"1 s\" }",
        "disturbance = { kind = \"sine\", amplitude = \"5 N\" }",
        "disturbance = { kind = \"sine\", amplitude = \"-5 N\", frequency = \"1 Hz\" }",
        "disturbance = { kind = \"sine\", amplitude = \"5 N\", frequency = \"4 MHz\" }",
        "disturbance = { kind = \"sine\", amplitude = \"5 N\", frequency = \"6 kHz\" }",
        "disturbance = { kind = \"sine\", amplitude = \"5 N\", frequency = \"6 Hz\", phase = \"1e300 rad\" }",
        "disturbance = { kind = \"constant\", force = \"-1e300 N\" }",
        "disturbance = { kind = \"file\" }",
        "disturbance = { kind = \"file\", file = \"absent.csv\" }",
        "disturbance = { kind = \"file\", file = \"short.csv\" }",
        "voltage = \"24 V\"",
        "voltage = { resistance = \"2 ohm\" }",
        "voltage = { force_constant = \"96 N/A\" }",
        "voltage = { force_constant = \"96 N/A\", amplifier_gain = \"1.8 A/V\", resistance = \"2 ohm\" }",
        "voltage = { force_constant = \"96 N/A\", amplifier_gain = \"1.8 A/V\", back_emf = \"2 V s/m\" }",
        "voltage = { force_constant = \"96 N/A\", resistance = \"0 ohm\" }",
        "voltage = { force_constant = \"96 N/A\", resistance = \"2 ohm\" }",
    ] {
        out += &desk.refusal(&good.replace("[axis]", &format!("[axis]\n{axis}")));
        out.push('\n');
    }
    insta::assert_snapshot!(out);
}
