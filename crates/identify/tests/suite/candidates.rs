//! The costs that searches see, against the friction crate, the separable method and differences.

use crate::common::{MACHINE, Noise, force_along, record};
use proptest::prelude::*;
use std::f64::consts::TAU;
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
use stiction_identify::candidates::{
    Candidates, Curve, Nonlinear, Scheme, SixParameters, box_of_curve, box_of_six, thinned,
};
use stiction_identify::procedure::{StaticPoint, StaticSettings, static_map};
use stiction_identify::{
    Conditioning, Cutoff, Delay, Law, LawKind, Mass, Record, Samples, SearchBox, Settings, Silent,
    Terms, condition, fit_law, fit_law_from, separable,
};
use stiction_search::{Bounds, Derivatives, Fidelity, Limits, Plan, Points, Problem, Run};

const SIX: [f64; 6] = [1.2e5, 600.0, 60.0, 20.0, 30.0, 5e-3];
const SAMPLES: usize = 3001;
const STEP: f64 = 1e-3;

fn velocity(t: f64) -> f64 {
    0.05 * (TAU * t).sin()
}

fn acceleration(t: f64) -> f64 {
    0.05 * TAU * (TAU * t).cos()
}

/// Force of the axis `machine` with a mass and an offset, and noise.
fn samples(mass: f64, offset: f64) -> Samples {
    let (v, mut u) = force_along(&MACHINE.law(), SAMPLES, STEP, 20, velocity);
    let mut noise = Noise::new(3);
    for (i, u) in u.iter_mut().enumerate() {
        *u += mass * acceleration(i as f64 * STEP) + offset + 0.3 * noise.normal();
    }
    Samples {
        time: (0..SAMPLES).map(|i| i as f64 * STEP).collect(),
        velocity: Some(v),
        force: u,
        ..Samples::default()
    }
}

fn plain() -> Record {
    let Samples {
        velocity, force, ..
    } = samples(0.0, 0.0);
    record(STEP, velocity.unwrap(), force)
}

fn bare() -> Terms {
    Terms {
        mass: Mass::Absent,
        offset: false,
        ..Terms::default()
    }
}

fn lugre() -> Law {
    Law::new(LawKind::LuGre)
}

/// A box of two decades to each side.
fn about(six: &[f64; 6]) -> Bounds {
    let [s0, s1, s2, fc, fs, vs] = *six;
    let x = [s0, s1, s2, fc, fs - fc, vs].map(f64::ln);
    Bounds::new(x.map(|x| x - 4.6).into(), x.map(|x| x + 4.6).into()).unwrap()
}

fn genome(six: &[f64; 6]) -> Vec<f64> {
    let bounds = about(six);
    bounds.at(&[0.5; 6])
}

fn cost(problem: &impl Problem, x: &[f64]) -> f64 {
    let mut points = Points::new(x.len());
    points.push(x);
    let mut out = [f64::NAN];
    problem.costs(&points, Fidelity::Full, &mut out);
    out[0]
}

fn derivatives(problem: &impl Problem, x: &[f64]) -> Derivatives {
    let mut points = Points::new(x.len());
    points.push(x);
    let mut out = [Derivatives::zeros(x.len())];
    problem
        .derivatives(&points, Fidelity::Full, &mut out)
        .unwrap();
    let [out] = out;
    out
}

