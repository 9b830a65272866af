//! The compensator in a loop, over one period of a triangle of the position, 10 mm/s each way.
//!
//!     stiction export examples/export/model.toml --target rust --out x-axis-friction
//!     mkdir x-axis-friction/examples && cp examples/export/rust/axis.rs x-axis-friction/examples
//!     cd x-axis-friction && cargo run --example axis

use x_axis_friction::{Input, ParamError, Settings, settings, with_settings};

fn main() -> Result<(), ParamError> {
    // The watchdog is off for this example only: it would let the axis move without compensation first.
    let mut compensator = with_settings(Settings { gain: 0.5, watchdog: None, ..settings() })?;
    for cycle in 0..2000 {
        let reference_velocity = if cycle < 1000 { 0.010 } else { -0.010 };
        let force = compensator.step(Input { reference_velocity, enable: true, ..Input::default() });
        if cycle % 1000 == 999 {
            println!("{force:.2} N at {:.0} mm/s", 1e3 * reference_velocity);
        }
    }
    Ok(())
}
