//! The procedures as whole workflows: on the logs of the demo, and what they refuse.

use crate::common::{Asked, Bench, noise, options};
use std::path::{Path, PathBuf};
use stiction_codes::Code;
use stiction_files::result::{Origin, ResultFile};
use stiction_files::{ModelFile, Warning};
use stiction_identify::Silent;
use stiction_pages::text;
use stiction_parameters::LawKind;
use stiction_workflows::Error;
use stiction_workflows::identify::Outcome;
use stiction_workflows::identify::{Method, Procedures};

fn with(logs: &[&Path], procedures: Procedures) -> Asked {
    options(logs, LawKind::LuGre).but(|asked| asked.procedures = procedures)
}

fn method(method: Method) -> Procedures {
    Procedures {
        method,
        ..Procedures::default()
    }
}

fn run(options: &Asked) -> Result<Outcome, Error> {
    options.identify(&mut Silent)
}

const TRUTH: [(&str, f64); 7] = [
    ("sigma0", 1.2e5),
    ("sigma1", 600.0),
    ("sigma2", 60.0),
    ("coulomb", 20.0),
    ("static", 30.0),
    ("stribeck_velocity", 5e-3),
    ("mass", 10.0),
];

/// Every identified parameter within this share of the truth, and within four deviations of it.
fn near_truth(outcome: &Outcome, share: f64) {
    for p in outcome
        .result
        .parameters
        .iter()
        .filter(|p| p.origin == Origin::Identified)
    {
        let Some((_, truth)) = TRUTH.iter().find(|(name, _)| *name == p.name) else {
            continue;
        };
        assert!(
            (p.value / truth - 1.0).abs() < share,
            "{}: {}",
            p.name,
            p.value
        );
        let std = p
            .std
            .unwrap_or_else(|| panic!("{} has no deviation: {}", p.name, p.reason));
        assert!(
            (p.value - truth).abs() < 4.0 * std,
            "{}: {} +- {std}",
            p.name,
            p.value
        );
        assert!(p.identifiable, "{}: {}", p.name, p.reason);
    }
    let trust = &outcome.result.trust;
    assert!(trust.trustworthy, "{:?}", trust.reasons);
}

/// What is written can be read back, and the report is whole.
fn files(outcome: &Outcome, bench: &Bench, name: &str) -> PathBuf {
    let dir = bench.path(name);
    stiction_pages::bundle::identification(outcome)
        .write(&dir)
        .unwrap();
    let json = std::fs::read_to_string(dir.join("result.json")).unwrap();
    let back: ResultFile = serde_json::from_str(&json).unwrap();
    assert_eq!(back, outcome.result);
    let html = std::fs::read_to_string(dir.join("report.html")).unwrap();
    stiction_testkit::assert_tables_fit(&html);
    assert!(html.trim_end().ends_with("</html>"));
    let model = dir.join("model.toml");
    ModelFile::read(&model).unwrap();
    model
}

/// The four procedures of the documentation, each on the model of the one before.
/// The covariance after the steps has every parameter that was identified, here or before; what was taken over varies as it did
/// in the model it came from, and sigma0 varies with it.
fn varies_as_a_whole(step: &Outcome, before: &Outcome) {
    let identified: Vec<&str> = step
        .result
        .parameters
        .iter()
        .filter(|p| p.origin == Origin::Identified)
        .map(|p| p.name.as_str())
        .collect();
    assert_eq!(step.result.covariance.names, identified);
    assert!(
        TRUTH.iter().all(|(name, _)| identified.contains(name)),
        "{identified:?}"
    );
    let element = |outcome: &Outcome, a: &str, b: &str| {
        let covariance = &outcome.result.covariance;
        let place = |name: &str| covariance.names.iter().position(|n| n == name).unwrap();
        covariance.matrix[place(a)][place(b)]
    };
    for (a, b) in [
        ("static", "static"),
        ("static", "coulomb"),
        ("sigma2", "coulomb"),
        ("mass", "static"),
    ] {
        assert_eq!(element(step, a, b), element(before, a, b), "{a} {b}");
    }
    assert!(element(step, "sigma0", "static") != 0.0);
}

