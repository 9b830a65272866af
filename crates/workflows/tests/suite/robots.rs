//! Identification of simulated robots, whose parameters are known.

use std::collections::BTreeMap;
use std::path::PathBuf;
use stiction_identify::{Control, Progress, Silent};
use stiction_rigid::{Base, Scope};
use stiction_testkit::gate;
use stiction_testkit::robots::{Arm, Motion, Names, csv};
use stiction_workflows::Error;
use stiction_workflows::robot::{Files, Options, RobotOutcome, robot};

/// Columns of a log by their names.
type Columns = Vec<(String, Vec<f64>)>;

/// A folder with the URDF of a robot and its logs.
struct Bench {
    folder: tempfile::TempDir,
    files: Files,
}

impl Bench {
    fn of(arm: &Arm) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let urdf = folder.path().join("robot.urdf");
        std::fs::write(&urdf, arm.urdf).unwrap();
        let files = Files {
            urdf: Some(urdf),
            ..Files::default()
        };
        Self { folder, files }
    }

    fn written(&self, name: &str, text: &str) -> PathBuf {
        let path = self.folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    }

    fn fit(mut self, text: &str) -> Self {
        self.files.logs.push(self.written("fit.csv", text));
        self
    }

    fn validate(mut self, text: &str) -> Self {
        self.files.validate.push(self.written("validate.csv", text));
        self
    }

    fn toml(mut self, text: &str) -> Self {
        self.files.robot = Some(self.written("robot.toml", text));
        self
    }

    fn run(&self) -> Result<RobotOutcome, Error> {
        robot(&self.files, &Options::default(), &mut Silent)
    }
}

/// An estimate beside the truth.
struct Score {
    kind: String,
    joint: String,
    error: f64,
    half_width: f64,
    at_once: f64,
    truth: f64,
}

/// Every base parameter and every parameter of friction that is flagged as identifiable.
fn scores(arm: &Arm, found: &RobotOutcome) -> Vec<Score> {
    let base = Base::of(&arm.robot, &Scope::all(&arm.robot, true)).unwrap();
    let truth = base.values(&arm.parameters, &arm.armature);
    assert_eq!(truth.len(), found.result.base.len());
    let entries = found.result.base.iter().zip(&truth);
    let mut out: Vec<Score> = entries
        .map(|(entry, truth)| Score {
            kind: match entry.name.contains("Ia(") {
                true => "base with an armature".into(),
                false => "base".into(),
            },
            joint: entry.name.clone(),
            error: entry.value - truth,
            half_width: entry.half_width,
            at_once: entry.half_width,
            truth: *truth,
        })
        .collect();
    for (i, joint) in found.joints.iter().enumerate() {
        let Ok(outcome) = &joint.outcome else {
            continue;
        };
        let all = &outcome.result.parameters;
        let reference = all.iter().find(|p| p.name == "transmitted_reference");
        // Levels are stated at that torque.
        let load = reference.map_or(0.0, |p| p.value);
        let mut truth = arm.friction[i].at_load(load).truth().to_vec();
        truth.push(("mass", arm.armature[i]));
        for p in all.iter().filter(|p| p.identifiable) {
            let stem = p.name.replace("_positive", "").replace("_negative", "");
            let own = truth.iter().find(|(name, _)| *name == stem);
            let (Some((_, truth)), Some([Some(low), Some(high)])) = (own, p.ci95) else {
                continue;
            };
            out.push(Score {
                kind: stem,
                joint: format!("{} ({})", joint.name, outcome.result.law),
                error: p.value - truth,
                half_width: if p.value > *truth {
                    p.value - low
                } else {
                    high - p.value
                },
                at_once: p.half_width.map_or(f64::NAN, |half| half.at_once),
                truth: *truth,
            });
        }
    }
    out
}

/// Of the intervals of a kind: how many hold the truth, those of the moment alone too, and the root mean square and the mean, which a
/// bias moves from 0, of the error over half of the interval.
#[derive(Default)]
struct Held {
    count: f64,
    inside: f64,
    at_once: f64,
    square: f64,
    sum: f64,
}

