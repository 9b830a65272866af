//! The rigid body of a robot, from the records of all its joints together.
//!
//! The torque of a joint is linear in the inertial parameters of the bodies it carries, ten each, in the inertia of its rotor
//! (armature) and in its friction: a level with the sign of the speed or a shape that is known, viscous friction, an offset.
//! All joints are fitted at once by weighted least squares (IDIM-WLS: Gautier 1997, doi 10.1109/ROBOT.1997.606767). Torque and columns
//! pass the same filter, that of the records. What the motion does not show stays where the URDF has it, by a [`Prior`].

mod channel;
mod columns;
mod prior;
mod solve;

pub use channel::torque_cutoff;
pub use prior::Prior;

use crate::conditioning::record::Record;
use crate::error::Error;
use crate::estimate::FrictionAlong;
use columns::Columns;
use nalgebra::{DMatrix, DVector};
use solve::Normal;
pub use solve::inverse as pseudo_inverse;
use stiction_rigid::{Robot, Workspace};
use stiction_signal::{Sos, effective_sample_size};

/// Rounds in which the weights of the joints follow from what the round before left.
const ROUNDS: usize = 3;
/// Part of the prior in the rounds that the weights follow from. Source: choice, next to nothing beside a log, and enough for what no
/// motion shows.
const WEIGHING_PRIOR: f64 = 1e-6;
/// Part of a record over which its residual is taken to be correlated at most.
const LONGEST_CORRELATION: usize = 4;

/// One joint of the robot that was logged.
#[derive(Clone, Copy, Debug)]
pub struct RobotJoint<'a> {
    /// Its number in the robot, of one that follows no other.
    pub joint: usize,
    /// Its log, conditioned. The records of all joints have the same samples.
    pub record: &'a Record,
    /// Its friction by an identified law along the record, whose parameters are fitted again, linearised; `None` takes Coulomb and
    /// viscous friction.
    pub friction: Option<&'a FrictionAlong>,
    /// Whether its force is fitted; of one that is not, the motion counts.
    pub counts: bool,
}

/// A robot and where the joints stand that were not logged, rad or m, a value for each of its joints.
#[derive(Clone, Copy, Debug)]
pub struct Machine<'a> {
    /// The robot.
    pub robot: &'a Robot,
    /// Positions of all joints; those of logged ones do not count.
    pub at: &'a [f64],
    /// A low-pass that all forces passed before they were logged.
    pub channel: Option<&'a Sos>,
}

/// Inertial parameters and armatures with their covariance.
#[derive(Clone, Debug)]
pub struct RigidFit {
    /// Ten parameters of each body, in the order of [`stiction_rigid::inertia`].
    pub parameters: Vec<f64>,
    /// Inertia of the rotor of each joint at the joint, kg m^2 or kg; 0 of one that was not logged.
    pub armature: Vec<f64>,
    /// Covariance of the parameters, then of the armatures.
    pub covariance: DMatrix<f64>,
    /// Root mean square of what is left of the force of each logged joint, N or N m.
    pub residual: Vec<f64>,
}

/// The force of a rigid body on a joint along a segment, at the full rate.
#[derive(Clone, Debug)]
pub struct RigidForce {
    /// Without the armature, N or N m.
    pub force: Vec<f64>,
    /// By how much it may be wrong: of each of the largest independent directions of the covariance one standard deviation.
    pub deviations: Vec<Vec<f64>>,
}

/// Fits the rigid body of a robot to all joints that were logged.
///
/// # Errors
/// Where the joints together have fewer samples than unknowns.
pub fn rigid_fit(
    machine: Machine,
    joints: &[RobotJoint],
    prior: &Prior,
) -> Result<RigidFit, Error> {
    let columns = Columns::of(machine, joints);
    let samples: usize = columns.iter().map(|own| own.force.len()).sum();
    let bodies = machine.robot.len();
    let unknowns = 11 * bodies + columns.iter().map(|own| own.friction).sum::<usize>();
    if samples < unknowns {
        return Err(Error::TooFewSamples {
            found: samples,
            needed: unknowns,
            losses: joints
                .first()
                .map(|own| own.record.losses())
                .unwrap_or_default(),
        });
    }
    let mut variance: Vec<f64> = columns
        .iter()
        .map(|own| mean_square(&own.force).max(f64::MIN_POSITIVE))
        .collect();
    let mut round = 0;
    loop {
        // A fit that the prior holds leaves smooth residuals, by which the log counts less and the prior more.
        let part = if round + 1 < ROUNDS {
            WEIGHING_PRIOR
        } else {
            1.0
        };
        let mut normal = Normal::new(unknowns, prior, part);
        for (own, variance) in columns.iter().zip(&variance) {
            normal.add(&own.matrix, &own.places, &own.force, *variance);
        }
        let solution = normal.solve(10 * bodies..11 * bodies);
        let left: Vec<DVector<f64>> = columns.iter().map(|own| own.left(&solution)).collect();
        round += 1;
        if round == ROUNDS {
            let rigid = 11 * bodies;
            let covariance = normal.covariance();
            return Ok(RigidFit {
                parameters: solution.rows(0, 10 * bodies).iter().copied().collect(),
                armature: solution.rows(10 * bodies, bodies).iter().copied().collect(),
                covariance: covariance.view((0, 0), (rigid, rigid)).into_owned(),
                residual: left.iter().map(|r| mean_square(r).sqrt()).collect(),
            });
        }
        for (variance, left) in variance.iter_mut().zip(&left) {
            // Correlated residuals say less than as many independent ones.
            let lags = left.len() / LONGEST_CORRELATION;
            let size = effective_sample_size(left.as_slice(), lags);
            let counts = size.map_or(1.0, |size| left.len() as f64 / size.size);
            *variance = (mean_square(left) * counts).max(f64::MIN_POSITIVE);
        }
    }
}

