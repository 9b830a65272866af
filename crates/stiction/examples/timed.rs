//! Identifies LuGre from a log so many times and prints the least time of a call in seconds: what `bench/python/measure.py`
//! compares the Python package with. `timed LOG TIMES`.

use std::time::Instant;
use stiction::{Identification, LawKind, Log, set_threads};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("a log")?;
    let times: u32 = arguments.next().ok_or("how many times")?.parse()?;
    set_threads(1);
    let log = [Log::open(path)?];
    let mut least = f64::INFINITY;
    for _ in 0..times {
        let clock = Instant::now();
        Identification::of(&log)
            .law(LawKind::LuGre)
            .without_comparison()
            .run()?;
        least = least.min(clock.elapsed().as_secs_f64());
    }
    println!("{least}");
    Ok(())
}
