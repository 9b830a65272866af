//! Whole identifications on made logs: what is refused, what is flagged, what is written.

use crate::common;
use crate::common::{Asked, Bench, both_ways, friction, noise, options};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;
use stiction_files::check_folder;
use stiction_files::result::{Origin, ResultFile, Status};
use stiction_files::{Axis, ModelFile};
use stiction_identify::{Control, Observer, Progress, Silent, Stage};
use stiction_parameters::LawKind;
use stiction_workflows::Error;
use stiction_workflows::Setting;
use stiction_workflows::identify::Method;
use stiction_workflows::identify::Outcome;

fn run(options: &Asked) -> Result<Outcome, stiction_workflows::Error> {
    options.identify(&mut Silent)
}

fn value(outcome: &Outcome, name: &str) -> f64 {
    let found = outcome.result.parameters.iter().find(|p| p.name == name);
    found.unwrap_or_else(|| panic!("no {name}")).value
}

fn has_page(code: &str) -> bool {
    let pages = stiction_testkit::workspace().join("docs/codes");
    pages.join(format!("{code}.md")).is_file()
}

/// A travel of kilometres is that of a wrong unit: nothing of the law may be used, and the axis file is where it is set right.
#[test]
fn a_size_of_no_machine_is_not_trusted() {
    let bench = Bench::new();
    let file = bench.log(
        "km.csv",
        8000,
        |t| 3e5 * both_ways(t)[0],
        |i, t| friction(both_ways(t)) + noise(5, i),
    );
    let result = run(&options(&[&file], LawKind::CoulombViscous))
        .unwrap()
        .result;
    assert!(!result.trust.trustworthy);
    assert_eq!(result.trust.next, stiction_files::result::Action::AxisFile);
    assert!(
        result
            .trust
            .reasons
            .iter()
            .any(|reason| reason.contains("machines have"))
    );
}

/// Logs from which nothing, or not everything, can be identified: an error, or a result that says no.
#[test]
fn poor_logs_are_refused_or_flagged() {
    let bench = Bench::new();
    let n = 4000;
    let sine = |t: f64| both_ways(t)[0];
    let one_way = |t: f64| {
        [
            0.05 * t + 0.005 * (6.0 * t).sin(),
            0.05 + 0.03 * (6.0 * t).cos(),
            -0.18 * (6.0 * t).sin(),
        ]
    };
    let logs = [
        (
            "constant velocity",
            bench.log("constant.csv", n, |t| 0.1 * t, |i, _| 26.0 + noise(1, i)),
        ),
        (
            "no motion",
            bench.log("rest.csv", n, |_| 0.1, |i, _| 5.0 + noise(2, i)),
        ),
        (
            "no motion but noise",
            bench.log(
                "buzz.csv",
                n,
                |t| 0.1 + 1e-6 * noise(3, (t * 1e3) as usize),
                |i, _| 5.0 + noise(4, i),
            ),
        ),
        (
            "pure noise",
            bench.log(
                "noise.csv",
                n,
                |t| 1e-3 * noise(5, (t * 1e3) as usize),
                |i, _| noise(6, i),
            ),
        ),
        (
            "20 samples",
            bench.log("short.csv", 20, sine, |_, t| friction(both_ways(t))),
        ),
        (
            "2 samples",
            bench.log("two.csv", 2, sine, |_, t| friction(both_ways(t))),
        ),
        ("no samples", bench.log("none.csv", 0, sine, |_, _| 0.0)),
        (
            "one direction only",
            bench.log(
                "oneway.csv",
                n,
                move |t| one_way(t)[0],
                move |i, t| friction(one_way(t)) + 0.1 * noise(7, i),
            ),
        ),
        (
            "saturated force",
            bench.log("saturated.csv", n, sine, |_, t| {
                friction(both_ways(t)).clamp(-15.0, 15.0)
            }),
        ),
        ("no force", bench.log("zero.csv", n, sine, |_, _| 0.0)),
        ("constant force", bench.log("same.csv", n, sine, |_, _| 7.0)),
        (
            "force unrelated to motion",
            bench.log("other.csv", n, sine, |i, _| 9.0 * noise(8, i)),
        ),
    ];
    let mut out = String::new();
    for (what, log) in &logs {
        for law in [LawKind::CoulombViscous, LawKind::LuGre, LawKind::Gms] {
            let _ = writeln!(out, "{what}, {}", law.name());
            match run(&options(&[log], law)) {
                Err(e) => {
                    assert!(has_page(e.code().as_str()), "{}", e.code());
                    let _ = writeln!(
                        out,
                        "    error [{}] {}",
                        e.code(),
                        bench.plain(&e.to_string())
                    );
                }
                Ok(outcome) => {
                    let trust = &outcome.result.trust;
                    assert!(!trust.trustworthy, "{what}: trusted");
                    for reason in &trust.reasons {
                        let _ = writeln!(out, "    not trustworthy: {}", bench.plain(reason));
                    }
                    let codes: BTreeSet<&str> = outcome
                        .result
                        .warnings
                        .iter()
                        .map(|w| w.code.as_str())
                        .collect();
                    for code in &codes {
                        assert!(has_page(code), "{code}");
                    }
                    let _ = writeln!(out, "    warnings: {codes:?}");
                    whole(&outcome);
                }
            }
        }
    }
    insta::assert_snapshot!(out);
}