fn table(scores: &[Score]) -> BTreeMap<&str, Held> {
    let mut of_kinds: BTreeMap<&str, Held> = BTreeMap::new();
    for score in scores {
        let ratio = score.error / score.half_width;
        let held = of_kinds.entry(&score.kind).or_default();
        held.count += 1.0;
        held.inside += f64::from(u8::from(ratio.abs() <= 1.0));
        held.at_once += f64::from(u8::from(score.error.abs() <= score.at_once));
        held.square += ratio * ratio;
        held.sum += ratio;
    }
    of_kinds
}

/// No effect of a joint is the weight or the inertia of others under another name.
fn assert_nothing_else(found: &RobotOutcome) {
    for joint in &found.joints {
        let outcome = joint.outcome.as_ref().unwrap();
        let effects = &outcome.result.effects;
        assert!(effects.is_empty(), "{}: {effects:?}", joint.name);
    }
}

/// The model of every joint leaves little more than the noise of a motion of another kind.
fn assert_predicts(arm: &Arm, found: &RobotOutcome) {
    let trust = &found.result.trust;
    assert!(trust.trustworthy, "{:?}", trust.reasons);
    for (joint, noise) in found.result.joints.iter().zip(&arm.noise) {
        let fit = joint.fit.as_ref().unwrap();
        assert_eq!(fit.judged_on, "validation");
        let left = fit.held_out_rms;
        assert!(
            left < *noise,
            "{}: {left} for a noise of {noise}",
            joint.name
        );
    }
}

/// Six joints, fitted on one log of a harmonic motion, validated on motions with rests.
fn identified(arm: &Arm, seconds: f64) -> RobotOutcome {
    let log = arm.record(Motion::Harmonic, seconds, 1);
    let unseen = arm.record(Motion::PointToPoint, 0.6 * seconds, 2);
    let bench = Bench::of(arm).fit(&log.csv(Names::Numbered));
    let bench = bench.validate(&unseen.csv(Names::Numbered));
    bench.run().unwrap()
}

#[test]
fn six_joints_are_identified_from_one_log_of_all() {
    let arm = Arm::six(1);
    let found = identified(&arm, 50.0);
    assert_predicts(&arm, &found);
    assert_nothing_else(&found);
    for score in scores(&arm, &found) {
        if ["coulomb", "sigma2"].contains(&score.kind.as_str()) {
            let Score {
                kind,
                joint,
                error,
                half_width,
                truth,
                ..
            } = score;
            assert!(error.abs() <= half_width, "{kind} of {joint}");
            assert!(
                error.abs() < 0.02 * truth,
                "{kind} of {joint}: {error} of {truth}"
            );
        }
    }
}

#[test]
fn coupling_is_not_called_friction() {
    let mut levels = Vec::new();
    for seed in gate(2, 1..=10) {
        let arm = Arm::pendulum(seed);
        let found = identified(&arm, 50.0);
        assert_predicts(&arm, &found);
        assert_nothing_else(&found);
        let all = scores(&arm, &found).into_iter();
        levels.extend(all.filter(|score| score.kind == "coulomb"));
    }
    assert!(!levels.is_empty());
    let outside = levels.iter().filter(|own| own.error.abs() > own.half_width);
    assert!(10 * outside.count() <= levels.len().max(10));
    for Score {
        joint,
        error,
        truth,
        ..
    } in levels
    {
        assert!(error.abs() < 0.15 * truth, "{joint}: {error} of {truth}");
    }
}

