//! Throughput of the text reader on logs of 100 MB, and the memory it takes.
//!
//! `cargo bench -p stiction-formats --bench text` generates the logs in a temporary folder (repr-like
//! numbers, fixed decimals, decimal comma, quoted), times each and, in a process of its own, reports
//! the peak of resident memory against the size of the samples.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::time::Instant;
use stiction_formats::text::{TextOptions, read_file};

const BYTES: u64 = 100_000_000;
const LOGS: [&str; 4] = ["full", "fixed", "comma", "quoted"];

fn main() {
    if let Some(path) = std::env::var_os("STICTION_BENCH_READ") {
        return report_one(Path::new(&path));
    }
    for log in LOGS {
        let status = Command::new(std::env::current_exe().unwrap())
            .env("STICTION_BENCH_READ", path(log))
            .status()
            .unwrap();
        assert!(status.success());
    }
    divan::main();
}

/// Reads one log and prints throughput and peak memory of this process.
fn report_one(path: &Path) {
    let before = resident("VmRSS");
    let start = Instant::now();
    let table = read_file(path, &TextOptions::default()).unwrap();
    let seconds = start.elapsed().as_secs_f64();
    let samples: usize = table.columns.iter().map(|c| c.values.len()).sum();
    let size = samples as f64 * 8e-6;
    let peak = resident("VmHWM") - before;
    let bytes = path.metadata().unwrap().len() as f64;
    println!(
        "{:<12} {:4.0} MB/s   samples {size:5.1} MB   peak {peak:5.1} MB = {:.2} x samples",
        path.file_stem().unwrap().to_string_lossy(),
        bytes / 1e6 / seconds,
        peak / size
    );
}

/// A line of `/proc/self/status` in MB.
fn resident(key: &str) -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status
        .lines()
        .find(|l| l.starts_with(key))
        .unwrap_or_default();
    let kib: f64 = line
        .split_whitespace()
        .nth(1)
        .and_then(|n| n.parse().ok())
        .unwrap_or(f64::NAN);
    kib * 1024.0 / 1e6
}

/// The log of this name, written on first use.
fn path(log: &str) -> PathBuf {
    static FOLDER: OnceLock<tempfile::TempDir> = OnceLock::new();
    let folder = FOLDER.get_or_init(|| tempfile::tempdir().unwrap());
    let path = folder.path().join(format!("{log}.csv"));
    if !path.exists() {
        write(&path, log).unwrap();
    }
    path
}

/// Writes rows of a sine, its derivative and a torque until the file is large enough.
fn write(path: &Path, log: &str) -> std::io::Result<()> {
    let mut out = BufWriter::new(File::create(path)?);
    let comma = log == "comma";
    let sep = if comma { ";" } else { "," };
    writeln!(
        out,
        "time [s]{sep}position [mm]{sep}velocity [mm/s]{sep}torque [Nm]"
    )?;
    let (mut written, mut row, mut text) = (0, 0_u32, String::new());
    while written < BYTES {
        let t = f64::from(row) * 1e-3;
        let (x, v) = (12.5 * (1.3 * t).sin(), 16.25 * (1.3 * t).cos());
        let f = v.signum() * 0.3 + 0.02 * v;
        text.clear();
        let _ = match log {
            "fixed" => writeln!(text, "{t:.6},{x:.6},{v:.6},{f:.6}"),
            "quoted" => writeln!(text, "\"{t}\",\"{x}\",\"{v}\",\"{f}\""),
            _ => writeln!(text, "{t}{sep}{x}{sep}{v}{sep}{f}"),
        };
        let line = if comma {
            text.replace('.', ",")
        } else {
            text.clone()
        };
        out.write_all(line.as_bytes())?;
        written += line.len() as u64;
        row += 1;
    }
    out.flush()
}

#[divan::bench(args = LOGS, sample_count = 5, sample_size = 1)]
fn read_100_mb(bencher: divan::Bencher, log: &str) {
    let path = path(log);
    bencher
        .counter(divan::counter::BytesCount::new(BYTES))
        .bench(|| read_file(&path, &TextOptions::default()).unwrap());
}
