//! C99: the compensators of all joints, what calls them in order and, where wished, gravity, inertia and Coriolis forces by
//! recursive Newton-Euler.

use super::body::Body;
use super::{Robot, RobotJoint, comment, joint_identifiers};
use crate::c::{self, DOUBLE, FLOAT, Precision};
use crate::number::Literal;
use crate::template::Fill;
use crate::terms::Extra;
use crate::vectors::DOUBLE_TOLERANCE;
use crate::{Error, File};
use sha2::{Digest, Sha256};
use stiction_rigid::urdf::Kind;

const HEADER: &str = include_str!("../../templates/robot/robot.h.in");
const SOURCE: &str = include_str!("../../templates/robot/robot.c.in");
const SELFTEST: &str = include_str!("../../templates/robot/selftest.c.in");

/// Largest error of torques in single precision, over the largest torque.
const SINGLE_TORQUE: f64 = 1e-5;

/// A place in the arrays of the code.
struct Slot<'a> {
    /// Name in the URDF.
    name: String,
    identifier: String,
    /// Its friction, if that was identified.
    fitted: Option<&'a RobotJoint>,
}

pub(super) fn files(robot: &Robot) -> Result<Vec<File>, Error> {
    let body = Body::loaded(robot)?;
    for joint in robot.joints.iter().filter(|_| robot.feeds_rigid) {
        joint.in_newtons("c")?;
    }
    let slots = slots(robot, &body);
    let mut files = Vec::new();
    for joint in &robot.joints {
        files.extend(c::files(&joint.model).map_err(|e| joint.refused(e))?);
    }
    files.extend(precision::<f64>(robot, &body, &slots, &DOUBLE));
    files.extend(precision::<f32>(robot, &body, &slots, &FLOAT));
    Ok(files)
}

/// The fitted joints or, where the rigid body is fed forward, all that follow none.
fn slots<'a>(robot: &'a Robot, body: &Body) -> Vec<Slot<'a>> {
    let slot = |joint: &'a RobotJoint| Slot {
        name: joint.name.clone(),
        identifier: joint.model.identifier.clone(),
        fitted: Some(joint),
    };
    if !robot.feeds_rigid {
        return robot.joints.iter().map(slot).collect();
    }
    let all = body.robot.independent().into_iter();
    let all: Vec<&str> = all.map(|i| body.robot.joints()[i].name.as_str()).collect();
    let fitted: Vec<&str> = robot.joints.iter().map(|j| j.name.as_str()).collect();
    let rest = all.iter().filter(|name| !fitted.contains(name)).copied();
    let names: Vec<&str> = fitted.iter().copied().chain(rest).collect();
    let identifiers = joint_identifiers(&robot.identifier, &names);
    let named: Vec<(&str, String)> = names.into_iter().zip(identifiers).collect();
    let of = |name: &&str| {
        let joint = robot.joints.iter().find(|joint| joint.name == **name);
        let own = named.iter().find(|(own, _)| own == name);
        Slot {
            name: name.to_string(),
            identifier: own.map_or(String::new(), |(_, identifier)| identifier.clone()),
            fitted: joint,
        }
    };
    all.iter().map(of).collect()
}