/// Every file of an outcome can be read by what it is for, whatever the log was.
fn whole(outcome: &Outcome) {
    let bundle = stiction_pages::bundle::identification(outcome);
    let names: Vec<&str> = bundle.files().iter().map(|(name, _)| &**name).collect();
    let mut sorted = names.clone();
    // Where a study takes the law there is one.
    sorted.retain(|name| *name != "study.toml");
    sorted.sort_unstable();
    assert_eq!(
        sorted,
        ["fit.csv", "model.toml", "report.html", "result.json"]
    );
    for (name, bytes) in bundle.files() {
        let text = std::str::from_utf8(bytes).unwrap();
        match &**name {
            "result.json" => {
                let back: ResultFile = serde_json::from_str(text).unwrap();
                assert_eq!(back, outcome.result);
            }
            "model.toml" => {
                let back = ModelFile::parse(text).unwrap();
                assert_eq!(back, ModelFile::from_result(&outcome.result));
            }
            "report.html" => {
                stiction_testkit::assert_tables_fit(text);
                let options = roxmltree::ParsingOptions {
                    allow_dtd: true,
                    ..Default::default()
                };
                let tree = roxmltree::Document::parse_with_options(text, options).unwrap();
                let headings: Vec<String> = tree
                    .descendants()
                    .filter(|n| n.has_tag_name("h2"))
                    .map(|n| n.descendants().filter_map(|d| d.text()).collect())
                    .collect();
                for heading in [
                    "Parameters",
                    "Friction and velocity",
                    "Force in time",
                    "How sure",
                    "What was read, and how it was conditioned",
                ] {
                    assert!(
                        headings.iter().any(|h| h.contains(heading)),
                        "{heading}: {headings:?}"
                    );
                }
                // A page that anything may be mailed in: it fetches and runs nothing.
                for tag in ["script", "iframe", "link", "img", "object"] {
                    assert!(
                        !tree.descendants().any(|n| n.tag_name().name() == tag),
                        "<{tag}>"
                    );
                }
                assert!(
                    tree.descendants()
                        .filter(|n| n.tag_name().name() == "svg")
                        .count()
                        >= 6
                );
                assert!(!text.contains("NaN"), "NaN in the report");
            }
            "study.toml" => assert!(text.contains("model   = \"model.toml\"")),
            _ => assert!(text.starts_with("time [s],measured [")),
        }
    }
}

#[test]
fn a_good_log_gives_the_truth() {
    let bench = Bench::new();
    let log = bench.good("good.csv", 1);
    let outcome = run(&options(&[&log], LawKind::CoulombViscous)).unwrap();
    assert!(
        outcome.result.trust.trustworthy,
        "{:?}",
        outcome.result.trust
    );
    for (name, truth) in [
        ("coulomb", 20.0),
        ("sigma2", 60.0),
        ("mass", 9.0),
        ("offset", 1.0),
    ] {
        let found = value(&outcome, name);
        assert!((found / truth - 1.0).abs() < 0.02, "{name} = {found}");
    }
    whole(&outcome);
}

