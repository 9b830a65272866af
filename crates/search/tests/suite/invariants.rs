//! What holds for every search, whatever the seed and wherever it is cut.

use crate::common;
use crate::common::Function;
use proptest::prelude::*;
use stiction_search::{
    Bounds, Control, CostsOnly, Derivatives, Error, Fidelity, Finish, Finished, Kind, Limits,
    Method, Plan, Points, Problem, Run, Searcher, Silent, Status,
};

type Any = Run<Finished<Searcher>>;

fn plan(method: usize, finish: bool) -> Plan {
    let plan = Plan::named(Method::NAMES[method]).expect("listed");
    if finish {
        plan.finished(Finish::default())
    } else {
        plan
    }
}

fn function(i: usize) -> Function {
    let n = 2 + i % 3;
    let [a, b, c, d] = common::all(n);
    match i % 4 {
        0 => a,
        1 => b,
        2 => c,
        _ => d,
    }
}

fn start(plan: &Plan, function: &Function, seed: u64) -> Any {
    let search = plan
        .start(function.bounds().dimensions(), seed)
        .expect("defaults");
    Run::new(search, function)
}

fn text(run: &Any) -> String {
    serde_json::to_string(run).expect("plain data")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Interrupted anywhere, saved, read back and gone on with in other batches: the same bits.
    #[test]
    fn resumes_with_the_same_bits(
        method in 0..Method::NAMES.len(), finish: bool, which in 0..12usize, seed: u64,
        batch in 1..70usize, after in 1..40usize, costs in 1..1500u64,
    ) {
        let (plan, function) = (plan(method, finish), function(which));
        let limits = Limits { costs, derivatives: 200, ..Limits::default() };
        let mut whole = start(&plan, &function, seed);
        let expected = whole.advance(&function, &limits, &mut Silent).expect("derivatives");

        let cut = Limits { batch, ..limits };
        let mut run = start(&plan, &function, seed);
        let mut calls = 0;
        let stop = loop {
            let mut interrupt = |_: &_| {
                calls += 1;
                if calls % after == 0 { Control::Stop } else { Control::Continue }
            };
            match run.advance(&function, &cut, &mut interrupt).expect("derivatives") {
                Status::Interrupted => run = serde_json::from_str(&text(&run)).expect("just written"),
                stop => break stop,
            }
        };
        prop_assert_eq!(stop, expected);
        prop_assert_eq!(text(&run), text(&whole));
    }

    /// Points stay in the box, counts are those of the problem, and a budget is spent whole or not
    /// exceeded.
    #[test]
    fn counts_and_budgets(
        method in 0..Method::NAMES.len(), finish: bool, which in 0..12usize, seed: u64,
        costs in 0..2000u64, derivatives in 0..200u64,
    ) {
        let (plan, function) = (plan(method, finish), function(which));
        let mut run = start(&plan, &function, seed);
        let limits = Limits { costs, derivatives, ..Limits::default() };
        let stop = run.advance(&function, &limits, &mut Silent).expect("derivatives");
        let counts = run.counts();
        prop_assert!(function.inside.get());
        prop_assert_eq!(counts.costs + counts.derivatives, function.asked.get());
        prop_assert!(counts.costs <= costs && counts.derivatives <= derivatives);
        if stop == Status::Budget {
            prop_assert!(counts.costs == costs || counts.derivatives == derivatives);
        }
        if let Some(best) = run.best() {
            prop_assert_eq!(best.cost, function.cost(&best.point));
            let last = run.history().improvements().last().expect("there is a best");
            prop_assert_eq!(last.cost, best.cost);
            let own = run.own_best().expect("found before any finish");
            prop_assert!(best.cost <= own.cost);
            prop_assert!(run.own_counts().costs <= counts.costs);
        }
        for pair in run.history().improvements().windows(2) {
            prop_assert!(pair[1].cost < pair[0].cost && pair[1].evaluations > pair[0].evaluations);
        }
    }
}

/// A function with a coarse stand-in that is a little wrong.
struct Thinned(Function);

impl Problem for Thinned {
    fn bounds(&self) -> &Bounds {
        self.0.bounds()
    }

    fn costs(&self, points: &Points, fidelity: Fidelity, costs: &mut [f64]) {
        self.0.costs(points, fidelity, costs);
        if fidelity == Fidelity::Coarse {
            costs.iter_mut().for_each(|cost| *cost = 1.1 * *cost + 1e-6);
        }
    }

    fn derivatives(
        &self,
        points: &Points,
        fidelity: Fidelity,
        out: &mut [Derivatives],
    ) -> Result<(), CostsOnly> {
        self.0.derivatives(points, fidelity, out)
    }

    fn coarse_share(&self) -> f64 {
        0.125
    }
}