fn precision<T: Literal>(
    robot: &Robot,
    body: &Body,
    slots: &[Slot],
    precision: &Precision,
) -> Vec<File> {
    let suffix = precision.suffix;
    let name = format!("{}_robot{suffix}", robot.identifier);
    let fitted = || {
        let numbered = slots.iter().enumerate();
        numbered
            .filter_map(|(i, slot)| Some((i, format!("{}{suffix}", slot.identifier), slot.fitted?)))
    };
    let lines = |of: &dyn Fn(usize, &str, &RobotJoint) -> String| -> String {
        let each: Vec<String> = fitted().map(|(i, own, joint)| of(i, &own, joint)).collect();
        each.join("\n")
    };
    let indices: Vec<String> = slots
        .iter()
        .enumerate()
        .map(|(i, slot)| {
            let upper = format!("{}{suffix}", slot.identifier).to_ascii_uppercase();
            let name = crate::header::plain(&slot.name);
            let note = if slot.fitted.is_some() {
                ""
            } else {
                ", no friction"
            };
            format!("    {upper}_INDEX = {i}, /* joint '{name}'{note} */")
        })
        .collect();
    let file = |own: &str, joint: &RobotJoint| {
        let base = own.strip_suffix(suffix).unwrap_or(&joint.model.identifier);
        format!("{base}_friction{suffix}")
    };
    let used = |extra: Extra| {
        let mut all = robot.joints.iter();
        all.any(|joint| Extra::of(&joint.model.terms).contains(&extra))
    };
    let rigid = robot.feeds_rigid;
    let adapts = |joint: &RobotJoint| joint.model.settings.adaptation.is_some();
    let settings = robot.joints.first().map(|joint| joint.model.settings);
    let number = |x: f64| T::from_f64(x).c();
    let mut fill = Fill::default();
    fill.set("header", comment(robot, " * ", false))
        .set("name", name.clone())
        .set("NAME", name.to_ascii_uppercase())
        .set("real", precision.real)
        .set("f", precision.literal)
        .set("m", precision.function)
        .set("MAX", precision.max)
        .set("stamp", stamp(robot))
        .set("count", slots.len().to_string())
        .set("indices", indices.join("\n"))
        .set(
            "includes",
            lines(&|_, own, joint| format!("#include \"{}.h\"", file(own, joint))),
        )
        .set(
            "sources",
            fitted()
                .map(|(_, own, joint)| format!("{}.c", file(&own, joint)))
                .collect::<Vec<_>>()
                .join(" "),
        )
        .set(
            "params_members",
            lines(&|_, own, _| format!("    {own}_params_t {own};")),
        )
        .set(
            "state_members",
            lines(&|_, own, _| format!("    {own}_state_t {own};")),
        )
        .set(
            "params_lines",
            lines(&|_, own, _| format!("    {own}_params(&params->{own});")),
        )
        .set(
            "init_lines",
            lines(&|_, own, _| {
                format!("    good = {own}_init(&params->{own}, &state->{own}) && good;")
            }),
        )
        .set(
            "reset_lines",
            lines(&|_, own, _| format!("    {own}_reset(&params->{own}, &state->{own});")),
        )
        .set(
            "step_lines",
            lines(&|i, own, joint| step(i, own, joint, rigid)),
        )
        .set(
            "test_states",
            lines(&|_, own, _| format!("    {own}_state_t {own}_alone;")),
        )
        .set(
            "test_init",
            lines(&|_, own, _| {
                format!("    wrong += {own}_init(&params.{own}, &{own}_alone) ? 0u : 1u;")
            }),
        )
        .set(
            "test_steps",
            lines(&|i, own, joint| test_step(i, own, joint, rigid)),
        )
        .flag("rigid", rigid)
        .flag("acceleration_in", rigid || used(Extra::Acceleration))
        .flag("position_in", rigid || used(Extra::Position))
        .flag("load_in", used(Extra::Load))
        .flag("temperature_in", used(Extra::Temperature))
        .flag("transmitted_in", !rigid && used(Extra::Transmitted))
        .flag("adapt", robot.joints.iter().any(adapts))
        .set(
            "cycle_time",
            settings.map_or(String::new(), |s| number(s.cycle_time)),
        )
        .set("ramp", settings.map_or(String::new(), |s| number(s.ramp)));
    if rigid {
        rigid_body::<T>(robot, body, slots, precision, &mut fill);
    }
    vec![
        File::text(format!("{name}.h"), fill.render(HEADER)),
        File::text(format!("{name}.c"), fill.render(SOURCE)),
        File::text(format!("{name}_selftest.c"), fill.render(SELFTEST)),
    ]
}

/// Inputs of a compensator from those of the robot, as statements.
fn inputs(i: usize, joint: &RobotJoint, input: &str, rigid: Option<&str>) -> Vec<String> {
    let mut members = vec![
        ("reference_velocity", "velocity"),
        ("tracking_error", "tracking_error"),
        ("enable", "enable"),
    ];
    if joint.model.settings.adaptation.is_some() {
        members.extend([("drive_force", "drive_force"), ("learn", "learn")]);
    }
    let extras = Extra::of(&joint.model.terms).into_iter();
    members.extend(extras.map(|extra| match extra {
        Extra::Acceleration => (extra.name(), "acceleration"),
        extra => (extra.name(), extra.name()),
    }));
    let from = |member: &str, own: &str| match (member, rigid) {
        ("transmitted", Some(torque)) => format!("{torque}[{i}]"),
        _ => format!("{input}{own}[{i}]"),
    };
    let line = |(member, own): (&str, &str)| format!("joint.{member} = {};", from(member, own));
    members.into_iter().map(line).collect()
}

