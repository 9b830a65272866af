//! The chosen law beside simpler ones, on samples that none of them was fitted to.

use crate::result::LawEntry;
use stiction_identify as engine;
use stiction_identify::{
    Estimate, Fit, Law, LawKind, LawScore, Observer, Record, SearchBox, Settings, Silent, Terms,
};

/// Blocks of the cross-validation where no validation data are given.
const BLOCKS: usize = 4;

/// What the laws are compared on.
pub(super) struct Ladder<'a> {
    pub record: &'a Record,
    /// Data to validate on; without them the record is cross-validated in blocks.
    pub held_out: Option<&'a Record>,
    /// Linear terms beside a symmetric law.
    pub symmetric: &'a Terms,
    /// Linear terms beside an asymmetric law.
    pub asymmetric: &'a Terms,
    pub low_speed: f64,
}

impl Ladder<'_> {
    /// Scores the fitted law and the simpler ones below it; the smallest held-out error is best.
    pub fn climb(
        &self,
        chosen: &Estimate,
        bounds: &SearchBox,
        settings: &Settings,
        observer: &mut dyn Observer,
    ) -> Vec<LawEntry> {
        let mut scores = Vec::new();
        for law in below(&chosen.law) {
            if law == chosen.law {
                scores.push(self.score(chosen, bounds, observer));
                continue;
            }
            let terms = if law.asymmetric {
                self.asymmetric
            } else {
                self.symmetric
            };
            let Ok(optimum) = engine::separable(self.record, law, terms, settings, &mut Silent)
            else {
                continue;
            };
            let fitted = engine::estimate(self.record, law, terms, &optimum, self.low_speed);
            scores.push(self.score(&fitted, &optimum.bounds, observer));
        }
        entries(&scores)
    }

    fn score(
        &self,
        fitted: &Estimate,
        bounds: &SearchBox,
        observer: &mut dyn Observer,
    ) -> LawScore {
        let Some(record) = self.held_out else {
            return engine::cross_validate(self.record, fitted, bounds, BLOCKS, observer);
        };
        let series = engine::predict(record, fitted);
        let residual = series.residual();
        LawScore {
            law: fitted.law,
            parameters: fitted.parameters.iter().filter(|p| p.identified).count(),
            fitted: fitted.fit,
            held_out: Fit::new(&series.measured, &residual),
            held_out_low_speed: Fit::slow(
                &series.measured,
                &residual,
                &series.velocity,
                self.low_speed,
            ),
        }
    }
}

/// The static laws, symmetric and as asked, and the law itself.
fn below(law: &Law) -> Vec<Law> {
    let mut out = Vec::new();
    for kind in [LawKind::CoulombViscous, LawKind::Stribeck] {
        let base = Law {
            kind,
            asymmetric: false,
            exponent: law.exponent,
        };
        out.push(base);
        out.push(base.asymmetric());
    }
    if law.asymmetric {
        out.push(Law {
            asymmetric: false,
            ..*law
        });
    }
    out.push(*law);
    let mut seen: Vec<Law> = Vec::new();
    out.retain(|l| {
        let new = !seen.contains(l);
        seen.push(*l);
        new
    });
    out
}

fn entries(scores: &[LawScore]) -> Vec<LawEntry> {
    let error = |s: &LawScore| s.held_out.map(|f| f.relative_error_percent);
    let best = scores
        .iter()
        .filter_map(error)
        .fold(f64::INFINITY, f64::min);
    scores
        .iter()
        .map(|s| LawEntry {
            law: s.law.kind.name().into(),
            asymmetric: s.law.asymmetric,
            parameters: s.parameters,
            fitted_error_percent: s.fitted.relative_error_percent,
            held_out_error_percent: error(s),
            held_out_low_speed_error_percent: s
                .held_out_low_speed
                .map(|f| f.relative_error_percent),
            best: error(s) == Some(best),
        })
        .collect()
}
