//! The law that a set of parameters makes.

use stiction_friction::{CoulombViscous, Damping, ElastoPlastic, LuGre, MaxwellSlip, Stribeck};

/// A law of `stiction-friction`, whichever it is.
#[derive(Clone, Debug, PartialEq)]
pub enum FrictionLaw {
    /// Coulomb and viscous friction.
    CoulombViscous(CoulombViscous<f64>),
    /// The steady curve.
    Stribeck(Stribeck<f64>),
    /// LuGre; Dahl is LuGre with a flat curve and no micro-damping.
    LuGre(LuGre<f64>),
    /// Elasto-plastic.
    ElastoPlastic(ElastoPlastic<f64>),
    /// Maxwell slip and generalised Maxwell slip.
    MaxwellSlip(MaxwellSlip<f64>),
}

impl FrictionLaw {
    /// The same law with sigma1 capped so that it cannot create energy
    /// ([`Damping::Capped`]): the form for simulation and control. Identification finds a constant sigma1, and what shows
    /// how a fit behaves has to be simulated with that.
    #[must_use]
    pub fn capped(self) -> Self {
        match self {
            FrictionLaw::LuGre(law) => FrictionLaw::LuGre(capped(&law)),
            FrictionLaw::ElastoPlastic(law) => {
                let same = ElastoPlastic::new(capped(law.bristle()), law.breakaway());
                FrictionLaw::ElastoPlastic(same.unwrap_or(law))
            }
            law => law,
        }
    }

    /// The law if it is LuGre or Dahl.
    pub fn lugre(&self) -> Option<LuGre<f64>> {
        match self {
            FrictionLaw::LuGre(law) => Some(*law),
            _ => None,
        }
    }

    /// The steady curve; `None` for Coulomb and viscous friction, which has none.
    pub fn curve(&self) -> Option<&Stribeck<f64>> {
        match self {
            FrictionLaw::CoulombViscous(_) => None,
            FrictionLaw::Stribeck(curve) => Some(curve),
            FrictionLaw::LuGre(law) => Some(law.curve()),
            FrictionLaw::ElastoPlastic(law) => Some(law.bristle().curve()),
            FrictionLaw::MaxwellSlip(law) => Some(law.curve()),
        }
    }
}

fn capped(law: &LuGre<f64>) -> LuGre<f64> {
    // The same number is valid in either form.
    let capped = Damping::Capped(law.damping().at_rest());
    law.with_damping(capped).unwrap_or(*law)
}
