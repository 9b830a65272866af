//! What the axis file asks of a motion beside LuGre: the terms that are planned for, and those that are not, by name.

use crate::error::Error;
use stiction_codes::Code;
use stiction_files::{Axis, Warning};
use stiction_identify::{Delay, Dependence, Mass, Terms};
use stiction_log::Motion;
use stiction_plan::{Elements, Limits, Subject};

/// What is planned for.
pub(super) struct Asked {
    pub subject: Subject,
    /// Whether there are waves along the position: where it counts from then matters.
    pub waves: bool,
    /// What is not planned for.
    pub warnings: Vec<Warning>,
}

/// The law that the terms stand beside.
pub(super) struct Law {
    /// Maxwell-slip elements in the place of LuGre.
    pub elements: Option<Elements>,
    /// Whether each direction has parameters of its own.
    pub is_asymmetric: bool,
    /// The commands that end in a plan for elements.
    pub steps: String,
}

/// What an axis file asks for on an axis that stands at `start`, m (rad).
pub(super) fn asked(
    axis: &Axis,
    motion: Motion,
    law: &Law,
    (start, limits): (f64, &Limits),
) -> Result<Asked, Error> {
    let is_asymmetric = law.is_asymmetric;
    let terms = axis.terms_of(motion, is_asymmetric)?;
    let mut own = Vec::new();
    let mut pitches = 0;
    if terms.gravity {
        own.extend(Subject::gravity(start));
    }
    for (k, pitch) in (1..).zip(&terms.cogging) {
        own.extend(Subject::cogging(k, *pitch, start));
    }
    if terms.quadratic_viscous {
        own.push(Subject::square(limits));
    }
    // Elements have no levels that depend on anything.
    let levels = terms.dependences.iter().filter(|_| law.elements.is_none());
    for dependence in levels {
        match dependence {
            Dependence::CoulombPosition(_) | Dependence::CoulombMap(_) => {
                own.push(Subject::level(limits));
            }
            Dependence::CoulombPitch(pitch) => {
                pitches += 1;
                own.extend(Subject::level_wave(pitches, *pitch, start));
            }
            _ => {}
        }
    }
    if !own.is_empty() {
        axis.fits(motion, &motion.force().si_text(), "plan")?;
    }
    let subject = Subject {
        elements: law.elements.map(|elements| Elements {
            delayed: terms.delay == Delay::Fitted,
            ..elements
        }),
        asymmetric: false,
        offset: terms.offset,
        terms: own,
    };
    Ok(Asked {
        waves: terms.gravity || !terms.cogging.is_empty() || pitches > 0,
        warnings: not_planned(axis, &terms, law).collect(),
        subject: match is_asymmetric {
            true => subject.directed(),
            false => subject,
        },
    })
}

fn warning(what: &str, instead: &str, motion: &str) -> Warning {
    Warning::new(Code::NotPlanned, format!("{what}: {instead}. {motion}"))
}

const ABSENT: &str = "planned as if absent, and no interval is expected of it";

/// Each key that is not planned for, and the motion that it needs.
fn not_planned<'a>(
    axis: &'a Axis,
    terms: &'a Terms,
    law: &'a Law,
) -> impl Iterator<Item = Warning> + 'a {
    let dependences = terms.dependences.iter().filter_map(|dependence| {
        let motion = match dependence {
            Dependence::CoulombLoad(_) => {
                "The load has to vary between runs: record this motion under at least three loads, the least, a middle one and the \
                 largest, and identify the logs together"
            }
            Dependence::CoulombTemperature(_) | Dependence::ViscousTemperature(_) => {
                "The temperature has to vary between runs: record this motion cold and warm, at least 10 K apart, best also half-way, \
                 and identify the logs together"
            }
            Dependence::CoulombTransmitted(_) | Dependence::CoulombDriven(_) => {
                "What the gear transmits has to vary: record this motion with and without a payload, or on both sides of the vertical and \
                 near it (two runs at least), and identify the logs together"
            }
            Dependence::CoulombLog(_) | Dependence::ViscousLog(_) => {
                "It differs from log to log: record this motion in each of the states that are to be told apart, twice at least in all"
            }
            Dependence::CoulombMap(_) => {
                return Some(warning(
                    "terms.coulomb_position = \"map\"",
                    "planned as a straight line, and no interval is expected of the rest",
                    "Constant speeds over the whole stroke, there and back, show it",
                ));
            }
            Dependence::CoulombPosition(_) | Dependence::CoulombPitch(_) => match law.elements {
                Some(_) => "Maxwell-slip elements have no level that depends on the position: plan and identify with --law lugre for it",
                None => return None,
            },
        };
        Some(warning(&format!("terms.{}", dependence.name()), ABSENT, motion))
    });
    let gaussian = "planned with the Gaussian curve, an exponent of 2";
    let curve = "Add constant speeds on either side of the Stribeck velocity, such as moves there and back at six speeds in equal ratios";
    let fitted = axis.exponent_fitted.then(|| {
        let instead = format!("{gaussian}, and no interval is expected of it");
        warning("terms.stribeck_exponent = \"fit\"", &instead, curve)
    });
    let given = axis.stribeck_exponent.filter(|exponent| *exponent != 2.0);
    let given = given.map(|exponent| {
        let what = format!(
            "terms.stribeck_exponent = {}",
            stiction_number::full(exponent)
        );
        warning(&what, gaussian, curve)
    });
    let elements = axis.gms_elements.filter(|_| law.elements.is_none());
    let elements = elements.map(|_| {
        let then = format!(
            "Limits say neither how many elements there are nor where they yield; a first log does: {}",
            law.steps
        );
        warning(
            "terms.gms_elements",
            "planned for LuGre, and no interval is expected of the elements",
            &then,
        )
    });
    let mass = (terms.mass == Mass::Absent).then(|| {
        warning(
            "mass = \"none\"",
            "planned as if the mass were fitted, so intervals may come out narrower",
            "Nothing has to be added",
        )
    });
    dependences
        .chain(fitted)
        .chain(given)
        .chain(elements)
        .chain(mass)
}

/// What a first model has and the axis file does not ask for.
pub(super) fn of_model(beyond: &[String]) -> Option<Warning> {
    (!beyond.is_empty()).then(|| {
        warning(
            &format!("the first identification has {}", beyond.join(", ")),
            ABSENT,
            "Ask for it under [terms] of the axis file, where it is fitted again",
        )
    })
}
