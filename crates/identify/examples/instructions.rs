//! One fixed piece of work, whose instructions `cargo xtask instructions` counts: `instructions WHAT`.
//!
//! Only what [`counted`] calls is counted. It all runs on one thread, and with the vector instructions that
//! the counting machine has: it knows none of 512 bits.

use std::f64::consts::TAU;
use std::hint::black_box;
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
use stiction_identify::{
    Conditioning, Cutoff, Law, LawKind, Mass, Samples, Settings, Silent, Terms, condition,
    estimate, intervals, separable,
};
use stiction_lanes::{
    Candidate, InstructionSet, Scheme, Segment, Time, Track, Trial, costs, sums, sums_alone,
};

const STEP: f64 = 1e-3;
const SAMPLES: usize = 6001;

/// The function by whose name the counting is switched on.
#[inline(never)]
fn counted(work: &mut dyn FnMut()) {
    work();
}

fn law() -> LuGre<f64> {
    let both = Direction {
        coulomb: 20.0,
        static_friction: 30.0,
        stribeck_velocity: 5e-3,
        viscous: 60.0,
    };
    let curve = Stribeck::symmetric(Shape::Gaussian, both, 0.0).expect("a curve");
    LuGre::new(1.2e5, Damping::Constant(600.0), curve).expect("a law")
}

/// Force along a velocity.
fn along(law: &LuGre<f64>, velocity: &[f64]) -> Vec<f64> {
    let mut z = 0.0;
    let mut force = vec![law.force(z, velocity[0])];
    for v in velocity.windows(2) {
        z = law.step_record(z, STEP, v[0], v[1]);
        force.push(law.force(z, v[1]));
    }
    force
}

fn work(what: &str) {
    let wave = |k: usize| 0.02 * libm::sin(TAU * STEP * k as f64);
    let velocity: Vec<f64> = (0..SAMPLES).map(wave).collect();
    let law = law();
    // Not white, and the same everywhere.
    let error = |k: usize| 0.2 * libm::sin(1e3 * libm::sin(k as f64));
    let clean = along(&law, &velocity);
    let force: Vec<f64> = clean
        .iter()
        .enumerate()
        .map(|(k, u)| u + error(k))
        .collect();
    let set = InstructionSet::best();
    let track = Track::new(&[Segment {
        time: Time::Step(STEP),
        velocity: &velocity,
        force: &force,
        keep: &[],
        columns: &[],
    }])
    .expect("a track");
    let candidates: Vec<Candidate> = (0..16)
        .map(|i| Candidate::gaussian([1e5 + 4e3 * f64::from(i), 600.0, 60.0, 20.0, 30.0, 5e-3]))
        .collect();
    let trials: Vec<Trial> = (0..8)
        .map(|i| Trial {
            ln_kappa: 8.5 + 0.05 * f64::from(i),
            ln_excess: -0.7,
            ln_velocity: -5.3,
            exponent: 2.0,
        })
        .collect();
    match what {
        "friction-step" => counted(&mut || drop(black_box(along(&law, &velocity)))),
        "costs" => counted(&mut || {
            drop(black_box(costs(&track, &candidates, Scheme::Explin, set)));
        }),
        "sums" => counted(&mut || drop(black_box(sums(&track, &trials, set)))),
        "sums-alone" => counted(&mut || drop(black_box(sums_alone(&track, &trials[0], set)))),
        "identify" => {
            let samples = Samples {
                time: (0..SAMPLES).map(|k| STEP * k as f64).collect(),
                velocity: Some(velocity),
                force,
                ..Samples::default()
            };
            let raw = Conditioning {
                source_cutoff: Cutoff::Off,
                common_cutoff: Cutoff::Off,
                ..Conditioning::default()
            };
            let record = condition(&[samples], &raw).expect("a record");
            let terms = Terms {
                mass: Mass::Absent,
                ..Terms::default()
            };
            let law = Law::new(LawKind::LuGre);
            counted(&mut || {
                let settings = Settings::default();
                let found = separable(&record, law, &terms, &settings, &mut Silent).expect("a fit");
                let mut result = estimate(&record, law, &terms, &found, 0.0);
                intervals(&record, &found, &mut result, &mut Silent);
                black_box(result);
            });
        }
        _ => {
            eprintln!("usage: instructions friction-step|costs|sums|sums-alone|identify");
            std::process::exit(2);
        }
    }
}

fn main() {
    let what = std::env::args().nth(1).unwrap_or_default();
    let one = rayon::ThreadPoolBuilder::new().num_threads(1);
    one.build().expect("a thread").install(|| work(&what));
}
