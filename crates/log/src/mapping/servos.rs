//! Servos whose firmware is known: motor and position loop, at the output shaft.

use std::f64::consts::TAU;

/// A servo with a P loop in position that sets the duty of its motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Servo {
    /// Name as in the axis file.
    pub name: &'static str,
    /// Torque constant, N m/A.
    pub torque_constant: f64,
    /// Resistance of motor and driver, ohm.
    pub resistance: f64,
    /// Back EMF constant, V s/rad.
    pub back_emf: f64,
    /// Nominal supply, V.
    pub supply: f64,
    /// Duty for each rad of following error and unit of the P gain, 1/rad.
    pub error_gain: f64,
    /// P gain that the firmware starts with.
    pub kp: f64,
    /// Largest duty, 0 to 1.
    pub duty_limit: f64,
    /// Where the numbers come from.
    pub source: &'static str,
}

/// Counts a turn of a 12-bit encoder, in a loop whose gain divides by `divisor` and whose duty of 1 is `full`.
const fn counted(divisor: f64, full: f64) -> f64 {
    4096.0 / TAU / divisor / full
}

/// The servos of the library.
#[rustfmt::skip] // A line a servo.
pub const SERVOS: &[Servo] = &[
    Servo { name: "xl330", torque_constant: 0.3867, resistance: 4.017, back_emf: 0.3867, supply: 7.4, error_gain: counted(256.0, 885.0), kp: 400.0, duty_limit: 1.0, source: "XL330-M288, BAM 1.0.2 (Duclusaud and Passault): pendulum fit, model M1" },
    Servo { name: "sts3215", torque_constant: 1.2116, resistance: 2.676, back_emf: 1.2116, supply: 7.4, error_gain: 0.166, kp: 32.0, duty_limit: 0.97, source: "7.4 V version, BAM 1.0.2: pendulum fit, model M1; loop measured with an oscilloscope" },
    Servo { name: "xl320", torque_constant: 0.9869, resistance: 35.61, back_emf: 0.9869, supply: 7.5, error_gain: 0.0505, kp: 32.0, duty_limit: 1.0, source: "BAM 1.0.2: pendulum fit, model M1; loop measured with an oscilloscope" },
    Servo { name: "mx64", torque_constant: 1.6225, resistance: 3.949, back_emf: 1.6225, supply: 15.0, error_gain: 0.158, kp: 32.0, duty_limit: 0.9625, source: "BAM 1.0.2: pendulum fit, model M1; loop measured with an oscilloscope" },
    Servo { name: "mx106", torque_constant: 2.1914, resistance: 2.965, back_emf: 2.1914, supply: 15.0, error_gain: 0.158, kp: 32.0, duty_limit: 0.9625, source: "BAM 1.0.2: pendulum fit, model M1; loop measured with an oscilloscope" },
    // From data sheets: stall at 11.1 V is 1.4 N m and 1.3 A, no load 57 rpm. Gear losses are in the torque constant.
    Servo { name: "xl430", torque_constant: 1.077, resistance: 8.54, back_emf: 1.86, supply: 11.1, error_gain: counted(128.0, 885.0), kp: 800.0, duty_limit: 1.0, source: "XL430-W250, ROBOTIS e-manual: stall, no load, P gain over 128; +-20 %" },
    // Stall at 12 V is 1.5 N m and 1.5 A, no load 59 rpm; the duty rises over a compliance slope of 32 counts of 300/1024 degrees.
    Servo { name: "ax12", torque_constant: 1.0, resistance: 8.0, back_emf: 1.94, supply: 11.1, error_gain: 6.11, kp: 1.0, duty_limit: 1.0, source: "AX-12A, ROBOTIS e-manual: stall, no load, compliance slope 32 (kp = 32/slope), punch and margin left out; +-20 %" },
];

/// The servo of this name.
pub fn servo(name: &str) -> Option<&'static Servo> {
    SERVOS.iter().find(|servo| servo.name == name)
}
