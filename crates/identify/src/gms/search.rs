//! From a dictionary of many elements to few elements, and then stepwise to fewer.

use super::count::{FEWEST, MOST};
use super::dictionary::{self, Atom};
use super::ladder::{Rung, Search};
use super::{choose, curves, kink};
use crate::conditioning::record::Record;
use crate::error::Error;
use crate::law::Law;
use crate::law::terms::Terms;
use crate::separable::checked::checked;
use crate::separable::descent::descend;
use crate::separable::objective::Objective;
use crate::separable::optimum::Optimum;
use crate::separable::search_box::SearchBox;
use crate::separable::settings::Settings;
use crate::watch::Watch;
use stiction_search::{Observer, Stage, Status};

/// Elements of the dictionary from which the elements are taken.
const DICTIONARY_ELEMENTS: usize = 40;
/// Steps of a descent before it is compared with others.
const SHORT_STEPS: usize = 12;
/// Relative difference of the costs below which two descents are on the way to one minimum.
const SAME_MINIMUM_COST: f64 = 2e-3;
/// Number of other descents that are followed further.
const MOST_RIVALS: usize = 3;
/// The stepwise reduction begins with this many elements more than wanted.
pub(super) const ELEMENTS_ABOVE: usize = 3;

/// Most steps of a descent during the reduction.
const RUNG_STEPS: usize = 30;
/// Steps between two checks of such a descent.
const STRIDE_STEPS: usize = 10;
/// Relative fall of the cost over a stride below which it ends.
const SETTLED_GAIN: f64 = 1e-5;

/// Most repetitions of the dictionary solution.
const MOST_REFILLS: usize = 3;
/// Relative fall of the cost that justifies one more repetition.
const WORTHWHILE_GAIN: f64 = 1e-3;

/// Parts of the fine stage in which the best starts are followed, and after which the last descent begins; between them elements are
/// joined.
const FOLLOWED: f64 = 0.5;
const JOINED: f64 = 0.9;

/// Times a stalled descent is started again.
const MOST_RESTARTS: usize = 8;

/// A curve, and elements that suit it.
type Start = (Vec<f64>, Vec<Atom>);

