//! Symbols and units of parameters, for files and people.

use stiction_identify::Dimension;
use stiction_log::Motion;

/// Unit of a parameter, given the units of the force and the load channel.
pub fn unit(dimension: Dimension, motion: Motion, force: &str, load: &str) -> String {
    let length = length_unit(motion);
    match dimension {
        Dimension::Stiffness => format!("{force}/{length}"),
        Dimension::Damping => format!("{force}*s/{length}"),
        Dimension::Force => force.to_string(),
        Dimension::Length => length.to_string(),
        Dimension::Rate => "1/s".into(),
        Dimension::Speed => speed_unit(motion).to_string(),
        Dimension::Inertia => match force {
            "N" => "kg".into(),
            "N*m" => "kg*m^2".into(),
            other => format!("{other}*s^2/{length}"),
        },
        Dimension::Time => "s".into(),
        Dimension::QuadraticDamping => format!("{force}*s^2/{length}^2"),
        Dimension::ForcePerLoad if load == force => "1".into(),
        Dimension::ForcePerLoad => match load {
            "" | "1" => force.to_string(),
            simple if simple.chars().all(char::is_alphanumeric) => format!("{force}/{load}"),
            product => format!("{force}/({product})"),
        },
        Dimension::ForcePerTemperature => format!("{force}/K"),
        Dimension::DampingPerTemperature => format!("{force}*s/({length}*K)"),
        Dimension::Load if load.is_empty() => "1".into(),
        Dimension::Load => load.to_string(),
        Dimension::Temperature => "K".into(),
        Dimension::One => "1".into(),
    }
}

/// Unit of position.
pub fn length_unit(motion: Motion) -> &'static str {
    match motion {
        Motion::Linear => "m",
        Motion::Rotary => "rad",
    }
}

/// Unit of force.
pub fn force_unit(motion: Motion) -> &'static str {
    match motion {
        Motion::Linear => "N",
        Motion::Rotary => "N*m",
    }
}

/// Unit of velocity.
pub fn speed_unit(motion: Motion) -> &'static str {
    match motion {
        Motion::Linear => "m/s",
        Motion::Rotary => "rad/s",
    }
}

/// Symbol of a parameter by its name, in Unicode.
pub fn symbol(name: &str) -> String {
    let (stem, side) = match name.strip_suffix("_pos") {
        Some(stem) => (stem, "⁺"),
        None => name
            .strip_suffix("_neg")
            .map_or((name, ""), |stem| (stem, "⁻")),
    };
    for (name, letter) in [("stiffness_", "k"), ("yield_", "d")] {
        if let Some(number) = stem.strip_prefix(name) {
            let digits = number.chars().map(subscript).collect::<String>();
            return format!("{letter}{digits}");
        }
    }
    let symbol = match stem {
        "sigma0" => "σ₀",
        "sigma1" => "σ₁",
        "sigma2" => "σ₂",
        "coulomb" => "Fc",
        "static" => "Fs",
        "stribeck_velocity" => "vs",
        "stribeck_exponent" => "δ",
        "breakaway_ratio" => "zba/zss",
        "attraction" => "a",
        "mass" => "M",
        "offset" => "F₀",
        "delay" => "τ",
        "quadratic_viscous" => "σ₂₂",
        "coulomb_load" => "∂Fc/∂N",
        "coulomb_temperature" => "∂Fc/∂T",
        "coulomb_position" => "∂Fc/∂x",
        "sigma2_temperature" => "∂σ₂/∂T",
        "load_reference" => "N₀",
        "temperature_reference" => "T₀",
        "position_reference" => "x₀",
        other => other,
    };
    format!("{symbol}{side}")
}

/// Whether a parameter is that of a single Maxwell-slip element.
pub fn is_element(name: &str) -> bool {
    let number = name
        .strip_prefix("stiffness_")
        .or(name.strip_prefix("yield_"));
    number.is_some_and(|n| n.parse::<u32>().is_ok())
}

/// A digit below the line.
fn subscript(digit: char) -> char {
    let shift = digit.to_digit(10).unwrap_or(0);
    char::from_u32(0x2080 + shift).unwrap_or(digit)
}

/// What a parameter is, in the words of the field.
pub fn meaning(name: &str, motion: Motion) -> String {
    let stem = name.trim_end_matches("_pos").trim_end_matches("_neg");
    let side = if name.ends_with("_pos") {
        ", positive direction"
    } else if name.ends_with("_neg") {
        ", negative direction"
    } else {
        ""
    };
    let text = match stem {
        "sigma0" => "bristle stiffness",
        "sigma1" => "micro-damping",
        "sigma2" => "viscous friction",
        "coulomb" => "Coulomb friction",
        "static" => "static friction",
        "stribeck_velocity" => "Stribeck velocity",
        "stribeck_exponent" => "Stribeck exponent",
        "breakaway_ratio" => "break-away part of the steady deflection",
        "attraction" => "attraction of slip to the Stribeck curve",
        "mass" => match motion {
            Motion::Linear => "moving mass",
            Motion::Rotary => "inertia",
        },
        "offset" => "constant force",
        "delay" => "delay of the force against the motion",
        "gravity_sin" => "gravity, sin q",
        "gravity_cos" => "gravity, cos q",
        "quadratic_viscous" => "quadratic viscous friction",
        "coulomb_load" => "Coulomb friction per normal load",
        "coulomb_temperature" => "Coulomb friction per temperature",
        "coulomb_position" => "Coulomb friction along the stroke",
        "sigma2_temperature" => "viscous friction per temperature",
        "load_reference" => "mean normal load",
        "temperature_reference" => "mean temperature",
        "position_reference" => "middle of the stroke",
        other if other.starts_with("cogging") => "cogging",
        other if other.starts_with("coulomb_pitch") => "Coulomb friction, wave along the stroke",
        other if other.starts_with("stiffness_") => "stiffness of an element",
        other if other.starts_with("yield_") => "deflection at which the element yields",
        other => other,
    };
    format!("{text}{side}")
}

/// What drives the axis, in words. A current or voltage that was not scaled keeps its own name.
pub fn driver(motion: Motion, force_unit: &str) -> &'static str {
    match (force_unit, motion) {
        ("A", _) => "current",
        ("V", _) => "voltage",
        (_, Motion::Linear) => "force",
        (_, Motion::Rotary) => "torque",
    }
}
