//! The two steps of Zhang et al. 2025 (doi 10.1371/journal.pone.0322844), eqs. (8) and (9), each by a search: the steady
//! curve through constant velocities, then sigma0 and sigma1 with the curve held.

use super::course::{Course, run};
use super::ranges;
use super::watch::Ended;
use crate::error::Error;
use crate::identify::load::Asked;
use crate::identify::logs::refused;
use crate::source::Source;
use libm::exp;
use stiction_files::Warning;
use stiction_files::result::SearchedEntry;
use stiction_identify::candidates::{
    Candidates, Curve, Dynamic, Scheme, SixParameters, box_of_curve, box_of_six,
};
use stiction_identify::procedure::{Exponent, StaticPoint, StaticSettings, Statics};
use stiction_identify::{Law, LawKind, Name, Observer, Record, Terms};
use stiction_say::Notice;
use stiction_search::Counts;

/// What a search of one step found.
pub(in crate::identify) struct Step {
    pub entry: SearchedEntry,
    pub counts: Counts,
    /// Where least squares begin: Stribeck velocities, m/s or rad/s; or `ln(sigma0/Fc)`.
    pub near: Vec<f64>,
    /// What the search found, by name, SI; where least squares are left out, the answer.
    pub values: Vec<(Name, f64)>,
    pub interrupted: bool,
    /// Unknowns at an end of their range, in words.
    at_ends: Vec<String>,
}

impl Step {
    /// Says which unknowns the box of the search keeps from going on.
    pub fn warning(&self) -> Option<Warning> {
        let each = self.at_ends.clone();
        (!each.is_empty()).then(|| Notice::AtBounds { each }.into())
    }
}

/// The search that the steps are to make; `None` where least squares alone are asked for.
fn course(asked: Asked) -> Result<Option<Course>, Error> {
    let Asked {
        options,
        axis,
        clock,
    } = asked;
    let name = options.searching.search;
    name.map(|name| Course::of(options, axis, name, clock))
        .transpose()
}

/// Searches the steady curve through points.
pub(in crate::identify) fn curve(
    asked: Asked,
    sources: &[Source],
    points: &[StaticPoint],
    settings: &StaticSettings,
    observer: &mut dyn Observer,
) -> Result<Option<Step>, Error> {
    let Some(course) = course(asked)? else {
        return Ok(None);
    };
    let fail = |e| refused(sources, e);
    if settings.exponent == Exponent::Fitted {
        return Err(Error::usage(
            "stribeck_exponent = \"fit\" beside a search",
            "a number",
        ));
    }
    let speed: Vec<f64> = points.iter().map(|p| p.velocity).collect();
    let force: Vec<f64> = points.iter().map(|p| p.force).collect();
    let bounds = box_of_curve(&speed, &force, settings.asymmetric).map_err(fail)?;
    let bounds = ranges::given(asked.axis, sources, bounds, ranges::CURVE)?;
    let problem = Curve::robust(points, settings, bounds).map_err(fail)?;
    let names = ranges::names(ranges::CURVE);
    let unknowns = match settings.asymmetric {
        true => ["_pos", "_neg"]
            .iter()
            .flat_map(|side| names.iter().map(move |name| format!("{name}{side}")))
            .collect(),
        false => names,
    };
    let found = run(&course, &problem, "curve", unknowns, None, observer)?;
    let near = found.point.chunks(ranges::CURVE.len());
    Ok(Some(Step {
        near: near.map(|genes| exp(genes[3])).collect(),
        values: problem.parameters(&found.point),
        interrupted: found.ended == Ended::Interrupted,
        at_ends: found.at_ends,
        entry: found.entry,
        counts: found.counts,
    }))
}

/// Searches sigma0 and sigma1 with the curve held.
pub(in crate::identify) fn dynamic(
    asked: Asked,
    sources: &[Source],
    record: &Record,
    statics: &Statics,
    terms: &Terms,
    observer: &mut dyn Observer,
) -> Result<Option<Step>, Error> {
    let Some(course) = course(asked)? else {
        return Ok(None);
    };
    if statics.asymmetric {
        return Err(Error::usage(
            "a search for sigma0 and sigma1 beside a curve with parameters for each direction",
            "a symmetric curve; or static-then-dynamic without a search, whose least squares take both directions",
        ));
    }
    let fail = |e| refused(sources, e);
    let law = Law {
        exponent: statics.exponent,
        ..Law::new(LawKind::LuGre)
    };
    let bounds = box_of_six(record).map_err(fail)?;
    let bounds = ranges::given(asked.axis, sources, bounds, ranges::SIX)?;
    let six = SixParameters::new(record, law, terms, bounds, Scheme::Explin).map_err(fail)?;
    let problem = Dynamic::new(six, &statics.sides[0]).map_err(fail)?;
    let unknowns = ranges::names(ranges::BRISTLE);
    let found = run(&course, &problem, "dynamic", unknowns, None, observer)?;
    let coulomb = libm::log(statics.sides[0].coulomb);
    Ok(Some(Step {
        near: vec![found.point[0] - coulomb],
        values: problem.parameters(&found.point),
        interrupted: found.ended == Ended::Interrupted,
        at_ends: found.at_ends,
        entry: found.entry,
        counts: found.counts,
    }))
}
