//! What is said after an export.

use std::fmt::Write;
use std::path::Path;
use stiction_number::{Percent, four_digits as short};
use stiction_workflows::export::{Exported, ExportedRobot, Platform, Reserve};

/// The files of an export, what it assumed, and what to know before it runs.
pub fn exported(exported: &Exported, dir: &Path) -> String {
    let mut out = String::new();
    for warning in &exported.warnings {
        let _ = writeln!(out, "warning [{}]: {}", warning.code, warning.message);
    }
    let unit = match exported.force_unit.as_str() {
        "1" => "(1 is 100 %)",
        typed => &stiction_number::unit(typed),
    };
    let most = format!("force at most {} {unit}", short(exported.limit));
    let what = match exported.target {
        "mujoco" => format!("for a time step of {} s", exported.cycle_time),
        "urdf" | "sdf" | "isaaclab" | "newton" | "bam" => "as friction of a joint".into(),
        "domain-json" => "as numbers with ranges".into(),
        "modelica" => "as friction between two flanges".into(),
        "tf5200" => format!("with {most}"),
        "drive-table" => "as numbers of drives".into(),
        "cogging-map" => "for its cogging alone".into(),
        "backlash" => "for its backlash alone".into(),
        _ => format!("for a cycle of {} s, {most}", exported.cycle_time),
    };
    let named = match exported.named_after_log {
        true => ", named after its log (--name gives another),",
        false => "",
    };
    let _ = writeln!(
        out,
        "{} compensator `{}`{named} {what}; put into operation as in docs/deploy/{}.md",
        exported.law, exported.name, exported.target
    );
    let _ = writeln!(
        out,
        "written to {}: {}",
        dir.display(),
        listed(&exported.written).join(", ")
    );
    if let Some(reserve) = exported.reserve {
        let _ = writeln!(out, "{}", whole(&reserve, exported.target));
    }
    if exported.target == "fmu" {
        let _ = writeln!(out, "{}", binaries(&exported.binaries));
    }
    out
}

/// The files of a robot, the law of each joint, and what to know before they run.
pub fn exported_robot(exported: &ExportedRobot, dir: &Path) -> String {
    let mut out = String::new();
    for warning in &exported.warnings {
        let _ = writeln!(out, "warning [{}]: {}", warning.code, warning.message);
    }
    let is_code = matches!(exported.target, "c" | "ros2");
    for joint in &exported.joints {
        let _ = write!(out, "joint {}: {}", joint.joint, joint.law);
        let _ = match is_code {
            true => writeln!(
                out,
                ", at most {} {}",
                short(joint.limit),
                stiction_number::unit(&joint.force_unit)
            ),
            false => writeln!(out),
        };
    }
    let cycle = match is_code {
        true => format!(" for a cycle of {} s", exported.cycle_time),
        false => String::new(),
    };
    let _ = writeln!(
        out,
        "{} joints of `{}`{cycle}; put into operation as in docs/deploy/{}.md",
        exported.joints.len(),
        exported.name,
        exported.target
    );
    let _ = writeln!(
        out,
        "written to {}: {}",
        dir.display(),
        listed(&exported.written).join(", ")
    );
    out
}

/// What a gain with a margin leaves, and the step after it has run well.
fn whole(reserve: &Reserve, target: &str) -> String {
    let adapt = match target {
        "tf5200" => "",
        _ => ", or --adapt where friction changes",
    };
    format!(
        "a gain of {} leaves {} of the friction, and the levels of friction are known within {}: where it runs well, export again with \
         --gain 1{adapt}",
        reserve.gain,
        Percent::error(100.0 * (1.0 - reserve.gain)).short(),
        Percent::error(reserve.known_within_percent).digits(2)
    )
}

/// Which platforms an FMU runs on as it is, and what is needed for the others.
fn binaries(inside: &[Platform]) -> String {
    let names: Vec<&str> = inside.iter().map(|platform| platform.name()).collect();
    let has = match names.as_slice() {
        [] => "no binary inside".into(),
        names => format!("binaries inside for {}", names.join(", ")),
    };
    let lacks = Platform::ALL.into_iter().filter(|p| !inside.contains(p));
    let lacks = lacks.map(|p| format!("{} ({})", p.name(), p.gcc()));
    match lacks.collect::<Vec<_>>().as_slice() {
        [] => has,
        lacks => format!(
            "{has}; with the compiler on the PATH when exporting also for {}",
            lacks.join(", ")
        ),
    }
}

/// More files than this in a folder are counted, not named.
const NAMED: usize = 8;

/// The files, a folder with many as one.
fn listed(paths: &[String]) -> Vec<String> {
    let mut list: Vec<String> = Vec::new();
    for path in paths {
        let folder = path.split_once('/').map(|(folder, _)| format!("{folder}/"));
        let inside = |folder: &String| paths.iter().filter(|p| p.starts_with(folder)).count();
        let entry = match folder.map(|folder| (inside(&folder), folder)) {
            Some((count, folder)) if count > NAMED => format!("{folder} ({count} files)"),
            _ => path.clone(),
        };
        if !list.contains(&entry) {
            list.push(entry);
        }
    }
    list
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_folder_with_many_files_is_one() {
        let paths = |folder: &str, n| {
            (0..n)
                .map(move |k| format!("{folder}/{k}.rs"))
                .collect::<Vec<_>>()
        };
        let all = [vec!["a.toml".into()], paths("src", 2), paths("law", 9)].concat();
        assert_eq!(
            super::listed(&all),
            ["a.toml", "src/0.rs", "src/1.rs", "law/ (9 files)"]
        );
    }
}
