//! A planned motion as a terminal shows it.

use super::table::table;
use crate::next::argument;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use stiction_files::plan::PlanFile;
use stiction_files::shell::{quoted, quoted_path, text};
use stiction_number::{Percent, four_digits as short, unit};
use stiction_policy::interval;
use stiction_workflows::plan::{Known, Planned};

/// The interval above which a parameter is said to stay open on some axes, percent.
const OPEN: f64 = 20.0;

/// What was planned, what its log can be expected to show, and what to type next. `written` is the folder of the set points.
pub fn planned(planned: &Planned, axis: &Path, written: &Path) -> String {
    let file = &planned.file;
    let mut out = format!(
        "{} s from rest to rest in {} pieces, {}; pieces simulated on {} axes that {} allows, the whole on {} others\n",
        short(file.duration),
        file.atom.len(),
        match file.motion.as_str() {
            "designed" => "designed".to_string(),
            other => format!("{other}: nothing designed was better"),
        },
        file.axes[0],
        planned.given.known_by(),
        file.axes[1],
    );
    if !file.assumed.is_empty() {
        out.push_str("\nassumed, since the axis file does not give them:\n");
        for assumed in &file.assumed {
            let with = match assumed.unit.as_str() {
                "1" => String::new(),
                name => format!(" {}", unit(name)),
            };
            let _ = writeln!(out, "    {} = {}{with}", assumed.key, short(assumed.value));
        }
    }
    for warning in &file.warning {
        let _ = writeln!(out, "\nwarning [{}] {}", warning.code, warning.message);
    }
    out.push_str(&expected(file));
    out.push_str(&wanted(planned, axis, written));
    out.push_str(&beside(file));
    out.push_str(&largest(planned));
    let folder = |name: &str| quoted_path(&written.join(name));
    let others = planned.carried.iter().filter(|file| !file.note.is_empty());
    for (k, file) in others.enumerate() {
        let head = if k == 0 { "\nfor a controller:\n" } else { "" };
        let _ = writeln!(
            out,
            "{head}    {}: {}",
            folder(file.carrier.file()),
            file.note
        );
    }
    let [low, high] = file.limits.stroke;
    let [least, most] = file.largest.position;
    let length = units(file)[0];
    let _ = writeln!(
        out,
        "\nbring the axis {}to where it may go {} {length} to negative and {} {length} to positive positions, of which the motion takes {} and \
         {}; run {} first at 30 % override and look, then at 100 %, and record time, position and force at {} Hz, as {}; then\nnext: {}",
        start(planned),
        short(-low),
        short(high),
        short((-least).max(0.0)),
        short(most.max(0.0)),
        folder("setpoints.csv"),
        short(file.rig.rate),
        recorded(planned),
        next(planned, axis, written),
    );
    out
}

/// Where the axis has to stand, where set points count from there.
pub(crate) fn start(planned: &Planned) -> String {
    let (start, length) = (planned.given.start, units(&planned.file)[0]);
    match planned.options.start {
        Some(_) => format!(
            "to position {} {length}, from which set points count, and ",
            short(start)
        ),
        None => String::new(),
    }
}

/// What the motion is recorded as, another file than the one that is there.
fn recorded(planned: &Planned) -> &'static str {
    match &planned.options.known {
        Some(Known::Log(log)) if log == Path::new("LOG.csv") => "LOG2.csv",
        _ => "LOG.csv",
    }
}

/// The command for the log of the motion.
fn next(planned: &Planned, axis: &Path, written: &Path) -> String {
    let typed = quoted_path;
    let axis = typed(axis);
    let first = match &planned.options.known {
        Some(Known::Log(log)) => format!("{} ", typed(log)),
        _ => String::new(),
    };
    let log = recorded(planned);
    let [sides, law] = sides(&planned.file);
    if planned.options.probe {
        let out = quoted(&format!(
            "{}-2",
            text(&written.components().collect::<PathBuf>())
        ));
        let options = format!("{}{}", wishes(planned), carried_on(planned));
        return format!("stiction plan {axis} --log {log}{sides}{options} --out {out}");
    }
    let [plan, out] = ["plan.toml", "identified"].map(|name| typed(&written.join(name)));
    format!("stiction identify {first}{log} --axis {axis}{law} --plan {plan} --out {out}")
}

/// What was asked for and holds of a plan that follows too.
fn carried_on(planned: &Planned) -> String {
    let options = &planned.options;
    let forms = options.carriers.iter();
    let forms = forms.map(|form| format!(" --format {}", form.name()));
    let start = options.start.iter();
    let start = start.map(|start| format!(" {}", argument(&format!("--start={start}"))));
    let seed = (options.seed != 0).then(|| format!(" --seed {}", options.seed));
    forms.chain(start).chain(seed).collect()
}

/// What is wanted; a probe is short whatever is.
fn wishes(planned: &Planned) -> String {
    let wishes = planned.options.wants.iter();
    wishes
        .map(|want| format!(" --want {}", quoted(&want.to_string())))
        .collect()
}

/// What the axis was known by.
fn known(planned: &Planned) -> String {
    match &planned.options.known {
        Some(Known::Log(file)) => format!(" --log {}", quoted_path(file)),
        Some(Known::Model(file)) => format!(" --model {}", quoted_path(file)),
        None => String::new(),
    }
}

/// Options by which a plan, and an identification, is for parameters of each direction, or for another law.
fn sides(file: &PlanFile) -> [String; 2] {
    match (&file.law, file.asymmetric) {
        (Some(law), _) => [(); 2].map(|()| format!(" --law {law}")),
        (None, true) => [" --asymmetric", " --law lugre --asymmetric"].map(String::from),
        (None, false) => ["", ""].map(String::from),
    }
}

