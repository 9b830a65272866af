//! The variables of levels that follow the machine.

use super::{Role, Start, Unit, Variable};
use stiction_friction::compensator::Adaptation;

/// What levels that follow the machine take and give, each after the variables of its role.
pub(super) fn insert(list: &mut Vec<Variable>, adaptation: Adaptation<f64>) {
    use Role::{Fixed, Input, Output, Tunable};
    let number = |value, unit| Start::Number(value, unit);
    let Adaptation {
        memory,
        range,
        mass,
    } = adaptation;
    for (name, role, start, at, about) in [
        (
            "drive_force",
            Input,
            number(0.0, Unit::Force),
            "drive_force",
            "that the drive was given in the cycle before, this compensation included",
        ),
        (
            "learn",
            Input,
            Start::Flag(false),
            "learn",
            "not at the limits of the drive, nor while something else than friction and inertia pushes",
        ),
        (
            "level_forward",
            Output,
            number(1.0, Unit::One),
            "law.levels[0]",
            "factor on the force of the law without its offset, found for motion forward",
        ),
        (
            "level_back",
            Output,
            number(1.0, Unit::One),
            "law.levels[1]",
            "the same for motion back",
        ),
        (
            "mass_found",
            Output,
            number(0.0, Unit::Inertia),
            "law.mass_found",
            "beside the levels",
        ),
        (
            "memory",
            Tunable,
            number(memory, Unit::Time),
            "params.memory",
            "time constant of what the levels forget, in time that is learnt from",
        ),
        (
            "range",
            Tunable,
            number(range, Unit::One),
            "params.range",
            "how far the levels may go from 1, above 0 and below 1",
        ),
        (
            "mass",
            Fixed,
            number(mass, Unit::Inertia),
            "params.mass",
            "moving mass; 0: none",
        ),
    ] {
        let last = list.iter().rposition(|v| v.role == role);
        let variable = Variable {
            name: name.into(),
            role,
            start,
            about,
            at: at.into(),
        };
        list.insert(last.map_or(0, |i| i + 1), variable);
    }
}
