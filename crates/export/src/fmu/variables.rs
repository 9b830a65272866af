//! The variables of an FMU: one list, from which the description and the addresses in the C text are made.

use super::unit::Unit;
use crate::Model;
use crate::number::Literal;
use crate::template::Fill;
use stiction_friction::Shape;
use stiction_friction::compensator::{Adaptation, Compensator, Friction};

/// What a variable is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    Input,
    Output,
    Local,
    /// A parameter that may change while it runs.
    Tunable,
    /// A parameter of the law.
    Fixed,
}

/// The value that a variable starts with.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Start {
    Number(f64, Unit),
    Flag(bool),
}

/// A variable.
#[derive(Clone, Debug)]
pub(super) struct Variable {
    pub name: &'static str,
    pub role: Role,
    pub start: Start,
    pub about: &'static str,
    /// Where the C text keeps it, in `data_t`.
    at: &'static str,
}

/// All of them; the value reference of the first is 1, since 0 is time.
#[derive(Clone, Debug)]
pub(super) struct Variables(Vec<Variable>);

/// What levels that follow the machine take and give, each after the variables of its role.
fn following(list: &mut Vec<Variable>, adaptation: Adaptation<f64>) {
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
            name,
            role,
            start,
            about,
            at,
        };
        list.insert(last.map_or(0, |i| i + 1), variable);
    }
}

impl Variables {
    pub(super) fn of(model: &Model, compensator: &Compensator<f64>) -> Self {
        let mut list = Vec::new();
        let mut number = |name, role, value, unit, at, about| {
            list.push(Variable {
                name,
                role,
                start: Start::Number(value, unit),
                about,
                at,
            });
        };
        let offset = match &model.friction {
            Friction::Coulomb(law) => law.offset(),
            Friction::Stribeck(curve) => curve.offset(),
            Friction::LuGre(law) => law.curve().offset(),
        };
        let bristles = matches!(model.friction, Friction::LuGre(_));
        number(
            "reference_velocity",
            Role::Input,
            0.0,
            Unit::Speed,
            "velocity",
            "of the set point, not measured; not finite: not enabled",
        );
        number(
            "tracking_error",
            Role::Input,
            0.0,
            Unit::Length,
            "error",
            "reference less measured position",
        );
        number(
            "force",
            Role::Output,
            0.0,
            Unit::Force,
            "law.output",
            "to be added to the force of the controller",
        );
        number(
            "baseline",
            Role::Output,
            0.0,
            Unit::Length,
            "law.baseline",
            "rms error without compensation; 0: not known yet",
        );
        number(
            "reason",
            Role::Output,
            0.0,
            Unit::One,
            "reason",
            "why the watchdog has switched off: 0 it has not; 1 larger mean square error; 2 larger peaks, again and again or for long",
        );
        number(
            "friction",
            Role::Local,
            offset,
            Unit::Force,
            "law.friction",
            "force of the law",
        );
        if bristles {
            number(
                "deflection",
                Role::Local,
                0.0,
                Unit::Length,
                "law.deflection",
                "of the bristles",
            );
        }
        let s = compensator.settings();
        let (window, ratio) = s.watchdog.map_or((0.0, 1.0), |w| (w.window, w.ratio));
        number(
            "gain",
            Role::Tunable,
            s.gain,
            Unit::One,
            "params.gain",
            "fraction of the friction that is compensated, 0 to 1",
        );
        number(
            "dead_zone",
            Role::Tunable,
            s.dead_zone,
            Unit::Speed,
            "params.dead_zone",
            "speeds up to this count as standstill",
        );
        number(
            "limit",
            Role::Tunable,
            s.limit,
            Unit::Force,
            "params.limit",
            "largest force",
        );
        number(
            "slew",
            Role::Tunable,
            s.slew,
            Unit::Slew,
            "params.slew",
            "fastest change of the force",
        );
        number(
            "ramp",
            Role::Tunable,
            s.ramp,
            Unit::Time,
            "params.ramp",
            "time in which the compensation goes from 0 to its full value",
        );
        number(
            "watchdog_window",
            Role::Tunable,
            window,
            Unit::Time,
            "params.watchdog_window",
            "moving time that the watchdog compares, a cycle of the motion; 0: no watchdog",
        );
        number(
            "watchdog_ratio",
            Role::Tunable,
            ratio,
            Unit::One,
            "params.watchdog_ratio",
            "largest allowed rms error with compensation over that without",
        );
        if let Friction::LuGre(law) = compensator.friction() {
            number(
                "sigma0",
                Role::Fixed,
                law.stiffness(),
                Unit::Stiffness,
                "params.sigma0",
                "stiffness of the bristles",
            );
            number(
                "sigma1",
                Role::Fixed,
                law.damping().at_rest(),
                Unit::Damping,
                "params.sigma1",
                "micro-damping at rest",
            );
        }
        match compensator.friction() {
            Friction::Coulomb(law) => {
                let (c, v) = (law.coulomb(), law.viscous());
                number(
                    "coulomb_pos",
                    Role::Fixed,
                    c[0],
                    Unit::Force,
                    "params.pos.coulomb",
                    "Fc for positive velocity",
                );
                number(
                    "viscous_pos",
                    Role::Fixed,
                    v[0],
                    Unit::Damping,
                    "params.pos.viscous",
                    "sigma2 for positive velocity",
                );
                number(
                    "coulomb_neg",
                    Role::Fixed,
                    c[1],
                    Unit::Force,
                    "params.neg.coulomb",
                    "Fc for negative velocity",
                );
                number(
                    "viscous_neg",
                    Role::Fixed,
                    v[1],
                    Unit::Damping,
                    "params.neg.viscous",
                    "sigma2 for negative velocity",
                );
            }
            Friction::Stribeck(_) | Friction::LuGre(_) => {
                let curve = match compensator.friction() {
                    Friction::LuGre(law) => law.curve(),
                    Friction::Stribeck(curve) => curve,
                    Friction::Coulomb(_) => unreachable!("it has no curve"),
                };
                let (p, n) = (curve.positive(), curve.negative());
                number(
                    "coulomb_pos",
                    Role::Fixed,
                    p.coulomb,
                    Unit::Force,
                    "params.pos.coulomb",
                    "Fc for positive velocity",
                );
                number(
                    "static_pos",
                    Role::Fixed,
                    p.static_friction,
                    Unit::Force,
                    "params.pos.static_friction",
                    "Fs for positive velocity",
                );
                number(
                    "stribeck_velocity_pos",
                    Role::Fixed,
                    p.stribeck_velocity,
                    Unit::Speed,
                    "params.pos.stribeck_velocity",
                    "vs for positive velocity",
                );
                number(
                    "viscous_pos",
                    Role::Fixed,
                    p.viscous,
                    Unit::Damping,
                    "params.pos.viscous",
                    "sigma2 for positive velocity",
                );
                number(
                    "coulomb_neg",
                    Role::Fixed,
                    n.coulomb,
                    Unit::Force,
                    "params.neg.coulomb",
                    "Fc for negative velocity",
                );
                number(
                    "static_neg",
                    Role::Fixed,
                    n.static_friction,
                    Unit::Force,
                    "params.neg.static_friction",
                    "Fs for negative velocity",
                );
                number(
                    "stribeck_velocity_neg",
                    Role::Fixed,
                    n.stribeck_velocity,
                    Unit::Speed,
                    "params.neg.stribeck_velocity",
                    "vs for negative velocity",
                );
                number(
                    "viscous_neg",
                    Role::Fixed,
                    n.viscous,
                    Unit::Damping,
                    "params.neg.viscous",
                    "sigma2 for negative velocity",
                );
                if let Shape::Power(exponent) = curve.shape() {
                    number(
                        "stribeck_exponent",
                        Role::Fixed,
                        exponent,
                        Unit::One,
                        "params.exponent",
                        "of the Stribeck curve",
                    );
                }
            }
        }
        number(
            "offset",
            Role::Fixed,
            offset,
            Unit::Force,
            "params.offset",
            "force at rest",
        );
        let mut flag = |at: usize, name, role, start, place, about| {
            list.insert(
                at,
                Variable {
                    name,
                    role,
                    start: Start::Flag(start),
                    about,
                    at: place,
                },
            );
        };
        flag(
            2,
            "enable",
            Role::Input,
            false,
            "enable",
            "whether to compensate",
        );
        flag(
            3,
            "reset",
            Role::Input,
            false,
            "reset",
            "resets the state and arms the watchdog again",
        );
        flag(
            5,
            "tripped",
            Role::Output,
            false,
            "law.tripped",
            "the watchdog has switched off, until a reset",
        );
        flag(
            6,
            "valid",
            Role::Output,
            true,
            "law.ready",
            "the parameters are in range; else the force is 0",
        );
        flag(
            7,
            "learned",
            Role::Output,
            false,
            "law.learned",
            "the error without compensation is known: the force may come in",
        );
        if let Some(adaptation) = s.adaptation {
            following(&mut list, adaptation);
        }
        Variables(list)
    }

