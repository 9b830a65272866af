//! The simulated axis: its settings for a run, and what is said of it.

use stiction_files::study::result::{
    AxisParameter, DisturbanceEntry, EventEntry, SimulatedAxis, VoltageEntry,
};
use stiction_files::study::{Belief, Event, Machine};
use stiction_files::symbols;
use stiction_friction::{Damping, ParamError};
use stiction_log::Motion;
use stiction_servo::axis::AxisSettings;
use stiction_servo::controller::Controller;
use stiction_servo::disturbance::Disturbance;
use stiction_servo::drive::Drive;
use stiction_servo::feedforward::Feedforward;
use stiction_servo::law::OfAxis;
use stiction_servo::levelled::Depends;
use stiction_servo::plant::Plant;

/// The axis with a controller and without compensation, with that law and mass.
pub(super) fn settings<L: OfAxis>(
    machine: &Machine,
    axis: Belief,
    controller: Controller,
    seed: u64,
) -> Result<AxisSettings<L>, ParamError> {
    let other = ParamError::new("law", f64::NAN, "that of the model");
    let law = L::of(&axis.law).ok_or(other)?;
    let plant = Plant::new(axis.mass, law)?
        .with_viscous(machine.viscous)?
        .with_stiffness(machine.spring)?;
    Ok(AxisSettings {
        plant,
        drive: machine.drive,
        encoder: machine.encoder,
        position_noise: machine.position_noise,
        cogging: machine.cogging,
        disturbance: machine.disturbance.clone(),
        controller,
        feedforward: Feedforward::default(),
        rate: machine.rate,
        substeps: machine.substeps,
        seed,
    })
}

/// What the controller may ask for and the drive can give, N (N m).
pub(super) fn largest_force(machine: &Machine, controller: &Controller) -> f64 {
    controller.force_limit().min(machine.drive.peak_force())
}

/// Unit of a metric.
pub(super) fn unit(machine: &Machine, metric: &str) -> String {
    match (metric, machine.motion) {
        ("stick_time" | "hunting_period" | "learning_time", _) => "s",
        ("velocity_ripple" | "rest_share" | "feed_error_share" | "found_friction", _) => "1",
        ("found_mass", Motion::Linear) => "kg",
        ("found_mass", Motion::Rotary) => "kg*m^2",
        ("feed_error_rms" | "feed_error_peak", motion) => symbols::speed_unit(motion),
        (name, _) if name.starts_with("saturation") => "1",
        (name, Motion::Linear) if name.starts_with("command_change") => "N",
        (name, Motion::Rotary) if name.starts_with("command_change") => "N*m",
        (_, motion) => symbols::length_unit(motion),
    }
    .into()
}

/// The axis as it goes into `study.json`.
pub(super) fn entry(machine: &Machine) -> SimulatedAxis {
    let parameters = machine.model.parameters.iter().map(|p| AxisParameter {
        name: p.name.to_string(),
        value: p.value,
        unit: p.unit.clone(),
    });
    let sigma1 = match machine.law.damping() {
        Some(Damping::Constant(_)) => "constant",
        Some(_) => "capped",
        None => "",
    };
    let depends = machine.depends.as_ref();
    let at = |on: fn(&Depends) -> Option<f64>| depends.and_then(on);
    SimulatedAxis {
        load: at(|d| d.on_load().then_some(d.surroundings.load)),
        temperature: at(|d| d.on_temperature().then_some(d.surroundings.temperature)),
        position: at(|d| d.on_position().then_some(d.surroundings.origin)),
        kind: match machine.motion {
            Motion::Linear => "linear",
            Motion::Rotary => "rotary",
        }
        .into(),
        origin: machine.model.origin.clone(),
        parameters: parameters.collect(),
        sigma1: sigma1.into(),
        mass: machine.mass,
        rate_hz: machine.rate,
        substeps: machine.substeps,
        delay_s: machine.drive.delay,
        current_lag_s: machine.drive.current_lag,
        peak_force: Some(machine.drive.peak_force()).filter(|f| f.is_finite()),
        encoder: machine.encoder.resolution(),
        position_noise: machine.position_noise,
        viscous: machine.viscous,
        spring: machine.spring,
        disturbance: machine.disturbance.as_ref().map(disturbance),
        voltage: voltage(&machine.drive),
    }
}

/// A change of the axis as it goes into `study.json`.
pub(super) fn event(event: &Event) -> EventEntry {
    EventEntry {
        time_s: event.time,
        mass: event.mass,
        friction: event.friction,
    }
}

/// A disturbance in the direction of the study file, which is against that of the axis.
fn disturbance(disturbance: &Disturbance) -> DisturbanceEntry {
    match *disturbance {
        Disturbance::Constant(force) => DisturbanceEntry {
            kind: "constant".into(),
            force: Some(-force),
            ..DisturbanceEntry::default()
        },
        Disturbance::Sine {
            amplitude,
            frequency,
            phase,
        } => DisturbanceEntry {
            kind: "sine".into(),
            amplitude: Some(-amplitude),
            frequency_hz: Some(frequency),
            phase_rad: Some(phase),
            ..DisturbanceEntry::default()
        },
        Disturbance::Recorded(_) => DisturbanceEntry {
            kind: "file".into(),
            ..DisturbanceEntry::default()
        },
    }
}

/// What a command in volts becomes; `None` where the command is the force.
fn voltage(drive: &Drive) -> Option<VoltageEntry> {
    let volts = drive.peak_current / drive.amplifier_gain;
    (drive.gain() != 1.0 || drive.back_emf > 0.0).then(|| VoltageEntry {
        force_constant: drive.force_constant,
        amplifier_gain: drive.amplifier_gain,
        back_emf: drive.back_emf,
        limit: Some(volts).filter(|v| v.is_finite()),
    })
}
