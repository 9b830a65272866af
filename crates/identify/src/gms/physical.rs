//! From the unknowns of the search to the parameters of the generalised Maxwell-slip law.

use crate::law::Law;
use crate::law::terms::{ColumnKind, LinearTerm};
use crate::parameter::physical::Physical;
use libm::exp;
use stiction_parameters::{Name, Quantity, Side};

/// The law's own parameters at the unknowns `p`, `c`: the elements one by one, and their totals. `sigma0`
/// and `static` are sums over the elements, not unknowns of their own.
pub(crate) fn physical(law: &Law, linear: &[LinearTerm], p: &[f64], c: &[f64]) -> Vec<Physical> {
    let layout = law.layout();
    let width = layout.count + c.len();
    // For each element: index of its nonlinear unknown, index of its linear unknown, and its yield force.
    let elements: Vec<(usize, usize, f64)> = linear
        .iter()
        .enumerate()
        .filter_map(|(j, term)| match term.column {
            ColumnKind::Element(k) => Some((layout.yields().start + k, j, c[j])),
            _ => None,
        })
        .collect();
    let of = |name: Name, value, slope, nonlinear, linear| Physical {
        name,
        value,
        slope,
        nonlinear,
        linear,
    };
    let mut out = Vec::new();
    let mut total = 0.0;
    let mut total_slope = vec![0.0; width];
    for (k, &(i, j, force)) in elements.iter().enumerate() {
        let inverse = exp(-p[i]);
        let mut slope = vec![0.0; width];
        slope[i] = -force * inverse;
        slope[layout.count + j] = inverse;
        total += force * inverse;
        for (sum, x) in total_slope.iter_mut().zip(&slope) {
            *sum += x;
        }
        let name = Quantity::ElementStiffness(number(k)).into();
        let stiffness = force * inverse;
        out.push(of(name, stiffness, slope, None, Some(j)));
    }
    for (k, &(i, j, _)) in elements.iter().enumerate() {
        let mut slope = vec![0.0; width];
        slope[i] = exp(p[i]);
        let name = Quantity::ElementYield(number(k)).into();
        out.push(of(name, exp(p[i]), slope, Some(i), Some(j)));
    }
    out.push(of(Quantity::Sigma0.into(), total, total_slope, None, None));
    if let Some(i) = layout.attraction {
        let mut slope = vec![0.0; width];
        slope[i] = exp(p[i]);
        out.push(of(
            Quantity::Attraction.into(),
            exp(p[i]),
            slope,
            Some(i),
            None,
        ));
    }
    let force: f64 = elements.iter().map(|(_, _, force)| force).sum();
    for (index, &side) in Side::all(law.asymmetric).iter().enumerate() {
        let ratio = if index == 1 { layout.ratio } else { None };
        let scale = ratio.map_or(1.0, |i| exp(p[i]));
        let mut slope = vec![0.0; width];
        for (_, j, _) in &elements {
            slope[layout.count + j] = scale;
        }
        if let Some(i) = ratio {
            slope[i] = scale * force;
        }
        let fixed = scale * force;
        if let (Some(e), Some(v)) = (layout.excess[index], layout.velocity[index]) {
            let excess = exp(p[e]);
            let inverse = 1.0 / (1.0 + excess);
            let mut coulomb: Vec<f64> = slope.iter().map(|x| x * inverse).collect();
            coulomb[e] = -fixed * excess * inverse * inverse;
            let name = Name::new(Quantity::Coulomb, side);
            let value = fixed * inverse;
            out.push(of(name, value, coulomb, None, None));
            let name = Name::new(Quantity::StribeckVelocity, side);
            let mut slope = vec![0.0; width];
            slope[v] = exp(p[v]);
            out.push(of(name, exp(p[v]), slope, Some(v), None));
        }
        // Without a Stribeck curve there is one level only.
        let name = match layout.excess[index] {
            Some(_) => Name::new(Quantity::Static, side),
            None => Name::new(Quantity::Coulomb, side),
        };
        out.push(of(name, fixed, slope, None, None));
    }
    out
}

/// Elements are counted from 1 in names.
fn number(index: usize) -> u32 {
    index as u32 + 1
}
