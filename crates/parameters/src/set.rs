//! Names with values.

use crate::{FrictionLaw, LawError, LawKind, Name, Quantity, Side};
use stiction_friction::{
    CoulombViscous, Damping, Direction, ElastoPlastic, Element, LuGre, MaxwellSlip, Shape, Stribeck,
};

/// Parameters of a law with their values, SI. What does not belong to the law (mass, delay, cogging, ...) may stand in it
/// and is passed over by [`law`](Self::law).
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterSet {
    kind: LawKind,
    values: Vec<(Name, f64)>,
}

/// Exponent of a curve that names none: the Gaussian of Canudas de Wit et al. 1995.
const GAUSSIAN: f64 = 2.0;
/// Stribeck velocity of a flat curve, m/s (rad/s): any will do.
const ANY_VELOCITY: f64 = 1.0;

/// The two numbers of a level that falls with speed.
fn of_the_fall(quantity: Quantity) -> bool {
    matches!(quantity, Quantity::Static | Quantity::StribeckVelocity)
}

impl ParameterSet {
    /// No values yet.
    pub fn new(kind: LawKind) -> Self {
        ParameterSet {
            kind,
            values: Vec::new(),
        }
    }

    /// Values of a law, in any order.
    pub fn of(kind: LawKind, values: impl IntoIterator<Item = (Name, f64)>) -> Self {
        let mut set = Self::new(kind);
        for (name, value) in values {
            set.insert(name, value);
        }
        set
    }