/// Units of length, speed and force.
fn units(file: &PlanFile) -> [&'static str; 3] {
    match file.kind == "rotary" {
        false => ["m", "m/s", "N"],
        true => ["rad", "rad/s", "N m"],
    }
}

/// The largest of what happened, beside the limits, and where to abort.
fn largest(planned: &Planned) -> String {
    let file = &planned.file;
    let [length, speed, force] = units(file);
    // Gains that are tuned come with the feedforward that most drives have.
    let follows = match planned.given.logged.has_full_feedforward() {
        true => {
            " (with velocity and acceleration feedforward, without which it is many times as large)"
        }
        false => "",
    };
    let (largest, limits) = (&file.largest, &file.limits);
    format!(
        "\nlargest on any of them: speed {} of {} {speed}; force {} of {} {force}, rms {} of {}, at its limit {} of the time; \
         following error {} {length}\nabort above a following error of {} {length}{follows}, a force of {} {force}, a speed of {} {speed}\n",
        short(largest.speed),
        short(limits.speed),
        short(largest.force),
        short(limits.peak_force),
        short(largest.force_rms),
        short(limits.rated_force),
        Percent::error(100.0 * largest.saturated).short(),
        short(largest.following_error),
        short(file.abort.following_error),
        short(file.abort.force),
        short(file.abort.speed),
    )
}

/// What each parameter can be expected to come out as.
fn expected(file: &PlanFile) -> String {
    let mut rows = vec![
        [
            "parameter",
            "95 % interval, half of the axes",
            "nine of ten",
        ]
        .map(String::from)
        .to_vec(),
    ];
    rows.extend(file.parameter.iter().map(|p| {
        let of = match &p.of {
            Some(of) => format!(" of {of}"),
            None => String::new(),
        };
        vec![
            p.name.clone(),
            format!("{}{of}", within(p.interval_percent)),
            format!("{}{of}", within(p.interval90_percent)),
        ]
    }));
    let mut out = String::from("\nexpected of its log, by simulation, at most:\n");
    out.push_str(&table(&rows, &[false, true, true]));
    let open: Vec<&str> = (file.parameter.iter())
        .filter(|p| p.interval90_percent > OPEN)
        .map(|p| p.name.as_str())
        .collect();
    if !open.is_empty() {
        let _ = writeln!(
            out,
            "on some axes {} may stay open: bristles of a few encoder steps, or static friction hardly above Coulomb friction",
            open.join(", ")
        );
    }
    out
}

/// Longest motion that is planned, s.
const LONGEST: f64 = stiction_workflows::plan::TIMES[1];

/// Least half of a 95 % interval that an identification states, percent.
const LEAST: f64 = 100.0 * interval::MIN_HALF_WIDTH;

/// Each wish, whether it is granted, and what would grant it.
fn wanted(planned: &Planned, axis: &Path, written: &Path) -> String {
    let file = &planned.file;
    let mut out = String::new();
    for wish in &file.wanted {
        let _ = writeln!(
            out,
            "wanted {} {}: expected {} on nine of ten axes{}",
            wish.name,
            within(wish.percent),
            within(wish.expected90_percent),
            match (wish.met, wish.percent < LEAST) {
                (true, _) => String::new(),
                (false, false) => ", the best in this time".into(),
                (false, true) => format!(
                    ", the best in this time; no identification states less than {}",
                    within(LEAST)
                ),
            }
        );
    }
    let lacking = file.wanted.iter().filter(|wish| !wish.met);
    // No motion brings one below the least.
    let shares = lacking.map(|wish| wish.expected90_percent / wish.percent.max(LEAST));
    let shares = shares.filter(|share| *share > 1.0);
    let Some(most) = shares.reduce(f64::max) else {
        return out;
    };
    let folder = text(&written.components().collect::<PathBuf>());
    let beside = |end: &str| quoted(&format!("{folder}{end}"));
    // Deviations fall with the root of the time.
    let needed = (file.duration * most * most * 1.1).ceil();
    if needed <= LONGEST {
        let _ = writeln!(
            out,
            "a longer motion may grant it: stiction plan {} --time {needed}s{}{}{}{} --out {}",
            quoted_path(axis),
            known(planned),
            sides(file)[0],
            wishes(planned),
            carried_on(planned),
            beside("-longer")
        );
    } else {
        let _ = writeln!(
            out,
            "no motion of at most {LONGEST} s grants it within these limits: deviations fall with the root of the time, and this one \
             would take {} s. A finer encoder, less noise of the force and more speed help, and a first log, from which less is open:\n    \
             stiction plan {} --stage probe{}{} --out {}",
            short(needed),
            quoted_path(axis),
            sides(file)[0],
            carried_on(planned),
            beside("-probe")
        );
    }
    out
}

fn within(percent: f64) -> String {
    format!("+-{}", Percent::deviation(percent).short())
}

/// The worst parameter beside that of other motions.
fn beside(file: &PlanFile) -> String {
    let header = [
        "motion",
        "s",
        "worst parameter, half of the axes",
        "nine of ten",
        "",
    ];
    let mut rows = vec![header.map(String::from).to_vec()];
    rows.extend(file.compared.iter().map(|c| {
        vec![
            c.name.clone(),
            short(c.duration),
            within(c.interval_percent),
            within(c.interval90_percent),
            if c.keeps_limits { "" } else { "breaks a limit" }.into(),
        ]
    }));
    format!("\n{}", table(&rows, &[false, true, true, true, false]))
}
