//! What was recorded from a device, and what was lost.

use std::fmt::Write;
use std::path::Path;
use stiction_files::shell;
use stiction_number::{four_digits as short, sig};
use stiction_record::{Device, End, Recorded};

/// How much was recorded, what is missing and why, where it is, and the command that reads it.
pub fn recorded(recorded: &Recorded, device: &Device) -> String {
    let mut out = format!(
        "recorded {} s: {}",
        short(recorded.span),
        count(recorded.rows, "sample")
    );
    if recorded.rate > 0.0 {
        let _ = write!(out, " at {} Hz", short(recorded.rate));
        if (recorded.rate / recorded.asked - 1.0).abs() > 0.01 {
            let _ = write!(out, " (asked for {} Hz)", short(recorded.asked));
        }
    }
    out.push('\n');
    if recorded.lost > 0 {
        let all = recorded.rows + recorded.lost;
        let part = 100.0 * recorded.lost as f64 / all as f64;
        let _ = write!(
            out,
            "lost: {} ({} %) in {}",
            count(recorded.lost, "sample"),
            sig(part, 2),
            count(recorded.gaps, "gap"),
        );
        if recorded.reconnects > 0 {
            let _ = write!(out, "; {}", count(recorded.reconnects, "reconnection"));
        }
        out.push('\n');
    } else if recorded.reconnects > 0 {
        let _ = writeln!(
            out,
            "{}, no sample lost",
            count(recorded.reconnects, "reconnection")
        );
    }
    for (left_out, why) in [
        (recorded.repeated, "whose time stamp was there already"),
        (recorded.incomplete, "without all symbols"),
        (recorded.unwritten, "that could not be written"),
    ] {
        if left_out > 0 {
            let _ = writeln!(out, "left out: {} {why}", count(left_out, "sample"));
        }
    }
    if let End::Failed(e) = &recorded.end {
        let _ = writeln!(out, "ended early: {e}");
    }
    if let Some(path) = &recorded.path {
        let typed = shell::text(path);
        let _ = writeln!(
            out,
            "written to {}\n{}",
            shell::shown(&typed),
            next(device, path)
        );
    }
    out
}

/// What reads the log.
fn next(device: &Device, path: &Path) -> String {
    let log = shell::quoted_path(path);
    match device {
        Device::Ads { .. } => format!("next: stiction check {log}"),
        Device::Rtde { .. } => format!("next: stiction robot {log} --urdf ARM.urdf --out robot"),
    }
}

fn count(number: u64, noun: &str) -> String {
    match number {
        1 => format!("1 {noun}"),
        _ => format!("{number} {noun}s"),
    }
}