/// A study draws parameters from a model, and the compensation with them is nearly that with the exact ones.
fn drawn_from(model: &Path, bench: &Bench) {
    let text = format!(
        "[axis]\nmodel = {:?}\nrate = \"4 kHz\"\n\
         [[path]]\nkind = \"sine\"\namplitude = \"1 mm\"\nfrequency = \"1 Hz\"\n\
         [[controller]]\nkind = \"cascade\"\nbandwidth = \"30 Hz\"\nforce_limit = \"200 N\"\n\
         [[compensator]]\nkind = \"lugre\"\n\
         [[parameter_error]]\nkind = \"covariance\"\ndraws = 20\n",
        model.display().to_string()
    );
    let study = stiction_files::study::Study::read(bench.write("drawn.toml", &text)).unwrap();
    let rows = stiction_workflows::study::simulate(&study, &mut Silent)
        .file
        .results;
    let drawn = rows
        .iter()
        .find(|r| r.compensator == "lugre" && r.parameters == "20 draws");
    let peak = drawn.unwrap().metric("peak_error").unwrap();
    let [low, high] = peak.interval95.unwrap();
    assert!(
        low < peak.mean && peak.mean < high && peak.worst_reduction_percent.unwrap() > 20.0,
        "{peak:?}"
    );
}

#[test]
fn the_logs_of_the_demo() {
    let bench = Bench::new();
    let logs = stiction_workflows::demo::procedures(bench.dir(), 0)
        .unwrap()
        .0;
    let log = |name: &str| {
        let found = logs.iter().find(|p| p.ends_with(name));
        found.unwrap_or_else(|| panic!("no {name}")).clone()
    };
    let speeds = log("speeds.csv");

    let map = run(&with(&[&speeds], method(Method::Static))).unwrap();
    near_truth(&map, 0.02);
    let entry = map.result.static_map.as_ref().unwrap();
    assert_eq!(entry.points.len(), 24);
    assert!(entry.scatter < 0.15, "{}", entry.scatter);
    assert_eq!(map.result.method, "static");
    assert_eq!(map.result.law, "stribeck");
    assert!(map.result.warnings.is_empty(), "{:?}", map.result.warnings);
    files(&map, &bench, "static");

    let both = Procedures {
        statics: vec![speeds.clone()],
        ..method(Method::StaticThenDynamic)
    };
    let dynamic = run(&with(&[&log("motion.csv")], both)).unwrap();
    near_truth(&dynamic, 0.02);
    let entry = dynamic.result.static_then_dynamic.as_ref().unwrap();
    assert_eq!(entry.statics, "static logs");
    assert!(entry.joint_rmse <= entry.rmse * (1.0 + 1e-9));
    assert!(entry.explanation.len() >= 2);
    let names: Vec<&str> = entry.parameters.iter().map(|p| p.name.as_str()).collect();
    assert!(
        TRUTH.iter().all(|(name, _)| names.contains(name)),
        "{names:?}"
    );
    let dynamic_model = files(&dynamic, &bench, "dynamic");

    let steps = Procedures {
        model: Some(dynamic_model.clone()),
        ..method(Method::PreslidingStep)
    };
    let step = run(&with(&[&log("step_1.csv"), &log("step_2.csv")], steps)).unwrap();
    near_truth(&step, 0.005);
    let entry = step.result.presliding_step.as_ref().unwrap();
    assert_eq!(entry.used, "simulated");
    // The bias of the published inversion at a damping ratio of .3 and a tenth of Fs.
    let published = &entry.published[0];
    assert!((-17.0..-13.0).contains(&published.sigma0_off_percent));
    assert!((20.0..35.0).contains(&published.sigma1_off_percent.unwrap()));
    assert_eq!(step.result.fit.unit, "m");
    let model = files(&step, &bench, "step");
    varies_as_a_whole(&step, &dynamic);
    drawn_from(&model, &bench);

    // What the model before left open is not exact for having no variance there.
    let mut open = ModelFile::from_result(&dynamic.result);
    let place = open
        .covariance
        .names
        .iter()
        .position(|name| name == "static")
        .unwrap();
    open.covariance
        .matrix
        .iter_mut()
        .for_each(|row| row[place] = 0.0);
    open.covariance.matrix[place].fill(0.0);
    let entry = open
        .parameter
        .iter_mut()
        .find(|p| p.name == "static")
        .unwrap();
    (entry.std, entry.ci95, entry.interval, entry.identifiable) = (None, None, None, false);
    let steps = Procedures {
        model: Some(bench.write("open.toml", &open.to_toml())),
        ..method(Method::PreslidingStep)
    };
    let step = run(&with(&[&log("step_1.csv"), &log("step_2.csv")], steps)).unwrap();
    let entry = step
        .result
        .parameters
        .iter()
        .find(|p| p.name == "static")
        .unwrap();
    assert!(
        !entry.identifiable && entry.origin == Origin::Given,
        "{entry:?}"
    );
    let warned = |w: &Warning| w.code == Code::NotIdentifiable && w.message.contains("static (");
    assert!(
        step.result.warnings.iter().any(warned),
        "{:?}",
        step.result.warnings
    );

    let ramps = Procedures {
        model: Some(dynamic_model),
        break_away: vec![log("ramp_1.csv"), log("ramp_2.csv"), log("ramp_3.csv")],
        ..method(Method::Static)
    };
    let ramps = run(&with(&[&speeds], ramps)).unwrap();
    let found = &ramps.result.break_away;
    for (run, rate) in found.iter().zip([5.0, 20.0, 100.0]) {
        assert!((run.rate / rate - 1.0).abs() < 0.005);
        let predicted = run.predicted_force.unwrap();
        assert!((run.force / predicted - 1.0).abs() < 0.02, "{run:?}");
    }
    assert!(found.is_sorted_by(|a, b| a.force > b.force));
    // Not a point of the map, whatever comes beside it.
    assert_eq!(ramps.result.parameters, map.result.parameters);
    files(&ramps, &bench, "ramps");
}

