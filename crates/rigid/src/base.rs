//! Base parameters: the combinations of inertial parameters that torques depend on (Gautier 1991, *Numerical calculation of
//! the base inertial parameters of robots*, doi:10.1002/rob.4620080405).

mod pivoted;

use crate::inertia;
use crate::random::Random;
use crate::robot::Robot;
use crate::urdf::Kind;
use crate::{Error, Workspace};
use pivoted::Columns;

/// Random states of the test; each gives an equation a moving joint, which has at most eleven unknowns of its own.
const STATES: usize = 40;
/// Largest positions of revolute (rad) and prismatic joints (m), speeds and accelerations of the states.
const TURN: f64 = std::f64::consts::PI;
const SLIDE: f64 = 1.0;
const SPEED: f64 = 3.0;
const ACCELERATION: f64 = 10.0;
/// Coefficient of a regrouped parameter that is rounding.
const SMALLEST_COEFFICIENT: f64 = 1e-10;

/// Which motion and which parameters are considered.
#[derive(Clone, Debug, PartialEq)]
pub struct Scope {
    /// Whether each joint moves; a follower moves with the joint that it follows.
    pub moving: Vec<bool>,
    /// Positions of the joints that do not, rad or m.
    pub position: Vec<f64>,
    /// Whether each joint has a rotor inertia as another parameter, which is torque per acceleration of the joint.
    pub armature: bool,
}

impl Scope {
    /// All joints of a robot move.
    pub fn all(robot: &Robot, armature: bool) -> Self {
        Self {
            moving: vec![true; robot.len()],
            position: vec![0.0; robot.len()],
            armature,
        }
    }
}

/// A parameter of the whole robot. Its column in a regressor is [`index`](Self::index).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Parameter {
    /// Inertial parameter of a body.
    Inertial {
        /// Number of the body.
        body: usize,
        /// Number of the parameter, 0 to 9 as in [`inertia::NAMES`].
        number: usize,
    },
    /// Rotor inertia of a joint, seen on its side of the gear.
    Armature {
        /// Number of the joint.
        joint: usize,
    },
}

impl Parameter {
    /// The parameter of a column, of a robot with that many joints: ten a body, then a rotor inertia a joint.
    fn of(index: usize, joints: usize) -> Self {
        if index < 10 * joints {
            Self::Inertial {
                body: index / 10,
                number: index % 10,
            }
        } else {
            Self::Armature {
                joint: index - 10 * joints,
            }
        }
    }

    /// Column of the parameter, of a robot with that many joints: ten a body, then a rotor inertia a joint.
    pub fn index(self, joints: usize) -> usize {
        match self {
            Self::Inertial { body, number } => 10 * body + number,
            Self::Armature { joint } => 10 * joints + joint,
        }
    }

    /// Symbol: `m`, `mx` .. `Izz`, or `Ia` for a rotor inertia.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Inertial { number, .. } => inertia::NAMES.get(number).copied().unwrap_or("?"),
            Self::Armature { .. } => "Ia",
        }
    }

    /// Number of the body, or of the joint that moves it.
    pub fn body(self) -> usize {
        match self {
            Self::Inertial { body, .. } => body,
            Self::Armature { joint } => joint,
        }
    }
}

/// Base parameters of a robot: `beta = pi_independent + K pi_dependent`.
#[derive(Clone, Debug, PartialEq)]
pub struct Base {
    joints: usize,
    independent: Vec<Parameter>,
    dependent: Vec<Parameter>,
    without_effect: Vec<Parameter>,
    regrouping: Vec<f64>,
}

impl Base {
    /// Finds the base parameters from the rank of the regressor at random states, which are always the same, by QR with
    /// column pivoting.
    ///
    /// # Errors
    /// If the scope has other than one value a joint.
    pub fn of(robot: &Robot, scope: &Scope) -> Result<Self, Error> {
        let n = robot.len();
        for (what, found) in [
            ("moving", scope.moving.len()),
            ("position", scope.position.len()),
        ] {
            if found != n {
                let wanted = n;
                return Err(Error::Length {
                    what,
                    found,
                    wanted,
                });
            }
        }
        let split = stacked(robot, scope).split();
        let parameter = |index: &usize| Parameter::of(*index, n);
        Ok(Self {
            joints: n,
            independent: split.independent.iter().map(parameter).collect(),
            dependent: split.dependent.iter().map(parameter).collect(),
            without_effect: split.zero.iter().map(parameter).collect(),
            regrouping: split.coefficients,
        })
    }

