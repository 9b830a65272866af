//! Levels and mass of each log, everything nonlinear held where all logs together have it.

use super::Told;
use crate::estimate::uncertainty::sandwich;
use crate::law::physical::physical;
use crate::parameter::physical::Physical;
use crate::separable::logs::Logs;
use crate::separable::objective::{Evaluation, Objective};
use nalgebra::DMatrix;
use stiction_parameters::{Name, Quantity};
use stiction_policy::agreement;

/// What is compared.
const COMPARED: [Quantity; 4] = [
    Quantity::Coulomb,
    Quantity::Sigma2,
    Quantity::Mass,
    Quantity::Offset,
];

/// A parameter that two logs have differently.
#[derive(Clone, Debug, PartialEq)]
pub struct Disagreement {
    /// Which one.
    pub name: Name,
    /// The logs, counted from 0: the one with the lower value, and the one with the higher.
    pub logs: [usize; 2],
    /// Its values there, SI.
    pub values: [f64; 2],
    /// Deviation that their difference has by chance, SI.
    pub deviation: f64,
    /// The difference in parts of the value of all logs together, or of the Coulomb level for an offset.
    pub part: f64,
}

/// A number for each compared parameter, log by log.
pub(super) type Levels = Vec<Vec<f64>>;

impl Logs {
    /// What a fit of these logs tells; `None` where it has another number of samples.
    pub fn told(&self, objective: &Objective, p: &[f64], at: &Evaluation) -> Option<Told> {
        self.are_of(at).then(|| Told {
            levels: self.levels(objective, p, at),
        })
    }

    /// The compared parameters in each log less those of all logs together.
    fn levels(&self, objective: &Objective, p: &[f64], at: &Evaluation) -> Levels {
        let all = &at.solution.coefficients;
        let together = compared(objective, p, all);
        self.each(at, |log| {
            let mut own = all.clone();
            for (&j, d) in log.active.iter().zip(log.solution().coefficients) {
                own[j] += d;
            }
            let own = compared(objective, p, &own);
            let both = own.iter().zip(&together);
            both.map(|(own, all)| own.value - all.value).collect()
        })
    }

    /// Variances of the same from the residual of each log.
    fn variances(&self, objective: &Objective, p: &[f64], at: &Evaluation) -> Levels {
        let together = compared(objective, p, &at.solution.coefficients);
        self.each(at, |log| {
            let small = sandwich(&log.columns, &log.solution().residual, &log.breaks).covariance;
            let (k, width) = (p.len(), p.len() + at.columns.len());
            let mut covariance = DMatrix::zeros(width, width);
            for (a, &i) in log.active.iter().enumerate() {
                for (b, &j) in log.active.iter().enumerate() {
                    covariance[(k + i, k + j)] = small[(a, b)];
                }
            }
            together.iter().map(|p| p.variance(&covariance)).collect()
        })
    }

    /// What these logs have differently: of each parameter the pair of logs that differ most surely. What filters and encoder
    /// make of it the replicas show.
    pub fn disagreements(
        &self,
        (objective, p, at): (&Objective, &[f64], &Evaluation),
        own: &Told,
        replicas: &[Told],
    ) -> Vec<Disagreement> {
        let variances = self.variances(objective, p, at);
        let together = compared(objective, p, &at.solution.coefficients);
        let levels = together.iter();
        let levels = levels.filter(|p| p.name.quantity == Quantity::Coulomb);
        let coulomb = levels.map(|p| p.value.abs()).fold(0.0, f64::max);
        let count = replicas.len() as f64;
        let mut out = Vec::new();
        for (i, p) in together.iter().enumerate() {
            // Value and variance in each log.
            let each: Vec<(f64, f64)> = (0..own.levels.len())
                .map(|l| {
                    let of = |told: &Told| told.levels[l][i];
                    let mean = replicas.iter().map(of).sum::<f64>() / count.max(1.0);
                    let square: f64 = replicas.iter().map(|r| (of(r) - mean).powi(2)).sum();
                    let scatter = square / (count - 1.0).max(1.0);
                    (
                        p.value + own.levels[l][i] - mean,
                        scatter.max(variances[l][i]),
                    )
                })
                .collect();
            let size = match p.name.quantity {
                Quantity::Offset => coulomb,
                _ => p.value.abs(),
            };
            let mut surest = 0.0;
            let mut found = None;
            for (a, low) in each.iter().enumerate() {
                for (b, high) in each.iter().enumerate() {
                    let apart = high.0 - low.0;
                    let deviation = (low.1 + high.1).sqrt();
                    let sure = apart / deviation;
                    if sure > f64::max(surest, agreement::MIN_CERTAIN_DEVIATIONS)
                        && apart > agreement::MIN_NAMED_DIFFERENCE * size
                    {
                        surest = sure;
                        found = Some(Disagreement {
                            name: p.name,
                            logs: [self.numbers()[a], self.numbers()[b]],
                            values: [low.0, high.0],
                            deviation,
                            part: apart / size,
                        });
                    }
                }
            }
            out.extend(found);
        }
        out
    }
}

/// The parameters that are compared.
fn compared(objective: &Objective, p: &[f64], c: &[f64]) -> Vec<Physical> {
    let step = objective.record().step();
    let mut all = physical(objective.law(), objective.linear(), step, p, c);
    all.retain(|p| COMPARED.contains(&p.name.quantity));
    all
}
