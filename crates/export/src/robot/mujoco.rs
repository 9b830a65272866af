//! MuJoCo 4: the URDF, the friction of its joints as classes and actuators to include, and a script that applies them.

use super::body::Body;
use super::python::literal;
use super::{Robot, RobotJoint, comment, urdf};
use crate::mujoco::{self, spaced};
use crate::number::Literal;
use crate::template::Fill;
use crate::vectors::DOUBLE_TOLERANCE;
use crate::{Error, File, law};
use stiction_friction::LuGre;
use stiction_friction::compensator::Friction;

const JOINTS: &str = include_str!("../../templates/robot/joints.xml.in");
const SCRIPT: &str = include_str!("../../templates/robot/mujoco.py.in");
const BRISTLES: &str = "%part mujoco/bristles.xml.in\n";

/// Presliding lengths that the self-test slides through, and in how many steps.
const PRESLIDINGS: f64 = 40.0;
const STEPS: f64 = 1000.0;

pub(super) fn files(robot: &Robot) -> Result<Vec<File>, Error> {
    let name = &robot.identifier;
    let bristles: Vec<Option<LuGre<f64>>> = robot
        .joints
        .iter()
        .map(|joint| mujoco::simple(&joint.model).ok())
        .collect();
    let has_bristles = bristles.iter().any(Option::is_some);
    let none = vec![None; bristles.len()];
    let script = script(robot, &bristles)?;
    let mut files = vec![
        urdf(robot),
        File::text(format!("{name}_joints.xml"), joints(robot, &none)?),
        File::text(format!("{name}_mujoco.py"), script),
    ];
    if has_bristles {
        let text = joints(robot, &bristles)?;
        files.push(File::text(format!("{name}_bristles.xml"), text));
    }
    Ok(files)
}

/// Classes and actuators; a joint with bristles has no friction loss.
fn joints(robot: &Robot, bristles: &[Option<LuGre<f64>>]) -> Result<String, Error> {
    let mut classes = Vec::new();
    let mut actuators = String::new();
    for (joint, bristle) in robot.joints.iter().zip(bristles) {
        let steady = joint.steady("mujoco")?;
        let (friction, damping) = match bristle {
            Some(law) => (0.0, law.curve().positive().viscous),
            None => (steady.friction, steady.damping),
        };
        classes.push(format!(
            "    <default class=\"{}\">\n      <joint armature=\"{}\" frictionloss=\"{}\" damping=\"{}\"/>\n    </default>",
            joint.model.identifier,
            joint.armature.c(),
            friction.c(),
            damping.c()
        ));
        if let Some(law) = bristle {
            actuators.push_str(&actuator(joint, law));
        }
    }
    let has = !actuators.is_empty();
    let mut fill = Fill::default();
    fill.set("header", spaced(&comment(robot, "", has)))
        .set("name", robot.identifier.clone())
        .set("classes", classes.join("\n"))
        .set("actuators", actuators.trim_end());
    let kind = if has { "bristles" } else { "joints" };
    fill.set("file", format!("{}_{kind}", robot.identifier))
        .flag("bristles", has);
    Ok(fill.render(JOINTS))
}

/// The bristles of a joint, passive.
fn actuator(joint: &RobotJoint, law: &LuGre<f64>) -> String {
    let offset = law.curve().offset();
    let mut fill = Fill::default();
    fill.set("name", joint.model.identifier.clone())
        .set("joint", xml(&joint.name))
        .set("input", " input=\"none\"")
        .set("f_unit", joint.model.force_unit())
        .set("v_unit", joint.model.speed_unit())
        .set("against", (-offset).c())
        .flag("offset", offset != 0.0);
    law::fill(&mut fill, &Friction::LuGre(*law), f64::c);
    let lines = fill.render(BRISTLES);
    lines.lines().map(|line| format!("    {line}\n")).collect()
}

fn script(robot: &Robot, bristles: &[Option<LuGre<f64>>]) -> Result<String, Error> {
    let body = Body::of(robot)?;
    let list = |values: &[f64]| -> String {
        let values: Vec<String> = values.iter().map(|x| x.c()).collect();
        format!("[{}]", values.join(", "))
    };
    let mut joints = Vec::new();
    for joint in &robot.joints {
        joints.push(format!(
            "    {}: \"{}\",",
            literal(&joint.name),
            joint.model.identifier
        ));
    }
    let followers = body.robot.joints().iter().filter_map(|joint| {
        let mimic = joint.mimic?;
        let of = &body.robot.joints()[mimic.of].name;
        let [ratio, offset] = [mimic.multiplier, mimic.offset].map(Literal::c);
        Some(format!(
            "    {}: ({}, {ratio}, {offset}),",
            literal(&joint.name),
            literal(of)
        ))
    });
    let independent = body.robot.independent().into_iter();
    let names: Vec<String> = independent
        .map(|i| literal(&body.robot.joints()[i].name))
        .collect();
    let (mut rows, mut scale) = (Vec::new(), 0.0_f64);
    for state in body.states() {
        scale = state.torque.iter().fold(scale, |most, x| most.max(x.abs()));
        let [q, v, a] = &state.motion;
        let parts = [q, v, a, &state.torque].map(|x| list(x));
        rows.push(format!("    ({}),", parts.join(", ")));
    }
    let pairs = robot.joints.iter().zip(bristles);
    let sliding: Vec<String> = pairs
        .filter_map(|(joint, law)| Some(slides(joint, law.as_ref()?)))
        .collect();
    let followers: Vec<String> = followers.collect();
    let mut fill = Fill::default();
    fill.set("header", comment(robot, "# ", false))
        .set("name", robot.identifier.clone())
        .set("gravity", list(&robot.gravity))
        .set("joints", joints.join("\n"))
        .set("independent", names.join(", "))
        .set("followers", followers.join("\n"))
        .set("rows", rows.join("\n"))
        .set("tolerance", (DOUBLE_TOLERANCE * scale).c())
        .set("sliding", sliding.join("\n"))
        .flag("bristles", !sliding.is_empty());
    Ok(fill.render(SCRIPT))
}

/// Class, speed, time of a step with which a thousand pass many presliding lengths, and force at that speed without viscous friction.
fn slides(joint: &RobotJoint, law: &LuGre<f64>) -> String {
    let side = law.curve().positive();
    let speed = side.stribeck_velocity;
    let step = PRESLIDINGS * law.bound() / (STEPS * speed);
    let force = law.curve().force(speed) - side.viscous * speed - law.curve().offset();
    let [speed, step, force] = [speed, step, force].map(Literal::c);
    let own = &joint.model.identifier;
    format!(
        "    ({}, \"{own}\", {speed}, {step}, {force}),",
        literal(&joint.name)
    )
}

/// A text as the value of an attribute, plain ASCII.
fn xml(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '"' | '&' | '<' | '>' | '\u{0}'..='\u{1f}' | '\u{7f}'.. => {
                out.push_str(&format!("&#{};", u32::from(c)));
            }
            c => out.push(c),
        }
    }
    out
}
