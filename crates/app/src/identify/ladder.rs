//! The chosen law beside others, on samples that none of them was fitted to.

use crate::result::LawEntry;
use stiction_identify as engine;
use stiction_identify::{
    Control, Estimate, Fit, Law, LawKind, LawScore, Observer, Progress, Record, SearchBox,
    Settings, Stage, Terms,
};

/// Blocks of the cross-validation where no validation data are given.
const BLOCKS: usize = 4;

/// Held-out errors within this factor of the least count as equal, and the simplest of them is best.
const EQUAL: f64 = 1.01;

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
    /// Scores the fitted law, its asymmetric or symmetric twin and the simpler ones; the simplest of
    /// those with the least held-out error is best. Nothing if the observer stopped it half way: a table of some laws
    /// would name the wrong one.
    pub fn climb(
        &self,
        chosen: &Estimate,
        bounds: &SearchBox,
        settings: &Settings,
        observer: &mut dyn Observer,
    ) -> Vec<LawEntry> {
        let laws = beside(&chosen.law);
        let mut relay = Relay {
            observer,
            done: 0,
            laws: laws.len(),
            stopped: false,
        };
        let mut scores = Vec::new();
        for law in laws {
            if law == chosen.law {
                scores.push(self.score(chosen, bounds, &mut relay));
            } else {
                let terms = if law.asymmetric {
                    self.asymmetric
                } else {
                    self.symmetric
                };
                if let Ok(found) = engine::separable(self.record, law, terms, settings, &mut relay)
                {
                    let fitted = engine::estimate(self.record, law, terms, &found, self.low_speed);
                    scores.push(self.score(&fitted, &found.bounds, &mut relay));
                }
            }
            if relay.stopped {
                return Vec::new();
            }
            relay.done += 1;
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

/// Passes progress on as that of the comparison, and remembers whether it was stopped.
struct Relay<'o> {
    observer: &'o mut dyn Observer,
    done: usize,
    laws: usize,
    stopped: bool,
}

impl Observer for Relay<'_> {
    fn progress(&mut self, progress: &Progress) -> Control {
        let control = self.observer.progress(&Progress {
            stage: Stage::CrossValidation,
            fraction: self.done as f64 / self.laws as f64,
            ..*progress
        });
        self.stopped |= control == Control::Stop;
        control
    }
}

/// The laws to compare a law with, from the simplest to the richest: every family up to its own, each
/// symmetric and asymmetric.
fn beside(law: &Law) -> Vec<Law> {
    LawKind::ALL
        .into_iter()
        .filter(|kind| *kind <= law.kind.max(LawKind::Stribeck))
        .flat_map(|kind| {
            let base = Law {
                kind,
                asymmetric: false,
                ..*law
            };
            // Dahl beside LuGre stands for "no Stribeck curve"; one of its kind is enough.
            let both = kind != LawKind::Dahl || law.kind == LawKind::Dahl;
            std::iter::once(base).chain(both.then(|| base.asymmetric()))
        })
        .collect()
}

fn entries(scores: &[LawScore]) -> Vec<LawEntry> {
    let error = |s: &LawScore| s.held_out.map(|f| f.relative_error_percent);
    let least = scores
        .iter()
        .filter_map(error)
        .fold(f64::INFINITY, f64::min);
    let best = scores
        .iter()
        .enumerate()
        .filter(|(_, s)| error(s).is_some_and(|e| e <= EQUAL * least))
        .min_by_key(|(_, s)| s.parameters)
        .map(|(i, _)| i);
    scores
        .iter()
        .enumerate()
        .map(|(i, s)| LawEntry {
            law: s.law.kind.name().into(),
            asymmetric: s.law.asymmetric,
            parameters: s.parameters,
            fitted_error_percent: s.fitted.relative_error_percent,
            held_out_error_percent: error(s),
            held_out_low_speed_error_percent: s
                .held_out_low_speed
                .map(|f| f.relative_error_percent),
            best: best == Some(i),
        })
        .collect()
}
