//! The variables of an FMU: one list, from which the description and the addresses in the C text are made.

/// Variables, a row each: what for, its kind, its name, what it starts with, where the C text keeps it, and what it is.
macro_rules! variables {
    ($($role:ident $kind:ident $name:literal $start:tt $at:literal $about:literal)*) => {
        [$(Variable::$kind($name, Role::$role, $start, $at, $about)),*]
    };
}

mod adaptation;
mod law;
mod terms;

use super::unit::Unit;
use crate::number::Literal;
use crate::template::Fill;
use std::borrow::Cow;
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
    pub about: Cow<'static, str>,
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
            about: about.into(),
            at: at.into(),
        }
    }

    fn number(
        name: impl Into<String>,
        role: Role,
        (value, unit): (f64, Unit),
        at: impl Into<String>,
        about: impl Into<Cow<'static, str>>,
    ) -> Self {
        Variable {
            name: name.into(),
            role,
            start: Start::Number(value, unit),
            about: about.into(),
            at: at.into(),
        }
    }
}

impl Variables {
    pub(super) fn of(compensator: &Compensator<f64>) -> Self {
        let offset = compensator.friction().offset();
        let mut list = Vec::from(variables! {
            Input  number "reference_velocity" (0.0, Unit::Speed)    "velocity"     "of the set point, not measured; not finite: not enabled"
            Input  number "tracking_error"     (0.0, Unit::Length)   "error"        "reference less measured position"
            Input  flag   "enable"             false                 "enable"       "whether to compensate"
            Input  flag   "reset"              false                 "reset"        "resets the state and arms the watchdog again"
            Output number "force"              (0.0, Unit::Force)    "law.output"   "to be added to the force of the controller"
            Output flag   "tripped"            false                 "law.tripped"  "the watchdog has switched off, until a reset"
            Output flag   "valid"              true                  "law.ready"    "the parameters are in range; else the force is 0"
            Output flag   "learned"            false                 "law.learned"  "the error without compensation is known: the force may come in"
            Output number "baseline"           (0.0, Unit::Length)   "law.baseline" "rms error without compensation; 0: not known yet"
            Output number "reason"             (0.0, Unit::One)      "reason"       "why the watchdog has switched off: 0 it has not; 1 larger mean square error; 2 larger peaks, again and again or for long"
            Local  number "friction"           (offset, Unit::Force) "law.friction" "force of the law"
        });
        list.extend(law::state(compensator.friction()));
        let s = compensator.settings();
        let (window, ratio) = s.watchdog.map_or((0.0, 1.0), |w| (w.window, w.ratio));
        list.extend(variables! {
            Tunable number "gain"            (s.gain, Unit::One)        "params.gain"            "fraction of the friction that is compensated, 0 to 1"
            Tunable number "dead_zone"       (s.dead_zone, Unit::Speed) "params.dead_zone"       "speeds up to this count as standstill"
            Tunable number "limit"           (s.limit, Unit::Force)     "params.limit"           "largest force"
            Tunable number "slew"            (s.slew, Unit::Slew)       "params.slew"            "fastest change of the force"
            Tunable number "ramp"            (s.ramp, Unit::Time)       "params.ramp"            "time in which the compensation goes from 0 to its full value"
            Tunable number "watchdog_window" (window, Unit::Time)       "params.watchdog_window" "moving time that the watchdog compares, a cycle of the motion; 0: no watchdog"
            Tunable number "watchdog_ratio"  (ratio, Unit::One)         "params.watchdog_ratio"  "largest allowed rms error with compensation over that without"
        });
        list.extend(law::parameters(compensator.friction()));
        list.extend(variables! {
            Fixed number "offset" (offset, Unit::Force) "params.offset" "force at rest"
        });
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

/// After the last of its role.
fn add(list: &mut Vec<Variable>, variable: Variable) {
    let last = list.iter().rposition(|v| v.role == variable.role);
    list.insert(last.map_or(0, |i| i + 1), variable);
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