/// Fits a Maxwell-slip law. Without a given number of elements it takes the number that best predicts
/// blocks left out of the fit. Elements to which the data give no stiffness are dropped.
pub(crate) fn search(
    record: &Record,
    law: Law,
    terms: &Terms,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<Optimum, Error> {
    if law.elements > MOST {
        return Err(Error::Setting {
            name: "elements",
            found: law.elements as f64,
            allowed: "at most 10, or 0 to leave it to the data",
        });
    }
    let (top, least) = match law.elements {
        0 => (MOST, FEWEST),
        given => ((given + ELEMENTS_ABOVE).min(MOST), given),
    };
    let wanted = law.elements;
    let law = |elements| Law { elements, ..law };
    checked(record, law(least), terms)?;
    let mut watch = Watch::new(observer, Stage::Scan);
    let mut search = Search {
        record,
        law: law(0),
        terms,
        settings,
        iterations: 0,
    };
    let rungs = search.ladder(top, least, &mut watch)?;
    let scores = if wanted == 0 {
        choose::scores(record, terms, &rungs, &mut watch)
    } else {
        Vec::new()
    };
    let at = match wanted {
        0 => choose::best(&scores, &rungs, record),
        _ => rungs.len() - 1,
    };
    let rung = rungs.into_iter().nth(at).expect("a ladder has a rung");
    let found = search.finish(rung, &mut watch)?;
    Ok(Optimum {
        elements: scores,
        ..found
    })
}

impl Search<'_> {
    /// Fits with `most` elements and fewer, down to `least`; each from the one before with two
    /// neighbours joined. Fewer than `most` where the data do not support as many.
    pub fn ladder(
        &mut self,
        most: usize,
        least: usize,
        watch: &mut Watch,
    ) -> Result<Vec<Rung>, Error> {
        let mut rung = match self.record.rough(self.settings.thin) {
            None => self.top(most, watch)?,
            Some(near) => {
                let mut search = Search {
                    record: &near,
                    iterations: 0,
                    ..*self
                };
                let rung = search.top(most, watch)?;
                self.iterations += search.iterations;
                watch.best = f64::INFINITY;
                let (curve, atoms) = self.split(&rung);
                self.fit(&curve, &atoms, RUNG_STEPS, watch)?
            }
        };
        let mut out = Vec::new();
        loop {
            rung = self.settle(rung, watch)?;
            let n = rung.law.elements;
            let joined = most.saturating_sub(n) as f64 / most.saturating_sub(least).max(1) as f64;
            watch.fraction = FOLLOWED + (JOINED - FOLLOWED) * joined.min(1.0);
            if n <= least || watch.stopped {
                out.push(rung);
                return Ok(out);
            }
            let (curve, atoms) = self.split(&rung);
            let next = self.fit(&curve, &dictionary::join(atoms, n - 1), RUNG_STEPS, watch)?;
            out.push(std::mem::replace(&mut rung, next));
        }
    }

    /// The best fit with `most` elements or fewer, from every start.
    fn top(&mut self, most: usize, watch: &mut Watch) -> Result<Rung, Error> {
        let starts = self.starts(most, watch)?;
        watch.stage = Stage::Coarse;
        watch.best = f64::INFINITY;
        let mut rivals: Vec<Rung> = Vec::new();
        for (i, (curve, atoms)) in starts.iter().enumerate() {
            if watch.stopped && !rivals.is_empty() {
                break;
            }
            watch.fraction = i as f64 / starts.len() as f64;
            rivals.push(self.fit(curve, atoms, SHORT_STEPS, watch)?);
        }
        rivals.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
        rivals.dedup_by(|b, a| b.cost() <= (1.0 + SAME_MINIMUM_COST) * a.cost());
        // Minima with different curves may lie close together: the best are followed further.
        watch.stage = Stage::Fine;
        let mut best: Option<Rung> = None;
        let rivals = rivals.into_iter().take(MOST_RIVALS);
        let count = rivals.len() as f64;
        for (i, rival) in rivals.enumerate() {
            if watch.stopped && best.is_some() {
                break;
            }
            watch.fraction = FOLLOWED * i as f64 / count;
            let rung = self.refill(rival, most, watch)?;
            if best.as_ref().is_none_or(|b| rung.cost() < b.cost()) {
                best = Some(rung);
            }
        }
        Ok(best.expect("the scan has a point"))
    }

    /// Continues a fit until it converges.
    pub fn finish(&mut self, mut rung: Rung, watch: &mut Watch) -> Result<Optimum, Error> {
        watch.stage = Stage::Fine;
        watch.fraction = JOINED;
        for _ in 0..MOST_RESTARTS {
            if watch.stopped {
                break;
            }
            let before = rung.cost();
            let (curve, atoms) = self.split(&rung);
            rung = self.fit(&curve, &atoms, self.settings.steps, watch)?;
            rung = self.settle(rung, watch)?;
            match rung.descent.status {
                Status::Stalled => {
                    let objective = Objective::new(self.record, rung.law, self.terms);
                    let cost = rung.cost();
                    let (bounds, p) = (&rung.bounds, &rung.descent.p);
                    match kink::way_out(&objective, bounds, p, cost, watch) {
                        Some(p) => rung = self.follow(rung.law, &p, self.settings.steps, watch)?,
                        None => {
                            rung.descent.status = Status::Converged;
                            break;
                        }
                    }
                }
                Status::Budget => {}
                _ => break,
            }
            // From kink to kink there is often a way on that gains nothing.
            let gain = 1.0 - rung.cost() / before;
            if gain < SETTLED_GAIN {
                rung.descent.status = Status::Converged;
                break;
            }
        }
        let objective = Objective::new(self.record, rung.law, self.terms);
        watch.fraction = 1.0;
        watch.report(objective.relative(rung.cost()));
        let Rung {
            law,
            bounds,
            descent,
        } = rung;
        Ok(Optimum {
            law,
            p: descent.p,
            bounds,
            status: if watch.stopped {
                Status::Interrupted
            } else {
                descent.status
            },
            counts: watch.counts,
            iterations: self.iterations,
            history: descent.history,
            elements: Vec::new(),
            delay: false,
            secant: descent.secant,
            evaluation: descent.evaluation,
        })
    }

    /// Curve and elements of a fit; those without force are left out.
    fn split(&self, rung: &Rung) -> (Vec<f64>, Vec<Atom>) {
        let p = &rung.descent.p;
        let curve = p[..rung.law.layout().yields().start].to_vec();
        (
            curve,
            dictionary::atoms(&rung.law, p, &rung.descent.evaluation),
        )
    }

    /// Solves the dictionary again with the curve of a fit, which may have changed much since, and
    /// continues from there while that lowers the cost.
    fn refill(&mut self, mut rung: Rung, most: usize, watch: &mut Watch) -> Result<Rung, Error> {
        for _ in 0..MOST_REFILLS {
            rung = self.settle(rung, watch)?;
            let (curve, own) = self.split(&rung);
            if own.len() >= most || watch.stopped {
                break;
            }
            let atoms = self.elements_for(&curve, &own, watch)?;
            let next = self.fit(&curve, &dictionary::join(atoms, most), RUNG_STEPS, watch)?;
            let gain = 1.0 - next.cost() / rung.cost();
            if gain > 0.0 {
                rung = next;
            }
            if gain.is_nan() || gain < WORTHWHILE_GAIN {
                break;
            }
        }
        Ok(rung)
    }

    /// The elements that a dictionary gives for a curve; the yield deflections `own` are added to its
    /// equal steps.
    fn elements_for(
        &mut self,
        curve: &[f64],
        own: &[Atom],
        watch: &mut Watch,
    ) -> Result<Vec<Atom>, Error> {
        let law = Law {
            elements: DICTIONARY_ELEMENTS + own.len(),
            ..self.law
        };
        let bounds = SearchBox::from_record(self.record, &law)?;
        let objective = Objective::new(self.record, law, self.terms);
        let places = dictionary::places(&bounds, &law.layout(), DICTIONARY_ELEMENTS);
        let places = own.iter().map(|atom| atom.place).chain(places);
        let p = dictionary::unknowns(curve, places);
        let at = objective.evaluate(&p, false);
        watch.count(&objective, false);
        watch.report(objective.relative(at.cost));
        Ok(dictionary::atoms(&law, &p, &at))
    }

    /// Drops elements without force and puts the others in the order of their yield deflections; what
    /// changed by that is fitted again.
    fn settle(&mut self, mut rung: Rung, watch: &mut Watch) -> Result<Rung, Error> {
        // Each pass loses an element or lowers the cost; the limit on passes is there because of rounding.
        for _ in 0..2 * MOST {
            let (curve, atoms) = self.split(&rung);
            let yields = &rung.descent.p[rung.law.layout().yields()];
            let done = atoms.len() == rung.law.elements && yields.is_sorted();
            if done || watch.stopped {
                break;
            }
            rung = self.fit(&curve, &atoms, RUNG_STEPS, watch)?;
        }
        Ok(rung)
    }

    /// Descends from a curve and elements.
    fn fit(
        &mut self,
        curve: &[f64],
        atoms: &[Atom],
        steps: usize,
        watch: &mut Watch,
    ) -> Result<Rung, Error> {
        let law = Law {
            elements: atoms.len(),
            ..self.law
        };
        let start = dictionary::unknowns(curve, atoms.iter().map(|a| a.place));
        self.follow(law, &start, steps, watch)
    }

    /// Descends from a point.
    pub fn follow(
        &mut self,
        law: Law,
        start: &[f64],
        steps: usize,
        watch: &mut Watch,
    ) -> Result<Rung, Error> {
        let bounds = SearchBox::from_record(self.record, &law)?;
        let objective = Objective::new(self.record, law, self.terms);
        let mut descent = descend(&objective, &bounds, start, steps.min(STRIDE_STEPS), watch);
        self.iterations += descent.iterations;
        let mut left = steps.saturating_sub(STRIDE_STEPS);
        let rough = steps < self.settings.steps;
        while left > 0 && descent.status == Status::Budget && !watch.stopped {
            let stride = if rough { left.min(STRIDE_STEPS) } else { left };
            let mut next = descend(&objective, &bounds, &descent.p, stride, watch);
            self.iterations += next.iterations;
            left -= stride;
            let gain = 1.0 - next.evaluation.cost / descent.evaluation.cost;
            descent.history.append(&mut next.history);
            next.history = descent.history;
            descent = next;
            if rough && (gain.is_nan() || gain < SETTLED_GAIN) {
                break;
            }
        }
        Ok(Rung {
            law,
            bounds,
            descent,
        })
    }

    /// The most promising curves, each with the elements that a dictionary gives it.
    fn starts(&mut self, most: usize, watch: &mut Watch) -> Result<Vec<Start>, Error> {
        let mut out = Vec::new();
        for curve in curves::curves(self, watch)? {
            let atoms = self.elements_for(&curve, &[], watch)?;
            out.push((curve, dictionary::join(atoms, most)));
        }
        Ok(out)
    }
}
