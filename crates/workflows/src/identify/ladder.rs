//! Laws side by side, on samples that none of them was fitted to.

use rayon::prelude::*;
use stiction_files::result::LawEntry;
use stiction_identify as engine;
use stiction_identify::{
    Estimate, Law, LawKind, LawScore, Observer, Optimum, Record, Settings, Status, Terms,
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
    /// Linear terms beside the laws.
    pub terms: &'a LinearTerms,
    /// The same with quadratic viscous friction, where the axis file leaves that open.
    pub bent: Option<LinearTerms>,
    /// Those beside a law that begins to look for the delay of the force, where that is asked for, at what another finds.
    pub held_delay: Option<LinearTerms>,
    pub low_speed: f64,
    /// Whether only laws with the same parameters in both directions are chosen from.
    pub symmetric: bool,
    /// Whether the Stribeck exponent is assumed, and may be fitted where the data ask for it.
    pub exponent_is_open: bool,
}

/// Linear terms beside the laws.
#[derive(Clone)]
pub(super) struct LinearTerms {
    /// Beside a symmetric law.
    pub symmetric: Terms,
    /// Beside an asymmetric law.
    pub asymmetric: Terms,
}

/// A law to fit, and what stands beside it.
#[derive(Clone)]
pub(super) struct Candidate<'a> {
    pub law: Law,
    pub terms: &'a Terms,
    /// Where descents start: at the end points of laws that it holds or that hold it. Without any, its whole range is
    /// searched.
    pub starts: Vec<Vec<f64>>,
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
    /// Fits and scores laws, each on a thread of its own; `fitted` are those that were fitted already.
    pub fn climb(
        &self,
        laws: &[Candidate],
        fitted: &[(&Estimate, &Optimum)],
        settings: &Settings,
        observer: &mut dyn Observer,
    ) -> Climb {
        let shared = Shared::new(observer, laws.len());
        // The richest law first, as it takes longest. Threads take one law at a time, so that none holds two of them.
        let mut found: Vec<_> = laws
            .par_iter()
            .rev()
            .with_max_len(1)
            .map(|candidate| {
                let mut known = fitted.iter().copied();
                let known = known.find(|(estimate, _)| candidate.is(estimate));
                let rung = self.rung(candidate, known, settings, &shared);
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

    /// A law with the terms that stand beside it unless others are asked for.
    pub fn usual(&self, law: Law) -> Candidate<'_> {
        let held = self.held_delay.as_ref();
        let held = held.filter(|_| law.kind.has_elements());
        let terms = held.unwrap_or(self.terms).beside(law.asymmetric);
        Candidate {
            law,
            terms,
            starts: Vec::new(),
        }
    }

    /// The same with quadratic viscous friction; `None` where the axis file asks for it beside every law.
    pub fn bent(&self, law: Law) -> Option<Candidate<'_>> {
        let terms = self.bent.as_ref()?.beside(law.asymmetric);
        Some(Candidate {
            terms,
            ..self.usual(law)
        })
    }

    /// A law with the terms that another one was fitted with.
    pub fn as_beside(&self, law: Law, rung: &Rung) -> Candidate<'_> {
        let terms = &rung.estimate.terms;
        let bent = self.bent.as_ref();
        let bent = bent.filter(|_| terms.quadratic_viscous);
        Candidate {
            terms: bent.unwrap_or(self.terms).beside(law.asymmetric),
            ..self.usual(law)
        }
    }

    /// Fits the law that says where another one begins to look for the delay of the force, where it is asked for, and keeps what it finds.
    pub fn hold_delay(
        &mut self,
        law: Law,
        settings: &Settings,
        observer: &mut dyn Observer,
    ) -> Option<(Estimate, Optimum)> {
        let terms = self.terms.beside(law.asymmetric);
        if !terms.asks_delay_of_another(&law) {
            return None;
        }
        let bound = self.low_speed;
        let found = engine::delay_of_another(self.record, law, terms, bound, settings, observer);
        // Where it cannot be found the law that was asked for says what is missing.
        let (other, left) = found.ok()?;
        self.held_delay = Some(self.terms.holding_delay_of(&other));
        Some(left)
    }

    /// Fits one law.
    pub fn fit(
        &self,
        candidate: &Candidate,
        settings: &Settings,
        observer: &mut dyn Observer,
    ) -> Result<(Estimate, Optimum), engine::Error> {
        let Candidate {
            law, terms, starts, ..
        } = candidate;
        let (record, bound) = (self.record, self.low_speed);
        let Some((first, others)) = starts.split_first() else {
            return engine::fit_law(record, *law, terms, bound, settings, observer);
        };
        let mut from =
            |start| engine::fit_law_from(start, record, *law, terms, bound, settings, observer);
        let mut best = from(first)?;
        for start in others {
            let other = from(start)?;
            if other.1.evaluation.cost < best.1.evaluation.cost {
                best = other;
            }
        }
        Ok(best)
    }

    fn rung(
        &self,
        candidate: &Candidate,
        fitted: Option<(&Estimate, &Optimum)>,
        settings: &Settings,
        shared: &Shared,
    ) -> Result<Rung, engine::Error> {
        let mut relay = shared.relay(Stage::CrossValidation);
        let (estimate, optimum) = match fitted {
            Some((estimate, optimum)) => (estimate.clone(), optimum.clone()),
            None => self.fit(candidate, settings, &mut relay)?,
        };
        let score = if self.held_out.is_empty() {
            engine::cross_validate(
                self.record,
                &estimate,
                &optimum,
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

impl LinearTerms {
    /// Those beside a law of this kind.
    pub fn beside(&self, asymmetric: bool) -> &Terms {
        match asymmetric {
            true => &self.asymmetric,
            false => &self.symmetric,
        }
    }

    /// The same with quadratic viscous friction.
    pub fn bent(&self) -> Self {
        let bent = |terms: &Terms| Terms {
            quadratic_viscous: true,
            ..terms.clone()
        };
        Self {
            symmetric: bent(&self.symmetric),
            asymmetric: bent(&self.asymmetric),
        }
    }

    fn holding_delay_of(&self, other: &Estimate) -> Self {
        let held = |terms: &Terms| terms.holding_delay_of(other);
        Self {
            symmetric: held(&self.symmetric),
            asymmetric: held(&self.asymmetric),
        }
    }
}

impl<'a> Candidate<'a> {
    /// The same with descents from the end points of other laws.
    pub fn from(mut self, rungs: &[&Rung]) -> Self {
        let starts = rungs.iter().map(|rung| rung.optimum.start_for(&self.law));
        self.starts = starts.collect();
        self
    }

    /// Whether an estimate is of this law with these terms; a delay at the end of its range was taken out of its terms.
    fn is(&self, estimate: &Estimate) -> bool {
        let same = |terms: &Terms| (terms.offset, terms.quadratic_viscous);
        estimate.law == self.law && same(&estimate.terms) == same(self.terms)
    }
}

impl Rung {
    /// Whether the data determine its Coulomb level.
    fn determined(&self) -> bool {
        let parameters = self.estimate.parameters.iter();
        let mut levels = parameters.filter(|p| p.name.quantity == Quantity::Coulomb);
        levels.all(|p| p.identifiable)
    }

    /// Whether the data leave a parameter of this quantity open, in either direction.
    pub fn leaves_open(&self, quantity: Quantity) -> bool {
        let mut parameters = self.estimate.parameters.iter();
        parameters.any(|p| p.name.quantity == quantity && p.identified && !p.identifiable)
    }

    /// Relative error on held-out samples, percent; infinite without one.
    pub fn held_out_error(&self) -> f64 {
        let error = self.score.held_out.map(|f| f.relative_error_percent);
        error.unwrap_or(f64::INFINITY)
    }

    /// Rms residual on samples of the record held out in turn; `None` where it was not cross-validated.
    pub fn cross_validated_rmse(&self, ladder: &Ladder) -> Option<f64> {
        let held_out = self.score.held_out.filter(|_| ladder.held_out.is_empty());
        held_out.map(|fit| fit.rmse)
    }

    /// Why it is not taken; `None` where it may be.
    fn held_back(&self) -> Option<String> {
        let status = self.optimum.status;
        let ended = matches!(status, Status::Converged | Status::Interrupted);
        (!ended).then(|| format!("its search ended with {}", status.name()))
    }

    fn entry(&self, standing: &engine::Standing) -> LawEntry {
        let Rung {
            estimate, score, ..
        } = self;
        let law = &score.law;
        LawEntry {
            law: law.kind.name().into(),
            asymmetric: law.asymmetric,
            without: without(law),
            exponent_fitted: law.has_stribeck() && law.exponent_fitted,
            offset: estimate.terms.offset,
            quadratic_viscous: estimate.terms.quadratic_viscous,
            elements: law.kind.has_elements().then_some(law.elements),
            parameters: score.parameters,
            fitted_error_percent: score.fitted.relative_error_percent,
            held_out_error_percent: score.held_out.map(|f| f.relative_error_percent),
            held_out_low_speed_error_percent: score
                .held_out_low_speed
                .map(|f| f.relative_error_percent),
            held_out_excess_percent: standing.excess.map(|x| 100.0 * libm::expm1(x)),
            // Standard error of a ratio from that of its logarithm, to first order.
            held_out_excess_std_percent: (standing.excess.zip(standing.excess_std))
                .map(|(x, std)| 100.0 * std * libm::exp(x)),
            aic_difference: standing.aic,
            bic_difference: standing.bic,
            determined: self.determined(),
            held_back: self.held_back(),
            best: standing.best,
            as_good: standing.as_good,
            reported: false,
        }
    }
}

impl Climb {
    /// The same with further rungs.
    pub fn and(mut self, more: Climb) -> Self {
        self.rungs.extend(more.rungs);
        self.stopped |= more.stopped;
        self
    }

    /// The rungs from the simplest law to the richest, each symmetric one before its asymmetric ones.
    pub fn sorted(mut self) -> Self {
        self.rungs.sort_by_key(|rung| {
            let law = &rung.estimate.law;
            let held = usize::from(law.flat) + usize::from(law.undamped);
            let terms = &rung.estimate.terms;
            let offset = terms.offset;
            let exponent = law.exponent_fitted;
            (
                law.kind,
                law.asymmetric,
                terms.quadratic_viscous,
                2 - held,
                law.undamped,
                exponent,
                offset,
            )
        });
        self
    }

    /// Whether a law with these terms was fitted already.
    pub fn has(&self, candidate: &Candidate) -> bool {
        self.rungs.iter().any(|rung| candidate.is(&rung.estimate))
    }

    /// Those with fewer parameters.
    pub fn simpler_than(&self, parameters: usize) -> Vec<Estimate> {
        let fewer = self
            .rungs
            .iter()
            .filter(|rung| rung.score.parameters < parameters);
        fewer.map(|rung| rung.estimate.clone()).collect()
    }

    /// The table of the laws, and which of them is best.
    pub fn entries(&self) -> (Vec<LawEntry>, Option<usize>) {
        let standings = engine::choose(&self.scores(0..self.rungs.len()));
        let best = standings.iter().position(|s| s.best);
        let rungs = self.rungs.iter().zip(&standings);
        let entries = rungs.map(|(rung, standing)| rung.entry(standing));
        (entries.collect(), best)
    }

    /// The best of some of the rungs.
    pub fn best_of(&self, rungs: &[usize]) -> Option<usize> {
        let standings = engine::choose(&self.scores(rungs.iter().copied()));
        Some(rungs[standings.iter().position(|s| s.best)?])
    }

    fn scores(&self, rungs: impl Iterator<Item = usize>) -> Vec<LawScore> {
        rungs.map(|i| self.rungs[i].score.clone()).collect()
    }
}

/// What of a law is left out, as `result.json` names it.
pub(super) fn without(law: &Law) -> Vec<String> {
    let held = [(law.flat, "stribeck"), (law.undamped, "sigma1")];
    let names = held
        .into_iter()
        .filter_map(|(held, name)| held.then_some(name));
    names.map(String::from).collect()
}

/// The symmetric laws of some families.
pub(super) fn symmetric(base: Law, kinds: &[LawKind]) -> Vec<Law> {
    let law = |&kind: &LawKind| Law {
        kind,
        asymmetric: false,
        elements: if kind.has_elements() {
            base.elements
        } else {
            0
        },
        ..base
    };
    kinds.iter().map(law).collect()
}

/// The laws to compare a law with: every family up to its own, at least up to LuGre, each symmetric and asymmetric; of Maxwell slip,
/// whose number of elements is found for each, those that are as symmetric as it is.
pub(super) fn beside(law: &Law) -> Vec<Law> {
    let top = law.kind.max(LawKind::LuGre);
    symmetric(*law, &LawKind::ALL)
        .into_iter()
        .flat_map(|law| [law, law.asymmetric()])
        .filter(|other| other.kind <= top)
        .filter(|other| !other.kind.has_elements() || other.asymmetric == law.asymmetric)
        // Beside LuGre, Dahl is the law without a Stribeck curve; one such law is enough.
        .filter(|other| {
            other.kind != LawKind::Dahl || !other.asymmetric || law.kind == LawKind::Dahl
        })
        .collect()
}
