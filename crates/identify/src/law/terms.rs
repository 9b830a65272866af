//! The linear terms of the force: the law's own and those that stand beside it.

use crate::law::{Law, LawKind};
use std::f64::consts::TAU;

/// Linear terms beside the friction law; each is one more exact unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Terms {
    /// Mass or inertia times acceleration.
    pub mass: Mass,
    /// A constant force. Beside an asymmetric law without much presliding it cannot be told from the
    /// difference of the two Coulomb levels.
    pub offset: bool,
    /// Gravity of a rotary axis: `sin q` and `cos q`.
    pub gravity: bool,
    /// Cogging: `sin` and `cos` of `2 pi x / pitch` for each pitch, m or rad.
    pub cogging: Vec<f64>,
}

/// What is known of the moving mass or inertia.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mass {
    /// One more unknown.
    Fitted,
    /// Known: kg or kg m^2 (force unit per acceleration), not negative.
    Given(f64),
    /// The force channel holds no inertia (a load cell between carriage and guide).
    Absent,
}

impl Default for Terms {
    fn default() -> Self {
        Self {
            mass: Mass::Fitted,
            offset: true,
            gravity: false,
            cogging: Vec::new(),
        }
    }
}

/// One linear unknown: its name in files, its place among the physical parameters, and whether it
/// must not be negative.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LinearTerm {
    pub name: String,
    pub column: ColumnKind,
    pub nonnegative: bool,
}

/// How a column of the regression is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ColumnKind {
    /// `eta` (or its steady state for a static law).
    Level,
    /// Deflection of one Maxwell-slip element, counted from 0, over its yield deflection.
    Element(usize),
    /// `sgn v` for one direction only (Coulomb + viscous, asymmetric).
    Sign(Side),
    /// `v - |v| eta / gh`.
    Rate,
    /// `v`, or `v` in one direction only.
    Speed(Option<Side>),
    Acceleration,
    One,
    /// `sin` of a rate times position, 1/m or 1/rad.
    Sine(f64),
    Cosine(f64),
}

/// A direction of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Positive,
    Negative,
}

impl Side {
    /// 1 for a velocity in this direction, 0 otherwise.
    pub fn selects(self, v: f64) -> bool {
        match self {
            Side::Positive => v > 0.0,
            Side::Negative => v < 0.0,
        }
    }
}

impl Terms {
    /// The linear unknowns of a law with these terms, in the order of the columns; the law's own
    /// (those that depend on the nonlinear unknowns) come first.
    pub(crate) fn columns(&self, law: &Law) -> Vec<LinearTerm> {
        let mut out = Vec::new();
        let mut push = |name: &str, column, nonnegative| {
            out.push(LinearTerm {
                name: name.to_string(),
                column,
                nonnegative,
            });
        };
        let split = law.kind == LawKind::CoulombViscous && law.asymmetric;
        if law.kind.has_elements() {
            for k in 0..law.elements {
                let name = format!("{}{}", crate::gms::ELEMENT, k + 1);
                push(&name, ColumnKind::Element(k), true);
            }
        } else if split {
            push("coulomb_pos", ColumnKind::Sign(Side::Positive), true);
            push("coulomb_neg", ColumnKind::Sign(Side::Negative), true);
        } else {
            push("coulomb", ColumnKind::Level, true);
        }
        if law.kind == LawKind::LuGre {
            push("sigma1", ColumnKind::Rate, true);
        }
        if law.asymmetric {
            push("sigma2_pos", ColumnKind::Speed(Some(Side::Positive)), true);
            push("sigma2_neg", ColumnKind::Speed(Some(Side::Negative)), true);
        } else {
            push("sigma2", ColumnKind::Speed(None), true);
        }
        if self.mass == Mass::Fitted {
            push("mass", ColumnKind::Acceleration, true);
        }
        if self.offset {
            push("offset", ColumnKind::One, false);
        }
        if self.gravity {
            push("gravity_sin", ColumnKind::Sine(1.0), false);
            push("gravity_cos", ColumnKind::Cosine(1.0), false);
        }
        for (k, pitch) in self.cogging.iter().enumerate() {
            push(
                &format!("cogging{}_sin", k + 1),
                ColumnKind::Sine(TAU / pitch),
                false,
            );
            push(
                &format!("cogging{}_cos", k + 1),
                ColumnKind::Cosine(TAU / pitch),
                false,
            );
        }
        out
    }
}
