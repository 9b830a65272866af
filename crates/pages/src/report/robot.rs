//! The report of a robot: the torque of each joint and what it is made of, then joint by joint.

use super::callout;
use super::{figures, tables};
use crate::robot::{Joints, joints, logs, next, part, rigid_body, rounded};
use std::path::Path;
use stiction_files::robot::result::{JointEntry, RobotFile};
use stiction_number::counted;
use stiction_report::{
    Align, Axis, Block, Callout, Color, Document, Figure, Layer, Panel, Severity, Table, Text,
    number,
};
use stiction_workflows::identify::Outcome;
use stiction_workflows::robot::{JointOutcome, RobotOutcome};

/// Most of a torque that is drawn, s: reversals are to be seen in a figure of half the width.
const MOST_SECONDS: f64 = 30.0;

/// The report of a robot whose files go into a folder.
pub fn robot(outcome: &RobotOutcome, folder: &Path) -> Document {
    let result = &outcome.result;
    let mut document = Document::new(format!("Robot {}", result.name))
        .subtitle(joints(result))
        .footer(format!(
            "stiction {} · seed {}",
            result.version, result.seed
        ))
        .block(verdict(result))
        .paragraph(next_step(result, folder));
    let torques: Vec<Block> = outcome
        .joints
        .iter()
        .filter_map(|joint| Some(torque(joint)?.into()))
        .collect();
    document = document
        .heading(2, "Torque of each joint")
        .paragraph(
            "The measured torque is that of the rigid body (gravity, inertia of the links), that of friction and rotor, and the residual.",
        )
        .block(Block::Columns(torques))
        .heading(2, "Joints")
        .block(side_by_side(result));
    if !result.warnings.is_empty() {
        document = document.heading(2, "Warnings");
    }
    for warning in &result.warnings {
        document = document.block(callout(warning));
    }
    document = document
        .heading(2, "Rigid body")
        .paragraph(format!("{}.", rigid_body(result)))
        .block(bodies(result))
        .block(base(result));
    for joint in &outcome.joints {
        document = alone(document, joint, result);
    }
    document = document.heading(2, "What was read");
    let names = [(true, "Fitted"), (false, "Validated on")];
    let mut facts: Vec<(Text, Text)> = names
        .into_iter()
        .filter_map(|(fitted, name)| Some((name.into(), logs(result, fitted)?.into())))
        .collect();
    let files = result.inputs.iter();
    let files = files.map(|input| (format!("{}{}", input.path, part(input)), &input.sha256));
    let urdf = (result.urdf.path.clone(), &result.urdf.sha256);
    facts.extend(
        files
            .chain([urdf])
            .map(|(path, sha256)| (path.into(), Text::from("SHA-256 ").code(sha256.as_str()))),
    );
    document.block(Block::Facts(facts))
}

fn verdict(result: &RobotFile) -> Callout {
    let (severity, text) = match result.trust.trustworthy {
        true => (
            Severity::Good,
            "May be used as a feedforward and in simulators, on motion like that of the logs."
                .into(),
        ),
        false => (
            Severity::Error,
            format!(
                "Not to be used as it is: {}.",
                result.trust.reasons.join("; ")
            ),
        ),
    };
    Callout {
        severity,
        code: String::new(),
        text: Text::of_message(&text),
        link: String::new(),
    }
}

fn next_step(result: &RobotFile, folder: &Path) -> Text {
    let (what, command) = next(result, folder);
    Text::from(format!("Next: {what}: ")).code(command)
}

/// The beginning of the measured torque with its parts, on samples that were not fitted where there are such.
fn torque(joint: &JointOutcome) -> Option<Figure> {
    let outcome = joint.outcome.as_ref().ok()?;
    let held_out = outcome.validation.first().zip(joint.rigid_held_out.first());
    let (series, rigid, on) = match held_out {
        Some(((_, series), rigid)) => (series, rigid, "held-out"),
        None => (&outcome.law().series, &joint.rigid, "fitted"),
    };
    let clock = figures::clock(series);
    let end = clock.first().map_or(0.0, |first| first + MOST_SECONDS);
    let shown = clock.partition_point(|t| *t <= end).min(rigid.len());
    let holes = &figures::breaks(series)[..shown];
    let time = figures::broken(&clock[..shown], holes);
    let line = |values: &[f64]| {
        let values = &values[..shown.min(values.len())];
        Layer::line(time.clone(), figures::broken(values, holes))
    };
    let measured = series.measured.iter().zip(rigid);
    let measured: Vec<f64> = measured.map(|(rest, rigid)| rest + rigid).collect();
    let axis = || Axis::new("Time", "s");
    let parts = Panel::new(axis(), figures::force_axis(outcome))
        .layer(line(&measured).color(Color::Grey).label("Measured"))
        .layer(line(rigid).color(Color::Green).label("Rigid body"))
        .layer(line(&series.model).color(Color::Blue).label("Friction"))
        .height(170.0);
    let left = Panel::new(axis(), Axis::new("Residual", outcome.force_unit.as_str()))
        .layer(line(&series.residual()).color(Color::Vermilion))
        .height(80.0);
    let figure = Figure::new(format!("{}, {on} samples", joint.name));
    Some(figure.panel(parts).panel(left).shared_x().half())
}

