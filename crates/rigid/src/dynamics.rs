//! Torques of a motion, their derivatives, the mass matrix and accelerations.
//!
//! Recursive Newton-Euler in the frames of the bodies, each about the origin of its frame (Featherstone 2008, *Rigid Body
//! Dynamics Algorithms*, chapter 5, in three-dimensional vectors as in Luh, Walker and Paul 1980).

use crate::linear::solve;
use crate::regressor::Screws;
use crate::robot::Robot;
use crate::scalar::{Dual, Scalar};
use crate::space::{Matrix, Vector, add, apply, apply_transposed, cross, dot, scale};

/// What a body does.
#[derive(Clone, Copy)]
pub(crate) struct Moved<T> {
    /// Its frame in that of its parent.
    pub rotation: Matrix<T>,
    pub translation: Vector<T>,
    /// Angular velocity and acceleration, and acceleration of the origin without gravity, in its own frame.
    pub velocity: Vector<T>,
    pub spin: Vector<T>,
    pub acceleration: Vector<T>,
}

impl<T: Scalar> Moved<T> {
    fn still() -> Self {
        let zero = T::from(0.0);
        Self {
            rotation: [[zero; 3]; 3],
            translation: [zero; 3],
            velocity: [zero; 3],
            spin: [zero; 3],
            acceleration: [zero; 3],
        }
    }
}

/// Bodies' motions and the forces on them.
#[derive(Clone)]
struct Pass<T> {
    moved: Vec<Moved<T>>,
    force: Vec<Vector<T>>,
    moment: Vec<Vector<T>>,
}

impl<T: Scalar> Pass<T> {
    fn new(bodies: usize) -> Self {
        let zero = [T::from(0.0); 3];
        Self {
            moved: vec![Moved::still(); bodies],
            force: vec![zero; bodies],
            moment: vec![zero; bodies],
        }
    }
}

/// Memory of the computations on one robot; made once, so that none of them allocates.
#[derive(Clone)]
pub struct Workspace {
    plain: Pass<f64>,
    dual: Pass<Dual>,
    /// Arguments and torques of the derivatives.
    states: [Vec<Dual>; 4],
    screws: Screws,
    /// Unit accelerations, a column of the mass matrix, the matrix.
    unit: Vec<f64>,
    column: Vec<f64>,
    matrix: Vec<f64>,
}

impl Workspace {
    /// Memory for a robot.
    pub fn new(robot: &Robot) -> Self {
        let n = robot.len();
        Self {
            plain: Pass::new(n),
            dual: Pass::new(n),
            states: std::array::from_fn(|_| vec![Dual::default(); n]),

            screws: Screws::new(robot),
            unit: vec![0.0; n],
            column: vec![0.0; n],
            matrix: vec![0.0; n * n],
        }
    }

    /// What the regressor needs.
    pub(crate) fn motions(&mut self, robot: &Robot) -> (&mut [Moved<f64>], &mut Screws) {
        self.check(robot);
        (&mut self.plain.moved, &mut self.screws)
    }

    fn check(&self, robot: &Robot) {
        assert_eq!(self.unit.len(), robot.len(), "a workspace of this robot");
    }
}

