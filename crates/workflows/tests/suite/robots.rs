//! Identification of simulated robots, whose parameters are known.

use std::path::{Path, PathBuf};
use stiction_identify::Silent;
use stiction_rigid::{Base, Scope};
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
            kind: "base".into(),
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
        let mut truth = arm.friction[i].truth().to_vec();
        truth.push(("mass", arm.armature[i]));
        for p in outcome.result.parameters.iter().filter(|p| p.identifiable) {
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

fn report(arm: &Arm, found: &RobotOutcome) {
    for joint in &found.result.joints {
        let Some(fit) = &joint.fit else {
            continue;
        };
        let i = arm.robot.joint(&joint.name).unwrap();
        eprintln!(
            "{}: {} asym {} torque {:.3} fit {:.4} held-out {:.4} ({}) noise {:.4} rigid {:.4} {} {:?}",
            joint.name,
            fit.law,
            fit.asymmetric,
            fit.torque_rms,
            fit.fit_rms,
            fit.held_out_rms,
            fit.judged_on,
            arm.noise[i],
            fit.rigid_deviation,
            fit.trustworthy,
            fit.reasons
        );
        if let Ok(outcome) = &found
            .joints
            .iter()
            .find(|own| own.name == joint.name)
            .unwrap()
            .outcome
        {
            let effects: Vec<String> = outcome
                .result
                .effects
                .iter()
                .map(|e| format!("{e:?}"))
                .collect();
            eprintln!(
                "   effects {effects:?}\n   warnings {:?}",
                outcome
                    .result
                    .warnings
                    .iter()
                    .map(|w| w.code)
                    .collect::<Vec<_>>()
            );
        }
    }
    eprintln!(
        "trust {:?} warnings {:?}",
        found.result.trust, found.result.warnings
    );
    for s in scores(arm, found) {
        let ok = if s.error.abs() <= s.half_width {
            " "
        } else {
            "!"
        };
        eprintln!(
            "{ok} {:20} {:40} truth {:10.4} error {:10.5} half {:10.5} ratio {:.2}",
            s.kind,
            s.joint,
            s.truth,
            s.error,
            s.half_width,
            s.error / s.half_width
        );
    }
}

#[test]
#[ignore = "soak: looks"]
fn looks() {
    let seed: u64 = std::env::var("SEED").map_or(1, |s| s.parse().unwrap());
    let kind = std::env::var("KIND").unwrap_or("six".into());
    let mut arm = match kind.as_str() {
        "six" => Arm::six(seed),
        "pendulum" => Arm::pendulum(seed),
        _ => Arm::slider(seed),
    };
    if let Ok(rate) = std::env::var("RATE") {
        arm.rate = rate.parse().unwrap();
    }
    if let Ok(load) = std::env::var("LOAD") {
        for f in &mut arm.friction {
            f.per_torque = load.parse().unwrap();
        }
    }
    if let Ok(load) = std::env::var("LAG") {
        arm.lag = load.parse().unwrap();
    }
    let clock = std::time::Instant::now();
    let log = arm.record(Motion::Harmonic, 50.0, seed);
    let points = arm.record(Motion::PointToPoint, 30.0, seed + 1000);
    eprintln!("simulated in {:?}", clock.elapsed());
    if let Ok(path) = std::env::var("KEEP") {
        std::fs::create_dir_all(&path).unwrap();
        std::fs::write(Path::new(&path).join("fit.csv"), log.csv(Names::Numbered)).unwrap();
        std::fs::write(
            Path::new(&path).join("points.csv"),
            points.csv(Names::Numbered),
        )
        .unwrap();
        std::fs::write(Path::new(&path).join("robot.urdf"), arm.urdf).unwrap();
    }
    let bench = Bench::of(&arm)
        .fit(&log.csv(Names::Numbered))
        .validate(&points.csv(Names::Numbered));
    let clock = std::time::Instant::now();
    let found = bench.run().unwrap();
    eprintln!("identified in {:?}", clock.elapsed());
    report(&arm, &found);
    for joint in &found.joints {
        let left = &joint.left[0];
        let most = left.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        let at: Vec<String> = left
            .iter()
            .enumerate()
            .filter(|(_, x)| x.abs() > 0.6 * most)
            .map(|(i, x)| format!("{:.1}:{x:.3}", i as f64 / left.len() as f64 * 50.0))
            .take(12)
            .collect();
        eprintln!("LEFT {} n {} {at:?}", joint.name, left.len());
    }
    for s in scores(&arm, &found) {
        println!(
            "SCORE\t{kind}\t{seed}\t{}\t{}\t{}\t{}\t{}\t{}",
            s.kind, s.joint, s.truth, s.error, s.half_width, s.at_once
        );
    }
    let _ = csv(&[]);
    let _ = Bench::toml;
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

#[test]
fn faults_of_logs_are_found() {
    let arm = Arm::pendulum(1);
    let log = arm.record(Motion::Harmonic, 20.0, 1);
    let columns = log.columns(Names::States);
    let run = |name: &str, change: &dyn Fn(&mut Columns), toml: Option<&str>| {
        let mut own = columns.clone();
        change(&mut own);
        let mut bench = Bench::of(&arm).fit(&csv(&own));
        if let Some(toml) = toml {
            bench = bench.toml(toml);
        }
        let text = said(&bench.run());
        eprintln!("== {name}\n{text}");
        text
    };
    run("as it is", &|_| {}, None);
    run("reversed", &|own| own[1..].reverse(), None);
    run(
        "degrees without unit",
        &|own| {
            for (name, values) in own.iter_mut() {
                *name = name.split(" [").next().unwrap().into();
                if name.contains("position") {
                    for x in values {
                        *x = x.to_degrees();
                    }
                }
            }
        },
        None,
    );
    run(
        "degrees named rad",
        &|own| {
            for (name, values) in own.iter_mut() {
                if name.contains("position") {
                    for x in values {
                        *x = x.to_degrees();
                    }
                }
            }
        },
        None,
    );
    run("still", &|own| own[2].1.fill(0.3), None);
    run(
        "no torque",
        &|own| {
            own.remove(4);
        },
        None,
    );
    run("no torque of any", &|own| own.truncate(3), None);
    run(
        "no column of a joint",
        &|own| {
            own.remove(4);
            own.remove(2);
        },
        None,
    );
    run(
        "no position of any",
        &|own| {
            own.drain(1..3);
        },
        None,
    );
    run(
        "commanded",
        &|own| {
            for (name, _) in own.iter_mut() {
                *name = name.replace("effort", "effort_cmd");
            }
        },
        None,
    );
    run(
        "currents",
        &|own| {
            for (name, values) in own.iter_mut() {
                if name.contains("effort") {
                    *name = name.replace("effort [N*m]", "current [A]");
                    for x in values {
                        *x /= 0.3;
                    }
                }
            }
        },
        None,
    );
    run(
        "currents with a scale of one",
        &|own| {
            for (name, values) in own.iter_mut() {
                if name.contains("effort") {
                    *name = name.replace("effort [N*m]", "current [A]");
                    for x in values {
                        *x /= 0.3;
                    }
                }
            }
        },
        Some(
            "[joint.upper]\nforce = { column = \"joint_states.upper.current [A]\", scale = \"0.3 N*m/A\" }\n",
        ),
    );
    run("left out", &|_| {}, Some("[joint.upper]\nfit = false\n"));
    run(
        "inverted",
        &|own| {
            for x in &mut own[3].1 {
                *x = -*x;
            }
        },
        None,
    );
    run(
        "swapped torques",
        &|own| {
            let a = own[3].1.clone();
            own[3].1 = own[4].1.clone();
            own[4].1 = a;
        },
        None,
    );
    run(
        "not a number",
        &|own| {
            for x in own[1].1.iter_mut().skip(5).step_by(7) {
                *x = f64::NAN;
            }
        },
        None,
    );
    run(
        "short",
        &|own| {
            for (_, x) in own.iter_mut() {
                x.truncate(12);
            }
        },
        None,
    );
    run(
        "one row",
        &|own| {
            for (_, x) in own.iter_mut() {
                x.truncate(1);
            }
        },
        None,
    );
}

#[test]
fn a_payload_that_the_urdf_lacks_is_found() {
    for (name, arm) in [
        ("none", Arm::six(1)),
        ("none", Arm::six(2)),
        ("none", Arm::six(3)),
        ("3 kg", Arm::six(1).carrying("flange", 3.0, [0.0, 0.1, 0.0])),
        ("3 kg", Arm::six(2).carrying("flange", 3.0, [0.0, 0.1, 0.0])),
        ("6 kg", Arm::six(3).carrying("flange", 6.0, [0.0, 0.1, 0.0])),
    ] {
        let log = arm.record(Motion::Harmonic, 30.0, 1);
        eprintln!(
            "== {name}\n{}",
            said(&Bench::of(&arm).fit(&log.csv(Names::States)).run())
        );
    }
}
