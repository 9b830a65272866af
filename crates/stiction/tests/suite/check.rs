//! What `check` says of a log without a fit, and the axis files that it begins.

use crate::common::{Bench, both_ways, friction, noise, options};
use std::f64::consts::PI;
use std::path::Path;
use stiction_files::Axis;
use stiction_files::result::Action;
use stiction_identify::Silent;
use stiction_pages::text;
use stiction_parameters::LawKind;
use stiction_workflows::check::{Check, check, init};

fn checked(log: &Path, axis: Option<&Path>) -> Check {
    check(&[log.to_path_buf()], axis, &mut Silent).unwrap()
}

/// How a parameter is judged, and what to record.
fn shown(found: &Check, name: &str) -> (String, String) {
    let shows = &found.logs[0].shows;
    let hit = shows.iter().find(|s| s.name == name);
    let hit = hit.unwrap_or_else(|| panic!("no {name} in {shows:#?}"));
    (hit.shown.clone(), hit.record.clone())
}

fn judged(found: &Check, expected: &[(&str, &str)]) {
    for (name, verdict) in expected {
        let (shown, record) = shown(found, name);
        assert_eq!(shown, *verdict, "{name}: {:#?}", found.logs[0].shows);
        assert_eq!(
            record.is_empty(),
            *verdict == "possible",
            "{name}: {record}"
        );
    }
}

#[test]
fn a_motion_shows_what_it_has() {
    let bench = Bench::new();
    let found = checked(&bench.good("good.csv", 1), None);
    judged(
        &found,
        &[
            ("coulomb", "possible"),
            ("sigma2", "possible"),
            ("mass", "possible"),
            ("asymmetry", "possible"),
        ],
    );
    let text = text::check(&found);
    assert!(text.contains("1 \"Time [s]\""), "{text}");
    assert!(
        text.contains("by its name; its unit as the file has it"),
        "{text}"
    );
    let next = format!(
        "next: stiction identify {} --out result",
        bench.path("good.csv").display()
    );
    assert!(text.trim_end().ends_with(&next), "{text}");
}

#[test]
fn a_motion_shows_nothing_that_it_lacks() {
    let bench = Bench::new();
    let n = 4000;
    let one_way = bench.log("one_way.csv", n, |t| 0.05 * t, |i, _| 23.0 + noise(1, i));
    judged(
        &checked(&one_way, None),
        &[
            ("coulomb", "no"),
            ("sigma2", "no"),
            ("static", "no"),
            ("sigma0", "no"),
            ("sigma1", "no"),
            ("asymmetry", "no"),
        ],
    );
    // Fast to and fro: the force turns round at once, and low speeds are only passed.
    let turns = |t: f64| 0.05 * (2.0 / PI) * (40.0 * t).sin().asin();
    let fast = bench.log("fast.csv", n, turns, |i, t| {
        20.0 * (40.0 * t).cos().signum() + noise(2, i)
    });
    judged(
        &checked(&fast, None),
        &[
            ("coulomb", "possible"),
            ("static", "doubtful"),
            ("sigma0", "no"),
            ("sigma1", "no"),
        ],
    );
    // Slowly, and the force follows the distance from the last reversal, as that of bristles does.
    let slow = |t: f64| 2e-4 * (1.0 - (2.0 * t).cos());
    let bristles = |t: f64| {
        let forward = (2.0 * t).sin() > 0.0;
        let gone = if forward { slow(t) } else { 4e-4 - slow(t) };
        let level = 20.0 * (1.0 - 2.0 * (-gone / 2e-5).exp());
        if forward { level } else { -level }
    };
    let slow = bench.log("slow.csv", 12_000, slow, |i, t| {
        bristles(t) + 0.1 * noise(3, i)
    });
    judged(
        &checked(&slow, None),
        &[
            ("coulomb", "possible"),
            ("sigma0", "possible"),
            ("sigma1", "possible"),
        ],
    );
    let still = bench.log("still.csv", n, |_| 0.1, |i, _| 5.0 + noise(2, i));
    let found = checked(&still, None);
    assert!(found.logs[0].motion.is_none() && found.logs[0].shows.is_empty());
    assert!(
        text::check(&found).contains("record another log as another.csv"),
        "{}",
        text::check(&found)
    );
}

