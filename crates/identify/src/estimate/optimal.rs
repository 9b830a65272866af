//! A parameter at the optimum of a search.

use crate::parameter::Parameter;
use crate::parameter::physical::Physical;
use crate::scatter::Variances;
use crate::separable::optimum::Optimum;

/// A fitted parameter with its linear interval. `bias` is what the conditioning adds to it; `level` is
/// the Coulomb level, with which a parameter that may be zero is compared.
pub(super) fn fitted(
    p: &Physical,
    variances: Variances,
    bias: Option<f64>,
    optimum: &Optimum,
    level: f64,
) -> Parameter {
    Parameter::judged(p, variances, bias, at_its_end(p, optimum), level)
}

/// Why a parameter is not free at the optimum; empty if it is.
fn at_its_end(p: &Physical, optimum: &Optimum) -> String {
    let solution = &optimum.evaluation.solution;
    if let Some(j) = p.linear {
        if solution.dependent[j] {
            return "cannot be separated from the other terms on this motion".into();
        }
        if !solution.active[j] {
            return "held at zero: the data ask for a negative value".into();
        }
    }
    match p.nonlinear {
        Some(i) if optimum.bounds.at_bound(&optimum.p, i) => {
            "is at the bound of its search range".into()
        }
        _ => String::new(),
    }
}
