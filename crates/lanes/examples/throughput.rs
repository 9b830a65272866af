//! Times the kernels on a record, for `bench/lanes/compare.py`: `throughput RECORD CANDIDATES ROUNDS`.
//!
//! RECORD holds little-endian f64, velocity and force of each sample in turn, at 10 kHz; CANDIDATES six
//! parameters each. Prints one line a kernel, name and least ns per candidate-step, on one thread; `pair`
//! uses two, and `apart` two that share nothing, each with half of the candidates: what the machine gives.

use std::hint::black_box;
use std::time::Instant;
use stiction_lanes::{
    Axis, Candidate, Drive, InstructionSet, Measured, Motion, Scheme, Segment, Stepping, Time,
    Track, Trial, costs, plants, sums, sums_alone,
};
use stiction_servo::plant;

const STEP: f64 = 1e-4;

fn read(path: &str) -> Vec<f64> {
    let bytes = std::fs::read(path).expect("a file to read");
    let numbers = bytes.as_chunks::<8>().0.iter();
    numbers.map(|b| f64::from_le_bytes(*b)).collect()
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [record, candidates, rounds] = &arguments[..] else {
        eprintln!("usage: throughput RECORD CANDIDATES ROUNDS");
        std::process::exit(2);
    };
    let record = read(record);
    let (velocity, force): (Vec<f64>, Vec<f64>) = record
        .as_chunks::<2>()
        .0
        .iter()
        .map(|s| (s[0], s[1]))
        .unzip();
    let candidates: Vec<Candidate> = read(candidates)
        .as_chunks::<6>()
        .0
        .iter()
        .map(|c| Candidate::gaussian(*c))
        .collect();
    let rounds: usize = rounds.parse().expect("a number of rounds");
    let set = InstructionSet::best();
    let track = Track::new(&[Segment {
        time: Time::Step(STEP),
        velocity: &velocity,
        force: &force,
        keep: &[],
        columns: &[],
    }])
    .expect("a record");
    let trials: Vec<Trial> = candidates
        .iter()
        .map(|c| Trial {
            ln_kappa: (c.stiffness / c.coulomb).ln(),
            ln_excess: (c.static_friction / c.coulomb - 1.0).ln(),
            ln_velocity: c.stribeck_velocity.ln(),
            exponent: 2.0,
        })
        .collect();
    let axes: Vec<Axis> = candidates
        .iter()
        .map(|&friction| Axis {
            mass: 4.0,
            friction,
        })
        .collect();
    let drive = Drive {
        step: STEP,
        force: &force,
        start: Motion::default(),
        measured: Measured::Velocity(&velocity),
    };
    let pool = |threads| {
        let builder = rayon::ThreadPoolBuilder::new().num_threads(threads);
        builder.build().expect("threads")
    };
    let (one, two) = (pool(1), pool(2));
    let cost = |count: usize, set| costs(&track, &candidates[..count], Scheme::Explin, set).ok();
    let time = |name: &str, count: usize, pool: &rayon::ThreadPool, run: &(dyn Fn() + Sync)| {
        let mut least = f64::INFINITY;
        for _ in 0..rounds {
            let start = Instant::now();
            pool.install(run);
            least = least.min(start.elapsed().as_secs_f64());
        }
        let steps = (count * velocity.len()) as f64;
        println!("{name} {:.4}", least * 1e9 / steps);
    };
    // The scalar law and plant, one candidate.
    let scalar_cost = || {
        let law = candidates[0].law().expect("a law");
        let (mut z, mut cost) = (0.0, 0.0);
        for (v, u) in velocity.windows(2).zip(&force[1..]) {
            z = law.step_record(z, STEP, v[0], v[1]);
            let e = u - law.force(z, v[1]);
            cost += e * e;
        }
        black_box(cost);
    };
    let scalar_plant = || {
        let law = axes[0].friction.law().expect("a law");
        let plant = plant::Plant::new(axes[0].mass, law).expect("a plant");
        let mut motion = plant::Motion::default();
        for &u in &force {
            motion = plant.step(motion, STEP, plant::Load::force(u)).motion;
        }
        black_box(motion);
    };
    let all = candidates.len();
    let halves = [pool(1), pool(1)].map(|pool| (pool, track.clone()));
    let apart = || {
        std::thread::scope(|scope| {
            let parts = candidates.chunks(all.div_ceil(2).max(1));
            for ((pool, track), part) in halves.iter().zip(parts) {
                let half = move || drop(black_box(costs(track, part, Scheme::Explin, set)));
                scope.spawn(move || pool.install(half));
            }
        });
    };
    println!(
        "# {set}, {} nodes for {} samples",
        track.nodes(),
        track.samples()
    );
    time("scalar-cost", 1, &one, &scalar_cost);
    time("scalar-plant", 1, &one, &scalar_plant);
    time("cost", all, &one, &|| drop(black_box(cost(all, set))));
    time("cost-pair", all, &two, &|| drop(black_box(cost(all, set))));
    time("cost-apart", all, &one, &apart);
    time("cost-8", 8, &one, &|| drop(black_box(cost(8, set))));
    time("cost-alone", 1, &one, &|| drop(black_box(cost(1, set))));
    for set in InstructionSet::all() {
        let name = format!("cost-16-{set}");
        time(&name, 16, &one, &|| drop(black_box(cost(16, set))));
    }
    time("sums-8", 8, &one, &|| {
        drop(black_box(sums(&track, &trials[..8], set)))
    });
    time("sums-alone", 1, &one, &|| {
        drop(black_box(sums_alone(&track, &trials[0], set)))
    });
    time("midpoint", 64, &one, &|| {
        drop(black_box(plants(
            &drive,
            &axes[..64],
            Stepping::Midpoint,
            set,
        )))
    });
    time("semi-implicit", 64, &one, &|| {
        drop(black_box(plants(
            &drive,
            &axes[..64],
            Stepping::SemiImplicit,
            set,
        )))
    });
}
