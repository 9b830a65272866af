//! Cost of the Maxwell-slip ladder: 3 to 10 elements on 40 000 samples, fitted and held out in blocks.

#[path = "../tests/suite/common/mod.rs"]
mod common;

use common::maxwell::{four, motion};
use common::{Noise, record};
use divan::Bencher;
use divan::counter::ItemsCount;
use stiction_identify::{Law, LawKind, Objective, Record, Settings, Silent, Terms, separable};

fn main() {
    divan::main();
}

const SAMPLES: usize = 40_000;

fn noisy() -> Record {
    let (v, clean) = four().along(SAMPLES, 5e-4, 20, motion);
    let mut noise = Noise::new(1);
    let u = clean.iter().map(|f| f + 0.15 * noise.normal()).collect();
    record(5e-4, v, u)
}

/// Ten elements with their sensitivities, once along the record.
#[divan::bench]
fn ten_elements_with_sensitivities(bencher: Bencher) {
    let record = noisy();
    let law = Law {
        elements: 10,
        ..Law::new(LawKind::Gms)
    };
    let mut p = vec![-0.7, -6.2, 4.6];
    p.extend((0..10).map(|k| -13.5 + 0.35 * f64::from(k)));
    let objective = Objective::new(&record, law, &Terms::default());
    bencher
        .counter(ItemsCount::new(SAMPLES))
        .bench(|| objective.evaluate(&p, true).cost);
}

/// The whole ladder: the number of elements is left to the data.
#[divan::bench(sample_count = 3, sample_size = 1)]
fn ladder(bencher: Bencher) {
    let record = noisy();
    let (law, terms) = (Law::new(LawKind::Gms), Terms::default());
    bencher.bench(|| {
        separable(&record, law, &terms, &Settings::default(), &mut Silent).expect("a fit")
    });
}
