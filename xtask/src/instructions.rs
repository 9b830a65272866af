//! Instructions of the kernels, of an identification and of whole commands, counted by callgrind, against a snapshot: a
//! slowdown shows in review, however busy the machine is.
//!
//! Counted is the build that the tests run, with one unit a crate (the profile `counted`): the numerical crates are
//! optimised in it as in a release, and its checks of overflow and indices are 2 to 19 % of the instructions.

use crate::debian;
use crate::shell::{self, Outcome};
use std::fmt::Write;
use std::fs;

/// What is counted, by the name that an example knows: `crates/identify/examples/instructions.rs`, for whole commands
/// `crates/stiction/examples/whole_commands.rs`.
const WHAT: [&str; 11] = [
    "friction-step",
    "costs",
    "sums",
    "sums-alone",
    "identify",
    "command-identify",
    "command-auto",
    "command-demo",
    "command-emps",
    "command-servo",
    "command-tribometer",
];
/// Those of measured recordings, which are not everywhere.
const MEASURED: usize = 3;
/// How the names of whole commands begin.
const COMMAND: &str = "command-";
/// Largest relative difference of a count: the C library picks its copying loops by processor.
const TOLERANCE: f64 = 0.02;
/// The same of a whole command, which also allocates, reads and writes.
const COMMAND_TOLERANCE: f64 = 0.05;
const SNAPSHOT: &str = "bench/instructions.txt";

/// Fails where a count differs from the snapshot.
pub fn compare() -> Outcome {
    let Some(counts) = counts()? else {
        return Ok(());
    };
    let path = shell::root().join(SNAPSHOT);
    let text = fs::read_to_string(&path).map_err(|e| format!("{SNAPSHOT}: {e}"))?;
    let table = table(&text, &counts);
    print!("{}", table.text);
    if table.same {
        return Ok(());
    }
    Err(format!(
        "instruction counts differ by more than {} % (whole commands {} %), see the table above; {}. If that is \
         meant: cargo xtask instructions --accept",
        100.0 * TOLERANCE,
        100.0 * COMMAND_TOLERANCE,
        compilers(&text)?
    ))
}

/// Writes the snapshot.
pub fn accept() -> Outcome {
    let Some(counts) = counts()? else {
        return Err("counts are kept for x86-64 with AVX2 only".into());
    };
    let mut text = format!(
        "# Instructions, by `cargo xtask instructions --accept`: x86-64, AVX2\n# {}\n",
        rustc()?
    );
    for (what, count) in WHAT.iter().zip(&counts) {
        let _ = writeln!(text, "{what} {count}");
    }
    if counts.len() < WHAT.len() {
        return Err("counts are kept with the measured recordings only".into());
    }
    fs::write(shell::root().join(SNAPSHOT), text).map_err(|e| format!("{SNAPSHOT}: {e}"))
}

/// One count for each of [`WHAT`]; `None` on a processor that the snapshot does not speak of.
fn counts() -> Result<Option<Vec<u64>>, String> {
    #[cfg(target_arch = "x86_64")]
    let known = is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma");
    #[cfg(not(target_arch = "x86_64"))]
    let known = false;
    if !known {
        println!("==> instructions: not compared, counts are kept for x86-64 with AVX2");
        return Ok(None);
    }
    debian::install()?;
    // Of the whole workspace, or features of the dependencies would differ and all of them be built again.
    shell::run(shell::cargo(
        "build --quiet --profile counted --workspace --example instructions --example whole_commands",
    ))?;
    let out = shell::target().join("instructions.callgrind");
    let file = format!("--callgrind-out-file={}", out.display());
    let data = std::env::var_os("STICTION_DATA").map(std::path::PathBuf::from);
    let data = data.unwrap_or_else(|| shell::root().join("../shared/data"));
    let counted = match data.is_dir() {
        true => &WHAT[..],
        false => &WHAT[..WHAT.len() - MEASURED],
    };
    counted
        .iter()
        .map(|what| {
            let example = match what.starts_with(COMMAND) {
                true => "whole_commands",
                false => "instructions",
            };
            let program = shell::target().join("counted/examples").join(example);
            let program = program.to_string_lossy();
            let toggle = format!("--toggle-collect=*{example}*counted*");
            let arguments = [
                "--quiet",
                "--tool=callgrind",
                &toggle,
                &file,
                &program,
                what,
            ];
            shell::output(shell::command("valgrind", &arguments))?;
            let text = fs::read_to_string(&out).map_err(|e| format!("{}: {e}", out.display()))?;
            total(&text).ok_or_else(|| format!("callgrind counted nothing for `{what}`"))
        })
        .collect::<Result<Vec<u64>, String>>()
        .map(Some)
}

/// The sum of a callgrind file.
fn total(text: &str) -> Option<u64> {
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix("totals: "))?;
    line.trim().parse().ok().filter(|&count| count > 0)
}

struct Table {
    text: String,
    same: bool,
}

/// Old beside new.
fn table(snapshot: &str, counts: &[u64]) -> Table {
    let mut out = Table {
        text: format!("    {:16} {:>12} {:>12}\n", "", "snapshot", "now"),
        same: true,
    };
    for (what, &now) in WHAT.iter().zip(counts) {
        let old = snapshot.lines().find_map(|line| {
            line.strip_prefix(what)?
                .strip_prefix(' ')?
                .parse::<u64>()
                .ok()
        });
        let shift = old.map_or(f64::INFINITY, |old| now as f64 / old as f64 - 1.0);
        let most = match what.starts_with(COMMAND) {
            true => COMMAND_TOLERANCE,
            false => TOLERANCE,
        };
        let same = shift.abs() <= most;
        out.same &= same;
        let old = old.map_or_else(|| "none".into(), |old| old.to_string());
        let _ = writeln!(
            out.text,
            "    {what:16} {old:>12} {now:>12} {:>+7.1} %{}",
            100.0 * shift,
            if same { "" } else { "  <" }
        );
    }
    out
}

fn rustc() -> Result<String, String> {
    let version = shell::output(shell::command("rustc", &["--version"]))?;
    Ok(version.trim().into())
}

/// With which compilers snapshot and counts were made.
fn compilers(snapshot: &str) -> Result<String, String> {
    let now = rustc()?;
    let then = snapshot
        .lines()
        .find_map(|line| line.strip_prefix("# rustc"))
        .map_or_else(|| "unknown".into(), |rest| format!("rustc{rest}"));
    Ok(if then == now {
        format!("both with {now}")
    } else {
        format!("the snapshot is of {then}, this is {now}")
    })
}

#[cfg(test)]
mod tests {
    use super::{table, total};

    #[test]
    fn a_count_that_moves_is_marked() {
        let snapshot = "# a\nfriction-step 1000\ncosts 1000\nsums 1000\nsums-alone 1000\n\
                        command-identify 1000\ncommand-auto 1000\n";
        let found = table(snapshot, &[1019, 1021, 979, 1000, 5, 1049, 949]);
        assert!(!found.same);
        let marked: Vec<bool> = found.text.lines().map(|l| l.ends_with('<')).collect();
        assert_eq!(marked, [false, false, true, true, false, true, false, true]);
        let identify = format!("{snapshot}identify 5\n");
        assert!(table(&identify, &[1000, 1000, 1000, 1000, 5, 970, 1030]).same);
    }

    #[test]
    fn nothing_counted_is_no_count() {
        assert_eq!(total("events: Ir\ntotals: 123\n"), Some(123));
        assert_eq!(total("events: Ir\ntotals: 0\n"), None);
    }
}
