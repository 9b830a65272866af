//! The families of friction laws.

use crate::{Quantity, UnknownLaw};

/// A family of friction laws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum LawKind {
    /// `Fc sgn v + s2 v`.
    CoulombViscous,
    /// `[Fc + (Fs - Fc) exp(-|v/vs|^delta)] sgn v + s2 v`.
    Stribeck,
    /// LuGre with `Fs = Fc` and `s1 = 0`.
    Dahl,
    /// Canudas de Wit et al. 1995, doi 10.1109/9.376053.
    LuGre,
    /// LuGre that does not creep below break-away: Dupont et al. 2002, doi 10.1109/TAC.2002.1000274.
    ElastoPlastic,
    /// Maxwell slip: elements that stick and slip in parallel, without a Stribeck curve.
    MaxwellSlip,
    /// Generalised Maxwell slip: Al-Bender, Lampaert and Swevers 2005, doi 10.1109/TAC.2005.858676.
    Gms,
}

impl LawKind {
    /// All families, from the simplest to the richest.
    pub const ALL: [LawKind; 7] = [
        LawKind::CoulombViscous,
        LawKind::Stribeck,
        LawKind::Dahl,
        LawKind::LuGre,
        LawKind::ElastoPlastic,
        LawKind::MaxwellSlip,
        LawKind::Gms,
    ];

    /// Name as typed on the command line and written to files.
    pub fn name(self) -> &'static str {
        match self {
            LawKind::CoulombViscous => "coulomb-viscous",
            LawKind::Stribeck => "stribeck",
            LawKind::Dahl => "dahl",
            LawKind::LuGre => "lugre",
            LawKind::ElastoPlastic => "elasto-plastic",
            LawKind::MaxwellSlip => "maxwell-slip",
            LawKind::Gms => "gms",
        }
    }

    /// The family of this name.
    #[doc(hidden)]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// Whether the law has a bristle, and so memory and a stiffness.
    #[doc(hidden)]
    pub fn has_bristle(self) -> bool {
        let one = matches!(
            self,
            LawKind::Dahl | LawKind::LuGre | LawKind::ElastoPlastic
        );
        one || self.has_elements()
    }

    /// Whether the law is a number of Maxwell-slip elements in parallel.
    #[doc(hidden)]
    pub fn has_elements(self) -> bool {
        matches!(self, LawKind::MaxwellSlip | LawKind::Gms)
    }

    /// Whether the law leaves nothing to a search: its parameters are all linear, or known places of elements.
    #[doc(hidden)]
    pub fn needs_no_search(self) -> bool {
        self == LawKind::CoulombViscous || self.has_elements()
    }

    /// Whether the friction level falls with speed.
    #[doc(hidden)]
    pub fn has_stribeck(self) -> bool {
        matches!(
            self,
            LawKind::Stribeck | LawKind::LuGre | LawKind::ElastoPlastic | LawKind::Gms
        )
    }

    /// Whether the bristle has a micro-damping.
    #[doc(hidden)]
    pub fn has_micro_damping(self) -> bool {
        matches!(self, LawKind::LuGre | LawKind::ElastoPlastic)
    }

    /// Whether a parameter can belong to the law or stand beside it: inertia, offset, delay and the terms of the axis stand
    /// beside any law.
    pub fn has(self, quantity: Quantity) -> bool {
        match quantity {
            Quantity::Sigma0 => self.has_bristle(),
            Quantity::Sigma1 => self.has_micro_damping(),
            Quantity::Static | Quantity::StribeckVelocity | Quantity::StribeckExponent => {
                self.has_stribeck()
            }
            Quantity::BreakawayRatio => self == LawKind::ElastoPlastic,
            Quantity::Attraction => self == LawKind::Gms,
            Quantity::ElementStiffness(_)
            | Quantity::ElementYield(_)
            | Quantity::ElementForce(_) => self.has_elements(),
            _ => true,
        }
    }

    /// The parameters that the law cannot do without, in the order of tables; of the elements of a Maxwell-slip law the
    /// first.
    #[doc(hidden)]
    pub fn needs(self) -> impl Iterator<Item = Quantity> {
        [
            (Quantity::Sigma0, self.has_bristle() && !self.has_elements()),
            (Quantity::Sigma1, self.has_micro_damping()),
            (Quantity::Sigma2, true),
            (Quantity::Coulomb, true),
            (Quantity::Static, self.has_stribeck()),
            (Quantity::StribeckVelocity, self.has_stribeck()),
            (Quantity::BreakawayRatio, self == LawKind::ElastoPlastic),
            (Quantity::Attraction, self == LawKind::Gms),
            (Quantity::ElementStiffness(1), self.has_elements()),
            (Quantity::ElementYield(1), self.has_elements()),
        ]
        .into_iter()
        .filter_map(|(quantity, needed)| needed.then_some(quantity))
    }
}

impl std::str::FromStr for LawKind {
    type Err = UnknownLaw;

    fn from_str(name: &str) -> Result<Self, UnknownLaw> {
        Self::from_name(name).ok_or_else(|| UnknownLaw(name.into()))
    }
}

/// A name for the law as a person writes it.
impl std::fmt::Display for LawKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
