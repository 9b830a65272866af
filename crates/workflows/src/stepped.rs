//! A law that is run: sample by sample in real time, or along a record.

use crate::Error;
use stiction_friction::{Elements, Gms, GmsState, MOST_ELEMENTS, MaxwellSlip, ParamError, State};
use stiction_parameters::{FrictionLaw, LawError, ParameterSet, Quantity, Side};

/// A friction law, and the quadratic viscous friction that an identification found beside it.
#[derive(Clone, Debug, PartialEq)]
pub struct Law {
    /// The law.
    pub law: FrictionLaw,
    /// Force per squared speed in positive and negative direction, N s^2/m^2 (N m s^2/rad^2).
    pub quadratic: [f64; 2],
}

impl Law {
    /// The law of a set of parameters.
    ///
    /// # Errors
    /// Where they make none.
    pub fn of(set: &ParameterSet) -> Result<Self, LawError> {
        let quadratic = |side| set.on(Quantity::QuadraticViscous, side).unwrap_or(0.0);
        let quadratic = [Side::Positive, Side::Negative].map(quadratic);
        if let Some(value) = quadratic.iter().find(|value| !value.is_finite()) {
            return Err(ParamError::new("quadratic_viscous", *value, "a finite number").into());
        }
        Ok(Self {
            law: set.law()?,
            quadratic,
        })
    }

    /// Force at a constant velocity, m/s (rad/s).
    pub fn steady(&self, velocity: f64) -> f64 {
        let force = match &self.law {
            FrictionLaw::CoulombViscous(law) => law.force(velocity),
            law => law.curve().map_or(0.0, |curve| curve.force(velocity)),
        };
        force + self.beside(velocity)
    }

    /// The quadratic viscous friction at a velocity, m/s (rad/s).
    fn beside(&self, velocity: f64) -> f64 {
        self.quadratic[usize::from(velocity < 0.0)] * velocity * velocity.abs()
    }
}

impl From<FrictionLaw> for Law {
    fn from(law: FrictionLaw) -> Self {
        Self {
            law,
            quadratic: [0.0; 2],
        }
    }
}

/// A law with its state, one call a sample: the form for simulation and control, whose sigma1 is capped
/// ([`FrictionLaw::capped`]).
#[derive(Clone, Debug)]
pub struct SteppedLaw {
    law: Law,
    memory: Memory,
    force: f64,
}

#[derive(Clone, Copy, Debug)]
enum Memory {
    None,
    Bristle(State<f64>),
    Elements(GmsState<f64, MOST_ELEMENTS>),
}

impl SteppedLaw {
    /// At rest, with nothing deflected.
    pub fn new(law: impl Into<Law>) -> Self {
        let Law { law, quadratic } = law.into();
        let law = law.capped();
        let (memory, force) = match &law {
            FrictionLaw::CoulombViscous(law) => (Memory::None, law.force(0.0)),
            FrictionLaw::Stribeck(curve) => (Memory::None, curve.force(0.0)),
            FrictionLaw::LuGre(law) => (Memory::Bristle(law.rest()), law.rest().force),
            FrictionLaw::ElastoPlastic(law) => (Memory::Bristle(law.rest()), law.rest().force),
            FrictionLaw::MaxwellSlip(law) => (Memory::Elements(law.rest()), law.rest().force),
        };
        let law = Law { law, quadratic };
        Self { law, memory, force }
    }

    /// Advances by `h` seconds at the velocity `v` (m/s, rad/s): the friction force in the unit of the law, positive against
    /// positive velocities. A sample that is not finite leaves the law as it is and returns the force before.
    pub fn step(&mut self, h: f64, v: f64) -> f64 {
        let force = match (&self.law.law, &mut self.memory) {
            (FrictionLaw::LuGre(law), Memory::Bristle(state)) => law.step(state, h, v),
            (FrictionLaw::ElastoPlastic(law), Memory::Bristle(state)) => law.step(state, h, v),
            (FrictionLaw::MaxwellSlip(law), Memory::Elements(state)) => law.step(state, h, v),
            (FrictionLaw::CoulombViscous(law), _) if v.is_finite() => law.force(v),
            (FrictionLaw::Stribeck(curve), _) if v.is_finite() => curve.force(v),
            _ => return self.force,
        };
        if v.is_finite() && h.is_finite() {
            self.force = force + self.law.beside(v);
        }
        self.force
    }

    /// The force of the last sample; of the law at rest where there was none.
    pub fn force(&self) -> f64 {
        self.force
    }

    /// The deflection of a bristle, m (rad), or the spring forces of elements; empty for a law without memory.
    pub fn state(&self) -> Vec<f64> {
        match (&self.law.law, &self.memory) {
            (FrictionLaw::MaxwellSlip(law), Memory::Elements(state)) => {
                state.elements.force[..law.elements().len()].to_vec()
            }
            (_, Memory::Bristle(state)) => vec![state.z],
            _ => Vec::new(),
        }
    }

