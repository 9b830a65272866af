//! Time of one regressor of a robot: `regressor URDF SAMPLES` prints the least of 20 rounds, ns; for bench/rigid/compare.py.

use std::hint::black_box;
use std::time::Instant;
use stiction_rigid::{Document, Robot, Workspace};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, path, samples] = &arguments[..] else {
        return Err("usage: regressor URDF SAMPLES".into());
    };
    let robot = Robot::new(&Document::parse(&std::fs::read_to_string(path)?)?)?;
    let (n, samples) = (robot.len(), samples.parse::<usize>()?);
    // Other angles in every sample.
    let state = |k: usize| (0..n).map(move |i| ((k * n + i) as f64 * 0.7).sin() * 3.0);
    let q: Vec<f64> = (0..samples).flat_map(state).collect();
    let mut workspace = Workspace::new(&robot);
    let mut regressor = vec![0.0; 10 * n * n];
    let mut least = f64::INFINITY;
    for _ in 0..20 {
        let start = Instant::now();
        for q in q.chunks_exact(n) {
            robot.regressor([q, q, q], &mut workspace, &mut regressor);
            black_box(&regressor);
        }
        least = least.min(start.elapsed().as_nanos() as f64 / samples as f64);
    }
    println!("{least:.1}");
    Ok(())
}
