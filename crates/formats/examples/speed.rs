//! How long reading files takes: `speed ROUNDS FILE ..`; the least of so many rounds, in milliseconds, and the numbers in the
//! file. `bench/formats/compare.py` puts it beside other readers, for docs/performance.md.

use std::path::Path;
use std::time::Instant;
use stiction_formats::{ReadOptions, read_table};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let rounds: usize = arguments
        .next()
        .ok_or("usage: speed ROUNDS FILE ..")?
        .parse()?;
    for file in arguments {
        let mut least = f64::INFINITY;
        let mut numbers = 0;
        for _ in 0..rounds {
            let begun = Instant::now();
            let table = read_table(Path::new(&file), &ReadOptions::default())?;
            least = least.min(begun.elapsed().as_secs_f64());
            numbers = table.columns.iter().map(|c| c.values.len()).sum();
        }
        println!("{file}\t{:.3}\t{numbers}", 1e3 * least);
    }
    Ok(())
}
