//! The text of this crate, for exported code that brings the law along.

macro_rules! files {
    ($($path:literal),* $(,)?) => {
        &[$(($path, include_str!(concat!("../", $path)))),*]
    };
}

/// Every file that a copy of this crate needs but its `Cargo.toml`, which in a workspace does not stand alone: path relative
/// to the crate, and text.
pub static FILES: &[(&str, &str)] = files![
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "README.md",
    "src/compensator.rs",
    "src/compensator/adaptation.rs",
    "src/compensator/beside.rs",
    "src/compensator/disturbance.rs",
    "src/compensator/friction.rs",
    "src/compensator/input.rs",
    "src/compensator/memory.rs",
    "src/compensator/preview.rs",
    "src/compensator/safety.rs",
    "src/compensator/settings.rs",
    "src/compensator/state.rs",
    "src/compensator/terms.rs",
    "src/compensator/watchdog.rs",
    "src/dahl.rs",
    "src/damping.rs",
    "src/elasto_plastic.rs",
    "src/elasto_plastic/plasticity.rs",
    "src/elasto_plastic/realtime.rs",
    "src/elasto_plastic/record.rs",
    "src/error.rs",
    "src/explicit.rs",
    "src/exponential.rs",
    "src/gms.rs",
    "src/gms/maxwell_slip.rs",
    "src/gms/realtime.rs",
    "src/gms/record.rs",
    "src/held.rs",
    "src/lib.rs",
    "src/lugre.rs",
    "src/real.rs",
    "src/realtime.rs",
    "src/record.rs",
    "src/shape.rs",
    "src/source.rs",
    "src/statics.rs",
    "src/stribeck.rs",
    "src/sweep.rs",
];
