//! What the error of a known external force adds to the intervals of what is fitted beside it.

use crate::conditioning::shift::Shift;
use crate::separable::objective::{Evaluation, Objective};
use nalgebra::DMatrix;

/// Covariance of the unknowns, nonlinear then linear, that comes of errors of the external force; `None` where there are none.
/// `bread` is the inverse of `J^T J`.
pub(crate) fn spread(
    objective: &Objective,
    at: &Evaluation,
    bread: &DMatrix<f64>,
) -> Option<DMatrix<f64>> {
    let record = objective.record();
    let count = |s: &crate::Segment| s.channels.external_deviations.len();
    let errors = record.segments.iter().map(count).max()?;
    let mut out: Option<DMatrix<f64>> = None;
    for error in 0..errors {
        let mut column = Vec::with_capacity(record.kept());
        for segment in &record.segments {
            let full = &segment.channels.external_deviations[error];
            if record.force_is_filtered {
                record.thin(segment, full, Shift::NONE, &mut column);
            } else {
                let filtered = record.filtered(segment, &[full], &[Shift::NONE], None);
                column.extend(filtered.into_iter().flatten().flatten());
            }
        }
        let moved = moved(at, bread, &column)?;
        let n = moved.len();
        let own = DMatrix::from_fn(n, n, |i, j| moved[i] * moved[j]);
        out = Some(match out {
            Some(all) => all + own,
            None => own,
        });
    }
    out
}

/// By how much the unknowns move where the force has a column more than the model, as in a Gauss-Newton step.
pub(crate) fn moved(at: &Evaluation, bread: &DMatrix<f64>, column: &[f64]) -> Option<Vec<f64>> {
    let along = at.slopes.iter().map(|s| s.as_slice());
    let along = along.chain(at.columns.iter().map(|c| c.as_slice()));
    let product = |x: &[f64]| x.iter().zip(column).map(|(x, y)| x * y).sum::<f64>();
    let products: Vec<f64> = along.map(product).collect();
    let n = products.len();
    let moved: Vec<f64> = (0..n)
        .map(|i| (0..n).map(|j| bread[(i, j)] * products[j]).sum::<f64>())
        .collect();
    moved.iter().all(|x| x.is_finite()).then_some(moved)
}
