//! `--method output-error` from files to files: a closed loop with a known controller, an open loop, what
//! is refused.

use crate::common::{Asked, Bench, options};
use std::fmt::Write;
use std::path::PathBuf;
use stiction_identify::Silent;
use stiction_parameters::LawKind;
use stiction_servo::cascade::{Cascade, CascadeState};
use stiction_servo::known;
use stiction_servo::path::Reference;
use stiction_servo::plant::{Load, Motion, Plant};
use stiction_workflows::identify::Method;
use stiction_workflows::identify::Outcome;

const CASCADE: Cascade = Cascade {
    position_gain: 60.0,
    speed_gain: 2500.0,
    integral_gain: 25_000.0,
    mass_feedforward: 0.0,
    force_limit: 500.0,
};

const AXIS: &str = r#"kind = "linear"

[columns]
time = "t"
position = { column = "x", unit = "mm" }
force = { column = "u", unit = "V", scale = "50 N/V" }
reference = { column = "r", unit = "mm" }
"#;

const CONTROLLER: &str = r#"
[controller]
kind = "p-pi"
position_gain = "60 1/s"
speed_gain = "2500 N s/m"
integral_gain = "500 V/m"
force_limit = "500 N"
"#;

/// The machine axis in closed loop, as its drive would write it: steps of 0.1 um, volts.
fn log(bench: &Bench, name: &str, n: usize, phase: f64) -> PathBuf {
    pushed(bench, name, n, phase, |_| 0.0)
}

/// The same beside a force from outside, the column `e` in N.
fn pushed(
    bench: &Bench,
    name: &str,
    n: usize,
    phase: f64,
    external: impl Fn(f64) -> f64,
) -> PathBuf {
    let h = 1e-3;
    let axis = known::find("machine").unwrap();
    let plant = Plant::new(axis.mass, axis.law).unwrap();
    let (mut state, mut motion) = (CascadeState::default(), Motion::default());
    let mut text = String::from("t [s],r,x,u,e\n");
    for k in 0..n {
        let t = k as f64 * h;
        let path = 0.01 * ((2.0 * t + phase).sin() - phase.sin()) + 0.004 * (9.0 * t).sin();
        let wanted = Reference {
            position: path,
            velocity: 0.0,
            acceleration: 0.0,
        };
        let x = 1e-7 * (motion.position / 1e-7).round();
        let force = CASCADE.force(&mut state, h, wanted, x);
        let _ = writeln!(
            text,
            "{t:.3},{:.9},{:.4},{:.6},{:.6}",
            1e3 * path,
            1e3 * x,
            force / 50.0,
            external(t)
        );
        let load = Load::force(force + external(t));
        for _ in 0..10 {
            motion = plant.step(motion, h / 10.0, load).motion;
        }
    }
    bench.write(name, &text)
}

fn simulated(bench: &Bench, axis: &str, change: impl FnOnce(&mut Asked)) -> Asked {
    let mut options = options(&[], LawKind::LuGre);
    options.files.axis = Some(bench.write("axis.toml", axis));
    options.procedures.method = Method::OutputError;
    change(&mut options);
    options
}

fn run(options: &Asked) -> Result<Outcome, stiction_workflows::Error> {
    options.identify(&mut Silent)
}

