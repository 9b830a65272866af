//! An axis that changes while it runs: what a change does, what finds it, and what is refused.

use crate::study::{AXIS, CASCADE, Desk, SHORT, row, together};
use stiction_identify::Silent;
use stiction_workflows::study::StudyOutcome;

/// Twenty millimetres either way at 1.5 Hz for 9 s, counted from the sixth second on.
const LONG: &str = r#"
[[path]]
kind      = "sine"
amplitude = "20 mm"
frequency = "1.5 Hz"
cycles    = 13.5
skip      = "6 s"
"#;

const TAKEN_UP: &str = "\n[[event]]\ntime = \"3 s\"\nmass = \"6.9 kg\"\nfriction = 1.3\n";

fn compensator(name: &str, more: &str) -> String {
    format!(
        "\n[[compensator]]\nname = \"{name}\"\nkind = \"lugre\"\ngain = 1.0\nwatchdog = false\n{more}\n"
    )
}

fn outcome(desk: &Desk, parts: &[&str]) -> StudyOutcome {
    let outcome =
        stiction_workflows::study::simulate(&desk.study(&together(parts)).unwrap(), &mut Silent);
    let warnings = &outcome.file.warnings;
    // Motors on a voltage are braked by their own.
    let braked = warnings.iter().all(|w| w.code.as_str() == "back-emf");
    assert!(braked, "{warnings:?}");
    outcome
}

/// Slow motion teaches a load estimate nothing: that is said, and the load it began with is not called found.
#[test]
fn a_load_estimate_that_learns_nothing_is_named() {
    let desk = Desk::new();
    let slow = "\n[[path]]\nkind = \"sine\"\namplitude = \"1 mm\"\nfrequency = \"1 Hz\"\n";
    let estimate = compensator("estimate", "load_estimate = true");
    let study = desk.study(&together(&[AXIS, slow, CASCADE, &estimate]));
    let outcome = stiction_workflows::study::simulate(&study.unwrap(), &mut Silent);
    let said: Vec<_> = outcome.file.warnings.iter().collect();
    let named = said.iter().find(|w| w.code.as_str() == "load-not-learnt");
    assert!(named.unwrap().message.contains("no time"), "{said:?}");
    let text = stiction_pages::text::study(&outcome);
    let line = text.lines().find(|l| l.contains("mass found")).unwrap();
    let at = line.find("mass found").unwrap();
    let rows = text.lines().filter(|l| l.starts_with("estimate"));
    assert!(
        rows.clone()
            .any(|l| l.get(at..).is_some_and(|c| c.contains("n/a"))),
        "{text}"
    );
}

