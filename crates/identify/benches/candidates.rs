//! Costs that a search over candidates sees, on the log of motion of `stiction demo`: divan's items are samples times
//! candidates, on one thread.

#[path = "../tests/suite/common/mod.rs"]
mod common;

use common::closed_loop::{axis, samples};
use divan::Bencher;
use divan::counter::ItemsCount;
use stiction_identify::candidates::{Dynamic, Scheme, SixParameters, box_of_six};
use stiction_identify::{Conditioning, Cutoff, Law, LawKind, Mass, Record, Terms, condition};
use stiction_search::{Fidelity, Points, Problem};
use stiction_servo::cascade::Cascade;
use stiction_servo::closed_loop::{ClosedLoop, ForceLog};
use stiction_servo::encoder::Encoder;
use stiction_servo::path::Path;
use stiction_servo::plant::Plant;

fn main() {
    let one = rayon::ThreadPoolBuilder::new().num_threads(1);
    one.use_current_thread().build_global().unwrap();
    divan::main();
}

/// A generation of the genetic algorithms.
const CANDIDATES: usize = 50;

/// The log of the demo, with the cut-offs that its identification chooses, or without any.
fn record(filtered: bool) -> Record {
    let axis = axis("machine");
    let log = ClosedLoop {
        plant: Plant::new(axis.mass, axis.law).unwrap(),
        controller: Cascade::tuned(axis.mass, 60.0, 500.0).unwrap(),
        path: Path::three_segments(0.196, 9.0).unwrap(),
        encoder: Encoder::new(50e-9).unwrap(),
        rate: 4000.0,
        substeps: 5,
        force_noise: 1.0,
        force_log: ForceLog::Centred,
        seed: 1,
    };
    let common_cutoff = match filtered {
        true => Cutoff::Hz(50.0),
        false => Cutoff::Off,
    };
    let conditioning = Conditioning {
        source_cutoff: Cutoff::Hz(200.0),
        common_cutoff,
        resolution: Some(50e-9),
        ..Conditioning::default()
    };
    condition(&[samples(&log.run().unwrap())], &conditioning).unwrap()
}

fn six(filtered: bool, terms: &Terms) -> (SixParameters, usize) {
    let record = record(filtered);
    let bounds = box_of_six(&record).unwrap();
    let law = Law::new(LawKind::LuGre);
    let six = SixParameters::new(&record, law, terms, bounds, Scheme::Explin).unwrap();
    let samples = record.segments.iter().map(|s| s.velocity.len()).sum();
    (six, samples)
}

fn costs(bencher: Bencher, problem: &impl Problem, samples: usize) {
    let bounds = problem.bounds();
    let mut points = Points::new(bounds.dimensions());
    for i in 0..CANDIDATES {
        let unit = 0.01 + 0.98 * i as f64 / CANDIDATES as f64;
        points.push(&bounds.at(&vec![unit; bounds.dimensions()]));
    }
    let mut out = vec![0.0; CANDIDATES];
    bencher
        .counter(ItemsCount::new(CANDIDATES * samples))
        .bench_local(|| problem.costs(&points, Fidelity::Full, &mut out));
}

/// Neither filter nor mass nor offset: the kernel of `stiction-lanes` alone.
#[divan::bench]
fn bare(bencher: Bencher) {
    let terms = Terms {
        mass: Mass::Absent,
        offset: false,
        ..Terms::default()
    };
    let (problem, samples) = six(false, &terms);
    costs(bencher, &problem, samples);
}

/// Six at once beside mass and offset, without a common filter and with one.
#[divan::bench(args = [false, true])]
fn six_at_once(bencher: Bencher, filtered: bool) {
    let (problem, samples) = six(filtered, &Terms::default());
    costs(bencher, &problem, samples);
}

/// The second of the two steps: sigma0 and sigma1, the steady curve held.
#[divan::bench]
fn curve_held(bencher: Bencher) {
    let (problem, samples) = six(true, &Terms::default());
    let held = axis("machine").law;
    let problem = Dynamic::new(problem, held.curve().positive()).unwrap();
    costs(bencher, &problem, samples);
}
