//! From the unknowns of the search to the parameters of the law.

use crate::gms;
use crate::law::terms::{ColumnKind, LinearTerm, Side};
use crate::law::{Law, share_of_odds, transmitted};
use crate::parameter::physical::Physical;
use stiction_parameters::{Name, Quantity};

/// All identified parameters of a law at the unknowns `p`, `c`; `step` is the sample time, s.
pub(crate) fn physical(
    law: &Law,
    linear: &[LinearTerm],
    step: f64,
    p: &[f64],
    c: &[f64],
) -> Vec<Physical> {
    let layout = law.layout();
    let k = p.len();
    let width = k + c.len();
    let at = |name: Quantity| linear.iter().position(|t| t.name == name);
    let sides = stiction_parameters::Side::all(law.asymmetric);
    let mut out = if law.kind.has_elements() {
        gms::physical::physical(law, linear, p, c)
    } else {
        Vec::new()
    };
    let mut push = |name: Name,
                    value: f64,
                    slope: Vec<f64>,
                    nonlinear: Option<usize>,
                    linear: Option<usize>| {
        out.push(Physical {
            name,
            value,
            slope,
            nonlinear,
            linear,
        });
    };
    let unit = |i: usize, x: f64| {
        let mut slope = vec![0.0; width];
        slope[i] = x;
        slope
    };
    if let Some(level) = at(Quantity::Coulomb) {
        let coulomb = c[level];
        if let Some(i) = layout.kappa {
            let kappa = libm::exp(p[i]);
            let mut slope = unit(i, kappa * coulomb);
            slope[k + level] = kappa;
            push(
                Quantity::Sigma0.into(),
                kappa * coulomb,
                slope,
                Some(i),
                Some(level),
            );
        }
        if let Some(i) = at(Quantity::Sigma1) {
            push(
                Quantity::Sigma1.into(),
                c[i],
                unit(k + i, 1.0),
                None,
                Some(i),
            );
        }
        for (index, side) in sides.iter().enumerate() {
            let ratio = if index == 1 { layout.ratio } else { None };
            let scale = ratio.map_or(1.0, |i| libm::exp(p[i]));
            let value = coulomb * scale;
            let mut coulomb_slope = unit(k + level, scale);
            if let Some(i) = ratio {
                coulomb_slope[i] = value;
            }
            push(
                Name::new(Quantity::Coulomb, *side),
                value,
                coulomb_slope.clone(),
                None,
                Some(level),
            );
            if let (Some(e), Some(v)) = (layout.excess[index], layout.velocity[index]) {
                let excess = libm::exp(p[e]);
                let mut slope: Vec<f64> =
                    coulomb_slope.iter().map(|x| x * (1.0 + excess)).collect();
                slope[e] += value * excess;
                push(
                    Name::new(Quantity::Static, *side),
                    value * (1.0 + excess),
                    slope,
                    Some(e),
                    Some(level),
                );
                let velocity = libm::exp(p[v]);
                push(
                    Name::new(Quantity::StribeckVelocity, *side),
                    velocity,
                    unit(v, velocity),
                    Some(v),
                    None,
                );
            }
        }
    }
    if let Some(i) = layout.exponent {
        let exponent = libm::exp(p[i]);
        push(
            Quantity::StribeckExponent.into(),
            exponent,
            unit(i, exponent),
            Some(i),
            None,
        );
    }
    let weight = transmitted::weight_of(linear);
    for (i, term) in linear.iter().enumerate() {
        let own = term.name == Quantity::Coulomb || term.name == Quantity::Sigma1;
        if own || matches!(term.name.quantity, Quantity::ElementForce(_)) {
            continue;
        }
        // The level of the negative direction is a multiple of that of the positive one, and so is
        // how it changes.
        let ratio = match term.column {
            ColumnKind::LevelTimes(_, Some(Side::Negative)) => layout.ratio,
            _ => None,
        };
        let scale = ratio.map_or(1.0, |i| libm::exp(p[i]));
        let mut slope = unit(k + i, scale);
        if let Some(at) = ratio {
            slope[at] = scale * c[i];
        }
        let mut value = scale * c[i];
        // A part of what is transmitted, which is as large as the weight that is fitted.
        if let (Some(of), Some(weight)) = (transmitted::of(term.column), weight) {
            let (larger, by) = of.scale(weight.map(|j| c[j]));
            value /= larger;
            slope.iter_mut().for_each(|x| *x /= larger);
            for (j, by) in weight.into_iter().zip(by) {
                slope[k + j] -= value * by / larger;
            }
        }
        push(term.name, value, slope, None, Some(i));
    }
    if k > layout.count {
        let delay = k - 1;
        push(
            Quantity::Delay.into(),
            p[delay] * step,
            unit(delay, step),
            Some(delay),
            None,
        );
    }
    if let Some(i) = layout.breakaway {
        let (value, slope) = share_of_odds(p[i]);
        out.push(Physical {
            name: Quantity::BreakawayRatio.into(),
            value,
            slope: unit(i, slope),
            nonlinear: Some(i),
            linear: None,
        });
    }
    out.sort_by_key(|parameter| parameter.name.quantity.place());
    out
}