fn side_by_side(result: &RobotFile) -> Table {
    let Joints { head, rows } = Joints::of(result);
    let align = |right| if right { Align::Right } else { Align::Left };
    let head = head.into_iter().map(|(title, right)| (title, align(right)));
    let mut table = Table::new(head).caption(Joints::caption(result));
    for (joint, row) in result.joints.iter().zip(rows) {
        table = match &joint.fit {
            Some(fit) if !fit.trustworthy => table.marked(Severity::Error, row),
            _ => table.row(row),
        };
    }
    table
}

fn bodies(result: &RobotFile) -> Table {
    let mut table = Table::new([
        ("Link", Align::Left),
        ("Mass, kg", Align::Right),
        ("URDF", Align::Right),
        ("Centre x, m", Align::Right),
        ("y", Align::Right),
        ("z", Align::Right),
    ])
    .caption(
        "Physically possible inertias nearest to the log. What the motion does not show is as in the URDF; the torque depends on the base \
         parameters below.",
    );
    for body in &result.bodies {
        let [x, y, z] = body.center.map(|c| number::sig(c, 3));
        let masses = [body.mass, body.urdf_mass].map(|mass| number::sig(mass, 4));
        let [mass, before] = masses;
        table = table.row([body.link.clone(), mass, before, x, y, z]);
    }
    table
}

fn base(result: &RobotFile) -> Block {
    let mut table = Table::new([
        ("Parameters", Align::Left),
        ("Value", Align::Right),
        ("Unit", Align::Left),
        ("URDF", Align::Right),
    ])
    .caption("Sums of inertial parameters that motion can determine, with half widths of 95 % intervals. Marked: the URDF is outside the interval.");
    for own in &result.base {
        let cells = [
            own.name.clone(),
            number::plus_minus(rounded(own.value, own.half_width), own.half_width),
            number::unit(&own.unit),
            number::sig(rounded(own.urdf, own.half_width), 3),
        ];
        table = match (own.value - own.urdf).abs() <= own.half_width {
            true => table.row(cells),
            false => table.marked(Severity::Warning, cells),
        };
    }
    let title = format!(
        "{}, with their values in the URDF",
        counted(result.base.len(), "base parameter")
    );
    Block::Details(title.into(), vec![table.into()])
}

/// A joint by itself, as an axis.
fn alone(document: Document, joint: &JointOutcome, result: &RobotFile) -> Document {
    let document = document.heading(2, joint.name.as_str());
    let outcome = match &joint.outcome {
        Ok(outcome) => outcome,
        Err(error) => return document.paragraph(format!("Not fitted: {error}.")),
    };
    let entry = result.joints.iter().find(|own| own.name == joint.name);
    let mut document = document
        .paragraph(columns(entry))
        .block(figures::velocity_map(outcome));
    let close: Vec<Block> = close(outcome).into_iter().map(Block::from).collect();
    if !close.is_empty() {
        document = document.block(Block::Columns(close));
    }
    document = document.block(tables::parameters(outcome));
    if !outcome.result.laws.is_empty() {
        let laws = tables::laws(outcome);
        document = document.block(Block::Details("Which law".into(), vec![laws.into()]));
    }
    document
}

/// The figures of an axis that show a part of the motion.
fn close(outcome: &Outcome) -> Vec<Figure> {
    let all = [
        figures::friction_curve(outcome),
        figures::presliding(outcome),
        figures::residual_over_position(outcome),
    ];
    all.into_iter().flatten().collect()
}

fn columns(entry: Option<&JointEntry>) -> String {
    let columns = entry.iter().flat_map(|own| &own.columns);
    let said: Vec<String> = columns
        .map(|own| format!("{}: {} ({})", own.role, own.column, number::unit(&own.unit)))
        .collect();
    format!("{}.", said.join("; "))
}
