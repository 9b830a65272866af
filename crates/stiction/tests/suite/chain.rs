//! The whole chain: a stage runs the excitation, its log is identified from the file, and the law that was found is fed
//! forward on the stage itself.

use crate::common::{Bench, options};
use std::fmt::Write;
use std::path::PathBuf;
use stiction_files::ModelFile;
use stiction_files::study::Study;
use stiction_files::study::result::ResultRow;
use stiction_friction::compensator::{Compensator, Friction, Settings, Source};
use stiction_friction::{
    Damping, Direction, ElastoPlastic, Element, Gms, Held, LuGre, Shape, Stribeck,
};
use stiction_identify::Silent;
use stiction_pages::bundle;
use stiction_parameters::LawKind;
use stiction_servo::axis::{AxisSettings, Sample};
use stiction_servo::feedforward::Feedforward;
use stiction_servo::known;
use stiction_servo::metrics::Tracking;
use stiction_servo::motion::Sine;
use stiction_servo::noise::Noise;
use stiction_servo::path::Path;
use stiction_servo::plant::Plant;
use stiction_servo::run::run;
use stiction_workflows::export::{ExportOptions, Target};

const RATE: f64 = 4000.0;

/// The stage at 4 kHz with one sample of delay, a current loop of 1 kHz, 50 nm an encoder step, 20 nm of noise before it.
fn stage() -> AxisSettings {
    AxisSettings {
        position_noise: 20e-9,
        ..known::find("motor").unwrap().simulated(RATE, 60.0).unwrap()
    }
}

/// What its drive logs: measured position, commanded force with .5 N of noise.
fn log(bench: &Bench) -> PathBuf {
    let samples = run(&stage(), &Path::three_segments(0.196, 6.0).unwrap()).unwrap();
    bench.write("stage.csv", &logged(&samples))
}

fn logged(samples: &[Sample]) -> String {
    let mut noise = Noise::new(7);
    let mut text = String::from("Time [s],Position [mm],Force [N]\n");
    for s in samples {
        let force = s.command + 0.5 * noise.normal();
        let _ = writeln!(text, "{:.6},{:.5},{force:.3}", s.time, 1e3 * s.measured);
    }
    text
}

#[test]
fn what_is_identified_takes_nine_tenths_off_the_reversal_peak() {
    let bench = Bench::new();
    let log = log(&bench);
    let outcome = options(&[&log], LawKind::LuGre)
        .identify(&mut Silent)
        .unwrap();
    assert!(
        outcome.result.trust.trustworthy,
        "{:?}",
        outcome.result.trust
    );
    let value = |name: &str| {
        let found = outcome.result.parameters.iter().find(|p| p.name == name);
        found.unwrap_or_else(|| panic!("no {name}")).value
    };
    let side = Direction {
        coulomb: value("coulomb"),
        static_friction: value("static"),
        stribeck_velocity: value("stribeck_velocity"),
        viscous: value("sigma2"),
    };
    let curve = Stribeck::symmetric(Shape::Gaussian, side, 0.0).unwrap();
    let law = LuGre::new(value("sigma0"), Damping::Capped(value("sigma1")), curve).unwrap();

    let none = stage();
    let compensator = Compensator::new(
        Friction::LuGre(law),
        Source::Reference,
        Settings::bare(1.0 / RATE, 200.0),
    );
    let with = AxisSettings {
        feedforward: Feedforward::compensator(compensator.unwrap(), none.drive.preview(1.0 / RATE)),
        ..none.clone()
    };
    for (amplitude, frequency) in [(5e-3, 0.5), (1e-3, 0.2), (20e-6, 1.0)] {
        let peak = |axis: &AxisSettings| {
            let samples = run(axis, &Sine::new(amplitude, frequency, 3.0).unwrap()).unwrap();
            Tracking::of(&samples[samples.len() / 3..]).reversal_peak
        };
        let (before, after) = (peak(&none), peak(&with));
        let less = 100.0 * (1.0 - after / before);
        println!(
            "{} um, {frequency} Hz: {:.1} um, {:.2} um, {less:.1} % less",
            1e6 * amplitude,
            1e6 * before,
            1e6 * after
        );
        assert!(less >= 90.0, "{less}");
    }
    for p in &outcome.result.parameters {
        println!("{} {}", p.name, p.value);
    }
}

/// A stage of a law that is not LuGre.
fn stage_of<L: Held<f64>>(law: L) -> AxisSettings<L> {
    let stage = stage();
    AxisSettings {
        plant: Plant::new(stage.plant.mass(), law).unwrap(),
        drive: stage.drive,
        encoder: stage.encoder,
        position_noise: stage.position_noise,
        cogging: None,
        disturbance: None,
        controller: stage.controller,
        feedforward: Feedforward::default(),
        rate: stage.rate,
        substeps: stage.substeps,
        seed: stage.seed,
    }
}

