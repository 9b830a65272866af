//! Motions of a study that go by a name alone, and what is measured on them.

use stiction_files::study::Study;
use stiction_files::study::result::{ResultRow, StudyFile};
use stiction_identify::Silent;

const AXIS: &str = "[axis]\nknown = \"motor\"\nrate = \"4 kHz\"\n";
const LOOP: &str =
    "[[controller]]\nkind = \"cascade\"\nbandwidth = \"30 Hz\"\nforce_limit = \"200 N\"\n";

/// The study, or why it is refused.
fn read(parts: &[&str]) -> Result<Study, String> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("study.toml");
    std::fs::write(&file, parts.concat()).unwrap();
    let place = format!("{}/", folder.path().display());
    Study::read(&file).map_err(|e| e.to_string().replace(&place, ""))
}

fn run(parts: &[&str]) -> StudyFile {
    stiction_workflows::study::simulate(&read(parts).unwrap(), &mut Silent).file
}

fn value(row: &ResultRow, name: &str) -> Option<f64> {
    row.metric(name).map(|m| m.mean)
}

/// Each velocity is a path: held over six presliding lengths of 18 N / 2e6 N/m, which is 54 um, or for 2 s; .1 s to reach the
/// velocity and .1 s to stop.
#[test]
fn crawl_is_a_path_for_each_velocity() {
    let file = run(&[AXIS, "[[path]]\nkind = \"crawl\"\n", LOOP]);
    let paths: Vec<_> = file
        .paths
        .iter()
        .map(|p| (p.name.as_str(), p.duration_s))
        .collect();
    for ((name, duration), (expected, seconds)) in paths.iter().zip([
        ("crawl at 1 um/s", 54.2),
        ("crawl at 10 um/s", 5.6),
        ("crawl at 100 um/s", 2.2),
    ]) {
        assert_eq!(*name, expected);
        assert!((duration - seconds).abs() < 1e-9, "{paths:?}");
    }
    assert_eq!(paths.len(), 3);
    for row in &file.results {
        // It goes one way, and all the way.
        assert!(value(row, "rest_share").is_some() && value(row, "standing_error").is_none());
        let share = value(row, "feed_error_share").unwrap();
        assert!((0.0..5.0).contains(&share), "{row:?}");
    }
    // A rate at which six presliding lengths would be too many samples.
    let fast = AXIS.replace("4 kHz", "40 kHz");
    let study = read(&[&fast, "[[path]]\nkind = \"crawl\"\n", LOOP]).unwrap();
    let longest = study.paths[0].trajectory.duration();
    assert!((longest - 999_999.0 / 40e3).abs() < 1e-6, "{longest}");
    let given =
        "[[path]]\nname = \"slow\"\nkind = \"crawl\"\nvelocities = [\"20 um/s\"]\nhold = \"3 s\"\n";
    let study = read(&[AXIS, given, LOOP]).unwrap();
    assert_eq!(study.paths[0].name, "slow at 20 um/s");
    assert!((study.paths[0].trajectory.duration() - 3.2).abs() < 1e-9);
}

/// The block of 1995 under the PID of its experiment hunts as it does there, 63.9 mm far in 24.44 s: the limit cycle does not
/// know by which motion it was reached. The loops that a study tunes do not hunt.
#[test]
fn hold_shows_hunting() {
    let block =
        "[axis]\nknown = \"C95\"\nrate = \"1 kHz\"\ndelay = \"0 s\"\nsigma1 = \"constant\"\n";
    let far = "[[path]]\nkind = \"hold\"\ndistance = \"1 m\"\nvelocity = \"0.5 m/s\"\ndwell = \"300 s\"\n";
    let pid = "[[controller]]\nkind = \"pid\"\nproportional = \"3 N/m\"\nintegral = \"4 N/(m s)\"\nderivative = \"6 N s/m\"\n\
               mass_feedforward = 0.0\nforce_limit = \"10 kN\"\n";
    let file = run(&[block, far, pid]);
    let row = &file.results[0];
    let (amplitude, period) = (
        value(row, "hunting_amplitude").unwrap(),
        value(row, "hunting_period").unwrap(),
    );
    assert!((amplitude / 0.0639 - 1.0).abs() < 0.01, "{amplitude}");
    assert!((period / 24.44 - 1.0).abs() < 0.01, "{period}");

    let file = run(&[AXIS, "[[path]]\nkind = \"hold\"\n", LOOP]);
    let row = &file.results[0];
    assert_eq!(value(row, "hunting_amplitude"), Some(0.0));
    assert_eq!(value(row, "hunting_period"), None);
    assert!(value(row, "standing_error").unwrap() < 1e-6);
    assert!(file.paths[0].duration_s > 20.0);
}

/// Circle and corner need no numbers either, on linear and rotary axes; asked for as a path they are named as contours.
#[test]
fn circle_and_corner_by_their_names() {
    let contours = "[[contour]]\nkind = \"circle\"\n[[contour]]\nkind = \"corner\"\n";
    for (first, second) in [("motor", "machine"), ("V5", "V6")] {
        let axes = format!(
            "[axis]\nknown = \"{first}\"\nrate = \"4 kHz\"\n[second_axis]\nknown = \"{second}\"\n"
        );
        let file = run(&[
            &axes,
            contours,
            &LOOP.replace("200 N", if first == "V5" { "200 N m" } else { "200 N" }),
        ]);
        assert_eq!(file.results.len(), 2);
        for row in &file.results {
            let share = value(row, "feed_error_share").unwrap();
            assert!(share > 0.0 && share < 1.0, "{row:?}");
        }
    }
}

#[test]
fn what_is_refused_of_them() {
    let mut out = String::new();
    for path in [
        "kind = \"circle\"",
        "kind = \"crawl\"\nvelocities = []",
        "kind = \"crawl\"\nvelocities = \"1 um/s\"",
        "kind = \"crawl\"\nvelocities = [\"1 um/s\", \"0 um/s\"]",
        "kind = \"crawl\"\nvelocities = [\"1 um/s\", \"1e-6 m/s\"]",
        "kind = \"crawl\"\nvelocities = [\"1 rad/s\"]",
        "kind = \"crawl\"\nvelocity = \"1 um/s\"",
        "kind = \"crawl\"\nhold = \"300 s\"",
        "kind = \"hold\"\ndistance = \"-1 mm\"",
        "kind = \"hold\"\ndwell = \"1 h\"",
        "kind = \"hold\"\nhold = \"1 s\"",
    ] {
        let text = format!("[[path]]\n{path}\n");
        let Err(refusal) = read(&[AXIS, &text, LOOP]) else {
            panic!("not refused: {path}");
        };
        out += &format!("{refusal}\n");
    }
    let watchdog = "[[compensator]]\nkind = \"lugre\"\nwatchdog_window = \"300 s\"\n";
    let refusal = read(&[AXIS, "[[path]]\nkind = \"hold\"\n", LOOP, watchdog]);
    out += &refusal.err().unwrap();
    insta::assert_snapshot!(out);
}
