//! Three robots of our own beside what Pinocchio computes for them (`tests/pinocchio/make_reference.py`).

use crate::common::{ARM6, ARM7, TREE, apart, robot};
use stiction_rigid::Workspace;

/// Part of the largest number; Pinocchio rounds too.
const ROUNDING: f64 = 1e-12;

/// What Pinocchio computes, in the order of our joints.
struct Reference<'t> {
    lines: std::str::Lines<'t>,
    /// Where each of our joints is in Pinocchio.
    order: Vec<usize>,
}

impl Reference<'_> {
    fn line(&mut self, name: &str) -> Option<Vec<f64>> {
        let line = self.lines.next()?;
        let mut words = line.split(' ');
        assert_eq!(words.next(), Some(name));
        Some(words.map(|word| word.parse().unwrap()).collect())
    }

    /// Items of `width` numbers, one a joint.
    fn items(&mut self, name: &str, width: usize) -> Option<Vec<f64>> {
        let values = self.line(name)?;
        let item = |i: &usize| values[i * width..(i + 1) * width].to_vec();
        Some(self.order.iter().flat_map(item).collect())
    }

    /// A matrix with items of `width` columns.
    fn matrix(&mut self, name: &str, width: usize) -> Vec<f64> {
        let n = self.order.len();
        let values = self.items(name, n * width).unwrap();
        let item = |row: usize, i: usize| (row * n + i) * width;
        let rows = (0..n).flat_map(|row| self.order.iter().map(move |i| item(row, *i)));
        rows.flat_map(|at| values[at..at + width].to_vec())
            .collect()
    }
}

fn compare(urdf: &str, reference: &str) {
    let robot = robot(urdf);
    let n = robot.len();
    let (names, rest) = reference.split_once('\n').unwrap();
    let names: Vec<&str> = names.split(' ').skip(1).collect();
    assert_eq!(names.len(), n);
    let place = |name: &str| names.iter().position(|other| *other == name).unwrap();
    let order: Vec<usize> = robot.joints().iter().map(|j| place(&j.name)).collect();
    let lines = rest.lines();
    let mut reference = Reference { lines, order };
    let parameters = robot.parameters();
    let close = |name: &str, ours: &[f64], theirs: &[f64]| {
        let apart = apart(ours, theirs);
        assert!(apart <= ROUNDING, "{name}: {apart:e}");
    };
    let theirs = reference.items("parameters", 10).unwrap();
    close("parameters", &parameters, &theirs);
    let mut workspace = Workspace::new(&robot);
    let mut states = 0;
    while let Some(q) = reference.items("q", 1) {
        let (v, a) = (
            reference.items("v", 1).unwrap(),
            reference.items("a", 1).unwrap(),
        );
        let motion: [&[f64]; 3] = [&q, &v, &a];
        let mut torque = vec![0.0; n];
        robot.torque(motion, &parameters, &mut workspace, &mut torque);
        close("torque", &torque, &reference.items("torque", 1).unwrap());
        let mut regressor = vec![f64::NAN; 10 * n * n];
        robot.regressor(motion, &mut workspace, &mut regressor);
        close("regressor", &regressor, &reference.matrix("regressor", 10));
        let (mut by_q, mut by_v, mut mass) = (vec![0.0; n * n], vec![0.0; n * n], vec![0.0; n * n]);
        robot.torque_derivatives(motion, &parameters, &mut workspace, &mut by_q, &mut by_v);
        close("by position", &by_q, &reference.matrix("by_position", 1));
        close("by speed", &by_v, &reference.matrix("by_speed", 1));
        robot.mass_matrix(&q, &parameters, &mut workspace, &mut mass);
        close("mass matrix", &mass, &reference.matrix("mass", 1));
        let mut back = vec![0.0; n];
        let given = [&q, &v, &torque[..]];
        assert!(robot.acceleration(given, &parameters, &[], &mut workspace, &mut back));
        assert!(apart(&back, &a) < 1e-10, "acceleration");
        states += 1;
    }
    assert_eq!(states, 3);
}

#[test]
fn arm_with_offsets_and_mixed_axes() {
    compare(ARM6, include_str!("../pinocchio/arm6.txt"));
}

#[test]
fn arm_with_fixed_links() {
    compare(ARM7, include_str!("../pinocchio/arm7.txt"));
}

#[test]
fn tree_with_prismatic_and_following_joints() {
    compare(TREE, include_str!("../pinocchio/tree.txt"));
}