/// A given mass stays as given, and what is named in the axis file counts.
#[test]
fn the_axis_file_counts() {
    let bench = Bench::new();
    let log = bench.good("good.csv", 2);
    let axis = bench.write(
        "axis.toml",
        "name = \"<b>X & Y</b>\"\nmass = \"9 kg\"\n[log]\ncrop = [\"1 s\", \"5 s\"]\n[report]\nlow_speed = \"20 mm/s\"\n",
    );
    let mut options = options(&[&log], LawKind::CoulombViscous);
    options.files.axis = Some(axis);
    let outcome = run(&options).unwrap();
    let mass = outcome
        .result
        .parameters
        .iter()
        .find(|p| p.name == "mass")
        .unwrap();
    assert_eq!((mass.value, mass.origin), (9.0, Origin::Given));
    assert_eq!(outcome.result.inputs[0].samples, 4001);
    assert_eq!(outcome.result.low_speed.as_ref().unwrap().bound, 0.02);
    whole(&outcome);
    options.files.axis = Some(bench.write("wrong.toml", "mass = \"9 kg m2\"\n"));
    let error = run(&options).unwrap_err();
    assert_eq!(error.code().as_str(), "bad-config");
}

/// `fit.csv` is itself a log: the reader gives back the numbers, bit for bit.
#[test]
fn the_fit_is_a_log() {
    let bench = Bench::new();
    let (a, b) = (bench.good("a.csv", 3), bench.good("b.csv", 4));
    for logs in [vec![a.as_path()], vec![a.as_path(), b.as_path()]] {
        let outcome = run(&options(&logs, LawKind::CoulombViscous)).unwrap();
        let bundle = stiction_pages::bundle::identification(&outcome);
        let fit = &bundle
            .files()
            .iter()
            .find(|(name, _)| *name == "fit.csv")
            .unwrap()
            .1;
        let file = bench.path("fit.csv");
        std::fs::write(&file, fit).unwrap();
        let table = stiction_workflows::source::table(&file, &Axis::default()).unwrap();
        let series = &outcome.law().series;
        assert_eq!(table.columns[0].name, "time");
        assert_eq!(table.columns[1].unit.as_deref(), Some("N"));
        assert_eq!(table.columns[0].values, series.time);
        assert_eq!(table.columns[1].values, series.measured);
        assert_eq!(table.columns[2].values, series.model);
        assert_eq!(table.columns[3].values, series.residual());
        assert_eq!(table.columns[4].values, series.position);
        assert_eq!(table.columns[5].unit.as_deref(), Some("m/s"));
        assert_eq!(table.columns[6].values, series.other);
        assert_eq!(table.columns.len(), 6 + logs.len());
    }
}

