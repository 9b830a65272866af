//! What plans are worth: logs of known axes along planned and hand-made motions, identified with defaults. Writes the table of
//! docs/plan.md: `plan [LOGS]`, LOGS of each motion and axis (10). `plan fresh [AXES]`: the slide's nameplate on AXES axes (32)
//! that it allows, a log each, by one plan, in two stages, and by the motion of the README. `plan terms [LOGS]`: axes with terms beside
//! LuGre, and with friction of its own in each direction. `plan time [LOGS]`: how long the plan, six speeds, three sines, and the plan of
//! somebody who knew the axis before would have to be for 1 % of every parameter. `plan elements [LOGS]`: axes with Maxwell-slip elements, by a probe and the plan for
//! what it says of them.

mod elements;
mod known;
mod terms;

use std::path::Path;
use stiction_files::Axis;
use stiction_files::result::ParameterEntry;
use stiction_identify::Silent;
use stiction_log::Column;
use stiction_parameters::LawKind;
use stiction_plan::{Candidate, Entry, Expected, HandMade, Motion, hand_made, run_finely};
use stiction_servo::noise::Noise;
use stiction_workflows::identify::Options;
use stiction_workflows::identify::identify_logs;
use stiction_workflows::plan::{Known, PlanOptions, Planned, plan as plan_motion};
use stiction_workflows::source::{Source, in_memory};

/// Name, axis file, and sigma0, sigma1, sigma2, Fc, Fs, vs, M.
const AXES: [(&str, &str, [f64; 7]); 3] = [
    (
        "slide",
        "rate = \"4 kHz\"\n[limits]\nstroke = [\"-100 mm\", \"100 mm\"]\nspeed = \"0.2 m/s\"\nacceleration = \"6 m/s2\"\njerk = \"1500 m/s3\"\n\
         rated_force = \"150 N\"\npeak_force = \"200 N\"\nmass = \"10 kg\"\nforce_noise = \"1 N\"\n[log]\nresolution = \"50 nm\"\n\
         [controller]\nbandwidth = \"60 Hz\"\n",
        [1.2e5, 600.0, 60.0, 20.0, 30.0, 5e-3, 10.0],
    ),
    (
        "motor",
        "rate = \"4 kHz\"\n[limits]\nstroke = [\"-100 mm\", \"100 mm\"]\nspeed = \"0.5 m/s\"\nacceleration = \"10 m/s2\"\njerk = \"2000 m/s3\"\n\
         rated_force = \"150 N\"\npeak_force = \"221 N\"\nmass = \"4.6 kg\"\nforce_noise = \"0.6 N\"\n[log]\nresolution = \"50 nm\"\n\
         [controller]\nbandwidth = \"60 Hz\"\n",
        [2e6, 1.5e3, 30.0, 12.0, 18.0, 3e-3, 4.6],
    ),
    (
        "coarse",
        "rate = \"2 kHz\"\n[limits]\nstroke = [\"-100 mm\", \"100 mm\"]\nspeed = \"0.3 m/s\"\nacceleration = \"6 m/s2\"\njerk = \"1500 m/s3\"\n\
         rated_force = \"80 N\"\npeak_force = \"100 N\"\nmass = \"5 kg\"\nforce_noise = \"0.5 N\"\n[log]\nresolution = \"0.5 um\"\n\
         [controller]\nbandwidth = \"40 Hz\"\n",
        [1.333e5, 600.0, 35.0, 5.0, 12.0, 0.03, 5.0],
    ),
];

/// What the logs of a motion said.
#[derive(Default)]
struct Found {
    /// Worst error of each log, percent.
    worst: Vec<f64>,
    inside: usize,
    claimed: usize,
    flagged: usize,
    all: usize,
    /// Squares of errors over predicted deviations.
    ratio: Vec<f64>,
    /// Squares of the errors of each parameter, in percent.
    squares: Vec<Vec<f64>>,
}

impl Found {
    fn add(&mut self, other: Found) {
        self.worst.extend(other.worst);
        self.ratio.extend(other.ratio);
        self.inside += other.inside;
        self.claimed += other.claimed;
        self.flagged += other.flagged;
        self.all += other.all;
        self.squares.resize(other.squares.len(), Vec::new());
        for (own, other) in self.squares.iter_mut().zip(other.squares) {
            own.extend(other);
        }
    }

