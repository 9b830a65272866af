//! Wrong settings are refused, with the method, the name, what was found and what is allowed.

use stiction_search::genetic::{Annealing, Rates, Ratio, Selection};
use stiction_search::{Bounds, Error, Finish, Method, Plan, annealing, genetic, levenberg};
use stiction_search::{cma_es, differential_evolution, nelder_mead, niched, particle_swarm};

fn refusal(method: Method) -> String {
    let error = method.start(3, 0).expect_err("a wrong setting");
    assert!(matches!(error, Error::Setting { .. }));
    error.to_string()
}

fn ga(change: impl FnOnce(&mut genetic::Settings)) -> Method {
    let mut settings = genetic::Settings::default();
    change(&mut settings);
    Method::AnnealingGa(settings)
}

macro_rules! with {
    ($method:ident, $module:ident, $($field:ident = $value:expr),+) => {{
        let mut settings = $module::Settings::default();
        $(settings.$field = $value;)+
        Method::$method(settings)
    }};
}

#[test]
fn refusals() {
    let cases = vec![
        ga(|s| s.population = 3),
        ga(|s| s.elite = 50),
        ga(|s| s.elite = 0),
        ga(|s| s.rounds = 0),
        ga(|s| s.generations = 2_000_000),
        ga(|s| {
            s.crossover_rate = Rates {
                low: 0.9,
                high: 0.6,
            }
        }),
        ga(|s| s.mutation_rate = Rates::fixed(f64::NAN)),
        ga(|s| s.selection = Selection::Rank { pressure: 2.5 }),
        ga(|s| s.ratio = Ratio::Constant(-0.1)),
        ga(|s| {
            s.annealing = Some(Annealing {
                start: 0.0,
                factor: 0.9,
            })
        }),
        ga(|s| {
            s.annealing = Some(Annealing {
                start: 5.0,
                factor: 1.1,
            })
        }),
        ga(|s| s.precision = Some(0.0)),
        ga(|s| s.adaptive_evolution = Some(2.0)),
        with!(NichedGa, niched, draw = 10),
        with!(NichedGa, niched, niches = 0),
        with!(NichedGa, niched, apart = f64::NAN),
        with!(De, differential_evolution, scale = [0.9, 0.5]),
        with!(De, differential_evolution, crossover = 1.5),
        with!(CmaEs, cma_es, population = Some(2)),
        with!(CmaEs, cma_es, deviation = f64::INFINITY),
        with!(Pso, particle_swarm, particles = 2),
        with!(Annealing, annealing, sample = 1),
        with!(Annealing, annealing, factor = 1.0),
        with!(NelderMead, nelder_mead, edge = 0.0),
        with!(NelderMead, nelder_mead, spread = f64::NAN),
        with!(Lm, levenberg, starts = 0),
        with!(Lm, levenberg, scan = 2_000_000),
    ];
    let all: Vec<String> = cases.into_iter().map(refusal).collect();
    insta::assert_snapshot!(all.join("\n"));
}

#[test]
fn boxes_and_finishes() {
    let wrong = [
        Bounds::new(vec![], vec![]),
        Bounds::new(vec![0.0], vec![1.0, 2.0]),
        Bounds::new(vec![0.0, 1.0], vec![1.0, f64::NAN]),
        Bounds::new(vec![-f64::MAX], vec![f64::MAX]),
    ];
    let mut all: Vec<String> = wrong
        .into_iter()
        .map(|b| b.expect_err("wrong").to_string())
        .collect();
    let plan = Plan::named("de").expect("listed");
    all.push(plan.start(65, 0).expect_err("too many").to_string());
    all.push(plan.start(0, 0).expect_err("none").to_string());
    let finish = Finish {
        apart: 2.0,
        ..Finish::default()
    };
    all.push(
        plan.finished(finish)
            .start(3, 0)
            .expect_err("too far")
            .to_string(),
    );
    insta::assert_snapshot!(all.join("\n"));
}

#[test]
fn every_name_is_a_method() {
    for name in Method::NAMES {
        assert_eq!(Method::named(name).expect("listed").name(), name);
        assert!(Plan::named(name).expect("listed").start(6, 1).is_ok());
    }
    assert_eq!(Plan::named("simplex"), None);
}
