//! Studies of two axes: the circle that is known from elsewhere, wrong parameters on both axes, what is refused.

use stiction_files::Error as FileError;
use stiction_files::study::Study;
use stiction_files::study::result::{ResultRow, StudyFile};
use stiction_identify::Silent;
use stiction_workflows::study::StudyOutcome;

const AXES: &str = r#"
[axis]
known        = "motor"
rate         = "4 kHz"
encoder      = "50 nm"
current_loop = "1 kHz"

[second_axis]
known        = "machine"
encoder      = "50 nm"
current_loop = "1 kHz"

[coupling]
bandwidth = "45 Hz"
limit     = "100 mm/s"
"#;

/// Half a turn a second.
const CIRCLE: &str = r#"
[[contour]]
kind         = "circle"
radius       = "10 mm"
velocity     = "31.41592653589793 mm/s"
acceleration = "0.3 m/s2"
jerk         = "6 m/s3"
"#;

const CONTROLLER: &str = r#"
[[controller]]
kind             = "cascade"
bandwidth        = "60 Hz"
second_bandwidth = "45 Hz"
force_limit      = "1 kN"
"#;

const WHOLE: &str = r#"
[[compensator]]
name     = "whole"
kind     = "lugre"
gain     = 1.0
watchdog = false
limit    = "200 N"
ramp     = "0 s"
"#;

fn read(text: &str) -> Result<Study, FileError> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("study.toml");
    std::fs::write(&file, text).unwrap();
    Study::read(&file)
}

fn run(text: &str) -> StudyOutcome {
    stiction_workflows::study::simulate(&read(text).unwrap(), &mut Silent)
}

fn row<'f>(
    file: &'f StudyFile,
    compensator: &str,
    coupled: bool,
    parameters: &str,
) -> &'f ResultRow {
    let is = |r: &&ResultRow| {
        (r.compensator.as_str(), r.coupled, r.parameters.as_str())
            == (compensator, coupled, parameters)
    };
    file.results.iter().find(is).unwrap()
}

fn peak(row: &ResultRow) -> f64 {
    row.metric("contour_peak").unwrap().mean
}

/// The circle of docs/compensation.md, whose figures come from the axes alone, without a study.
#[test]
fn the_published_circle() {
    let outcome = run(&[AXES, CIRCLE, CONTROLLER, WHOLE].concat());
    let file = &outcome.file;
    assert!(file.warnings.is_empty(), "{:?}", file.warnings);
    assert_eq!(file.results.len(), 4);
    // None and whole, each without and with coupling. To the digits, or half a step of the encoder.
    for (compensator, coupled, expected, digit) in [
        ("none", false, 64.9e-6, 0.1e-6),
        ("none", true, 4.24e-6, 0.025e-6),
        ("whole", false, 0.13e-6, 0.025e-6),
        ("whole", true, 0.04e-6, 0.025e-6),
    ] {
        let found = peak(row(file, compensator, coupled, "exact"));
        assert!(
            (found - expected).abs() <= digit,
            "{compensator} {coupled}: {found}"
        );
    }
    // The whole of a circle between two others is no less wide than its largest deviation.
    let circular = row(file, "none", false, "exact")
        .metric("circular_deviation")
        .unwrap();
    assert!(circular.mean >= 0.9 * 64.8e-6 && circular.mean < 2.0 * 64.8e-6);

    let bundle = stiction_pages::bundle::study(&outcome);
    let html = String::from_utf8(bundle.files()[0].1.clone()).unwrap();
    for words in [
        "Deviations ×",
        "Contour error",
        "whole, coupling",
        "The second axis",
    ] {
        assert!(html.contains(words), "{words}");
    }
    let text = stiction_pages::text::study(&outcome);
    assert!(text.contains("coupling"), "{text}");
    assert!(text.contains("second axis: Known axis machine"), "{text}");
}

