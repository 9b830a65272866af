//! A friction law: at constant velocity, sample by sample, or along a record.

use crate::Error;
use stiction_friction::LuGre;
use stiction_parameters::{LawKind, Name, ParameterSet};
use stiction_workflows::{self as workflows, forces_along};

/// A friction law with its numbers, quadratic viscous friction among them.
///
/// ```
/// use stiction::{Law, LawKind, Quantity};
/// let law = Law::new(LawKind::LuGre, [
///     (Quantity::Sigma0, 1.2e5),         // N/m
///     (Quantity::Sigma1, 600.0),         // N s/m
///     (Quantity::Sigma2, 60.0),          // N s/m
///     (Quantity::Coulomb, 20.0),         // N
///     (Quantity::Static, 30.0),          // N
///     (Quantity::StribeckVelocity, 5e-3), // m/s
/// ])?;
/// let mut stepped = law.stepped();
/// for _ in 0..4000 {
///     stepped.step(250e-6, 0.1); // 1 s at 0.1 m/s
/// }
/// assert!((stepped.force() - 26.0).abs() < 1e-9); // Fc + sigma2 v
/// assert!((law.steady(0.1) - 26.0).abs() < 1e-9);
/// # Ok::<(), stiction::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Law {
    kind: LawKind,
    law: workflows::Law,
}

impl Law {
    /// A law of parameters in SI units; those that do not belong to it are left aside, and an exponent that is missing is 2.
    ///
    /// # Errors
    /// Where a parameter of the law is missing, or has a value that it cannot have.
    pub fn new<N: Into<Name>>(
        kind: LawKind,
        parameters: impl IntoIterator<Item = (N, f64)>,
    ) -> Result<Self, Error> {
        let values = parameters.into_iter();
        let values = values.map(|(name, value)| (name.into(), value));
        Self::of(&ParameterSet::of(kind, values))
    }

    pub(crate) fn of(values: &ParameterSet) -> Result<Self, Error> {
        let law = workflows::Law::of(values).map_err(Error::of_law)?;
        let kind = values.kind();
        Ok(Self { kind, law })
    }

    /// Its family.
    pub fn kind(&self) -> LawKind {
        self.kind
    }

    /// Friction at a constant velocity, m/s (rad/s), in the unit of the law; of the sign of the velocity, but for a constant force.
    pub fn steady(&self, velocity: f64) -> f64 {
        self.law.steady(velocity)
    }

    /// The law at rest with nothing deflected, for simulation and control.
    pub fn stepped(&self) -> SteppedLaw {
        SteppedLaw(workflows::SteppedLaw::new(self.law.clone()))
    }

    /// Friction along a record that begins undeflected, as an identification takes it: time in s, velocity in m/s (rad/s), which runs
    /// linearly between samples.
    ///
    /// # Errors
    /// Where the two differ in length, time does not increase, or a number is not finite.
    pub fn along(&self, time: &[f64], velocity: &[f64]) -> Result<Vec<f64>, Error> {
        forces_along(&self.law, time, velocity).map_err(Error::of)
    }

    /// The law for a drive without `std`, as [`friction`](crate::friction) has it; `None` for another law than LuGre and Dahl. Its sigma1 is
    /// constant, as it was identified; quadratic viscous friction is not in it.
    pub fn lugre(&self) -> Option<LuGre<f64>> {
        self.law.law.lugre()
    }
}

/// A law with its state, one call a sample: the form for simulation and control, in which sigma1 is capped so that it cannot create
/// energy.
#[derive(Clone, Debug)]
pub struct SteppedLaw(workflows::SteppedLaw);

impl SteppedLaw {
    /// Advances by `h` seconds at the velocity `v` (m/s, rad/s): the friction force in the unit of the law, positive against
    /// positive velocities. A sample that is not finite leaves the law as it is and returns the force before.
    pub fn step(&mut self, h: f64, v: f64) -> f64 {
        self.0.step(h, v)
    }

    /// The force of the last sample; of the law at rest where there was none.
    pub fn force(&self) -> f64 {
        self.0.force()
    }

    /// The deflection of a bristle, m (rad), or the spring forces of elements; empty for a law without memory.
    pub fn state(&self) -> Vec<f64> {
        self.0.state()
    }

    /// Back to rest.
    pub fn reset(&mut self) {
        self.0.reset();
    }
}
