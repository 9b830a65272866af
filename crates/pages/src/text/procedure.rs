//! What the procedures found, for a terminal.

use super::table::table;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use stiction_files::result::{
    BreakAwayEntry, PreslidingStepEntry, ResultFile, StaticMapEntry, TwoStepEntry,
};
use stiction_files::shell::quoted_path;
use stiction_files::symbols;
use stiction_number::{Percent, four_digits as short, unit};

/// A section for each procedure that was used.
pub(super) fn sections(result: &ResultFile) -> String {
    let mut out = String::new();
    if let Some(map) = &result.static_map {
        out.push_str(&static_map(map));
    }
    if let Some(entry) = &result.static_then_dynamic {
        out.push_str(&two_step(entry));
    }
    if let Some(entry) = &result.presliding_step {
        out.push_str(&presliding_step(entry, result));
    }
    if !result.break_away.is_empty() {
        out.push_str(&break_away(
            &result.break_away,
            &unit(&result.axis.force_unit),
            match result.axis.kind.as_str() {
                "rotary" => "rad",
                _ => "m",
            },
        ));
    }
    out
}

fn cells<const N: usize>(cells: [&str; N]) -> Vec<String> {
    cells.map(String::from).to_vec()
}

fn static_map(map: &StaticMapEntry) -> String {
    let (v, f) = (unit(&map.velocity_unit), unit(&map.force_unit));
    let mut rows = vec![vec![
        format!("velocity {v}"),
        format!("force {f}"),
        "std".into(),
        "map".into(),
        "samples".into(),
        String::new(),
    ]];
    for p in &map.points {
        rows.push(vec![
            short(p.velocity),
            short(p.force),
            short(p.force_std),
            short(p.model),
            p.samples.to_string(),
            if p.weight < 0.1 {
                "left out".into()
            } else {
                String::new()
            },
        ]);
    }
    let mut out = format!(
        "\nstatic map, {} constant velocities, scatter beyond their standard errors {} {f}\n",
        map.points.len(),
        short(map.scatter)
    );
    out.push_str(&table(&rows, &[true, true, true, true, true, false]));
    out
}

fn two_step(entry: &TwoStepEntry) -> String {
    let mut rows = vec![cells([
        "parameter",
        "two steps",
        "std",
        "joint",
        "std",
        "apart, std of joint",
    ])];
    let std = |std: Option<f64>| std.map_or("-".into(), short);
    for p in &entry.parameters {
        rows.push(vec![
            p.name.clone(),
            short(p.value),
            std(p.std),
            short(p.joint),
            std(p.joint_std),
            p.difference_in_std
                .map_or("-".into(), |d| format!("{d:+.1}")),
        ]);
    }
    let mut out = format!(
        "\nstatic parameters first (from the {}), against all at once\n",
        entry.statics
    );
    out.push_str(&table(&rows, &[false, true, true, true, true, true]));
    for line in &entry.explanation {
        let _ = writeln!(out, "{line}");
    }
    out
}

fn presliding_step(entry: &PreslidingStepEntry, result: &ResultFile) -> String {
    let value = |name: &str| {
        let found = result.parameters.iter().find(|p| p.name == name);
        found.map_or("-".into(), |p| short(p.value))
    };
    let mut rows = vec![cells([
        "",
        "step",
        "overshoot",
        "zeta",
        "sigma0",
        "",
        "sigma1",
        "",
    ])];
    let percent = |x: Option<f64>| x.map_or(String::new(), |x| Percent::error(x).signed(1));
    for p in &entry.published {
        rows.push(vec![
            format!("inverted, {}", p.path),
            format!("{} {}", short(p.height), unit(&entry.force_unit)),
            p.overshoot
                .map_or("none".into(), |x| Percent::error(100.0 * x).decimals(1)),
            p.damping_ratio.map_or("-".into(), short),
            short(p.sigma0),
            percent(Some(p.sigma0_off_percent)),
            p.sigma1.map_or("refused".into(), short),
            percent(p.sigma1_off_percent),
        ]);
    }
    rows.push(vec![
        "simulated (used)".into(),
        String::new(),
        String::new(),
        short(entry.damping_ratio),
        value("sigma0"),
        String::new(),
        value("sigma1"),
        String::new(),
    ]);
    let mut out = String::from(
        "\npresliding steps: the published inversion takes the bristles for linear; used is the fit by \
         simulation\n",
    );
    out.push_str(&table(
        &rows,
        &[false, true, true, true, true, true, true, true],
    ));
    let _ = writeln!(
        out,
        "delay of the position against the force {} s, {}",
        short(entry.delay_s),
        match entry.delay_std_s {
            Some(std) => format!("std {} s", short(std)),
            None => "the end of its range".into(),
        }
    );
    out
}