/// A load that is taken up is found within 2 %, and what is found takes the error back to that of the axis as it was.
#[test]
fn a_load_that_is_taken_up_is_found() {
    let desk = Desk::new();
    let schemes = [
        compensator("as it was", ""),
        compensator("estimate", "load_estimate = true"),
        compensator("adaptation", "adaptation = true"),
    ]
    .concat();
    let noisy = AXIS.replace("[axis]", "[axis]\nposition_noise = \"20 nm\"");
    let parts = [&noisy, LONG, CASCADE, &schemes];
    let before = outcome(&desk, &parts);
    let after = outcome(&desk, &[&together(&parts), TAKEN_UP]);
    let rms = |outcome: &StudyOutcome, name: &str| {
        row(&outcome.file, name, "exact")
            .metric("rms_error")
            .unwrap()
            .mean
    };
    let trace = |name: &str| {
        let found = after.traces.iter().find(|t| t.compensator == name);
        found.unwrap().load.as_ref().unwrap()
    };
    let load = trace("estimate");
    let late = |t: &f64| *t > 4.0;
    for (time, (mass, level)) in load
        .time
        .iter()
        .zip(load.found_mass.iter().zip(&load.found_level))
    {
        if late(time) {
            assert!((mass / 6.9 - 1.0).abs() < 0.02, "{time}: {mass}");
            assert!((level / 1.3 - 1.0).abs() < 0.02, "{time}: {level}");
        }
    }
    let metric = |name: &str| {
        let row = row(&after.file, "estimate", "exact");
        let metric = row.metric(name).unwrap();
        (metric.mean, metric.unit.clone(), metric.reduction_percent)
    };
    let (mass, unit, reduction) = metric("found_mass");
    assert!((mass / 6.9 - 1.0).abs() < 0.02 && unit == "kg" && reduction.is_none());
    assert!((metric("found_friction").0 / 1.3 - 1.0).abs() < 0.02);
    let without = row(&after.file, "as it was", "exact");
    assert!(without.metric("found_mass").is_none());
    let changes = load
        .mass
        .windows(2)
        .filter(|pair| pair[0] != pair[1])
        .count();
    assert_eq!(
        (changes, load.mass[0], *load.level.last().unwrap()),
        (1, 4.6, 1.3)
    );
    // Left alone the error grows; fed with the estimate it is as before.
    assert!(rms(&after, "as it was") > 3.0 * rms(&before, "as it was"));
    assert!(rms(&after, "estimate") < 0.05 * rms(&after, "as it was"));
    // An adaptation finds the level where friction alone changes, and takes no part of it for a mass.
    let friction = TAKEN_UP.replace("mass = \"6.9 kg\"", "");
    let dried = outcome(&desk, &[&together(&parts), &friction]);
    let adapted = dried.traces.iter().find(|t| t.compensator == "adaptation");
    let adapted = adapted.unwrap().load.as_ref().unwrap();
    let levels = adapted.time.iter().zip(&adapted.found_level);
    let before = levels
        .filter(|(t, _)| **t < 3.0)
        .map(|(_, level)| (level - 1.0).abs());
    assert!(before.fold(0.0, f64::max) < 0.02);
    let end = adapted.found_level.last().unwrap();
    assert!((end / 1.3 - 1.0).abs() < 0.02, "{end}");
    let mass = adapted.found_mass.last().unwrap();
    assert!((mass / 4.6 - 1.0).abs() < 0.05, "{mass}");
    let html =
        String::from_utf8(stiction_pages::bundle::study(&after).files()[0].1.clone()).unwrap();
    stiction_testkit::assert_tables_fit(&html);
    for words in [
        "The load found while running",
        "from 3.000 s on: mass 6.900 kg",
    ] {
        assert!(html.contains(words), "{words}");
    }
    assert_eq!(after.file.events.len(), 1);
}

/// A change at the beginning is the axis that it makes, under the same controller.
#[test]
fn a_change_at_the_beginning_is_another_axis() {
    let desk = Desk::new();
    let axis = |mass: &str, by: f64| {
        format!(
            "[axis]\nrate = \"4 kHz\"\nmass = \"{mass}\"\nparameters = {{ sigma0 = \"{} N/m\", sigma1 = \"{} N s/m\", \
             sigma2 = \"{} N s/m\", coulomb = \"{} N\", static = \"{} N\", stribeck_velocity = \"3 mm/s\" }}\n",
            by * 2e6,
            by * 1500.0,
            by * 30.0,
            by * 12.0,
            by * 18.0
        )
    };
    let gains = "\n[[controller]]\nkind = \"cascade\"\nposition_gain = \"90 1/s\"\nspeed_gain = \"1700 N s/m\"\n\
                 integral_gain = \"1e5 N/m\"\nforce_limit = \"200 N\"\nmass_feedforward = 0.0\n";
    for (event, mass, by) in [
        ("mass = \"6.9 kg\"", "6.9 kg", 1.0),
        ("friction = 1.5", "4.6 kg", 1.5),
    ] {
        let event = format!("\n[[event]]\ntime = \"0 s\"\n{event}\n");
        let changed = desk.run(&together(&[&axis("4.6 kg", 1.0), SHORT, gains, &event]));
        let other = desk.run(&together(&[&axis(mass, by), SHORT, gains]));
        assert_eq!(changed.results, other.results);
    }
}