/// Dwells of half a second, in half of the time: too short to be left out, and dear.
#[test]
fn dwells_are_told_what_they_cost() {
    let bench = Bench::new();
    let rests = |name: &str, dwells: bool| {
        let turned = |t: f64| match dwells {
            true => PI * (t.floor() + (2.0 * t.fract()).min(1.0)),
            false => 2.0 * PI * t,
        };
        let log = bench.log(
            name,
            8000,
            |t| 0.02 * (1.0 - turned(t).cos()),
            |i, t| 20.0 * turned(t).sin().signum() + noise(4, i),
        );
        let found = checked(&log, None).logs.remove(0);
        let cost = found.shows.into_iter().find(|s| s.name == "rests");
        (cost, found.motion.unwrap().still)
    };
    let (cost, still) = rests("dwells.csv", true);
    assert!((still - 0.5).abs() < 0.05, "{still}");
    let cost = cost.unwrap();
    assert_eq!(cost.shown, "doubtful");
    assert!(cost.because.contains("times as wide"), "{}", cost.because);
    assert!(!cost.record.is_empty());
    let (cost, still) = rests("sine.csv", false);
    assert!(still < 0.05, "{still}");
    assert!(cost.is_none(), "{cost:?}");
}

/// Never to a command that would refuse the log.
#[test]
fn every_log_leads_on() {
    let bench = Bench::new();
    let moves = |t: f64| both_ways(t)[0];
    let rubs = |i: usize, t: f64| friction(both_ways(t)) + noise(4, i);
    let fast = |t: f64| 0.005 * (60.0 * t).sin();
    let logs = [
        (bench.log("good.csv", 4000, moves, rubs), Action::IDENTIFY),
        (bench.log("short.csv", 100, fast, rubs), Action::Simulate),
        (
            bench.log("off.csv", 4000, moves, |_, _| 0.0),
            Action::Record,
        ),
        (bench.log("still.csv", 4000, |_| 0.1, rubs), Action::Record),
        (
            bench.log("away.csv", 4000, |t| 0.1 * t, rubs),
            Action::Record,
        ),
    ];
    for (log, expected) in logs {
        let next = checked(&log, None).logs[0].next.clone();
        assert_eq!(next, expected, "{}", log.display());
    }
}

/// A force of the wrong sign is named, and the next step is the axis file, not another fit; gravity on a joint is fitted without a word in
/// an axis file.
#[test]
fn what_the_axis_file_lacks_is_named() {
    let bench = Bench::new();
    let joint = |t: f64| both_ways(t).map(|x| 40.0 * x);
    let text = |force: &dyn Fn(usize, f64) -> f64| {
        let row = |i: usize| {
            let t = i as f64 / 1000.0;
            format!("{t:.4},{:.6},{:.4}\n", joint(t)[0], force(i, t))
        };
        let rows: String = (0..6000).map(row).collect();
        format!("Time [s],Angle [rad],Torque [N m]\n{rows}")
    };
    let rubs = |i: usize, t: f64| {
        let [_, v, a] = joint(t);
        0.5 * v.signum() + 0.02 * v + 0.01 * a + 0.01 * noise(6, i)
    };
    let gravity = text(&|i, t| rubs(i, t) + 4.0 * joint(t)[0].sin());
    let wrong = text(&|i, t| -rubs(i, t));
    let log = bench.write("wrong.csv", &wrong);
    let found = checked(&log, None);
    let refused = found.logs[0].refused.as_deref().unwrap_or_default();
    assert!(refused.contains("invert = true"), "{refused}");
    assert_eq!(found.logs[0].next, Action::AxisFile);
    assert!(found.logs[0].parameters.iter().all(|p| !p.identifiable));
    let found = checked(&bench.write("arm.csv", &gravity), None);
    let arm = &found.logs[0];
    assert_eq!(arm.next, Action::IDENTIFY, "{:?}", arm.refused);
    let of_gravity = |name: &str| arm.parameters.iter().any(|p| p.name == name);
    assert!(of_gravity("gravity_sin") && of_gravity("gravity_cos"));
}

/// Two logs of an axis whose encoder was set to zero elsewhere before the second.
#[test]
fn a_fit_sees_the_reversals_that_check_sees() {
    let bench = Bench::new();
    let rubs = |i: usize, t: f64| friction(both_ways(t)) + noise(5, i);
    let first = bench.log("a.csv", 3000, |t| both_ways(t)[0], rubs);
    let second = bench.log("b.csv", 3000, |t| 2.0 + both_ways(t)[0], rubs);
    let found = [&first, &second].map(|log| checked(log, None).logs[0].motion.clone().unwrap());
    let asked = options(&[&first, &second], LawKind::CoulombViscous);
    let fit = asked.identify(&mut Silent).unwrap();
    let seen = fit.result.trust.compensation.as_ref().unwrap();
    assert_eq!(seen.reversals, found[0].reversals + found[1].reversals);
    let stroke = seen.stroke.unwrap();
    assert!((stroke / found[0].range - 1.0).abs() < 0.02, "{stroke}");
}

