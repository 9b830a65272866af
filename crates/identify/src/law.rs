//! Which law is fitted, and which linear terms beside it.

pub(crate) mod physical;
pub(crate) mod terms;

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
    /// Whether the exponent is one more unknown, common to both directions; `exponent` is not used
    /// then.
    pub exponent_fitted: bool,
}

impl Law {
    /// The symmetric law of this family with the Gaussian Stribeck curve.
    pub fn new(kind: LawKind) -> Self {
        Self {
            kind,
            asymmetric: false,
            exponent: 2.0,
            exponent_fitted: false,
        }
    }

    /// The same law with parameters per direction.
    #[must_use]
    pub fn asymmetric(mut self) -> Self {
        self.asymmetric = true;
        self
    }

    /// The same law with its Stribeck exponent as one more unknown.
    #[must_use]
    pub fn with_fitted_exponent(mut self) -> Self {
        self.exponent_fitted = true;
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
        let exponent = next(curve && self.exponent_fitted);
        Layout {
            kappa,
            excess: [excess_pos, if two { excess_neg } else { excess_pos }],
            velocity: [velocity_pos, if two { velocity_neg } else { velocity_pos }],
            ratio,
            exponent,
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
    /// `ln delta`, the Stribeck exponent of both directions.
    pub exponent: Option<usize>,
    /// How many there are.
    pub count: usize,
}
