//! sigma0 and sigma1 with the steady curve held, against the truth and against the joint fit.

use crate::common::trials::quantised;
use crate::common::{MACHINE, MOTOR, Noise, Set, record, sine_record};
use stiction_identify::procedure::{
    StaticPoint, StaticSettings, Statics, dynamic, dynamic_conditioned, static_map,
};
use stiction_identify::{
    Conditioning, Cutoff, Delay, Error, Estimate, Law, LawKind, Mass, Record, Settings, Silent,
    Terms, estimate, separable,
};

fn noisy(set: &Set, sd: f64, seed: u64) -> Record {
    let (v, clean) = sine_record(set);
    let mut noise = Noise::new(seed);
    let every = 3;
    let u: Vec<f64> = clean.iter().map(|f| f + sd * noise.normal()).collect();
    let thin = |x: &[f64]| x.iter().step_by(every).copied().collect::<Vec<_>>();
    record(3e-4, thin(&v), thin(&u))
}

/// A static map of the same axis from noisy constant speeds.
fn statics(set: &Set, sd: f64, seed: u64) -> Statics {
    let law = set.law();
    let mut noise = Noise::new(seed);
    let points: Vec<StaticPoint> = (0..14)
        .map(|i| 0.1 * set.velocity * 2000_f64.powf(f64::from(i) / 13.0))
        .flat_map(|v| [v, -v])
        .map(|velocity| StaticPoint {
            log: 0,
            time: (0.0, 1.0),
            position: 0.0,
            velocity,
            force: law.curve().force(velocity) + sd * noise.normal(),
            error: sd,
            samples: 1000,
            effective: 1000.0,
            dropped: 0.0,
            pitches: 0,
        })
        .collect();
    let settings = StaticSettings {
        offset: false,
        ..StaticSettings::default()
    };
    Statics::from_map(&static_map(&points, &settings).unwrap()).unwrap()
}

fn terms() -> Terms {
    Terms {
        mass: Mass::Absent,
        offset: false,
        ..Terms::default()
    }
}

fn fit(record: &Record, statics: &Statics) -> Estimate {
    dynamic(record, statics, &terms(), 1e-3, &mut Silent).unwrap()
}

#[test]
fn without_noise_the_truth() {
    for set in [MACHINE, MOTOR] {
        let found = fit(&noisy(&set, 0.0, 1), &statics(&set, 0.0, 1));
        for (name, truth) in set.truth() {
            let p = found.parameter(name).unwrap();
            println!("{} {name} {} {truth} {:?}", set.name, p.value, p.std);
            assert!((p.value / truth - 1.0).abs() < 2e-3, "{name}: {}", p.value);
            assert!(p.identifiable, "{name}: {}", p.reason);
        }
    }
}

/// With noise in the record and in the map, the intervals hold the truth: the uncertainty of the map
/// is in those of sigma0 and sigma1. Beside it the joint fit of the same record.
#[test]
fn with_noise_inside_the_intervals() {
    let set = MACHINE;
    let (mut inside, mut all) = (0, 0);
    let mut alone = 0.0_f64;
    for seed in 1..=30 {
        let record = noisy(&set, 0.2, seed);
        let known = statics(&set, 0.3, 100 + seed);
        let found = fit(&record, &known);
        for (name, truth) in [("sigma0", set.sigma0), ("sigma1", set.sigma1)] {
            let p = found.parameter(name).unwrap();
            let (low, high) = p.ci95.unwrap();
            inside += usize::from(low <= truth && truth <= high);
            all += 1;
            if name == "sigma1" {
                alone += (p.value / truth - 1.0).powi(2);
            }
        }
        if seed == 1 {
            let law = Law::new(LawKind::LuGre);
            let joint =
                separable(&record, law, &terms(), &Settings::default(), &mut Silent).unwrap();
            let joint = estimate(&record, law, &terms(), &joint, 1e-3);
            for name in ["sigma0", "sigma1", "coulomb", "static"] {
                let (a, b) = (
                    found.parameter(name).unwrap(),
                    joint.parameter(name).unwrap(),
                );
                println!(
                    "{name} {} {:?} / joint {} {:?}",
                    a.value, a.std, b.value, b.std
                );
                assert!((a.value / b.value - 1.0).abs() < 0.2);
            }
            assert!(
                joint.fit.rmse <= found.fit.rmse + 1e-9,
                "the joint fit leaves the least"
            );
        }
    }
    println!(
        "{inside} of {all}, sigma1 rms error {:.2} %",
        100.0 * (alone / 30.0).sqrt()
    );
    assert!(inside >= 52, "{inside} of {all}");
}