/// What is identified of a law is what compensates it: the log of its stage goes through a file into a model, the model into a
/// compensator, and that onto the stage. `least` is the share of the reversal peak that is taken off, percent.
fn compensated<L: Held<f64>>(law: L, kind: LawKind, least: f64) {
    let stage = stage_of(law);
    let bench = Bench::new();
    let samples = run(&stage, &Path::three_segments(0.196, 6.0).unwrap()).unwrap();
    let log = bench.write("stage.csv", &logged(&samples));
    let outcome = options(&[&log], kind).identify(&mut Silent).unwrap();
    let model = ModelFile::from_result(&outcome.result);
    let mut options = ExportOptions::new(Target::Rust, 1.0 / RATE);
    options.gain = Some(1.0);
    options.limit = Some(200.0);
    options.safety.window = Some(0.0);
    let compensator = stiction_workflows::export::compensator(&model, &options).unwrap();
    let with = AxisSettings {
        feedforward: Feedforward::compensator(compensator, stage.drive.preview(1.0 / RATE)),
        ..stage.clone()
    };
    // The study beside the model runs as it is.
    let dir = bench.path("found");
    bundle::identification(&outcome).write(&dir).unwrap();
    let study = Study::read(dir.join("study.toml")).unwrap();
    let file = stiction_workflows::study::simulate(&study, &mut Silent).file;
    for path in ["as fast as in the log", "a tenth of that"] {
        let error = |compensator: &str| {
            let row = file.results.iter().find(|row| {
                row.path == path && row.compensator == compensator && row.parameters == "exact"
            });
            let metrics = &row.unwrap().metrics;
            metrics
                .iter()
                .find(|m| m.name == "reversal_peak")
                .unwrap()
                .mean
        };
        assert!(error(kind.name()) < 0.5 * error("none"), "{path}");
    }
    for (amplitude, frequency) in [(5e-3, 0.5), (1e-3, 0.2), (20e-6, 1.0)] {
        let peak = |axis: &AxisSettings<L>| {
            let samples = run(axis, &Sine::new(amplitude, frequency, 3.0).unwrap()).unwrap();
            Tracking::of(&samples[samples.len() / 3..]).reversal_peak
        };
        let (before, after) = (peak(&stage), peak(&with));
        let less = 100.0 * (1.0 - after / before);
        println!(
            "{kind}: {} um, {frequency} Hz: {:.1} um, {:.2} um, {less:.1} % less",
            1e6 * amplitude,
            1e6 * before,
            1e6 * after
        );
        assert!(less >= least, "{less}");
    }
}

#[test]
#[ignore = "soak: LuGre beside it"]
fn an_elasto_plastic_axis_is_compensated_by_its_law() {
    let bristle = known::find("motor").unwrap().capped_law();
    let law = ElastoPlastic::new(bristle, 0.7).unwrap();
    compensated(law, LawKind::ElastoPlastic, 90.0);
}

#[test]
#[ignore = "soak: LuGre beside it"]
fn a_gms_axis_is_compensated_by_its_law() {
    let curve = *known::find("motor").unwrap().law.curve();
    let element = |stiffness, share| Element { stiffness, share };
    let elements = [
        element(1.2e6, 0.3),
        element(6e5, 0.3),
        element(3e5, 0.25),
        element(1e5, 0.15),
    ];
    let law = Gms::new(elements, 2e3, 0.0, curve).unwrap();
    compensated(law, LawKind::Gms, 80.0);
}

/// The study that is written beside a model runs as it is.
#[test]
fn the_study_beside_a_model_shows_what_compensation_does() {
    let bench = Bench::new();
    let log = log(&bench);
    let outcome = options(&[&log], LawKind::LuGre).identify(&mut Silent);
    let dir = bench.path("found");
    bundle::identification(&outcome.unwrap())
        .write(&dir)
        .unwrap();
    let study = Study::read(dir.join("study.toml")).unwrap();
    let file = stiction_workflows::study::simulate(&study, &mut Silent).file;
    // The model knows its errors, so that it promises: the axis as modelled is near what it is promised to be.
    assert_eq!(file.promise.len(), 4, "{:?}", file.not_promised);
    assert!(file.promise.iter().all(|p| p.left90_percent[1] < 60.0));
    let modelled = |row: &&ResultRow| row.parameters == "exact";
    let results: Vec<_> = file.results.iter().filter(modelled).collect();
    // Two paths, without, with Coulomb friction and with LuGre.
    assert_eq!(results.len(), 6);
    for path in results.chunks(3) {
        let error = |compensator: &str| {
            let row = path
                .iter()
                .find(|row| row.compensator == compensator)
                .unwrap();
            assert_eq!(row.switched_off, 0, "{row:?}");
            let peak = row.metrics.iter().find(|m| m.name == "reversal_peak");
            peak.unwrap().mean
        };
        assert!(error("lugre") < 0.5 * error("none"), "{path:#?}");
    }
}