/// A contour from a file is followed as the one that made it, and its deviation is the distance across it.
#[test]
fn a_contour_from_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let turn = |k: u32| 2.0 * std::f64::consts::PI * f64::from(k) / 2000.0;
    // A turn of 10 mm in 2 s, started and ended softly.
    let soft = |a: f64| a - libm::sin(a);
    let rows = (0..=2000).map(|k| {
        let (s, c) = libm::sincos(soft(turn(k)));
        format!("{},{},{}\n", 1e-3 * f64::from(k), 10.0 * c, 10.0 * s)
    });
    let text: String = std::iter::once("t [s],x [mm],y [mm]\n".to_string())
        .chain(rows)
        .collect();
    std::fs::write(folder.path().join("turn.csv"), text).unwrap();
    let contour = "\n[[contour]]\nkind = \"file\"\nfile = \"turn.csv\"\n";
    let file = folder.path().join("study.toml");
    std::fs::write(&file, [AXES, contour, CONTROLLER, WHOLE].concat()).unwrap();
    let study = Study::read(&file).unwrap();
    let outcome = stiction_workflows::study::simulate(&study, &mut Silent);
    assert!(
        outcome.file.warnings.is_empty(),
        "{:?}",
        outcome.file.warnings
    );
    let metric = |coupled, name| {
        let row = row(&outcome.file, "none", coupled, "exact");
        row.metric(name).unwrap().mean
    };
    let bundle = stiction_pages::bundle::study(&outcome);
    let rows = String::from_utf8(bundle.files()[1].1.clone()).unwrap();
    assert_eq!(bundle.files()[1].0, "contours.csv");
    let mut worst = 0.0_f64;
    for line in rows
        .lines()
        .filter(|l| l.starts_with("\"file\",\"cascade 60 Hz\",\"none\",0,"))
    {
        let values: Vec<f64> = line
            .split(',')
            .skip(3)
            .map(|x| x.parse().unwrap())
            .collect();
        let (x, y, deviation) = (values[4], values[5], values[8]);
        // From the circle itself, whose centre lies 10 mm to the left of the start.
        let off = libm::hypot(x + 10e-3, y) - 10e-3;
        assert!(
            (off - deviation).abs() < 0.02 * metric(false, "contour_peak") + 1e-9,
            "{line}"
        );
        worst = worst.max(deviation.abs());
    }
    assert!((worst / metric(false, "contour_peak") - 1.0).abs() < 0.02);
    let coupled = metric(true, "contour_peak");
    assert!(worst > 20e-6 && coupled < 0.3 * worst, "{worst} {coupled}");
}

/// Above a PID, which integrates the position error itself, coupling does not drift: many turns are no worse than few.
#[test]
fn coupling_above_pids_does_not_drift() {
    let pid = CONTROLLER.replace("cascade", "pid");
    let peaks = [2, 12].map(|turns| {
        let circle = CIRCLE.replace("10 mm\"", &format!("10 mm\"\nturns = {turns}"));
        let outcome = run(&[AXES, &circle, &pid].concat());
        let of = |coupled| peak(row(&outcome.file, "none", coupled, "exact"));
        (of(false), of(true))
    });
    println!("{peaks:?}");
    assert!(peaks[1].1 < 1.1 * peaks[0].1, "{peaks:?}");
    assert!(peaks[1].1 < 0.3 * peaks[1].0, "{peaks:?}");
}

/// The first turn is left out, neither less nor more: with a ramp of v/a + a/j at the start it takes as long as at full
/// speed and half the ramp.
#[test]
fn the_first_turn_does_not_count() {
    let circle = CIRCLE.replace("10 mm\"", "10 mm\"\nturns = 3");
    let outcome = run(&[AXES, &circle, CONTROLLER].concat());
    let v = 10e-3 * std::f64::consts::PI;
    let expected = 2.0 + 0.5 * (v / 0.3 + 0.3 / 6.0);
    assert!((outcome.file.paths[0].skip_s - expected).abs() < 1e-9);
}

/// The same set of wrong parameters on both axes: what they leave is most of what is left, and coupling takes most of it.
#[test]
fn wrong_parameters_of_both_axes() {
    let small = CIRCLE
        .replace(
            "radius       = \"10 mm\"",
            "radius = \"2 mm\"\nturns = 1\nskip = \"0.1 s\"",
        )
        .replace("jerk         = \"6 m/s3\"", "jerk = \"20 m/s3\"");
    let corners = "\n[[parameter_error]]\nkind = \"corners\"\nby = \"15 %\"\n";
    let outcome = run(&[AXES, &small, CONTROLLER, WHOLE, corners].concat());
    let metric = |coupled, parameters| {
        let row = row(&outcome.file, "whole", coupled, parameters);
        let runs = if parameters == "exact" { 1 } else { 64 };
        assert_eq!(row.runs, runs);
        row.metric("contour_peak").unwrap().clone()
    };
    let [exact, wrong, coupled] = [
        metric(false, "exact"),
        metric(false, "±15 %"),
        metric(true, "±15 %"),
    ];
    assert!(wrong.mean > 5.0 * exact.mean, "{wrong:?} {exact:?}");
    assert!(coupled.largest < 0.2 * wrong.largest, "{coupled:?}");
    // Wrong on both: each reverses with a larger error than with its own parameters.
    for axis in ["reversal_peak_x", "reversal_peak_y"] {
        let of = |parameters| {
            let row = row(&outcome.file, "whole", false, parameters);
            row.metric(axis).unwrap().mean
        };
        assert!(of("±15 %") > 3.0 * of("exact"), "{axis}");
    }
}

