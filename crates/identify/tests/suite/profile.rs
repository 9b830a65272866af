//! Intervals from the profile of the cost, against the cost itself.

use crate::common::trials;
use crate::common::{Noise, record};
use stiction_friction::{Direction, Shape, Stribeck};
use stiction_identify::{
    Estimate, IntervalKind, Law, LawKind, Mass, Objective, Optimum, Record, Settings, Silent,
    Terms, estimate, intervals, separable,
};

const STEP: f64 = 5e-4;

fn terms() -> Terms {
    Terms {
        mass: Mass::Absent,
        offset: false,
        ..Terms::default()
    }
}

/// A Stribeck curve (Fc 20 N, Fs 30 N, vs 5 mm/s) along two tones with so much white noise that its
/// velocity is known to some 10 %.
fn noisy(noise: f64, seed: u64) -> Record {
    let both = Direction {
        coulomb: 20.0,
        static_friction: 30.0,
        stribeck_velocity: 5e-3,
        viscous: 60.0,
    };
    let curve = Stribeck::symmetric(Shape::Gaussian, both, 0.0).unwrap();
    let mut random = Noise::new(seed);
    let v = trials::motion(4000);
    let u = v
        .iter()
        .map(|&v| curve.force(v) + noise * random.normal())
        .collect();
    record(STEP, v, u)
}

fn fit(record: &Record, law: Law) -> (Estimate, Estimate, Optimum) {
    let found = separable(record, law, &terms(), &Settings::default(), &mut Silent).unwrap();
    let linear = estimate(record, law, &terms(), &found, 0.0);
    let mut full = linear.clone();
    intervals(record, &found, &mut full, &mut stiction_identify::Silent);
    (linear, full, found)
}

/// Least cost over all ln(Fs/Fc - 1), on a fine grid, at one Stribeck velocity.
fn least(objective: &Objective, velocity: f64) -> f64 {
    (0..=4000)
        .map(|i| -4.0 + 5.0 * f64::from(i) / 4000.0)
        .map(|excess| objective.evaluate(&[excess, velocity.ln()], false).cost)
        .fold(f64::INFINITY, f64::min)
}

/// At both ends of the interval the cost, minimised on a grid, has risen by what white noise makes of
/// 1.96 deviations.
#[test]
fn the_cost_at_the_ends_has_risen_by_the_quantile() {
    for seed in [1, 2, 3] {
        let record = noisy(12.0, seed);
        let law = Law::new(LawKind::Stribeck);
        let (linear, full, found) = fit(&record, law);
        let p = full.parameter("stribeck_velocity").unwrap();
        assert_eq!(p.interval, IntervalKind::Profile);
        let (low, high) = p.ci95.unwrap();
        let objective = Objective::new(&record, law, &terms());
        let variance = found.evaluation.cost / (record.kept() - 4) as f64;
        for end in [low, high] {
            let rise = (least(&objective, end) - found.evaluation.cost) / variance;
            // The long-run noise of a white residual is the white one to some percent.
            assert!(
                (0.9..1.25).contains(&(rise / 3.8415)),
                "seed {seed}: {rise}"
            );
        }
        let (a, b) = linear.parameter("stribeck_velocity").unwrap().ci95.unwrap();
        assert!((low / a - 1.0).abs() > 1e-3 || (high / b - 1.0).abs() > 1e-3);
        assert!(full.counts.total() > linear.counts.total());
    }
}

/// What is well known keeps its linear interval and costs nothing.
#[test]
fn a_well_known_parameter_keeps_its_linear_interval() {
    let record = noisy(0.2, 4);
    let (linear, full, _) = fit(&record, Law::new(LawKind::Stribeck));
    assert_eq!(linear.parameters, full.parameters);
    assert_eq!(linear.counts, full.counts);
}

/// Without a Stribeck peak in the data its velocity has at least one open side.
#[test]
fn a_curve_that_the_data_do_not_show_is_open() {
    let v = trials::motion(4000);
    let mut random = Noise::new(9);
    let u = v
        .iter()
        .map(|v| 20.0 * v.signum() + 60.0 * v + random.normal())
        .collect();
    let (_, full, _) = fit(&record(STEP, v, u), Law::new(LawKind::Stribeck));
    let p = full.parameter("stribeck_velocity").unwrap();
    assert!(!p.identifiable && !p.reason.is_empty());
    assert!(
        p.ci95
            .is_none_or(|(low, high)| low.is_infinite() || high.is_infinite()),
        "{p:?}"
    );
}
