//! Cost of the filters per sample: `cargo bench -p stiction-signal`.
//!
//! The throughput column counts samples times columns; identification filters about ten columns of
//! a record at once.

use divan::{Bencher, counter::ItemsCount};
use stiction_signal::{SavitzkyGolay, Sos, gradient};

const SAMPLES: usize = 30_000;

fn main() {
    divan::main();
}

/// A sine with a deterministic wobble.
fn signal() -> Vec<f64> {
    (0..SAMPLES)
        .map(|k| (0.01 * k as f64).sin() + 1e-3 * ((k * 7919) % 101) as f64)
        .collect()
}

#[divan::bench(args = [2, 4, 8])]
fn causal(bencher: Bencher, order: usize) {
    let filter = Sos::butterworth_low_pass(order, 0.1, 2.0).unwrap();
    let bencher = bencher
        .with_inputs(signal)
        .counter(ItemsCount::new(SAMPLES));
    bencher.bench_local_refs(|signal| filter.filter(signal));
}

#[divan::bench(args = [2, 4, 8])]
fn zero_phase_one_column(bencher: Bencher, order: usize) {
    let filter = Sos::butterworth_low_pass(order, 0.1, 2.0).unwrap();
    let bencher = bencher
        .with_inputs(signal)
        .counter(ItemsCount::new(SAMPLES));
    bencher.bench_local_refs(|signal| filter.zero_phase_in_place(signal).unwrap());
}

#[divan::bench(args = [2, 4, 8])]
fn zero_phase_eight_columns(bencher: Bencher, order: usize) {
    let filter = Sos::butterworth_low_pass(order, 0.1, 2.0).unwrap();
    let bencher = bencher
        .with_inputs(|| core::array::from_fn::<_, 8, _>(|_| signal()))
        .counter(ItemsCount::new(8 * SAMPLES));
    bencher.bench_local_refs(|columns| {
        let mut columns = columns.each_mut().map(Vec::as_mut_slice);
        filter.zero_phase_columns(&mut columns).unwrap();
    });
}

#[divan::bench(args = [11, 41])]
fn savitzky_golay(bencher: Bencher, window: usize) {
    let (filter, signal) = (SavitzkyGolay::new(window, 3, 1).unwrap(), signal());
    let bencher = bencher.counter(ItemsCount::new(SAMPLES));
    bencher.bench_local(|| filter.apply(&signal, 1e-3).unwrap());
}

#[divan::bench]
fn central_differences(bencher: Bencher) {
    let signal = signal();
    let bencher = bencher.counter(ItemsCount::new(SAMPLES));
    bencher.bench_local(|| gradient(&signal, 1e-3).unwrap());
}
