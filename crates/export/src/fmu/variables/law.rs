//! The variables of the law: what it remembers, and its parameters.

use super::{Role, Unit, Variable};
use stiction_friction::compensator::Friction;
use stiction_friction::{LuGre, Shape, Stribeck};

/// What the law remembers between two samples beside its force.
pub(super) fn state(friction: &Friction<f64>) -> Vec<Variable> {
    match friction {
        Friction::LuGre(_) | Friction::ElastoPlastic(_) => Vec::from(variables! {
            Local number "deflection" (0.0, Unit::Length) "law.deflection" "of the bristles"
        }),
        Friction::Gms(law) => {
            let elements = 0..law.elements().len();
            let list = elements.map(|k| {
                Variable::number(
                    format!("element_{}", k + 1),
                    Role::Local,
                    (0.0, Unit::Force),
                    format!("law.element_force[{k}]"),
                    "force of a Maxwell-slip element",
                )
            });
            list.collect()
        }
        Friction::Coulomb(_) | Friction::Stribeck(_) => vec![],
    }
}

/// The parameters of the law but its offset.
pub(super) fn parameters(friction: &Friction<f64>) -> Vec<Variable> {
    match friction {
        Friction::Coulomb(law) => {
            let (coulomb, viscous) = (law.coulomb(), law.viscous());
            let sides = [0, 1].map(|i| {
                [
                    fixed(SIDES[i], COULOMB, coulomb[i]),
                    fixed(SIDES[i], VISCOUS, viscous[i]),
                ]
            });
            sides.into_iter().flatten().collect()
        }
        Friction::Stribeck(steady) => curve(steady),
        Friction::LuGre(law) => bristle(law),
        Friction::ElastoPlastic(law) => {
            let mut list = bristle(law.bristle());
            let about = "deflection up to which bristles are elastic, over the steady one, above 0 and below 1";
            let ratio = (law.breakaway(), Unit::One);
            let at = "params.breakaway";
            list.push(Variable::number(
                "breakaway_ratio",
                Role::Fixed,
                ratio,
                at,
                about,
            ));
            list
        }
        Friction::Gms(law) => {
            let mut list = curve(law.curve());
            for (k, element) in law.elements().iter().enumerate() {
                let stiffness = (element.stiffness, Unit::Stiffness);
                let share = (element.share, Unit::One);
                for (name, value, about) in [
                    ("stiffness", stiffness, "of a Maxwell-slip element"),
                    ("share", share, "of the level that it takes; the sum is 1"),
                ] {
                    list.push(Variable::number(
                        format!("{name}_{}", k + 1),
                        Role::Fixed,
                        value,
                        format!("params.element_{name}[{k}]"),
                        about,
                    ));
                }
            }
            if law.attraction().is_finite() {
                let rate = (law.attraction(), Unit::Slew);
                let about = "rate at which elements that slip approach the level";
                list.push(parameter("attraction", rate, about));
            }
            list
        }
    }
}

/// The parameters of a bristle.
fn bristle(law: &LuGre<f64>) -> Vec<Variable> {
    let stiffness = (law.stiffness(), Unit::Stiffness);
    let damping = (law.damping().at_rest(), Unit::Damping);
    let mut list = vec![
        parameter("sigma0", stiffness, "stiffness of the bristles"),
        parameter("sigma1", damping, "micro-damping at rest"),
    ];
    list.extend(curve(law.curve()));
    list
}

/// A direction of motion, as names have it and as the C text does.
const SIDES: [&str; 2] = ["pos", "neg"];

/// Of a parameter that each direction has: its name, the field of the C text, its unit, and its symbol.
type Field = (&'static str, &'static str, Unit, &'static str);

const COULOMB: Field = ("coulomb", "coulomb", Unit::Force, "Fc");
const STATIC: Field = ("static", "static_friction", Unit::Force, "Fs");
const VELOCITY: Field = ("stribeck_velocity", "stribeck_velocity", Unit::Speed, "vs");
const VISCOUS: Field = ("viscous", "viscous", Unit::Damping, "sigma2");

fn fixed(side: &str, (name, field, unit, symbol): Field, value: f64) -> Variable {
    let way = if side == SIDES[0] {
        "positive"
    } else {
        "negative"
    };
    Variable::number(
        format!("{name}_{side}"),
        Role::Fixed,
        (value, unit),
        format!("params.{side}.{field}"),
        format!("{symbol} for {way} velocity"),
    )
}

/// A parameter that both directions share.
fn parameter(name: &str, value: (f64, Unit), about: &'static str) -> Variable {
    Variable::number(name, Role::Fixed, value, format!("params.{name}"), about)
}

/// The parameters of the steady curve.
fn curve(curve: &Stribeck<f64>) -> Vec<Variable> {
    let mut list = Vec::new();
    for (name, side) in SIDES.into_iter().zip([curve.positive(), curve.negative()]) {
        list.push(fixed(name, COULOMB, side.coulomb));
        list.push(fixed(name, STATIC, side.static_friction));
        list.push(fixed(name, VELOCITY, side.stribeck_velocity));
        list.push(fixed(name, VISCOUS, side.viscous));
    }
    if let Shape::Power(exponent) = curve.shape() {
        list.extend(variables! {
            Fixed number "stribeck_exponent" (exponent, Unit::One) "params.exponent" "of the Stribeck curve"
        });
    }
    list
}
