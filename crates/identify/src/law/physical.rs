//! From the unknowns of the search to the parameters of the law.

use crate::gms;
use crate::law::dependence::Factor;
use crate::law::terms::{ColumnKind, LinearTerm, Side};
use crate::law::{Law, share_of_odds};
use nalgebra::DMatrix;

/// What a parameter measures; with the units of force and motion this gives its unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Force per length (or torque per angle).
    Stiffness,
    /// Force per speed.
    Damping,
    /// Force, torque, or what stands for it (current, voltage).
    Force,
    /// Length or angle.
    Length,
    /// Length (or angle) per time.
    Speed,
    /// Per time.
    Rate,
    /// Force per acceleration: mass or inertia.
    Inertia,
    /// Time, s.
    Time,
    /// Force per squared speed.
    QuadraticDamping,
    /// Force per normal load; a pure number where both are in one unit.
    ForcePerLoad,
    /// Force per temperature.
    ForcePerTemperature,
    /// Force per speed and temperature.
    DampingPerTemperature,
    /// Normal load, in the unit of its channel.
    Load,
    /// Temperature, K.
    Temperature,
    /// A pure number.
    One,
}

/// A parameter of the law as a function of the unknowns `(p, c)`.
#[derive(Clone, Debug)]
pub(crate) struct Physical {
    pub name: String,
    pub dimension: Dimension,
    pub value: f64,
    /// Derivatives with respect to `p` then `c`.
    pub slope: Vec<f64>,
    /// Nonlinear unknown that sets this parameter, if any: at its bound the parameter is not known.
    pub nonlinear: Option<usize>,
    /// Linear unknown that sets this parameter, if any.
    pub linear: Option<usize>,
    pub positive: bool,
    /// Whether it is a share, between 0 and 1.
    pub share: bool,
}

impl Physical {
    /// Variance for a covariance of the unknowns.
    pub fn variance(&self, unknowns: &DMatrix<f64>) -> f64 {
        (0..self.slope.len())
            .map(|i| self.slope[i] * self.with(unknowns, i))
            .sum()
    }

    /// Covariance with one of the unknowns.
    pub fn with(&self, unknowns: &DMatrix<f64>, unknown: usize) -> f64 {
        self.slope
            .iter()
            .enumerate()
            .map(|(j, slope)| slope * unknowns[(unknown, j)])
            .sum()
    }
}

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
    let at = |name: &str| linear.iter().position(|t| t.name == name);
    let suffixes: &[&str] = if law.asymmetric {
        &["_pos", "_neg"]
    } else {
        &[""]
    };
    let mut out = if law.kind.has_elements() {
        gms::physical::physical(law, linear, p, c)
    } else {
        Vec::new()
    };
    let mut push = |name: String,
                    dimension,
                    value: f64,
                    slope: Vec<f64>,
                    nonlinear: Option<usize>,
                    linear: Option<usize>,
                    positive| {
        out.push(Physical {
            name,
            dimension,
            value,
            slope,
            nonlinear,
            linear,
            positive,
            share: false,
        });
    };
    let unit = |i: usize, x: f64| {
        let mut slope = vec![0.0; width];
        slope[i] = x;
        slope
    };
    if let Some(level) = at("coulomb") {
        let coulomb = c[level];
        if let Some(i) = layout.kappa {
            let kappa = libm::exp(p[i]);
            let mut slope = unit(i, kappa * coulomb);
            slope[k + level] = kappa;
            push(
                "sigma0".into(),
                Dimension::Stiffness,
                kappa * coulomb,
                slope,
                Some(i),
                Some(level),
                true,
            );
        }
        if let Some(i) = at("sigma1") {
            push(
                "sigma1".into(),
                Dimension::Damping,
                c[i],
                unit(k + i, 1.0),
                None,
                Some(i),
                true,
            );
        }
        for (side, suffix) in suffixes.iter().enumerate() {
            let ratio = if side == 1 { layout.ratio } else { None };
            let scale = ratio.map_or(1.0, |i| libm::exp(p[i]));
            let value = coulomb * scale;
            let mut coulomb_slope = unit(k + level, scale);
            if let Some(i) = ratio {
                coulomb_slope[i] = value;
            }
            push(
                format!("coulomb{suffix}"),
                Dimension::Force,
                value,
                coulomb_slope.clone(),
                None,
                Some(level),
                true,
            );
            if let (Some(e), Some(v)) = (layout.excess[side], layout.velocity[side]) {
                let excess = libm::exp(p[e]);
                let mut slope: Vec<f64> =
                    coulomb_slope.iter().map(|x| x * (1.0 + excess)).collect();
                slope[e] += value * excess;
                push(
                    format!("static{suffix}"),
                    Dimension::Force,
                    value * (1.0 + excess),
                    slope,
                    Some(e),
                    Some(level),
                    true,
                );
                let velocity = libm::exp(p[v]);
                push(
                    format!("stribeck_velocity{suffix}"),
                    Dimension::Speed,
                    velocity,
                    unit(v, velocity),
                    Some(v),
                    None,
                    true,
                );
            }
        }
    }
    if let Some(i) = layout.exponent {
        let exponent = libm::exp(p[i]);
        push(
            "stribeck_exponent".into(),
            Dimension::One,
            exponent,
            unit(i, exponent),
            Some(i),
            None,
            true,
        );
    }
    for (i, term) in linear.iter().enumerate() {
        let own = matches!(term.name.as_str(), "coulomb" | "sigma1");
        if own || term.name.starts_with(gms::ELEMENT) {
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
        push(
            term.name.clone(),
            dimension(term.column),
            scale * c[i],
            slope,
            None,
            Some(i),
            term.nonnegative,
        );
    }
    if k > layout.count {
        let delay = k - 1;
        push(
            "delay".into(),
            Dimension::Time,
            p[delay] * step,
            unit(delay, step),
            Some(delay),
            None,
            false,
        );
    }
    if let Some(i) = layout.breakaway {
        let (value, slope) = share_of_odds(p[i]);
        out.push(Physical {
            name: "breakaway_ratio".into(),
            dimension: Dimension::One,
            value,
            slope: unit(i, slope),
            nonlinear: Some(i),
            linear: None,
            positive: true,
            share: true,
        });
    }
    out.sort_by_key(|parameter| rank(&parameter.name));
    out
}