/// A log whose units stand nowhere, with an encoder of a millionth of whatever unit.
fn bare(bench: &Bench) -> std::path::PathBuf {
    // The numbers of its column are metres.
    let counts = |t: f64| (both_ways(t)[0] * 1e6).round() / 1e9;
    let log = bench.log("bare.csv", 6000, counts, |i, t| {
        friction(both_ways(t)) + 0.5 * noise(4, i)
    });
    let text = std::fs::read_to_string(&log).unwrap();
    let named = "Time [s],Position [mm],Force [N]";
    bench.write(
        "bare.csv",
        &text.replacen(named, "time,displacement,force", 1),
    )
}

#[test]
fn assumed_units_stand_at_the_head_of_every_result() {
    let bench = Bench::new();
    let log = bare(&bench);
    let found = options(&[&log], LawKind::CoulombViscous)
        .identify(&mut Silent)
        .unwrap();
    let lines: Vec<&str> = found.result.inputs[0]
        .assumed
        .iter()
        .map(|a| a.line.as_str())
        .collect();
    let expected = [
        "time = { column = \"time\", unit = \"s\" }",
        "position = { column = \"displacement\", unit = \"m\" }",
        "force = { column = \"force\", unit = \"N\" }",
    ];
    assert_eq!(lines, expected);
    let text = text::outcome(&found);
    let head = text.split("\n\n").next().unwrap();
    assert!(
        head.contains("[unit-assumed]") && head.contains(expected[1]),
        "{head}"
    );
    let bundle = stiction_pages::bundle::identification(&found);
    let (_, report) = bundle
        .files()
        .iter()
        .find(|(name, _)| *name == "report.html")
        .unwrap();
    let report = std::str::from_utf8(report).unwrap();
    let (said, table) = (report.find("units assumed"), report.find("<table"));
    assert!(said.is_some() && said < table, "{said:?} {table:?}");
    // With the lines written down nothing is assumed.
    let axis = bench.write(
        "axis.toml",
        &format!("kind = \"linear\"\n[columns]\n{}\n", lines.join("\n")),
    );
    let mut asked = options(&[&log], LawKind::CoulombViscous);
    asked.files.axis = Some(axis);
    let same = asked.identify(&mut Silent).unwrap();
    assert!(same.result.inputs[0].assumed.is_empty());
    assert!(!text::outcome(&same).contains("unit-assumed"));
}

#[test]
fn an_axis_file_is_begun_with_what_was_found() {
    let bench = Bench::new();
    let log = bare(&bench);
    let started = init(&log, None).unwrap();
    let axis = Axis::parse(&started.text).unwrap();
    let step = axis.mapping.resolution.unwrap();
    assert!((step / 1e-6 - 1.0).abs() < 1e-6, "{step}");
    assert!(
        started.text.contains("# the unit is assumed"),
        "{}",
        started.text
    );
    assert!(
        started
            .changes
            .iter()
            .any(|c| c == "position, its unit assumed"),
        "{:?}",
        started.changes
    );
}

#[test]
fn an_axis_file_is_kept_and_given_what_it_lacks() {
    let bench = Bench::new();
    let log = bare(&bench);
    let given = "# ours\nmass = \"9 kg\"\n\n[columns]\nposition = \"displacement\"\n\n[terms]\ndelay = \"none\"\n";
    let axis = bench.write("axis.toml", given);
    let started = init(&log, Some(&axis)).unwrap();
    let text = &started.text;
    assert!(
        text.starts_with("# ours\nmass = \"9 kg\"\nkind = \"linear\"\n"),
        "{text}"
    );
    assert!(
        text.contains("position = { column = \"displacement\", unit = \"m\" }"),
        "{text}"
    );
    assert!(text.contains("\n[terms]\ndelay = \"none\"\n"), "{text}");
    let said = started.changes.join("\n");
    assert!(said.contains("added: kind = \"linear\""), "{said}");
    assert!(
        said.contains("changed under [columns]: position = "),
        "{said}"
    );
    assert!(said.contains("added under [columns]: force = "), "{said}");
    assert!(said.contains("added under [log]: resolution = "), "{said}");
    // Once more there is nothing to add.
    let again = bench.write("again.toml", text);
    assert_eq!(init(&log, Some(&again)).unwrap().changes, [""; 0]);
}

#[test]
fn columns_without_names_are_described() {
    let bench = Bench::new();
    let mut rows = String::new();
    for i in 0..500 {
        let t = f64::from(i) * 1e-3;
        let state = both_ways(t);
        rows.push_str(&format!(
            "{t:.3} {:.6} {:.4} 0\n",
            state[0],
            friction(state)
        ));
    }
    let log = bench.write("bare.txt", &rows);
    let started = init(&log, None).unwrap();
    Axis::parse(&started.text).unwrap();
    assert!(started.undecided.is_some());
    let text = &started.text;
    assert!(
        text.contains(
            "#   1: (no name): 0 .. 0.4990, rises all the time, by 0.001000 a sample: time?"
        ),
        "{text}"
    );
    assert!(text.contains("#   4: (no name): 0 throughout"), "{text}");
}
