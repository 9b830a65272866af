//! Physical consistency: Pinocchio's log-Cholesky coordinates, bodies of known shape, and the projection's optimum.

use crate::common::{ARM7, Dice, apart, robot};
use stiction_rigid::consistency::{
    is_consistent, log_cholesky, log_cholesky_jacobian, made_consistent, of_log_cholesky,
    of_pseudo_inertia, pseudo_inertia, smallest_eigenvalue,
};
use stiction_rigid::inertia::{Parameters, point_mass, sum};
use stiction_rigid::project;

#[test]
fn log_cholesky_coordinates_are_those_of_pinocchio() {
    let text = include_str!("../pinocchio/log_cholesky.txt");
    let lines: Vec<Vec<f64>> = text
        .lines()
        .map(|line| line.split(' ').map(|x| x.parse().unwrap()).collect())
        .collect();
    let mut cases = 0;
    for case in lines.chunks_exact(3) {
        let theta: [f64; 10] = case[0].clone().try_into().unwrap();
        let parameters = of_log_cholesky(&theta);
        assert!(apart(&parameters, &case[1]) < 1e-14);
        let jacobian = log_cholesky_jacobian(&theta).concat();
        assert!(apart(&jacobian, &case[2]) < 1e-14);
        assert!(apart(&log_cholesky(&parameters).unwrap(), &theta) < 1e-12);
        assert_eq!(
            of_pseudo_inertia(&pseudo_inertia(&parameters))[..4],
            parameters[..4]
        );
        cases += 1;
    }
    assert_eq!(cases, 5);
}

/// A cuboid of these edges, m, and mass, kg, about its centre.
fn cuboid(mass: f64, [a, b, c]: [f64; 3]) -> Parameters {
    let moment = |p: f64, q: f64| mass / 12.0 * (p * p + q * q);
    [
        mass,
        0.0,
        0.0,
        0.0,
        moment(b, c),
        0.0,
        moment(a, c),
        0.0,
        0.0,
        moment(a, b),
    ]
}

#[test]
fn bodies_of_known_shape() {
    // Eigenvalues in kg at 0.1 m: of each edge m e² / 12, and the mass.
    let edges = [0.1, 0.2, 0.3];
    let body = cuboid(12.0, edges);
    assert!((smallest_eigenvalue(&body) - 1.0).abs() < 1e-12);
    assert!(is_consistent(&body));
    assert_eq!(made_consistent(&body), body);
    // A plate of no thickness is the limit; a point mass, no mass and a negative one are beyond it.
    let plate = cuboid(12.0, [0.0, 0.2, 0.3]);
    assert!(smallest_eigenvalue(&plate).abs() < 1e-12);
    for impossible in [
        plate,
        point_mass(1.0, [0.1; 3]),
        [0.0; 10],
        cuboid(-1.0, edges),
    ] {
        assert!(!is_consistent(&impossible));
        let made = made_consistent(&impossible);
        assert!(
            smallest_eigenvalue(&made) > 0.9e-4,
            "{}",
            smallest_eigenvalue(&made)
        );
    }
    let near = made_consistent(&plate);
    assert!(apart(&near, &plate) < 0.02, "{}", apart(&near, &plate));
    // Too large a moment for the others.
    let mut body = body;
    body[9] = body[4] + body[6] + 1e-3;
    assert!(!is_consistent(&body));
}

/// Information of random equations, so many a parameter of each body.
fn information(dice: &mut Dice, n: usize, equations: usize) -> Vec<f64> {
    let mut h = vec![0.0; n * n];
    for _ in 0..equations {
        let row = dice.vector(n, 100.0);
        for i in 0..n {
            for j in 0..n {
                h[i * n + j] += row[i] * row[j];
            }
        }
    }
    h
}

fn misfit(h: &[f64], a: &[f64], b: &[f64]) -> f64 {
    let n = a.len();
    let gap: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    (0..n)
        .map(|i| gap[i] * (0..n).map(|j| h[i * n + j] * gap[j]).sum::<f64>())
        .sum()
}

#[test]
fn consistent_estimate_stays() {
    let nominal = robot(ARM7).parameters();
    let n = nominal.len();
    let mut dice = Dice::new();
    let h = information(&mut dice, n, 2 * n);
    let estimate: Vec<f64> = nominal.iter().map(|x| x * 1.02).collect();
    let found = project(&estimate, &h, &nominal, 1e-9).unwrap();
    assert!(found.converged && found.steps < 200, "{}", found.steps);
    assert!(apart(&found.parameters, &estimate) < 1e-7);
    assert!(found.misfit < 1e-9);
}

