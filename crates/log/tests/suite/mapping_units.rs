//! Units against their definitions, and text that must not bring the parser down.

use crate::mapping_common::{axis, message};
use proptest::prelude::*;
use std::f64::consts::PI;
use stiction_formats::{Dimension as D, Kind, Unit, Value};
use stiction_log::{Log, Mapping, Motion};

/// Unit, dimension, SI value of one by definition (BIPM brochure; international inch and pound).
fn definitions() -> Vec<(&'static str, D, f64)> {
    let pound = 0.453_592_37 * 9.806_65;
    let stiffness = D::FORCE.per(D::LENGTH).unwrap();
    vec![
        ("s", D::TIME, 1.0),
        ("ms", D::TIME, 1e-3),
        ("us", D::TIME, 1e-6),
        ("µs", D::TIME, 1e-6),
        ("μs", D::TIME, 1e-6),
        ("ns", D::TIME, 1e-9),
        ("min", D::TIME, 60.0),
        ("h", D::TIME, 3600.0),
        ("m", D::LENGTH, 1.0),
        ("mm", D::LENGTH, 1e-3),
        ("um", D::LENGTH, 1e-6),
        ("µm", D::LENGTH, 1e-6),
        ("nm", D::LENGTH, 1e-9),
        ("km", D::LENGTH, 1e3),
        ("in", D::LENGTH, 0.0254),
        ("rad", D::ANGLE, 1.0),
        ("mrad", D::ANGLE, 1e-3),
        ("deg", D::ANGLE, PI / 180.0),
        ("°", D::ANGLE, PI / 180.0),
        ("rev", D::ANGLE, 2.0 * PI),
        ("turn", D::ANGLE, 2.0 * PI),
        ("arcsec", D::ANGLE, PI / 180.0 / 3600.0),
        ("m/s", D::LINEAR_VELOCITY, 1.0),
        ("mm/s", D::LINEAR_VELOCITY, 1e-3),
        ("mm/min", D::LINEAR_VELOCITY, 1e-3 / 60.0),
        ("m/min", D::LINEAR_VELOCITY, 1.0 / 60.0),
        ("rad/s", D::ANGULAR_VELOCITY, 1.0),
        ("rad s-1", D::ANGULAR_VELOCITY, 1.0),
        ("deg/s", D::ANGULAR_VELOCITY, PI / 180.0),
        ("°/s", D::ANGULAR_VELOCITY, PI / 180.0),
        ("rpm", D::ANGULAR_VELOCITY, 2.0 * PI / 60.0),
        ("1/min", D::ANGULAR_VELOCITY, 2.0 * PI / 60.0),
        ("min⁻¹", D::ANGULAR_VELOCITY, 2.0 * PI / 60.0),
        ("U/min", D::ANGULAR_VELOCITY, 2.0 * PI / 60.0),
        ("r/min", D::ANGULAR_VELOCITY, 2.0 * PI / 60.0),
        ("N", D::FORCE, 1.0),
        ("kN", D::FORCE, 1e3),
        ("mN", D::FORCE, 1e-3),
        ("MN", D::FORCE, 1e6),
        ("uN", D::FORCE, 1e-6),
        ("lbf", D::FORCE, pound),
        ("ozf", D::FORCE, pound / 16.0),
        ("N m", D::TORQUE, 1.0),
        ("Nm", D::TORQUE, 1.0),
        ("N*m", D::TORQUE, 1.0),
        ("N·m", D::TORQUE, 1.0),
        ("N-m", D::TORQUE, 1.0),
        ("N.m", D::TORQUE, 1.0),
        ("m N", D::TORQUE, 1.0),
        ("mN m", D::TORQUE, 1e-3),
        ("mNm", D::TORQUE, 1e-3),
        ("kNm", D::TORQUE, 1e3),
        ("Ncm", D::TORQUE, 1e-2),
        ("lbf in", D::TORQUE, pound * 0.0254),
        ("A", D::CURRENT, 1.0),
        ("mA", D::CURRENT, 1e-3),
        ("Arms", D::CURRENT, 1.0),
        ("V", D::VOLTAGE, 1.0),
        ("mV", D::VOLTAGE, 1e-3),
        ("kg", D::MASS, 1.0),
        ("g", D::MASS, 1e-3),
        ("kg m2", D::INERTIA, 1.0),
        ("kg*m^2", D::INERTIA, 1.0),
        ("kg·m²", D::INERTIA, 1.0),
        ("kgcm2", D::INERTIA, 1e-4),
        ("g cm**2", D::INERTIA, 1e-7),
        ("Hz", D::FREQUENCY, 1.0),
        ("kHz", D::FREQUENCY, 1e3),
        ("1/s", D::FREQUENCY, 1.0),
        ("K", D::TEMPERATURE, 1.0),
        ("counts", D::COUNTS, 1.0),
        ("inc", D::COUNTS, 1.0),
        ("incr", D::COUNTS, 1.0),
        ("LSB", D::COUNTS, 1.0),
        ("%", D::ONE, 1e-2),
        ("-", D::ONE, 1.0),
        ("N/mm", stiffness, 1e3),
        ("N/(m)", stiffness, 1.0),
        ("[mm]", D::LENGTH, 1e-3),
        ("N m/A", D::TORQUE.per(D::CURRENT).unwrap(), 1.0),
        ("um/count", D::LENGTH.per(D::COUNTS).unwrap(), 1e-6),
        ("V/(m/s)", D::VOLTAGE.per(D::LINEAR_VELOCITY).unwrap(), 1.0),
        ("V s/m", D::VOLTAGE.per(D::LINEAR_VELOCITY).unwrap(), 1.0),
        ("m/s/s", D::LINEAR_VELOCITY.per(D::TIME).unwrap(), 1.0),
        ("m/s^2", D::LINEAR_VELOCITY.per(D::TIME).unwrap(), 1.0),
        (
            "N m s/rad",
            D::TORQUE.per(D::ANGULAR_VELOCITY).unwrap(),
            1.0,
        ),
        (
            "mm/rev",
            D::LENGTH.per(D::ANGLE).unwrap(),
            1e-3 / (2.0 * PI),
        ),
        ("kg m^2 s^-3 A^-1", D::VOLTAGE, 1.0),
    ]
}

