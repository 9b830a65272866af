//! A known axis as a whole: drive, encoder and controller of a common servo around its plant.

use super::KnownAxis;
use crate::axis::AxisSettings;
use crate::cascade::Cascade;
use crate::controller::Controller;
use crate::drive::Drive;
use crate::encoder::Encoder;
use crate::feedforward::Feedforward;
use crate::plant::Plant;
use stiction_friction::{Damping, Direction, LuGre, ParamError, Stribeck};

impl KnownAxis {
    /// The axis under a cascade at `rate` (Hz) with a speed loop of `bandwidth` (Hz): one sample of delay, a current loop
    /// of 1 kHz, encoder steps of 50 nm (nrad), mass and velocity fed forward, sigma1 capped, no compensation. The plant is
    /// stepped at 10 kHz or faster.
    pub fn simulated(&self, rate: f64, bandwidth: f64) -> Result<AxisSettings, ParamError> {
        ParamError::positive("rate", rate)?;
        let limit = 1000.0;
        Ok(AxisSettings {
            plant: Plant::new(self.mass, self.capped_law())?,
            drive: Drive::linear_motor(1.0 / rate),
            encoder: Encoder::new(50e-9)?,
            position_noise: 0.0,
            cogging: None,
            disturbance: None,
            controller: Controller::Cascade(Cascade::tuned(self.mass, bandwidth, limit)?),
            feedforward: Feedforward::default(),
            rate,
            substeps: libm::ceil(1e4 / rate) as u32,
            seed: 1,
        })
    }
}

/// The 64 laws in which each of sigma0, sigma1, sigma2, Fc, Fs, vs is too small or too large by the fraction `by`, 0 to below
/// 1, in both directions of motion alike: wrong laws to give a compensator instead of `law`. Everything else is that of
/// `law`. Fs is kept at Fc or above.
pub fn corners(law: &LuGre<f64>, by: f64) -> impl Iterator<Item = LuGre<f64>> {
    let law = *law;
    (0..64).filter_map(move |corner| {
        let off = |i: u32| {
            if corner >> i & 1 == 1 {
                1.0 + by
            } else {
                1.0 - by
            }
        };
        let side = |exact: &Direction<f64>| {
            let coulomb = off(3) * exact.coulomb;
            Direction {
                coulomb,
                static_friction: coulomb.max(off(4) * exact.static_friction),
                stribeck_velocity: off(5) * exact.stribeck_velocity,
                viscous: off(2) * exact.viscous,
            }
        };
        let damping = match law.damping() {
            Damping::Constant(sigma1) => Damping::Constant(off(1) * sigma1),
            Damping::Capped(sigma1) => Damping::Capped(off(1) * sigma1),
            Damping::Olsson { sigma1, velocity } => Damping::Olsson {
                sigma1: off(1) * sigma1,
                velocity,
            },
        };
        let curve = law.curve();
        let sides = [curve.positive(), curve.negative()].map(side);
        let curve = Stribeck::new(curve.shape(), sides[0], sides[1], curve.offset()).ok()?;
        LuGre::new(off(0) * law.stiffness(), damping, curve).ok()
    })
}