    /// The values of those names that are names of parameters; others are passed over.
    pub fn from_text<'a>(kind: LawKind, values: impl IntoIterator<Item = (&'a str, f64)>) -> Self {
        let known = values.into_iter();
        Self::of(
            kind,
            known.filter_map(|(name, value)| Some((name.parse().ok()?, value))),
        )
    }

    /// The family of the law.
    pub fn kind(&self) -> LawKind {
        self.kind
    }

    /// Puts a value in, in place of the one that the name has.
    pub fn insert(&mut self, name: impl Into<Name>, value: f64) {
        let name = name.into();
        match self.values.iter_mut().find(|(own, _)| *own == name) {
            Some((_, own)) => *own = value,
            None => self.values.push((name, value)),
        }
    }

    /// The same without a value of this quantity.
    #[must_use]
    pub fn without(mut self, quantity: Quantity) -> Self {
        self.values.retain(|(name, _)| name.quantity != quantity);
        self
    }

    /// All names and values, in the order in which they came.
    pub fn iter(&self) -> impl Iterator<Item = (Name, f64)> {
        self.values.iter().copied()
    }

    /// The value of a name.
    pub fn get(&self, name: impl Into<Name>) -> Option<f64> {
        let name = name.into();
        let found = self.values.iter().find(|(own, _)| *own == name);
        found.map(|(_, value)| *value)
    }

    /// The value that holds in a direction: that of the direction, or that of both.
    pub fn on(&self, quantity: Quantity, side: Side) -> Option<f64> {
        self.get(Name::new(quantity, side))
            .or_else(|| self.get(quantity))
    }

    /// Whether a number of the steady curve has a value for each direction.
    pub fn is_asymmetric(&self) -> bool {
        self.values
            .iter()
            .any(|(name, _)| name.side != Side::Both && name.quantity.is_of_the_steady_curve())
    }

    /// The parameters without a value, in any direction, that the law cannot do without. LuGre does without
    /// `static` and `stribeck_velocity` where it has neither: then `Fs = Fc`.
    pub fn missing(&self) -> impl Iterator<Item = Quantity> {
        let has = |quantity| {
            self.values
                .iter()
                .any(|(name, _)| name.quantity == quantity)
        };
        let flat = !self.falls();
        self.kind
            .needs()
            .filter(move |quantity| !(flat && of_the_fall(*quantity)))
            .filter(move |quantity| !has(*quantity))
    }

    /// The law, with a constant sigma1 as identification finds it; [`FrictionLaw::capped`] is the form for simulation and
    /// control. The offset, if there is one, is in the law; a curve without an exponent is Gaussian, and that of LuGre
    /// without `static` and `stribeck_velocity` is flat.
    ///
    /// # Errors
    /// For a parameter of the law without a value, and a value that the law cannot have.
    pub fn law(&self) -> Result<FrictionLaw, LawError> {
        Ok(match self.kind {
            LawKind::CoulombViscous => FrictionLaw::CoulombViscous(self.coulomb_viscous()?),
            LawKind::Stribeck => FrictionLaw::Stribeck(self.curve()?),
            LawKind::Dahl | LawKind::LuGre => FrictionLaw::LuGre(self.bristle()?),
            LawKind::ElastoPlastic => {
                let breakaway = self.need(Quantity::BreakawayRatio)?;
                FrictionLaw::ElastoPlastic(ElastoPlastic::new(self.bristle()?, breakaway)?)
            }
            LawKind::MaxwellSlip | LawKind::Gms => FrictionLaw::MaxwellSlip(self.maxwell_slip()?),
        })
    }

    /// The law where it is LuGre or Dahl, which is LuGre with a flat curve and no micro-damping.
    ///
    /// # Errors
    /// As [`law`](Self::law), and for another law.
    pub fn lugre(&self) -> Result<LuGre<f64>, LawError> {
        match self.kind {
            LawKind::Dahl | LawKind::LuGre => self.bristle(),
            kind => Err(LawError::NotLuGre { kind }),
        }
    }

    fn need(&self, quantity: Quantity) -> Result<f64, LawError> {
        self.get(quantity).ok_or(LawError::Missing {
            kind: self.kind,
            name: quantity.into(),
        })
    }

    fn need_on(&self, quantity: Quantity, side: Side) -> Result<f64, LawError> {
        self.on(quantity, side).ok_or_else(|| {
            let known = self
                .values
                .iter()
                .any(|(name, _)| name.quantity == quantity);
            let side = if known { side } else { Side::Both };
            LawError::Missing {
                kind: self.kind,
                name: Name::new(quantity, side),
            }
        })
    }

    fn offset(&self) -> f64 {
        self.get(Quantity::Offset).unwrap_or(0.0)
    }

    fn coulomb_viscous(&self) -> Result<CoulombViscous<f64>, LawError> {
        let both = |quantity| {
            Ok::<_, LawError>([
                self.need_on(quantity, Side::Positive)?,
                self.need_on(quantity, Side::Negative)?,
            ])
        };
        let (coulomb, viscous) = (both(Quantity::Coulomb)?, both(Quantity::Sigma2)?);
        // An error names the parameter as the set does.
        Ok(if self.is_asymmetric() {
            CoulombViscous::new(coulomb, viscous, self.offset())?
        } else {
            CoulombViscous::symmetric(coulomb[0], viscous[0], self.offset())?
        })
    }

    /// Whether the level falls with speed; that of LuGre does not where neither number of its curve is given.
    fn falls(&self) -> bool {
        let mut given = self.values.iter().map(|(name, _)| name.quantity);
        let flat = self.kind == LawKind::LuGre && !given.any(of_the_fall);
        self.kind.has_stribeck() && !flat
    }

    /// The steady curve; flat for a law without a Stribeck effect.
    fn curve(&self) -> Result<Stribeck<f64>, LawError> {
        let side = |side| {
            let coulomb = self.need_on(Quantity::Coulomb, side)?;
            let falls = self.falls();
            Ok::<_, LawError>(Direction {
                coulomb,
                static_friction: if falls {
                    self.need_on(Quantity::Static, side)?
                } else {
                    coulomb
                },
                stribeck_velocity: if falls {
                    self.need_on(Quantity::StribeckVelocity, side)?
                } else {
                    ANY_VELOCITY
                },
                viscous: self.need_on(Quantity::Sigma2, side)?,
            })
        };
        let (positive, negative) = (side(Side::Positive)?, side(Side::Negative)?);
        let shape = self.shape();
        // An error names the parameter as the set does.
        Ok(if self.is_asymmetric() {
            Stribeck::new(shape, positive, negative, self.offset())?
        } else {
            Stribeck::symmetric(shape, positive, self.offset())?
        })
    }

    /// The form of the steady curve.
    pub(crate) fn shape(&self) -> Shape<f64> {
        let exponent = self.get(Quantity::StribeckExponent);
        Shape::with_exponent(exponent.unwrap_or(GAUSSIAN))
    }

    fn bristle(&self) -> Result<LuGre<f64>, LawError> {
        let curve = self.curve()?;
        let sigma1 = if self.kind.has_micro_damping() {
            self.need(Quantity::Sigma1)?
        } else {
            0.0
        };
        let sigma0 = self.need(Quantity::Sigma0)?;
        Ok(LuGre::new(sigma0, Damping::Constant(sigma1), curve)?)
    }

    /// The yield forces of the elements at rest are those of the positive direction.
    fn maxwell_slip(&self) -> Result<MaxwellSlip<f64>, LawError> {
        let curve = self.curve()?;
        let mut elements = Vec::new();
        for k in 1.. {
            let stiffness = self.get(Quantity::ElementStiffness(k));
            if stiffness.is_none() && k > 1 {
                break;
            }
            let stiffness = self.need(Quantity::ElementStiffness(k))?;
            let deflection = self.need(Quantity::ElementYield(k))?;
            elements.push(Element {
                stiffness,
                share: stiffness * deflection,
            });
        }
        // The parameter is a rate; the law has it in forces, over the level at rest.
        let attraction = match self.kind {
            LawKind::Gms => self.need(Quantity::Attraction)? * curve.static_level(1.0),
            _ => f64::INFINITY,
        };
        Ok(MaxwellSlip::new(&elements, attraction, curve)?)
    }
}