fn names(dir: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(dir)
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn the_folder_is_whole_or_untouched() {
    let bench = Bench::new();
    let log = bench.good("good.csv", 5);
    let outcome = run(&options(&[&log], LawKind::CoulombViscous)).unwrap();
    let bundle = stiction_pages::bundle::identification(&outcome);
    let out = bench.path("deep/er/out");
    check_folder(&out, false).unwrap();
    assert!(!bench.path("deep").exists(), "a check makes nothing");
    let written = bundle.write(&out).unwrap();
    assert_eq!(written.last().unwrap(), &out.join("result.json"));
    let four = ["fit.csv", "model.toml", "report.html", "result.json"];
    assert_eq!(names(&out), four);
    for (name, bytes) in bundle.files() {
        assert_eq!(&std::fs::read(out.join(&**name)).unwrap(), bytes);
    }
    // Its own folder may be written again.
    check_folder(&out, false).unwrap();
    bundle.write(&out).unwrap();
    assert_eq!(names(&out), four);

    let foreign = bench.path("foreign");
    std::fs::create_dir(&foreign).unwrap();
    check_folder(&foreign, false).unwrap();
    std::fs::write(foreign.join("thesis.doc"), "years of work").unwrap();
    let error = check_folder(&foreign, false).unwrap_err();
    assert_eq!(error.code().as_str(), "output");
    check_folder(&foreign, true).unwrap();
    bundle.write(&foreign).unwrap();
    assert_eq!(
        std::fs::read(foreign.join("thesis.doc")).unwrap(),
        b"years of work"
    );

    // A result of somebody else's is not ours.
    let other = bench.path("other");
    std::fs::create_dir(&other).unwrap();
    std::fs::write(other.join("result.json"), "{\"schema\": \"theirs\"}").unwrap();
    assert_eq!(
        check_folder(&other, false).unwrap_err().code().as_str(),
        "output"
    );

    // A file that cannot be replaced stops everything before anything is replaced.
    let blocked = bench.path("blocked");
    std::fs::create_dir_all(blocked.join("result.json")).unwrap();
    assert_eq!(
        bundle.write(&blocked).unwrap_err().code().as_str(),
        "output"
    );
    assert_eq!(names(&blocked), ["result.json"]);

    for bad in [log.clone(), log.join("sub")] {
        assert_eq!(
            check_folder(&bad, true).unwrap_err().code().as_str(),
            "output"
        );
        assert_eq!(bundle.write(&bad).unwrap_err().code().as_str(), "output");
    }
}

/// A file that was edited since, and one that belongs to an earlier result alone, is kept under another name.
#[test]
fn edits_are_kept() {
    let bench = Bench::new();
    let log = bench.good("good.csv", 5);
    let outcome = run(&options(&[&log], LawKind::CoulombViscous)).unwrap();
    let bundle = stiction_pages::bundle::identification(&outcome);
    let out = bench.path("out");
    bundle.write(&out).unwrap();
    assert!(bundle.kept(&out).is_empty());
    let edit = |name: &str, text: &str| {
        std::fs::write(out.join(name), text).unwrap();
        let file = std::fs::File::options()
            .write(true)
            .open(out.join(name))
            .unwrap();
        let later = std::time::SystemTime::now() + std::time::Duration::from_secs(2);
        file.set_modified(later).unwrap();
    };
    edit("model.toml", "mine");
    // This law has no study.
    edit("study.toml", "of a law before");
    let kept = [
        ("model.toml", "model-1.toml"),
        ("study.toml", "study-1.toml"),
    ];
    let kept = kept.map(|(from, to)| (out.join(from), out.join(to)));
    assert_eq!(bundle.kept(&out), kept);
    bundle.write(&out).unwrap();
    let four = [
        "fit.csv",
        "model-1.toml",
        "model.toml",
        "report.html",
        "result.json",
        "study-1.toml",
    ];
    assert_eq!(names(&out), four);
    let text = |name: &str| std::fs::read_to_string(out.join(name)).unwrap();
    assert_eq!(
        (text("model-1.toml"), text("study-1.toml")),
        ("mine".into(), "of a law before".into())
    );
    edit("model.toml", "again");
    bundle.write(&out).unwrap();
    assert_eq!(text("model-2.toml"), "again");
}

/// What was stopped early does not take the place of a complete result.
#[test]
fn a_complete_result_stays() {
    let bench = Bench::new();
    let log = bench.good("good.csv", 5);
    let mut outcome = run(&options(&[&log], LawKind::CoulombViscous)).unwrap();
    let out = bench.path("out");
    let whole = stiction_pages::bundle::identification(&outcome);
    outcome.result.search.status = Status::Interrupted;
    let part = stiction_pages::bundle::identification(&outcome);
    let schema = stiction_files::result::SCHEMA;
    let beside = |bundle| stiction_pages::bundle::beside_complete(bundle, &out, schema, false);
    let late = |bundle| stiction_pages::bundle::beside_complete(bundle, &out, schema, true);
    assert_eq!(late(&whole), None);
    assert_eq!(beside(&part), None);
    whole.write(&out).unwrap();
    assert_eq!(beside(&whole), None);
    assert_eq!(beside(&part), Some(bench.path("out-interrupted")));
    // Stopped after its search had ended, it says nothing of that itself.
    assert_eq!(late(&whole), Some(bench.path("out-interrupted")));
    // Nor that of something else beside it.
    std::fs::create_dir(bench.path("out-interrupted")).unwrap();
    let thesis = bench.path("out-interrupted").join("thesis.doc");
    std::fs::write(thesis, "years of work").unwrap();
    assert_eq!(beside(&part), Some(bench.path("out-interrupted-2")));
    part.write(&out).unwrap();
    assert_eq!(beside(&part), None);
}

/// A pipe of the name of a result must not make anyone wait.
#[cfg(unix)]
#[test]
fn a_pipe_is_no_result() {
    let bench = Bench::new();
    let pipe = bench.path("result.json");
    let made = std::process::Command::new("mkfifo")
        .arg(&pipe)
        .status()
        .unwrap();
    assert!(made.success());
    assert_eq!(
        check_folder(bench.dir(), false)
            .unwrap_err()
            .code()
            .as_str(),
        "output"
    );
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let bench = Bench::new();
    let log = bench.good("good.csv", 6);
    for law in [LawKind::CoulombViscous, LawKind::LuGre] {
        let mut options = options(&[&log], law);
        options.seed = u64::MAX;
        options.compare_laws = law == LawKind::CoulombViscous;
        let (a, b) = (
            stiction_pages::bundle::identification(&run(&options).unwrap()),
            stiction_pages::bundle::identification(&run(&options).unwrap()),
        );
        for ((name, a), (_, b)) in a.files().iter().zip(b.files()) {
            // Only result.json tells how long it took.
            if *name != "result.json" {
                assert!(a == b, "{name} differs");
            }
        }
    }
}

#[test]
fn validation_and_split() {
    let bench = Bench::new();
    let (a, b) = (bench.good("a.csv", 7), bench.good("b.csv", 8));
    let mut with = options(&[&a], LawKind::CoulombViscous);
    with.files.validate = vec![b.clone()];
    let outcome = run(&with).unwrap();
    let held_out = &outcome.result.validation[0];
    assert_eq!(held_out.path, b.display().to_string());
    // The law is the truth, so unseen data leave what the noise leaves.
    let ratio = held_out.fit.rmse / outcome.result.fit.rmse;
    assert!((0.9..1.1).contains(&ratio), "{ratio}");
    whole(&outcome);

    let mut split = options(&[&a], LawKind::CoulombViscous);
    split.split = Some(0.5);
    let outcome = run(&split).unwrap();
    let (fit, rest) = (&outcome.result.fit, &outcome.result.validation[0].fit);
    let whole_log = run(&options(&[&a], LawKind::CoulombViscous)).unwrap();
    assert_eq!(fit.samples + rest.samples, whole_log.result.fit.samples);
    assert!(
        fit.samples.abs_diff(rest.samples) <= 60,
        "{} {}",
        fit.samples,
        rest.samples
    );
    whole(&outcome);

    for part in [0.0, 1.0, -0.5, 1.5, f64::NAN, f64::INFINITY] {
        split.split = Some(part);
        assert_eq!(run(&split).unwrap_err().code().as_str(), "usage", "{part}");
    }
    // One sample is one sample.
    let usable = whole_log.result.fit.samples as f64;
    let mut alone = [0.5, 1.0, 1.5].map(|rest| {
        split.split = Some(1.0 - rest / usable);
        run(&split).unwrap_err().to_string()
    });
    alone.sort();
    assert!(
        alone
            .iter()
            .any(|said| said.contains(" leaves 1 sample to validate on")),
        "{alone:?}"
    );
    // Too little to fit, too little to validate on: the share is named.
    for (part, left) in [
        (1e-6, " leaves 0 samples to fit"),
        (1.0 - 1e-6, " to validate on"),
    ] {
        split.split = Some(part);
        let error = run(&split).unwrap_err();
        assert_eq!(error.code().as_str(), "usage");
        assert!(error.to_string().contains(left), "{error}");
        // And the one that is named leaves enough of both.
        let Error::Usage { allowed, .. } = error else {
            panic!("{error}")
        };
        let share = allowed.value(Setting::Split).unwrap();
        split.split = Some(share.parse().unwrap());
        whole(&run(&split).unwrap());
    }
}

/// Where the measured force never changes there is no variance to explain; the files stay readable.
#[test]
fn a_validation_without_variance_can_be_read_back() {
    let bench = Bench::new();
    let log = |name: &str, force: &dyn Fn(f64) -> f64| {
        let mut text = String::from("Time [s],Velocity [m/s],Force [N]\n");
        for i in 0..4000 {
            let t = f64::from(i) / common::RATE;
            let _ = writeln!(text, "{t:.4},{:.9},{:.6}", both_ways(t)[1], force(t));
        }
        bench.write(name, &text)
    };
    let good = log("good.csv", &|t| friction(both_ways(t)));
    let same = log("same.csv", &|_| 5.0);
    let mut options = options(&[&good], LawKind::CoulombViscous);
    options.files.validate = vec![same];
    whole(&run(&options).unwrap());
}

#[test]
fn logs_of_different_axes_are_not_mixed() {
    let bench = Bench::new();
    let good = bench.good("good.csv", 9);
    let text = std::fs::read_to_string(&good).unwrap();
    let rotary = bench.write(
        "rotary.csv",
        &text
            .replace("[mm]", "[deg]")
            .replace("Force [N]", "Torque [Nm]"),
    );
    let current = bench.write("current.csv", &text.replace("Force [N]", "Current [A]"));
    for other in [rotary, current] {
        let mixed = options(&[&good, &other], LawKind::CoulombViscous);
        assert_eq!(run(&mixed).unwrap_err().code().as_str(), "usage");
        let mut validated = options(&[&good], LawKind::CoulombViscous);
        validated.files.validate = vec![other.clone()];
        assert_eq!(run(&validated).unwrap_err().code().as_str(), "usage");
    }
    assert_eq!(
        run(&options(&[], LawKind::LuGre))
            .unwrap_err()
            .code()
            .as_str(),
        "usage"
    );
}

/// A log of elastic elements between stops, through all files: what they do together is found, their
/// number chosen from those that were tried, and the start of the log left out.
#[test]
fn maxwell_slip_from_log_to_files() {
    let bench = Bench::new();
    let motion = |t: f64| 40e-6 * (6.3 * t).sin() + 8e-6 * (22.0 * t).sin();
    let elements = [(2e6, 3e-6), (4e5, 15e-6)];
    let mut z = [0.0_f64; 2];
    let mut force = Vec::new();
    for i in 0..8000 {
        let way = motion(i as f64 / common::RATE) - motion((i.max(1) - 1) as f64 / common::RATE);
        for (z, (_, d)) in z.iter_mut().zip(elements) {
            *z = (*z + way).clamp(-d, d);
        }
        force.push(z.iter().zip(elements).map(|(z, (k, _))| k * z).sum::<f64>());
    }
    let log = bench.log("elements.csv", 8000, motion, |i, _| {
        force[i] + 0.05 * noise(3, i)
    });
    let axis = bench.write("axis.toml", "mass = \"none\"\n");
    let mut options = options(&[&log], LawKind::MaxwellSlip);
    options.files.axis = Some(axis);
    options.compare_laws = true;
    let outcome = run(&options).unwrap();
    whole(&outcome);
    let result = &outcome.result;
    assert_eq!(result.law, "maxwell-slip");
    assert!(result.trust.trustworthy, "{:?}", result.trust);
    for (name, truth) in [("sigma0", 2.4e6), ("coulomb", 12.0)] {
        let off = value(&outcome, name) / truth - 1.0;
        assert!(off.abs() < 0.02, "{name} off by {off}");
    }
    assert_eq!(result.elements.iter().filter(|e| e.chosen).count(), 1);
    assert!(
        result
            .elements
            .iter()
            .all(|e| e.held_out_error_percent.is_some())
    );
    assert!(
        result
            .laws
            .iter()
            .any(|l| l.law == "maxwell-slip" && l.best)
    );
    let notes = &result.axis.conditioning;
    assert!(
        notes.iter().any(|n| n.contains("at the start not fitted")),
        "{notes:?}"
    );
}

/// Stops at the first sign of a stage.
struct StopAt(Stage);

impl Observer for StopAt {
    fn progress(&mut self, progress: &Progress) -> Control {
        match progress.stage == self.0 {
            true => Control::Stop,
            false => Control::Continue,
        }
    }
}

/// Stopped before the cut-offs are chosen, a search sees a record that the same command would not see again:
/// there is nothing to go on from, and the result says what it stands on.
#[test]
fn a_search_on_a_record_not_yet_chosen_keeps_no_state() {
    let bench = Bench::new();
    let log = bench.good("log.csv", 5);
    let mut options = options(&[&log], LawKind::LuGre);
    options.procedures.method = Method::Searched("niched-ga");
    options.searching.evaluations = Some(200);
    options.searching.checkpoint = Some(bench.path("c.json"));
    let stopped = options.identify(&mut StopAt(Stage::Tuning)).unwrap();
    let notes = stopped.result.axis.conditioning.join("\n");
    assert!(
        notes.contains("cut-offs not chosen: the run was stopped"),
        "{notes}"
    );
    assert!(!bench.path("c.json").exists());
    run(&options).unwrap();
    assert!(bench.path("c.json").exists());
}

/// A third, or half, of the force written as 0: friction and mass are those of the whole log. Offset
/// and delay are not compared: a line across a reversal moves the edge of the force by a part of a sample.
#[test]
fn zeros_for_missing_samples_are_not_fitted() {
    let bench = Bench::new();
    let fit = |name: &str, nth: usize| {
        let log = bench.log(
            name,
            6000,
            |t| both_ways(t)[0],
            |i, t| {
                if i % nth == 1 {
                    0.0
                } else {
                    friction(both_ways(t)) + 0.3 * noise(5, i)
                }
            },
        );
        let options = options(&[&log], LawKind::CoulombViscous);
        options.identify(&mut Silent).unwrap().result
    };
    let whole = fit("whole.csv", usize::MAX);
    for (name, nth) in [("third.csv", 3), ("half.csv", 2)] {
        let filled = fit(name, nth);
        assert!(
            filled
                .warnings
                .iter()
                .any(|w| w.code.as_str() == "zero-filled"),
            "{name}"
        );
        let both = whole.parameters.iter().zip(&filled.parameters);
        for (a, b) in both.filter(|(a, _)| !["offset", "delay"].contains(&a.name.as_str())) {
            let bound = 0.01 * a.value.abs() + 4.0 * a.std.unwrap_or(0.0);
            assert!(
                (a.value - b.value).abs() <= bound,
                "{name} {}: {} {}",
                a.name,
                a.value,
                b.value
            );
        }
    }
}

/// A Maxwell-slip law is fitted from where its start no longer has an effect: what is left is split, not the record.
#[test]
fn a_split_is_one_of_the_samples_that_count() {
    let bench = Bench::new();
    // One slow sweep over the whole range in the first half, quick motion within it after that.
    let motion = |t: f64| {
        let sweep = 0.02 * (1.0 - (std::f64::consts::PI * (t / 4.0).min(1.0)).cos());
        sweep - 0.004 * (1.0 - (9.0 * (t - 4.0).max(0.0)).cos())
    };
    let log = bench.log("late.csv", 8000, motion, |i, t| {
        let v = (motion(t + 1e-4) - motion(t - 1e-4)) / 2e-4;
        20.0 * (v / 1e-3).tanh() + 60.0 * v + 0.3 * noise(4, i)
    });
    let mut asked = options(&[&log], LawKind::MaxwellSlip);
    asked.files.axis =
        Some(bench.write("axis.toml", "mass = \"none\"\n[terms]\ngms_elements = 3\n"));
    asked.split = Some(0.5);
    let outcome = run(&asked).unwrap();
    let (fit, rest) = (&outcome.result.fit, &outcome.result.validation[0].fit);
    assert!(
        fit.samples.abs_diff(rest.samples) <= 2,
        "{} {}",
        fit.samples,
        rest.samples
    );
    whole(&outcome);
}

/// Results of earlier versions, whose next step was a name and whose cure was a line or a law alone.
#[test]
fn actions_of_earlier_results_are_read() {
    use stiction_files::result::{Action, Trust};
    let trust = |next: &str, cure: &str| -> Trust {
        let text = format!(
            r#"{{"trustworthy": true, "reasons": [], "next": {next}, "cause": {{"code": "law-shape", "text": "", "size": "", "cure": {cure}}}}}"#
        );
        serde_json::from_str(&text).unwrap()
    };
    let line = r#"{"table": "terms", "line": "gravity = true"}"#;
    let old = trust("\"check\"", line);
    assert_eq!(old.next, Action::CHECK);
    let cure = old.cause.clone().and_then(|cause| cause.cure);
    assert!(matches!(cure, Some(Action::Line { table, .. }) if table == "terms"));
    assert_eq!(trust("\"export\"", line).next, Action::Export);
    let law = trust("\"another-law\"", r#"{"law": "gms"}"#);
    assert_eq!(law.next, Action::LetTheDataChoose);
    let cure = law.cause.and_then(|cause| cause.cure);
    assert!(matches!(cure, Some(Action::Law { law, .. }) if law == "gms"));
    let text = serde_json::to_string(&old).unwrap();
    assert_eq!(serde_json::from_str::<Trust>(&text).unwrap(), old);
}
