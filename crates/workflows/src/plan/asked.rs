//! What the axis file asks of a motion beside LuGre: the terms that are planned for, and those that are not, by name.

use crate::error::Error;
use stiction_files::{Axis, Warning};
use stiction_identify::{Delay, Dependence, Mass, Terms};
use stiction_log::Motion;
use stiction_plan::{Elements, Limits, Subject};
use stiction_say::{Notice, Unplanned};

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

/// Each key that is not planned for, and the motion that it needs.
fn not_planned<'a>(
    axis: &'a Axis,
    terms: &'a Terms,
    law: &'a Law,
) -> impl Iterator<Item = Warning> + 'a {
    let dependences = terms.dependences.iter().filter_map(|dependence| {
        let key = dependence.name();
        match dependence {
            Dependence::CoulombLoad(_) => Some(Unplanned::Load(key)),
            Dependence::CoulombTemperature(_) | Dependence::ViscousTemperature(_) => {
                Some(Unplanned::Temperature(key))
            }
            Dependence::CoulombTransmitted(_) | Dependence::CoulombDriven(_) => {
                Some(Unplanned::Transmitted(key))
            }
            Dependence::CoulombLog(_) | Dependence::ViscousLog(_) => Some(Unplanned::Logs(key)),
            Dependence::CoulombMap(_) => Some(Unplanned::Map),
            Dependence::CoulombPosition(_) | Dependence::CoulombPitch(_) => {
                let elements = law.elements.is_some();
                elements.then_some(Unplanned::ElementsByPosition(key))
            }
        }
    });
    let fitted = axis.exponent_fitted.then_some(Unplanned::FittedExponent);
    let given = axis.stribeck_exponent.filter(|exponent| *exponent != 2.0);
    let given = given.map(Unplanned::Exponent);
    let elements = axis.gms_elements.filter(|_| law.elements.is_none());
    let elements = elements.map(|_| Unplanned::Elements(law.steps.clone()));
    let mass = (terms.mass == Mass::Absent).then_some(Unplanned::NoMass);
    dependences
        .chain(fitted)
        .chain(given)
        .chain(elements)
        .chain(mass)
        .map(|what| Notice::Unplanned(what).into())
}

/// What a first model has and the axis file does not ask for.
pub(super) fn of_model(beyond: &[String]) -> Option<Warning> {
    let what = || Unplanned::FirstModel(beyond.to_vec());
    (!beyond.is_empty()).then(|| Notice::Unplanned(what()).into())
}