/// Every kind of contour beside a path of the first axis, by any controller; learning is of one axis.
#[test]
fn contours_beside_paths() {
    let limits = "velocity = \"40 mm/s\"\nacceleration = \"1 m/s2\"\njerk = \"100 m/s3\"\n";
    let contours = format!(
        "\n[[contour]]\nkind = \"corner\"\nside = \"4 mm\"\n{limits}\n\
         [[contour]]\nkind = \"square\"\nside = \"4 mm\"\n{limits}\n\
         [[contour]]\nkind = \"figure-eight\"\nwidth = \"8 mm\"\nheight = \"4 mm\"\nturns = 1\n{limits}\n\
         [[path]]\nkind = \"sine\"\namplitude = \"1 mm\"\nfrequency = \"2 Hz\"\ncycles = 2\n"
    );
    let fuzzy =
        "\n[[controller]]\nkind = \"fuzzy-pid\"\nbandwidth = \"45 Hz\"\nforce_limit = \"1 kN\"\n";
    let learning = "\n[[compensator]]\nkind = \"learning\"\nlead = \"2.5 ms\"\ncutoff = \"250 Hz\"\npasses = 2\n";
    let text = [AXES, &contours, CONTROLLER, fuzzy, WHOLE, learning].concat();
    let study = read(&text).unwrap();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let outcome = pool
            .build()
            .unwrap()
            .install(|| stiction_workflows::study::simulate(&study, &mut Silent));
        serde_json::to_string(&outcome.file).unwrap()
    };
    let one = with(1);
    assert!(one == with(3), "threads do not count");
    let file: StudyFile = serde_json::from_str(&one).unwrap();
    // Two controllers: three compensators on the path, two on each of three contours without and with coupling.
    assert_eq!(file.results.len(), 2 * (3 + 3 * 2 * 2));
    let kinds: Vec<&str> = file.paths.iter().map(|p| p.kind.as_str()).collect();
    assert_eq!(kinds, ["sine", "corner", "square", "figure-eight"]);
    for row in &file.results {
        let contour = row.metric("contour_rms").is_some();
        assert_eq!(contour, row.path != "sine", "{row:?}");
        assert!(!row.coupled || contour);
        assert!(row.metric("circular_deviation").is_none());
    }
    // A square of the same size has no other deviation than its corners have: micrometres, not millimetres.
    let squares = file.results.iter().filter(|r| r.path == "square");
    assert!(squares.map(peak).all(|p| p > 0.0 && p < 1e-4));
}

#[test]
fn what_is_refused_of_two_axes() {
    let good = [AXES, CIRCLE, CONTROLLER, WHOLE].concat();
    let changes = [
        ("[second_axis]", "[other_axis]"),
        ("known        = \"machine\"", "known = \"V6\""),
        (
            "known        = \"machine\"",
            "known = \"machine\"\nrate = \"1 kHz\"",
        ),
        ("limit     = \"100 mm/s\"", ""),
        ("radius       = \"10 mm\"", "radius = \"0 mm\""),
        ("radius       = \"10 mm\"", "radius = \"1e-300 m\""),
        ("radius       = \"10 mm\"", "side = \"10 mm\""),
        (
            "radius       = \"10 mm\"",
            "radius = \"10 mm\"\nskip = \"9 s\"",
        ),
        ("kind         = \"circle\"", "kind = \"spiral\""),
        (
            "kind         = \"circle\"",
            "kind = \"circle\"\nturns = 1000",
        ),
        (
            "velocity     = \"31.41592653589793 mm/s\"",
            "velocity = \"1 nm/s\"",
        ),
        (
            "bandwidth        = \"60 Hz\"\nsecond_bandwidth = \"45 Hz\"",
            "position_gain = \"60 1/s\"\nspeed_gain = \"1 kN s/m\"\nintegral_gain = \"1 kN/m\"",
        ),
    ];
    let mut out = String::new();
    for (from, to) in changes {
        assert!(good.contains(from), "{from}");
        let Err(error) = read(&good.replacen(from, to, 1)) else {
            panic!("not refused: {to}");
        };
        assert_eq!(error.code().as_str(), "bad-config");
        let text = error.to_string();
        out += text
            .split_once("study.toml: ")
            .map_or(text.as_str(), |(_, rest)| rest);
        out += "\n";
    }
    insta::assert_snapshot!(out);
}

/// The example that comes with the documentation is a study.
#[test]
fn the_example_is_a_study() {
    let file = stiction_testkit::workspace().join("examples/stage/contour.toml");
    Study::read(&file).unwrap();
}
