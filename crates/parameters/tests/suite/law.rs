//! The law of a set, against the friction crate's own constructors.

use stiction_friction::{
    CoulombViscous, Damping, Direction, ElastoPlastic, Element, Gms, LuGre, Shape, Stribeck,
};
use stiction_parameters::{FrictionLaw, LawError, LawKind, Name, ParameterSet, Quantity, Side};

const SIDES: [Direction<f64>; 2] = [
    Direction {
        coulomb: 20.0,
        static_friction: 30.0,
        stribeck_velocity: 5e-3,
        viscous: 60.0,
    },
    Direction {
        coulomb: 24.0,
        static_friction: 31.0,
        stribeck_velocity: 4e-3,
        viscous: 80.0,
    },
];

/// Everything that any law needs, symmetric or not, with an offset and a mass.
fn set(kind: LawKind, asymmetric: bool) -> ParameterSet {
    let mut set = ParameterSet::new(kind);
    let sides: &[Side] = if asymmetric {
        &[Side::Positive, Side::Negative]
    } else {
        &[Side::Both]
    };
    for (side, numbers) in sides.iter().zip(SIDES) {
        for (quantity, value) in [
            (Quantity::Coulomb, numbers.coulomb),
            (Quantity::Static, numbers.static_friction),
            (Quantity::StribeckVelocity, numbers.stribeck_velocity),
            (Quantity::Sigma2, numbers.viscous),
        ] {
            set.insert(Name::new(quantity, *side), value);
        }
    }
    for (quantity, value) in [
        (Quantity::Sigma0, 1.2e5),
        (Quantity::Sigma1, 600.0),
        (Quantity::BreakawayRatio, 0.7),
        (Quantity::Attraction, 100.0),
        (Quantity::ElementStiffness(1), 8e5),
        (Quantity::ElementYield(1), 15e-6),
        (Quantity::ElementStiffness(2), 6e5),
        (Quantity::ElementYield(2), 30e-6),
        (Quantity::Offset, -3.0),
        (Quantity::Mass, 10.0),
    ] {
        set.insert(quantity, value);
    }
    set
}

fn curve(shape: Shape<f64>, asymmetric: bool) -> Stribeck<f64> {
    let negative = SIDES[usize::from(asymmetric)];
    Stribeck::new(shape, SIDES[0], negative, -3.0).unwrap()
}

fn flat(asymmetric: bool) -> Stribeck<f64> {
    let side = |side: Direction<f64>| Direction {
        static_friction: side.coulomb,
        stribeck_velocity: 1.0,
        ..side
    };
    let negative = side(SIDES[usize::from(asymmetric)]);
    Stribeck::new(Shape::Gaussian, side(SIDES[0]), negative, -3.0).unwrap()
}

#[test]
fn every_law() {
    for asymmetric in [false, true] {
        let of = |kind| set(kind, asymmetric).law().unwrap();
        let curve = curve(Shape::Gaussian, asymmetric);
        let flat = flat(asymmetric);
        let negative = &SIDES[usize::from(asymmetric)];
        let coulomb = [20.0, negative.coulomb];
        let plain = CoulombViscous::new(coulomb, [60.0, negative.viscous], -3.0).unwrap();
        let lugre = LuGre::new(1.2e5, Damping::Constant(600.0), curve).unwrap();
        let dahl = LuGre::new(1.2e5, Damping::Constant(0.0), flat).unwrap();
        let elastic = ElastoPlastic::new(lugre, 0.7).unwrap();
        assert_eq!(
            of(LawKind::CoulombViscous),
            FrictionLaw::CoulombViscous(plain)
        );
        assert_eq!(of(LawKind::Stribeck), FrictionLaw::Stribeck(curve));
        assert_eq!(of(LawKind::LuGre), FrictionLaw::LuGre(lugre));
        assert_eq!(of(LawKind::Dahl), FrictionLaw::LuGre(dahl));
        assert_eq!(
            of(LawKind::ElastoPlastic),
            FrictionLaw::ElastoPlastic(elastic)
        );
        // Yield forces at rest: 12 N and 18 N, together the static level of 30 N; 100/s of it are 3000 N/s.
        let element = |stiffness, share| Element { stiffness, share };
        let elements = [element(8e5, 12.0), element(6e5, 18.0)];
        for (kind, attraction, curve) in [
            (LawKind::Gms, 3000.0, curve),
            (LawKind::MaxwellSlip, f64::INFINITY, flat),
        ] {
            let FrictionLaw::MaxwellSlip(law) = of(kind) else {
                panic!("{kind}");
            };
            let wanted = Gms::new(elements, attraction, 0.0, curve).unwrap();
            assert_eq!(law.gms::<2>(), Some(wanted), "{kind}");
            assert_eq!(law.gms::<3>(), None);
        }
    }
}