fn break_away(runs: &[BreakAwayEntry], unit: &str, length: &str) -> String {
    let mut rows = vec![vec![
        "break-away".to_string(),
        format!("rate {unit}/s"),
        format!("force {unit}"),
        "friction".into(),
        "predicted".into(),
        format!("after {length}"),
        String::new(),
    ]];
    for run in runs {
        rows.push(vec![
            run.path.clone(),
            short(run.rate),
            short(run.force),
            run.friction.map_or("-".into(), short),
            run.predicted_friction_there.map_or("-".into(), short),
            short(run.displacement),
            slips(run.slips),
        ]);
    }
    let offset = runs.iter().map(|run| run.offset).fold(0.0, |_, own| own);
    let friction = match (runs.iter().any(|run| run.friction.is_some()), offset != 0.0) {
        (false, _) => "force: what the drive gives, mass times acceleration and constant force included; their mass is not known\n".into(),
        (true, false) => "friction: the force of the drive less mass times acceleration\n".to_string(),
        (true, true) => format!(
            "friction: the force of the drive less mass times acceleration and less the offset, {} {unit}\n",
            short(offset)
        ),
    };
    format!(
        "\n{}{friction}",
        table(&rows, &[false, true, true, true, true, true, false])
    )
}

/// What is said of an axis that stuck again after it had broken away.
fn slips(count: usize) -> String {
    match count {
        0 => String::new(),
        1 => "sticks again after one slip".into(),
        n => format!("stick-slip, {n} slips"),
    }
}

/// What to type for each of the logs that the demo wrote for the procedures, and the parameters to find.
pub fn procedure_commands(dir: &Path, written: &[PathBuf], truth: &[(String, f64)]) -> String {
    let mut out = String::new();
    for path in written {
        let _ = writeln!(out, "{}", path.display());
    }
    let d = dir.display();
    let _ = write!(
        out,
        "
the steady curve from constant velocities
  stiction identify {d}/speeds.csv --method static --out {d}/static
the same, then stiffness and micro-damping from motion, beside the joint fit
  stiction identify {d}/motion.csv --method static-then-dynamic --static {d}/speeds.csv --out {d}/dynamic
stiffness and micro-damping from force steps, with the curve and mass of that model
  stiction identify {d}/step_1.csv {d}/step_2.csv --method presliding-step --model {d}/dynamic/model.toml --out {d}/step
break-away at several rates, beside what the model predicts
  stiction identify {d}/speeds.csv --method static --model {d}/dynamic/model.toml --break-away {d}/ramp_1.csv {d}/ramp_2.csv {d}/ramp_3.csv --out {d}/break-away

the truth: {}
",
        parameters(truth),
    );
    out
}

/// What to type for the log of a planned motion on the axis of the demo, and the parameters to find.
pub fn planned_log(plan: &Path, log: &Path, truth: &[(String, f64)]) -> String {
    format!(
        "{}\n\nthe truth: {}\n\nwhat it shows, beside what was expected:\nnext: stiction identify {} --plan {} --out {}\n",
        log.display(),
        parameters(truth),
        quoted_path(log),
        quoted_path(plan),
        quoted_path(&log.with_file_name("identified")),
    )
}

fn parameters(truth: &[(String, f64)]) -> String {
    let list: Vec<String> = truth
        .iter()
        .map(|(name, value)| format!("{} {}", symbols::symbol(name), short(*value)))
        .collect();
    list.join(", ")
}
