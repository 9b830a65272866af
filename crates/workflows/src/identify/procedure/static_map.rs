//! `--method static`: constant velocities to Fc, Fs, vs, sigma2.

use super::break_away::break_away;
use super::map::{Mapped, map};
use crate::error::Error;
use crate::identify::assemble::{self, Parts};
use crate::identify::load::{Asked, Loaded};
use crate::identify::logs::log_warnings_but;
use crate::identify::outcome::{Found, Outcome};
use crate::identify::trust;
use crate::source::Source;
use stiction_files::{Axis, Warning};
use stiction_identify::{LawKind, Observer, Status};
use stiction_say::{Found as Kind, Notice};

/// The whole workflow.
pub(in crate::identify) fn run(
    asked: Asked,
    loaded: Loaded,
    observer: &mut dyn Observer,
) -> Result<Outcome, Error> {
    asked.options.require(
        &[LawKind::CoulombViscous, LawKind::Stribeck, LawKind::LuGre],
        "a static map has no stiffness: coulomb-viscous, or stribeck (also meant by lugre)",
    )?;
    let sources = &loaded.sources;
    let mut found = map(asked, sources, observer)?;
    let mut law = found.map.fitted_law();
    law.counts.add(&found.counts);
    let outlying = found.map.outlying().count();
    if found.interrupted {
        law.status = Status::Interrupted;
    }
    // A log of constant velocities moves at few speeds on purpose, perhaps in one direction: what counts is whether all
    // points together do.
    let is_on_purpose =
        |found: &Kind| matches!(found, Kind::OneSpeed { .. } | Kind::OneDirection { .. });
    let mut warnings = log_warnings_but(sources, is_on_purpose);
    warnings.extend(one_direction(&found));
    warnings.append(&mut found.warnings);
    let judged = trust::of_static_map(&law, outlying, sources, loaded.motion(), warnings);
    let break_away = break_away(&loaded.beside, &law)?;
    let mut result = assemble::result(Parts {
        asked,
        sources,
        conditioning: notes(&found, sources, asked.axis),
        unsettled: None,
        law: &law,
        validation: &[],
        laws: Vec::new(),
        late: 0.0,
        without: Vec::new(),
        law_chosen_by: "user",
        judged,
    });
    result.static_map = Some(found.entry);
    break_away.into_result(&mut result);
    let found = Found::Procedure(Box::new(law));
    Ok(Outcome::new(result, found, Vec::new(), loaded.sources))
}

/// A warning where every point is of the same direction.
fn one_direction(found: &Mapped) -> Option<Warning> {
    let points = &found.map.points;
    let forward = points.iter().filter(|p| p.velocity > 0.0).count();
    if forward > 0 && forward < points.len() {
        return None;
    }
    let points = points.len();
    Some(Notice::PointsOneWay { points }.into())
}

fn notes(found: &Mapped, sources: &[Source], axis: &Axis) -> Vec<String> {
    let mut notes = vec![
        "force and position as logged, nothing filtered".to_string(),
        format!(
            "{} constant-velocity stretches, sought in the {}; ends and transients dropped (marginal \
             standard error rule)",
            found.map.points.len(),
            if sources.iter().all(|s| s.log.reference.is_some()) {
                "reference"
            } else {
                "position"
            }
        ),
    ];
    if !axis.terms.cogging.is_empty() {
        let whole = found.map.points.iter().filter(|p| p.pitches > 0).count();
        notes.push(format!(
            "{whole} of them averaged over whole cogging pitches"
        ));
    }
    notes.push("robust loss: Tukey's, its scale from the points".into());
    notes
}
