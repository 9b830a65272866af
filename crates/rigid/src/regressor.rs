//! The regressor: torques as a linear function of the inertial parameters (Atkeson, An and Hollerbach 1986, *Estimation of
//! inertial parameters of manipulator loads and links*, doi:10.1177/027836498600500306).

use crate::dynamics::{Moved, Workspace, outward};
use crate::robot::Robot;
use crate::space::{Matrix, Vector, add, apply_transposed, cross, dot};

/// Axis of a joint in the frame of a body that it carries: angular velocity and speed of the body's origin that unit speed of
/// the joint gives.
#[derive(Clone, Copy)]
pub(crate) struct Screw {
    /// Number of the joint.
    joint: usize,
    turn: Vector<f64>,
    slide: Vector<f64>,
}

/// Screws of each body: one for each joint from the base to its own.
#[derive(Clone)]
pub(crate) struct Screws {
    screws: Vec<Screw>,
    /// Where those of each body begin; one more than bodies.
    begins: Vec<usize>,
}

impl Screws {
    pub fn new(robot: &Robot) -> Self {
        let mut begins = vec![0];
        let mut screws: Vec<Screw> = Vec::new();
        for (i, joint) in robot.joints.iter().enumerate() {
            if let Some(p) = joint.parent {
                screws.extend_from_within(begins[p]..begins[p + 1]);
            }
            let turn = if robot.turns[i].revolute {
                joint.axis
            } else {
                [0.0; 3]
            };
            let slide = if robot.turns[i].revolute {
                [0.0; 3]
            } else {
                joint.axis
            };
            let joint = i;
            screws.push(Screw { joint, turn, slide });
            begins.push(screws.len());
        }
        Self { screws, begins }
    }

    /// Moves the screws of the parent of body i, which stands before it, into its frame.
    fn update(&mut self, i: usize, parent: Option<usize>, moved: &Moved<f64>) -> &[Screw] {
        let begin = self.begins[i];
        let (before, own) = self.screws.split_at_mut(begin);
        let own = &mut own[..self.begins[i + 1] - begin];
        if let Some(p) = parent {
            for (own, outer) in own
                .iter_mut()
                .zip(&before[self.begins[p]..self.begins[p + 1]])
            {
                let slide = add(outer.slide, cross(outer.turn, moved.translation));
                own.turn = apply_transposed(&moved.rotation, outer.turn);
                own.slide = apply_transposed(&moved.rotation, slide);
            }
        }
        own
    }
}

/// Force and moment about the origin of a body's frame for each of its ten parameters.
struct Wrench {
    /// Force of the mass.
    mass: Vector<f64>,
    /// Force of the first moments, a column each; their moment is `h × mass`.
    first: Matrix<f64>,
    /// Moment of the inertia, a row each direction.
    second: [[f64; 6]; 3],
}

impl Wrench {
    #[inline]
    fn of(moved: &Moved<f64>) -> Self {
        let ([x, y, z], [dx, dy, dz]) = (moved.velocity, moved.spin);
        let (xx, yy, zz, xy, xz, yz) = (x * x, y * y, z * z, x * y, x * z, y * z);
        Self {
            mass: moved.acceleration,
            first: [
                [-yy - zz, xy - dz, xz + dy],
                [xy + dz, -xx - zz, yz - dx],
                [xz - dy, yz + dx, -xx - yy],
            ],
            second: [
                [dx, dy - xz, -yz, dz + xy, yy - zz, yz],
                [xz, dx + yz, dy, zz - xx, dz - xy, -xz],
                [-xy, xx - yy, xy, dx - yz, dy + xz, dz],
            ],
        }
    }

    /// Torque on a joint for each parameter.
    #[inline]
    fn on(&self, screw: &Screw) -> [f64; 10] {
        let (turn, slide) = (screw.turn, screw.slide);
        let first = add(apply_transposed(&self.first, slide), cross(self.mass, turn));
        let [a, b, c] = &self.second;
        let second = |k: usize| turn[0] * a[k] + turn[1] * b[k] + turn[2] * c[k];
        [
            dot(self.mass, slide),
            first[0],
            first[1],
            first[2],
            second(0),
            second(1),
            second(2),
            second(3),
            second(4),
            second(5),
        ]
    }
}

impl Robot {
    /// Matrix n x 10n by rows that gives, times the [`parameters`](Self::parameters), the [`torque`](Self::torque) of a
    /// motion. The row of a joint is 0 but for the columns of the bodies that it carries, 10 i to 10
    /// [`end`](crate::Body::end).
    ///
    /// # Panics
    /// If a length does not fit the robot.
    pub fn regressor(&self, motion: [&[f64]; 3], workspace: &mut Workspace, regressor: &mut [f64]) {
        let n = self.len();
        let fits = motion.iter().all(|x| x.len() == n);
        assert!(fits && regressor.len() == 10 * n * n, "n values, n x 10n");
        let (moved, screws) = workspace.motions(self);
        outward(self, self.gravity(), motion, moved);
        regressor.fill(0.0);
        let (blocks, _) = regressor.as_chunks_mut::<10>();
        for (i, (joint, moved)) in self.joints.iter().zip(&*moved).enumerate() {
            let wrench = Wrench::of(moved);
            for screw in screws.update(i, joint.parent, moved) {
                blocks[screw.joint * n + i] = wrench.on(screw);
            }
        }
    }
}
