//! Comparisons on a log: what its axis file says holds for the reference as for the searches.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use stiction_files::compare_file::CompareFile;
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
use stiction_identify::Silent;
use stiction_identify::candidates::Scheme;
use stiction_servo::noise::Noise;
use stiction_workflows::compare::{CompareOptions, Input, compare};

const STEP: f64 = 1e-3;
const COULOMB: f64 = 14.0;

/// Three seconds of a sine with 1 % noise on the force, the law on a finer grid.
fn log(folder: &Path, shape: Shape<f64>, micro_damping: f64) -> PathBuf {
    let side = Direction {
        coulomb: COULOMB,
        static_friction: 19.5,
        stribeck_velocity: 8e-3,
        viscous: 45.0,
    };
    let curve = Stribeck::new(shape, side, side, 0.0).unwrap();
    let law = LuGre::new(8e4, Damping::Constant(micro_damping), curve).unwrap();
    let v = |t: f64| 0.08 * libm::sin(std::f64::consts::TAU * t);
    let mut noise = Noise::new(3);
    let (mut z, mut text) = (0.0, String::from("time [s],velocity [m/s],force [N]\n"));
    for i in 0..3000 {
        let t = f64::from(i) * STEP;
        for k in 0..if i > 0 { 20 } else { 0 } {
            let at = t - STEP + f64::from(k) * STEP / 20.0;
            z = law.step_record(z, STEP / 20.0, v(at), v(at + STEP / 20.0));
        }
        let force = law.force(z, v(t)) + 0.2 * noise.normal();
        let _ = writeln!(text, "{t:.4},{:.12e},{force:.9e}", v(t));
    }
    let path = folder.join("log.csv");
    std::fs::write(&path, text).unwrap();
    path
}

/// Three runs of least squares on it, with an axis file.
fn compared(folder: &Path, log: PathBuf, axis: &str, decades: Option<f64>) -> CompareFile {
    let path = folder.join("axis.toml");
    std::fs::write(
        &path,
        format!("kind = \"linear\"\nmass = \"none\"\n[terms]\n{axis}"),
    )
    .unwrap();
    let options = CompareOptions {
        input: Input::Log { logs: vec![log] },
        axis: Some(path),
        methods: vec!["lm".into()],
        seeds: 3,
        evaluations: 2000,
        noise: None,
        excitation: None,
        rate: None,
        other_law: false,
        decades,
        integrator: Scheme::Explin,
        cost: None,
        max_samples: u64::MAX,
    };
    compare(&options, &mut Silent).unwrap_or_else(|e| panic!("{axis}: {e}"))
}

fn found(file: &CompareFile, name: &str) -> f64 {
    let run = &file.methods[0].runs[0];
    run.parameters.iter().find(|(n, _)| n == name).unwrap().1
}

/// The wrong delay makes the fit worse, for the reference and the searches alike.
#[test]
fn a_given_delay_holds_for_the_reference_too() {
    let folder = tempfile::tempdir().unwrap();
    let log = log(folder.path(), Shape::Gaussian, 350.0);
    let none = compared(folder.path(), log.clone(), "delay = \"none\"\n", None);
    for delay in ["-2 ms", "2 ms"] {
        let axis = format!("delay = \"{delay}\"\n");
        let file = compared(folder.path(), log.clone(), &axis, None);
        assert!(file.reference.cost > 1.001 * none.reference.cost, "{delay}");
        assert!(!file.reference.beaten, "{delay}: {:?}", file.reference);
        let successes = file.methods[0].own.successes;
        assert_eq!(successes, 3, "{delay}: {:?}", file.methods[0].own.excess);
    }
}

#[test]
fn the_exponent_of_the_axis_file_is_fitted_with() {
    let folder = tempfile::tempdir().unwrap();
    let log = log(folder.path(), Shape::Power(1.0), 350.0);
    let axis = "delay = \"none\"\nstribeck_exponent = 1\n";
    let right = compared(folder.path(), log.clone(), axis, None);
    let gauss = compared(folder.path(), log, "delay = \"none\"\n", None);
    assert!(right.reference.cost < gauss.reference.cost);
    assert_eq!(right.methods[0].own.successes, 3);
    let [fs, vs] = ["static", "stribeck_velocity"].map(|name| found(&right, name));
    assert!((fs / 19.5 - 1.0).abs() < 0.05, "Fs {fs}");
    assert!((vs / 8e-3 - 1.0).abs() < 0.1, "vs {vs}");
    // Of a log nobody knows the answer: the report shows what each method found.
    let bundle = stiction_pages::bundle::comparison(&right);
    let (_, page) = &bundle.files()[0];
    let page = std::str::from_utf8(page).unwrap();
    let table = page.split_once("Parameters found").unwrap().1;
    assert!(table.contains(&stiction_number::sig(fs, 5)), "{fs}");
}

/// A micro-damping of zero has no logarithm; a box about it is a box about next to nothing.
#[test]
fn a_box_about_an_answer_with_a_zero_in_it() {
    let folder = tempfile::tempdir().unwrap();
    let log = log(folder.path(), Shape::Gaussian, 0.0);
    let file = compared(folder.path(), log, "delay = \"none\"\n", Some(1.0));
    assert_eq!(
        file.methods[0].own.successes, 3,
        "{:?}",
        file.methods[0].own
    );
}
