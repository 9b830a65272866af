//! Fits to the samples without a fold, from the fit to all of them.
//!
//! Near the optimum the folds share columns and sensitivities: the Gauss-Newton step to the optimum without a fold
//! follows from sums of products over the other folds. At its end only the columns are computed again, and their
//! coefficients are exact on the samples that are left. Where the step is long, or the cost does not fall as it promises,
//! a descent finds the optimum instead.

use crate::conditioning::blocks::Folds;
use crate::law::terms::Terms;
use crate::separable::descent::{descend_as, settings};
use crate::separable::linear::{self, dot};
use crate::separable::objective::{Evaluation, Objective};
use crate::separable::reduced::{self, Products};
use crate::separable::search_box::SearchBox;
use crate::separable::secant::Secant;
use crate::watch::Watch;
use nalgebra::DMatrix;
use stiction_search::{Control, descent};

/// Longest step of a logarithm that is trusted without a descent.
const LONGEST_STEP: f64 = 0.3;
/// Part of the promised fall of the cost that has to come.
const KEPT_PROMISE: f64 = 0.5;
/// Fall of the cost, relative to it, that matters to no error which is compared.
const NO_GAIN: f64 = 1e-5;
/// Cost, relative to the energy of the force, that is rounding of its sums.
const ROUNDING: f64 = 1e-12;

/// A fit to all samples of a record.
pub(crate) struct Whole<'a> {
    pub objective: &'a Objective<'a>,
    pub terms: &'a Terms,
    pub bounds: &'a SearchBox,
    /// What its descent learnt of the curvature.
    pub secant: &'a Secant,
    /// Nonlinear unknowns.
    pub p: &'a [f64],
    /// The evaluation there, with sensitivities.
    pub at: &'a Evaluation,
    /// Most steps of a descent.
    pub steps: usize,
}

impl Whole<'_> {
    /// The residual of every kept sample, with the fit that left its fold out; `None` where the watch was stopped.
    pub fn residuals(&self, folds: &Folds, watch: &mut Watch) -> Option<Vec<f64>> {
        let objective = self.objective;
        let target = objective.target_at(self.p);
        let columns: Vec<&[f64]> = self.at.columns.iter().map(|c| c.as_slice()).collect();
        let all: Vec<&[f64]> = columns
            .iter()
            .copied()
            .chain(self.at.slopes.iter().map(Vec::as_slice))
            .chain([&*target])
            .collect();
        let sums = Sums::of(&all, folds, columns.len());
        let mut out = vec![0.0; target.len()];
        for fold in 0..folds.count {
            let (p, coefficients) = match self.stepped(&sums, folds, fold, watch) {
                Some(found) => found,
                None => self.descended(folds, fold, watch),
            };
            let now = objective.relative(self.at.cost);
            if watch.stopped || watch.report(now) == Control::Stop {
                return None;
            }
            let model = objective.model(&p, &coefficients);
            let rows = objective.force().iter().zip(&model).zip(&folds.of);
            for (out, ((u, y), of)) in out.iter_mut().zip(rows) {
                if *of == fold {
                    *out = u - y;
                }
            }
        }
        Some(out)
    }

    /// Part of the samples that a fit without a fold sees.
    fn share(&self, folds: &Folds) -> f64 {
        1.0 - 1.0 / folds.count.max(1) as f64
    }

    /// The unknowns after one step, and the coefficients that suit the other folds; `None` where more than that is needed.
    fn stepped(
        &self,
        sums: &Sums,
        folds: &Folds,
        fold: usize,
        watch: &mut Watch,
    ) -> Option<(Vec<f64>, Vec<f64>)> {
        let bounded = self.objective.nonnegative();
        let products = Others { sums, out: fold };
        let here = reduced::from_products(&products, bounded, self.p.len());
        let here = self.secant.corrected(&here, self.share(folds));
        let here = self.objective.prior().add(self.p, here);
        let region = self.bounds.region();
        let mut p = self.p.to_vec();
        let mut promised = 0.0;
        if !p.is_empty() {
            let step = descent::damped_step(&here, None, &p, region, 0.0, LONGEST_STEP)?;
            let to = region.moved(&p, &step);
            if descent::largest(&to, &p) >= LONGEST_STEP {
                return None;
            }
            promised = descent::predicted_gain(&here, &descent::difference(&to, &p));
            p = to;
        }
        let columns = self.objective.columns_at(&p);
        watch.count(self.objective, false);
        let others = |x: &[f64]| -> Vec<f64> {
            let rows = x.iter().zip(&folds.of).filter(|(_, of)| **of != fold);
            rows.map(|(x, _)| *x).collect()
        };
        let kept: Vec<Vec<f64>> = columns.iter().map(|c| others(c)).collect();
        let views: Vec<&[f64]> = kept.iter().map(Vec::as_slice).collect();
        let found = linear::solve(&views, bounded, &others(&self.objective.target_at(&p)));
        let fell = here.cost - found.cost - self.objective.prior().cost(&p);
        let rounding = ROUNDING * self.objective.energy();
        let enough = fell >= KEPT_PROMISE * promised || promised <= NO_GAIN * here.cost + rounding;
        (enough && fell >= -NO_GAIN * here.cost - rounding).then_some((p, found.coefficients))
    }

    /// The same from a descent on the record without the fold.
    fn descended(&self, folds: &Folds, fold: usize, watch: &mut Watch) -> (Vec<f64>, Vec<f64>) {
        let record = folds.masked(self.objective.record(), fold, false);
        let objective = Objective::new(&record, *self.objective.law(), self.terms);
        let settings = descent::Settings {
            trusted_step: LONGEST_STEP,
            trusted_gain: NO_GAIN,
            no_gain: NO_GAIN,
            ..settings(objective.energy(), self.steps)
        };
        let secant = self.secant.times(self.share(folds));
        let found = descend_as(&objective, self.bounds, self.p, &settings, secant, watch);
        (found.p, found.evaluation.solution.coefficients)
    }
}

