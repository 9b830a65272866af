//! The library of machines as a terminal shows it.

use super::table::table;
use std::fmt::Write;
use std::path::Path;
use stiction_files::shell::quoted_path;
use stiction_number::{Percent, counted};
use stiction_workflows::library::{Library, Machine, MachineKind};

/// The machines side by side, and how one is taken out.
pub fn library(library: &Library) -> String {
    let head = ["machine", "kind", "law", "error", "usable", "licence"];
    let mut rows = vec![head.map(String::from).to_vec()];
    rows.extend(library.machines.iter().map(|own| {
        vec![
            own.name.clone(),
            own.kind.name().into(),
            own.found.law.clone(),
            error(own.found.held_out_error_percent),
            usable(own).into(),
            licence(own).into(),
        ]
    }));
    let mut out = table(&rows, &[false, false, false, true, false, false]);
    out.push_str("error: held-out, of the force; of a robot that of its worst joint\n");
    if let Some(own) = library.machines.first() {
        let _ = writeln!(
            out,
            "where one comes from:\nnext: stiction library {}",
            own.name
        );
    }
    out
}

/// Where a machine comes from, what was found, and how its files are written.
pub fn machine(machine: &Machine) -> String {
    let mut out = about(machine);
    let name = &machine.name;
    let _ = writeln!(
        out,
        "its files:\nnext: stiction library {name} --out {name}"
    );
    out
}

/// The same where its files were written into a folder.
pub fn machine_in(machine: &Machine, written: &[&str], dir: &Path) -> String {
    let mut out = about(machine);
    let folder = stiction_files::shell::shown(&stiction_files::shell::text(dir));
    let _ = writeln!(out, "written to {folder}: {}", written.join(", "));
    let [model, to] = [machine.model(), "mujoco"].map(|name| quoted_path(&dir.join(name)));
    let (what, urdf) = match &machine.urdf {
        Some(urdf) => {
            let name = urdf.rsplit('/').next().unwrap_or(urdf);
            let what = format!(
                "with {urdf} of the PyPI package example-robot-data; also urdf, isaaclab and others"
            );
            (what, format!(" --urdf {name}"))
        }
        None => (
            "a simulated joint; also c, ros2, urdf and others".into(),
            String::new(),
        ),
    };
    let _ = writeln!(
        out,
        "{what}:\nnext: stiction export {model} --target mujoco{urdf} --out {to}"
    );
    out
}

fn about(machine: &Machine) -> String {
    let found = &machine.found;
    let mut out = format!("{}\n", machine.title);
    let _ = writeln!(out, "source    {}", machine.source);
    let _ = writeln!(out, "licence   {}", machine.licence);
    let _ = writeln!(
        out,
        "command   {} (stiction {}, {})",
        machine.command, found.version, found.identified
    );
    let of = match machine.kind {
        MachineKind::Robot => "of the torque of each joint at most",
        MachineKind::Axis | MachineKind::Servo => "of the force",
    };
    let percent = error(found.held_out_error_percent);
    let _ = writeln!(
        out,
        "found     {}: held-out error {percent} {of}",
        found.law
    );
    let verdict = match machine.kind {
        MachineKind::Robot => "for feedforward  ",
        MachineKind::Axis | MachineKind::Servo => "for compensation  ",
    };
    let _ = match found.usable {
        true => writeln!(out, "{verdict}yes"),
        false => writeln!(out, "{verdict}no: {}", found.reasons.join("; ")),
    };
    let refused = found.joints.iter().filter(|joint| !joint.usable);
    let names: Vec<&str> = refused.map(|joint| joint.name.as_str()).collect();
    if !names.is_empty() {
        let all = counted(found.joints.len(), "joint");
        let _ = writeln!(
            out,
            "friction alone   may not compensate {} of {all}: {} (why: --json)",
            names.len(),
            names.join(", ")
        );
    }
    out
}

/// `yes` or `no`; of a robot with joints of both kinds `partly`.
fn usable(machine: &Machine) -> &'static str {
    let found = &machine.found;
    match (found.usable, found.joints.iter().all(|joint| joint.usable)) {
        (true, true) => "yes",
        (true, false) => "partly",
        (false, _) => "no",
    }
}

/// The name of the licence without its holder.
fn licence(machine: &Machine) -> &str {
    machine.licence.split(',').next().unwrap_or_default()
}

fn error(percent: f64) -> String {
    Percent::error(percent).digits(2)
}
