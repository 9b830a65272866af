//! How long the pyramid of a channel takes to build, and how long a screen of any part of it.

use divan::Bencher;
use divan::counter::ItemsCount;
use std::hint::black_box;
use stiction_studio::pyramid::{Pyramid, Tiles};

fn main() {
    divan::main();
}

/// A channel that goes to and fro with some ripple.
fn channel(samples: usize) -> Vec<f64> {
    (0..samples)
        .map(|k| ((k % 10_007) as f64 - 5003.0) + (k % 13) as f64)
        .collect()
}

#[divan::bench(args = [1_000_000, 6_000_000, 100_000_000], sample_count = 5, sample_size = 1)]
fn build(bencher: Bencher, samples: usize) {
    let values = channel(samples);
    bencher
        .counter(ItemsCount::new(samples))
        .bench_local(|| Pyramid::new(black_box(&values)));
}

#[divan::bench(args = [1, 10, 1000, 100_000])]
fn screen(bencher: Bencher, zoom: usize) {
    let values = channel(6_000_000);
    let pyramid = Pyramid::new(&values);
    let part = values.len() / zoom;
    let start = (values.len() - part) / 3;
    bencher.bench_local(|| {
        let tiles = Tiles::of(start..start + part, 1500);
        let spans = tiles.ranges().map(|range| pyramid.span(&values, range));
        spans.fold(0.0, |sum, (low, high)| sum + high - low)
    });
}