#[test]
fn a_closed_loop_is_identified_from_its_file() {
    let bench = Bench::new();
    let first = log(&bench, "first.csv", 4000, 0.0);
    let second = log(&bench, "second.csv", 2000, 0.7);
    let options = simulated(&bench, &format!("{AXIS}{CONTROLLER}"), |o| {
        o.files.logs = vec![first];
        o.files.validate = vec![second];
    });
    let outcome = run(&options).unwrap();
    let result = &outcome.result;
    assert!(result.trust.trustworthy, "{:?}", result.trust.reasons);
    assert_eq!(result.method, "output-error");
    for (name, truth) in [
        ("sigma0", 1.2e5),
        ("sigma1", 600.0),
        ("sigma2", 60.0),
        ("coulomb", 20.0),
        ("static", 30.0),
        ("stribeck_velocity", 5e-3),
        ("mass", 10.0),
    ] {
        let p = result.parameters.iter().find(|p| p.name == name).unwrap();
        assert!((p.value / truth - 1.0).abs() < 0.01, "{name} {}", p.value);
        assert!(p.identifiable, "{name}: {}", p.reason);
    }
    assert_eq!(
        (result.fit.signal.as_str(), result.fit.unit.as_str()),
        ("position", "m")
    );
    let simulation = result.simulation.as_ref().unwrap();
    assert_eq!((simulation.kind.as_str(), simulation.runs), ("closed", 1));
    let floor = simulation.quantisation_floor.unwrap();
    assert!(
        (floor / (1e-7 / 12f64.sqrt()) - 1.0).abs() < 1e-6,
        "{floor}"
    );
    assert!(result.fit.rmse < 3.0 * floor, "{}", result.fit.rmse);
    let force = simulation.force.as_ref().unwrap();
    assert_eq!((force.signal.as_str(), force.unit.as_str()), ("force", "N"));
    assert!(force.relative_error_percent < 2.0, "{force:?}");
    assert!(
        result.validation[0].fit.rmse < 3.0 * floor,
        "{:?}",
        result.validation[0]
    );
    assert_eq!(simulation.validation_force.len(), 1);

    let out = bench.path("out");
    stiction_pages::bundle::identification(&outcome)
        .write(&out)
        .unwrap();
    let csv = std::fs::read_to_string(out.join("fit.csv")).unwrap();
    assert!(csv.starts_with(
        "time [s],measured [m],model [m],residual [m],velocity [m/s],force [N],model force [N]\n"
    ));
    assert_eq!(csv.lines().count(), 4001);
    let json = std::fs::read_to_string(out.join("result.json")).unwrap();
    let read: stiction_files::result::ResultFile = serde_json::from_str(&json).unwrap();
    assert_eq!(read.simulation, result.simulation);
    let html = std::fs::read_to_string(out.join("report.html")).unwrap();
    stiction_testkit::assert_tables_fit(&html);
    for words in [
        "Measured and simulated",
        "Force over position",
        "Validation",
    ] {
        assert!(html.contains(words), "{words}");
    }
    let text = stiction_pages::text::outcome(&outcome);
    assert!(
        text.contains("simulation  closed loop, one run from a fitted start (4 values); force"),
        "{text}"
    );
}

/// What acts from outside acts on the simulated axis, and the controller does not ask for it; on what is held out, too.
#[test]
fn a_closed_loop_feels_the_external_force() {
    let bench = Bench::new();
    let push = |t: f64| 12.0 + 10.0 * (7.0 * t).sin();
    let only = pushed(&bench, "pushed.csv", 6000, 0.0, push);
    let columns = format!("{AXIS}external = {{ column = \"e\", unit = \"N\" }}\n");
    let options = simulated(&bench, &format!("{columns}{CONTROLLER}"), |o| {
        o.files.logs = vec![only];
        o.split = Some(0.7);
    });
    let outcome = run(&options).unwrap();
    let result = &outcome.result;
    assert!(result.trust.trustworthy, "{:?}", result.trust.reasons);
    for (name, truth) in [("sigma0", 1.2e5), ("coulomb", 20.0), ("mass", 10.0)] {
        let p = result.parameters.iter().find(|p| p.name == name).unwrap();
        assert!((p.value / truth - 1.0).abs() < 0.01, "{name} {}", p.value);
    }
    let held_out = result.validation[0].fit.rmse;
    assert!(held_out < 2.0 * result.fit.rmse, "{held_out}");
}

#[test]
fn the_same_log_is_split_and_driven_by_its_force() {
    let bench = Bench::new();
    let only = log(&bench, "only.csv", 3000, 0.0);
    let axis = format!("{AXIS}\n[simulation]\nsegment = \"0.5 s\"\n");
    let options = simulated(&bench, &axis, |o| {
        o.files.logs = vec![only];
        o.split = Some(0.7);
        o.law = Some(LawKind::Dahl);
    });
    let outcome = run(&options).unwrap();
    let simulation = outcome.result.simulation.as_ref().unwrap();
    assert_eq!((simulation.kind.as_str(), simulation.runs), ("open", 4));
    assert_eq!(simulation.start, "runs");
    assert!(simulation.force.is_none());
    assert_eq!(outcome.result.validation[0].fit.samples, 900);
    let mass = outcome.law().value("mass").unwrap();
    assert!((mass / 10.0 - 1.0).abs() < 0.1, "{mass}");
}

/// The machine axis under a force, open loop: newtons and micrometres.
fn driven(bench: &Bench, name: &str, n: usize, force: impl Fn(f64) -> f64) -> PathBuf {
    let axis = known::find("machine").unwrap();
    let plant = Plant::new(axis.mass, axis.law).unwrap();
    let mut motion = Motion::default();
    let mut text = String::from("time [s],position [um],force [N]\n");
    for k in 0..n {
        let t = k as f64 * 1e-3;
        let x = (motion.position / 1e-7).round() * 0.1;
        let _ = writeln!(text, "{t:.3},{x:.1},{:.6}", force(t));
        for _ in 0..10 {
            motion = plant.step(motion, 1e-4, Load::force(force(t))).motion;
        }
    }
    bench.write(name, &text)
}