#[test]
#[ignore = "soak: minutes; how often intervals hold the truth"]
fn intervals_hold_the_truth_as_often_as_they_say() {
    /// Its name, the robot of a seed, and what is other than in that.
    type World = (&'static str, fn(u64) -> Arm, fn(&mut Arm));
    // The constants were chosen on seeds 1 to 10.
    let worlds: [World; 6] = [
        ("six", Arm::six, |_| {}),
        ("six, load", Arm::six, |arm| {
            arm.friction
                .iter_mut()
                .for_each(|own| own.per_torque = 0.05);
        }),
        ("six, Stribeck", Arm::six, |arm| {
            arm.friction.iter_mut().for_each(|own| own.rise = 1.3);
        }),
        ("six, 1 kHz", Arm::six, |arm| arm.rate = 1000),
        ("pendulum", Arm::pendulum, |_| {}),
        ("slider", Arm::slider, |_| {}),
    ];
    let mut of_all: BTreeMap<String, [f64; 2]> = BTreeMap::new();
    for (world, arm, change) in worlds {
        let mut all = Vec::new();
        for seed in 11..=20 {
            let mut arm = arm(seed);
            change(&mut arm);
            all.extend(scores(&arm, &identified(&arm, 50.0)));
        }
        for (kind, held) in table(&all) {
            let of = |x: f64| x / held.count;
            eprintln!(
                "{world}: {kind}: {} values, {:.2} inside, {:.2} at once, error over half width {:.2} rms, {:.2} mean",
                held.count,
                of(held.inside),
                of(held.at_once),
                of(held.square).sqrt(),
                of(held.sum)
            );
            let sum = of_all.entry(kind.to_owned()).or_default();
            *sum = [sum[0] + held.inside, sum[1] + held.count];
        }
    }
    for (kind, [inside, count]) in of_all {
        let part = inside / count;
        assert!(part >= 0.9, "{kind}: {part:.2} inside");
    }
}

/// The findings of a robot as one text.
fn said(found: &Result<RobotOutcome, Error>) -> String {
    match found {
        Ok(found) => {
            let joints = found.result.joints.iter();
            let joints = joints.map(|own| format!("{}: fitted {}", own.name, own.fit.is_some()));
            let warnings = found.result.warnings.iter().map(|w| format!("{w:?}"));
            let all: Vec<String> = joints.chain(warnings).collect();
            format!("trust {:?}\n{}", found.result.trust, all.join("\n"))
        }
        Err(error) => format!("error: {error}"),
    }
}

/// The log of a double pendulum after a change of its columns (time, two positions, two torques), and what is said of it.
fn said_of(change: impl Fn(&mut Columns), toml: Option<&str>) -> String {
    let arm = Arm::pendulum(1);
    let mut columns = arm.record(Motion::Harmonic, 20.0, 1).columns(Names::States);
    change(&mut columns);
    let mut bench = Bench::of(&arm).fit(&csv(&columns));
    if let Some(toml) = toml {
        bench = bench.toml(toml);
    }
    said(&bench.run())
}

fn assert_says(said: &str, parts: &[&str]) {
    for part in parts {
        assert!(said.contains(part), "no {part:?} in: {said}");
    }
}

#[test]
fn the_order_of_columns_does_not_count() {
    let said = said_of(|columns| columns[1..].reverse(), None);
    assert_eq!(said, said_of(|_| {}, None));
    assert_says(
        &said,
        &[
            "trustworthy: true",
            "upper: fitted true",
            "lower: fitted true",
        ],
    );
}

#[test]
fn degrees_are_refused() {
    let in_degrees = |columns: &mut Columns| {
        for (name, values) in &mut columns[1..3] {
            assert!(name.ends_with("[rad]"), "{name}");
            values.iter_mut().for_each(|x| *x = x.to_degrees());
        }
    };
    let said = said_of(in_degrees, None);
    assert_says(
        &said,
        &[
            "error",
            "joint upper goes from",
            "-2 to 2",
            "unit = \"deg\"",
        ],
    );
}

#[test]
fn joints_that_lack_something_are_named() {
    let still = said_of(|columns| columns[2].1.fill(0.3), None);
    assert_says(
        &still,
        &[
            "trustworthy: false",
            "upper: fitted true",
            "lower: fitted false",
            "Still { joint: \"lower\" }",
        ],
    );
    let without = said_of(|columns| drop(columns.remove(4)), None);
    assert_says(
        &without,
        &[
            "upper: fitted true",
            "lower: fitted false",
            "NoTorque { joint: \"lower\" }",
        ],
    );
    let without_any = said_of(|columns| columns.truncate(3), None);
    assert_says(
        &without_any,
        &["error", "joint upper has no torque or current column"],
    );
    let unknown = |columns: &mut Columns| {
        columns.remove(4);
        columns.remove(2);
    };
    let unknown = said_of(unknown, None);
    assert_says(
        &unknown,
        &["upper: fitted true", "NotLogged { joint: \"lower\""],
    );
    let none = said_of(|columns| drop(columns.drain(1..3)), None);
    assert_says(
        &none,
        &["error", "has no columns of the joints upper, lower"],
    );
    let left_out = said_of(|_| {}, Some("[joint.upper]\nfit = false\n"));
    assert_says(
        &left_out,
        &[
            "upper: fitted false",
            "lower: fitted true",
            "LeftOut { joint: \"upper\" }",
        ],
    );
}

#[test]
fn commands_and_currents_without_a_gain_are_named() {
    let commanded = |columns: &mut Columns| {
        for (name, _) in columns {
            *name = name.replace("effort", "effort_cmd");
        }
    };
    assert_says(
        &said_of(commanded, None),
        &[
            "Commanded { joint: \"upper\"",
            "Commanded { joint: \"lower\"",
        ],
    );
    let currents = |columns: &mut Columns| {
        for (name, values) in &mut columns[3..] {
            *name = name.replace("effort [N*m]", "current [A]");
            values.iter_mut().for_each(|x| *x /= 0.3);
        }
    };
    assert_says(
        &said_of(currents, None),
        &[
            "error",
            "no gain is known of what drives upper (A), lower (A)",
        ],
    );
}

#[test]
fn logs_of_faults_beyond_use_are_refused_without_panic() {
    for rows in [0, 1, 2, 12] {
        let short = said_of(
            |columns| columns.iter_mut().for_each(|own| own.1.truncate(rows)),
            None,
        );
        assert_says(&short, &["error"]);
    }
    let holes = |columns: &mut Columns| {
        columns[1]
            .1
            .iter_mut()
            .step_by(7)
            .for_each(|x| *x = f64::NAN);
    };
    said_of(holes, None);
    let same = |columns: &mut Columns| columns[0].1.fill(1.0);
    assert_says(&said_of(same, None), &["error"]);
    let inverted = |columns: &mut Columns| {
        columns[3].1.iter_mut().for_each(|x| *x = -*x);
    };
    assert_says(
        &said_of(inverted, None),
        &["trustworthy: false", "joint upper"],
    );
    let swapped = |columns: &mut Columns| {
        let other = columns[3].1.clone();
        columns[3].1 = std::mem::replace(&mut columns[4].1, other);
    };
    assert_says(&said_of(swapped, None), &["trustworthy: false"]);
}

#[test]
fn a_load_that_the_urdf_lacks_is_found() {
    let loaded = |mass| {
        let arm = Arm::six(3).carrying("flange", mass, [0.0, 0.1, 0.0]);
        let log = arm.record(Motion::Harmonic, 30.0, 1);
        let found = Bench::of(&arm).fit(&log.csv(Names::States)).run().unwrap();
        let warnings = found.result.warnings;
        warnings
            .into_iter()
            .map(|own| format!("{own:?}"))
            .collect::<String>()
    };
    let said = loaded(3.0);
    assert!(said.contains("Payload { link: \"flange\""), "{said}");
    let said = loaded(0.0);
    assert!(!said.contains("Payload"), "{said}");
}

#[test]
fn a_position_that_jumps_cuts_the_log_of_all_joints() {
    let jumps = |columns: &mut Columns| {
        for (joint, from) in [(1, 700), (2, 1200)] {
            columns[joint].1[from..].iter_mut().for_each(|x| *x += 0.05);
        }
    };
    assert_says(&said_of(jumps, None), &["trustworthy: true"]);
}

#[test]
fn what_the_robot_file_says_has_to_fit_the_log() {
    let coupling = "[[coupling]]\njoints = [\"upper\", \"lower\"]\nmatrix = [[1, 0], [1, 1]]\n";
    let half = said_of(|columns| drop(columns.remove(4)), Some(coupling));
    assert_says(&half, &["error", "some of its joints have a position"]);
    let stands = said_of(|_| {}, Some("[joint.upper]\nat = \"0.1 rad\"\n"));
    assert_says(&stands, &["error", "the log has its position"]);
}

#[test]
fn gravity_that_points_up_is_found() {
    let arm = Arm::slider(1);
    let log = arm.record(Motion::Harmonic, 20.0, 1).csv(Names::Numbered);
    let bench = Bench::of(&arm).fit(&log);
    let bench = bench.toml("gravity = [0, 0, 9.81]\n[joint.tilt]\n");
    assert_says(
        &said(&bench.run()),
        &["FarFromUrdf", "direction of gravity"],
    );
}

#[test]
fn what_was_interrupted_is_not_trusted() {
    let arm = Arm::pendulum(1);
    let log = arm.record(Motion::Harmonic, 20.0, 1).csv(Names::Numbered);
    let bench = Bench::of(&arm).fit(&log);
    for reports in [1, 3] {
        let mut left = reports;
        let mut stops = |_: &Progress| {
            left -= 1;
            match left {
                ..=0 => Control::Stop,
                _ => Control::Continue,
            }
        };
        let found = robot(&bench.files, &Options::default(), &mut stops);
        assert_says(&said(&found), &["trustworthy: false", "ended early"]);
    }
}

/// The inertia of the first body about its joint and an armature act alike: the URDF decides, and what the two share is no error of the
/// torque, however exact the log.
#[test]
fn what_inertia_and_armature_share_is_no_error() {
    const HEAVY: f64 = 50.0;
    const LIGHT: f64 = 0.01;
    let body = |name: &str, mass: f64, inertia: f64| {
        format!(
            "<link name=\"{name}\"><inertial><mass value=\"{mass}\"/><inertia ixx=\"{inertia}\" iyy=\"{inertia}\" \
             izz=\"{inertia}\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>"
        )
    };
    let joint = |name: &str, parent: &str, child: &str| {
        format!(
            "<joint name=\"{name}\" type=\"continuous\"><parent link=\"{parent}\"/><child link=\"{child}\"/>\
             <axis xyz=\"0 0 1\"/></joint>"
        )
    };
    let urdf = format!(
        "<robot name=\"two\"><link name=\"base\"/>{}{}{}{}</robot>",
        body("heavy", 10.0, HEAVY),
        body("light", 0.1, LIGHT),
        joint("first", "base", "heavy"),
        joint("second", "heavy", "light"),
    );
    // A sine of some amplitude and frequency, Hz: position, velocity, acceleration.
    let sine = |amplitude: f64, hertz: f64, t: f64| {
        let w = std::f64::consts::TAU * hertz;
        let (sin, cos) = (w * t).sin_cos();
        [sin, w * cos, -w * w * sin].map(|x| amplitude * x)
    };
    // Uniform, of a deviation of 0.02 N m.
    let noise = |k: i32| {
        let x = (12.9898 * f64::from(k)).sin() * 43_758.545_3;
        0.069 * (x - x.floor() - 0.5)
    };
    let mut log = String::from("t [s],q1 [rad],q2 [rad],tau1 [N*m],tau2 [N*m]\n");
    for i in 0..10_000 {
        let t = f64::from(i) / 250.0;
        let [a, b, c] = [(0.5, 0.5), (0.8, 0.31), (0.3, 0.837)].map(|(a, hertz)| sine(a, hertz, t));
        let second = [b[0] + c[0], b[1] + c[1], b[2] + c[2]];
        let friction =
            |v: f64, coulomb: f64, viscous: f64| coulomb * (v / 1e-3).tanh() + viscous * v;
        let shared = LIGHT * (a[2] + second[2]);
        let tau1 = HEAVY * a[2] + shared + friction(a[1], 5.0, 3.0) + noise(2 * i);
        let tau2 = shared + friction(second[1], 2.0, 0.5) + noise(2 * i + 1);
        log += &format!("{t},{:.9},{:.9},{tau1:.6},{tau2:.6}\n", a[0], second[0]);
    }
    let folder = tempfile::tempdir().unwrap();
    let written = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let files = Files {
        urdf: Some(written("two.urdf", &urdf)),
        logs: vec![written("fit.csv", &log)],
        ..Files::default()
    };
    let found = robot(&files, &Options::default(), &mut Silent).unwrap();
    let inertia = found.rigid.parameters[9];
    assert!((inertia / HEAVY - 1.0).abs() < 0.01, "{inertia}");
    assert!(found.rigid.armature[0] < 0.01 * HEAVY);
    for joint in &found.result.joints {
        let fit = joint.fit.as_ref().unwrap();
        assert!(
            fit.held_out_rms < 0.1,
            "{}: {}",
            joint.name,
            fit.held_out_rms
        );
        assert!(fit.trustworthy);
    }
}