/// Twice the gradient against central differences of the cost; the cost of both ways is one.
fn check_gradient(problem: &impl Problem, x: &[f64], tolerance: f64) {
    let at = derivatives(problem, x);
    let here = cost(problem, x);
    assert!(
        (at.cost - here).abs() < 1e-10 * here.max(1e-3),
        "{} {here}",
        at.cost
    );
    let steepest = at.gradient.iter().fold(here, |m, g| m.max(2.0 * g.abs()));
    for i in 0..x.len() {
        let moved = |d: f64| {
            let mut y = x.to_vec();
            y[i] += d;
            cost(problem, &y)
        };
        let slope = (moved(1e-4) - moved(-1e-4)) / 2e-4;
        let error = (2.0 * at.gradient[i] - slope).abs();
        assert!(
            error < tolerance * steepest,
            "gene {i}: {} {slope}",
            2.0 * at.gradient[i]
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// The cost of any candidate is that of the law of the friction crate, sample by sample.
    #[test]
    fn six_parameters_are_the_law(unit in prop::collection::vec(0.05_f64..0.95, 6)) {
        let record = plain();
        let problem =
            SixParameters::new(&record, lugre(), &bare(), about(&SIX), Scheme::Explin).unwrap();
        let x = about(&SIX).at(&unit);
        let value = |i: usize| problem.parameters(&x)[i].1;
        let side = Direction {
            viscous: value(2),
            coulomb: value(3),
            static_friction: value(4),
            stribeck_velocity: value(5),
        };
        let curve = Stribeck::symmetric(Shape::Gaussian, side, 0.0).unwrap();
        let law = LuGre::new(value(0), Damping::Constant(value(1)), curve).unwrap();
        let (_, model) = force_along(&law, SAMPLES, STEP, 1, velocity);
        let u = &record.segments[0].force;
        let sum: f64 = u.iter().zip(&model).map(|(u, y)| (u - y) * (u - y)).sum();
        let energy: f64 = u.iter().map(|u| u * u).sum();
        let found = cost(&problem, &x);
        prop_assert!((found / (sum / energy) - 1.0).abs() < 1e-8, "{found} {}", sum / energy);
    }
}

#[test]
fn gradients_are_slopes_whatever_stands_beside_the_law() {
    let off: Vec<f64> = (0..6)
        .map(|i| genome(&SIX)[i] + [0.2, -0.3, 0.1, -0.1, 0.2, 0.15][i])
        .collect();
    let record = plain();
    let problem =
        SixParameters::new(&record, lugre(), &bare(), about(&SIX), Scheme::Explin).unwrap();
    check_gradient(&problem, &off, 1e-6);
    let log = [samples(7.0, 1.5)];
    let none = Conditioning {
        source_cutoff: Cutoff::Off,
        common_cutoff: Cutoff::Off,
        ..Conditioning::default()
    };
    let filtered = Conditioning {
        common_cutoff: Cutoff::Hz(100.0),
        ..none
    };
    for conditioning in [none, filtered] {
        let record = condition(&log, &conditioning).unwrap();
        let terms = Terms::default();
        let problem =
            SixParameters::new(&record, lugre(), &terms, about(&SIX), Scheme::Explin).unwrap();
        check_gradient(&problem, &off, 1e-6);
        let three = SixParameters::nonlinear(&off);
        let inner = SearchBox::around(&three, 1.0);
        let least = Nonlinear::new(&record, None, lugre(), &terms, &inner).unwrap();
        check_gradient(&least, &three, 1e-4);
        // With Fc, sigma1 and sigma2 solved too, the cost can only be less.
        assert!(cost(&least, &three) < cost(&problem, &off));
    }
}

/// Costs come from the filtered force of a candidate and what further columns express of it, derivatives from the products of
/// all columns: two ways to one number, whatever filter, delay and terms there are, and where a coefficient is held at zero.
#[test]
fn costs_are_those_of_the_products_of_all_columns() {
    let wide = Terms {
        cogging: vec![4e-3],
        ..Terms::default()
    };
    let offset_alone = Terms {
        mass: Mass::Given(3.0),
        ..Terms::default()
    };
    let delayed = |samples: f64| Terms {
        delay: Delay::Given(samples * STEP),
        ..Terms::default()
    };
    let all = [
        bare(),
        Terms::default(),
        wide,
        offset_alone,
        delayed(1.0),
        delayed(-0.5),
        delayed(2.3),
    ];
    // A negative mass cannot be: beside friction of the right size it is held at zero.
    for mass in [7.0, -7.0] {
        let mut log = samples(mass, 1.5);
        log.valid = (0..SAMPLES).map(|i| !(900..1100).contains(&i)).collect();
        log.breaks = vec![2000];
        for common_cutoff in [Cutoff::Off, Cutoff::Hz(120.0), Cutoff::Hz(40.0)] {
            let conditioning = Conditioning {
                source_cutoff: Cutoff::Off,
                common_cutoff,
                ..Conditioning::default()
            };
            let record = condition(std::slice::from_ref(&log), &conditioning).unwrap();
            for terms in &all {
                let problem =
                    SixParameters::new(&record, lugre(), terms, about(&SIX), Scheme::Explin)
                        .unwrap();
                let mut points = Points::new(6);
                points.push(&genome(&SIX));
                let mut noise = Noise::new(8);
                for _ in 0..20 {
                    let unit = [(); 6].map(|()| (0.5 + 0.25 * noise.normal()).clamp(0.0, 1.0));
                    points.push(&about(&SIX).at(&unit));
                }
                let mut found = [f64::NAN; 21];
                problem.costs(&points, Fidelity::Full, &mut found);
                // To the bit, whatever stands in the other lanes.
                for (x, found) in points.rows().zip(&found).step_by(5) {
                    assert_eq!(cost(&problem, x), *found);
                }
                let mut products = vec![Derivatives::zeros(6); 21];
                problem
                    .derivatives(&points, Fidelity::Full, &mut products)
                    .unwrap();
                for (found, products) in found.iter().zip(&products) {
                    let apart = (found / products.cost - 1.0).abs();
                    assert!(
                        apart < 1e-9,
                        "{common_cutoff:?} {terms:?}: {found} {}",
                        products.cost
                    );
                }
            }
        }
    }
}

/// At the optimum of the separable method both costs are its cost, and every search that descends ends
/// there.
#[test]
fn searches_end_where_the_separable_method_does() {
    let record = plain();
    let (terms, settings) = (bare(), Settings::default());
    let optimum = separable(&record, lugre(), &terms, &settings, &mut Silent).unwrap();
    // What is known before the log moves a fitted law by little, the cost of a search not at all.
    let (best, _) = fit_law(&record, lugre(), &terms, 0.0, &settings, &mut Silent).unwrap();
    let energy: f64 = record.segments[0].force.iter().map(|u| u * u).sum();
    let least = optimum.evaluation.cost / energy;
    let bounds = box_of_six(&record).unwrap();
    let six = SixParameters::new(&record, lugre(), &terms, bounds, Scheme::Explin).unwrap();
    let thin = thinned(&record);
    let inner = SearchBox::from_record(&record, &lugre()).unwrap();
    let three = Nonlinear::new(&record, thin.as_ref(), lugre(), &terms, &inner).unwrap();
    let (point, found) = searched(&six);
    assert!((found / least - 1.0).abs() < 1e-6, "{found} {least}");
    let (p, found) = searched(&three);
    assert!((found / least - 1.0).abs() < 1e-6, "{found} {least}");
    for start in [SixParameters::nonlinear(&point), p] {
        let (estimate, _) = fit_law_from(
            &start,
            &record,
            lugre(),
            &terms,
            0.0,
            &settings,
            &mut Silent,
        )
        .unwrap();
        for p in &best.parameters {
            let again = estimate.value(p.name).unwrap();
            assert!(
                (again / p.value - 1.0).abs() < 1e-4,
                "{}: {again} {}",
                p.name,
                p.value
            );
        }
    }
}

fn searched(problem: &impl Problem) -> (Vec<f64>, f64) {
    let plan = Plan::named("niched-ga").unwrap();
    let search = plan.start(problem.bounds().dimensions(), 5).unwrap();
    let mut run = Run::new(search, problem);
    run.advance(problem, &Limits::default(), &mut stiction_search::Silent)
        .unwrap();
    let best = run.best().unwrap();
    (best.point.clone(), best.cost)
}

#[test]
fn a_curve_has_the_slopes_of_its_cost_and_names_for_each_direction() {
    let speeds: Vec<f64> = (-20..=20).map(|i| 0.05 * f64::from(i)).collect();
    let truth = [0.02_f64, 0.28, 0.06, 0.2, 0.03, 0.29, 0.04, 0.3].map(f64::ln);
    let force = |v: &f64| {
        let p = if *v < 0.0 { &truth[4..] } else { &truth[..4] };
        let [s2, fc, e, vs] = std::array::from_fn(|i| p[i].exp());
        (fc + e * (-(v / vs).powi(2)).exp()) * v.signum() + s2 * v
    };
    let u: Vec<f64> = speeds.iter().map(force).collect();
    let bounds = Bounds::new(truth.map(|x| x - 1.0).into(), truth.map(|x| x + 1.0).into());
    let curve = Curve::new(speeds, u, bounds.unwrap()).unwrap();
    assert!(cost(&curve, &truth) < 1e-28);
    let off: Vec<f64> = truth
        .iter()
        .enumerate()
        .map(|(i, x)| x + 0.1 * (i as f64 - 3.0))
        .collect();
    check_gradient(&curve, &off, 1e-5);
    assert_eq!(curve.parameters(&off)[6].0, "static_neg");
}

/// A search of a static map minimises what the least squares of the map do: two bad points move neither. Their mean square
/// has its minimum elsewhere.
#[test]
fn a_search_of_a_static_map_is_as_robust_as_its_least_squares() {
    let mut noise = Noise::new(5);
    let mut points: Vec<StaticPoint> = (0..12)
        .map(|i| 5e-4 * 600_f64.powf(f64::from(i) / 11.0))
        .flat_map(|v| [v, -v])
        .map(|velocity| StaticPoint {
            log: 0,
            time: (0.0, 1.0),
            position: 0.0,
            velocity,
            force: 0.4 + MACHINE.law().curve().force(velocity) + 0.05 * noise.normal(),
            error: 0.05,
            samples: 1000,
            effective: 1000.0,
            dropped: 0.0,
            pitches: 0,
        })
        .collect();
    points[4].force += 6.0;
    points[11].force += 9.0;
    for asymmetric in [false, true] {
        let settings = StaticSettings {
            asymmetric,
            offset: !asymmetric,
            ..StaticSettings::default()
        };
        let map = static_map(&points, &settings).unwrap();
        let (speed, force): (Vec<f64>, Vec<f64>) =
            points.iter().map(|p| (p.velocity, p.force)).unzip();
        let bounds = || box_of_curve(&speed, &force, asymmetric).unwrap();
        let robust = Curve::robust(&points, &settings, bounds()).unwrap();
        let squares = Curve::new(speed.clone(), force.clone(), bounds()).unwrap();
        let ended = |problem: &Curve| {
            let plan = Plan::named("de").unwrap();
            let search = plan.start(bounds().dimensions(), 5).unwrap();
            let mut run = Run::new(search, problem);
            let limits = Limits {
                costs: 60_000,
                ..Limits::default()
            };
            run.advance(problem, &limits, &mut stiction_search::Silent)
                .unwrap();
            run.best().unwrap().clone()
        };
        let found = ended(&robust);
        check_gradient(
            &robust,
            &found.point.iter().map(|x| x + 1e-3).collect::<Vec<_>>(),
            1e-4,
        );
        let mut elsewhere = 0.0_f64;
        for ((name, found), (_, other)) in robust
            .parameters(&found.point)
            .into_iter()
            .zip(squares.parameters(&ended(&squares).point))
        {
            let least = map.value(name).unwrap();
            assert!(
                (found / least - 1.0).abs() < 1e-3,
                "{name}: {found} {least}"
            );
            elsewhere = elsewhere.max((other / least - 1.0).abs());
        }
        assert!(elsewhere > 0.04, "{elsewhere}");
    }
}

#[test]
fn what_cannot_be_searched_is_refused_by_name() {
    let record = plain();
    let refused = |law: Law, terms: &Terms, scheme| {
        let problem = SixParameters::new(&record, law, terms, about(&SIX), scheme);
        problem.err().expect("refused").to_string()
    };
    let both = refused(lugre().asymmetric(), &bare(), Scheme::Explin);
    assert!(
        both.starts_with("nonlinear unknowns = 6: the symmetric LuGre law"),
        "{both}"
    );
    let euler = refused(lugre(), &Terms::default(), Scheme::Euler);
    assert!(
        euler.starts_with("further terms or filters = 2: none beside"),
        "{euler}"
    );
    let inner = SearchBox::from_record(&record, &lugre()).unwrap();
    let viscous = Law::new(LawKind::CoulombViscous);
    assert!(Nonlinear::new(&record, None, viscous, &bare(), &inner).is_err());
    let wide = Bounds::new(vec![-100.0; 6], vec![100.0; 6]).unwrap();
    assert!(SixParameters::new(&record, lugre(), &bare(), wide, Scheme::Explin).is_err());
    let settings = Settings::default();
    let start = fit_law_from(
        &[0.0],
        &record,
        lugre(),
        &bare(),
        0.0,
        &settings,
        &mut Silent,
    );
    assert!(start.is_err());
}
