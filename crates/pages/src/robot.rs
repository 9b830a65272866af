//! Words and rows about a robot that reports and the terminal share.

use std::path::Path;
use stiction_files::robot::result::{BaseEntry, Estimated, JointEntry, RobotFile, RobotInput};
use stiction_files::shell::{free_folder, quoted, quoted_path, shown};
use stiction_number::{Percent, counted, plus_minus, quantity, sig, unit};
use stiction_policy::interval;

/// Most names of joints in a line.
const MOST_NAMES: usize = 3;

/// The logs that were fitted, or those that were validated on; `None` where there are none.
pub(crate) fn logs(result: &RobotFile, fitted: bool) -> Option<String> {
    let own = result.inputs.iter().filter(|input| input.fitted == fitted);
    let own: Vec<&RobotInput> = own.collect();
    let samples = own.iter().map(|input| input.samples).sum();
    Some(match own.as_slice() {
        [] => return None,
        [one] => format!(
            "{}{}: {} at {} Hz",
            shown(&one.path),
            part(one),
            counted(samples, "sample"),
            sig(one.rate_hz, 4)
        ),
        all => format!("{} logs: {}", all.len(), counted(samples, "sample")),
    })
}

/// The part of a log behind its name; empty for the whole.
pub(crate) fn part(input: &RobotInput) -> String {
    let part = input.part.as_ref();
    part.map_or_else(String::new, |part| format!(", {part}"))
}

/// Which joints were logged, and how their columns were found.
pub(crate) fn joints(result: &RobotFile) -> String {
    let names: Vec<&str> = result.joints.iter().map(|own| own.name.as_str()).collect();
    let named = match names.as_slice() {
        [first, .., last] if names.len() > MOST_NAMES => format!("{first} … {last}"),
        few => few.join(", "),
    };
    let is_named = |joint: &JointEntry| {
        let mut columns = joint.columns.iter();
        columns.all(|column| column.column.contains(&joint.name))
    };
    let by = match (result.joints.iter().all(is_named), &result.robot) {
        (true, _) => "columns by the names of the joints",
        (false, Some(_)) => "columns as in the robot file, or by their numbers",
        (false, None) => "columns by their numbers",
    };
    format!("{}: {named} ({by})", counted(names.len(), "joint"))
}

/// How many base parameters there are and are known, and which filters were used.
pub(crate) fn rigid_body(result: &RobotFile) -> String {
    let known = result.base.iter().filter(|own| is_known(own)).count();
    let filter = &result.conditioning;
    let torque = filter.torque_cutoff_hz.map_or_else(String::new, |hertz| {
        format!(
            "; torques were low-passed at {} before they were logged",
            quantity(hertz, "Hz")
        )
    });
    format!(
        "{known} of {} known to ± {}; low-pass {}{torque}",
        counted(result.base.len(), "base parameter"),
        Percent::deviation(100.0 * interval::MAX_HALF_WIDTH).short(),
        quantity(filter.common_cutoff_hz, "Hz"),
    )
}

/// Whether the interval of a base parameter is as narrow as that of a constant of an axis has to be.
pub(crate) fn is_known(own: &BaseEntry) -> bool {
    own.half_width <= interval::MAX_HALF_WIDTH * own.value.abs()
}

/// A value with half of its interval; `open` where the data do not determine it.
pub(crate) fn estimated(own: &Estimated) -> String {
    match own.half_width {
        _ if !own.identifiable => "open".into(),
        Some(half) => plus_minus(own.value, half),
        None => sig(own.value, 3),
    }
}

/// A value that is next to nothing beside its interval as 0.
pub(crate) fn rounded(value: f64, half: f64) -> f64 {
    /// Part of the interval from which a value has a digit.
    const LEAST: f64 = 1e-2;
    if value.abs() < LEAST * half {
        0.0
    } else {
        value
    }
}

/// The joints side by side: head and rows.
pub(crate) struct Joints {
    /// Titles, and whether numbers stand below.
    pub head: Vec<(&'static str, bool)>,
    /// A row for each joint.
    pub rows: Vec<Vec<String>>,
}

impl Joints {
    /// Those of a robot.
    pub fn of(result: &RobotFile) -> Self {
        let fits = || result.joints.iter().filter_map(|joint| joint.fit.as_ref());
        let has_load = fits().any(|fit| fit.load.is_some());
        let mut head = vec![
            ("joint", false),
            ("law", false),
            ("unit", false),
            ("Fc", true),
            ("viscous", true),
        ];
        head.extend(has_load.then_some(("load", true)));
        head.extend([
            ("armature", true),
            ("error", true),
            ("of torque", true),
            ("usable", false),
        ]);
        let row = |joint: &JointEntry| {
            let mut cells = vec![joint.name.clone()];
            let Some(fit) = &joint.fit else {
                cells.resize(head.len() - 1, "-".into());
                cells.push("not fitted".into());
                return cells;
            };
            let one = |own: &Option<Estimated>| own.as_ref().map_or("-".into(), estimated);
            cells.extend([
                match fit.asymmetric {
                    true => format!("{} ±", fit.law),
                    false => fit.law.clone(),
                },
                unit(&joint.unit),
                one(&fit.coulomb),
                one(&fit.viscous),
            ]);
            cells.extend(has_load.then(|| one(&fit.load)));
            cells.extend([
                estimated(&fit.armature),
                sig(fit.held_out_rms, 3),
                Percent::error(100.0 * fit.held_out_rms / fit.torque_rms).decimals(0),
                if fit.trustworthy { "yes" } else { "no" }.into(),
            ]);
            cells
        };
        let rows = result.joints.iter().map(row).collect();
        Self { head, rows }
    }

    /// What the columns are.
    pub fn caption(result: &RobotFile) -> String {
        let mut fits = result.joints.iter().filter_map(|joint| joint.fit.as_ref());
        let on = match fits.next().map(|fit| fit.judged_on.as_str()) {
            Some("validation") => "on the validation data",
            Some("held-out") => "on blocks that were not fitted",
            _ => "on the fitted samples",
        };
        format!(
            "Half widths of 95 % intervals; ± behind a law: parameters of each direction, whose means are shown. Error: root mean square \
             of what the model leaves of the torque {on}, beside the root mean square of that torque."
        )
    }
}

/// What is to be done next, and the command that does it, with the model in a folder.
pub(crate) fn next(result: &RobotFile, dir: &Path) -> (&'static str, String) {
    if result.trust.trustworthy {
        let (model, out) = (dir.join("robot.toml"), dir.join("urdf"));
        let command = format!(
            "stiction export {} --target urdf --out {}",
            quoted_path(&model),
            quoted_path(&out)
        );
        return (
            "the URDF with what was identified; also mujoco, isaaclab, newton, bam, domain-json, ros2 and c",
            command,
        );
    }
    let log = result
        .inputs
        .first()
        .map_or("", |input| input.path.as_str());
    let ending = Path::new(log)
        .extension()
        .map_or("csv".into(), |end| end.to_string_lossy());
    let axis = result.robot.as_ref();
    let axis = axis.map_or_else(String::new, |file| {
        format!(" --axis {}", quoted(&file.path))
    });
    let out = match dir.file_name() {
        Some(name) => dir.with_file_name(format!("{}-again", name.to_string_lossy())),
        None => "again".into(),
    };
    let command = format!(
        "stiction robot {} --urdf {}{axis} --out {}",
        quoted(&format!("another.{ending}")),
        quoted(&result.urdf.path),
        quoted_path(&free_folder(&out))
    );
    (
        "record a motion of all joints at once through their range, both ways and at several speeds, then",
        command,
    )
}
