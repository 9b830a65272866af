//! From the unknowns of the search to the parameters of the generalised Maxwell-slip law.

use crate::law::Law;
use crate::law::physical::{Dimension, Physical};
use crate::law::terms::{ColumnKind, LinearTerm};
use libm::exp;

/// Names of the parameters of single elements, before their number.
pub const STIFFNESS: &str = "stiffness_";
/// See [`STIFFNESS`].
pub const YIELD: &str = "yield_";

/// The law's own parameters at the unknowns `p`, `c`: the elements one by one, and what they come to
/// together. `sigma0` and `static` are sums over the elements and no unknowns of their own.
pub(crate) fn physical(law: &Law, linear: &[LinearTerm], p: &[f64], c: &[f64]) -> Vec<Physical> {
    let layout = law.layout();
    let width = layout.count + c.len();
    // Nonlinear unknown, linear unknown and yield force of each element.
    let elements: Vec<(usize, usize, f64)> = linear
        .iter()
        .enumerate()
        .filter_map(|(j, term)| match term.column {
            ColumnKind::Element(k) => Some((layout.yields().start + k, j, c[j])),
            _ => None,
        })
        .collect();
    let positive = |name: String, dimension, value, slope, nonlinear, linear| Physical {
        name,
        dimension,
        value,
        slope,
        nonlinear,
        linear,
        positive: true,
        share: false,
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
        let name = format!("{STIFFNESS}{}", k + 1);
        let stiffness = force * inverse;
        out.push(positive(
            name,
            Dimension::Stiffness,
            stiffness,
            slope,
            None,
            Some(j),
        ));
    }
    for (k, &(i, j, _)) in elements.iter().enumerate() {
        let mut slope = vec![0.0; width];
        slope[i] = exp(p[i]);
        let name = format!("{YIELD}{}", k + 1);
        out.push(positive(
            name,
            Dimension::Length,
            exp(p[i]),
            slope,
            Some(i),
            Some(j),
        ));
    }
    out.push(positive(
        "sigma0".into(),
        Dimension::Stiffness,
        total,
        total_slope,
        None,
        None,
    ));
    if let Some(i) = layout.attraction {
        let mut slope = vec![0.0; width];
        slope[i] = exp(p[i]);
        out.push(positive(
            "attraction".into(),
            Dimension::Rate,
            exp(p[i]),
            slope,
            Some(i),
            None,
        ));
    }
    let force: f64 = elements.iter().map(|(_, _, force)| force).sum();
    let suffixes: &[&str] = if law.asymmetric {
        &["_pos", "_neg"]
    } else {
        &[""]
    };
    for (side, suffix) in suffixes.iter().enumerate() {
        let ratio = if side == 1 { layout.ratio } else { None };
        let scale = ratio.map_or(1.0, |i| exp(p[i]));
        let mut slope = vec![0.0; width];
        for (_, j, _) in &elements {
            slope[layout.count + j] = scale;
        }
        if let Some(i) = ratio {
            slope[i] = scale * force;
        }
        let fixed = scale * force;
        if let (Some(e), Some(v)) = (layout.excess[side], layout.velocity[side]) {
            let excess = exp(p[e]);
            let inverse = 1.0 / (1.0 + excess);
            let mut coulomb: Vec<f64> = slope.iter().map(|x| x * inverse).collect();
            coulomb[e] = -fixed * excess * inverse * inverse;
            let name = format!("coulomb{suffix}");
            let value = fixed * inverse;
            out.push(positive(name, Dimension::Force, value, coulomb, None, None));
            let name = format!("stribeck_velocity{suffix}");
            let mut slope = vec![0.0; width];
            slope[v] = exp(p[v]);
            out.push(positive(
                name,
                Dimension::Speed,
                exp(p[v]),
                slope,
                Some(v),
                None,
            ));
        }
        // Without a Stribeck curve there is one level only.
        let name = match layout.excess[side] {
            Some(_) => format!("static{suffix}"),
            None => format!("coulomb{suffix}"),
        };
        out.push(positive(name, Dimension::Force, fixed, slope, None, None));
    }
    out
}