fn mean_square(x: &DVector<f64>) -> f64 {
    x.norm_squared() / x.len().max(1) as f64
}

impl RigidFit {
    /// The force of the rigid body on a joint along its record, segment by segment.
    pub fn force_on(
        &self,
        machine: Machine,
        joints: &[RobotJoint],
        joint: usize,
    ) -> Vec<RigidForce> {
        let directions = self.directions(machine, joints, joint);
        let robot = machine.robot;
        let mut workspace = Workspace::new(robot);
        let mut torque = vec![0.0; robot.len()];
        let mut out = Vec::new();
        for segment in 0..joints.first().map_or(0, |own| own.record.segments.len()) {
            let mut force = Vec::new();
            let mut deviations = vec![Vec::new(); directions.len()];
            columns::along(machine, joints, segment, |motion| {
                let mut of = |parameters: &[f64]| {
                    robot.torque(motion, parameters, &mut workspace, &mut torque);
                    columns::reduced(robot, joint, &torque)
                };
                force.push(of(&self.parameters));
                for (out, direction) in deviations.iter_mut().zip(&directions) {
                    out.push(of(direction));
                }
            });
            let mut columns: Vec<&mut [f64]> = std::iter::once(&mut force)
                .chain(&mut deviations)
                .map(Vec::as_mut_slice)
                .collect();
            columns::pass(machine, &mut columns);
            out.push(RigidForce { force, deviations });
        }
        out
    }

    /// The force of the rigid body on each joint at the samples of its record that count, N or N m.
    pub fn at_samples(&self, machine: Machine, joints: &[RobotJoint]) -> Vec<Vec<f64>> {
        let on = |own: usize| {
            let columns = Columns::one(machine, joints, own);
            let places = &columns.places[..columns.rigid];
            let parameters = places.iter().map(|place| self.parameters[*place]);
            let parameters = DVector::from_iterator(columns.rigid, parameters);
            let force = columns.matrix.columns(0, columns.rigid) * parameters;
            force.iter().copied().collect()
        };
        (0..joints.len()).map(on).collect()
    }

    /// By how much the force on each joint may be wrong by the covariance, its armature with it: root mean square over the samples of its
    /// record that count, N or N m. What inertia of a body and armature share does not count.
    pub fn deviations(&self, machine: Machine, joints: &[RobotJoint]) -> Vec<f64> {
        let on = |own: usize| {
            let columns = Columns::one(machine, joints, own);
            let count = columns.rigid + 1;
            let force = columns.forces(&self.root(&columns.places[..count]));
            (force.norm_squared() / force.nrows().max(1) as f64).sqrt()
        };
        (0..joints.len()).map(on).collect()
    }

    /// Root of the covariance of some unknowns.
    fn root(&self, places: &[usize]) -> DMatrix<f64> {
        let n = places.len();
        let of = |i: usize, j: usize| self.covariance[(places[i], places[j])];
        solve::root(DMatrix::from_fn(n, n, of))
    }

    /// Directions of the parameters, one standard deviation each, that together give nearly all of the variance of the force on a
    /// joint along its record.
    fn directions(&self, machine: Machine, joints: &[RobotJoint], joint: usize) -> Vec<Vec<f64>> {
        /// Part of the variance that is left out.
        const LEFT_OUT: f64 = 1e-2;
        let bodies = 10 * machine.robot.len();
        let Some(own) = joints.iter().position(|own| own.joint == joint) else {
            return Vec::new();
        };
        let columns = Columns::one(machine, joints, own);
        let count = columns.rigid;
        // The covariance of the parameters that act on this joint, and their force at all samples.
        let places = &columns.places[..count];
        let root = self.root(places);
        let force = columns.forces(&root);
        let gram = force.tr_mul(&force);
        let total = gram.trace();
        let eigen = gram.symmetric_eigen();
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
        let mut rest = total;
        let mut out = Vec::new();
        for i in order {
            if rest <= LEFT_OUT * total {
                break;
            }
            rest -= eigen.eigenvalues[i];
            let own = &root * eigen.eigenvectors.column(i);
            let mut direction = vec![0.0; bodies];
            for (place, value) in places.iter().zip(own.iter()) {
                direction[*place] = *value;
            }
            out.push(direction);
        }
        out
    }
}