    /// How long the motion would have to be for a root mean square error of 1 % of every parameter, by the root of the time, s; none
    /// where a parameter is left open.
    fn seconds(&self, duration: f64) -> Option<f64> {
        let mean = |squares: &Vec<f64>| squares.iter().sum::<f64>() / squares.len().max(1) as f64;
        let worst = self.squares.iter().map(mean).fold(0.0, f64::max);
        (self.flagged == 0).then_some(duration * worst)
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |at: usize, usual: usize| {
        let given = arguments.get(at);
        given.map_or(usual, |x| x.parse().expect("a number"))
    };
    if arguments.first().is_some_and(|word| word == "fresh") {
        return fresh(number(1, 32));
    }
    if arguments.first().is_some_and(|word| word == "terms") {
        return terms::terms(number(1, 10) as u64);
    }
    if arguments.first().is_some_and(|word| word == "elements") {
        return elements::elements(number(1, 10) as u64);
    }
    if arguments.first().is_some_and(|word| word == "time") {
        return time(number(1, 10) as u64);
    }
    let logs = number(0, 10) as u64;
    println!(
        "| axis | motion | s | logs | median | largest | coverage | flagged | rms/predicted | s to 1 % |\n|---|---|---|---|---|---|---|---|---|---|"
    );
    let mut all: Vec<(&str, Found)> = Vec::new();
    let mut pool =
        |motion: &'static str, found: Found| match all.iter_mut().find(|(own, _)| *own == motion) {
            Some((_, own)) => own.add(found),
            None => all.push((motion, found)),
        };
    for (name, axis, values) in AXES {
        let folder =
            std::env::temp_dir().join(format!("stiction-plan-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let file = folder.join("axis.toml");
        std::fs::write(&file, axis).expect("a file");
        let planned = plan(&file, PlanOptions::default());
        let plate = &planned.given.nameplate;
        let truth = Candidate::from_values(values);
        let axis = Axis::read(&file).expect("an axis");
        let mut motions = vec![("plan, nameplate", planned.motion.clone())];
        for kind in HandMade::ALL {
            let made =
                hand_made(kind, &plate.limits, &plate.rig, 9.0).expect("limits that are some");
            motions.extend(made.map(|motion| (kind.name(), motion)));
        }
        for (motion_name, motion) in motions {
            let mut found = Found::default();
            for seed in 0..logs {
                one(&motion, &truth, &planned, &axis, (seed, None), &mut found);
            }
            say(name, motion_name, motion.duration(), &mut found);
            pool(motion_name, found);
        }
        // Two stages: each probe has a plan of its own, whose logs are identified with it.
        let probe = plan(
            &file,
            PlanOptions {
                probe: true,
                ..PlanOptions::default()
            },
        );
        let (mut found, mut duration) = (Found::default(), 0.0);
        for number in 0..PROBES {
            let first = log(&probe.motion, &truth, &probe, &axis, 500 + number);
            let csv = folder.join(format!("probe-{number}.csv"));
            std::fs::write(&csv, text(&first)).expect("a file");
            let known = Some(Known::Log(csv));
            let second = plan(
                &file,
                PlanOptions {
                    known,
                    ..PlanOptions::default()
                },
            );
            duration = probe.motion.duration() + second.motion.duration();
            for seed in 0..logs / PROBES {
                let seed = 100 * number + seed;
                one(
                    &second.motion,
                    &truth,
                    &second,
                    &axis,
                    (seed, Some(&first)),
                    &mut found,
                );
            }
        }
        say(name, "probe + plan", duration, &mut found);
        pool("probe + plan", found);
        std::fs::remove_dir_all(&folder).expect("the folder that was made");
    }
    for (motion, mut found) in all {
        let about = if motion == "probe + plan" { 12.0 } else { 9.0 };
        say("all", motion, about, &mut found);
    }
}

/// How long each motion would have to be for 1 % of every parameter: the plan, that of somebody who knew the axis, which no plan
/// from a nameplate can be expected to do better than, and the two that are run by hand.
fn time(logs: u64) {
    println!(
        "| axis | motion | s | logs | median | largest | coverage | flagged | rms/predicted | s to 1 % |\n|---|---|---|---|---|---|---|---|---|---|"
    );
    for (name, axis, values) in AXES {
        let folder =
            std::env::temp_dir().join(format!("stiction-time-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let file = folder.join("axis.toml");
        std::fs::write(&file, axis).expect("a file");
        let planned = plan(&file, PlanOptions::default());
        let plate = &planned.given.nameplate;
        let truth = Candidate::from_values(values);
        let axis = Axis::read(&file).expect("an axis");
        let known = plan(&file, known::options(&folder, values));
        let mut motions = vec![
            ("plan, nameplate", planned.motion.clone()),
            ("plan, axis known", known.motion),
        ];
        for kind in [HandMade::SixSpeeds, HandMade::ThreeSines] {
            let made = hand_made(kind, &plate.limits, &plate.rig, 9.0).expect("limits");
            motions.extend(made.map(|motion| (kind.name(), motion)));
        }
        for (motion_name, motion) in motions {
            let mut found = Found::default();
            for seed in 0..logs {
                one(&motion, &truth, &planned, &axis, (seed, None), &mut found);
            }
            say(name, motion_name, motion.duration(), &mut found);
        }
        std::fs::remove_dir_all(&folder).expect("the folder that was made");
    }
}

/// Axes that were not among those a plan was made on: worst errors of a log each, and how many parameters it leaves open.
fn fresh(count: usize) {
    let (name, axis, _) = AXES[0];
    let folder = std::env::temp_dir().join(format!("stiction-fresh-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let file = folder.join("axis.toml");
    std::fs::write(&file, axis).expect("a file");
    let axis = Axis::read(&file).expect("an axis");
    let one_stage = plan(&file, PlanOptions::default());
    let probe = plan(
        &file,
        PlanOptions {
            probe: true,
            ..PlanOptions::default()
        },
    );
    let plate = &one_stage.given.nameplate;
    let readme = hand_made(HandMade::ThreeSines, &plate.limits, &plate.rig, 9.0);
    let readme = readme.expect("limits that are some").expect("a motion");
    let mut all: [Found; 3] = Default::default();
    let mut better = [0, 0, 0];
    println!("| {name} | plan | two stages | README |\n|---|---|---|---|");
    for (number, truth) in plate
        .draw(&one_stage.given.subject, count, FRESH)
        .into_iter()
        .enumerate()
    {
        let seed = 10_000 + number as u64;
        let mut own: [Found; 3] = Default::default();
        one(
            &one_stage.motion,
            &truth,
            &one_stage,
            &axis,
            (seed, None),
            &mut own[0],
        );
        one(
            &readme,
            &truth,
            &one_stage,
            &axis,
            (seed, None),
            &mut own[2],
        );
        let first = log(&probe.motion, &truth, &probe, &axis, 500 + seed);
        let csv = folder.join("probe.csv");
        std::fs::write(&csv, text(&first)).expect("a file");
        let second = PlanOptions {
            known: Some(Known::Log(csv)),
            ..PlanOptions::default()
        };
        match plan_motion(&file, &second, &mut Silent) {
            Ok(Some(second)) => {
                let logs = (seed, Some(&first));
                one(&second.motion, &truth, &second, &axis, logs, &mut own[1]);
                // One log is chance: on the true axis, what either is likely to be off by.
                let both = [probe.motion.atoms(), second.motion.atoms()].concat();
                let both = Motion::new(both).expect("pieces that join");
                let [both, hand] = [&both, &readme].map(|m| likely(m, &truth, &one_stage));
                better[2] += usize::from(both <= 1.1 * hand);
            }
            _ => own[1].worst.push(f64::INFINITY),
        }
        let said = own
            .each_ref()
            .map(|found| format!("{:.2}, {} open", found.worst[0], found.flagged));
        println!("| {number} | {} |", said.join(" | "));
        better[0] += usize::from(own[0].worst[0] < own[2].worst[0]);
        better[1] += usize::from(own[1].worst[0] <= 1.1 * own[2].worst[0]);
        for (all, own) in all.iter_mut().zip(own) {
            all.add(own);
        }
    }
    println!(
        "\n| axis | motion | s | logs | median | largest | coverage | flagged | rms/predicted | s to 1 % |\n|---|---|---|---|---|---|---|---|---|---|"
    );
    for (motion, found) in ["plan, nameplate", "probe + plan", "README"]
        .iter()
        .zip(&mut all)
    {
        say(name, motion, 9.0, found);
    }
    println!(
        "the plan is better than the README on {} of {count}, two stages at most 1.1 times as far off on {}, and expected to be on {}",
        better[0], better[1], better[2]
    );
    std::fs::remove_dir_all(&folder).expect("the folder that was made");
}

/// The predicted deviation of the worst parameter on an axis.
fn likely(motion: &Motion, axis: &Candidate, planned: &Planned) -> f64 {
    let plate = &planned.given.nameplate;
    let entry = Entry::of(motion, axis, (&plate.limits, &plate.rig), 1 << 25).expect("as before");
    Expected::of(&[entry], &planned.given.aim).worst(1.0)
}

fn plan(file: &Path, options: PlanOptions) -> Planned {
    let planned = plan_motion(file, &options, &mut Silent).expect("a plan");
    planned.expect("not stopped")
}

/// Probes of an axis.
const PROBES: u64 = 2;
/// Seed of axes that no plan was made on.
const FRESH: u32 = 77;

/// A simulated log.
fn log(motion: &Motion, truth: &Candidate, planned: &Planned, axis: &Axis, seed: u64) -> Source {
    let plate = &planned.given.nameplate;
    let (limits, rig) = (&plate.limits, &plate.rig);
    let mut noise = Noise::new(1000 + seed);
    let phase = noise.uniform();
    let run = run_finely(motion, truth, rig, limits.peak_force, phase)
        .expect("an axis that can be simulated");
    let force = run
        .command
        .iter()
        .map(|f| f + rig.force_noise * noise.normal())
        .collect();
    let time = (0..run.reading.len())
        .map(|k| k as f64 / rig.rate)
        .collect();
    // In the coordinates of the controller.
    let start = planned.given.start;
    let reading = run.reading.iter().map(|x| start + x).collect();
    let column = |name: &str, unit: &str, values: Vec<f64>| Column {
        name: name.into(),
        unit: Some(unit.into()),
        values,
        ..Column::default()
    };
    let columns = vec![
        column("time", "s", time),
        column(
            "position",
            &planned.given.motion.position().si_text(),
            reading,
        ),
        column("force", &planned.given.motion.force().si_text(), force),
    ];
    in_memory("log", columns, axis).expect("a log")
}

/// A log as text.
fn text(Source { log, .. }: &Source) -> String {
    let (Some(position), Some(force)) = (&log.position, &log.force) else {
        return String::new();
    };
    let rows = log.time.iter().zip(position).zip(force);
    let rows: Vec<String> = rows.map(|((t, x), f)| format!("{t},{x},{f}\n")).collect();
    format!("time [s],position [m],force [N]\n{}", rows.concat())
}

/// A log, identified, with one before it where there is one, and its errors.
fn one(
    motion: &Motion,
    truth: &Candidate,
    planned: &Planned,
    axis: &Axis,
    (seed, before): (u64, Option<&Source>),
    found: &mut Found,
) {
    let plate = &planned.given.nameplate;
    let (limits, rig) = (&plate.limits, &plate.rig);
    let mut logs: Vec<Source> = before.into_iter().cloned().collect();
    logs.push(log(motion, truth, planned, axis, seed));
    let mut options = Options::default();
    if planned.given.subject.asymmetric {
        (options.law, options.asymmetric) = (Some(LawKind::LuGre), true);
    }
    if let Some(elements) = planned.given.subject.elements {
        options.law = Some(match elements.falls {
            true => LawKind::Gms,
            false => LawKind::MaxwellSlip,
        });
    }
    let fit = identify_logs(&options, axis, logs, Vec::new(), &mut Silent).expect("a fit");
    let parameter = |name: &str| fit.result.parameters.iter().find(|p| p.name == name);
    let entry = Entry::of(motion, truth, (limits, rig), 1 << 25).expect("as before");
    let expected = Expected::of(&[entry], &planned.given.aim);
    let predicted = &expected.axes[0];
    let mut worst: f64 = 0.0;
    let value = |name: &str| parameter(name).map(|p| p.value);
    // What changes along the stroke holds at the position that the fit names.
    let reference = value("position_reference").map(|x| x - planned.given.start);
    let names = planned.given.subject.names();
    let units = truth.units();
    let all = names.iter().zip(terms::values(truth, reference));
    found.squares.resize(names.len(), Vec::new());
    let each = all.zip(units.iter().zip(predicted)).enumerate();
    for (i, ((name, truth), (unit, predicted))) in each {
        found.all += 1;
        // One that the law holds, micro-damping of none, is not claimed.
        let claims = |p: &&ParameterEntry| p.identifiable && p.range().is_some();
        let Some(p) = parameter(name).filter(claims) else {
            found.flagged += 1;
            continue;
        };
        let error = (p.value - truth) / unit;
        worst = worst.max(error.abs());
        found.squares[i].push(1e4 * error * error);
        found.ratio.push((error / predicted) * (error / predicted));
        if let Some((low, high)) = p.range() {
            found.claimed += 1;
            found.inside += usize::from(low <= truth && truth <= high);
        }
    }
    found.worst.push(100.0 * worst);
}

fn say(axis: &str, motion_name: &str, duration: f64, found: &mut Found) {
    found.worst.sort_by(f64::total_cmp);
    let n = found.worst.len();
    let median = 0.5 * (found.worst[(n - 1) / 2] + found.worst[n / 2]);
    let rms = (found.ratio.iter().sum::<f64>() / found.ratio.len().max(1) as f64).sqrt();
    let seconds = found.seconds(duration);
    let seconds = seconds.map_or("open".into(), |seconds| format!("{seconds:.1}"));
    println!(
        "| {axis} | {motion_name} | {:.1} | {n} | {median:.2} | {:.2} | {:.0} | {:.0} | {rms:.2} | {seconds} |",
        duration,
        found.worst[n - 1],
        100.0 * found.inside as f64 / found.claimed.max(1) as f64,
        100.0 * found.flagged as f64 / found.all as f64,
    );
}
