//! The variables of levels that follow the machine.

use super::{Role, Unit, Variable, add};
use stiction_friction::compensator::Adaptation;

/// What levels that follow the machine take and give, each after the variables of its role.
pub(super) fn insert(list: &mut Vec<Variable>, adaptation: Adaptation<f64>) {
    let Adaptation {
        memory,
        range,
        mass,
    } = adaptation;
    let variables = variables! {
        Input   number "drive_force"   (0.0, Unit::Force)    "drive_force"   "that the drive was given in the cycle before, this compensation included"
        Input   flag   "learn"         false                 "learn"         "not at the limits of the drive, nor while something else than friction and inertia pushes"
        Output  number "level_dry"     (1.0, Unit::One)      "law.level_dry" "factor on the dry part of the law's force"
        Output  number "level_viscous" (1.0, Unit::One)      "law.level_viscous" "factor on the viscous part"
        Output  number "mass_found"    (0.0, Unit::Inertia)  "law.mass_found" "beside them"
        Tunable number "memory"        (memory, Unit::Time)  "params.memory" "time constant of what the factors forget, in time in which the force is new"
        Tunable number "range"         (range, Unit::One)    "params.range"  "how far the factors may go from 1, above 0 and below 1"
        Fixed   number "mass"          (mass, Unit::Inertia) "params.mass"   "moving mass; 0: none"
    };
    for variable in variables {
        add(list, variable);
    }
}
