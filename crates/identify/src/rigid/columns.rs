//! Columns of the regression of one joint.

use super::{Machine, RobotJoint};
use crate::conditioning::record::Record;
use crate::conditioning::shift::Shift;
use nalgebra::{DMatrix, DVector};
use stiction_rigid::{Robot, Workspace};

/// The regression of one joint.
pub(super) struct Columns {
    /// A row for each sample that counts: inertial parameters, armature, friction.
    pub matrix: DMatrix<f64>,
    /// Which unknown of the robot each column is.
    pub places: Vec<usize>,
    /// How many columns are of inertial parameters.
    pub rigid: usize,
    /// How many are of friction.
    pub friction: usize,
    /// The force, without the friction that is known.
    pub force: DVector<f64>,
}

impl Columns {
    /// Those of all joints.
    pub fn of(machine: Machine, joints: &[RobotJoint]) -> Vec<Self> {
        let mut first = 11 * machine.robot.len();
        let counted = (0..joints.len()).filter(|own| joints[*own].counts);
        let one = |own| {
            let mut columns = Self::one(machine, joints, own);
            columns.places.extend(first..first + columns.friction);
            first += columns.friction;
            columns
        };
        counted.map(one).collect()
    }

    /// Those of the joint at an index of `joints`; its friction has no places yet.
    pub fn one(machine: Machine, joints: &[RobotJoint], own: usize) -> Self {
        let robot = machine.robot;
        let bodies = robot.len();
        let RobotJoint {
            joint,
            record,
            friction,
            ..
        } = joints[own];
        let carried: Vec<usize> = parameters_on(robot, joint);
        let mut workspace = Workspace::new(robot);
        let mut regressor = vec![0.0; 10 * bodies * bodies];
        let count = carried.len();
        let own = match friction {
            Some(_) => 1,
            None => 3,
        };
        let mut out: Vec<Vec<f64>> = vec![Vec::new(); count + 1 + own];
        for (at, segment) in record.segments.iter().enumerate() {
            let mut full = vec![Vec::with_capacity(segment.velocity.len()); count];
            along(machine, joints, at, |motion| {
                robot.regressor(motion, &mut workspace, &mut regressor);
                for (column, place) in full.iter_mut().zip(&carried) {
                    let of_row = |row: usize| regressor[row * 10 * bodies + place];
                    column.push(reduced_by(robot, joint, of_row));
                }
            });
            full.push(segment.acceleration.clone());
            full.push(vec![1.0; segment.velocity.len()]);
            if friction.is_none() {
                full.push(segment.velocity.clone());
                full.push(segment.velocity.iter().map(|v| sign(*v)).collect());
            }
            let mut columns: Vec<&mut [f64]> = full.iter_mut().map(Vec::as_mut_slice).collect();
            pass(machine, &mut columns);
            let full: Vec<&[f64]> = full.iter().map(Vec::as_slice).collect();
            let filtered = record.filtered(segment, &full, &[Shift::NONE], None);
            for (out, column) in out.iter_mut().zip(filtered) {
                out.extend(column.into_iter().flatten());
            }
        }
        let mut places = carried;
        places.push(10 * bodies + joint);
        let mut force = DVector::from_vec(record.gather(|s| &s.force));
        if let Some(friction) = friction {
            // It has passed the filters.
            force -= DVector::from_column_slice(&friction.force);
            out.extend(friction.slopes.iter().cloned());
        }
        let rows = force.len();
        Self {
            matrix: DMatrix::from_fn(rows, out.len(), |i, j| out[j][i]),
            places,
            rigid: count,
            friction: out.len() - count - 1,
            force,
        }
    }

    /// Forces of some values of the first unknowns, a column for each: a product with a transpose, as in `solve`.
    pub fn forces(&self, values: &DMatrix<f64>) -> DMatrix<f64> {
        let columns = self.matrix.columns(0, values.nrows());
        columns.transpose().tr_mul(values)
    }

    /// What a solution leaves of the force.
    pub fn left(&self, solution: &DVector<f64>) -> DVector<f64> {
        let own = DVector::from_iterator(
            self.places.len(),
            self.places.iter().map(|place| solution[*place]),
        );
        &self.force - &self.matrix * own
    }
}

/// Passes columns at the full rate through the low-pass that the forces passed. One that is too short for it stays as it is.
pub(super) fn pass(machine: Machine, columns: &mut [&mut [f64]]) {
    if let Some(channel) = machine.channel {
        let _ = channel.zero_phase_columns(columns);
    }
}

/// -1, 0 or 1.
fn sign(v: f64) -> f64 {
    match v {
        0.0 => 0.0,
        v => v.signum(),
    }
}

/// The inertial parameters that act on a joint: those of the bodies that it and its followers carry.
fn parameters_on(robot: &Robot, joint: usize) -> Vec<usize> {
    let is_moved = |body: usize| {
        let under = |joint: usize| (joint..robot.bodies()[joint].end).contains(&body);
        let mut followers = (0..robot.len()).filter(|i| follows(robot, *i, joint).is_some());
        under(joint) || followers.any(under)
    };
    (0..robot.len())
        .filter(|body| is_moved(*body))
        .flat_map(|body| 10 * body..10 * body + 10)
        .collect()
}

/// By how much a joint moves for a unit of the one that it follows.
fn follows(robot: &Robot, joint: usize, of: usize) -> Option<f64> {
    let mimic = robot.joints()[joint].mimic.filter(|mimic| mimic.of == of)?;
    Some(mimic.multiplier)
}

/// The force on a joint with those on the joints that follow it.
pub(super) fn reduced(robot: &Robot, joint: usize, force: &[f64]) -> f64 {
    reduced_by(robot, joint, |row| force[row])
}

fn reduced_by(robot: &Robot, joint: usize, of_row: impl Fn(usize) -> f64) -> f64 {
    let followers = (0..robot.len()).filter_map(|i| Some(follows(robot, i, joint)? * of_row(i)));
    of_row(joint) + followers.sum::<f64>()
}

/// Calls `each` with positions, speeds and accelerations of all joints at every full-rate sample of a segment.
pub(super) fn along(
    machine: Machine,
    joints: &[RobotJoint],
    segment: usize,
    mut each: impl FnMut([&[f64]; 3]),
) {
    let robot = machine.robot;
    let independent = robot.independent();
    let logged: Vec<Option<&Record>> = independent
        .iter()
        .map(|joint| {
            let own = joints.iter().find(|own| own.joint == *joint);
            own.map(|own| own.record)
        })
        .collect();
    let samples = joints
        .iter()
        .filter_map(|own| Some(own.record.segments.get(segment)?.velocity.len()))
        .min()
        .unwrap_or(0);
    let mut own = vec![0.0; independent.len()];
    let mut all = [0; 3].map(|_: i32| vec![0.0; robot.len()]);
    for k in 0..samples {
        for (which, out) in all.iter_mut().enumerate() {
            for ((x, record), joint) in own.iter_mut().zip(&logged).zip(&independent) {
                *x = match record.map(|record| &record.segments[segment]) {
                    Some(s) => [&s.position, &s.velocity, &s.acceleration][which][k],
                    None if which == 0 => machine.at[*joint],
                    None => 0.0,
                };
            }
            match which {
                0 => robot.expand(&own, out),
                _ => robot.expand_rates(&own, out),
            }
        }
        each([&all[0], &all[1], &all[2]]);
    }
}