#[test]
fn every_unit_is_what_it_is_defined_to_be() {
    for (text, dimension, si) in definitions() {
        let unit = Unit::parse(text).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert_eq!(unit.dimension(), dimension, "{text}");
        let off = (unit.factor() / si - 1.0).abs();
        assert!(
            off <= 4.0 * f64::EPSILON,
            "{text}: {} against {si}",
            unit.factor()
        );
    }
}

#[test]
fn decimal_prefixes_cost_one_rounding() {
    // The nearest double of 242.2e-6 is 242.2 / 1e6: multiplying by the double 1e-6 would miss it
    // for many numbers.
    let micro = Unit::parse("uN").unwrap();
    for k in 1..2000_i32 {
        let number = f64::from(k) / 10.0;
        assert_eq!(micro.to_si(number).to_bits(), (number / 1e6).to_bits());
    }
}

#[test]
fn celsius_has_an_offset_and_only_alone() {
    assert_eq!(Unit::parse("degC").unwrap().to_si(20.0), 293.15);
    assert_eq!(Value::parse("-273.15 °C").unwrap().si(), 0.0);
    assert_eq!(Unit::parse("N/degC").unwrap_err().kind, Kind::Unit);
    assert_eq!(Unit::parse("degC/s").unwrap_err().kind, Kind::Unit);
}

#[test]
fn what_is_ambiguous_or_unknown_is_refused() {
    for text in [
        "", " ", "Mm", "NM", "Nms", "N/m s", "N/m-s", "U", "r", "x", "mmm", "gm", "C", "m^0",
        "m^99", "m^", "(m", "m)", "N**", "*m", "m*", "m//s", "M", "µ", "nrad/", "kk", "5 mm",
        "m^(2", "°F",
    ] {
        let error = Unit::parse(text).expect_err(text);
        assert_eq!(error.kind, Kind::Unit, "{text}");
    }
}