/// An exponent of 1 or 2 is the exponential or the Gaussian curve, whoever builds the law; as a power it would be the same
/// curve but for its slope at rest.
#[test]
fn the_exponent_chooses_the_form() {
    for (exponent, shape) in [
        (2.0, Shape::Gaussian),
        (1.0, Shape::Exponential),
        (1.3, Shape::Power(1.3)),
    ] {
        let mut set = set(LawKind::LuGre, false);
        set.insert(Quantity::StribeckExponent, exponent);
        let law = set.law().unwrap();
        assert_eq!(*law.curve().unwrap(), curve(shape, false));
        let power = curve(Shape::Power(exponent), false);
        for v in [1e-4, 3e-3, -5e-3, 0.1] {
            let (a, b) = (law.curve().unwrap().level(v), power.level(v));
            assert!((a - b).abs() < 1e-14 * b, "{exponent} {v}: {a} {b}");
        }
    }
}

/// The law is that of the identification, which finds a constant sigma1; simulation and control cap it.
#[test]
fn sigma1_is_constant_until_it_is_capped() {
    for kind in [LawKind::LuGre, LawKind::Dahl] {
        let law = set(kind, true).law().unwrap();
        let at_rest = law.lugre().unwrap().damping().at_rest();
        assert_eq!(
            law.lugre().unwrap().damping(),
            Damping::Constant(at_rest),
            "{kind}"
        );
        let capped = law.clone().capped().lugre().unwrap();
        assert_eq!(capped.damping(), Damping::Capped(at_rest), "{kind}");
        assert_eq!(capped.curve(), law.curve().unwrap());
    }
    let FrictionLaw::ElastoPlastic(law) =
        set(LawKind::ElastoPlastic, false).law().unwrap().capped()
    else {
        panic!();
    };
    assert_eq!(law.bristle().damping(), Damping::Capped(600.0));
}

#[test]
fn what_is_missing_or_wrong_is_named() {
    for kind in LawKind::ALL {
        for quantity in kind.needs() {
            let without = set(kind, false).without(quantity);
            assert_eq!(without.missing().next(), Some(quantity), "{kind}");
            let error = without.law().unwrap_err();
            let name = Name::from(quantity);
            assert_eq!(error, LawError::Missing { kind, name });
            assert_eq!(
                error.to_string(),
                format!("the law {kind} needs {quantity}", quantity = name)
            );
        }
        assert_eq!(set(kind, true).missing().next(), None);
    }
    let only_one = ParameterSet::of(
        LawKind::CoulombViscous,
        [
            (Name::new(Quantity::Coulomb, Side::Positive), 20.0),
            (Quantity::Sigma2.into(), 1.0),
        ],
    );
    let error = only_one.law().unwrap_err().to_string();
    assert_eq!(error, "the law coulomb-viscous needs coulomb_neg");
    for (asymmetric, name) in [(false, "static"), (true, "static_neg")] {
        let mut set = set(LawKind::LuGre, asymmetric);
        set.insert(name.parse::<Name>().unwrap(), 10.0);
        let LawError::Value(error) = set.law().unwrap_err() else {
            panic!();
        };
        assert_eq!(error.name, name);
    }
}

#[test]
fn more_elements_than_a_law_can_have() {
    let mut set = set(LawKind::Gms, false);
    for k in 3..=11 {
        set.insert(Quantity::ElementStiffness(k), 1e5);
        set.insert(Quantity::ElementYield(k), 1e-4);
        assert_eq!(set.law().is_ok(), k <= 10, "{k}");
    }
}
