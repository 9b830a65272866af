//! The variables of an FMU: one list, from which the description and the addresses in the C text are made.

mod adaptation;
mod law;
mod terms;

use super::unit::Unit;
use crate::number::Literal;
use crate::template::Fill;
use stiction_friction::compensator::Compensator;

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
    pub name: String,
    pub role: Role,
    pub start: Start,
    pub about: &'static str,
    /// Where the C text keeps it, in `data_t`.
    at: String,
}

/// All of them; the value reference of the first is 1, since 0 is time.
#[derive(Clone, Debug)]
pub(super) struct Variables(Vec<Variable>);

impl Variable {
    fn flag(name: &str, role: Role, start: bool, at: &str, about: &'static str) -> Self {
        Variable {
            name: name.into(),
            role,
            start: Start::Flag(start),
            about,
            at: at.into(),
        }
    }

    fn number(
        name: impl Into<String>,
        role: Role,
        (value, unit): (f64, Unit),
        at: impl Into<String>,
        about: &'static str,
    ) -> Self {
        Variable {
            name: name.into(),
            role,
            start: Start::Number(value, unit),
            about,
            at: at.into(),
        }
    }
}

impl Variables {
    pub(super) fn of(compensator: &Compensator<f64>) -> Self {
        let mut list = vec![
            Variable::number(
                "reference_velocity",
                Role::Input,
                (0.0, Unit::Speed),
                "velocity",
                "of the set point, not measured; not finite: not enabled",
            ),
            Variable::number(
                "tracking_error",
                Role::Input,
                (0.0, Unit::Length),
                "error",
                "reference less measured position",
            ),
            Variable::flag(
                "enable",
                Role::Input,
                false,
                "enable",
                "whether to compensate",
            ),
            Variable::flag(
                "reset",
                Role::Input,
                false,
                "reset",
                "resets the state and arms the watchdog again",
            ),
            Variable::number(
                "force",
                Role::Output,
                (0.0, Unit::Force),
                "law.output",
                "to be added to the force of the controller",
            ),
            Variable::flag(
                "tripped",
                Role::Output,
                false,
                "law.tripped",
                "the watchdog has switched off, until a reset",
            ),
            Variable::flag(
                "valid",
                Role::Output,
                true,
                "law.ready",
                "the parameters are in range; else the force is 0",
            ),
            Variable::flag(
                "learned",
                Role::Output,
                false,
                "law.learned",
                "the error without compensation is known: the force may come in",
            ),
            Variable::number(
                "baseline",
                Role::Output,
                (0.0, Unit::Length),
                "law.baseline",
                "rms error without compensation; 0: not known yet",
            ),
            Variable::number(
                "reason",
                Role::Output,
                (0.0, Unit::One),
                "reason",
                "why the watchdog has switched off: 0 it has not; 1 larger mean square error; 2 larger peaks, again and again or for long",
            ),
            Variable::number(
                "friction",
                Role::Local,
                (compensator.friction().offset(), Unit::Force),
                "law.friction",
                "force of the law",
            ),
        ];
        list.extend(law::state(compensator.friction()));
        let s = compensator.settings();
        let (window, ratio) = s.watchdog.map_or((0.0, 1.0), |w| (w.window, w.ratio));
        list.extend([
            Variable::number(
                "gain",
                Role::Tunable,
                (s.gain, Unit::One),
                "params.gain",
                "fraction of the friction that is compensated, 0 to 1",
            ),
            Variable::number(
                "dead_zone",
                Role::Tunable,
                (s.dead_zone, Unit::Speed),
                "params.dead_zone",
                "speeds up to this count as standstill",
            ),
            Variable::number(
                "limit",
                Role::Tunable,
                (s.limit, Unit::Force),
                "params.limit",
                "largest force",
            ),
            Variable::number(
                "slew",
                Role::Tunable,
                (s.slew, Unit::Slew),
                "params.slew",
                "fastest change of the force",
            ),
            Variable::number(
                "ramp",
                Role::Tunable,
                (s.ramp, Unit::Time),
                "params.ramp",
                "time in which the compensation goes from 0 to its full value",
            ),
            Variable::number(
                "watchdog_window",
                Role::Tunable,
                (window, Unit::Time),
                "params.watchdog_window",
                "moving time that the watchdog compares, a cycle of the motion; 0: no watchdog",
            ),
            Variable::number(
                "watchdog_ratio",
                Role::Tunable,
                (ratio, Unit::One),
                "params.watchdog_ratio",
                "largest allowed rms error with compensation over that without",
            ),
        ]);
        list.extend(law::parameters(compensator.friction()));
        list.push(Variable::number(
            "offset",
            Role::Fixed,
            (compensator.friction().offset(), Unit::Force),
            "params.offset",
            "force at rest",
        ));
        if let Some(adaptation) = s.adaptation {
            adaptation::insert(&mut list, adaptation);
        }
        if let Some(terms) = compensator.terms() {
            terms::insert(&mut list, terms);
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
