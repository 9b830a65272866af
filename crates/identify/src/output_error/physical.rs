//! From the shared unknowns to the parameters of the law.

use crate::gms;
use crate::law::Law;
use crate::law::terms::{ColumnKind, LinearTerm, Mass, Terms};
use crate::output_error::plant::Axis;
use crate::output_error::unknowns::{Layout, Unknown};
use crate::parameter::Parameter;
use crate::parameter::physical::Physical;
use stiction_parameters::{Name, Quantity, Side};

/// The parameters of the law as functions of the shared unknowns.
///
/// The delay is that of the middle of a row's force, as the fit of the force states it.
pub(crate) fn parameters(
    law: &Law,
    layout: &Layout,
    axis: &Axis,
    q: &[f64],
    centre: f64,
) -> Vec<Physical> {
    let mut out = match law.kind.has_elements() {
        true => of_elements(law, layout, axis, q),
        false => Vec::new(),
    };
    for (k, (unknown, &x)) in layout.unknowns.iter().zip(q).enumerate() {
        let mut slope = vec![0.0; q.len()];
        let (name, value) = match *unknown {
            Unknown::Stiffness => {
                slope[k] = axis.stiffness;
                (Quantity::Sigma0.into(), axis.stiffness)
            }
            Unknown::MicroDamping => {
                slope[k] = axis.micro_damping;
                (Quantity::Sigma1.into(), axis.micro_damping)
            }
            Unknown::Viscous(side) => {
                slope[k] = 1.0;
                (Name::new(Quantity::Sigma2, side), x)
            }
            Unknown::Coulomb(side) => {
                let level = axis.sides[side.index()].coulomb;
                slope[k] = level;
                (Name::new(Quantity::Coulomb, side), level)
            }
            // The elements have given these.
            Unknown::Reach(_) | Unknown::Yield(_) | Unknown::Ratio | Unknown::Attraction => {
                continue;
            }
            Unknown::Excess(_) | Unknown::Velocity(_) if law.kind.has_elements() => continue,
            Unknown::Excess(side) => {
                let curve = &axis.sides[side.index()];
                slope[k] = curve.fixed - curve.coulomb;
                if let Some(level) = layout.place(Unknown::Coulomb(side)) {
                    slope[level] = curve.fixed;
                }
                (Name::new(Quantity::Static, side), curve.fixed)
            }
            Unknown::Velocity(side) => {
                let velocity = axis.sides[side.index()].velocity;
                slope[k] = velocity;
                (Name::new(Quantity::StribeckVelocity, side), velocity)
            }
            Unknown::Mass => {
                slope[k] = axis.mass;
                (Quantity::Mass.into(), axis.mass)
            }
            Unknown::Offset => {
                slope[k] = 1.0;
                (Quantity::Offset.into(), x)
            }
            Unknown::Delay => {
                slope[k] = 1.0;
                (Quantity::Delay.into(), x + centre)
            }
            Unknown::Wave(i) => {
                slope[k] = 1.0;
                (layout.waves[i].1, x)
            }
        };
        out.push(Physical {
            name,
            value,
            slope,
            nonlinear: Some(k),
            linear: None,
        });
    }
    out.sort_by_key(|parameter| parameter.name.quantity.place());
    out
}

/// The parameters of a law with elements, from those of the fit of the force in its own unknowns.
fn of_elements(law: &Law, layout: &Layout, axis: &Axis, q: &[f64]) -> Vec<Physical> {
    let theirs = law.layout();
    let place = |unknown| layout.place(unknown);
    // Where each of their nonlinear unknowns stands here; all are the same logarithms.
    let mut at = vec![None; theirs.count];
    let mut same = |index: Option<usize>, unknown| {
        if let Some(i) = index {
            at[i] = place(unknown);
        }
    };
    for (i, &side) in Side::all(law.asymmetric).iter().enumerate() {
        same(theirs.excess[i], Unknown::Excess(side));
        same(theirs.velocity[i], Unknown::Velocity(side));
    }
    same(theirs.ratio, Unknown::Ratio);
    same(theirs.attraction, Unknown::Attraction);
    for (k, i) in theirs.yields().enumerate() {
        same(Some(i), Unknown::Reach(k));
    }
    let value = |place: &Option<usize>| place.map_or(0.0, |k| q[k]);
    let p: Vec<f64> = at.iter().map(value).collect();
    // The yield forces are linear there and logarithms here.
    let forces: Vec<f64> = (0..law.elements).map(|k| axis.element(k).force).collect();
    let term = |k: usize| LinearTerm {
        name: Quantity::ElementForce(k as u32 + 1).into(),
        column: ColumnKind::Element(k),
    };
    let linear: Vec<LinearTerm> = (0..law.elements).map(term).collect();
    let moved = |mut parameter: Physical| {
        let mut slope = vec![0.0; q.len()];
        for (i, place) in at.iter().enumerate() {
            if let Some(k) = *place {
                slope[k] += parameter.slope[i];
            }
        }
        for (i, force) in forces.iter().enumerate() {
            if let Some(k) = place(Unknown::Yield(i)) {
                slope[k] += force * parameter.slope[theirs.count + i];
            }
        }
        parameter.slope = slope;
        parameter.nonlinear = match (parameter.nonlinear, parameter.linear) {
            (Some(i), _) => at[i],
            (None, Some(i)) => place(Unknown::Yield(i)),
            (None, None) => None,
        };
        parameter.linear = None;
        parameter
    };
    let all = gms::physical::physical(law, &linear, &p, &forces);
    all.into_iter().map(moved).collect()
}

/// Puts what was given beside what was found, in the order of tables.
pub(crate) fn insert_given(parameters: &mut Vec<Parameter>, law: &Law, terms: &Terms) {
    if law.kind.has_stribeck() {
        let at = parameters
            .iter()
            .rposition(|p| p.name.quantity == Quantity::StribeckVelocity)
            .map_or(parameters.len(), |i| i + 1);
        parameters.insert(
            at,
            Parameter::given(Quantity::StribeckExponent, law.exponent),
        );
    }
    if let Mass::Given(mass) = terms.mass {
        let at = parameters
            .iter()
            .position(|p| p.name == Quantity::Offset)
            .unwrap_or(parameters.len());
        let mass = Parameter::given(Quantity::Mass, mass);
        parameters.insert(at, mass);
    }
}