/// What a procedure cannot be given is refused, each with its page.
#[test]
fn what_cannot_be_is_refused() {
    let bench = Bench::new();
    let log = bench.good("log.csv", 1);
    let other = bench.good("other.csv", 2);
    let refused = |options: &Asked, code: &str| {
        let error = run(options)
            .err()
            .unwrap_or_else(|| panic!("{code}: accepted"));
        assert_eq!(error.code().as_str(), code, "{error}");
        let page = stiction_testkit::workspace().join(format!("docs/codes/{code}.md"));
        assert!(page.is_file(), "{code}");
        bench.plain(&error.to_string())
    };
    let of = |m| with(&[&log], method(m));
    assert!(refused(&of(Method::Static), "too-few-speeds").contains("log.csv"));
    refused(&of(Method::StaticThenDynamic), "too-few-speeds");
    assert!(refused(&of(Method::PreslidingStep), "no-step").contains("log.csv"));
    let ramp = Procedures {
        break_away: vec![other.clone()],
        ..Procedures::default()
    };
    let message = refused(&with(&[&log], ramp), "no-break-away");
    assert!(
        message.contains("other.csv") && !message.contains("log.csv:"),
        "{message}"
    );
    let statics = Procedures {
        statics: vec![other.clone()],
        ..Procedures::default()
    };
    refused(&with(&[&log], statics), "usage");
    let twice = Procedures {
        statics: vec![log.clone()],
        ..method(Method::StaticThenDynamic)
    };
    refused(&with(&[&log], twice), "usage");
    for m in [Method::Static, Method::PreslidingStep] {
        let split = of(m).but(|asked| asked.split = Some(0.5));
        refused(&split, "usage");
        let dahl = of(m).but(|asked| asked.law = Some(LawKind::Dahl));
        refused(&dahl, "usage");
    }
    let model = |text: &str| Procedures {
        model: Some(bench.write("model.toml", text)),
        ..method(Method::StaticThenDynamic)
    };
    refused(&with(&[&log], model("schema = 3")), "bad-config");
    let missing = Procedures {
        model: Some(bench.path("none.toml")),
        ..method(Method::StaticThenDynamic)
    };
    refused(&with(&[&log], missing), "bad-config");
}