    /// All that it remembers, for [`recall`](Self::recall): the last force, then its deflection, or of elements the direction
    /// and for each its spring force and whether it slips.
    pub fn memory(&self) -> Vec<f64> {
        let flag = |is: bool| f64::from(u8::from(is));
        let mut out = vec![self.force];
        match &self.memory {
            Memory::None => {}
            Memory::Bristle(state) => out.extend([state.force, state.z]),
            Memory::Elements(state) => {
                let at = &state.elements;
                out.extend([state.force, flag(at.forward)]);
                out.extend(at.force);
                out.extend(at.slips.map(flag));
            }
        }
        out
    }

    /// Takes up what [`memory`](Self::memory) gave, of the same law; whether it was that of such a law.
    pub fn recall(&mut self, memory: &[f64]) -> bool {
        match (&mut self.memory, memory) {
            (Memory::None, [force]) => self.force = *force,
            (Memory::Bristle(state), [force, last, z]) => {
                *state = State {
                    z: *z,
                    force: *last,
                };
                self.force = *force;
            }
            (Memory::Elements(state), [force, last, forward, each @ ..])
                if each.len() == 2 * MOST_ELEMENTS =>
            {
                let (forces, slips) = each.split_at(MOST_ELEMENTS);
                state.force = *last;
                state.elements.forward = *forward != 0.0;
                state.elements.force.copy_from_slice(forces);
                for (own, slip) in state.elements.slips.iter_mut().zip(slips) {
                    *own = *slip != 0.0;
                }
                self.force = *force;
            }
            _ => return false,
        }
        true
    }

    /// Back to rest.
    pub fn reset(&mut self) {
        *self = Self::new(self.law.clone());
    }
}

/// The friction force of a law along a record that begins undeflected, as an identification takes it: time in s, velocity in
/// m/s (rad/s), which runs linearly between samples.
///
/// # Errors
/// Where the two differ in length, time does not increase, or a number is not finite.
pub fn forces_along(law: &Law, time: &[f64], velocity: &[f64]) -> Result<Vec<f64>, Error> {
    check(time, velocity)?;
    let mut forces = match &law.law {
        FrictionLaw::CoulombViscous(law) => velocity.iter().map(|&v| law.force(v)).collect(),
        FrictionLaw::Stribeck(curve) => velocity.iter().map(|&v| curve.force(v)).collect(),
        FrictionLaw::LuGre(law) => along(
            (time, velocity),
            0.0,
            |z, h, va, vb| law.step_record(z, h, va, vb),
            |z, v| law.force(*z, v),
        ),
        FrictionLaw::ElastoPlastic(law) => along(
            (time, velocity),
            0.0,
            |z, h, va, vb| law.step_record(z, h, va, vb),
            |z, v| law.force(*z, v),
        ),
        FrictionLaw::MaxwellSlip(law) => of_elements(law, (time, velocity)),
    };
    for (force, &v) in forces.iter_mut().zip(velocity) {
        *force += law.beside(v);
    }
    Ok(forces)
}

/// With as many elements as the law has.
fn of_elements(law: &MaxwellSlip<f64>, record: (&[f64], &[f64])) -> Vec<f64> {
    macro_rules! first_of {
        ($($n:literal)*) => {
            $(if let Some(law) = law.gms::<$n>() {
                return along_elements(&law, record);
            })*
        };
    }
    first_of!(1 2 3 4 5 6 7 8 9 10);
    Vec::new()
}

fn along_elements<const N: usize>(law: &Gms<f64, N>, record: (&[f64], &[f64])) -> Vec<f64> {
    along(
        record,
        Elements::default(),
        |at, h, va, vb| law.step_record(at, h, va, vb),
        |at, v| law.force(at, v),
    )
}

fn along<S: Copy>(
    (time, velocity): (&[f64], &[f64]),
    start: S,
    step: impl Fn(S, f64, f64, f64) -> S,
    force: impl Fn(&S, f64) -> f64,
) -> Vec<f64> {
    let mut at = start;
    let mut out = Vec::with_capacity(time.len());
    for (k, &v) in velocity.iter().enumerate() {
        if k > 0 {
            at = step(at, time[k] - time[k - 1], velocity[k - 1], v);
        }
        out.push(force(&at, v));
    }
    out
}

fn check(time: &[f64], velocity: &[f64]) -> Result<(), Error> {
    let refused = |found: String, allowed: &'static str| Error::Usage {
        found: found.into(),
        allowed: allowed.into(),
    };
    if time.len() != velocity.len() {
        let found = format!(
            "velocity has {} samples, time {}",
            velocity.len(),
            time.len()
        );
        return Err(refused(found, "as many of both"));
    }
    for (name, values) in [("time", time), ("velocity", velocity)] {
        if let Some(k) = values.iter().position(|x| !x.is_finite()) {
            let found = format!("{name}[{k}] is {}", values[k]);
            return Err(refused(found, "finite numbers"));
        }
    }
    match time.windows(2).position(|pair| pair[1] <= pair[0]) {
        Some(k) => Err(refused(
            format!("time[{}] is not after time[{k}]", k + 1),
            "time that increases, s",
        )),
        None => Ok(()),
    }
}
