//! A robot as a terminal shows it: what was read, the joints side by side, whether the model may be used.

use super::{first_sentence, table::table};
use crate::robot::{Joints, estimated, joints, logs, next, rigid_body, rounded};
use std::fmt::Write;
use std::path::Path;
use stiction_files::Warning;
use stiction_files::robot::result::{JointEntry, RobotFile};
use stiction_files::shell::shown;
use stiction_number::{Percent, counted, plus_minus, sig, unit};
use stiction_workflows::robot::RobotOutcome;

/// Most warnings, and most reasons of a verdict, that are shown in short.
const MOST: usize = 3;

/// The outcome in short: what [`robot_in_full`] says in full.
pub fn robot(outcome: &RobotOutcome) -> String {
    let result = &outcome.result;
    let mut out = read(result);
    out.push_str(&side_by_side(result));
    out.push_str(&verdict(result, MOST));
    let line = |warning: &Warning| {
        let said = first_sentence(&warning.message);
        format!("warning [{}] {said}", warning.code)
    };
    // What says no more than what was done is for the long form.
    let all = result.warnings.iter().filter(|own| !own.is_note());
    let all: Vec<String> = all.map(line).collect();
    out.push_str(&some(all.into_iter(), MOST, "warning"));
    out
}

/// The outcome in full: columns, parameters of the rigid body, bodies, and what is to be said of each joint.
pub fn robot_in_full(outcome: &RobotOutcome) -> String {
    let result = &outcome.result;
    let mut out = read(result);
    out.push_str("\ncolumns\n");
    out.push_str(&columns(result));
    out.push_str("\njoints\n");
    out.push_str(&side_by_side(result));
    out.push_str(&simulators(result));
    out.push_str("\nbase parameters\n");
    out.push_str(&base(result));
    out.push_str("\nbodies\n");
    out.push_str(&bodies(result));
    for joint in &outcome.joints {
        out.push_str(&of_joint(joint.name.as_str(), outcome));
    }
    for warning in &result.warnings {
        let _ = writeln!(out, "\nwarning [{}] {}", warning.code, warning.message);
    }
    out.push('\n');
    out.push_str(&verdict(result, usize::MAX));
    out
}

/// What to do next with the result in a folder.
pub fn robot_next(result: &RobotFile, dir: &Path) -> String {
    let (what, command) = next(result, dir);
    format!("{what}\nnext: {command}\n")
}

fn read(result: &RobotFile) -> String {
    let mut out = String::new();
    if let Some(logs) = logs(result, true) {
        let _ = writeln!(out, "{logs}");
    }
    if let Some(logs) = logs(result, false) {
        let _ = writeln!(out, "validation  {logs}");
    }
    let _ = writeln!(out, "{}", joints(result));
    let _ = writeln!(out, "rigid body  {}", rigid_body(result));
    out
}

fn side_by_side(result: &RobotFile) -> String {
    let Joints { head, rows } = Joints::of(result);
    let right: Vec<bool> = head.iter().map(|(_, right)| *right).collect();
    let head = head.iter().map(|(title, _)| title.to_string()).collect();
    let all: Vec<Vec<String>> = std::iter::once(head).chain(rows).collect();
    table(&all, &right)
}

fn verdict(result: &RobotFile, most: usize) -> String {
    if result.trust.trustworthy {
        let fits = result.joints.iter().filter_map(|joint| joint.fit.as_ref());
        let left = fits.clone().map(|fit| fit.held_out_rms / fit.torque_rms);
        let alone = fits.clone().filter(|fit| fit.compensates).count();
        let all = fits.count();
        let mut out = format!(
            "for feedforward  yes: error at most {} of the torque ({})\n",
            Percent::error(100.0 * left.fold(0.0, f64::max)).decimals(0),
            counted(all, "joint")
        );
        if alone < all {
            let _ = writeln!(
                out,
                "friction alone   may compensate {alone} of {}: --verbose says why",
                counted(all, "joint")
            );
        }
        return out;
    }
    let line = |reason: &String| match most {
        usize::MAX => format!("for feedforward  no: {reason}"),
        _ => format!("for feedforward  no: {}", first_sentence(reason)),
    };
    some(result.trust.reasons.iter().map(line), most, "reason")
}