/// Measured recordings: the servo moves at .017 to .027 N m, on ramps of 1/60 N m/s; the benchmark axis
/// has its constant velocities in its reference, and the map agrees with the published least squares.
#[test]
fn measured_recordings() {
    let Some(data) = stiction_testkit::recordings() else {
        return;
    };
    let axis = |name: &str| Some(stiction_testkit::workspace().join("validation").join(name));
    let ramps = Procedures {
        break_away: (1..=5)
            .map(|k| data.join(format!("servo/breakaway_{k}.txt")))
            .collect(),
        ..Procedures::default()
    };
    let servo = with(&[&data.join("servo/sliding_1.txt")], ramps).but(|asked| {
        asked.files.axis = axis("servo.toml");
        asked.law = Some(LawKind::CoulombViscous);
    });
    for found in &run(&servo).unwrap().result.break_away {
        println!(
            "{}: {} N m at {} N m/s",
            found.path, found.force, found.rate
        );
        assert!((0.017..=0.0275).contains(&found.force), "{found:?}");
        assert!((found.rate * 60.0 - 1.0).abs() < 0.01);
        assert_eq!(found.predicted_force, None);
    }
    let emps = with(&[&data.join("emps/DATA_EMPS.mat")], method(Method::Static)).but(|asked| {
        asked.files.axis = axis("emps.toml");
        (asked.law, asked.asymmetric) = (Some(LawKind::CoulombViscous), true);
    });
    let emps = run(&emps).unwrap();
    let value = |name: &str| {
        let found = emps.result.parameters.iter().find(|p| p.name == name);
        found.unwrap().value
    };
    let points = &emps.result.static_map.as_ref().unwrap().points;
    let [pos, neg] = ["pos", "neg"]
        .map(|s| value(&format!("coulomb_{s}")) + 0.1 * value(&format!("sigma2_{s}")));
    println!("{} points: {pos} and {neg} N at .1 m/s", points.len());
    assert!(points.len() >= 20);
    // Published, from the whole motion: 20.3935 N and 203.5034 N s/m, offset -3.1648 N.
    let friction = 20.3935 + 0.1 * 203.5034;
    assert!(
        (0.5 * (pos + neg) / friction - 1.0).abs() < 0.03,
        "{pos} {neg}"
    );
    assert!((0.5 * (pos - neg) + 3.1648).abs() < 1.0, "{pos} {neg}");
}

/// One log a speed, as many drives make them: each moves one way, and only all together say whether that matters.
#[test]
fn warnings_of_many_logs_are_said_once() {
    let bench = Bench::new();
    let log = |speed: f64| {
        let name = format!("{speed}.csv");
        let force = speed.signum() * 20.0 + 60.0 * speed;
        bench.log(&name, 2000, |t| speed * t, |i, _| force + 0.2 * noise(9, i))
    };
    let forward: Vec<PathBuf> = (1..8).map(|k| log(0.02 * f64::from(k))).collect();
    let back: Vec<PathBuf> = (1..8).map(|k| log(-0.02 * f64::from(k))).collect();
    let map = |logs: &[PathBuf]| {
        let paths: Vec<&Path> = logs.iter().map(PathBuf::as_path).collect();
        let asked = with(&paths, method(Method::Static));
        let asked = asked.but(|asked| asked.law = Some(LawKind::CoulombViscous));
        run(&asked).unwrap().result
    };
    let said = |result: &ResultFile| -> Vec<Code> {
        let codes = result.warnings.iter().map(|w| w.code);
        codes.filter(|code| *code == Code::OneDirection).collect()
    };
    assert_eq!(said(&map(&[forward.clone(), back].concat())), []);
    let one_way = map(&forward);
    assert_eq!(said(&one_way), [Code::OneDirection]);
    let mut codes: Vec<Code> = one_way.warnings.iter().map(|w| w.code).collect();
    codes.dedup();
    let distinct: std::collections::BTreeSet<&Code> = codes.iter().collect();
    assert_eq!(distinct.len(), codes.len(), "{:?}", one_way.warnings);
}

