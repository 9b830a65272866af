//! Which law is fitted, and which linear terms beside it.

use std::f64::consts::TAU;

/// A family of friction laws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LawKind {
    /// `Fc sgn v + s2 v`.
    CoulombViscous,
    /// `[Fc + (Fs - Fc) exp(-|v/vs|^delta)] sgn v + s2 v`.
    Stribeck,
    /// LuGre with `Fs = Fc` and `s1 = 0`.
    Dahl,
    /// Canudas de Wit et al. 1995, doi 10.1109/9.376053.
    LuGre,
}

impl LawKind {
    /// All families, from the simplest to the richest.
    pub const ALL: [LawKind; 4] = [
        LawKind::CoulombViscous,
        LawKind::Stribeck,
        LawKind::Dahl,
        LawKind::LuGre,
    ];

    /// Name as typed on the command line and written to files.
    pub fn name(self) -> &'static str {
        match self {
            LawKind::CoulombViscous => "coulomb-viscous",
            LawKind::Stribeck => "stribeck",
            LawKind::Dahl => "dahl",
            LawKind::LuGre => "lugre",
        }
    }

    /// The family of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// Whether the law has a bristle, and so memory and a stiffness.
    pub fn has_bristle(self) -> bool {
        matches!(self, LawKind::Dahl | LawKind::LuGre)
    }

    /// Whether the friction level falls with speed.
    pub fn has_stribeck(self) -> bool {
        matches!(self, LawKind::Stribeck | LawKind::LuGre)
    }
}

/// A name for the law as a person writes it.
impl std::fmt::Display for LawKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// A law to fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    /// The family.
    pub kind: LawKind,
    /// Whether each direction of motion has parameters of its own.
    pub asymmetric: bool,
    /// Stribeck exponent `delta`, dimensionless; 2 is the Gaussian curve.
    pub exponent: f64,
}

impl Law {
    /// The symmetric law of this family with the Gaussian Stribeck curve.
    pub fn new(kind: LawKind) -> Self {
        Self {
            kind,
            asymmetric: false,
            exponent: 2.0,
        }
    }

    /// The same law with parameters per direction.
    #[must_use]
    pub fn asymmetric(mut self) -> Self {
        self.asymmetric = true;
        self
    }

    /// Number of nonlinear unknowns.
    pub fn nonlinear(&self) -> usize {
        let layout = self.layout();
        layout.count
    }

    pub(crate) fn layout(&self) -> Layout {
        let mut count = 0;
        let mut next = |wanted: bool| {
            wanted.then(|| {
                count += 1;
                count - 1
            })
        };
        let bristle = self.kind.has_bristle();
        let curve = self.kind.has_stribeck();
        // Coulomb + viscous stays linear in both directions: one sign column each.
        let two = self.asymmetric && self.kind != LawKind::CoulombViscous;
        let kappa = next(bristle);
        let excess_pos = next(curve);
        let velocity_pos = next(curve);
        let ratio = next(two);
        let excess_neg = next(two && curve);
        let velocity_neg = next(two && curve);
        Layout {
            kappa,
            excess: [excess_pos, if two { excess_neg } else { excess_pos }],
            velocity: [velocity_pos, if two { velocity_neg } else { velocity_pos }],
            ratio,
            count,
        }
    }
}

/// Where each nonlinear unknown stands in the vector `p`; every one is a logarithm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Layout {
    /// `ln kappa`, kappa = s0/Fc in 1/m or 1/rad.
    pub kappa: Option<usize>,
    /// `ln (r - 1)`, r = Fs/Fc, for positive and negative velocity.
    pub excess: [Option<usize>; 2],
    /// `ln vs`, for positive and negative velocity.
    pub velocity: [Option<usize>; 2],
    /// `ln (Fc- / Fc+)`.
    pub ratio: Option<usize>,
    /// How many there are.
    pub count: usize,
}

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
        if split {
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
