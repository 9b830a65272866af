//! Names, symbols, units and ranges.

use stiction_parameters::{Allowed, Dimension, LawKind, Name, Quantity, Side, Units, Wave};

/// Every quantity, elements and waves with a number of two digits.
fn all() -> Vec<Quantity> {
    let mut out = vec![
        Quantity::Sigma0,
        Quantity::Sigma1,
        Quantity::Sigma2,
        Quantity::QuadraticViscous,
        Quantity::Coulomb,
        Quantity::Static,
        Quantity::StribeckVelocity,
        Quantity::StribeckExponent,
        Quantity::BreakawayRatio,
        Quantity::Attraction,
        Quantity::Mass,
        Quantity::Offset,
        Quantity::Delay,
        Quantity::ElementStiffness(10),
        Quantity::ElementYield(10),
        Quantity::ElementForce(10),
        Quantity::CoulombLog(2),
        Quantity::Sigma1Log(3),
        Quantity::Sigma2Log(12),
        Quantity::CoulombLoad,
        Quantity::CoulombTemperature,
        Quantity::CoulombPosition,
        Quantity::CoulombMap(8),
        Quantity::CoulombTransmitted,
        Quantity::CoulombDriven,
        Quantity::Sigma2Temperature,
        Quantity::LoadReference,
        Quantity::TemperatureReference,
        Quantity::PositionReference,
        Quantity::PositionStroke,
        Quantity::TransmittedReference,
    ];
    for wave in [Wave::Sine, Wave::Cosine] {
        out.extend([
            Quantity::Gravity(wave),
            Quantity::Cogging(12, wave),
            Quantity::CoulombPitch(12, wave),
        ]);
    }
    out
}

#[test]
fn every_name_reads_back_as_itself() {
    let mut seen = std::collections::HashSet::new();
    for quantity in all() {
        for side in [Side::Both, Side::Positive, Side::Negative] {
            let name = Name::new(quantity, side);
            let text = name.to_string();
            assert_eq!(text.parse::<Name>().unwrap(), name);
            assert!(name == text.as_str() && name == *text.as_str());
            assert!(seen.insert(text));
            assert!(!name.symbol().is_empty() && !quantity.meaning().is_empty());
        }
    }
}

#[test]
fn texts_that_are_no_names_are_refused() {
    let texts = [
        "",
        "_pos",
        "sigma3",
        "stiffness_",
        "stiffness_0",
        "stiffness_01",
        "stiffness_+1",
        "stiffness_99999999999",
        "cogging1",
        "cogging_sin",
        "coulomb_pos_neg",
        "Coulomb",
    ];
    for text in texts {
        assert!(text.parse::<Name>().is_err(), "{text:?}");
    }
    let error = "sigma3".parse::<Name>().unwrap_err();
    assert_eq!(error.to_string(), "\"sigma3\" is no parameter of any law");
}

#[test]
fn symbols() {
    let symbol = |text: &str| text.parse::<Name>().unwrap().symbol();
    assert_eq!(symbol("coulomb_neg"), "Fc⁻");
    assert_eq!(symbol("stiffness_10"), "k₁₀");
    assert_eq!(symbol("yield_3"), "d₃");
    assert_eq!(symbol("cogging1_sin"), "cogging1_sin");
}

#[test]
fn units_follow_those_of_force_and_motion() {
    let (linear, rotary) = (Units::linear("N"), Units::rotary("N*m"));
    assert_eq!(linear.of(Dimension::Stiffness), "N/m");
    assert_eq!(rotary.of(Dimension::Damping), "N*m*s/rad");
    assert_eq!(linear.of(Dimension::Inertia), "kg");
    assert_eq!(rotary.of(Dimension::Inertia), "kg*m^2");
    assert_eq!(Units::linear("A").of(Dimension::Inertia), "A*s^2/m");
    assert_eq!(rotary.of(Dimension::Speed), "rad/s");
    let per_load = |load| linear.with_load(load).of(Dimension::ForcePerLoad);
    assert_eq!(
        ["", "N", "kg", "N*m"].map(per_load),
        ["N", "1", "N/kg", "N/(N*m)"]
    );
}

/// A law needs only what it can have, and the friction crate refuses what is outside the ranges.
#[test]
fn needs_and_ranges() {
    for kind in LawKind::ALL {
        assert!(kind.needs().all(|quantity| kind.has(quantity)), "{kind}");
        assert_eq!(LawKind::from_name(kind.name()), Some(kind));
    }
    assert!(!LawKind::Stribeck.has(Quantity::Sigma0));
    assert!(LawKind::Stribeck.has(Quantity::Mass));
    for (allowed, good, bad) in [
        (Allowed::NotNegative, 0.0, -1e-300),
        (Allowed::Positive, 1e-300, 0.0),
        (Allowed::Share, 0.5, 1.0),
        (Allowed::Exponent, 10.0, 10.1),
        (Allowed::Any, -1e300, f64::INFINITY),
    ] {
        assert!(allowed.admits(good) && !allowed.admits(bad), "{allowed:?}");
        assert!(!allowed.admits(f64::NAN));
    }
}