/// What the coefficient of a column measures.
fn dimension(column: ColumnKind) -> Dimension {
    match column {
        ColumnKind::Rate | ColumnKind::Speed(_) => Dimension::Damping,
        ColumnKind::Square(_) => Dimension::QuadraticDamping,
        ColumnKind::Acceleration => Dimension::Inertia,
        ColumnKind::LevelTimes(factor, _) => match factor {
            Factor::Load(_) => Dimension::ForcePerLoad,
            Factor::Temperature(_) => Dimension::ForcePerTemperature,
            Factor::Position(_) => Dimension::Stiffness,
            Factor::Sine(_) | Factor::Cosine(_) => Dimension::Force,
        },
        // Only a temperature changes the viscous term.
        ColumnKind::SpeedTimes(..) => Dimension::DampingPerTemperature,
        ColumnKind::Level
        | ColumnKind::Element(_)
        | ColumnKind::Sign(_)
        | ColumnKind::One
        | ColumnKind::Sine(_)
        | ColumnKind::Cosine(_) => Dimension::Force,
    }
}

/// Order of parameters in tables and files.
pub(crate) fn rank(name: &str) -> usize {
    const ORDER: [&str; 13] = [
        "sigma0",
        "sigma1",
        "sigma2",
        "quadratic_viscous",
        "coulomb",
        "static",
        "stribeck_velocity",
        "stribeck_exponent",
        "breakaway_ratio",
        "attraction",
        "mass",
        "offset",
        "delay",
    ];
    ORDER
        .iter()
        .position(|known| {
            name == *known
                || name
                    .strip_prefix(known)
                    .is_some_and(|s| s == "_pos" || s == "_neg")
        })
        .unwrap_or(ORDER.len())
}

/// Covariance of the physical parameters from that of the unknowns.
pub(crate) fn propagate(parameters: &[Physical], unknowns: &DMatrix<f64>) -> DMatrix<f64> {
    let width = unknowns.nrows();
    let t = DMatrix::from_fn(parameters.len(), width, |i, j| parameters[i].slope[j]);
    &t * unknowns * t.transpose()
}
