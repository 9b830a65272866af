//! The robots of example-robot-data 6 beside Pinocchio 4.1 (`tests/pinocchio/robots.py`), and rewritten.

use crate::common::{Dice, apart};
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};
use stiction_rigid::{
    Base, Document, Error, NewDynamics, NewInertial, Robot, Scope, Workspace, inertia, rewrite,
};

/// Random states of each robot.
const STATES: usize = 1000;
/// Part of the largest number.
const ROUNDING: f64 = 1e-10;

/// Runs `robots.py` in the Python of `cargo xtask soak`, and hands on what it writes.
fn pinocchio<T>(arguments: &[&str], read: impl FnOnce(&mut dyn BufRead) -> T) -> T {
    let python = std::env::var("STICTION_PINOCCHIO")
        .expect("STICTION_PINOCCHIO: a Python with tests/pinocchio/requirements.txt; cargo xtask soak sets it");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/pinocchio/robots.py");
    let mut command = Command::new(&python);
    command.arg(script).args(arguments).stdout(Stdio::piped());
    let mut child = command.spawn().unwrap_or_else(|e| panic!("{python}: {e}"));
    let result = read(&mut BufReader::with_capacity(
        1 << 20,
        child.stdout.take().unwrap(),
    ));
    assert!(child.wait().unwrap().success(), "{arguments:?}");
    result
}

fn numbers(from: &mut dyn BufRead, count: usize) -> Vec<f64> {
    let mut bytes = vec![0; 8 * count];
    from.read_exact(&mut bytes).unwrap();
    bytes
        .as_chunks()
        .0
        .iter()
        .map(|b| f64::from_le_bytes(*b))
        .collect()
}

/// Where each of our joints is in Pinocchio.
fn order(robot: &Robot, from: &mut dyn BufRead) -> Vec<usize> {
    let mut names = String::new();
    from.read_line(&mut names).unwrap();
    let names: Vec<&str> = names.trim_end().split('\t').collect();
    assert_eq!(names.len(), robot.len());
    let place = |name: &str| names.iter().position(|other| *other == name).unwrap();
    robot
        .joints()
        .iter()
        .map(|joint| place(&joint.name))
        .collect()
}

/// Items of `width` numbers in the order of our joints.
fn items(values: &[f64], order: &[usize], width: usize) -> Vec<f64> {
    order
        .iter()
        .flat_map(|i| values[i * width..(i + 1) * width].to_vec())
        .collect()
}

/// A matrix with items of `width` columns, in the order of our joints.
fn matrix(from: &mut dyn BufRead, order: &[usize], width: usize) -> Vec<f64> {
    let n = order.len();
    let values = numbers(from, n * n * width);
    order
        .iter()
        .flat_map(|i| items(&values[i * n * width..(i + 1) * n * width], order, width))
        .collect()
}

/// Largest differences of parameters, torques, regressors, derivatives.
fn compare(path: &str, robot: &Robot) -> [f64; 5] {
    let n = robot.len();
    let mut workspace = Workspace::new(robot);
    let parameters = robot.parameters();
    let mut worst = [0.0_f64; 5];
    pinocchio(&[path, &STATES.to_string()], |from| {
        let order = order(robot, from);
        let theirs = items(&numbers(from, 10 * n), &order, 10);
        worst[0] = apart(&parameters, &theirs);
        let mut regressor = vec![0.0; 10 * n * n];
        let (mut torque, mut by_q, mut by_v) = (vec![0.0; n], vec![0.0; n * n], vec![0.0; n * n]);
        for _ in 0..STATES {
            let [q, v, a, theirs] = [(); 4].map(|()| items(&numbers(from, n), &order, 1));
            let motion: [&[f64]; 3] = [&q, &v, &a];
            robot.torque(motion, &parameters, &mut workspace, &mut torque);
            robot.regressor(motion, &mut workspace, &mut regressor);
            robot.torque_derivatives(motion, &parameters, &mut workspace, &mut by_q, &mut by_v);
            let regressors = matrix(from, &order, 10);
            let [by_position, by_speed] = [(); 2].map(|()| matrix(from, &order, 1));
            // Derivatives may vanish where torques do not.
            let size = theirs.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let sized = |values: &[f64]| [values, &[size]].concat();
            let found = [
                apart(&torque, &theirs),
                apart(&regressor, &regressors),
                apart(&sized(&by_q), &sized(&by_position)),
                apart(&sized(&by_v), &sized(&by_speed)),
            ];
            for (worst, x) in worst[1..].iter_mut().zip(found) {
                // NaN stays.
                *worst = if x <= *worst { *worst } else { x };
            }
        }
        assert_eq!(from.read(&mut [0]).unwrap(), 0);
    });
    worst
}

