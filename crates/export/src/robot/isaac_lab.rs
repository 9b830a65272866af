//! Isaac Lab: one actuator for all joints, with the friction of each by its name.

use super::python::pattern;
use super::{Robot, comment};
use crate::number::Literal;
use crate::template::Fill;
use crate::{Error, File};

const CONFIG: &str = include_str!("../../templates/robot/isaaclab.py.in");

pub(super) fn files(robot: &Robot) -> Result<Vec<File>, Error> {
    let (mut names, mut armature) = (Vec::new(), Vec::new());
    let [mut at_rest, mut sliding, mut viscous] = [const { Vec::new() }; 3];
    for joint in &robot.joints {
        let steady = joint.steady("isaaclab")?;
        let name = pattern(&joint.name);
        let entry = |value: f64| format!("        {name}: {},", value.c());
        armature.push(entry(joint.armature));
        at_rest.push(entry(steady.at_rest));
        sliding.push(entry(steady.friction));
        viscous.push(entry(steady.damping));
        names.push(format!("        {name},"));
    }
    let mut fill = Fill::default();
    fill.set("header", comment(robot, "# ", true))
        .set("NAME", robot.identifier.to_ascii_uppercase())
        .set("names", names.join("\n"))
        .set("armature", armature.join("\n"))
        .set("at_rest", at_rest.join("\n"))
        .set("sliding", sliding.join("\n"))
        .set("viscous", viscous.join("\n"));
    let path = format!("{}_friction.py", robot.identifier);
    Ok(vec![File::text(path, fill.render(CONFIG))])
}