/// Motions of the bodies, from the base outwards.
pub(crate) fn outward<T: Scalar>(
    robot: &Robot,
    gravity: [f64; 3],
    [q, dq, ddq]: [&[T]; 3],
    moved: &mut [Moved<T>],
) {
    let zero = [T::from(0.0); 3];
    // A base that accelerates upwards stands for gravity.
    let base = gravity.map(|g| T::from(-g));
    for (i, (joint, turn)) in robot.joints.iter().zip(&robot.turns).enumerate() {
        let axis = joint.axis.map(T::from);
        let mut translation = joint.frame.translation.map(T::from);
        let rotation = if turn.revolute {
            let (sin, cos) = q[i].sin_cos();
            let element = |r: usize, c: usize| {
                let part = sin * T::from(turn.sine[r][c]) + cos * T::from(turn.cosine[r][c]);
                T::from(turn.still[r][c]) + part
            };
            let row = |r| [element(r, 0), element(r, 1), element(r, 2)];
            [row(0), row(1), row(2)]
        } else {
            let rotation = joint.frame.rotation.map(|row| row.map(T::from));
            translation = add(translation, apply(&rotation, scale(axis, q[i])));
            rotation
        };
        let (w, dw, a) = match joint.parent {
            None => (zero, zero, base),
            Some(p) => (moved[p].velocity, moved[p].spin, moved[p].acceleration),
        };
        let swung = add(cross(dw, translation), cross(w, cross(w, translation)));
        let mut velocity = apply_transposed(&rotation, w);
        let mut spin = apply_transposed(&rotation, dw);
        let mut acceleration = apply_transposed(&rotation, add(a, swung));
        let along = scale(axis, dq[i]);
        if turn.revolute {
            spin = add(spin, add(scale(axis, ddq[i]), cross(velocity, along)));
            velocity = add(velocity, along);
        } else {
            let coriolis = scale(cross(velocity, along), T::from(2.0));
            acceleration = add(acceleration, add(scale(axis, ddq[i]), coriolis));
        }
        moved[i] = Moved {
            rotation,
            translation,
            velocity,
            spin,
            acceleration,
        };
    }
}

/// Torques from the motions, from the tips inwards.
fn inward<T: Scalar>(robot: &Robot, parameters: &[f64], pass: &mut Pass<T>, torque: &mut [T]) {
    let (ten, _) = parameters.as_chunks::<10>();
    for (i, p) in ten.iter().enumerate() {
        let m = &pass.moved[i];
        let (w, dw, a) = (m.velocity, m.spin, m.acceleration);
        let p = p.map(T::from);
        let h = [p[1], p[2], p[3]];
        let inertia = [[p[4], p[5], p[7]], [p[5], p[6], p[8]], [p[7], p[8], p[9]]];
        let swung = add(cross(dw, h), cross(w, cross(w, h)));
        pass.force[i] = add(scale(a, p[0]), swung);
        let gyroscopic = cross(w, apply(&inertia, w));
        pass.moment[i] = add(add(apply(&inertia, dw), gyroscopic), cross(h, a));
    }
    for (i, joint) in robot.joints.iter().enumerate().rev() {
        let axis = joint.axis.map(T::from);
        let (force, moment) = (pass.force[i], pass.moment[i]);
        let along = if robot.turns[i].revolute {
            moment
        } else {
            force
        };
        torque[i] = dot(axis, along);
        if let Some(p) = joint.parent {
            let m = &pass.moved[i];
            let force = apply(&m.rotation, force);
            let moment = add(apply(&m.rotation, moment), cross(m.translation, force));
            pass.force[p] = add(pass.force[p], force);
            pass.moment[p] = add(pass.moment[p], moment);
        }
    }
}

impl Robot {
    fn check(&self, values: &[&[f64]], parameters: &[f64]) {
        let fits = values.iter().all(|v| v.len() == self.len());
        assert!(fits, "a value a joint");
        assert_eq!(parameters.len(), 10 * self.len(), "ten parameters a body");
    }

    /// Torques, N m (or N of prismatic joints), that a motion takes: positions q, speeds dq, accelerations ddq in rad or m
    /// and s, parameters as in [`parameters`](Self::parameters). Without friction and rotor inertia.
    ///
    /// # Panics
    /// If a length does not fit the robot.
    pub fn torque(
        &self,
        motion: [&[f64]; 3],
        parameters: &[f64],
        workspace: &mut Workspace,
        torque: &mut [f64],
    ) {
        self.check(&[motion[0], motion[1], motion[2], torque], parameters);
        workspace.check(self);
        outward(self, self.gravity, motion, &mut workspace.plain.moved);
        inward(self, parameters, &mut workspace.plain, torque);
    }

