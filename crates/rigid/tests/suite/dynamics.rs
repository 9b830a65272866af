//! Properties of the dynamics: linear in the parameters, conservative, loads and followers.

use crate::common::{ALL, ARM7, Dice, TREE, apart, robot};
use stiction_rigid::{Robot, Workspace, inertia};

#[test]
fn regressor_times_parameters_is_the_torque() {
    let mut dice = Dice::new();
    for urdf in ALL {
        let mut robot = robot(urdf);
        let n = robot.len();
        robot.set_gravity([3.0, -4.0, 5.0]);
        let mut workspace = Workspace::new(&robot);
        for _ in 0..100 {
            let [q, dq, ddq] = [3.0, 5.0, 20.0].map(|most| dice.vector(n, most));
            // Of any values: linear, not only at physical ones.
            let parameters = dice.vector(10 * n, 1.0);
            let mut torque = vec![0.0; n];
            robot.torque([&q, &dq, &ddq], &parameters, &mut workspace, &mut torque);
            let mut regressor = vec![f64::NAN; 10 * n * n];
            robot.regressor([&q, &dq, &ddq], &mut workspace, &mut regressor);
            let rows = regressor.chunks_exact(10 * n);
            let product: Vec<f64> = rows
                .map(|row| row.iter().zip(&parameters).map(|(a, b)| a * b).sum())
                .collect();
            assert!(apart(&product, &torque) < 1e-12);
        }
    }
}

/// Kinetic energy from the mass matrix; a joint's power without acceleration is what gravity and the change of that take.
fn kinetic(robot: &Robot, q: &[f64], dq: &[f64], workspace: &mut Workspace) -> f64 {
    let n = robot.len();
    let mut mass = vec![0.0; n * n];
    robot.mass_matrix(q, &robot.parameters(), workspace, &mut mass);
    let row = |i: usize| mass[i * n..(i + 1) * n].iter().zip(dq).map(|(m, v)| m * v);
    (0..n).map(|i| 0.5 * dq[i] * row(i).sum::<f64>()).sum()
}

#[test]
fn falling_robot_keeps_its_energy() {
    for urdf in ALL {
        let mut robot = robot(urdf);
        let n = robot.len();
        // Without gravity, kinetic energy alone.
        robot.set_gravity([0.0; 3]);
        let parameters = robot.parameters();
        let mut workspace = Workspace::new(&robot);
        let mut state: Vec<f64> = Dice::new().vector(2 * n, 1.0);
        let zero = vec![0.0; n];
        let mut rate = |x: &[f64]| {
            let mut a = vec![0.0; n];
            let given = [&x[..n], &x[n..], &zero];
            assert!(robot.acceleration(given, &parameters, &[], &mut workspace, &mut a));
            [&x[n..], &a].concat()
        };
        let ahead = |x: &[f64], k: &[f64], h: f64| -> Vec<f64> {
            x.iter().zip(k).map(|(x, k)| x + h * k).collect()
        };
        let mut memory = Workspace::new(&robot);
        let before = kinetic(&robot, &state[..n], &state[n..], &mut memory);
        // Runge-Kutta of fourth order.
        let h = 2e-4;
        for _ in 0..1000 {
            let a = rate(&state);
            let b = rate(&ahead(&state, &a, h / 2.0));
            let c = rate(&ahead(&state, &b, h / 2.0));
            let d = rate(&ahead(&state, &c, h));
            for i in 0..2 * n {
                state[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
            }
        }
        let after = kinetic(&robot, &state[..n], &state[n..], &mut memory);
        assert!((after / before - 1.0).abs() < 1e-9, "{before} {after}");
    }
}

#[test]
fn load_of_a_link_weighs_at_its_joints() {
    let mut robot = robot(ARM7);
    let n = robot.len();
    let (q, zero) = (Dice::new().vector(n, 2.0), vec![0.0; n]);
    let mut workspace = Workspace::new(&robot);
    let mut held = |robot: &Robot| {
        let mut torque = vec![0.0; n];
        let motion = [&q[..], &zero, &zero];
        robot.torque(motion, &robot.parameters(), &mut workspace, &mut torque);
        torque
    };
    let before = held(&robot);
    let own = robot.bodies()[6].own;
    robot
        .attach(
            "finger",
            1.5,
            [0.02, 0.0, 0.1],
            [1e-3, 0.0, 1e-3, 0.0, 0.0, 1e-3],
        )
        .unwrap();
    let loaded = held(&robot);
    assert_eq!(robot.bodies()[6].own, own);
    // A load is what a link of the same inertia is.
    let link = r#"<link name="load"><inertial><origin xyz="0.02 0 0.1"/><mass value="1.5"/><inertia ixx="1e-3" ixy="0"
        ixz="0" iyy="1e-3" iyz="0" izz="1e-3"/></inertial></link><joint name="held" type="fixed"><parent link="finger"/>
        <child link="load"/></joint></robot>"#;
    let as_link = held(&crate::common::robot(&ARM7.replace("</robot>", link)));
    assert!(apart(&loaded, &as_link) < 1e-14);
    assert!(apart(&loaded, &before) > 0.1);
    for (link, mass) in [
        ("stand", 1.0),
        ("nothing", 1.0),
        ("hand", -1.0),
        ("hand", f64::NAN),
    ] {
        robot.attach(link, mass, [0.0; 3], [0.0; 6]).unwrap_err();
    }
}

#[test]
fn followers_give_their_work_to_the_joint_they_follow() {
    let robot = robot(TREE);
    let independent = robot.independent();
    assert_eq!(independent.len(), robot.len() - 1);
    let mut dice = Dice::new();
    let n = robot.len();
    let (mut q, mut dq) = (vec![0.0; n], vec![0.0; n]);
    robot.expand(&dice.vector(n - 1, 1.0), &mut q);
    let speeds = dice.vector(n - 1, 1.0);
    robot.expand_rates(&speeds, &mut dq);
    let (leader, follower) = (
        robot.joint("left_finger").unwrap(),
        robot.joint("left_thumb").unwrap(),
    );
    assert_eq!(q[follower], -1.5 * q[leader] + 0.01);
    let torque = dice.vector(n, 1.0);
    let mut reduced = vec![0.0; n - 1];
    robot.reduce(&torque, &mut reduced);
    let power = |torque: &[f64], speed: &[f64]| -> f64 {
        torque
            .iter()
            .zip(speed)
            .map(|(torque, speed)| torque * speed)
            .sum()
    };
    assert!((power(&torque, &dq) - power(&reduced, &speeds)).abs() < 1e-14);
}

#[test]
fn inertial_of_the_carrier_comes_back() {
    for urdf in ALL {
        let document = stiction_rigid::Document::parse(urdf).unwrap();
        let robot = robot(urdf);
        for (i, body) in robot.bodies().iter().enumerate() {
            let parameters = inertia::sum(&body.own, &body.attached);
            let found = robot.carrier_inertial(i, &parameters).unwrap();
            let stated = document.links[body.carrier].inertial.unwrap();
            let (found, stated) = [found, stated].map(|i| inertia::of_inertial(&i)).into();
            assert!(apart(&found, &stated) < 1e-12);
        }
    }
}
