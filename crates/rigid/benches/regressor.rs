//! Times of the dynamics for one sample of a motion, of arms with six and seven joints and a tree of eight.

use divan::{Bencher, black_box};
use stiction_rigid::{Document, Robot, Workspace};

fn main() {
    divan::main();
}

const ROBOTS: [(&str, &str); 3] = [
    ("arm6", include_str!("../tests/pinocchio/arm6.urdf")),
    ("arm7", include_str!("../tests/pinocchio/arm7.urdf")),
    ("tree", include_str!("../tests/pinocchio/tree.urdf")),
];
const NAMES: [&str; 3] = ["arm6", "arm7", "tree"];

fn robot(name: &str) -> Robot {
    let (_, urdf) = ROBOTS.iter().find(|robot| robot.0 == name).expect("listed");
    Robot::new(&Document::parse(urdf).expect("valid")).expect("valid")
}

#[divan::bench(args = NAMES)]
fn regressor(bencher: Bencher, name: &str) {
    let robot = robot(name);
    let n = robot.len();
    let (x, mut out) = (vec![0.7; n], vec![0.0; 10 * n * n]);
    let mut workspace = Workspace::new(&robot);
    bencher.bench_local(|| {
        let x = black_box(&x[..]);
        robot.regressor([x, x, x], &mut workspace, &mut out);
        black_box(&out);
    });
}

#[divan::bench(args = NAMES)]
fn torque(bencher: Bencher, name: &str) {
    let robot = robot(name);
    let n = robot.len();
    let (x, mut out, parameters) = (vec![0.7; n], vec![0.0; n], robot.parameters());
    let mut workspace = Workspace::new(&robot);
    bencher.bench_local(|| {
        let x = black_box(&x[..]);
        robot.torque([x, x, x], &parameters, &mut workspace, &mut out);
        black_box(&out);
    });
}

#[divan::bench(args = NAMES)]
fn torque_derivatives(bencher: Bencher, name: &str) {
    let robot = robot(name);
    let n = robot.len();
    let (x, parameters) = (vec![0.7; n], robot.parameters());
    let (mut by_q, mut by_v) = (vec![0.0; n * n], vec![0.0; n * n]);
    let mut workspace = Workspace::new(&robot);
    bencher.bench_local(|| {
        let x = black_box(&x[..]);
        robot.torque_derivatives([x, x, x], &parameters, &mut workspace, &mut by_q, &mut by_v);
        black_box((&by_q, &by_v));
    });
}
