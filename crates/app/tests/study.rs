//! Studies: numbers that are known from elsewhere, what a covariance does, what is refused, and that threads do not count.

use std::path::PathBuf;
use stiction_app::study::result::{ResultRow, StudyFile};
use stiction_app::{Control, Error, Study};
use tempfile::TempDir;

/// A folder with a study in it.
struct Desk(TempDir);

impl Desk {
    fn new() -> Self {
        Desk(tempfile::tempdir().unwrap())
    }

    fn write(&self, name: &str, text: &str) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    }

    fn study(&self, text: &str) -> Result<Study, Error> {
        Study::read(&self.write("study.toml", text))
    }

    fn run(&self, text: &str) -> StudyFile {
        run(&self.study(text).unwrap())
    }

    /// What is said of a study, without the folder that it is in.
    fn refusal(&self, text: &str) -> String {
        let Err(error) = self.study(text) else {
            panic!("not refused: {text}");
        };
        assert_eq!(error.code(), "bad-config");
        let folder = format!("{}/", self.0.path().display());
        error.to_string().replace(&folder, "")
    }
}

fn run(study: &Study) -> StudyFile {
    study.run(&mut |_, _| Control::Continue).file
}

fn row<'f>(file: &'f StudyFile, compensator: &str, parameters: &str) -> &'f ResultRow {
    let found = file
        .results
        .iter()
        .find(|r| r.compensator == compensator && r.parameters == parameters);
    found.unwrap_or_else(|| panic!("no row {compensator}, {parameters}"))
}

const AXIS: &str = r#"
[axis]
known        = "motor"
rate         = "4 kHz"
encoder      = "50 nm"
current_loop = "1 kHz"
peak_force   = "1248 N"
"#;

const SINE: &str = r#"
[[path]]
kind      = "sine"
amplitude = "5 mm"
frequency = "0.5 Hz"
"#;

const CASCADE: &str = r#"
[[controller]]
kind        = "cascade"
bandwidth   = "60 Hz"
force_limit = "200 N"
"#;

const WHOLE: &str = r#"
[[compensator]]
name     = "whole"
kind     = "lugre"
gain     = 1.0
watchdog = false
ramp     = "0 s"
"#;

fn together(parts: &[&str]) -> String {
    parts.concat()
}

/// The errors without and with compensation are those of an independent prototype (58.5 um, and 98.5 % less) and of the
/// tables in docs/compensation.md.
#[test]
fn the_published_sine() {
    let observer = "\n[[compensator]]\nname = \"DOB\"\nkind = \"disturbance-observer\"\nbandwidth = \"60 Hz\"\n";
    let file = Desk::new().run(&together(&[AXIS, SINE, CASCADE, WHOLE, observer]));
    assert_eq!(file.status, "complete");
    assert_eq!(file.results.len(), 3);
    let peak = |name: &str| row(&file, name, "exact").metric("peak_error").unwrap().mean;
    assert!(
        (peak("none") / 58.5e-6 - 1.0).abs() < 0.01,
        "{}",
        peak("none")
    );
    let less = |name: &str| {
        let metric = row(&file, name, "exact").metric("reversal_peak").unwrap();
        metric.reduction_percent.unwrap()
    };
    assert!(less("whole") > 98.5, "{}", less("whole"));
    assert!((less("DOB") - 81.7).abs() < 0.5, "{}", less("DOB"));
    let none = row(&file, "none", "exact").metric("rms_error").unwrap();
    assert_eq!((none.reduction_percent, none.interval95), (None, None));
    // A sine has no stretch of constant velocity.
    assert!(
        none.mean > 0.0
            && row(&file, "none", "exact")
                .metric("velocity_ripple")
                .is_none()
    );
}

const SHORT: &str = r#"
[[path]]
kind      = "sine"
amplitude = "0.2 mm"
frequency = "4 Hz"
cycles    = 2
"#;

