//! How many seeds of each method find the minimum of standard functions, and with how many
//! evaluations: a method that grows more expensive shows here.

use crate::common;
use crate::common::Function;
use stiction_search::{Limits, Method, Plan, Run, Silent, Status};

const SEEDS: u64 = 10;

/// Evaluations until the target of the seeds that reach it, and the median cost of the method's own
/// best.
fn measure(name: &str, function: &Function) -> (Vec<u64>, f64) {
    let (mut used, mut own) = (Vec::new(), Vec::new());
    for seed in 0..SEEDS {
        let search = Plan::named(name).expect("listed").start(6, seed);
        let mut run = Run::new(search.expect("defaults"), function);
        let limits = Limits {
            costs: 20_000,
            derivatives: 20_000,
            target: Some(1e-8),
            ..Limits::default()
        };
        let stop = run.advance(function, &limits, &mut Silent);
        if stop == Ok(Status::Target) {
            used.push(run.counts().costs + run.counts().derivatives);
        }
        own.push(run.own_best().expect("finite costs").cost);
    }
    used.sort_unstable();
    own.sort_by(f64::total_cmp);
    (used, own[own.len() / 2])
}

#[test]
fn hits_and_evaluations() {
    let mut table = format!(
        "six dimensions, cost <= 1e-8 within 20000 evaluations, {SEEDS} seeds\n{:12}  {:10}  hits  median  own best\n",
        "method", "function"
    );
    for name in Method::NAMES {
        for function in common::all(6) {
            let (used, own) = measure(name, &function);
            let median = match used.get(used.len() / 2) {
                Some(median) => median.to_string(),
                None => String::from("-"),
            };
            let function = function.name;
            table += &format!(
                "{name:12}  {function:10}  {:4}  {median:>6}  {own:8.1e}\n",
                used.len()
            );
        }
    }
    insta::assert_snapshot!(table);
}
