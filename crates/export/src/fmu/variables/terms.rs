//! The variables of what friction depends on, and of what is fed forward beside it.

use super::{Role, Unit, Variable, add};
use crate::terms::{self, Extra};
use stiction_friction::compensator::Terms;

/// What comes in, and the parts of the force, each after the variables of its role.
pub(super) fn insert(list: &mut Vec<Variable>, terms: &Terms<f64>) {
    for extra in Extra::of(terms) {
        let reference = extra.channel(&terms.channels).unwrap_or_default().reference;
        let (unit, about) = match extra {
            Extra::Acceleration => (
                Unit::Acceleration,
                "of the set point, at the instant of its velocity",
            ),
            Extra::Position => (
                Unit::Length,
                "of the set point; not finite: as it came in last",
            ),
            Extra::Load => (
                Unit::One,
                "normal load, in the unit of the model; not finite: as it came in last",
            ),
            Extra::Temperature => (Unit::Temperature, "not finite: as it came in last"),
            Extra::Transmitted => (
                Unit::Force,
                "what the load asks of the motor beside friction and inertia, positive where the motor has to push towards \
                 positive positions; not finite: as it came in last",
            ),
        };
        let start = (reference, unit);
        add(
            list,
            Variable::number(extra.name(), Role::Input, start, extra.name(), about),
        );
    }
    let fed = terms::parts(terms);
    if fed.is_empty() {
        return;
    }
    for part in [&["friction"][..], &fed].concat() {
        let name = format!("part_{part}");
        let at = format!("law.{name}");
        let about = "a part of the force, before limit and slew limit";
        add(
            list,
            Variable::number(name, Role::Output, (0.0, Unit::Force), at, about),
        );
    }
}
