//! Whether logs of one axis tell the same of its parameters.
//!
//! The residual of a deviation counts noise within a log. What differs from one log to the next (warmth, lubrication, load)
//! is the same for all samples of a log: more samples do not average it out, and no residual within a log shows it. At the
//! optimum the pulls of the logs on the unknowns, `(J^T J)^-1 J_l^T r_l` for log l, add up to zero; their scatter is that of
//! the estimate if the logs are independent, whatever is correlated within them (cluster-robust covariance: Liang and Zeger
//! 1986, doi 10.1093/biomet/73.1.13). Filters and encoder pull too: how much on which log, the replicas of the fitted axis
//! show.
//!
//! Two logs that differ in one unknown may move another one without pulling on it: they are seen from a
//! [centre](centre) between them as well, and the larger scatter counts.
//!
//! A residual is so divided in two: what logs have differently is judged here, and what is left when each log has linear
//! unknowns of its own ([`Logs::within`]) states the deviations and is looked through for a [misfit](crate::misfit) of the law.

mod centre;
mod levels;
mod points;

use levels::Levels;
pub use levels::{Disagreement, NOT_CONSTANT};
pub(crate) use points::{Placed, disagreement};

use crate::parameter::NORMAL_Q95;
use crate::parameter::physical::Physical;
use crate::separable::linear::dot;
use crate::separable::logs::Logs;
use crate::separable::objective::Evaluation;
use crate::student;
use nalgebra::DMatrix;
use std::ops::Range;
use stiction_parameters::Name;

/// Upper 5 % points of the ratio of variances with 1, 2, .. degrees of freedom above and 9 (of ten replicas) below
/// (Abramowitz and Stegun, table 26.9); the last for all beyond.
const CHANCE: [f64; 8] = [5.12, 4.26, 3.86, 3.63, 3.48, 3.37, 3.29, 3.23];

/// How each log pulls on the unknowns.
type Pulls = Vec<Vec<f64>>;

/// What the logs of a fit tell: how they pull on its unknowns, and the levels of each.
#[derive(Clone, Debug)]
pub(crate) struct Told {
    pulls: Pulls,
    /// The same from the centre between the logs.
    from_centre: Pulls,
    levels: Levels,
}

impl Logs {
    /// How each log pulls on the unknowns `(p, c)` where the inverse of `J^T J` is given.
    fn pulls(&self, at: &Evaluation, inverse: &DMatrix<f64>) -> Pulls {
        let residual = at.residual();
        let columns: Vec<&[f64]> = at
            .slopes
            .iter()
            .chain(at.columns.iter().map(|column| &**column))
            .map(Vec::as_slice)
            .collect();
        let pull = |range: &Range<usize>| {
            let scores: Vec<f64> = columns
                .iter()
                .map(|column| dot(&column[range.clone()], &residual[range.clone()]))
                .collect();
            (0..columns.len())
                .map(|i| {
                    let each = scores.iter().enumerate();
                    each.map(|(j, score)| inverse[(i, j)] * score).sum()
                })
                .collect()
        };
        self.ranges().iter().map(pull).collect()
    }
}

impl Told {
    /// What has to be added to the `known` variance of each parameter for logs that differ by more than it and the replicas
    /// explain. With few logs their scatter is itself hardly known: the variance is enlarged so that 1.96 deviations are
    /// Student's interval, with two logs 6.5 deviations.
    pub fn between(&self, parameters: &[Physical], replicas: &[Told], known: &[f64]) -> Between {
        let free = self.pulls.len() - 1;
        let chance = CHANCE[free.min(CHANCE.len()) - 1];
        let few = student::whole(free) / NORMAL_Q95;
        let count = replicas.len() as f64;
        let ways: [Way; 2] = [
            (|told| &told.pulls, about_mean),
            (|told| &told.from_centre, about_zero),
        ];
        let means = ways.map(|(of, _)| mean(replicas, of, self));
        let beyond = |p: &Physical, known: f64| {
            let each = ways.iter().zip(&means).map(|((of, squares), mean)| {
                let scatter = |told: &Told| scatter(p, of(told), mean, squares);
                let usual = replicas.iter().map(scatter).sum::<f64>() / (count - 1.0).max(1.0);
                scatter(self) - chance * usual.max(known)
            });
            each.fold(0.0, f64::max)
        };
        let each = parameters.iter().zip(known);
        Between(
            each.map(|(p, known)| (p.name, beyond(p, *known)))
                .filter(|(_, beyond)| *beyond > 0.0)
                .map(|(name, beyond)| (name, few * few * beyond))
                .collect(),
        )
    }
}

/// What logs that differ add to the variances of parameters.
#[derive(Debug, Default)]
pub(crate) struct Between(Vec<(Name, f64)>);

impl Between {
    /// What they add to that of a parameter.
    pub fn variance(&self, name: Name) -> f64 {
        let own = self.0.iter().find(|(own, _)| *own == name);
        own.map_or(0.0, |(_, variance)| *variance)
    }

    /// The same with more for a parameter.
    pub fn add(&mut self, name: Name, variance: f64) {
        match self.0.iter_mut().find(|(own, _)| *own == name) {
            Some((_, own)) => *own += variance,
            None => self.0.push((name, variance)),
        }
    }