    /// Derivatives of the torques with respect to positions and to speeds: two matrices n x n by rows, exact to rounding.
    /// Those with respect to accelerations are the [`mass_matrix`](Self::mass_matrix).
    ///
    /// # Panics
    /// If a length does not fit the robot.
    pub fn torque_derivatives(
        &self,
        motion: [&[f64]; 3],
        parameters: &[f64],
        workspace: &mut Workspace,
        by_position: &mut [f64],
        by_speed: &mut [f64],
    ) {
        let n = self.len();
        self.check(&motion, parameters);
        workspace.check(self);
        assert!(
            by_position.len() == n * n && by_speed.len() == n * n,
            "matrices n x n"
        );
        let [q, dq, ddq, torque] = &mut workspace.states;
        for (dual, plain) in [&mut *q, &mut *dq, &mut *ddq].into_iter().zip(motion) {
            for (dual, x) in dual.iter_mut().zip(plain) {
                *dual = Dual::from(*x);
            }
        }
        for (which, out) in [by_position, by_speed].into_iter().enumerate() {
            for column in 0..n {
                let seeded = if which == 0 { &mut *q } else { &mut *dq };
                seeded[column].slope = 1.0;
                let pass = &mut workspace.dual;
                outward(self, self.gravity, [&*q, &*dq, &*ddq], &mut pass.moved);
                inward(self, parameters, pass, torque);
                for (row, torque) in torque.iter().enumerate() {
                    out[row * n + column] = torque.slope;
                }
                let seeded = if which == 0 { &mut *q } else { &mut *dq };
                seeded[column].slope = 0.0;
            }
        }
    }

    /// Mass matrix at positions q, kg m² (kg of prismatic joints), n x n, symmetric.
    ///
    /// # Panics
    /// If a length does not fit the robot.
    pub fn mass_matrix(
        &self,
        q: &[f64],
        parameters: &[f64],
        workspace: &mut Workspace,
        matrix: &mut [f64],
    ) {
        let n = self.len();
        self.check(&[q], parameters);
        workspace.check(self);
        assert_eq!(matrix.len(), n * n, "a matrix n x n");
        let Workspace {
            plain,
            unit,
            column,
            ..
        } = workspace;
        for j in 0..n {
            // Without speeds: the torque of a unit acceleration alone.
            column.fill(0.0);
            unit.fill(0.0);
            unit[j] = 1.0;
            outward(self, [0.0; 3], [q, &*column, &*unit], &mut plain.moved);
            inward(self, parameters, plain, column);
            for i in j..n {
                matrix[i * n + j] = column[i];
                matrix[j * n + i] = column[i];
            }
        }
    }

    /// Accelerations of positions q and speeds dq under torques on the joints, for simulations: solves the equations of
    /// motion by Cholesky. `armature` is a rotor inertia at each joint, kg m² or kg, or empty. False, and no accelerations,
    /// if the mass matrix is not positive definite.
    ///
    /// # Panics
    /// If a length does not fit the robot.
    pub fn acceleration(
        &self,
        [q, dq, torque]: [&[f64]; 3],
        parameters: &[f64],
        armature: &[f64],
        workspace: &mut Workspace,
        acceleration: &mut [f64],
    ) -> bool {
        let n = self.len();
        self.check(&[q, dq, torque, acceleration], parameters);
        assert!(
            armature.is_empty() || armature.len() == n,
            "a value a joint"
        );
        // Taken out, so that the rest of the workspace can be used; no allocation.
        let mut matrix = std::mem::take(&mut workspace.matrix);
        self.mass_matrix(q, parameters, workspace, &mut matrix);
        for (i, armature) in armature.iter().enumerate() {
            matrix[i * n + i] += armature;
        }
        let Workspace { plain, unit, .. } = workspace;
        unit.fill(0.0);
        outward(self, self.gravity, [q, dq, &*unit], &mut plain.moved);
        inward(self, parameters, plain, acceleration);
        for (a, torque) in acceleration.iter_mut().zip(torque) {
            *a = torque - *a;
        }
        let solved = solve(&mut matrix, acceleration);
        workspace.matrix = matrix;
        solved
    }
}