/// What the information says nothing of is that of the nominal body of least divergence; here, all is known but one body.
#[test]
fn undetermined_body_is_the_nominal_one() {
    let nominal = robot(ARM7).parameters();
    let n = nominal.len();
    let mut h = information(&mut Dice::new(), n, 2 * n);
    for i in 0..n {
        for j in 0..10 {
            h[i * n + 20 + j] = 0.0;
            h[(20 + j) * n + i] = 0.0;
        }
    }
    let estimate: Vec<f64> = nominal.iter().map(|x| x * 1.02).collect();
    let found = project(&estimate, &h, &nominal, 1e-6).unwrap();
    assert!(found.converged);
    assert!(apart(&found.parameters[20..30], &nominal[20..30]) < 1e-9);
}

/// The optimum of a convex problem: no consistent parameters have a smaller misfit, but for the weight of the prior times the
/// number of dimensions of its barrier (Boyd and Vandenberghe 2004, section 11.2.2).
#[test]
fn no_consistent_parameters_are_nearer() {
    let nominal = robot(ARM7).parameters();
    let n = nominal.len();
    let mut dice = Dice::new();
    let h = information(&mut dice, n, n / 2);
    let noise = dice.vector(n, 0.5);
    let estimate: Vec<f64> = nominal.iter().zip(&noise).map(|(x, e)| x + e).collect();
    assert!(
        estimate
            .as_chunks()
            .0
            .iter()
            .any(|body| !is_consistent(body))
    );
    let found = project(&estimate, &h, &nominal, 1e-6).unwrap();
    assert!(found.converged, "{found:?}");
    assert!(found.parameters.as_chunks().0.iter().all(is_consistent));
    let ours = misfit(&h, &found.parameters, &estimate);
    assert!((ours - found.misfit).abs() <= 1e-6 * ours + 1e-9);
    assert!(ours > 1.0);
    let mut best = f64::INFINITY;
    for round in 0..20_000 {
        // Near it in log-Cholesky coordinates, at all distances.
        let most = 10.0_f64.powi(-(round % 8));
        let bodies = found.parameters.as_chunks().0.iter();
        let other: Vec<f64> = bodies
            .flat_map(|body| {
                let mut theta = log_cholesky(body).unwrap();
                theta.iter_mut().for_each(|x| *x += most * dice.unit());
                of_log_cholesky(&theta)
            })
            .collect();
        best = best.min(misfit(&h, &other, &estimate));
    }
    assert!(best > ours - 2.0 * 1e-6 * 100.0 * 28.0, "{best} {ours}");
    // A smaller weight comes nearer, a larger one does not.
    let at = |weight| project(&estimate, &h, &nominal, weight).unwrap().misfit;
    assert!(at(1e-8) <= at(1e-6) && at(1e-6) < at(1.0));
}

#[test]
fn massless_nominal_bodies_are_made_consistent() {
    let estimate = sum(&cuboid(2.0, [0.1; 3]), &point_mass(0.1, [0.1, 0.0, 0.0]));
    let mut h = vec![0.0; 100];
    (0..10).for_each(|i| h[11 * i] = 1e4);
    let found = project(&estimate, &h, &[0.0; 10], 1e-6).unwrap();
    assert!(found.converged && found.misfit < 1e-3, "{found:?}");
}

#[test]
fn impossible_requests_are_refused() {
    let body = cuboid(1.0, [0.1; 3]);
    let h = vec![0.0; 100];
    let refused = |estimate: &[f64], h: &[f64], nominal: &[f64], weight| {
        project(estimate, h, nominal, weight)
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        refused(&body[1..], &h, &body, 1.0),
        "estimate: 9 values; allowed: 10"
    );
    assert_eq!(
        refused(&[], &h, &[], 1.0),
        "estimate: 0 values; allowed: 10"
    );
    assert_eq!(
        refused(&body, &h[1..], &body, 1.0),
        "information: 99 values; allowed: 100"
    );
    assert_eq!(
        refused(&body, &h, &body, 0.0),
        "weight of the prior = 0; allowed: positive, finite"
    );
    let mut bad = h.clone();
    bad[3] = f64::NAN;
    assert!(refused(&body, &bad, &body, 1.0).ends_with("allowed: finite"));
    bad[3] = 0.0;
    bad[0] = -1e6;
    assert!(refused(&body, &bad, &body, 1.0).contains("0 or more"));
}