#[test]
fn a_curve_that_is_none_is_refused() {
    let mut known = statics(&MACHINE, 0.0, 1);
    let parameters = known.parameters.clone();
    known.parameters.retain(|p| p.name != "coulomb");
    let missing = Statics::new(known.parameters, known.covariance.clone(), 2.0);
    assert!(matches!(
        missing,
        Err(Error::Setting {
            name: "coulomb",
            ..
        })
    ));
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let mut parameters = parameters.clone();
        for p in parameters.iter_mut().filter(|p| p.name == "coulomb") {
            p.value = bad;
        }
        assert!(
            Statics::new(parameters, known.covariance.clone(), 2.0).is_err(),
            "{bad}"
        );
    }
}

/// Encoder steps and filters shift what is fitted beside a known curve, and no residual shows it: with what replicas show of it
/// taken off, the errors are smaller.
#[test]
fn what_encoder_and_filters_shift_is_taken_off() {
    let filters = Conditioning {
        source_cutoff: Cutoff::Hz(400.0),
        common_cutoff: Cutoff::Hz(200.0),
        ..Conditioning::default()
    };
    let terms = Terms {
        delay: Delay::NONE,
        ..Terms::default()
    };
    let statics = statics(&MACHINE, 1e-4, 1);
    let names = ["sigma0", "sigma1", "mass"];
    let (mut before, mut after, mut inside) = ([0.0; 3], [0.0; 3], 0);
    let runs = 6;
    for run in 0..runs {
        let trial = quantised(1e-6, 0.05, &filters, run);
        let mut found = dynamic(&trial.record, &statics, &terms, 1e-3, &mut Silent).unwrap();
        let raw = found.clone();
        dynamic_conditioned(&trial.record, &statics, &mut found, 0.0, &mut Silent);
        for (k, name) in names.iter().enumerate() {
            let truth = trial.truth.iter().find(|(own, _)| own == name).unwrap().1;
            let off = |estimate: &Estimate| (estimate.value(*name).unwrap() / truth - 1.0).powi(2);
            before[k] += off(&raw);
            after[k] += off(&found);
            let (low, high) = found.parameter(*name).unwrap().ci95.unwrap();
            inside += usize::from(low <= truth && truth <= high);
        }
    }
    println!("before {before:?}, after {after:?}, {inside} inside");
    assert!(before.iter().sum::<f64>() > 2.0 * after.iter().sum::<f64>());
}

/// The error of a delay that was found on the same record and then held is one of sigma1 and of the mass: their deviations are
/// those of the held delay and of its error together, taken from fits at the ends of its interval.
#[test]
fn the_error_of_a_held_delay_is_counted() {
    let filters = Conditioning {
        source_cutoff: Cutoff::Hz(400.0),
        common_cutoff: Cutoff::Hz(200.0),
        ..Conditioning::default()
    };
    let trial = quantised(1e-6, 0.05, &filters, 1);
    let statics = statics(&MACHINE, 1e-4, 1);
    let deviation = 5e-5;
    let at = |delay: f64, deviation: f64| {
        let terms = Terms {
            delay: Delay::Given(delay),
            ..Terms::default()
        };
        let mut found = dynamic(&trial.record, &statics, &terms, 1e-3, &mut Silent).unwrap();
        let raw = found.clone();
        dynamic_conditioned(&trial.record, &statics, &mut found, deviation, &mut Silent);
        (raw, found)
    };
    let [(early, _), (late, _)] = [-deviation, deviation].map(|delay| at(delay, 0.0));
    let [(_, known), (_, held)] = [0.0, deviation].map(|deviation| at(0.0, deviation));
    for name in ["sigma1", "mass"] {
        let moved = 0.5 * (late.value(name).unwrap() - early.value(name).unwrap());
        let [known, held] = [&known, &held].map(|e| e.parameter(name).unwrap().std.unwrap());
        println!("{name} moves by {moved}, {known} to {held}");
        assert!(moved.abs() > 0.5 * known, "{name} does not feel the delay");
        assert!((held / known.hypot(moved) - 1.0).abs() < 1e-2, "{name}");
    }
}