/// The first lines, and how many more there are.
fn some(lines: impl ExactSizeIterator<Item = String>, most: usize, noun: &str) -> String {
    let more = lines.len().saturating_sub(most);
    let mut out: String = lines.take(most).map(|line| shown(&line) + "\n").collect();
    if more > 0 {
        let _ = writeln!(out, "{}: --verbose", counted(more, &format!("more {noun}")));
    }
    out
}

fn columns(result: &RobotFile) -> String {
    let mut rows = vec![
        ["joint", "role", "column", "read as"]
            .map(String::from)
            .to_vec(),
    ];
    for joint in &result.joints {
        for column in &joint.columns {
            rows.push(vec![
                joint.name.clone(),
                column.role.clone(),
                column.column.clone(),
                column.unit.clone(),
            ]);
        }
    }
    table(&rows, &[false; 4])
}

/// Coulomb and viscous friction with the armature, as simulators take them.
fn simulators(result: &RobotFile) -> String {
    let mut out = String::new();
    for joint in &result.joints {
        let Some(fit) = &joint.fit else { continue };
        if let Some([friction, damping]) = &fit.simulators {
            let _ = writeln!(
                out,
                "simulators  {}: Coulomb {}, viscous {}, armature {}",
                shown(&joint.name),
                plus_minus(friction.value, friction.repeat),
                plus_minus(damping.value, damping.repeat),
                estimated(&fit.armature)
            );
        }
    }
    out
}

fn base(result: &RobotFile) -> String {
    let head = ["value", "unit", "URDF", "parameters"];
    let mut rows = vec![head.map(String::from).to_vec()];
    rows.extend(result.base.iter().map(|own| {
        vec![
            plus_minus(rounded(own.value, own.half_width), own.half_width),
            unit(&own.unit),
            sig(rounded(own.urdf, own.half_width), 3),
            own.name.clone(),
        ]
    }));
    table(&rows, &[true, false, true, false])
}

fn bodies(result: &RobotFile) -> String {
    let head = ["link", "mass [kg]", "URDF", "centre [m]", "", ""];
    let mut rows = vec![head.map(String::from).to_vec()];
    rows.extend(result.bodies.iter().map(|body| {
        let [x, y, z] = body.center.map(|c| sig(c, 3));
        let (mass, before) = (sig(body.mass, 4), sig(body.urdf_mass, 4));
        vec![body.link.clone(), mass, before, x, y, z]
    }));
    table(&rows, &[false, true, true, true, true, true])
}

/// What is to be said of a joint alone: why its law may not compensate by itself, and its warnings.
fn of_joint(name: &str, outcome: &RobotOutcome) -> String {
    let entry = outcome.result.joints.iter().find(|own| own.name == name);
    let own = outcome.joints.iter().find(|own| own.name == name);
    let mut out = String::new();
    if let Some(JointEntry { fit: Some(fit), .. }) = entry {
        let _ = writeln!(
            out,
            "\n{}: {} of torque when fitted, error of the rigid body {}",
            shown(name),
            Percent::error(100.0 * fit.fit_rms / fit.torque_rms).digits(2),
            sig(fit.rigid_deviation, 2)
        );
        let said = match fit.compensates {
            true => "  for compensation  yes\n".into(),
            false => format!("  for compensation  no: {}\n", fit.reasons.join("; ")),
        };
        out.push_str(&said);
    }
    if let Some(Ok(own)) = own.map(|own| &own.outcome) {
        for warning in &own.result.warnings {
            let _ = writeln!(out, "  warning [{}] {}", warning.code, warning.message);
        }
    }
    out
}
