//! Damaged URDFs and random text are read or refused, never a panic.

use crate::common::{ALL, Dice};
use proptest::prelude::*;
use stiction_rigid::{Base, Document, NewDynamics, NewInertial, Robot, Scope, Workspace, rewrite};

/// Everything that is computed for a robot.
fn use_all(urdf: &str) {
    let Ok(robot) = Document::parse(urdf).and_then(|document| Robot::new(&document)) else {
        return;
    };
    let n = robot.len();
    let mut workspace = Workspace::new(&robot);
    let (x, mut torque) = (vec![0.5; n], vec![0.0; n]);
    robot.torque(
        [&x, &x, &x],
        &robot.parameters(),
        &mut workspace,
        &mut torque,
    );
    robot.acceleration(
        [&x, &x, &x],
        &robot.parameters(),
        &[],
        &mut workspace,
        &mut torque,
    );
    assert!(robot.parameters().iter().all(|x| !x.is_nan()), "{urdf}");
    assert!(Base::of(&robot, &Scope::all(&robot, true)).unwrap().len() <= 11 * n);
    let written = |i: usize| {
        let mut parameters = [0.1; 10];
        parameters.copy_from_slice(&robot.parameters()[10 * i..10 * i + 10]);
        let link = robot.links()[robot.bodies()[i].carrier].name.as_str();
        let inertial = robot.carrier_inertial(i, &parameters)?;
        Some(NewInertial { link, inertial })
    };
    let inertials: Vec<NewInertial> = (0..n).filter_map(written).collect();
    let dynamics = robot.joints().iter().map(|joint| NewDynamics {
        joint: &joint.name,
        damping: 1.0,
        friction: 2.0,
    });
    let text = rewrite(urdf, &inertials, &dynamics.collect::<Vec<_>>()).unwrap();
    let again = Robot::new(&Document::parse(&text).unwrap()).unwrap();
    assert!(again.joints().iter().all(|joint| joint.friction == 2.0));
}

proptest! {
    #[test]
    fn any_text(text in any::<String>(), inside in any::<String>()) {
        use_all(&text);
        use_all(&format!("<robot>{inside}</robot>"));
    }
}

#[test]
fn damaged_robots() {
    let mut dice = Dice::new();
    let pieces = [
        "",
        "\"",
        "<",
        ">",
        "/>",
        "0",
        "-",
        "1e49",
        "1e400",
        "nan",
        "<link name=\"x\"/>",
        "fixed",
        "link1",
        "base",
        "\u{feff}",
        "\u{301}",
        "]]>",
        "<!--",
        "&amp;",
        "&#0;",
        "mimic",
    ];
    for round in 0..4_000 {
        let mut text = ALL[round % 3].to_string();
        for _ in 0..1 + dice.below(4) {
            let at = dice.below(text.len());
            let end = at + dice.below(if round % 2 == 0 { 8 } else { 400 });
            let end = end.min(text.len());
            if text.is_char_boundary(at) && text.is_char_boundary(end) {
                text.replace_range(at..end, pieces[dice.below(pieces.len())]);
            }
        }
        use_all(&text);
    }
}
