//! Recordings of a small servo motor with a pendulum (Rhoban, Apache-2.0): JSON of what the servo says of itself.

use serde_json::Value;
use std::fmt::Write;
use std::path::Path;

/// Published constants of the XL330: torque of a current, N m/A, and resistance, ohm.
const TORQUE_CONSTANT: f64 = 0.3867;
const RESISTANCE: f64 = 4.017;
/// The duty that is logged when all of the voltage is on the motor.
const FULL_DUTY: f64 = 885.0;
/// Gravity, m/s^2.
const GRAVITY: f64 = 9.81;

/// A recording as a table: time, position, the torque that voltage and back EMF make, and that of the weight on the joint, of
/// mass and length as they are stated.
pub fn table(path: &Path) -> String {
    let text = std::fs::read_to_string(path).expect("a recording");
    let all: Value = serde_json::from_str(&text).expect("JSON");
    let number = |of: &Value, key: &str| of[key].as_f64().expect("a number");
    let weight = number(&all, "mass") * GRAVITY * number(&all, "length");
    let mut table = String::from("Time [s],Position [rad],Torque [N m],Weight [N m]\n");
    for entry in all["entries"].as_array().expect("entries") {
        let [time, position, speed] =
            ["timestamp", "position", "speed"].map(|key| number(entry, key));
        // A 16-bit number in two's complement.
        let duty = number(entry, "load");
        let duty = if duty < 32768.0 { duty } else { duty - 65536.0 };
        let volts = duty / FULL_DUTY * number(entry, "input_volts");
        let torque = TORQUE_CONSTANT * (volts - TORQUE_CONSTANT * speed) / RESISTANCE;
        let falls = -weight * position.sin();
        let _ = writeln!(table, "{time},{position},{torque},{falls}");
    }
    table
}