    /// Each with its value reference.
    pub(super) fn iter(&self) -> impl Iterator<Item = (usize, &Variable)> {
        self.0.iter().enumerate().map(|(i, v)| (i + 1, v))
    }

    /// The addresses, for the C text.
    pub(super) fn fill(&self, fill: &mut Fill) {
        let cases = |flags: bool| -> String {
            let lines: Vec<String> = self
                .iter()
                .filter(|(_, v)| matches!(v.start, Start::Flag(_)) == flags)
                .map(|(r, v)| format!("    case {r}u: at = &d->{}; break;", v.at))
                .collect();
            lines.join("\n")
        };
        let first = |wanted: &dyn Fn(&Variable) -> bool| {
            let found = self.iter().find(|(_, v)| wanted(v));
            found.map_or(self.0.len() + 1, |(r, _)| r).to_string()
        };
        fill.set("numbers", cases(false))
            .set("flags", cases(true))
            .set("after_inputs", first(&|v| v.role != Role::Input))
            .set("tunable_from", first(&|v| v.role == Role::Tunable))
            .set("fixed_from", first(&|v| v.role == Role::Fixed))
            .set("end", (self.0.len() + 1).to_string());
    }
}

impl Start {
    /// As the description writes it.
    pub(super) fn text(&self) -> String {
        match self {
            Start::Number(value, _) => value.c(),
            Start::Flag(value) => value.to_string(),
        }
    }
}