    /// Number of base parameters.
    pub fn len(&self) -> usize {
        self.independent.len()
    }

    /// Whether there is no base parameter.
    pub fn is_empty(&self) -> bool {
        self.independent.is_empty()
    }

    /// The parameter that each base parameter is named after; their columns of the regressor are its independent ones.
    pub fn independent(&self) -> &[Parameter] {
        &self.independent
    }

    /// Parameters that are regrouped into base parameters.
    pub fn dependent(&self) -> &[Parameter] {
        &self.dependent
    }

    /// Parameters that no torque depends on.
    pub fn without_effect(&self) -> &[Parameter] {
        &self.without_effect
    }

    /// The matrix K by rows: a row for each base parameter, a column for each dependent parameter.
    pub fn regrouping(&self) -> &[f64] {
        &self.regrouping
    }

    /// What a base parameter is the sum of: the parameter that it is named after with 1, then the regrouped ones with their
    /// coefficients, without those that are zero to rounding.
    pub fn terms(&self, number: usize) -> Vec<(Parameter, f64)> {
        let Some(first) = self.independent.get(number) else {
            return Vec::new();
        };
        let row = self.regrouping.iter().skip(number * self.dependent.len());
        let regrouped = self.dependent.iter().copied().zip(row.copied());
        let kept = regrouped.filter(|(_, k)| k.abs() > SMALLEST_COEFFICIENT);
        [(*first, 1.0)].into_iter().chain(kept).collect()
    }

    /// Base parameters of inertial parameters, ten a body, and rotor inertias, one a joint or none at all.
    ///
    /// # Panics
    /// If there are fewer values than parameters.
    pub fn values(&self, parameters: &[f64], armature: &[f64]) -> Vec<f64> {
        let value = |parameter: &Parameter| match parameter {
            Parameter::Armature { joint } => armature.get(*joint).copied().unwrap_or(0.0),
            inertial => parameters[inertial.index(self.joints)],
        };
        let dependent: Vec<f64> = self.dependent.iter().map(value).collect();
        let rows = (0..self.len()).map(|i| &self.regrouping[i * dependent.len()..]);
        let regrouped = rows.map(|row| row.iter().zip(&dependent).map(|(k, p)| k * p).sum::<f64>());
        self.independent
            .iter()
            .map(value)
            .zip(regrouped)
            .map(|(a, b)| a + b)
            .collect()
    }
}

/// Regressors of all states, one below the other: rows of the moving joints that follow none.
fn stacked(robot: &Robot, scope: &Scope) -> Columns {
    let n = robot.len();
    let width = if scope.armature { 11 * n } else { 10 * n };
    let independent = robot.independent();
    let moving: Vec<usize> = independent
        .iter()
        .copied()
        .filter(|i| scope.moving[*i])
        .collect();
    let mut columns = Columns::new(STATES * moving.len(), width);
    let mut workspace = Workspace::new(robot);
    let mut regressor = vec![0.0; 10 * n * n];
    let mut random = Random::new(1);
    let [mut q, mut dq, mut ddq] = [(); 3].map(|()| vec![0.0; n]);
    for state in 0..STATES {
        let mut drawn = [[0.0; 3]; crate::MOST_JOINTS];
        for (&i, drawn) in independent.iter().zip(&mut drawn) {
            let range = if robot.joints()[i].kind == Kind::Prismatic {
                SLIDE
            } else {
                TURN
            };
            *drawn = [range, SPEED, ACCELERATION].map(|most| most * random.signed());
            if !scope.moving[i] {
                *drawn = [scope.position[i], 0.0, 0.0];
            }
        }
        let part =
            |k: usize| -> Vec<f64> { drawn.iter().take(independent.len()).map(|x| x[k]).collect() };
        robot.expand(&part(0), &mut q);
        robot.expand_rates(&part(1), &mut dq);
        robot.expand_rates(&part(2), &mut ddq);
        robot.regressor([&q, &dq, &ddq], &mut workspace, &mut regressor);
        for (at, &leader) in moving.iter().enumerate() {
            let row = state * moving.len() + at;
            for (i, joint) in robot.joints().iter().enumerate() {
                let ratio = match joint.mimic {
                    Some(mimic) if mimic.of == leader => mimic.multiplier,
                    None if i == leader => 1.0,
                    _ => continue,
                };
                for column in 10 * i..10 * robot.bodies()[i].end {
                    columns.add(row, column, ratio * regressor[10 * n * i + column]);
                }
                if scope.armature {
                    columns.add(row, 10 * n + i, ratio * ddq[i]);
                }
            }
        }
    }
    columns
}
