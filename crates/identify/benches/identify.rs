//! Cost of an identification: six parameters of 30 001 samples with 1 % noise, and its parts.

#[path = "../tests/suite/common/mod.rs"]
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
        ..Terms::default()
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

/// The elasto-plastic bristle beside LuGre's: four stages a step where it is not elastic.
#[divan::bench(args = [false, true])]
fn elasto_plastic(bencher: Bencher, sensitivities: bool) {
    let record = noisy();
    let terms = terms();
    let law = Law::new(LawKind::ElastoPlastic);
    let objective = Objective::new(&record, law, &terms);
    let p = [P[0], P[1], P[2], 0.8];
    bencher
        .counter(ItemsCount::new(30_001_usize))
        .bench(|| objective.evaluate(&p, sensitivities).cost);
}

#[divan::bench]
fn search_alone(bencher: Bencher) {
    let record = noisy();
    let (law, terms) = (Law::new(LawKind::LuGre), terms());
    bencher.bench(|| {
        separable(&record, law, &terms, &Settings::default(), &mut Silent).expect("a fit")
    });
}

#[divan::bench]
fn whole_identification(bencher: Bencher) {
    let record = noisy();
    let (law, terms) = (Law::new(LawKind::LuGre), terms());
    bencher.bench(|| {
        let found =
            separable(&record, law, &terms, &Settings::default(), &mut Silent).expect("a fit");
        let mut estimate = estimate(&record, law, &terms, &found, 0.0);
        intervals(&record, &found, &mut estimate, &mut Silent);
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
        intervals(&record, &found, &mut estimate, &mut Silent);
        estimate
    });
}

/// 28 points, everything of the static map with its intervals: to stay below 10 ms.
#[divan::bench(args = [false, true])]
fn static_map(bencher: Bencher, asymmetric: bool) {
    use stiction_identify::procedure::{StaticPoint, StaticSettings, static_map};
    let mut noise = Noise::new(2);
    let law = MACHINE.law();
    let points: Vec<StaticPoint> = (0..14)
        .map(|i| 5e-4 * 1000_f64.powf(f64::from(i) / 13.0))
        .flat_map(|v| [v, -v])
        .map(|velocity| StaticPoint {
            log: 0,
            time: (0.0, 1.0),
            position: 0.0,
            velocity,
            force: law.curve().force(velocity) + 0.2 * noise.normal(),
            error: 0.2,
            samples: 1000,
            effective: 1000.0,
            dropped: 0.0,
            pitches: 0,
        })
        .collect();
    let settings = StaticSettings {
        asymmetric,
        offset: !asymmetric,
        ..StaticSettings::default()
    };
    bencher.bench(|| static_map(&points, &settings).expect("a map"));
}
