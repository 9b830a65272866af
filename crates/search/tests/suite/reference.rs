//! The methods against implementations that are not ours: `reference/reference.txt`, made by the
//! script beside it with SciPy, pycma and pygmo.

use crate::common;
use stiction_search::{Limits, Method, Run, Silent, Status};
use stiction_search::{cma_es, differential_evolution, nelder_mead};

/// How many seeds of how many found the minimum, and their median evaluations.
struct Found {
    seeds: u64,
    hits: u64,
    median: f64,
}

/// As the published implementation found it.
fn published(method: &str, function: &str) -> Found {
    let line = include_str!("../reference/reference.txt")
        .lines()
        .find_map(|line| line.strip_prefix(&format!("{method} {function} ")))
        .expect("in the file");
    let numbers: Vec<u64> = line
        .split(' ')
        .map(|x| x.parse().expect("a number"))
        .collect();
    Found {
        seeds: numbers[0],
        hits: numbers[1],
        median: numbers[2] as f64,
    }
}

/// As ours finds it, without restarts or a finish.
fn ours(method: &Method, function: &str, seeds: u64) -> Found {
    let all = common::all(6);
    let function = all.iter().find(|f| f.name == function).expect("known");
    let mut used: Vec<u64> = (0..seeds)
        .filter_map(|seed| {
            let mut run = Run::new(method.start(6, seed).expect("settings"), function);
            let limits = Limits {
                costs: 20_000,
                target: Some(1e-8),
                ..Limits::default()
            };
            let stop = run.advance(function, &limits, &mut Silent);
            (stop == Ok(Status::Target)).then(|| run.counts().costs)
        })
        .collect();
    used.sort_unstable();
    Found {
        seeds,
        hits: used.len() as u64,
        median: used.get(used.len() / 2).map_or(0.0, |&n| n as f64),
    }
}

/// Hits within three deviations of the difference of two binomials, medians within a part.
fn compare(name: &str, method: &Method, within: f64) {
    for function in ["sphere", "ellipsoid", "rosenbrock", "rastrigin"] {
        let theirs = published(name, function);
        let ours = ours(method, function, theirs.seeds);
        let n = theirs.seeds as f64;
        let p = (ours.hits + theirs.hits) as f64 / (2.0 * n);
        let most = 3.0 * (2.0 * n * p * (1.0 - p)).sqrt();
        assert!(
            ours.hits.abs_diff(theirs.hits) as f64 <= most,
            "{name} {function}: {} hits for {}",
            ours.hits,
            theirs.hits
        );
        assert!(
            theirs.hits == 0 || (ours.median / theirs.median - 1.0).abs() < within,
            "{name} {function}: {} evaluations for {}",
            ours.median,
            theirs.median
        );
    }
}

#[test]
fn differential_evolution_is_as_scipy_has_it() {
    let settings = differential_evolution::Settings {
        spread: 0.0,
        ..Default::default()
    };
    compare("de", &Method::De(settings), 0.10);
}

#[test]
fn cma_es_is_as_pycma_has_it() {
    let settings = cma_es::Settings {
        restarts: 0,
        ..Default::default()
    };
    compare("cma-es", &Method::CmaEs(settings), 0.10);
}

/// pygmo flies on beyond the wall with another velocity, and sets out with other ones.
#[test]
fn particle_swarm_is_no_slower_than_pygmo() {
    let method = Method::named("pso").expect("listed");
    for function in ["sphere", "ellipsoid"] {
        let theirs = published("pso", function);
        let ours = ours(&method, function, theirs.seeds);
        assert_eq!(ours.hits, theirs.hits);
        let ratio = ours.median / theirs.median;
        assert!(ratio > 0.7 && ratio < 1.05, "{function}: {ratio}");
    }
}

/// No chance in it: one simplex takes the same way, evaluation for evaluation, from the point where seed 0
/// puts it. From there neither reaches the target on `ellipsoid` and `rosenbrock` with one simplex.
#[test]
fn nelder_mead_takes_the_way_of_scipy() {
    let settings = nelder_mead::Settings {
        simplices: 1,
        width: 1e-300,
        ..Default::default()
    };
    for function in ["sphere", "ellipsoid", "rosenbrock"] {
        let theirs = published("nelder-mead", function);
        let ours = ours(&Method::NelderMead(settings.clone()), function, 1);
        assert_eq!(
            (ours.hits, ours.median),
            (theirs.hits, theirs.median),
            "{function}"
        );
    }
}