#[test]
fn terms_that_a_static_map_does_not_count_are_refused_with_their_key() {
    let bench = Bench::new();
    let log = bench.good("log.csv", 3);
    for (term, kind) in [
        ("gravity = true", "rotary"),
        ("quadratic_viscous = true", "linear"),
        ("coulomb_position = true", "linear"),
    ] {
        let text = format!("[terms]\n{term}\n");
        let asked = with(&[&log], method(Method::Static)).but(|asked| {
            asked.files.axis = Some(bench.write("axis.toml", &text));
        });
        if kind == "rotary" {
            let turned = std::fs::read_to_string(&log).unwrap();
            std::fs::write(
                &log,
                turned.replace("[mm]", "[mrad]").replace("[N]", "[N m]"),
            )
            .unwrap();
        }
        let error = run(&asked).unwrap_err();
        let (key, _) = term.split_once(' ').unwrap();
        assert_eq!(error.code(), Code::BadConfig);
        assert!(
            error.to_string().contains(&format!(", terms.{key}: given")),
            "{error}"
        );
        bench.good("log.csv", 3);
    }
}

/// Less searching than by default, as an axis file asks for it.
/// Levels that changed between the constant velocities and the motion are named; what was held or found with them is no
/// constant of the machine, and the motion is identified by itself next.
#[test]
fn a_motion_with_another_friction_than_the_map_is_named() {
    let bench = Bench::new();
    let logs = stiction_workflows::demo::procedures(bench.dir(), 0)
        .unwrap()
        .0;
    let (speeds, motion) = (&logs[0], &logs[1]);
    let text = std::fs::read_to_string(motion).unwrap();
    for by in [1.03, 1.2, 0.8] {
        // Everything of the motion but its time and place.
        let rows = text.lines().map(|row| {
            let (rest, force) = row.rsplit_once(',').unwrap();
            match force.parse::<f64>() {
                Ok(force) => format!("{rest},{}", by * force),
                Err(_) => row.to_string(),
            }
        });
        let changed = bench.write("changed.csv", &rows.collect::<Vec<_>>().join("\n"));
        let both = Procedures {
            statics: vec![speeds.clone()],
            ..method(Method::StaticThenDynamic)
        };
        let result = run(&with(&[&changed], both)).unwrap().result;
        let named = result
            .warnings
            .iter()
            .find(|w| w.code == Code::LogsDisagree);
        assert_eq!(named.is_some(), by != 1.03, "{by}: {:?}", result.warnings);
        let Some(warning) = named else { continue };
        assert!(
            warning.message.contains("coulomb is"),
            "{}",
            warning.message
        );
        assert!(!result.trust.trustworthy);
        assert_eq!(
            result.trust.next,
            stiction_files::result::Action::LetTheDataChoose
        );
        for name in ["coulomb", "static", "sigma0", "sigma1", "mass"] {
            assert!(
                result.trust.open.iter().any(|open| open == name),
                "{by}: {name}"
            );
        }
    }
}