/// The estimate knows the voltage that the motion of a motor takes.
#[test]
fn a_load_on_a_motor_on_a_voltage_is_found() {
    let desk = Desk::new();
    let motor = "voltage = { force_constant = \"96 N/A\", resistance = \"24 ohm\", inductance = \"10 mH\" }";
    let axis = AXIS
        .replace("current_loop = \"1 kHz\"", motor)
        .replace("peak_force   = \"1248 N\"", "");
    let estimate = compensator("estimate", "load_estimate = true");
    let after = outcome(&desk, &[&axis, LONG, CASCADE, &estimate, TAKEN_UP]);
    let load = after
        .traces
        .iter()
        .find_map(|t| t.load.as_ref().filter(|l| !l.found_mass.is_empty()));
    let load = load.unwrap();
    let last = |values: &[f64]| *values.last().unwrap();
    let (mass, level) = (last(&load.found_mass), last(&load.found_level));
    assert!(
        (mass / 6.9 - 1.0).abs() < 0.02 && (level / 1.3 - 1.0).abs() < 0.02,
        "{mass} {level}"
    );
}

/// What comes after the end of a path is said, and drawn on the others alone.
#[test]
fn a_change_after_the_end_of_a_path() {
    let long = SHORT.replace("cycles    = 2", "cycles    = 4\nname = \"longer\"");
    let late = "\n[[event]]\ntime = \"0.7 s\"\nmass = \"6.9 kg\"\n";
    let study = Desk::new().study(&together(&[AXIS, SHORT, &long, CASCADE, late]));
    let outcome = stiction_workflows::study::simulate(&study.unwrap(), &mut Silent);
    let [warning] = &outcome.file.warnings[..] else {
        panic!("{:?}", outcome.file.warnings);
    };
    let said = "the event at 0.7000 s comes after the end of sine: nothing changes there";
    assert_eq!(
        (warning.code.as_str(), warning.message.as_str()),
        ("late-event", said)
    );
    let html = stiction_pages::bundle::study(&outcome).files()[0].1.clone();
    let html = String::from_utf8(html).unwrap();
    // On the longer path alone there is a line at that time.
    let figures: Vec<&str> = html
        .split("<title>Tracking error</title>")
        .skip(1)
        .collect();
    assert_eq!(figures.len(), 2);
}

#[test]
fn what_is_refused_of_events() {
    let desk = Desk::new();
    let good = together(&[AXIS, SHORT, CASCADE]);
    let mut out = String::new();
    for more in [
        "[[event]]\nmass = \"5 kg\"",
        "[[event]]\ntime = \"0.2 s\"",
        "[[event]]\ntime = \"-1 s\"\nmass = \"5 kg\"",
        "[[event]]\ntime = \"0.5 s\"\nmass = \"5 kg\"",
        "[[event]]\ntime = \"0.2 s\"\nmass = \"0 kg\"",
        "[[event]]\ntime = \"0.2 s\"\nmass = \"5 N\"",
        "[[event]]\ntime = \"0.2 s\"\nfriction = 0",
        "[[event]]\ntime = \"0.2 s\"\nfriction = \"20 %\"",
        "[[event]]\ntime = \"0.2 s\"\nmass = \"5 kg\"\n[[event]]\ntime = \"0.2 s\"\nfriction = 2",
        "[[event]]\ntime = \"0.2 s\"\nforce = \"5 N\"\nmass = \"5 kg\"",
        "[event]\ntime = \"0.2 s\"",
        "[[compensator]]\nkind = \"lugre\"\nload_estimate = 1",
        "[[compensator]]\nkind = \"lugre\"\nload_estimate = true\nadaptation = true",
        "[[compensator]]\nkind = \"disturbance-observer\"\nbandwidth = \"60 Hz\"\nload_estimate = true",
    ] {
        out += &desk.refusal(&format!("{good}\n{more}\n"));
        out.push('\n');
    }
    let contour = "[second_axis]\nknown = \"motor\"\n[[contour]]\nkind = \"circle\"\nradius = \"10 mm\"\nvelocity = \"50 mm/s\"\n\
                   acceleration = \"1 m/s2\"\njerk = \"50 m/s3\"\n[[event]]\ntime = \"0.2 s\"\nmass = \"5 kg\"\n";
    out += &desk.refusal(&together(&[&good, contour]));
    insta::assert_snapshot!(out);
}