#[test]
fn messages_of_refusal() {
    let units = [
        "Mm", "NM", "newton", "N/m s", "Nms", "rmp", "zz", "m^0.5", "kg°", "mmHg", "",
    ];
    let values = [
        "mm",
        "1,5 mm",
        "5 furlong",
        "nan V",
        "1e999 m",
        "",
        "2 N V/",
    ];
    let units = units
        .iter()
        .map(|t| Unit::parse(t).unwrap_err().to_string());
    let values = values
        .iter()
        .map(|t| Value::parse(t).unwrap_err().to_string());
    let wrong = Value::parse("5 mm")
        .unwrap()
        .si_of(D::FREQUENCY)
        .unwrap_err()
        .to_string();
    let lines: Vec<_> = units.chain(values).chain([wrong]).collect();
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn values_with_and_without_blanks() {
    let gain = Value::parse("35.15065188 N/V").unwrap();
    assert_eq!(
        gain.si_of(D::FORCE.per(D::VOLTAGE).unwrap()).unwrap(),
        35.150_651_88
    );
    assert_eq!(Value::parse("100Hz").unwrap().si(), 100.0);
    assert_eq!(Value::parse(" -5e-1 mm/s ").unwrap().si(), -0.5 / 1e3);
    assert_eq!(Value::parse("7").unwrap().si_of(D::ONE).unwrap(), 7.0);
    assert_eq!(
        Value::parse("160.18 1/s")
            .unwrap()
            .si_of(D::FREQUENCY)
            .unwrap(),
        160.18
    );
    assert_eq!(Value::parse("50 %").unwrap().si(), 0.5);
    assert_eq!(gain.to_string(), "35.15065188 N/V");
}

/// Dimensions made of what friction identification meets: products of up to three named ones.
fn any_dimension() -> impl Strategy<Value = D> {
    let base = prop::sample::select(vec![
        D::TIME,
        D::LENGTH,
        D::ANGLE,
        D::MASS,
        D::FORCE,
        D::TORQUE,
        D::CURRENT,
        D::VOLTAGE,
        D::TEMPERATURE,
        D::COUNTS,
        D::ONE,
    ]);
    prop::collection::vec((base, -2..=2), 1..4).prop_map(|factors| {
        let mut all = D::ONE;
        for (dimension, power) in factors {
            all = dimension
                .power(power)
                .and_then(|d| all.times(d))
                .unwrap_or(all);
        }
        all
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn si_text_reads_back(dimension in any_dimension()) {
        let unit = Unit::parse(&Unit::si(dimension).to_string()).unwrap();
        prop_assert_eq!(unit.dimension(), dimension);
        prop_assert_eq!(unit.factor(), 1.0);
    }

    #[test]
    fn values_read_back(number in prop::num::f64::NORMAL | prop::num::f64::ZERO, pick in 0..70_usize) {
        let (text, ..) = definitions()[pick];
        let value = Value { number, unit: Unit::parse(text).unwrap() };
        let again = Value::parse(&value.to_string()).unwrap();
        prop_assert_eq!(again.number.to_bits(), number.to_bits());
        prop_assert_eq!(again.unit.dimension(), value.unit.dimension());
        prop_assert_eq!(again.unit.factor().to_bits(), value.unit.factor().to_bits());
    }

    #[test]
    fn arbitrary_text_never_panics(text in ".{0,80}") {
        let _ = Unit::parse(&text);
        let _ = Value::parse(&text);
    }

    #[test]
    fn text_like_units_never_panics(text in "[-+*/^(). 0-9mNkgsAVradU%°µ²⁻·]{0,40}") {
        if let Ok(unit) = Unit::parse(&text) {
            prop_assert!(unit.factor().is_finite() && unit.factor() > 0.0);
        }
        let _ = Value::parse(&text);
    }

    #[test]
    fn products_and_quotients_multiply(a in 0..40_usize, b in 0..40_usize) {
        let (left, ld, lf) = definitions()[a];
        let (right, rd, rf) = definitions()[b];
        let special = ["min", "h", "1/min", "min⁻¹", "1/s"];
        prop_assume!(!special.contains(&left) && !special.contains(&right));
        let product = Unit::parse(&format!("({left})*({right})")).unwrap();
        prop_assert_eq!(Some(product.dimension()), ld.times(rd));
        prop_assert!((product.factor() / (lf * rf) - 1.0).abs() < 1e-14);
        let ratio = Unit::parse(&format!("({left})/({right})")).unwrap();
        prop_assert_eq!(Some(ratio.dimension()), ld.per(rd));
        prop_assert!((ratio.factor() / (lf / rf) - 1.0).abs() < 1e-14);
    }
}

/// Torque of CiA 402 is in thousandths of the rated one: objects 6071h and 6077h.
#[test]
fn a_torque_in_thousandths_of_the_rated_one_asks_for_it() {
    let unit = |text: &str| stiction_formats::Unit::parse(text).unwrap().to_si(1.0);
    for text in ["0.1%", "0.1 %", "[0.1%]", "0,1 %", "permille", "‰"] {
        assert_eq!(unit(text), 1e-3, "{text}");
    }
    let mut table = axis(3000).table();
    let force = &mut table.columns[3];
    (force.name, force.unit) = ("6077h Torque actual value".into(), Some("0.1%".into()));
    let given = Mapping {
        motion: Some(Motion::Linear),
        ..Mapping::default()
    };
    let log = Log::from_table(&table, &given).unwrap();
    assert!(message(&log, "force-not-calibrated").contains("scale = \"RATED N\""));
    let raw = table.columns[3].values[700];
    assert!((log.force.unwrap()[700] / raw - 1e-3).abs() < 1e-15);
}