const SEARCH: &str = "[search.ga]
population = 20
generations = 40
[search.adaptive-ga]
population = 20
generations = 40
[search.annealing-ga]
population = 20
generations = 20
rounds = 2
[search.box]
sigma0 = [\"1e4 N/m\", \"1e7 N/m\"]
sigma1 = [\"10 N s/m\", \"1e5 N s/m\"]
sigma2 = [\"1 N s/m\", \"1e3 N s/m\"]
coulomb = [\"1 N\", \"100 N\"]
static_excess = [\"0.1 N\", \"100 N\"]
stribeck_velocity = [\"0.1 mm/s\", \"100 mm/s\"]
";

/// Both steps of the paper, each by a search with settings and a box of the axis file, then least squares.
#[test]
#[ignore = "soak: a search alone beside it"]
fn both_steps_by_a_search() {
    let bench = Bench::new();
    let logs = stiction_workflows::demo::procedures(bench.dir(), 0)
        .unwrap()
        .0;
    let (speeds, motion) = (&logs[0], &logs[1]);
    let axis = bench.write("axis.toml", SEARCH);
    for name in ["ga", "adaptive-ga", "annealing-ga", "niched-ga"] {
        let mut asked = with(
            &[motion],
            Procedures {
                statics: vec![speeds.clone()],
                ..method(Method::StaticThenDynamic)
            },
        );
        asked.files.axis = Some(axis.clone());
        asked.searching.search = Some(name);
        let outcome = run(&asked).unwrap();
        near_truth(&outcome, 0.01);
        let result = &outcome.result;
        let curve = result.static_map.as_ref().unwrap().searched.as_ref();
        let (curve, bristle) = (curve.unwrap(), result.searched.as_ref().unwrap());
        assert_eq!(
            (curve.method.as_str(), curve.cost.as_str()),
            (name, "curve")
        );
        assert_eq!(
            (bristle.method.as_str(), bristle.cost.as_str()),
            (name, "dynamic")
        );
        assert_eq!(bristle.unknowns, ["sigma0", "sigma1"]);
        for (found, expected) in bristle.bounds.iter().zip([[1e4, 1e7], [10.0, 1e5]]) {
            let off = |i: usize| (found[i] / expected[i] - 1.0).abs();
            assert!(off(0) < 1e-12 && off(1) < 1e-12, "{found:?}");
        }
        if name == "ga" {
            // 20 individuals through 40 generations, and the first ones.
            assert!(
                curve.evaluations.costs <= 20 * 41,
                "{:?}",
                curve.evaluations
            );
        }
    }
}

/// Without least squares the parameters are those of the search, to the digit, with the error that the search saw, and none
/// has an interval.
#[test]
fn a_search_alone() {
    let bench = Bench::new();
    let logs = stiction_workflows::demo::procedures(bench.dir(), 0)
        .unwrap()
        .0;
    let (speeds, motion) = (&logs[0], &logs[1]);
    let in_steps = Procedures {
        statics: vec![speeds.clone()],
        ..method(Method::StaticThenDynamic)
    };
    for (procedures, search, cost) in [
        (in_steps, Some("ga"), "dynamic"),
        (method(Method::from_name("ga").unwrap()), None, "six"),
        (method(Method::from_name("de").unwrap()), None, "separable"),
    ] {
        let mut asked = with(&[motion], procedures);
        if cost != "separable" {
            asked.files.axis = Some(bench.write("axis.toml", SEARCH));
        }
        asked.searching.search = search;
        asked.searching.no_finish = true;
        asked.searching.evaluations = Some(600);
        let outcome = run(&asked).unwrap();
        let result = &outcome.result;
        assert_eq!(result.trust.next, stiction_files::result::Action::Finish);
        assert!(result.trust.reasons[0].contains("no intervals"), "{cost}");
        let searched = result.searched.as_ref().unwrap();
        assert_eq!(searched.cost, cost);
        let spent = &searched.evaluations;
        let spent = spent.costs + spent.derivatives + spent.coarse_costs;
        assert!(
            spent > 0 && result.search.evaluations as u64 >= spent,
            "{cost}"
        );
        let own = searched.own.as_ref().unwrap();
        for found in &own.parameters {
            let given = result.parameters.iter().find(|p| p.name == found.name);
            let given = given.unwrap_or_else(|| panic!("{cost}: {}", found.name));
            let off = (given.value / found.value - 1.0).abs();
            assert!(
                off < 1e-9,
                "{cost} {}: {} {}",
                found.name,
                given.value,
                found.value
            );
        }
        for p in result
            .parameters
            .iter()
            .filter(|p| p.origin == Origin::Identified)
        {
            assert!(
                p.std.is_none() && p.ci95.is_none() && !p.identifiable,
                "{p:?}"
            );
        }
        let seen = 100.0 * own.cost.sqrt();
        let stated = result.fit.relative_error_percent;
        assert!(
            (stated / seen - 1.0).abs() < 1e-3,
            "{cost}: {stated} {seen}"
        );
    }
    let mut asked = with(&[motion], Procedures::default());
    asked.searching.no_finish = true;
    let refused = run(&asked).unwrap_err().to_string();
    assert!(refused.contains("no_finish"), "{refused}");
}

/// A box that keeps the search from the curve: least squares find it, and the box is named.
#[test]
fn a_box_off_the_truth_does_not_decide() {
    let bench = Bench::new();
    let logs = stiction_workflows::demo::procedures(bench.dir(), 0)
        .unwrap()
        .0;
    let alone = run(&with(&[&logs[0]], method(Method::Static))).unwrap();
    for range in [
        "sigma2 = [\"600 N s/m\", \"6000 N s/m\"]",
        "stribeck_velocity = [\"0.1 m/s\", \"0.2 m/s\"]",
    ] {
        let mut asked = with(&[&logs[0]], method(Method::Static));
        let text = format!("[search.lm]\nstarts = 2\n[search.box]\n{range}\n");
        asked.files.axis = Some(bench.write("off.toml", &text));
        asked.searching.search = Some("lm");
        let outcome = run(&asked).unwrap();
        assert_eq!(
            outcome.result.parameters, alone.result.parameters,
            "{range}"
        );
        let warnings = &outcome.result.warnings;
        let named = warnings.iter().any(|w| w.message.contains("[search.box]"));
        assert!(named, "{warnings:?}");
        // The end of the box is no answer to compare with one; that beside it is.
        let said = text::outcome(&outcome);
        let mut rows = said.lines().filter(|row| row.contains("not comparable"));
        let (row, more) = (rows.next().expect(&said), rows.next());
        assert!(
            range.starts_with(row.split_whitespace().next().unwrap()),
            "{row}"
        );
        assert!(more.is_none() && said.contains("off by itself"), "{said}");
    }
    // Without a search the box does not decide either, and what lies outside is named.
    let mut asked = with(&[&logs[1]], Procedures::default());
    let text = "[search.box]\nsigma0 = [\"1e10 N/m\", \"1e12 N/m\"]\nsigma2 = [\"1 N s/m\", \"1e3 N s/m\"]\n";
    asked.files.axis = Some(bench.write("off.toml", text));
    let warnings = run(&asked).unwrap().result.warnings;
    let outside = warnings.iter().filter(|w| w.code.as_str() == "outside-box");
    let outside: Vec<_> = outside.map(|w| w.message.as_str()).collect();
    let [said] = outside.as_slice() else {
        panic!("{warnings:?}");
    };
    assert!(
        said.contains("sigma0 = 1") && said.contains("not 1e10 to 1e12"),
        "{said}"
    );
    assert!(!said.contains("sigma2"), "{said}");
}

/// A search where none is made, or a setting that it cannot have there.
#[test]
fn searches_of_steps_are_refused_elsewhere() {
    let bench = Bench::new();
    let logs = stiction_workflows::demo::procedures(bench.dir(), 0)
        .unwrap()
        .0;
    let refused = |method_: Method, change: &dyn Fn(&mut Asked)| {
        let mut asked = with(&[&logs[0]], method(method_));
        change(&mut asked);
        bench.plain(&run(&asked).unwrap_err().to_string())
    };
    let texts = [
        refused(Method::Separable, &|o| o.searching.search = Some("ga")),
        refused(Method::Searched("ga"), &|o| o.searching.search = Some("de")),
        refused(Method::Static, &|o| o.searching.search = Some("gaa")),
        refused(Method::Static, &|o| o.searching.target = Some(1.0)),
        refused(Method::Static, &|o| {
            o.searching.search = Some("ga");
            o.searching.checkpoint = Some("c.json".into());
        }),
        refused(Method::Static, &|o| {
            o.searching.search = Some("ga");
            let text = "[search.box]\nsigma2 = [\"1 N\", \"2 N\"]\n";
            o.files.axis = Some(bench.write("box.toml", text));
        }),
        refused(Method::Searched("de"), &|o| {
            let text = "[search.box]\nsigma2 = [\"1 N s/m\", \"2 N s/m\"]\n";
            o.files.axis = Some(bench.write("ratios.toml", text));
        }),
    ];
    insta::assert_snapshot!(texts.join("\n"));
}
