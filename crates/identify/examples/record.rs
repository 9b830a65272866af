//! Identifies a record and says how long it took, for `bench/peers/identify.py`: `record FILE ROUNDS`.
//!
//! FILE holds little-endian f64, velocity and force of each sample in turn, at 10 kHz. Prints for each part
//! the least time in ms and, where the kernel tells it, the mean processor time; the least time of a batch on
//! one and on two threads, and of its two halves on two threads that share nothing, which is what the machine
//! gives; what the search counted, and the parameters.

use rayon::prelude::*;
use std::hint::black_box;
use std::time::Instant;
use stiction_identify::{
    Conditioning, Cutoff, Estimate, Law, LawKind, Mass, Optimum, Record, Samples, Settings, Silent,
    Terms, condition, estimate, intervals, separable,
};

/// As in the program.
#[global_allocator]
static MEMORY: mimalloc::MiMalloc = mimalloc::MiMalloc;

const STEP: f64 = 1e-4;
const NAMES: [&str; 6] = [
    "sigma0",
    "sigma1",
    "sigma2",
    "coulomb",
    "static",
    "stribeck_velocity",
];
/// Identifications of a batch.
const BATCH: usize = 16;

fn read(path: &str) -> Record {
    let bytes = std::fs::read(path).expect("a file to read");
    let numbers = bytes.as_chunks::<8>().0.iter();
    let numbers: Vec<f64> = numbers.map(|b| f64::from_le_bytes(*b)).collect();
    let pairs = numbers.as_chunks::<2>().0.iter();
    let (velocity, force): (Vec<f64>, Vec<f64>) = pairs.map(|s| (s[0], s[1])).unzip();
    let samples = Samples {
        time: (0..velocity.len()).map(|i| i as f64 * STEP).collect(),
        velocity: Some(velocity),
        force,
        ..Samples::default()
    };
    let raw = Conditioning {
        source_cutoff: Cutoff::Off,
        common_cutoff: Cutoff::Off,
        ..Conditioning::default()
    };
    condition(&[samples], &raw).expect("a record")
}

/// Time that this thread has had a processor, s; good over many ticks of the scheduler only.
fn busy() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
    Some(1e-9 * nanoseconds)
}

/// Prints least time and mean processor time of a piece of work, ms.
fn timed(name: &str, rounds: usize, work: &mut dyn FnMut()) {
    let mut least = f64::INFINITY;
    let before = busy();
    for _ in 0..rounds {
        let start = Instant::now();
        work();
        least = least.min(1e3 * start.elapsed().as_secs_f64());
    }
    println!("{name} {least:.4}");
    if let (Some(before), Some(after)) = (before, busy()) {
        println!("{name}-busy {:.4}", 1e3 * (after - before) / rounds as f64);
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, rounds] = &arguments[..] else {
        eprintln!("usage: record FILE ROUNDS");
        std::process::exit(2);
    };
    let record = read(file);
    let rounds: usize = rounds.parse().expect("a number of rounds");
    let law = Law::new(LawKind::LuGre);
    let terms = Terms {
        mass: Mass::Absent,
        offset: false,
        ..Terms::default()
    };
    let searched = |record: &Record| -> Optimum {
        separable(record, law, &terms, &Settings::default(), &mut Silent).expect("a fit")
    };
    let search = || searched(&record);
    let estimated = |found: &Optimum| -> Estimate { estimate(&record, law, &terms, found, 0.0) };
    let pool = |threads| {
        let builder = rayon::ThreadPoolBuilder::new().num_threads(threads);
        builder.build().expect("threads")
    };
    let (one, two) = (pool(1), pool(2));
    let batch = || {
        (0..BATCH).into_par_iter().for_each(|_| {
            black_box(estimated(&search()));
        });
    };
    let halves = [pool(1), pool(1)].map(|pool| (pool, record.clone()));
    let apart = || {
        std::thread::scope(|scope| {
            for (pool, record) in &halves {
                let half = || {
                    for _ in 0..BATCH / 2 {
                        black_box(estimate(record, law, &terms, &searched(record), 0.0));
                    }
                };
                scope.spawn(move || pool.install(half));
            }
        });
    };
    let found = search();
    let result = estimated(&found);
    one.install(|| {
        timed("search", rounds, &mut || drop(black_box(search())));
        timed("estimate", rounds, &mut || {
            drop(black_box(estimated(&found)))
        });
        timed("intervals", rounds, &mut || {
            intervals(&record, &found, &mut result.clone(), &mut Silent);
        });
    });
    let few = rounds.div_ceil(BATCH);
    timed("batch-1", few, &mut || one.install(batch));
    timed("batch-2", few, &mut || two.install(batch));
    timed("apart-2", few, &mut || apart());
    println!("evaluations {}", found.counts.total());
    println!("thinned {}", found.counts.coarse());
    println!("cost {:e}", found.evaluation.cost);
    for name in NAMES {
        let value = result.value(name).expect("a parameter");
        println!("{name} {value:e}");
    }
}
