//! Which law is fitted, and which linear terms beside it.

pub(crate) mod dependence;
pub(crate) mod map;
pub(crate) mod physical;
pub(crate) mod prior;
pub(crate) mod terms;
pub(crate) mod transmitted;

pub use stiction_parameters::LawKind;

/// A law to fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    /// The family.
    pub kind: LawKind,
    /// Whether each direction of motion has parameters of its own.
    pub asymmetric: bool,
    /// Stribeck exponent `delta`, dimensionless; 2 is the Gaussian curve.
    pub exponent: f64,
    /// Elements of a Maxwell-slip law; 0 leaves the number to the data. Other laws do
    /// not look at it.
    pub elements: usize,
    /// Whether the exponent is one more unknown, common to both directions; `exponent` is not used
    /// then.
    pub exponent_fitted: bool,
    /// Whether static friction is held at Coulomb friction, so that LuGre has no Stribeck curve.
    pub flat: bool,
    /// Whether the micro-damping of LuGre is held at zero.
    pub undamped: bool,
}

impl Law {
    /// The symmetric law of this family with the Gaussian Stribeck curve.
    pub fn new(kind: LawKind) -> Self {
        Self {
            kind,
            asymmetric: false,
            exponent: 2.0,
            elements: 0,
            exponent_fitted: false,
            flat: false,
            undamped: false,
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

    /// LuGre with static friction held at Coulomb friction (`Fs = Fc`); another law is as it was.
    #[must_use]
    pub fn flat(mut self) -> Self {
        self.flat = self.kind == LawKind::LuGre;
        self
    }

    /// LuGre without micro-damping (`sigma1 = 0`); another law is as it was.
    #[must_use]
    pub fn undamped(mut self) -> Self {
        self.undamped = self.kind == LawKind::LuGre;
        self
    }

    /// Whether its friction level falls with speed.
    pub fn has_stribeck(&self) -> bool {
        self.kind.has_stribeck() && !self.flat
    }

    /// Whether its bristle has a micro-damping.
    pub fn has_micro_damping(&self) -> bool {
        self.kind.has_micro_damping() && !self.undamped
    }

    /// Number of nonlinear unknowns.
    pub fn nonlinear(&self) -> usize {
        let layout = self.layout();
        layout.count
    }

    /// Names of the nonlinear unknowns of a law that is not of Maxwell slip, in their order; each is
    /// searched by its logarithm. `kappa` is sigma0/Fc in 1/m (1/rad), `excess` is Fs/Fc - 1, `ratio`
    /// is Fc of the negative direction over that of the positive one, `breakaway_odds` b/(1 - b).
    pub fn unknowns(&self) -> Vec<String> {
        let layout = self.layout();
        let both = [
            ("kappa", layout.kappa),
            ("ratio", layout.ratio),
            ("breakaway_odds", layout.breakaway),
            ("stribeck_exponent", layout.exponent),
        ];
        let two = layout.excess[0] != layout.excess[1];
        let suffixes = if two { ["_pos", "_neg"] } else { [""; 2] };
        let mut names = vec![String::new(); layout.count];
        for (name, index) in both {
            if let Some(i) = index {
                names[i] = name.into();
            }
        }
        for (name, sides) in [
            ("excess", layout.excess),
            ("stribeck_velocity", layout.velocity),
        ] {
            for (suffix, index) in suffixes.iter().zip(sides) {
                if let Some(i) = index {
                    names[i] = format!("{name}{suffix}");
                }
            }
        }
        names
    }

    pub(crate) fn layout(&self) -> Layout {
        let mut count = 0;
        let mut next = |wanted: bool| {
            wanted.then(|| {
                count += 1;
                count - 1
            })
        };
        let elements = self.kind.has_elements();
        let bristle = self.kind.has_bristle() && !elements;
        let curve = self.has_stribeck();
        // Coulomb + viscous stays linear in both directions: one sign column each.
        let two = self.asymmetric && self.kind != LawKind::CoulombViscous;
        let kappa = next(bristle);
        let excess_pos = next(curve);
        let velocity_pos = next(curve);
        let ratio = next(two);
        let excess_neg = next(two && curve);
        let velocity_neg = next(two && curve);
        let breakaway = next(self.kind == LawKind::ElastoPlastic);
        let attraction = next(elements && curve);
        let exponent = next(curve && self.exponent_fitted && !elements);
        let yields = if elements { self.elements } else { 0 };
        count += yields;
        Layout {
            kappa,
            excess: [excess_pos, if two { excess_neg } else { excess_pos }],
            velocity: [velocity_pos, if two { velocity_neg } else { velocity_pos }],
            ratio,
            breakaway,
            attraction,
            yields,
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
    /// `ln (Fc- / Fc+)`; for the Maxwell-slip law `ln (Fs- / Fs+)`.
    pub ratio: Option<usize>,
    /// `ln (b/(1 - b))`, b = z_ba/z_ss, of an elasto-plastic bristle.
    pub breakaway: Option<usize>,
    /// `ln w`, the rate in 1/s at which a slipping Maxwell-slip element follows the Stribeck curve.
    pub attraction: Option<usize>,
    /// How many `ln d_k` of Maxwell-slip elements stand last; d in m or rad.
    pub yields: usize,
    /// `ln delta`, the Stribeck exponent of both directions.
    pub exponent: Option<usize>,
    /// How many there are.
    pub count: usize,
}

/// The share, between 0 and 1, that belongs to the logarithm of its odds `b/(1 - b)`, and its derivative.
pub(crate) fn share_of_odds(odds: f64) -> (f64, f64) {
    let share = 1.0 / (1.0 + libm::exp(-odds));
    let rest = 1.0 / (1.0 + libm::exp(odds));
    (share, share * rest)
}

impl Layout {
    /// Where `ln d_k` of the Maxwell-slip elements stand.
    pub fn yields(&self) -> std::ops::Range<usize> {
        self.count - self.yields..self.count
    }
}