    /// Whether they add to none.
    pub fn is_nothing(&self) -> bool {
        self.0.is_empty()
    }
}

/// The pulls that are looked at.
type Of = fn(&Told) -> &Pulls;
/// What is scattered, and about what.
type Way = (Of, fn(&[f64]) -> f64);

/// Mean pulls of replicas; zero where there are none.
fn mean(replicas: &[Told], of: Of, own: &Told) -> Pulls {
    let own = of(own).iter();
    let mut out: Pulls = own.map(|pull| vec![0.0; pull.len()]).collect();
    for told in replicas {
        for (sum, pull) in out.iter_mut().zip(of(told)) {
            for (sum, x) in sum.iter_mut().zip(pull) {
                *sum += x / replicas.len() as f64;
            }
        }
    }
    out
}

/// Variance of a parameter from the scatter of the pulls about those that are expected.
fn scatter(
    parameter: &Physical,
    pulls: &Pulls,
    expected: &Pulls,
    squares: &fn(&[f64]) -> f64,
) -> f64 {
    let along = |(pull, expected): (&Vec<f64>, &Vec<f64>)| -> f64 {
        let slopes = parameter.slope.iter();
        slopes
            .zip(pull.iter().zip(expected))
            .map(|(slope, (x, e))| slope * (x - e))
            .sum()
    };
    let logs = pulls.len() as f64;
    let each: Vec<f64> = pulls.iter().zip(expected).map(along).collect();
    squares(&each) * logs / (logs - 1.0)
}

/// What pulls from the optimum add up to is not between the logs: nothing there, and the rest of the way to it in a replica.
fn about_mean(pulls: &[f64]) -> f64 {
    let mean = pulls.iter().sum::<f64>() / pulls.len() as f64;
    pulls.iter().map(|d| (d - mean) * (d - mean)).sum()
}

/// What pulls from the centre add up to is how far the logs together have moved the parameter.
fn about_zero(pulls: &[f64]) -> f64 {
    pulls.iter().map(|d| d * d).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use stiction_parameters::Quantity;

    fn mass() -> [Physical; 1] {
        [Physical {
            name: Quantity::Mass.into(),
            value: 1.0,
            slope: vec![1.0],
            nonlinear: None,
            linear: Some(0),
        }]
    }

    /// Logs that know equally much: each pulls on the mean by how far it is from it, divided by their number.
    fn told(values: &[f64]) -> Told {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let pulls: Pulls = values.iter().map(|x| vec![(x - mean) / count]).collect();
        Told {
            from_centre: pulls.clone(),
            pulls,
            levels: Vec::new(),
        }
    }

    /// Half-width of the 95 % interval that is stated.
    fn reach(values: &[f64], known: f64, replicas: &[Told]) -> f64 {
        let between = told(values).between(&mass(), replicas, &[known]);
        NORMAL_Q95 * (known + between.variance(Quantity::Mass.into())).sqrt()
    }

    /// Intervals of a mean as a table of Student's t has them: 12.706 and 4.303 standard errors.
    #[test]
    fn logs_without_noise_have_students_interval() {
        let two = reach(&[0.9, 1.1], 0.0, &[]);
        assert!((two - 12.706 * 0.1).abs() < 1e-4, "{two}");
        // Deviation 0.1, its mean over three a root of three less.
        let three = reach(&[0.9, 1.0, 1.1], 0.0, &[]);
        assert!(
            (three - 4.303 * 0.1 / 3.0_f64.sqrt()).abs() < 1e-4,
            "{three}"
        );
    }

    #[test]
    fn what_is_known_or_replicas_show_is_not_counted_again() {
        let values = [0.99, 1.01];
        let known = 1e-4 / 5.0;
        assert_eq!(reach(&values, known, &[]), NORMAL_Q95 * known.sqrt());
        // Replicas in which the second log pulls up as much as it does here, some more and some less.
        let replicas: Vec<Told> = [0.5, 1.5]
            .map(|part| told(&values.map(|x| part * x)))
            .to_vec();
        assert_eq!(reach(&values, 0.0, &replicas), 0.0);
        // A common step that replicas still had to take says nothing of logs.
        let mut moved = replicas;
        for pull in moved.iter_mut().flat_map(|told| &mut told.pulls) {
            pull[0] += 1.0;
        }
        let far = reach(&[0.5, 1.5], 0.0, &moved);
        assert!(far > 12.0 * 0.49 && far < 12.8 * 0.5, "{far}");
    }

    /// From the centre both logs pull the same way: the parameter is moved, though no scatter about the optimum shows it.
    #[test]
    fn what_both_logs_move_alike_counts() {
        let mut moved = told(&[1.0, 1.0]);
        moved.from_centre = vec![vec![0.05], vec![0.05]];
        let between = moved.between(&mass(), &[], &[0.0]);
        let reach = NORMAL_Q95 * between.variance(Quantity::Mass.into()).sqrt();
        assert!((reach - 12.706 * 0.1).abs() < 1e-4, "{reach}");
    }
}
