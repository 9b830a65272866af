//! How often the 95 % intervals hold the truth, parameter by parameter, for three kinds of noise.
//!
//! `cargo run --release -p stiction-identify --example coverage -- [runs] [first run] [noise]`, with
//! noise one of `white`, `ar`, `quantised`, `50nm`, `100nm`; all of them if none is named. A binomial count of 200
//! runs at 95 % has a deviation of 1.5 %. In `quantised` (encoder counts of 1 um, .05 N on the force)
//! the position leaves a residual of .56 N, the noise of the force one of .02 N; the finer encoders
//! come with 1 N on the force, as the demo.

#[path = "../../tests/suite/common/mod.rs"]
mod common;
mod rivals;

use common::trials::{Tally, Trial, autoregressive, coverage, quantised};
use stiction_identify::{Conditioning, Cutoff};

/// Makes the record of one run.
type Make = Box<dyn Fn(u64) -> Trial>;

fn main() {
    let (mut numbers, mut wanted) = (Vec::new(), Vec::<String>::new());
    for argument in std::env::args().skip(1) {
        match argument.parse::<u64>() {
            Ok(n) => numbers.push(n),
            Err(_) => wanted.push(argument),
        }
    }
    let first = numbers.get(1).copied().unwrap_or(0);
    let runs = first..first + numbers.first().copied().unwrap_or(200);
    // Stated here, so that the figures do not move with the defaults of the conditioning.
    let filters = Conditioning {
        source_cutoff: Cutoff::Hz(400.0),
        common_cutoff: Cutoff::Hz(200.0),
        ..Conditioning::default()
    };
    let log = |count: f64, force: f64| move |run| quantised(count, force, &filters, run);
    let kinds: [(&str, Make); 5] = [
        ("white", Box::new(|run| autoregressive(0.0, run))),
        ("ar", Box::new(|run| autoregressive(0.9, run))),
        ("quantised", Box::new(log(1e-6, 0.05))),
        ("50nm", Box::new(log(50e-9, 1.0))),
        ("100nm", Box::new(log(100e-9, 1.0))),
    ];
    for (name, trial) in kinds {
        if wanted.is_empty() || wanted.iter().any(|w| w == name) {
            println!("{name}, runs {} to {}", runs.start, runs.end - 1);
            table(&coverage(runs.clone(), &trial));
            rivals::table(runs.clone(), &trial);
        }
    }
}

fn table(tallies: &[Tally]) {
    println!(
        "  {:18} {:>12} {:>9} {:>9} {:>9} {:>9}",
        "", "identifiable", "hold", "bias %", "spread %", "stated %"
    );
    for t in tallies {
        let size = if t.truth == 0.0 { 1.0 } else { t.truth };
        let n = t.values.len() as f64;
        let mean = t.values.iter().sum::<f64>() / n;
        let spread = (t.values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n).sqrt();
        let stated = t.deviations.iter().sum::<f64>() / t.deviations.len() as f64;
        println!(
            "  {:18} {:12} {:7.1} % {:9.3} {:9.3} {:9.3}",
            t.name,
            t.identifiable,
            100.0 * t.coverage(),
            100.0 * (mean - t.truth) / size,
            100.0 * spread / size,
            100.0 * stated / size
        );
    }
}