/// The best is one of the full record, and what is coarse counts its share of the budget.
#[test]
fn coarse_evaluations_count_their_share() {
    let problem = Thinned(common::rosenbrock(4));
    for costs in [0, 1, 7, 16, 17, 20, 10_000] {
        let search = plan(3, false).start(4, 5).expect("defaults");
        let mut run = Run::new(search, &problem);
        let limits = Limits {
            costs,
            ..Limits::default()
        };
        run.advance(&problem, &limits, &mut Silent)
            .expect("derivatives");
        let counts = run.counts();
        assert!(counts.of(Kind::Costs, 0.125) <= costs as f64);
        assert!(counts.coarse_costs <= 8 * costs);
        let Some(best) = run.best() else {
            assert_eq!(costs, 0);
            continue;
        };
        assert_eq!(best.cost, problem.0.cost(&best.point));
        assert!(best.cost < 1e-12, "{costs}: {}", best.cost);
    }
}

/// Part of the box has no finite cost.
struct Holes(Bounds);

impl Problem for Holes {
    fn bounds(&self) -> &Bounds {
        &self.0
    }

    fn costs(&self, points: &Points, _: Fidelity, costs: &mut [f64]) {
        for (x, cost) in points.rows().zip(costs) {
            *cost = match x {
                [a, _] if *a < 0.2 => f64::NAN,
                [_, b] if *b < 0.2 => f64::NEG_INFINITY,
                [a, b] if a + b > 1.6 => f64::INFINITY,
                [a, b] => (a - 0.3) * (a - 0.3) + (b - 0.4) * (b - 0.4),
                _ => f64::NAN,
            };
        }
    }
}

#[test]
fn what_is_not_finite_is_never_chosen() {
    let problem = Holes(Bounds::new(vec![0.0; 2], vec![1.0; 2]).expect("a box"));
    for name in Method::NAMES {
        let plan = Plan {
            finish: None,
            ..Plan::named(name).expect("listed")
        };
        let mut run = Run::new(plan.start(2, 1).expect("defaults"), &problem);
        let limits = Limits {
            costs: 3000,
            ..Limits::default()
        };
        let stop = run.advance(&problem, &limits, &mut Silent);
        if ["lm", "niched-ga"].contains(&name) {
            assert_eq!(stop, Err(Error::NoDerivatives));
            continue;
        }
        let best = run.best().expect("most of the box is finite");
        assert!(
            best.cost.is_finite() && best.cost < 1e-2,
            "{name}: {best:?}"
        );
    }
}

/// Nowhere a finite cost: every search comes to an end or uses its budget, and has no best.
#[test]
fn a_box_without_any_finite_cost() {
    struct Nothing(Bounds);
    impl Problem for Nothing {
        fn bounds(&self) -> &Bounds {
            &self.0
        }
        fn costs(&self, _: &Points, _: Fidelity, costs: &mut [f64]) {
            costs.fill(f64::NAN);
        }
    }
    let problem = Nothing(Bounds::new(vec![0.0; 3], vec![1.0; 3]).expect("a box"));
    for name in Method::NAMES {
        let plan = Plan::named(name).expect("listed");
        let mut run = Run::new(plan.start(3, 1).expect("defaults"), &problem);
        let limits = Limits {
            costs: 3000,
            ..Limits::default()
        };
        let stop = run.advance(&problem, &limits, &mut Silent);
        assert!(name == "lm" || stop.is_ok(), "{name}: {stop:?}");
        assert_eq!(run.best(), None, "{name}");
    }
}

/// One dimension without width, one dimension in all.
#[test]
fn degenerate_boxes() {
    for bounds in [
        Bounds::new(vec![-1.0], vec![2.0]),
        Bounds::new(vec![-1.0, 0.0], vec![2.0, 0.0]),
    ] {
        struct Square(Bounds);
        impl Problem for Square {
            fn bounds(&self) -> &Bounds {
                &self.0
            }
            fn costs(&self, points: &Points, _: Fidelity, costs: &mut [f64]) {
                for (x, cost) in points.rows().zip(costs) {
                    *cost = x.iter().map(|x| x * x).sum();
                }
            }
        }
        let problem = Square(bounds.expect("a box"));
        let n = problem.0.dimensions();
        for name in Method::NAMES
            .into_iter()
            .filter(|name| !["lm", "niched-ga"].contains(name))
        {
            let plan = Plan {
                finish: None,
                ..Plan::named(name).expect("listed")
            };
            let mut run = Run::new(plan.start(n, 1).expect("defaults"), &problem);
            let limits = Limits {
                costs: 4000,
                ..Limits::default()
            };
            run.advance(&problem, &limits, &mut Silent)
                .expect("costs only");
            assert!(run.best().expect("finite").cost < 1e-3, "{name}");
        }
    }
}

/// The same bits on every machine: what 400 evaluations found.
#[test]
fn bits() {
    let mut found = String::new();
    for name in Method::NAMES {
        let function = common::rosenbrock(3);
        let mut run = start(&Plan::named(name).expect("listed"), &function, 42);
        let limits = Limits {
            costs: 400,
            derivatives: 12,
            ..Limits::default()
        };
        run.advance(&function, &limits, &mut Silent)
            .expect("derivatives");
        let best = run.best().expect("finite");
        let point: Vec<String> = best
            .point
            .iter()
            .map(|x| format!("{:016x}", x.to_bits()))
            .collect();
        found += &format!(
            "{name:12} {} {:016x}\n",
            point.join(" "),
            best.cost.to_bits()
        );
    }
    insta::assert_snapshot!(found);
}