/// The same bits with any number of threads; every cell of the grid is there, and an interrupt keeps what is done.
#[test]
fn threads_do_not_count_and_an_interrupt_keeps_what_is_done() {
    let moves = "\n[[path]]\nkind = \"constant-velocity\"\nhold = \"0.2 s\"\nvelocity = \"5 mm/s\"\nacceleration = \"1 m/s2\"\njerk = \"100 m/s3\"\n";
    let fuzzy = "\n[[controller]]\nkind = \"fuzzy-pid\"\nbandwidth = \"40 Hz\"\n";
    let learning = "\n[[compensator]]\nkind = \"learning\"\nlead = \"2.5 ms\"\ncutoff = \"250 Hz\"\npasses = 3\n";
    let corners = "\n[[parameter_error]]\nkind = \"corners\"\nby = \"20 %\"\n";
    let text = together(&[AXIS, SHORT, moves, CASCADE, fuzzy, WHOLE, learning, corners])
        .replace("[axis]", "seed = 3\n[axis]\nposition_noise = \"20 nm\"");
    let desk = Desk::new();
    let study = desk.study(&text).unwrap();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let file = pool.build().unwrap().install(|| run(&study));
        serde_json::to_string(&file).unwrap()
    };
    let one = with(1);
    assert!(one == with(3));
    let file: StudyFile = serde_json::from_str(&one).unwrap();
    // Two paths, two controllers; none, whole, whole with wrong parameters, learning.
    assert_eq!(file.results.len(), 2 * 2 * 4);
    assert_eq!(row(&file, "whole", "±20 %").runs, 64);
    let ripple = |r: &ResultRow| r.metric("velocity_ripple").is_some();
    assert_eq!(file.results.iter().filter(|r| ripple(r)).count(), 8);
    assert!(file.warnings.is_empty(), "{:?}", file.warnings);

    let pool = rayon::ThreadPoolBuilder::new().num_threads(1);
    let mut seen = 0;
    let cut = pool.build().unwrap().install(|| {
        study.run(&mut |done, all| {
            seen = done;
            assert_eq!(all, 4 * (1 + 65 + 1));
            match done {
                5.. => Control::Stop,
                _ => Control::Continue,
            }
        })
    });
    assert_eq!(seen, 5);
    assert_eq!(cut.file.status, "interrupted");
    let kept: usize = cut.file.results.iter().map(|r| r.runs).sum();
    assert_eq!(kept, 5);
    // What is kept can be drawn.
    assert_eq!(cut.bundle().files().len(), 2);
}

/// A model file of the stage whose static and Coulomb friction have the standard deviations given, N, and correlate fully.
fn model(coulomb: f64, fixed: f64) -> String {
    let parameters = [
        ("sigma0", 2e6, "N/m"),
        ("sigma1", 1.5e3, "N*s/m"),
        ("sigma2", 30.0, "N*s/m"),
        ("coulomb", 12.0, "N"),
        ("static", 18.0, "N"),
        ("stribeck_velocity", 3e-3, "m/s"),
        ("mass", 4.6, "kg"),
    ];
    let mut text = String::from(
        "schema = \"stiction.model/1\"\nname = \"stage\"\nkind = \"linear\"\nlaw = \"lugre\"\nasymmetric = false\n\
         force_unit = \"N\"\ntrustworthy = true\n[source]\nversion = \"0\"\nmethod = \"separable\"\nseed = 0\n\
         inputs = []\n",
    );
    for (name, value, unit) in parameters {
        text += &format!(
            "[[parameter]]\nname = \"{name}\"\nsymbol = \"{name}\"\nvalue = {value:?}\nunit = \"{unit}\"\n\
             identifiable = true\norigin = \"identified\"\n"
        );
    }
    let c = coulomb * fixed;
    text += &format!(
        "[covariance]\nnames = [\"coulomb\", \"static\"]\nmatrix = [[{:?}, {c:?}], [{c:?}, {:?}]]\n",
        coulomb * coulomb,
        fixed * fixed
    );
    text
}

/// Draws spread as the covariance says: with a compensator of the steady curve at high speed, what it is off by is what the
/// Coulomb level is off by, in the part of the error that a Coulomb level off by 10 % makes.
#[test]
fn draws_from_the_covariance() {
    let desk = Desk::new();
    let draws = "\n[[parameter_error]]\nkind = \"covariance\"\ndraws = 60\n";
    let text = |file: &str| {
        together(&[AXIS, SHORT, CASCADE, WHOLE, draws])
            .replace("known        = \"motor\"", &format!("model = \"{file}\""))
    };
    desk.write("sure.toml", &model(0.0, 0.0));
    desk.write("good.toml", &model(0.12, 0.18));
    desk.write("poor.toml", &model(0.6, 0.9));
    let [sure, good, poor] = ["sure", "good", "poor"].map(|name| {
        let file = desk.run(&text(&format!("{name}.toml")));
        assert!(file.warnings.is_empty(), "{:?}", file.warnings);
        assert_eq!(file.inputs.len(), 2);
        let exact = row(&file, "whole", "exact")
            .metric("rms_error")
            .unwrap()
            .mean;
        let draws = row(&file, "whole", "60 draws");
        assert_eq!(draws.runs, 60);
        let metric = draws.metric("rms_error").unwrap();
        let [low, high] = metric.interval95.unwrap();
        assert!(metric.least <= low && low <= high && high <= metric.largest);
        (exact, high, metric.least)
    });
    // Without spread every draw is the exact run.
    assert_eq!((sure.0, sure.0), (sure.1, sure.2));
    assert_eq!((sure.0, sure.0), (good.0, poor.0));
    // Five times the deviation, about five times the error.
    let ratio = (poor.1 - poor.0) / (good.1 - good.0);
    assert!((3.5..6.5).contains(&ratio), "{ratio}");
    let off = Desk::new();
    off.write("m.toml", &model(0.1, 0.1).replace("[0.01", "[-0.01"));
    assert!(off.study(&text("m.toml")).is_err());
}

