//! The rigid body of a robot, and motions with the torques that it takes.

use super::Robot;
use crate::Error;
use stiction_rigid::{Document, Workspace};

/// Motions in a self-test.
const STATES: usize = 16;
/// Golden ratio: its multiples fill an interval evenly.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The rigid body of a URDF with gravity.
pub(super) struct Body {
    pub(super) robot: stiction_rigid::Robot,
}

/// A motion of the independent joints with its torques.
pub(super) struct State {
    /// Positions, speeds and accelerations.
    pub(super) motion: [Vec<f64>; 3],
    /// Torques without those of rotors and friction.
    pub(super) torque: Vec<f64>,
}

impl Body {
    /// Without the load.
    pub(super) fn of(robot: &Robot) -> Result<Self, Error> {
        let mut rigid = stiction_rigid::Robot::new(&Document::parse(&robot.urdf)?)?;
        rigid.set_gravity(robot.gravity);
        Ok(Self { robot: rigid })
    }

    /// With the load.
    pub(super) fn loaded(robot: &Robot) -> Result<Self, Error> {
        let mut body = Self::of(robot)?;
        if let Some(load) = &robot.load {
            body.robot
                .attach(&load.link, load.mass, load.center, [0.0; 6])?;
        }
        Ok(body)
    }

    /// Motions of all independent joints, the same each time.
    pub(super) fn states(&self) -> Vec<State> {
        let robot = &self.robot;
        let independent = robot.independent().len();
        let (all, parameters) = (robot.len(), robot.parameters());
        let mut workspace = Workspace::new(robot);
        let mut number = 0.0;
        let mut spread = |most: f64| {
            number += GOLDEN;
            most * (2.0 * (number - libm::floor(number)) - 1.0)
        };
        let mut state = || {
            let motion = [3.0, 2.0, 5.0]
                .map(|most| -> Vec<f64> { (0..independent).map(|_| spread(most)).collect() });
            let [mut q, mut dq, mut ddq, mut every] = [(); 4].map(|()| vec![0.0; all]);
            robot.expand(&motion[0], &mut q);
            robot.expand_rates(&motion[1], &mut dq);
            robot.expand_rates(&motion[2], &mut ddq);
            robot.torque([&q, &dq, &ddq], &parameters, &mut workspace, &mut every);
            let mut torque = vec![0.0; independent];
            robot.reduce(&every, &mut torque);
            State { motion, torque }
        };
        (0..STATES).map(|_| state()).collect()
    }
}
