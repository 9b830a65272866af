//! The six parameters of LuGre, force in and position out.

use super::problem::{Candidates, Named, checked, named, physical};
use crate::error::Error;
use stiction_lanes::{Axis, Candidate, Drive, InstructionSet, Measured, Motion, Stepping, plants};
use stiction_search::{Bounds, Fidelity, Points, Problem};

/// Mean square of measured minus simulated position over that of the measured position, for a mass
/// that is known and starts at rest with its bristle unloaded. Costs only. The genome is that of
/// [`SixParameters`](super::SixParameters).
///
/// In open loop an error of the parameters adds up to a drift of the position: keep runs short.
pub struct Simulated {
    bounds: Bounds,
    mass: f64,
    step: f64,
    force: Vec<f64>,
    position: Vec<f64>,
    energy: f64,
}

impl Simulated {
    /// A mass (kg, kg m^2) under a force (N, N m) held in each step (s), and its position (m, rad) at
    /// the end of each.
    ///
    /// # Errors
    /// For lengths that differ, a mass or step that is not positive, and numbers that are not finite.
    pub fn new(
        mass: f64,
        step: f64,
        force: Vec<f64>,
        position: Vec<f64>,
        bounds: Bounds,
    ) -> Result<Self, Error> {
        let energy: f64 = position.iter().map(|x| x * x).sum();
        let out = Self {
            bounds: checked(bounds, 6)?,
            mass,
            step,
            force,
            position,
            energy,
        };
        if !(energy > 0.0 && energy.is_finite()) {
            return Err(Error::NoMotion {
                bound: energy,
                unit: "",
            });
        }
        let probe = out.run(&[out.bounds.low().to_vec()]);
        match probe {
            Some(_) => Ok(out),
            None => Err(Error::Setting {
                name: "mass, step or force of the simulation",
                found: out.mass,
                allowed: "a positive mass and step, and as many finite forces as positions",
            }),
        }
    }

    fn run(&self, points: &[Vec<f64>]) -> Option<Vec<f64>> {
        let drive = Drive {
            step: self.step,
            force: &self.force,
            start: Motion::default(),
            measured: Measured::Position(&self.position),
        };
        let axes: Vec<Axis> = points
            .iter()
            .map(|x| Axis {
                mass: self.mass,
                friction: Candidate::gaussian(physical(x)),
            })
            .collect();
        let found = plants(&drive, &axes, Stepping::Midpoint, InstructionSet::best()).ok()?;
        Some(found.iter().map(|o| o.cost / self.energy).collect())
    }
}

impl Problem for Simulated {
    fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    fn costs(&self, points: &Points, _: Fidelity, out: &mut [f64]) {
        let points: Vec<Vec<f64>> = points.rows().map(<[f64]>::to_vec).collect();
        for (out, cost) in out.iter_mut().zip(self.run(&points).unwrap_or_default()) {
            *out = cost;
        }
    }
}

impl Candidates for Simulated {
    fn parameters(&self, point: &[f64]) -> Named {
        named(physical(point))
    }
}
