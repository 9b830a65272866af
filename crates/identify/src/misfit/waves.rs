//! Waves over the position: one that the law lacks, and one that it has with a pitch that is off.

use super::coupling::beside::Beside;
use super::ripple::{Along, Repeats, Ripple};
use super::{Cause, Divided, Divisions, Misfit, spring_force};
use crate::law::terms::{ColumnKind, Terms};
use crate::separable::objective::{Evaluation, Objective};
use stiction_parameters::{Quantity, Wave};

/// Part of the residual that another pitch of a wave explains from which that is named, before all that looks alike, and the part
/// of a wave by which it is then off over the stroke.
const MOVED_SHARE: f64 = 0.3;
const MOVED_BY: f64 = 0.001;
/// Pitch over stroke from which a wave is a line on it, whose pitch says nothing.
pub(crate) const STRAIGHT: f64 = 4.0;
/// Part of what a wave explains that a line does where a force grows with the position: a wave that is hardly shorter than the stroke
/// goes nearly as one.
const OF_A_WAVE: f64 = 0.5;
/// What a wave leaves of a residual, over what a line over the position leaves, up to which the level has the wave.
const OF_A_LINE: f64 = 0.5;
/// Part of a level along the stroke that a line over the position has to explain for the level to go as one.
const LINE_SHARE: f64 = 0.5;

impl Divisions {
    /// The misfit with the wave over the position that explains it, where one does.
    pub fn waved(
        &self,
        misfit: Option<Misfit>,
        objective: &Objective,
        terms: &Terms,
        at: &Evaluation,
        residual: &[f64],
    ) -> Option<Misfit> {
        let cause = misfit.as_ref().and_then(Misfit::cause);
        let near = [Cause::Ripple, Cause::Position, Cause::Shape];
        if cause.is_some_and(|cause| !near.contains(&cause)) {
            return misfit;
        }
        let waves = given(terms, objective, at);
        if waves.is_empty() && cause.is_none() {
            return misfit;
        }
        let beside = Beside::new(&at.jacobian(), residual);
        let ones = vec![1.0; residual.len()];
        let level = level(objective, at);
        let along = |what| Along {
            what,
            position: &self.measures.position,
            weight: match what {
                Repeats::Force => &ones,
                Repeats::Level => &level,
            },
        };
        let moved = waves.iter().filter_map(|wave| {
            let found = along(wave.what).moved(wave.pitch, wave.factors, &beside)?;
            let named = found.share >= MOVED_SHARE
                && wave.pitch <= STRAIGHT * found.stroke
                && found.pitch > 0.0
                && found.off_by(wave.pitch) >= MOVED_BY;
            named.then_some(Ripple {
                replaces: Some(wave.place),
                ..found
            })
        });
        if let Some(found) = moved.max_by(|a, b| a.share.total_cmp(&b.share)) {
            let misfit = misfit.unwrap_or_else(|| self.unseen(Divided::Position, residual));
            return Some(self.of_a_wave(misfit, found, residual));
        }
        let mut misfit = misfit?;
        if cause == Some(Cause::Shape) {
            let sharp = along(Repeats::Force).best(residual, &beside);
            return Some(match sharp.filter(Ripple::is_sharp) {
                Some(found) => self.of_a_wave(misfit, found, residual),
                None => self.sprung(misfit, 0.0, &beside, residual),
            });
        }
        if cause == Some(Cause::Ripple) {
            misfit.ripple = along(Repeats::Force).best(residual, &beside);
            return Some(match misfit.ripple.filter(|wave| !wave.is_sharp()) {
                Some(wave) => self.sprung(misfit, OF_A_WAVE * wave.share, &beside, residual),
                None => misfit,
            });
        }
        if cause == Some(Cause::Position) {
            let own = along(Repeats::Level);
            let both = own.position.iter().zip(&level);
            let line: Vec<f64> = both.map(|(x, w)| x * w).collect();
            let of_a_line = beside.explained(&line).share;
            misfit.straight = of_a_line >= LINE_SHARE * misfit.share;
            let wave = own.best(residual, &beside);
            misfit.ripple = wave.filter(|wave| {
                wave.has_known_pitch() && 1.0 - wave.share <= OF_A_LINE * (1.0 - of_a_line)
            });
        }
        Some(misfit)
    }

    /// The misfit with a force that grows with the position, where that explains it and at least a part of the residual.
    fn sprung(&self, mut misfit: Misfit, least: f64, beside: &Beside, residual: &[f64]) -> Misfit {
        let found = spring_force::sought(&self.measures.position, self.length, beside);
        misfit.spring_force = found.filter(|found| found.share >= least);
        if let Some(found) = misfit.spring_force {
            misfit.ripple = None;
            self.along_the_position(&mut misfit, found.share, residual);
        }
        misfit
    }

    /// The misfit with a wave that is its cause.
    fn of_a_wave(&self, mut misfit: Misfit, found: Ripple, residual: &[f64]) -> Misfit {
        misfit.ripple = Some(found);
        self.along_the_position(&mut misfit, found.share, residual);
        misfit
    }

    /// Counts what something along the position explains of a residual, by which the misfit is shown then.
    fn along_the_position(&self, misfit: &mut Misfit, share: f64, residual: &[f64]) {
        misfit.count(share, residual);
        misfit.by = Divided::Position;
        misfit.shown_by = misfit.by;
        let place = Divided::ALL.iter().position(|own| *own == misfit.by);
        misfit.course = place.map_or_else(Vec::new, |i| self.course(i, residual));
    }
}

/// A wave that a law has.
struct Given {
    what: Repeats,
    /// Its place among those of its kind, from 0.
    place: usize,
    pitch: f64,
    /// Factors of its sine and cosine, in the unit of the force.
    factors: [f64; 2],
}

/// The waves of a fit, those of an asymmetric level in the mean of both directions.
fn given(terms: &Terms, objective: &Objective, at: &Evaluation) -> Vec<Given> {
    let factor = |quantity: Quantity| {
        let both = objective.linear().iter().zip(&at.solution.coefficients);
        let own = both.filter(|(term, _)| term.name.quantity == quantity);
        let (sum, count) = own.fold((0.0, 0.0), |(sum, count), (_, c)| (sum + c, count + 1.0));
        (count > 0.0).then(|| sum / count)
    };
    let factors =
        |of: &dyn Fn(Wave) -> Quantity| Some([factor(of(Wave::Sine))?, factor(of(Wave::Cosine))?]);
    let forces = terms
        .cogging
        .iter()
        .enumerate()
        .filter_map(|(place, &pitch)| {
            Some(Given {
                what: Repeats::Force,
                place,
                pitch,
                factors: factors(&|part| Quantity::Cogging(place as u32 + 1, part))?,
            })
        });
    let levels = terms.level_pitches().into_iter().enumerate();
    let levels = levels.filter_map(|(place, pitch)| {
        Some(Given {
            what: Repeats::Level,
            place,
            pitch,
            factors: factors(&|part| Quantity::CoulombPitch(place as u32 + 1, part))?,
        })
    });
    forces.chain(levels).collect()
}

/// What a level of friction multiplies at the kept samples: 1 where the axis slides forward.
fn level(objective: &Objective, at: &Evaluation) -> Vec<f64> {
    let mut out = vec![0.0; at.residual().len()];
    for (term, column) in objective.linear().iter().zip(&at.columns) {
        if matches!(term.column, ColumnKind::Level | ColumnKind::Sign(_)) {
            out.iter_mut().zip(column.iter()).for_each(|(y, x)| *y += x);
        }
    }
    out
}
