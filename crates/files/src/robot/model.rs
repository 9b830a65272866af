//! What an identification adds to `robot.toml`: of each joint its friction, of each body its inertia.

use super::result::{BodyEntry, RobotFile};
use std::fmt::Write;

/// A robot file with the identified part, [`Robot::identified`](super::Robot::identified). `urdf` is the path of the URDF from
/// the folder of the file.
pub fn text(robot: &RobotFile, urdf: &str) -> String {
    let mut out = String::new();
    let _ = writeln!(
        out,
        "schema = {:?}\nname = {}\nurdf = {}\nurdf_sha256 = {:?}\ngravity = {:?}",
        super::result::SCHEMA,
        quoted(&robot.name),
        quoted(urdf),
        robot.urdf.sha256,
        robot.gravity,
    );
    if let Some(tool) = &robot.tool {
        let _ = writeln!(
            out,
            "\n[tool]\nlink = {}\nmass = \"{:?} kg\"\ncenter = {:?}",
            quoted(&tool.link),
            tool.mass,
            tool.center
        );
    }
    if let Some(time) = &robot.time {
        let _ = writeln!(out, "\n[columns]\n{}", time.line);
    }
    for coupling in &robot.couplings {
        let joints: Vec<String> = coupling.joints.iter().map(|own| quoted(own)).collect();
        let _ = writeln!(
            out,
            "\n[[coupling]]\njoints = [{}]\nmatrix = {:?}",
            joints.join(", "),
            coupling.matrix
        );
    }
    for joint in &robot.joints {
        let _ = writeln!(out, "\n[joint.{}]", quoted(&joint.name));
        for column in &joint.columns {
            let _ = writeln!(out, "{}", column.line);
        }
        let Some(fit) = &joint.fit else { continue };
        let _ = writeln!(out, "\n[joint.{}.identified]", quoted(&joint.name));
        let _ = writeln!(
            out,
            "model = {}",
            quoted(&format!("{}/model.toml", fit.folder))
        );
        let _ = writeln!(out, "armature = {:?}", fit.armature.value);
        if let Some([friction, damping]) = &fit.simulators {
            let _ = writeln!(
                out,
                "friction = {:?}\ndamping = {:?}",
                friction.value, damping.value
            );
        }
    }
    for body in &robot.bodies {
        body_text(body, &mut out);
    }
    out
}

fn body_text(body: &BodyEntry, out: &mut String) {
    let _ = writeln!(
        out,
        "\n[[body]]\njoint = {}\nlink = {}\nmass = {:?}\ncenter = {:?}\ninertia = {:?}",
        quoted(&body.joint),
        quoted(&body.link),
        body.mass,
        body.center,
        body.inertia
    );
}

/// A text or a key of TOML on one line.
pub fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            c if c.is_control() => {
                let _ = write!(out, "\\u{:04X}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}
