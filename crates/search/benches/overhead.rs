//! What a search itself costs, per evaluation: a problem whose cost is a few nanoseconds.

use divan::Bencher;
use divan::counter::ItemsCount;
use stiction_search::{
    Bounds, CostsOnly, Derivatives, Fidelity, Limits, Method, Plan, Points, Problem, Run, Silent,
};

fn main() {
    divan::main();
}

/// `sum (x_i - 1)^2` with derivatives.
struct Sphere(Bounds);

impl Problem for Sphere {
    fn bounds(&self) -> &Bounds {
        &self.0
    }

    fn costs(&self, points: &Points, _: Fidelity, costs: &mut [f64]) {
        for (x, cost) in points.rows().zip(costs) {
            *cost = x.iter().map(|x| (x - 1.0) * (x - 1.0)).sum();
        }
    }

    fn derivatives(
        &self,
        points: &Points,
        _: Fidelity,
        out: &mut [Derivatives],
    ) -> Result<(), CostsOnly> {
        for (x, d) in points.rows().zip(out) {
            for (i, x) in x.iter().enumerate() {
                d.cost += (x - 1.0) * (x - 1.0);
                d.gradient[i] = x - 1.0;
                // Falsely small, so that the descent takes many steps.
                d.normal[i * 7] = 30.0;
            }
        }
        Ok(())
    }
}

/// 5000 evaluations in six dimensions; the time of one is the inverse of the items per second.
#[divan::bench(args = Method::NAMES)]
fn evaluations(bencher: Bencher, name: &str) {
    let problem = Sphere(Bounds::new(vec![-3.0; 6], vec![4.0; 6]).expect("a box"));
    let start = || {
        let plan = Plan {
            finish: None,
            ..Plan::named(name).expect("listed")
        };
        Run::new(plan.start(6, 1).expect("defaults"), &problem)
    };
    let limits = Limits {
        costs: 5000,
        derivatives: 5000,
        ..Limits::default()
    };
    let go = |mut run: Run<_>| {
        let stop = run.advance(&problem, &limits, &mut Silent);
        (run.counts(), stop)
    };
    let (counts, _) = go(start());
    bencher
        .counter(ItemsCount::new(counts.costs + counts.derivatives))
        .with_inputs(start)
        .bench_values(go);
}
