//! Memory that reading a log takes: `reading LOG AXIS.toml`, for docs/performance.md; with `whole` behind it every column is kept
//! until the log is mapped. Linux alone says what the most was.

use std::path::Path;
use stiction_files::Axis;
use stiction_log::Log;
use stiction_workflows::source;

/// Most memory of this process so far, bytes.
fn most() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"));
    let kibibytes = line.and_then(|l| l.trim().trim_end_matches("kB").trim().parse::<f64>().ok());
    1024.0 * kibibytes.unwrap_or(f64::NAN)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args_os().skip(1);
    let (Some(log), Some(axis)) = (arguments.next(), arguments.next()) else {
        return Err("usage: reading LOG AXIS.toml [whole]".into());
    };
    let axis = Axis::read(Path::new(&axis))?;
    let before = most();
    let log = match arguments.next() {
        None => source::load(Path::new(&log), &axis)?.log,
        Some(_) => Log::of_table(source::table(Path::new(&log), &axis)?, &axis.mapping)?,
    };
    let after = most();
    let columns = [
        &log.position,
        &log.velocity,
        &log.acceleration,
        &log.force,
        &log.reference,
        &log.temperature,
        &log.load,
        &log.external,
    ];
    let columns = 1 + columns.into_iter().flatten().count();
    let kept = 8.0 * columns as f64 * log.time.len() as f64;
    println!(
        "{} rows, {columns} columns kept: {:.0} MB; most memory {:.0} MB, {:.0} MB of it before: {:.2} times what is kept",
        log.time.len(),
        kept / 1e6,
        after / 1e6,
        before / 1e6,
        after / kept
    );
    Ok(())
}
