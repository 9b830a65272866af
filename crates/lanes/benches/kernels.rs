//! Cost of one candidate along one record of 30 001 samples: divan's items are candidate-steps.

use divan::Bencher;
use divan::counter::ItemsCount;
use stiction_lanes::{
    Axis, Candidate, Drive, InstructionSet, Measured, Motion, Scheme, Segment, Stepping, Time,
    Track, Trial, costs, plants, sums, sums_alone,
};

fn main() {
    // One thread, so that the figure is that of a core.
    let one = rayon::ThreadPoolBuilder::new().num_threads(1);
    one.use_current_thread().build_global().unwrap();
    divan::main();
}

const SAMPLES: usize = 30_001;

/// 3 s at 10 kHz, three strokes of 50 mm/s at most.
fn track() -> Track {
    let w = 2.0 * std::f64::consts::PI * 1e-4;
    let velocity: Vec<f64> = (0..SAMPLES)
        .map(|k| 0.05 * libm::sin(w * k as f64))
        .collect();
    let force: Vec<f64> = velocity
        .iter()
        .map(|v| 20.0 * v.signum() + 60.0 * v)
        .collect();
    Track::new(&[Segment {
        time: Time::Step(1e-4),
        velocity: &velocity,
        force: &force,
        keep: &[],
        columns: &[],
    }])
    .unwrap()
}

fn candidates(count: usize) -> Vec<Candidate> {
    (0..count)
        .map(|i| {
            let f = 1.0 + 0.01 * i as f64;
            Candidate::gaussian([1.2e5 * f, 600.0, 60.0, 20.0, 20.0 + 10.0 * f, 5e-3 * f])
        })
        .collect()
}

#[divan::bench(args = [1, 8, 16, 64, 1024], sample_count = 20)]
fn cost(bencher: Bencher, count: usize) {
    let (track, candidates) = (track(), candidates(count));
    bencher
        .counter(ItemsCount::new(count * SAMPLES))
        .bench_local(|| costs(&track, &candidates, Scheme::Explin, InstructionSet::best()));
}

#[divan::bench(sample_count = 10)]
fn cost_any_exponent(bencher: Bencher) {
    let track = track();
    let mut candidates = candidates(64);
    candidates.iter_mut().for_each(|c| c.exponent = 1.3);
    bencher
        .counter(ItemsCount::new(64 * SAMPLES))
        .bench_local(|| costs(&track, &candidates, Scheme::Explin, InstructionSet::best()));
}

#[divan::bench(args = ["avx512", "avx2", "baseline"], sample_count = 3)]
fn cost_by_instruction_set(bencher: Bencher, name: &str) {
    let Some(set) = InstructionSet::all().into_iter().find(|s| s.name() == name) else {
        return;
    };
    let (track, candidates) = (track(), candidates(16));
    bencher
        .counter(ItemsCount::new(16 * SAMPLES))
        .bench_local(|| costs(&track, &candidates, Scheme::Explin, set));
}

fn trials(count: usize) -> Vec<Trial> {
    (0..count)
        .map(|i| Trial {
            ln_kappa: libm::log(6e3) + 0.01 * i as f64,
            ln_excess: libm::log(0.5),
            ln_velocity: libm::log(5e-3),
            exponent: 2.0,
        })
        .collect()
}

/// What a Gauss-Newton step of eight trials needs.
#[divan::bench(args = [8, 64], sample_count = 20)]
fn normal(bencher: Bencher, count: usize) {
    let (track, trials) = (track(), trials(count));
    bencher
        .counter(ItemsCount::new(count * SAMPLES))
        .bench_local(|| sums(&track, &trials, InstructionSet::best()));
}

/// What a Gauss-Newton step of one trial needs.
#[divan::bench(sample_count = 20)]
fn normal_alone(bencher: Bencher) {
    let (track, trial) = (track(), trials(1)[0]);
    bencher
        .counter(ItemsCount::new(SAMPLES))
        .bench_local(|| sums_alone(&track, &trial, InstructionSet::best()));
}

#[divan::bench(args = [16, 64], sample_count = 10)]
fn midpoint(bencher: Bencher, count: usize) {
    driven(bencher, count, Stepping::Midpoint);
}

#[divan::bench(args = [16, 64], sample_count = 300)]
fn semi_implicit(bencher: Bencher, count: usize) {
    driven(bencher, count, Stepping::SemiImplicit);
}

/// A mass of 4 kg under a sine of 60 N.
fn driven(bencher: Bencher, count: usize, stepping: Stepping) {
    let w = 2.0 * std::f64::consts::PI * 1e-4;
    let force: Vec<f64> = (0..SAMPLES)
        .map(|k| 60.0 * libm::sin(w * k as f64))
        .collect();
    let axes: Vec<Axis> = candidates(count)
        .into_iter()
        .map(|friction| Axis {
            mass: 4.0,
            friction,
        })
        .collect();
    let drive = Drive {
        step: 1e-4,
        force: &force,
        start: Motion::default(),
        measured: Measured::Position(&force),
    };
    bencher
        .counter(ItemsCount::new(count * SAMPLES))
        .bench_local(|| plants(&drive, &axes, stepping, InstructionSet::best()));
}
