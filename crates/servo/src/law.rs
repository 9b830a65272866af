//! The friction law of an axis, whichever it is when the program runs.

use crate::known;
use stiction_friction::compensator::Friction;
use stiction_friction::{
    Damping, Direction, ElastoPlastic, Element, Held, LuGre, MaxwellSlip, ParamError, Stribeck,
};

/// A law that an axis can be simulated with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AxisLaw {
    /// LuGre, and Dahl.
    LuGre(LuGre<f64>),
    /// Elasto-plastic.
    ElastoPlastic(ElastoPlastic<f64>),
    /// Maxwell slip and generalised Maxwell slip.
    MaxwellSlip(MaxwellSlip<f64>),
}

/// A law as a type of its own, which an axis is made of.
pub trait OfAxis: Held<f64> {
    /// The law if it is of this type.
    fn of(law: &AxisLaw) -> Option<Self>;
}

impl OfAxis for LuGre<f64> {
    fn of(law: &AxisLaw) -> Option<Self> {
        match law {
            AxisLaw::LuGre(law) => Some(*law),
            _ => None,
        }
    }
}

impl OfAxis for ElastoPlastic<f64> {
    fn of(law: &AxisLaw) -> Option<Self> {
        match law {
            AxisLaw::ElastoPlastic(law) => Some(*law),
            _ => None,
        }
    }
}

impl OfAxis for MaxwellSlip<f64> {
    fn of(law: &AxisLaw) -> Option<Self> {
        match law {
            AxisLaw::MaxwellSlip(law) => Some(*law),
            _ => None,
        }
    }
}

impl AxisLaw {
    /// The steady curve.
    pub fn curve(&self) -> &Stribeck<f64> {
        match self {
            AxisLaw::LuGre(law) => law.curve(),
            AxisLaw::ElastoPlastic(law) => law.bristle().curve(),
            AxisLaw::MaxwellSlip(law) => law.curve(),
        }
    }

    /// Stiffness from rest, N/m (N m/rad).
    pub fn stiffness(&self) -> f64 {
        match self {
            AxisLaw::LuGre(law) => law.stiffness(),
            AxisLaw::ElastoPlastic(law) => law.bristle().stiffness(),
            AxisLaw::MaxwellSlip(law) => law.stiffness(),
        }
    }

    /// The way from rest within which the law is still bending, m (rad).
    pub fn presliding(&self) -> f64 {
        match self {
            AxisLaw::LuGre(law) => law.bound(),
            AxisLaw::ElastoPlastic(law) => law.bound(),
            AxisLaw::MaxwellSlip(law) => law.longest_yield(),
        }
    }

    /// The micro-damping of a law that has one.
    pub fn damping(&self) -> Option<Damping<f64>> {
        match self {
            AxisLaw::LuGre(law) => Some(law.damping()),
            AxisLaw::ElastoPlastic(law) => Some(law.bristle().damping()),
            AxisLaw::MaxwellSlip(_) => None,
        }
    }

    /// The law of a compensator.
    pub fn friction(&self) -> Friction<f64> {
        match *self {
            AxisLaw::LuGre(law) => Friction::LuGre(law),
            AxisLaw::ElastoPlastic(law) => Friction::ElastoPlastic(law),
            AxisLaw::MaxwellSlip(law) => Friction::Gms(law),
        }
    }

    /// The law with another form of its bristle, stiffness and curve as they come.
    fn with_bristle(
        &self,
        of: impl FnOnce(&LuGre<f64>) -> Result<LuGre<f64>, ParamError>,
    ) -> Result<Self, ParamError> {
        Ok(match self {
            AxisLaw::LuGre(law) => AxisLaw::LuGre(of(law)?),
            AxisLaw::ElastoPlastic(law) => {
                AxisLaw::ElastoPlastic(ElastoPlastic::new(of(law.bristle())?, law.breakaway())?)
            }
            AxisLaw::MaxwellSlip(_) => *self,
        })
    }

    /// The law with sigma1 at rest in the form that `like` has, capped or constant; the same where it has none.
    pub fn damped_as(&self, like: impl Fn(f64) -> Damping<f64>) -> Result<Self, ParamError> {
        self.with_bristle(|law| law.with_damping(like(law.damping().at_rest())))
    }

    /// The law with another steady curve.
    pub fn with_curve(&self, curve: Stribeck<f64>) -> Result<Self, ParamError> {
        match self {
            AxisLaw::MaxwellSlip(law) => {
                MaxwellSlip::new(law.elements(), law.attraction(), curve).map(AxisLaw::MaxwellSlip)
            }
            law => law.with_bristle(|law| LuGre::new(law.stiffness(), law.damping(), curve)),
        }
    }

    /// The law with stiffer or softer elements.
    fn with_stiffness(law: &MaxwellSlip<f64>, by: f64) -> Result<MaxwellSlip<f64>, ParamError> {
        let elements = law.elements().iter();
        let elements: Vec<Element<f64>> = elements
            .map(|e| Element {
                stiffness: by * e.stiffness,
                ..*e
            })
            .collect();
        MaxwellSlip::new(&elements, law.attraction(), *law.curve())
    }

    /// The law with its whole friction, but for the offset, `by` > 0 times as large at every deflection and velocity: what a
    /// load or a temperature does to it.
    pub fn scaled(&self, by: f64) -> Result<Self, ParamError> {
        if let AxisLaw::MaxwellSlip(law) = self {
            ParamError::positive("friction", by)?;
            let curve = law.curve();
            let [positive, negative] = [curve.positive(), curve.negative()].map(|side| Direction {
                coulomb: by * side.coulomb,
                static_friction: by * side.static_friction,
                viscous: by * side.viscous,
                ..*side
            });
            let curve = Stribeck::new(curve.shape(), positive, negative, curve.offset())?;
            let stiffer = Self::with_stiffness(law, by)?;
            // A force rate: it grows with the forces.
            let law = MaxwellSlip::new(stiffer.elements(), by * law.attraction(), curve)?;
            return Ok(AxisLaw::MaxwellSlip(law));
        }
        self.with_bristle(|law| crate::load::scaled(law, by))
    }

    /// Wrong laws to give a compensator: [`known::corners`] of the bristle; of elements the stiffness of all, and the curve.
    pub fn corners(&self, by: f64) -> Vec<Self> {
        let AxisLaw::MaxwellSlip(own) = self else {
            let bristle = match self {
                AxisLaw::ElastoPlastic(law) => law.bristle(),
                AxisLaw::LuGre(law) => law,
                AxisLaw::MaxwellSlip(_) => return Vec::new(),
            };
            let corners = known::corners(bristle, by);
            return corners
                .filter_map(|corner| self.with_bristle(|_| Ok(corner)).ok())
                .collect();
        };
        // The corners of a bristle of the same stiffness and curve; sigma1 makes no difference.
        let bristle = LuGre::new(own.stiffness(), Damping::Constant(1.0), *own.curve());
        let Ok(bristle) = bristle else {
            return Vec::new();
        };
        known::corners(&bristle, by)
            .filter(|corner| corner.damping().at_rest() < 1.0)
            .filter_map(|corner| {
                let law = Self::with_stiffness(own, corner.stiffness() / own.stiffness()).ok()?;
                let law = AxisLaw::MaxwellSlip(law).with_curve(*corner.curve());
                law.ok()
            })
            .collect()
    }
}
