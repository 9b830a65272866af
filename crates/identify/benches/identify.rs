//! Cost of an identification: six parameters of 30 001 samples with 1 % noise, and its parts.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{MACHINE, Noise, record, sine_record};
use divan::Bencher;
use divan::counter::ItemsCount;
use stiction_identify::{
    Law, LawKind, Mass, Objective, Record, Settings, Silent, Terms, estimate, intervals, separable,
};

fn main() {
    divan::main();
}

fn noisy() -> Record {
    let (v, clean) = sine_record(&MACHINE);
    let mut noise = Noise::new(1);
    let u = clean.iter().map(|f| f + 0.2 * noise.normal()).collect();
    record(1e-4, v, u)
}

fn terms() -> Terms {
    Terms {
        mass: Mass::Absent,
        offset: false,
        gravity: false,
        cogging: Vec::new(),
    }
}

const P: [f64; 3] = [8.7, -0.69, -5.3];

#[divan::bench]
fn cost_only(bencher: Bencher) {
    let record = noisy();
    let terms = terms();
    let objective = Objective::new(&record, Law::new(LawKind::LuGre), &terms);
    bencher
        .counter(ItemsCount::new(30_001_usize))
        .bench(|| objective.evaluate(&P, false).cost);
}

#[divan::bench]
fn cost_and_sensitivities(bencher: Bencher) {
    let record = noisy();
    let terms = terms();
    let objective = Objective::new(&record, Law::new(LawKind::LuGre), &terms);
    bencher
        .counter(ItemsCount::new(30_001_usize))
        .bench(|| objective.evaluate(&P, true).cost);
}

#[divan::bench]
fn whole_identification(bencher: Bencher) {
    let record = noisy();
    let (law, terms) = (Law::new(LawKind::LuGre), terms());
    bencher.bench(|| {
        let found =
            separable(&record, law, &terms, &Settings::default(), &mut Silent).expect("a fit");
        let mut estimate = estimate(&record, law, &terms, &found, 0.0);
        intervals(&record, &found, &mut estimate);
        estimate
    });
}

/// The intervals alone: covariance, and profiles where they are wanted.
#[divan::bench]
fn intervals_alone(bencher: Bencher) {
    let record = noisy();
    let (law, terms) = (Law::new(LawKind::LuGre), terms());
    let found = separable(&record, law, &terms, &Settings::default(), &mut Silent).expect("a fit");
    bencher.bench(|| {
        let mut estimate = estimate(&record, law, &terms, &found, 0.0);
        intervals(&record, &found, &mut estimate);
        estimate
    });
}
