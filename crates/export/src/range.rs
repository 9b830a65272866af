//! Numbers that a number type can compute with: far enough from the ends of its range that nothing in the compensator or
//! the vectors of the self-test overflows or vanishes.

use crate::{Error, Model, terms};
use stiction_friction::Direction;
use stiction_friction::compensator::Friction;

/// A number with its name, and whether it may be arbitrarily small.
struct Number {
    name: &'static str,
    value: f64,
    small: bool,
}

/// The magnitudes that a number type can compute with.
struct Range {
    /// Parameters that are divided by, or multiplied with each other.
    parameters: (f64, f64),
    /// Largest stiffness and micro-damping of bristles.
    bristles: f64,
    /// Least and largest force limit.
    limit: (f64, f64),
    /// Least size of what makes an input count: in a single-precision block next to one in double precision it would vanish,
    /// and its input with it.
    slope: f64,
}

impl Range {
    /// The range of the number type of this name. Products of two parameters, and of those with the times and
    /// speeds of a test, stay well inside.
    fn of(number_type: Option<&str>) -> Self {
        match number_type {
            // No operation of the block overflows in REAL, at any speed that it accepts; the block's `valid` uses the same
            // bounds.
            Some("REAL" | "LREAL") => Range {
                parameters: (1e-9, 1e9),
                bristles: 1e15,
                limit: (1e-15, 1e15),
                slope: 1e-30,
            },
            Some("float" | "f32") => Range {
                parameters: (1e-15, 1e15),
                bristles: 1e15,
                limit: (1e-30, 1e30),
                slope: 1e-30,
            },
            _ => Range {
                parameters: (1e-100, 1e100),
                bristles: 1e100,
                limit: (1e-200, 1e200),
                slope: 1e-200,
            },
        }
    }
}

/// Refuses a law or a limit beyond the range of a number type, `number_type` in the target. Signs and relations between
/// parameters are checked by the constructors.
pub(crate) fn check(
    model: &Model,
    limit: f64,
    number_type: Option<&'static str>,
) -> Result<(), Error> {
    let range = Range::of(number_type);
    let refuse = |name, value, range: (f64, f64)| Error::Range {
        name,
        value,
        range,
        number_type,
    };
    let mass = model.settings.adaptation.map(|a| Number {
        name: "mass",
        value: a.mass,
        small: false,
    });
    for Number { name, value, small } in law(&model.friction).into_iter().chain(mass) {
        let size = value.abs();
        let least = if small { 0.0 } else { range.parameters.0 };
        let most = match name {
            "sigma0" | "sigma1" | "element_stiffness" | "attraction" => range.bristles,
            _ => range.parameters.1,
        };
        if size > most || (size > 0.0 && size < least) {
            return Err(refuse(name, value, (least, most)));
        }
    }
    for (name, value) in terms::numbers(&model.terms) {
        if value.abs() > range.parameters.1 {
            return Err(refuse(name, value, (0.0, range.parameters.1)));
        }
    }
    for (name, value) in terms::slopes(&model.terms) {
        if value != 0.0 && value.abs() < range.slope {
            return Err(refuse(name, value, (range.slope, range.parameters.1)));
        }
    }
    if limit > range.limit.1 || (limit > 0.0 && limit < range.limit.0) {
        return Err(refuse("limit", limit, range.limit));
    }
    Ok(())
}

/// The parameters of a law; without direction in their names where both directions are the same.
fn law(friction: &Friction<f64>) -> Vec<Number> {
    let flat = |coulomb, viscous| Direction {
        coulomb,
        static_friction: coulomb,
        stribeck_velocity: 1.0,
        viscous,
    };
    let (pos, neg, offset) = match (friction, friction.curve()) {
        (Friction::Coulomb(law), _) => {
            let ([pos, neg], [v_pos, v_neg]) = (law.coulomb(), law.viscous());
            (flat(pos, v_pos), flat(neg, v_neg), law.offset())
        }
        (_, Some(curve)) => (*curve.positive(), *curve.negative(), curve.offset()),
        (_, None) => unreachable!("every other law has a curve"),
    };
    let number = |name, value, small| Number { name, value, small };
    let mut numbers = Vec::new();
    if let Some(law) = friction.bristle() {
        numbers.push(number("sigma0", law.stiffness(), false));
        numbers.push(number("sigma1", law.damping().at_rest(), true));
    }
    if let Friction::ElastoPlastic(law) = friction {
        numbers.push(number("breakaway_ratio", law.breakaway(), false));
    }
    if let Friction::Gms(law) = friction {
        for element in law.elements() {
            numbers.push(number("element_stiffness", element.stiffness, false));
            numbers.push(number("element_share", element.share, false));
        }
        if law.attraction().is_finite() {
            numbers.push(number("attraction", law.attraction(), false));
        }
    }
    let names = [
        ["coulomb", "coulomb_pos", "coulomb_neg"],
        ["static", "static_pos", "static_neg"],
        [
            "stribeck_velocity",
            "stribeck_velocity_pos",
            "stribeck_velocity_neg",
        ],
        ["sigma2", "sigma2_pos", "sigma2_neg"],
    ];
    let values = |side: Direction<f64>| {
        [
            side.coulomb,
            side.static_friction,
            side.stribeck_velocity,
            side.viscous,
        ]
    };
    for (names, (pos, neg)) in names
        .into_iter()
        .zip(values(pos).into_iter().zip(values(neg)))
    {
        let small = names[0] == "sigma2";
        if pos == neg {
            numbers.push(number(names[0], pos, small));
        } else {
            numbers.push(number(names[1], pos, small));
            numbers.push(number(names[2], neg, small));
        }
    }
    numbers.push(number("offset", offset, true));
    numbers
}