/// The text without inertias, joint friction, and the space before them.
fn rest(text: &str) -> String {
    let mut out = String::new();
    let mut text = text;
    let next = |text: &str| {
        let starts = [
            ("<inertial>", "</inertial>"),
            ("<dynamics", ">"),
            ("</dynamics", ">"),
        ];
        let found = starts.iter().filter_map(|(open, close)| {
            let at = text.find(open)?;
            Some((at, at + text[at..].find(close)? + close.len()))
        });
        found.min()
    };
    while let Some((start, end)) = next(text) {
        out.push_str(text[..start].trim_end());
        text = &text[end..];
    }
    out + text
}

/// Writes other inertias and friction, and asks Pinocchio what the file says.
fn rewritten(text: &str, robot: &Robot) {
    let mut dice = Dice::new();
    let mut wanted = robot.parameters();
    let mut inertials = Vec::new();
    for (i, body) in robot.bodies().iter().enumerate() {
        let parameters = &mut wanted.as_chunks_mut::<10>().0[i];
        let own = body.own.map(|x| x * (1.0 + 0.1 * dice.unit()));
        *parameters = inertia::sum(&own, &body.attached);
        if let Some(inertial) = robot.carrier_inertial(i, parameters) {
            let link = robot.links()[body.carrier].name.as_str();
            inertials.push(NewInertial { link, inertial });
        }
    }
    let dynamics = robot.joints().iter().map(|joint| NewDynamics {
        joint: &joint.name,
        damping: 0.25,
        friction: 0.75,
    });
    let dynamics: Vec<NewDynamics> = dynamics.collect();
    let new = rewrite(text, &inertials, &dynamics).unwrap();
    assert_eq!(rest(&new), rest(text));
    assert_eq!(rewrite(&new, &inertials, &dynamics).unwrap(), new);
    let again = Robot::new(&Document::parse(&new).unwrap()).unwrap();
    assert!(apart(&again.parameters(), &wanted) < 1e-12);
    let friction = |j: &stiction_rigid::Joint| (j.damping, j.friction) == (0.25, 0.75);
    assert!(again.joints().iter().all(friction));
    let path = std::env::temp_dir().join(format!("stiction-rigid-{}.urdf", std::process::id()));
    std::fs::write(&path, &new).unwrap();
    let theirs = pinocchio(&[&path.to_string_lossy(), "0"], |from| {
        let order = order(robot, from);
        items(&numbers(from, 10 * robot.len()), &order, 10)
    });
    std::fs::remove_file(&path).unwrap();
    assert!(apart(&theirs, &wanted) < 1e-12);
}

#[test]
#[ignore = "soak: 69 robots with Pinocchio"]
fn robots_of_example_robot_data() {
    let list = pinocchio(&["list"], |from| {
        let mut text = String::new();
        from.read_to_string(&mut text).unwrap();
        text
    });
    let (mut compared, mut refused) = (0, Vec::new());
    let mut worst = [0.0_f64; 5];
    for path in list.lines() {
        let text = std::fs::read_to_string(path).unwrap();
        let robot = match Document::parse(&text).and_then(|document| Robot::new(&document)) {
            Ok(robot) => robot,
            // A box in the hand, a drone without joints, a file without links.
            Err(e @ (Error::FreeBase { .. } | Error::Joints { .. } | Error::Missing { .. })) => {
                refused.push(format!("{path}: {e}"));
                continue;
            }
            Err(e) => panic!("{path}: {e}"),
        };
        let found = compare(path, &robot);
        eprintln!("{found:?} {} joints {path}", robot.len());
        assert!(found.iter().all(|x| *x <= ROUNDING), "{path}: {found:?}");
        worst.iter_mut().zip(found).for_each(|(w, x)| *w = w.max(x));
        rewritten(&text, &robot);
        compared += 1;
    }
    eprintln!("{compared} robots, {worst:?}; refused: {refused:#?}");
    assert_eq!(compared, 66);
}

/// Numbers of base parameters in the literature: UR10 and Panda on a vertical first axis, 7 a joint but 1 for the first
/// (Gautier and Khalil 1990; Gaz et al. 2019 for the Panda).
#[test]
#[ignore = "soak: robots of example-robot-data"]
fn base_parameters_of_known_arms() {
    let list = pinocchio(&["list"], |from| {
        let mut text = String::new();
        from.read_to_string(&mut text).unwrap();
        text
    });
    for (name, joints, wanted) in [("ur10_robot.urdf", 6, 36), ("panda.urdf", 7, 43)] {
        let path = list.lines().find(|path| path.ends_with(name)).unwrap();
        let robot =
            Robot::new(&Document::parse(&std::fs::read_to_string(path).unwrap()).unwrap()).unwrap();
        let mut scope = Scope::all(&robot, false);
        // Without the fingers of a hand.
        scope.moving[joints..].fill(false);
        assert_eq!(Base::of(&robot, &scope).unwrap().len(), wanted, "{name}");
    }
}