#[test]
fn what_is_refused() {
    let good = together(&[AXIS, SINE, CASCADE, WHOLE]);
    let desk = Desk::new();
    desk.write(
        "volts.toml",
        &model(0.1, 0.1)
            .replace("\"N", "\"V")
            .replace("\"kg\"", "\"V*s^2/m\""),
    );
    desk.write(
        "richer.toml",
        &model(0.1, 0.1).replace("\"lugre\"", "\"elasto-plastic\""),
    );
    desk.write(
        "part.toml",
        &model(0.1, 0.1)
            .replacen("sigma0", "delay", 1)
            .replacen("N/m", "s", 1),
    );
    let changes = [
        ("amplitude = \"5 mm\"", "amplitude = 5"),
        ("amplitude = \"5 mm\"", "amplitude = \"5 N\""),
        ("amplitude = \"5 mm\"", "amplitude = \"-5 mm\""),
        (
            "amplitude = \"5 mm\"",
            "amplitude = \"5 mm\"\ndwell = \"1 s\"",
        ),
        (
            "amplitude = \"5 mm\"",
            "skip = \"9 s\"\namplitude = \"5 mm\"",
        ),
        ("frequency = \"0.5 Hz\"", ""),
        ("frequency = \"0.5 Hz\"", "frequency = \"1e-6 Hz\""),
        ("kind      = \"sine\"", "kind = \"sinus\""),
        ("[[path]]", "[path]"),
        ("known        = \"motor\"", ""),
        ("known        = \"motor\"", "known = \"engine\""),
        ("known        = \"motor\"", "model = \"absent.toml\""),
        ("known        = \"motor\"", "model = \"volts.toml\""),
        ("known        = \"motor\"", "model = \"richer.toml\""),
        ("known        = \"motor\"", "model = \"part.toml\""),
        ("rate         = \"4 kHz\"", "rate = \"4 MHz\""),
        ("peak_force   = \"1248 N\"", "delay = \"1 s\""),
        ("bandwidth   = \"60 Hz\"", ""),
        (
            "bandwidth   = \"60 Hz\"",
            "bandwidth = \"60 Hz\"\nspeed_gain = \"1 N s/m\"",
        ),
        ("gain     = 1.0", "gain = 1.5"),
        ("gain     = 1.0", "gain = \"1\""),
        ("gain     = 1.0", "source = \"blend\""),
        ("name     = \"whole\"", "name = \"none\""),
        ("watchdog = false", "watchdog = 0"),
        ("[axis]", "sead = 1\n[axis]"),
        ("[axis]", "seed = -1\n[axis]"),
        (
            "[axis]",
            "[[parameter_error]]\nkind = \"covariance\"\n[axis]",
        ),
        (
            "[axis]",
            "[[parameter_error]]\nkind = \"corners\"\nby = \"120 %\"\n[axis]",
        ),
        ("[axis]", "[axis"),
    ];
    let mut out = String::new();
    for (from, to) in changes {
        assert!(good.contains(from), "{from}");
        out += &desk.refusal(&good.replacen(from, to, 1));
        out += "\n";
    }
    out += &desk.refusal(AXIS);
    insta::assert_snapshot!(out);
}

/// The study that comes with the documentation is one.
#[test]
fn the_example_is_a_study() {
    let file = stiction_testkit::workspace().join("examples/stage/study.toml");
    let study = Study::read(&file).unwrap();
    assert_eq!(study.inputs().count(), 1);
}
