//! Studies: numbers that are known from elsewhere, what a covariance does, what is refused, and that threads do not count.

use crate::common::counted;
use std::path::PathBuf;
use stiction_files::Error as FileError;
use stiction_files::study::Study;
use stiction_files::study::result::{ResultRow, StudyFile};
use stiction_identify::{Control, Progress, Silent};
use tempfile::TempDir;

/// A folder with a study in it.
pub(crate) struct Desk(TempDir);

impl Desk {
    pub(crate) fn new() -> Self {
        Desk(tempfile::tempdir().unwrap())
    }

    pub(crate) fn write(&self, name: &str, text: &str) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    }

    pub(crate) fn study(&self, text: &str) -> Result<Study, FileError> {
        Study::read(self.write("study.toml", text))
    }

    pub(crate) fn run(&self, text: &str) -> StudyFile {
        run(&self.study(text).unwrap())
    }

    /// What is said of a study, without the folder that it is in.
    pub(crate) fn refusal(&self, text: &str) -> String {
        let Err(error) = self.study(text) else {
            panic!("not refused: {text}");
        };
        assert_eq!(error.code().as_str(), "bad-config");
        let folder = format!("{}/", self.0.path().display());
        error.to_string().replace(&folder, "")
    }
}

fn run(study: &Study) -> StudyFile {
    stiction_workflows::study::simulate(study, &mut Silent).file
}

pub(crate) fn row<'f>(file: &'f StudyFile, compensator: &str, parameters: &str) -> &'f ResultRow {
    let found = file
        .results
        .iter()
        .find(|r| r.compensator == compensator && r.parameters == parameters);
    found.unwrap_or_else(|| panic!("no row {compensator}, {parameters}"))
}

pub(crate) const AXIS: &str = r#"
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

pub(crate) const CASCADE: &str = r#"
[[controller]]
kind        = "cascade"
bandwidth   = "60 Hz"
force_limit = "200 N"
"#;

pub(crate) const WHOLE: &str = r#"
[[compensator]]
name     = "whole"
kind     = "lugre"
gain     = 1.0
watchdog = false
ramp     = "0 s"
"#;

