//! The compensator in a loop, over a triangle of the position, 10 mm/s each way.
//!
//!     stiction export examples/export/model.toml --target rust --out x-axis-friction
//!     mkdir x-axis-friction/examples && cp examples/export/rust/axis.rs x-axis-friction/examples
//!     cd x-axis-friction && cargo run --example axis
//!
//! Nothing is added for the first 11 s: the watchdog learns the error without compensation over five cycles of the motion.

use x_axis_friction::{Input, ParamError, Settings, Watchdog, settings, with_settings};

/// What drive and axis say, in the place of yours.
struct Axis {
    /// CiA 402, 6041h: bits 0, 1, 2 and 5 set, bit 3 clear.
    operates: bool,
    homed: bool,
    /// E-stop or safe torque off is asked for.
    stopping: bool,
    brake_open: bool,
}

fn main() -> Result<(), ParamError> {
    let axis = Axis { operates: true, homed: true, stopping: false, brake_open: true };
    // A little less than a cycle of the motion.
    let watchdog = Some(Watchdog { window: 1.9, ..Watchdog::default() });
    let mut compensator = with_settings(Settings { gain: 0.5, watchdog, ..settings() })?;
    for cycle in 0..14_000 {
        if axis.stopping {
            compensator.reset(); // gone at once, without the ramp
        }
        let reference_velocity = if cycle % 2000 < 1000 { 0.010 } else { -0.010 };
        let force = compensator.step(Input {
            reference_velocity,
            tracking_error: 0.0,
            enable: axis.operates && axis.homed && !axis.stopping && axis.brake_open,
            ..Input::default()
        });
        if cycle >= 12_000 && cycle % 1000 == 999 {
            println!("{force:.2} N at {:.0} mm/s", 1e3 * reference_velocity);
        }
    }
    Ok(())
}
