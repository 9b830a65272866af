//! A map of the level of friction over the stroke: a straight line and cosines.
//!
//! Over a stroke of length `l` that begins at `a`, with `s = (x - a)/l`, the level is
//! `Fc + m1 (2 s - 1) + m2 cos(pi s) + m3 cos(2 pi s) + ...`, so that `Fc` is its mean along the stroke. Cosines alone have no slope
//! at the ends and would follow a ramp slowly; the line takes that off (Eubank and Speckman 1990, Biometrika 77, 1, doi
//! 10.1093/biomet/77.1.1).

use crate::conditioning::record::{Record, extent};
use crate::estimate::estimate;
use crate::estimate::fitted::FittedLaw;
use crate::law::Law;
use crate::law::dependence::Dependence;
use crate::law::terms::Terms;
use crate::separable::separable;
use crate::separable::settings::Settings;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;
use stiction_friction::compensator::WAVES;
use stiction_parameters::Quantity;
use stiction_policy::choice;
use stiction_search::{Observer, Status};

/// A map, over the stroke of a record once [`Terms::about`] has taken it from there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Map {
    /// Where the stroke begins, m or rad.
    pub start: f64,
    /// How long it is, m or rad.
    pub stroke: f64,
    /// How many parts there are, 0 to `most`: the line, then the cosines.
    pub terms: usize,
    /// How many there may be, at most [`MOST`](Self::MOST).
    pub most: usize,
}

impl Default for Map {
    fn default() -> Self {
        Self {
            start: 0.0,
            stroke: 0.0,
            terms: Self::MOST,
            most: Self::MOST,
        }
    }
}

impl Map {
    /// Most parts: a line, and as many cosines as a compensator has room for waves along the position.
    pub const MOST: usize = 1 + WAVES;

    /// Whether the data would carry more parts than there may be: then nothing bounds what is left out.
    pub fn is_truncated(&self) -> bool {
        self.terms == self.most
    }

    /// The same over the stroke of a record; without parts where it has none.
    pub(crate) fn about(self, record: &Record) -> Self {
        let (low, high) = extent(&record.pick(|s| &s.channels.position));
        match low < high {
            true => Self {
                start: low,
                stroke: high - low,
                ..self
            },
            false => Self { terms: 0, ..self },
        }
    }

    /// The middle of the stroke, m or rad.
    pub(crate) fn middle(&self) -> f64 {
        self.start + 0.5 * self.stroke
    }

    /// A part, counted from 1, at a place, which is held within the stroke.
    pub(crate) fn part(&self, k: usize, x: f64) -> f64 {
        let s = ((x - self.start) / self.stroke).clamp(0.0, 1.0);
        match k {
            1 => 2.0 * s - 1.0,
            _ => libm::cos((k - 1) as f64 * PI * s),
        }
    }
}

impl Terms {
    /// The map of the level, if there is one.
    pub fn map(&self) -> Option<Map> {
        self.dependences.iter().find_map(|own| match own {
            Dependence::CoulombMap(map) => Some(*map),
            _ => None,
        })
    }

    /// The same with as much of a map of the level as a record carries: no map, a line, or a line and some cosines.
    ///
    /// What is lost where the last ones are left out is the Wald statistic of their coefficients in a fit of the whole map, with
    /// the covariance that counts the correlation of the residual. Whether there is a map at all is decided by BIC, which finds
    /// none where there is none, with the effective samples of the residual; how far it goes by AIC, so that what is left out
    /// is less than what the intervals state.
    ///
    /// The terms are [`about`](Self::about) the record; without a map, or where it cannot be fitted, they stay as they are.
    #[must_use]
    pub fn mapped(
        &self,
        record: &Record,
        law: Law,
        settings: &Settings,
        observer: &mut dyn Observer,
    ) -> Self {
        let Some(map) = self.map() else {
            return self.clone();
        };
        let Ok(optimum) = separable(record, law, self, settings, observer) else {
            return self.clone();
        };
        if optimum.status == Status::Interrupted {
            return self.clone();
        }
        let fitted = estimate(record, law, self, &optimum, 0.0);
        let carried = Dependence::CoulombMap(Map {
            terms: carried(&fitted, map.terms),
            ..map
        });
        let dependence = |own: &Dependence| match own {
            Dependence::CoulombMap(_) => carried,
            other => *other,
        };
        Self {
            dependences: self.dependences.iter().map(dependence).collect(),
            ..self.clone()
        }
    }
}

/// How many of so many parts of a map, in their order, a fit of all of them carries.
fn carried(fitted: &FittedLaw, terms: usize) -> usize {
    let found = (1..=terms).filter_map(|k| {
        let quantity = Quantity::CoulombMap(k as u32);
        let place = fitted.covariance.place(quantity.into())?;
        Some((place, fitted.value(quantity)?))
    });
    let found: Vec<(usize, f64)> = found.collect();
    let lost = |kept: usize| {
        let rest = &found[kept..];
        let c = DVector::from_iterator(rest.len(), rest.iter().map(|(_, c)| *c));
        let at = |i: usize, j: usize| fitted.covariance.matrix[rest[i].0][rest[j].0];
        let covariance = DMatrix::from_fn(rest.len(), rest.len(), at);
        // A column that cannot be told from others has no variance, and is no reason for a map.
        covariance
            .cholesky()
            .map_or(0.0, |factor| c.dot(&factor.solve(&c)))
    };
    let least = |first: usize, penalty: f64| {
        let all = (first..=found.len()).map(|kept| (kept, lost(kept) + penalty * kept as f64));
        all.min_by(|a, b| a.1.total_cmp(&b.1))
            .map_or(0, |(kept, _)| kept)
    };
    match least(0, libm::log(fitted.fit.effective_samples)) {
        0 => 0,
        _ => least(1, choice::AIC_PER_PARAMETER),
    }
}