fn step(i: usize, own: &str, joint: &RobotJoint, rigid: bool) -> String {
    let torque = rigid.then_some("state->torque");
    let lines = inputs(i, joint, "input->", torque);
    format!(
        "    {{\n        {own}_input_t joint;\n        {}\n        force[{i}] = {own}_step(&params->{own}, &state->{own}, &joint);\n    }}",
        lines.join("\n        ")
    )
}

fn test_step(i: usize, own: &str, joint: &RobotJoint, rigid: bool) -> String {
    let lines = inputs(i, joint, "input.", rigid.then_some("state.torque"));
    format!(
        "        {{\n            {own}_input_t joint;\n            {}\n            alone[{i}] = {own}_step(&params.{own}, &{own}_alone, &joint);\n        }}",
        lines.join("\n            ")
    )
}

/// Bodies, rotors, limits and the vectors of the self-test.
fn rigid_body<T: Literal>(
    robot: &Robot,
    body: &Body,
    slots: &[Slot],
    precision: &Precision,
    fill: &mut Fill,
) {
    let rigid = &body.robot;
    let number = |x: f64| T::from_f64(x + 0.0).c();
    let list = |values: &[f64]| -> String {
        let values: Vec<String> = values.iter().map(|x| number(*x)).collect();
        format!("{{ {} }}", values.join(", "))
    };
    let independent = rigid.independent();
    let place = |joint: usize| independent.iter().position(|i| *i == joint).unwrap_or(0);
    let parameters = rigid.parameters();
    let (ten, _) = parameters.as_chunks::<10>();
    let bodies: Vec<String> = rigid
        .joints()
        .iter()
        .zip(ten)
        .enumerate()
        .map(|(i, (joint, ten))| {
            let parent = joint.parent.map_or("-1".into(), |p| p.to_string());
            let (leads, ratio, offset) = match joint.mimic {
                Some(mimic) => (mimic.of, mimic.multiplier, mimic.offset),
                None => (i, 1.0, 0.0),
            };
            let slides = joint.kind == Kind::Prismatic;
            format!(
                "    /* {} */\n    {{ {parent}, {}, {slides}, {}, {}, {},\n      {},\n      {}, {},\n      {}, {} }}",
                crate::header::plain(&joint.name),
                place(leads),
                number(ratio),
                number(offset),
                list(&joint.axis),
                list(joint.frame.rotation.as_flattened()),
                list(&joint.frame.translation),
                number(ten[0]),
                list(&ten[1..4]),
                list(&ten[4..]),
            )
        })
        .collect();
    let armature: Vec<f64> = slots
        .iter()
        .map(|slot| slot.fitted.map_or(0.0, |joint| joint.armature))
        .collect();
    let effort = independent.iter().map(|i| rigid.joints()[*i].limit.effort);
    let limits: Vec<String> = effort
        .enumerate()
        .map(|(i, effort)| {
            let stated = effort.filter(|x| *x > 0.0 && *x < T::MAX.to_f64());
            let limit = stated.map_or(precision.max.to_string(), number);
            format!("    params->torque_limit[{i}] = {limit};")
        })
        .collect();
    let (mut rows, mut most) = (Vec::new(), 0.0_f64);
    for state in body.states() {
        most = state.torque.iter().fold(most, |most, x| most.max(x.abs()));
        let [q, v, a] = state.motion.each_ref().map(|x| list(x));
        rows.push(format!(
            "    {{ {q},\n      {v},\n      {a},\n      {} }}",
            list(&state.torque)
        ));
    }
    let relative = match precision.real == DOUBLE.real {
        true => DOUBLE_TOLERANCE,
        false => SINGLE_TORQUE,
    };
    fill.set("bodies", bodies.join(",\n"))
        .set("body_count", bodies.len().to_string())
        .set("armature", list(&armature))
        .set("base", list(&robot.gravity.map(|g| -g)))
        .set("limits", limits.join("\n"))
        .set("rows", rows.join(",\n"))
        .set("tolerance", number(relative * most));
}

/// A number that files of another robot do not share, for the preprocessor to compare.
fn stamp(robot: &Robot) -> String {
    let hash = Sha256::digest(format!("{robot:?}"));
    let head = hash.iter().take(4);
    let number = head.fold(0, |n, byte| n << 8 | u32::from(*byte));
    format!("0x{number:08x}u")
}
