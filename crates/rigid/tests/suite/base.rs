//! Base parameters: their number against closed forms, and that they give the torque.

use crate::common::{ALL, ARM6, ARM7, Dice, TREE, apart, robot};
use stiction_rigid::{Base, Parameter, Robot, Scope, Workspace};

fn all(robot: &Robot, armature: bool) -> Base {
    Base::of(robot, &Scope::all(robot, armature)).unwrap()
}

/// Gautier and Khalil 1990: of a serial robot of revolute joints, seven parameters a joint, of the first one with a vertical
/// axis only one. Six joints have 36 (as the PUMA 560), seven have 43 (as the Panda).
#[test]
fn serial_robots_have_seven_parameters_a_joint_and_one_at_the_first() {
    assert_eq!(all(&robot(ARM6), false).len(), 36);
    assert_eq!(all(&robot(ARM7), false).len(), 43);
    // Inclined, the first joint has its two first moments as well.
    let mut inclined = robot(ARM6);
    inclined.set_gravity([3.0, 0.0, -9.0]);
    assert_eq!(all(&inclined, false).len(), 38);
}

/// Terms to twelve digits.
fn terms(base: &Base, number: usize) -> Vec<(Parameter, f64)> {
    let rounded = |(p, k): (Parameter, f64)| (p, (k * 1e12).round() / 1e12);
    base.terms(number).into_iter().map(rounded).collect()
}

/// Khalil and Dombre 2002, section 9.4: the rotor inertia of the first joint cannot be told from the inertia of its body, nor
/// that of the second if its axis is perpendicular to the first; the others are parameters of their own.
#[test]
fn first_rotor_inertias_are_regrouped() {
    let oblique = robot(&ARM6.replace("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0.4 1 0\"/>"));
    assert_eq!(all(&oblique, true).len(), 36 + 5);
    let robot = robot(ARM6);
    let base = all(&robot, true);
    assert_eq!(base.len(), 36 + 4);
    let first = Parameter::Inertial { body: 0, number: 9 };
    let place = base.independent().iter().position(|p| *p == first).unwrap();
    let armature = Parameter::Armature { joint: 0 };
    assert!(terms(&base, place).contains(&(armature, 1.0)));
    assert_eq!((first.symbol(), armature.symbol()), ("Izz", "Ia"));
}

/// A vertical prismatic joint feels masses alone; a pendulum below it that turns about its vertical axis, one inertia.
#[test]
fn prismatic_joint_feels_masses() {
    let urdf = r#"<robot><link name="a"/><link name="b"/><link name="c"/>
        <joint name="j" type="prismatic"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint>
        <joint name="k" type="revolute"><parent link="b"/><child link="c"/><axis xyz="0 0 1"/></joint></robot>"#;
    let base = all(&robot(urdf), false);
    let inertial = |body, number| Parameter::Inertial { body, number };
    assert_eq!(base.independent(), [inertial(0, 0), inertial(1, 9)]);
    assert_eq!(
        terms(&base, 0),
        [(inertial(0, 0), 1.0), (inertial(1, 0), 1.0)]
    );
    assert_eq!(base.dependent(), [inertial(1, 0)]);
    assert_eq!(base.without_effect().len(), 17);
    assert_eq!(base.terms(2), []);
}

#[test]
fn base_parameters_give_the_torque() {
    for urdf in ALL {
        let robot = robot(urdf);
        let n = robot.len();
        let base = all(&robot, true);
        let mut dice = Dice::new();
        let mut workspace = Workspace::new(&robot);
        let (parameters, armature) = (dice.vector(10 * n, 1.0), dice.vector(n, 1.0));
        let beta = base.values(&parameters, &armature);
        for _ in 0..20 {
            let leaders = base_coordinates(&robot);
            let [mut q, mut dq, mut ddq] = [(); 3].map(|()| vec![0.0; n]);
            robot.expand(&dice.vector(leaders, 2.0), &mut q);
            robot.expand_rates(&dice.vector(leaders, 2.0), &mut dq);
            robot.expand_rates(&dice.vector(leaders, 2.0), &mut ddq);
            let mut torque = vec![0.0; n];
            robot.torque([&q, &dq, &ddq], &parameters, &mut workspace, &mut torque);
            for i in 0..n {
                torque[i] += armature[i] * ddq[i];
            }
            let mut regressor = vec![0.0; 10 * n * n];
            robot.regressor([&q, &dq, &ddq], &mut workspace, &mut regressor);
            let product = |i: usize| {
                let column = |p: &Parameter| match *p {
                    Parameter::Armature { joint } => {
                        if joint == i {
                            ddq[i]
                        } else {
                            0.0
                        }
                    }
                    other => regressor[10 * n * i + other.index(n)],
                };
                let terms = base.independent().iter().zip(&beta);
                terms.map(|(p, beta)| column(p) * beta).sum::<f64>()
            };
            let found: Vec<f64> = (0..n).map(product).collect();
            let (mut a, mut b) = (vec![0.0; leaders], vec![0.0; leaders]);
            robot.reduce(&found, &mut a);
            robot.reduce(&torque, &mut b);
            assert!(apart(&a, &b) < 1e-10, "{}", apart(&a, &b));
        }
    }
}

fn base_coordinates(robot: &Robot) -> usize {
    robot.independent().len()
}

#[test]
fn joints_that_stand_are_part_of_what_carries_them() {
    let robot = robot(ARM7);
    let mut scope = Scope::all(&robot, false);
    scope.moving[3..].fill(false);
    scope.position = vec![0.3; 7];
    assert_eq!(Base::of(&robot, &scope).unwrap().len(), 15);
    scope.moving.fill(false);
    assert!(Base::of(&robot, &scope).unwrap().is_empty());
    scope.moving.pop();
    Base::of(&robot, &scope).unwrap_err();
}

/// A follower adds nothing that its leader's motion does not show: fewer parameters than of the same tree with free fingers.
#[test]
fn followers_have_no_parameters_of_their_own_motion() {
    let mimic = TREE.lines().find(|line| line.contains("<mimic")).unwrap();
    let free = all(&robot(&TREE.replace(mimic, "")), true);
    let bound = all(&robot(TREE), true);
    assert!(bound.len() < free.len(), "{} {}", bound.len(), free.len());
}
