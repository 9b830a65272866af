//! Methods on one identification problem: six LuGre parameters from 30 001 samples with 1 % noise.
//!
//! ```text
//! cargo run --release -p stiction-search --example lugre -- [SEEDS] [DECADES] [METHOD..]
//! ```
//!
//! A hit is a cost within 1e-4 (relative) of the global least-squares optimum; evaluations are those
//! of the full record, a coarse one counting its share, with derivatives or without.

mod axis;
mod kernel;
mod record;

use axis::Axis;
use std::time::Instant;
use stiction_search::{Finished, Limits, Method, Plan, Problem, Run, Searcher, Silent};

/// The coarse record keeps one sample in so many.
const EVERY: usize = 8;
/// What a method may use.
const LIMITS: Limits = Limits {
    costs: 20_000,
    derivatives: 2_000,
    target: None,
    batch: 1024,
};

fn run(name: &str, seed: u64, axis: &Axis) -> Run<Finished<Searcher>> {
    let plan = Plan::named(name).expect("a method");
    let mut run = Run::new(plan.start(6, seed).expect("defaults"), axis);
    run.advance(axis, &LIMITS, &mut Silent)
        .expect("derivatives");
    run
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// One line: hits with and without the least squares after it, and what was used.
fn measure(name: &str, seeds: u64, axis: &Axis, least: f64) {
    let (mut hits, mut own_hits) = (0, 0);
    let mut used = [const { Vec::new() }; 4];
    for seed in 0..seeds {
        axis.spent.set(Default::default());
        let since = Instant::now();
        let run = run(name, seed, axis);
        let seconds = since.elapsed().as_secs_f64();
        let hit = |cost: f64| u32::from(cost <= least * (1.0 + 1e-4));
        hits += run.best().map_or(0, |b| hit(b.cost));
        own_hits += run.own_best().map_or(0, |b| hit(b.cost));
        let [costs, derivatives] = axis.spent.get().map(|d| d.as_secs_f64());
        let evaluations = run.counts().full_records(axis.coarse_share());
        for (all, one) in used
            .iter_mut()
            .zip([evaluations, seconds, costs, derivatives])
        {
            all.push(one);
        }
    }
    let [evaluations, seconds, costs, derivatives] = used.each_mut().map(|x| median(x));
    let most = used[0][used[0].len() - 1];
    println!(
        "  {name:12}  hits {hits:3}, before the finish {own_hits:3}, of {seeds}; evaluations {evaluations:.0}, at most \
         {most:.0}; {seconds:.3} s, of which costs {costs:.3}, derivatives {derivatives:.3}"
    );
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let seeds = arguments
        .next()
        .map_or(10, |s| s.parse().expect("a number of seeds"));
    let decades = arguments
        .next()
        .map_or(1.0, |s| s.parse().expect("a number of decades"));
    let mut names: Vec<String> = arguments.collect();
    if names.is_empty() {
        names = Method::NAMES.map(String::from).to_vec();
    }
    for (set, (title, _)) in record::SETS.iter().enumerate() {
        let near = Axis::near(set);
        let least = run("lm", 1, &near).best().expect("finite").cost;
        let axis = Axis::new(set, decades, EVERY);
        let share = axis.coarse_share();
        println!("{title}, +-{decades} decades: optimum {least:.6e} N^2, coarse record {share:.3}");
        for name in &names {
            measure(name, seeds, &axis, least);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use record::Record;

    /// The kernel against the friction crate on the same samples.
    #[test]
    fn kernel_is_the_law() {
        for (_, p) in record::SETS {
            let exact = record::forces(&p, 1);
            let mut cost = [0.0];
            kernel::costs(&Record::new(&exact, 1), &[p], &mut cost);
            let energy = exact.iter().map(|f| f * f).sum::<f64>() / exact.len() as f64;
            assert!(cost[0] < 1e-24 * energy, "{} {energy}", cost[0]);
        }
    }

    /// The whole study is the example itself: 100 seeds each.
    #[test]
    fn niched_ga_finds_the_optimum_in_four_decades() {
        for set in 0..2 {
            let least = run("lm", 1, &Axis::near(set)).best().expect("finite").cost;
            let axis = Axis::new(set, 2.0, EVERY);
            for seed in 0..4 {
                let run = run("niched-ga", seed, &axis);
                let best = run.best().expect("finite").cost;
                assert!(
                    best <= least * (1.0 + 1e-4),
                    "{set} {seed}: {}",
                    best / least
                );
                assert!(run.counts().full_records(axis.coarse_share()) < 150.0);
            }
        }
    }

    /// Twice the gradient against central differences of the cost.
    #[test]
    fn gradient_is_the_slope_of_the_cost() {
        for (_, p) in record::SETS {
            let record = Record::new(&record::measured(&p, 1), 20);
            let at = p.map(|x| 1.1 * x);
            let (_, gradient, _) = kernel::derivatives(&record, &at);
            for i in 0..6 {
                let cost = |d: f64| {
                    let mut q = at;
                    q[i] *= d.exp();
                    let mut cost = [0.0];
                    kernel::costs(&record, &[q], &mut cost);
                    cost[0]
                };
                let slope = (cost(1e-5) - cost(-1e-5)) / 2e-5;
                let scale = 1e-6 * cost(0.0);
                assert!((2.0 * gradient[i] - slope).abs() < scale, "{i} {slope}");
            }
        }
    }
}