pub(crate) fn together(parts: &[&str]) -> String {
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

pub(crate) const SHORT: &str = r#"
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
        stiction_workflows::study::simulate(&study, &mut |progress: &Progress| {
            let (done, all) = counted(progress);
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
    assert_eq!(stiction_pages::bundle::study(&cut).files().len(), 3);
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
    desk.write("sure.toml", &model(1e-20, 1e-20));
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
    // A spread below the rounding of the values makes every draw the exact run.
    assert_eq!((sure.0, sure.0), (sure.1, sure.2));
    assert_eq!((sure.0, sure.0), (good.0, poor.0));
    // Five times the deviation, about five times the error.
    let ratio = (poor.1 - poor.0) / (good.1 - good.0);
    assert!((3.5..6.5).contains(&ratio), "{ratio}");
    let off = Desk::new();
    off.write("m.toml", &model(0.1, 0.1).replace("[0.01", "[-0.01"));
    assert!(off.study(&text("m.toml")).is_err());
    // What is wrong with a covariance is said at its place in the model, and where the study asks for it.
    let none = "[covariance]\nnames = []\nmatrix = []\n";
    let (start, _) = model(0.1, 0.1)
        .split_once("[covariance]")
        .map(|(a, b)| (a.to_string(), b.len()))
        .unwrap();
    off.write("m.toml", &format!("{start}{none}"));
    let refusal = off.refusal(&text("m.toml"));
    assert!(refusal.starts_with("m.toml: line "), "{refusal}");
    assert!(
        refusal.contains("covariance.names: the covariance knows of no error, and draws from it are asked for in study.toml: line "),
        "{refusal}"
    );
    off.write("m.toml", &model(0.0, 0.1));
    let refusal = off.refusal(&text("m.toml"));
    assert!(
        refusal.contains("covariance.matrix[1][1]: a variance of 0 for coulomb"),
        "{refusal}"
    );
    off.write("m.toml", &model(1e9, 1e9));
    let refusal = off.refusal(&text("m.toml"));
    assert!(
        refusal.contains("coulomb = 12.00 has a standard deviation of 1.000e9"),
        "{refusal}"
    );
}

/// A model whose directions differ, with a force at rest and a constant micro-damping: parameters that are hardly wrong give
/// hardly another result.
#[test]
fn corners_are_the_model_but_for_what_they_name() {
    let desk = Desk::new();
    let extra = ["coulomb_neg", "static_neg", "offset"]
        .into_iter()
        .zip([8.0, 10.0, 5.0]);
    let extra: String = extra
        .map(|(name, value)| {
            format!(
                "[[parameter]]\nname = \"{name}\"\nsymbol = \"{name}\"\nvalue = {value:?}\nunit = \"N\"\n\
                 identifiable = true\norigin = \"identified\"\n"
            )
        })
        .collect();
    let text = model(0.1, 0.1)
        .replace("asymmetric = false", "asymmetric = true")
        .replace("\"coulomb\"", "\"coulomb_pos\"")
        .replace("\"static\"", "\"static_pos\"")
        .replace("[covariance]", &(extra + "[covariance]"));
    desk.write("m.toml", &text);
    let axis = AXIS.replace(
        "known        = \"motor\"",
        "model = \"m.toml\"\nsigma1 = \"constant\"",
    );
    let corners = "\n[[parameter_error]]\nkind = \"corners\"\nby = \"0.001 %\"\n";
    let file = desk.run(&together(&[&axis, SHORT, CASCADE, WHOLE, corners]));
    let rms = |parameters: &str| {
        let row = row(&file, "whole", parameters);
        row.metric("rms_error").unwrap().clone()
    };
    let (exact, wrong) = (rms("exact"), rms("±0.001 %"));
    assert!(exact.reduction_percent.unwrap() > 90.0, "{exact:?}");
    for of in [wrong.least, wrong.largest] {
        // A tenth of an encoder step.
        assert!((of - exact.mean).abs() < 5e-9, "{exact:?} {wrong:?}");
    }
}

fn codes(file: &StudyFile) -> Vec<&str> {
    file.warnings.iter().map(|w| w.code.as_str()).collect()
}

/// The plant is stepped as often as its bristles need, or the study says that it is not.
#[test]
fn stiff_bristles_get_shorter_steps() {
    let desk = Desk::new();
    for (sigma0, substeps, warned) in [
        ("2000000.0", 3, false),
        ("1e10", 12, false),
        ("1e14", 100, true),
    ] {
        desk.write("stiff.toml", &model(0.1, 0.1).replace("2000000.0", sigma0));
        let text = together(&[AXIS, SHORT, CASCADE])
            .replace("known        = \"motor\"", "model = \"stiff.toml\"");
        let file = desk.run(&text);
        assert_eq!(file.axis.substeps, substeps, "{sigma0}");
        assert_eq!(codes(&file).contains(&"long-steps"), warned, "{sigma0}");
    }
}

/// A watchdog has learnt before the run: a move with default settings is the one without a watchdog, which compensates from the
/// first sample of the motion on.
#[test]
fn a_watchdog_has_learnt_before_the_run() {
    let there = "\n[[path]]\nkind = \"move\"\ndistance = \"10 mm\"\nvelocity = \"50 mm/s\"\nacceleration = \"1 m/s2\"\njerk = \"50 m/s3\"\n";
    let supplied = "\n[[compensator]]\nkind = \"lugre\"\n";
    let unwatched = "\n[[compensator]]\nname = \"unwatched\"\nkind = \"lugre\"\nwatchdog = false\n";
    let study = Desk::new().study(&together(&[AXIS, there, CASCADE, supplied, unwatched]));
    let outcome = stiction_workflows::study::simulate(&study.unwrap(), &mut Silent);
    let file = &outcome.file;
    let metrics = |name: &str| &row(file, name, "exact").metrics;
    assert_eq!(metrics("lugre"), metrics("unwatched"));
    let peak = row(file, "lugre", "exact").metric("peak_error").unwrap();
    assert!(peak.reduction_percent.unwrap() > 40.0, "{peak:?}");
    assert!(file.warnings.is_empty(), "{:?}", file.warnings);
    let courses =
        String::from_utf8(stiction_pages::bundle::study(&outcome).files()[1].1.clone()).unwrap();
    let first = courses.lines().find_map(|line| {
        let numbers: Vec<f64> = line.split(',').filter_map(|x| x.parse().ok()).collect();
        (numbers.last().is_some_and(|force| *force != 0.0)).then(|| numbers[0])
    });
    assert!(first.unwrap() < 2e-3, "{first:?}");
}

/// Too large a force under a slow loop on motion of the presliding length is worse than none (docs/compensation.md): what the
/// watchdog has learnt before makes it switch off, in some of the sets and not with the exact parameters.
#[test]
fn a_watchdog_switches_off_what_is_worse() {
    let axis = AXIS.replace("4 kHz", "1 kHz");
    let small =
        "\n[[path]]\nkind = \"sine\"\namplitude = \"20 um\"\nfrequency = \"1 Hz\"\ncycles = 8\n";
    let slow = CASCADE.replace("60 Hz", "30 Hz");
    let whole = "\n[[compensator]]\nkind = \"lugre\"\ngain = 1.0\n";
    let corners = "\n[[parameter_error]]\nkind = \"corners\"\nby = \"30 %\"\n";
    let file = Desk::new().run(&together(&[&axis, small, &slow, whole, corners]));
    assert_eq!(row(&file, "lugre", "exact").switched_off, 0);
    let wrong = row(&file, "lugre", "±30 %");
    assert!((1..64).contains(&wrong.switched_off), "{wrong:?}");
    let said = format!("switched off in {} of 64", wrong.switched_off);
    assert_eq!(wrong.remarks(), said);
}

/// A drive that cannot even overcome friction, and a loop so fast that it swings between its limits, are named.
#[test]
fn forces_at_their_limit_and_loops_that_swing() {
    let weak = AXIS.replace("1248 N", "10 N");
    let file = Desk::new().run(&together(&[&weak, SHORT, CASCADE, WHOLE]));
    assert_eq!(codes(&file), ["at-force-limit"]);
    assert!(
        file.warnings[0].message.contains("limit of 10.0 N")
            && file.warnings[0].message.contains("with none (")
            && file.warnings[0].message.contains(", whole ("),
        "{:?}",
        file.warnings
    );
    let saturation = row(&file, "none", "exact").metric("saturation").unwrap();
    assert!(saturation.mean > 0.5 && saturation.mean <= 1.0);
    let fast = CASCADE.replace("60 Hz", "900 Hz");
    let file = Desk::new().run(&together(&[AXIS, SHORT, &fast, WHOLE]));
    assert_eq!(codes(&file), ["at-force-limit", "unsteady-command"]);
    let file = Desk::new().run(&together(&[AXIS, SHORT, CASCADE, WHOLE]));
    assert!(codes(&file).is_empty());
    let saturation = row(&file, "none", "exact").metric("saturation").unwrap();
    assert_eq!(saturation.largest, 0.0);
}

/// A sine from a file, in other units and at uneven times, is the sine.
#[test]
fn a_path_from_a_file() {
    let desk = Desk::new();
    let omega = 8.0 * std::f64::consts::PI;
    let mut rows = String::from("t [ms];x [mm]\n");
    for k in 0..=1000 {
        let t = 0.5e-3 * f64::from(k) + if k % 2 == 1 { 0.1e-3 } else { 0.0 };
        rows += &format!("{};{}\n", 1e3 * t, 3.0 + 0.2 * (1.0 - libm::cos(omega * t)));
    }
    desk.write("sine.csv", &rows);
    let from_file = "\n[[path]]\nkind = \"file\"\nfile = \"sine.csv\"\nskip = \"0.25 s\"\n";
    let file = desk.run(&together(&[AXIS, SHORT, from_file, CASCADE, WHOLE]));
    assert!(file.warnings.is_empty(), "{:?}", file.warnings);
    assert_eq!(file.inputs.len(), 2);
    assert!((file.paths[1].duration_s - 0.5).abs() < 1e-9);
    let rms = |path: &str| {
        let of = |r: &&ResultRow| r.path == path && r.compensator == "none";
        let row = file.results.iter().find(of).unwrap();
        row.metric("rms_error").unwrap().mean
    };
    assert!(
        (rms("file") / rms("sine") - 1.0).abs() < 0.01,
        "{} {}",
        rms("file"),
        rms("sine")
    );

    let mut out = String::new();
    for (name, text) in [
        ("absent.csv", None),
        ("one.csv", Some("t [s]\n0\n1\n2\n")),
        ("back.csv", Some("t [s],x [mm]\n0,0\n1,1\n0.5,2\n")),
        ("unit.csv", Some("t [s],x [N]\n0,0\n1,1\n2,2\n")),
        ("hole.csv", Some("t [s],x [mm]\n0,0\n1,\n2,2\n")),
    ] {
        if let Some(text) = text {
            desk.write(name, text);
        }
        let text = together(&[AXIS, from_file, CASCADE]).replace("sine.csv", name);
        let Err(error) = desk.study(&text) else {
            panic!("not refused: {name}");
        };
        let folder = format!("{}/", desk.0.path().display());
        out += &format!("{}: {error}\n", error.code()).replace(&folder, "");
    }
    insta::assert_snapshot!(out);
    // Without units they are those of the SI, and that is said.
    desk.write("bare.csv", "t,x\n0,0\n0.5,0.001\n1,0\n");
    let text = together(&[AXIS, from_file, CASCADE]).replace("sine.csv", "bare.csv");
    assert_eq!(codes(&desk.run(&text)), ["unit-assumed"]);
}

/// Of many compensators the figures show some, and say so; of the tile's two one names the risk.
#[test]
fn what_the_report_does_not_draw_it_says() {
    let gains: String = (1..=8)
        .map(|k| {
            format!(
                "\n[[compensator]]\nname = \"gain {k}\"\nkind = \"lugre\"\nwatchdog = false\ngain = {}\n",
                0.1 * f64::from(k)
            )
        })
        .collect();
    let corners = "\n[[parameter_error]]\nkind = \"corners\"\nby = \"10 %\"\n";
    let study = Desk::new()
        .study(&together(&[AXIS, SHORT, CASCADE, &gains, corners]))
        .unwrap();
    let outcome = stiction_workflows::study::simulate(&study, &mut Silent);
    let html =
        String::from_utf8(stiction_pages::bundle::study(&outcome).files()[0].1.clone()).unwrap();
    stiction_testkit::assert_tables_fit(&html);
    assert!(html.contains("7 of 9: without compensation, and those that leave the least"));
    assert!(
        html.contains("largest error, gain 8, if the axis were exactly the model; ")
            && html.contains("at the worst of ±10 %")
    );
}

/// Of many motions and controllers every motion has figures before one has them under a second controller; tables have all.
#[test]
fn figures_of_every_motion() {
    let paths: String = (1..=9)
        .map(|k| SHORT.replace("[[path]]", &format!("[[path]]\nname = \"{k} times\"")))
        .collect();
    let pid = "\n[[controller]]\nkind = \"pid\"\nbandwidth = \"40 Hz\"\n";
    let study = Desk::new().study(&together(&[AXIS, &paths, CASCADE, pid]));
    let outcome = stiction_workflows::study::simulate(&study.unwrap(), &mut Silent);
    let html =
        String::from_utf8(stiction_pages::bundle::study(&outcome).files()[0].1.clone()).unwrap();
    assert!(html.contains("16 of 18 motions and controllers have figures"));
    assert_eq!(html.matches("<title>Tracking error</title>").count(), 16);
    let (_, last) = html.rsplit_once(">9 times, cascade 60 Hz<").unwrap();
    let (section, without) = last.split_once(">9 times, pid 40 Hz<").unwrap();
    assert!(section.contains("<title>Tracking error</title>"));
    assert!(!without.contains("<title>Tracking error</title>"));
    // One run has no worst, and no column of it.
    assert!(!html.contains(">Worst<"));
}

/// What is said of a model is said of its axis, once.
#[test]
fn warnings_of_two_axes() {
    let desk = Desk::new();
    let doubtful = model(0.1, 0.1).replace("trustworthy = true", "trustworthy = false");
    desk.write("model.toml", &doubtful);
    let axes = "[axis]\nmodel = \"model.toml\"\nrate = \"4 kHz\"\npeak_force = \"200 N\"\n\
                [second_axis]\nmodel = \"model.toml\"\npeak_force = \"200 N\"\n";
    let text = together(&[axes, "[[contour]]\nkind = \"circle\"\n", CASCADE]);
    let study = desk.study(&text).unwrap();
    let said: Vec<&str> = study.warnings.iter().map(|w| w.message.as_str()).collect();
    let flagged = "the identification flagged this model as not trustworthy: see its report";
    assert_eq!(
        said,
        [
            format!("first axis: {flagged}"),
            format!("second axis: {flagged}")
        ]
    );
}

/// A model of force steps without a steady curve: what is missing, and how to have it.
#[test]
fn bristles_alone_are_no_axis() {
    let desk = Desk::new();
    let text = model(0.1, 0.1)
        .replace("separable", "presliding-step")
        .replace(
            "inputs = []",
            "inputs = [{ path = \"my step.csv\", sha256 = \"0\" }]",
        );
    let (before, rest) = text
        .split_once("[[parameter]]\nname = \"stribeck_velocity\"")
        .unwrap();
    let (_, after) = rest.split_once("[[parameter]]").unwrap();
    let (after, _) = after.split_once("[covariance]").unwrap();
    let text = format!("{before}[[parameter]]{after}[covariance]\nnames = []\nmatrix = []\n");
    desk.write("model.toml", &text);
    let said = desk.refusal("[axis]\nmodel = \"model.toml\"\nrate = \"4 kHz\"\n");
    let command = "stiction identify 'my step.csv' --method presliding-step --model curve/model.toml --out whole";
    assert!(
        said.contains("no stribeck_velocity") && said.ends_with(command),
        "{said}"
    );
}

/// The courses stand beside the report: the whole run, thinned evenly, one block for each run with exact parameters.
#[test]
fn courses_beside_the_report() {
    let corners = "\n[[parameter_error]]\nkind = \"corners\"\nby = \"10 %\"\n";
    let path = SHORT.replace("kind", "name = \"to, and \\\"fro\\\"\"\nkind");
    let study = Desk::new()
        .study(&together(&[AXIS, &path, CASCADE, WHOLE, corners]))
        .unwrap();
    let outcome = stiction_workflows::study::simulate(&study, &mut Silent);
    let bundle = stiction_pages::bundle::study(&outcome);
    let (name, rows) = &bundle.files()[1];
    assert_eq!(*name, "trajectories.csv");
    let rows = String::from_utf8(rows.clone()).unwrap();
    let mut lines = rows.lines();
    assert_eq!(
        lines.next().unwrap(),
        "path,controller,compensator,time [s],reference [m],position [m],error [m],force [N],compensation [N]"
    );
    let key = "\"to, and \"\"fro\"\"\",\"cascade 60 Hz\",\"whole\",";
    let whole: Vec<Vec<f64>> = lines
        .filter_map(|line| line.strip_prefix(key))
        .map(|line| line.split(',').map(|x| x.parse().unwrap()).collect())
        .collect();
    // Half a second at 4 kHz, all of it.
    assert_eq!(whole.len(), 2001);
    assert!((whole[2000][0] - 0.5).abs() < 1e-12);
    for row in &whole {
        let [_, reference, position, error, force, compensation] = row[..] else {
            panic!("{row:?}");
        };
        assert!((reference - position - error).abs() < 1e-9);
        assert!(compensation.abs() <= 20.0 && force.abs() <= 200.0);
    }
    let of = |name: &str| {
        row(&outcome.file, "whole", "exact")
            .metric(name)
            .unwrap()
            .mean
    };
    let counted = whole.iter().filter(|row| row[0] >= 0.25);
    let peak = counted.map(|row| row[3].abs()).fold(0.0, f64::max);
    assert!((peak / of("peak_error") - 1.0).abs() < 1e-6);
}

// Motions that are over within a few samples at 4 kHz.
const CHIRP: &str = "
[[path]]
kind = \"chirp\"
amplitude = \"1 mm\"
from = \"1 Hz\"
to = \"500 Hz\"
duration = \"2 s\"
";
const MOVE: &str = "
[[path]]
kind = \"staircase\"
distance = \"1e-300 m\"
velocity = \"1 m/s\"
acceleration = \"1 m/s2\"
jerk = \"100 m/s3\"
";
const HOLD: &str = "
[[path]]
kind = \"constant-velocity\"
hold = \"1 ms\"
velocity = \"1 um/s\"
acceleration = \"1 m/s2\"
jerk = \"1e6 m/s3\"
";
const EXCITATION: &str = "
[[path]]
kind = \"excitation\"
speed = \"1e300 m/s\"
duration = \"9 s\"
";
const BRIEF: &str = "
[[path]]
kind = \"excitation\"
speed = \"1 m/s\"
duration = \"1 ms\"
";

/// What goes farther than any axis is refused at its place, in the study and in the files that it names.
#[test]
fn motions_and_forces_beyond_all_measure_are_refused() {
    let desk = Desk::new();
    let rows = (0..100).map(|i| {
        format!(
            "{},{}\n",
            0.01 * f64::from(i),
            if i == 50 { 1e300 } else { 0.0 }
        )
    });
    let rows: String = rows.collect();
    desk.write("far.csv", &format!("t [s],x [m]\n{rows}"));
    desk.write("strong.csv", &format!("t [s],force [N]\n{rows}"));
    let file = "\n[[path]]\nkind = \"file\"\nfile = \"far.csv\"\n";
    let disturbed = AXIS.to_string() + "disturbance = { kind = \"file\", file = \"strong.csv\" }\n";
    let wide = SINE.replace("5 mm", "1e15 m");
    let said = [
        desk.refusal(&together(&[AXIS, file, CASCADE, WHOLE])),
        desk.refusal(&together(&[&disturbed, SINE, CASCADE, WHOLE])),
        desk.refusal(&together(&[AXIS, &wide, CASCADE, WHOLE])),
    ];
    insta::assert_snapshot!(said.join("\n"));
}

/// A loop that is not stable is named with its gains and the time at which the axis left the path; it has no figures, and the
/// other controllers have theirs.
#[test]
fn runs_that_diverge() {
    let desk = Desk::new();
    let wild = "
[[controller]]
kind          = \"cascade\"
name          = \"wild\"
position_gain = \"1e15 1/s\"
speed_gain    = \"1e15 N s/m\"
integral_gain = \"0 N/m\"
force_limit   = \"1e15 N\"
";
    let axis = AXIS.replace("peak_force   = \"1248 N\"\n", "");
    let file = desk.run(&together(&[&axis, SHORT, CASCADE, wild, WHOLE]));
    assert_eq!(file.results.len(), 2, "{:?}", file.results);
    assert!(file.results.iter().all(|row| row.controller != "wild"));
    assert_eq!(codes(&file), ["not-run"]);
    insta::assert_snapshot!(file.warnings[0].message);
}

/// Axes of a promise that leave their path are counted, with what was drawn; the gains, with which the axis as modelled stays on
/// its path, are not blamed.
#[test]
fn drawn_axes_that_diverge() {
    let desk = Desk::new();
    let remaining = "[remaining]\nshapes = []\nlevel = 0.0\nplace = PLACE\nplace_length = 0.001\nwandering = 0.0\nmemory = 0.01\n";
    let with = |place: &str| model(0.12, 0.18) + &remaining.replace("PLACE", place);
    desk.write("good.toml", &with("0.1"));
    desk.write("wild.toml", &with("1e15"));
    let run = |file: &str| {
        let text = together(&[AXIS, SHORT, CASCADE, WHOLE]);
        desk.run(&text.replace("known        = \"motor\"", &format!("model = \"{file}\"")))
    };
    let good = run("good.toml");
    assert_eq!(good.promise.len(), 1, "{:?}", good.not_promised);
    assert!(good.warnings.is_empty(), "{:?}", good.warnings);
    let wild = run("wild.toml");
    assert_eq!(codes(&wild), ["not-promised"]);
    assert!(wild.promise.is_empty());
    assert!(row(&wild, "whole", "exact").metric("peak_error").is_some());
    insta::assert_snapshot!(format!(
        "{}\n{}",
        wild.not_promised.unwrap(),
        wild.warnings[0].message
    ));
}

/// What the warnings call unstable is not promised first.
#[test]
fn a_loop_that_swings_promises_nothing() {
    let desk = Desk::new();
    let remaining = "[remaining]\nshapes = []\nlevel = 0.0\nplace = 0.1\nplace_length = 0.001\nwandering = 0.0\nmemory = 0.01\n";
    desk.write("model.toml", &(model(0.12, 0.18) + remaining));
    let axis = AXIS.replace("known        = \"motor\"", "model = \"model.toml\"");
    let fast = CASCADE
        .replace("60 Hz", "900 Hz")
        .replace("cascade\"", "cascade\"\nname = \"fast\"");
    let file = desk.run(&together(&[&axis, SHORT, CASCADE, &fast, WHOLE]));
    assert!(
        codes(&file).contains(&"unsteady-command"),
        "{:?}",
        file.warnings
    );
    let drawn = file
        .results
        .iter()
        .filter(|row| row.parameters == "promised" && row.compensator == "whole");
    let drawn: Vec<_> = drawn
        .map(|row| {
            (
                row.controller.as_str(),
                row.judged().unwrap().left90_percent.is_some(),
            )
        })
        .collect();
    assert!(drawn.contains(&("fast", true)), "{drawn:?}");
    let promised: Vec<_> = file
        .promise
        .iter()
        .map(|entry| entry.controller.as_str())
        .collect();
    assert_eq!(promised, ["cascade 60 Hz"], "{:?}", file.not_promised);
}

/// Between the passes of learning the work can be stopped; what was not finished is not kept.
#[test]
fn learning_stops_between_passes() {
    let learning = "\n[[compensator]]\nkind = \"learning\"\nlead = \"2.5 ms\"\ncutoff = \"250 Hz\"\npasses = 50\n";
    let study = Desk::new()
        .study(&together(&[AXIS, SHORT, CASCADE, learning]))
        .unwrap();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1);
    let mut asked = 0;
    let outcome = pool.build().unwrap().install(|| {
        stiction_workflows::study::simulate(&study, &mut |progress: &Progress| {
            let (done, _) = counted(progress);
            // The run without compensation, then three passes.
            asked += 1;
            assert_eq!(done, 1);
            match asked {
                4.. => Control::Stop,
                _ => Control::Continue,
            }
        })
    });
    assert_eq!((asked, outcome.file.status.as_str()), (4, "interrupted"));
    assert_eq!(outcome.file.results.len(), 1);
}

/// Published numbers in the study itself: the known axis that has them, and its results.
#[test]
fn six_published_numbers_are_simulated() {
    let desk = Desk::new();
    let known = together(&[AXIS, SINE, CASCADE, WHOLE]);
    let numbers = "mass = \"4.6 kg\"\nparameters = { sigma0 = \"2e6 N/m\", sigma1 = \"1500 N s/m\", sigma2 = \"0.03 N s/mm\", \
                   coulomb = \"12 N\", static = \"18 N\", stribeck_velocity = \"3 mm/s\" }";
    let given = known.replace("known        = \"motor\"", numbers);
    let (known, given) = (desk.run(&known), desk.run(&given));
    assert_eq!(known.results, given.results);
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
    let of_a_bristle = |block: &&str| block.contains("\"sigma0\"") || block.contains("\"sigma1\"");
    let steady = model(0.1, 0.1).replace("\"lugre\"", "\"stribeck\"");
    let steady: Vec<&str> = steady
        .split("[[parameter]]")
        .filter(|block| !of_a_bristle(block))
        .collect();
    desk.write("steady.toml", &steady.join("[[parameter]]"));
    desk.write(
        "part.toml",
        &model(0.1, 0.1)
            .replacen("sigma0", "offset", 1)
            .replacen("N/m", "N", 1),
    );
    desk.write("weightless.toml", &model(0.1, 0.1).replace("4.6", "0.0"));
    desk.write("points.csv", "t [s],x [parsec]\n0,0\n1,1\n");
    let changes = [
        ("known        = \"motor\"", "parameters = \"motor\""),
        (
            "known        = \"motor\"",
            "parameters = { sigma0 = \"2e6 N/m\", coulomb = \"12 N\" }",
        ),
        (
            "known        = \"motor\"",
            "parameters = { sigma0 = \"2e6 N/m\", sigma1 = \"1500 N s/m\", sigma2 = \"30 N s/m\", coulomb = \"12 N\", \
             static = \"8 N\", stribeck_velocity = \"3 mm/s\" }",
        ),
        (
            "known        = \"motor\"",
            "parameters = { sigma0 = \"2e6 N/m\", sigma1 = \"1500 N s/m\", sigma2 = \"30 N s/m\", coulomb = \"12 N m\", \
             static = \"18 N\", stribeck_velocity = \"3 mm/s\" }",
        ),
        (
            "known        = \"motor\"",
            "known = \"motor\"\nparameters = { sigma0 = \"2e6 N/m\" }",
        ),
        ("known        = \"motor\"", "known = \"Motor\""),
        ("known        = \"motor\"", "model = \"\""),
        ("known        = \"motor\"", "model = \".\""),
        ("known        = \"motor\"", "model = \"weightless.toml\""),
        (SINE, "[[path]]\nkind = \"file\"\nfile = \"\"\n"),
        (SINE, "[[path]]\nkind = \"file\"\nfile = \"absent.csv\"\n"),
        (SINE, "[[path]]\nkind = \"file\"\nfile = \".\"\n"),
        (SINE, "[[path]]\nkind = \"file\"\nfile = \"points.csv\"\n"),
        ("encoder      = \"50 nm\"", "encoder = \"1e15 m\""),
        ("encoder      = \"50 nm\"", "encoder = \"11 mm\""),
        ("current_loop = \"1 kHz\"", "current_loop = \"fast\""),
        (
            "peak_force   = \"1248 N\"",
            "peak_force = \"1248 N\"\ncogging = { amplitude = \"2 N\", pitch = \"49 nm\" }",
        ),
        (
            "peak_force   = \"1248 N\"",
            "peak_force = \"1248 N\"\ncogging = { amplitude = \"2 N\", pitch = \"1e14 m\" }",
        ),
        ("bandwidth   = \"60 Hz\"", "bandwidth = \"2 kHz\""),
        (
            "bandwidth   = \"60 Hz\"",
            "bandwidth = \"60 Hz\"\nsecond_bandwidth = \"50 Hz\"",
        ),
        (
            "gain     = 1.0",
            "adaptation = { memory = \"1 s\", range = 1.0 }",
        ),
        ("name     = \"whole\"", "name = \"wh\\u001b[31mole\""),
        (
            "[axis]",
            "[[parameter_error]]\nkind = \"corners\"\nby = \"100 %\"\n[axis]",
        ),
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
        ("amplitude = \"5 mm\"", "amplitud = \"5 mm\""),
        ("frequency = \"0.5 Hz\"", "frequency = \"1e-6 Hz\""),
        ("frequency = \"0.5 Hz\"", "frequency = \"3 kHz\""),
        ("frequency = \"0.5 Hz\"", "frequency = \"1e300 Hz\""),
        ("amplitude = \"5 mm\"", "amplitude = \"1e300 m\""),
        (
            "peak_force   = \"1248 N\"",
            "peak_force = \"1248 N\"\ncogging = { amplitude = \"1e300 N\", pitch = \"24 mm\" }",
        ),
        (SINE, CHIRP),
        (SINE, MOVE),
        (SINE, HOLD),
        (SINE, EXCITATION),
        (SINE, BRIEF),
        ("kind      = \"sine\"", "kind = \"sinus\""),
        ("[[path]]", "[path]"),
        ("known        = \"motor\"", ""),
        ("known        = \"motor\"", "known = \"engine\""),
        ("known        = \"motor\"", "model = \"absent.toml\""),
        ("known        = \"motor\"", "model = \"volts.toml\""),
        ("known        = \"motor\"", "model = \"steady.toml\""),
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
        (
            "watchdog = false",
            "watchdog = false\nwatchdog_window = \"1 s\"",
        ),
        (
            "[axis]",
            "[coupling]\nbandwidth = \"30 Hz\"\nlimit = \"10 mm/s\"\n[axis]",
        ),
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
