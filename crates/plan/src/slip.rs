//! Maxwell-slip elements on a simulated axis: their law, and what their force depends on.

use crate::candidate::Candidate;
use crate::subject::Elements;
use stiction_friction::{Direction, Element, MaxwellSlip, ParamError, Shape, Stribeck};
use stiction_identify::{Fall, SlipAlong, slip_along};

/// The elements of an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Slip {
    /// Of each the stiffness, N/m (N m/rad), and the deflection at which it yields at rest, m (rad); both > 0.
    pub elements: Vec<[f64; 2]>,
    /// Rate at which an element that slips follows the curve, > 0, 1/s; none where the level does not fall with speed.
    pub attraction: Option<f64>,
}

/// A curve that does not fall has any Stribeck velocity, m/s (rad/s).
const ANY_VELOCITY: f64 = 1.0;

impl Slip {
    /// The axis of values in the order of [`Subject::names`](crate::Subject::names), up to the mass.
    pub(crate) fn axis(of: Elements, values: &[f64]) -> Option<Candidate> {
        let (stiffnesses, rest) = values.split_at_checked(of.count)?;
        let (yields, rest) = rest.split_at_checked(of.count)?;
        let elements: Vec<[f64; 2]> = stiffnesses
            .iter()
            .zip(yields)
            .map(|(k, d)| [*k, *d])
            .collect();
        let held: f64 = elements.iter().map(|[k, d]| k * d).sum();
        let (sigma2, [coulomb, velocity], attraction, mass) = match *rest {
            [sigma2, coulomb, velocity, attraction, mass] if of.falls => {
                (sigma2, [coulomb, velocity], Some(attraction), mass)
            }
            [sigma2, mass] if !of.falls => (sigma2, [held, ANY_VELOCITY], None, mass),
            _ => return None,
        };
        let sigma0 = stiffnesses.iter().sum();
        let plain = [sigma0, 0.0, sigma2, coulomb, held, velocity, mass];
        Some(Candidate {
            slip: Some(Slip {
                elements,
                attraction,
            }),
            ..Candidate::from_values(plain)
        })
    }

    /// The values of an axis with these elements, in the order of [`Slip::axis`].
    pub(crate) fn values(&self, axis: &Candidate) -> Vec<f64> {
        let each = |i: usize| self.elements.iter().map(move |element| element[i]);
        let mut out: Vec<f64> = each(0).chain(each(1)).chain([axis.sigma2]).collect();
        if let Some(attraction) = self.attraction {
            out.extend([axis.coulomb, axis.stribeck_velocity, attraction]);
        }
        out.push(axis.mass);
        out
    }

    /// Refuses values that are no such axis.
    pub(crate) fn validate(&self, axis: &Candidate) -> Result<(), ParamError> {
        for [stiffness, deflection] in &self.elements {
            ParamError::positive("stiffness", *stiffness)?;
            ParamError::positive("yield", *deflection)?;
        }
        ParamError::positive("sigma2", axis.sigma2)?;
        ParamError::positive("coulomb", axis.coulomb)?;
        ParamError::positive("mass", axis.mass)?;
        if let Some(attraction) = self.attraction {
            ParamError::positive("attraction", attraction)?;
            ParamError::positive("stribeck_velocity", axis.stribeck_velocity)?;
            if axis.static_friction.is_nan() || axis.static_friction <= axis.coulomb {
                let allowed = "above Coulomb friction";
                return Err(ParamError::new("static", axis.static_friction, allowed));
            }
        }
        self.law(axis).map(|_| ())
    }

    /// The law of an axis with these elements.
    pub fn law(&self, axis: &Candidate) -> Result<MaxwellSlip<f64>, ParamError> {
        let both = Direction {
            coulomb: axis.coulomb,
            static_friction: axis.static_friction,
            stribeck_velocity: axis.stribeck_velocity,
            viscous: axis.sigma2,
        };
        let curve = Stribeck::symmetric(Shape::Gaussian, both, 0.0)?;
        let elements: Vec<Element<f64>> = self
            .elements
            .iter()
            .map(|[stiffness, deflection]| Element {
                stiffness: *stiffness,
                share: stiffness * deflection,
            })
            .collect();
        let attraction = self
            .attraction
            .map_or(f64::INFINITY, |rate| rate * axis.static_friction);
        MaxwellSlip::new(&elements, attraction, curve)
    }

    /// The force of each element at its yield, N (N m).
    fn forces(&self) -> Vec<f64> {
        self.elements.iter().map(|[k, d]| k * d).collect()
    }

    /// The elements along a velocity.
    fn along(
        &self,
        axis: &Candidate,
        step: f64,
        velocity: &[f64],
        slopes: bool,
    ) -> (Vec<f64>, SlipAlong) {
        let yields: Vec<f64> = self.elements.iter().map(|element| element[1]).collect();
        let fall = self.attraction.map(|attraction| Fall {
            excess: axis.excess(),
            stribeck_velocity: axis.stribeck_velocity,
            attraction,
        });
        let forces = self.forces();
        let along = slip_along(&yields, &forces, fall, (step, velocity), slopes);
        (forces, along)
    }

    /// What the law and the mass ask for along a motion, without the terms beside them, N (N m).
    pub(crate) fn force(
        &self,
        axis: &Candidate,
        step: f64,
        (velocity, acceleration): (&[f64], &[f64]),
    ) -> Vec<f64> {
        let (_, along) = self.along(axis, step, velocity, false);
        let motion = velocity.iter().zip(acceleration);
        let each = along.force.iter().zip(motion);
        each.map(|(force, (v, a))| force + axis.sigma2 * v + axis.mass * a)
            .collect()
    }

    /// Derivatives of the same by the logarithms of the values of the law and the mass, in the order of [`Slip::values`].
    ///
    /// The fit has yield forces W, yield deflections d and Fs/Fc - 1 as its unknowns; a stiffness at a given d raises W, and with it Fs.
    pub(crate) fn jacobian(
        &self,
        axis: &Candidate,
        step: f64,
        (velocity, acceleration): (&[f64], &[f64]),
    ) -> Vec<Vec<f64>> {
        let (forces, along) = self.along(axis, step, velocity, true);
        let shared = if self.attraction.is_some() { 3 } else { 0 };
        let over = axis.static_friction - axis.coulomb;
        // By ln W of an element at its d and at a given Fc.
        let by_force = |k: usize| -> Vec<f64> {
            let levels = along.levels[k].iter().map(|level| forces[k] * level);
            match self.attraction {
                None => levels.collect(),
                Some(_) => {
                    let steeper = forces[k] / over;
                    let both = levels.zip(&along.slopes[0]);
                    both.map(|(own, slope)| own + steeper * slope).collect()
                }
            }
        };
        let count = self.elements.len();
        let stiffnesses: Vec<Vec<f64>> = (0..count).map(by_force).collect();
        let yields = (0..count).map(|k| {
            let both = stiffnesses[k].iter().zip(&along.slopes[shared + k]);
            both.map(|(a, b)| a + b).collect::<Vec<f64>>()
        });
        let yields: Vec<Vec<f64>> = yields.collect();
        let mut out = stiffnesses;
        out.extend(yields);
        out.push(velocity.iter().map(|v| axis.sigma2 * v).collect());
        if self.attraction.is_some() {
            let steeper = axis.static_friction / over;
            out.push(along.slopes[0].iter().map(|s| -steeper * s).collect());
            out.push(along.slopes[1].clone());
            out.push(along.slopes[2].clone());
        }
        out.push(acceleration.iter().map(|a| axis.mass * a).collect());
        out
    }
}
