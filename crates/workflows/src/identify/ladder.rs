//! Laws side by side, on samples that none of them was fitted to.

use rayon::prelude::*;
use stiction_files::result::LawEntry;
use stiction_identify as engine;
use stiction_identify::{
    Estimate, Law, LawKind, LawScore, Observer, Optimum, Record, Settings, Terms,
};
use stiction_parameters::Quantity;
use stiction_search::{Shared, Stage};

/// Blocks that a record is cut into for cross-validation where no validation data are given: each law is fitted four
/// times, to three quarters of the record.
const CROSS_VALIDATION_BLOCKS: usize = 4;

/// What the laws are compared on.
pub(super) struct Ladder<'a> {
    pub record: &'a Record,
    /// Data to validate on; without them the record is cross-validated in blocks.
    pub held_out: &'a [Record],
    /// Linear terms beside a symmetric law.
    pub symmetric: &'a Terms,
    /// Linear terms beside an asymmetric law.
    pub asymmetric: &'a Terms,
    pub low_speed: f64,
}

/// A law, fitted and scored.
pub(super) struct Rung {
    pub estimate: Estimate,
    pub optimum: Optimum,
    score: LawScore,
}

/// What came of fitting several laws.
pub(super) struct Climb {
    /// Those that could be fitted, in the order of the laws.
    pub rungs: Vec<Rung>,
    /// Whether the observer stopped it half way: some laws are missing or unfinished.
    pub stopped: bool,
}

impl Ladder<'_> {
    /// Fits and scores laws, each on a thread of its own; `fitted` is one that was fitted already.
    pub fn climb(
        &self,
        laws: &[Law],
        fitted: Option<(&Estimate, &Optimum)>,
        settings: &Settings,
        observer: &mut dyn Observer,
    ) -> Climb {
        let shared = Shared::new(observer, laws.len());
        // The richest law first, as it takes longest. Threads take one law at a time, so that none holds two of them.
        let mut found: Vec<_> = laws
            .par_iter()
            .rev()
            .with_max_len(1)
            .map(|law| {
                let known = fitted.filter(|(estimate, _)| estimate.law == *law);
                let rung = self.rung(*law, known, settings, &shared);
                shared.one_more();
                rung
            })
            .collect();
        found.reverse();
        Climb {
            rungs: found.into_iter().flatten().collect(),
            stopped: shared.is_stopped(),
        }
    }

    /// The linear terms beside a law.
    pub fn terms(&self, law: &Law) -> &Terms {
        if law.asymmetric {
            self.asymmetric
        } else {
            self.symmetric
        }
    }

    /// Fits one law.
    pub fn fit(
        &self,
        law: Law,
        settings: &Settings,
        observer: &mut dyn Observer,
    ) -> Result<(Estimate, Optimum), engine::Error> {
        let terms = self.terms(&law);
        engine::fit_law(self.record, law, terms, self.low_speed, settings, observer)
    }

    fn rung(
        &self,
        law: Law,
        fitted: Option<(&Estimate, &Optimum)>,
        settings: &Settings,
        shared: &Shared,
    ) -> Result<Rung, engine::Error> {
        let mut relay = shared.relay(Stage::CrossValidation);
        let (estimate, optimum) = match fitted {
            Some((estimate, optimum)) => (estimate.clone(), optimum.clone()),
            None => self.fit(law, settings, &mut relay)?,
        };
        let score = if self.held_out.is_empty() {
            engine::cross_validate(
                self.record,
                &estimate,
                &optimum.bounds,
                CROSS_VALIDATION_BLOCKS,
                &mut relay,
            )
        } else {
            LawScore::on(self.held_out, &estimate)
        };
        Ok(Rung {
            estimate,
            optimum,
            score,
        })
    }
}

impl Rung {
    /// Whether the data determine its Coulomb level, without which no law is trusted.
    fn determined(&self) -> bool {
        let parameters = self.estimate.parameters.iter();
        let mut levels = parameters.filter(|p| p.name.quantity == Quantity::Coulomb);
        levels.all(|p| p.identifiable)
    }
}

impl Climb {
    /// The table of the laws, and which of them is best.
    pub fn entries(&self) -> (Vec<LawEntry>, Option<usize>) {
        let scores: Vec<LawScore> = self.rungs.iter().map(|r| r.score.clone()).collect();
        let standings = engine::choose(&scores);
        let best = standings.iter().position(|s| s.best);
        let entries = scores.iter().zip(standings);
        let entry = |(s, standing): (&LawScore, engine::Standing)| LawEntry {
            law: s.law.kind.name().into(),
            asymmetric: s.law.asymmetric,
            elements: s.law.kind.has_elements().then_some(s.law.elements),
            parameters: s.parameters,
            fitted_error_percent: s.fitted.relative_error_percent,
            held_out_error_percent: s.held_out.map(|f| f.relative_error_percent),
            held_out_low_speed_error_percent: s
                .held_out_low_speed
                .map(|f| f.relative_error_percent),
            held_out_excess_percent: standing.excess.map(|x| 100.0 * libm::expm1(x)),
            // Standard error of a ratio from that of its logarithm, to first order.
            held_out_excess_std_percent: (standing.excess.zip(standing.excess_std))
                .map(|(x, std)| 100.0 * std * libm::exp(x)),
            aic_difference: standing.aic,
            bic_difference: standing.bic,
            determined: false,
            best: standing.best,
        };
        let mut entries: Vec<LawEntry> = entries.map(entry).collect();
        for (entry, rung) in entries.iter_mut().zip(&self.rungs) {
            entry.determined = rung.determined();
        }
        (entries, best)
    }

    /// The best of some of the rungs.
    pub fn best_of(&self, rungs: &[usize]) -> Option<usize> {
        let scores: Vec<LawScore> = rungs.iter().map(|&i| self.rungs[i].score.clone()).collect();
        let best = engine::choose(&scores).iter().position(|s| s.best)?;
        Some(rungs[best])
    }
}

/// Every law, symmetric and asymmetric, from the simplest to the richest.
pub(super) fn every(base: Law) -> Vec<Law> {
    LawKind::ALL
        .into_iter()
        .flat_map(|kind| {
            let base = Law {
                kind,
                asymmetric: false,
                ..base
            };
            [base, base.asymmetric()]
        })
        .collect()
}

/// The laws to compare a law with: every family up to its own, each symmetric and asymmetric.
pub(super) fn beside(law: &Law) -> Vec<Law> {
    let top = law.kind.max(LawKind::Stribeck);
    every(*law)
        .into_iter()
        .filter(|other| other.kind <= top)
        // Beside LuGre, Dahl is the law without a Stribeck curve; one such law is enough.
        .filter(|other| {
            other.kind != LawKind::Dahl || !other.asymmetric || law.kind == LawKind::Dahl
        })
        .collect()
}