/// A law that holds where it was fitted and nowhere else is not trusted, and says on which log.
#[test]
fn an_unseen_log_that_is_missed_counts_in_the_verdict() {
    let bench = Bench::new();
    // Below break-away Dahl is as good as LuGre; past it, it slides where LuGre falls off its static level.
    let presliding = driven(&bench, "presliding.csv", 2000, |t| 12.0 * (9.0 * t).sin());
    let sliding = driven(&bench, "sliding.csv", 2000, |t| 38.0 * (4.0 * t).sin());
    let again = driven(&bench, "again.csv", 1500, |t| 11.0 * (11.0 * t).sin());
    let with = |unseen: PathBuf| {
        let asked = simulated(&bench, "kind = \"linear\"\nmass = \"10 kg\"\n", |o| {
            o.files.logs = vec![presliding.clone()];
            o.files.validate = vec![unseen];
            o.law = Some(LawKind::Dahl);
        });
        run(&asked).unwrap().result
    };
    let missed = with(sliding);
    let reasons = missed.trust.reasons.join("; ");
    assert!(
        reasons.contains("sliding.csv, simulated whole"),
        "{reasons}"
    );
    assert!(
        reasons.contains("that of the fit") || reasons.contains("explains"),
        "{reasons}"
    );
    let held = with(again).trust.reasons.join("; ");
    assert!(!held.contains("again.csv"), "{held}");
}

/// Ramps are a commanded force: they are fitted where nothing else is given, and their break-away stands beside that.
#[test]
fn ramps_are_fitted_and_read() {
    let bench = Bench::new();
    let up = driven(&bench, "up.csv", 1000, |t| 45.0 * t);
    let down = driven(&bench, "down.csv", 1000, |t| -45.0 * t);
    let still = driven(&bench, "still.csv", 500, |t| 10.0 * t);
    let axis = "kind = \"linear\"\nmass = \"10 kg\"\n";
    let ramps = vec![up, down, still.clone()];
    let alone = simulated(&bench, axis, |o| {
        o.procedures.break_away = ramps.clone();
        o.law = Some(LawKind::Dahl);
    });
    let result = run(&alone).unwrap().result;
    assert_eq!(result.inputs.len(), 3);
    assert_eq!(result.break_away.len(), 2);
    for found in &result.break_away {
        // The static level of the machine is 30 N, and a ramp of this rate passes a little below.
        assert!((25.0..31.0).contains(&found.force.abs()), "{found:?}");
    }
    let left_out: Vec<_> = result
        .warnings
        .iter()
        .filter(|w| w.code.as_str() == "no-break-away")
        .collect();
    assert_eq!(left_out.len(), 1);
    assert!(left_out[0].message.contains("still.csv"), "{left_out:?}");
    // Without a method that fits them there is nothing to fit.
    let fitted = simulated(&bench, axis, |o| {
        o.procedures.method = Method::Separable;
        o.procedures.break_away = ramps.clone();
    });
    assert_eq!(run(&fitted).unwrap_err().code().as_str(), "usage");
}

#[test]
fn what_cannot_be_simulated_is_told() {
    let bench = Bench::new();
    let only = log(&bench, "only.csv", 1000, 0.0);
    let blind = AXIS
        .replace("reference", "load")
        .replace("\"mm\" }\n\"", "");
    let blind = blind.replace(
        "{ column = \"r\", unit = \"mm\" }",
        "{ column = \"r\", unit = \"N\" }",
    );
    let cases = [
        (format!("{blind}{CONTROLLER}"), None, "not-simulated"),
        (
            format!("mass = \"none\"\n{AXIS}{CONTROLLER}"),
            None,
            "not-simulated",
        ),
        (
            format!("{AXIS}{CONTROLLER}rate = \"1234 Hz\"\n"),
            None,
            "bad-setting",
        ),
        (
            format!("{AXIS}{}", CONTROLLER.replace("2500 N s/m", "2500 N s")),
            None,
            "bad-config",
        ),
        (format!("{AXIS}{CONTROLLER}"), Some(1.5), "usage"),
    ];
    for (axis, split, code) in cases {
        let options = simulated(&bench, &axis, |o| {
            o.files.logs = vec![only.clone()];
            o.split = split;
        });
        let e = run(&options).unwrap_err();
        assert_eq!(e.code().as_str(), code, "{e}");
    }
}