/// Products of the columns, of the sensitivities and of the target with each other.
struct Sums {
    linear: usize,
    target: usize,
    total: DMatrix<f64>,
    folds: Vec<DMatrix<f64>>,
}

impl Sums {
    fn of(all: &[&[f64]], folds: &Folds, linear: usize) -> Self {
        let n = all.len();
        let mut each = vec![DMatrix::zeros(n, n); folds.count];
        let mut start = 0;
        for stretch in folds.of.chunk_by(|a, b| a == b) {
            let rows = start..start + stretch.len();
            start = rows.end;
            let sums = &mut each[stretch[0]];
            for i in 0..n {
                for j in 0..=i {
                    sums[(i, j)] += dot(&all[i][rows.clone()], &all[j][rows.clone()]);
                }
            }
        }
        for sums in &mut each {
            sums.fill_upper_triangle_with_lower_triangle();
        }
        Self {
            linear,
            target: n - 1,
            total: each
                .iter()
                .fold(DMatrix::zeros(n, n), |sum, fold| sum + fold),
            folds: each,
        }
    }
}

/// The products over all folds but one.
struct Others<'a> {
    sums: &'a Sums,
    out: usize,
}

impl Others<'_> {
    fn product(&self, i: usize, j: usize) -> f64 {
        self.sums.total[(i, j)] - self.sums.folds[self.out][(i, j)]
    }
}

/// The sensitivities are those of the model with the coefficients of the fit to all samples.
impl Products for Others<'_> {
    fn linear(&self, i: usize, j: usize) -> f64 {
        self.product(i, j)
    }

    fn target(&self, i: usize) -> f64 {
        self.product(self.sums.target, i)
    }

    fn energy(&self) -> f64 {
        self.product(self.sums.target, self.sums.target)
    }

    fn slope_linear(&self, k: usize, i: usize, _: &[f64]) -> f64 {
        self.product(self.sums.linear + k, i)
    }

    fn slope_target(&self, k: usize, _: &[f64]) -> f64 {
        self.product(self.sums.target, self.sums.linear + k)
    }

    fn slopes(&self, k: usize, l: usize, _: &[f64]) -> f64 {
        self.product(self.sums.linear + k, self.sums.linear + l)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conditioning::record::Record;
    use crate::conditioning::record::tests::of_velocities;
    use crate::law::{Law, LawKind};
    use crate::separable::recursion::trace;
    use crate::separable::separable;
    use crate::separable::settings::Settings;
    use stiction_search::{Silent, Stage};

    /// A LuGre axis along slow and fast motion, with noise.
    fn record(law: &Law) -> Record {
        let wave =
            |k: usize| 0.02 * libm::sin(7e-3 * k as f64) + 2e-3 * libm::cos(0.043 * k as f64);
        let velocity: Vec<f64> = (0..4000).map(wave).collect();
        let mut record = of_velocities(1e-3, &[&velocity]);
        let along = trace(law, &[8.7, -0.7, -5.0], 1e-3, &velocity, false);
        let segment = &mut record.segments[0];
        for (i, v) in velocity.iter().enumerate() {
            let noise = libm::sin(1e3 * libm::sin(i as f64));
            segment.acceleration[i] = libm::sin(0.3 * i as f64);
            let inertia = 3.0 * segment.acceleration[i];
            let friction = 20.0 * along.eta[i] + 0.1 * along.rate[i] + 50.0 * v;
            segment.force[i] = friction + inertia + 0.3 * noise;
        }
        record
    }

    /// One step leaves what whole descents leave, at an evaluation for each fold.
    #[test]
    fn a_step_is_as_good_as_a_descent() {
        let law = Law::new(LawKind::LuGre);
        let record = record(&law);
        for law in [law, law.asymmetric()] {
            let terms = Terms::default();
            let found = separable(&record, law, &terms, &Settings::default(), &mut Silent).unwrap();
            let objective = Objective::new(&record, law, &terms);
            let whole = Whole {
                objective: &objective,
                terms: &terms,
                bounds: &found.bounds,
                secant: &found.secant,
                p: &found.p,
                at: &found.evaluation,
                steps: 60,
            };
            let folds = Folds::of(&record, 4);
            let mut silent = Silent;
            let mut watch = Watch::new(&mut silent, Stage::CrossValidation);
            let stepped = whole.residuals(&folds, &mut watch).unwrap();
            assert_eq!(watch.counts.total(), 4);
            let mut square = 0.0;
            for fold in 0..4 {
                let (p, c) = whole.descended(&folds, fold, &mut watch);
                let model = objective.model(&p, &c);
                for (i, (u, y)) in objective.force().iter().zip(&model).enumerate() {
                    square += if folds.of[i] == fold {
                        (u - y) * (u - y)
                    } else {
                        0.0
                    };
                }
            }
            let ratio = (dot(&stepped, &stepped) / square).sqrt();
            assert!((ratio - 1.0).abs() < 1e-4, "{law:?}: {ratio}");
        }
    }
}
