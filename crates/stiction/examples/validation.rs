//! Writes `docs/validation.md`: every measured recording, its recipe, what was found and what must
//! hold. Run by `cargo xtask validation`.

#[path = "../tests/suite/measure/mod.rs"]
mod measure;

use std::fmt::Write;
use stiction_testkit::{CASES, recordings, workspace};

fn main() -> std::io::Result<()> {
    let Some(data) = recordings() else {
        std::process::exit(2)
    };
    let mut out = String::from(
        "# Validation on measured recordings\n\n\
         Written by `cargo xtask validation`; do not edit. The recordings are not part of the project \
         (see [decisions](decisions/)); the axis files that map them are in `validation/`.\n\n\
         Relative error = 100 rms(residual) / rms(measured force). Conditioning as \
         in [identification](identification.md#conditioning): cut-offs chosen by the data, delay \
         fitted. Where a recording is treated otherwise, its recipe says so. Fits by simulation (`--method \
         output-error`) compare the position as measured.\n",
    );
    let mut last = "";
    for case in CASES {
        if case.name != last {
            let axis = std::fs::read_to_string(workspace().join("validation").join(case.axis))?;
            let _ = writeln!(out, "\n## {}\n\n```toml\n{}```", case.name, axis);
            last = case.name;
        }
        let outcome = measure::run(case, &data);
        let side = if case.asymmetric { ", asymmetric" } else { "" };
        let method = match case.method {
            "separable" => String::new(),
            other => format!(", {other}"),
        };
        let _ = writeln!(out, "\n### {}{side}{method}\n", case.law);
        let _ = writeln!(out, "Fitted: {}.", case.logs.join(", "));
        if let Some(part) = case.split {
            let _ = writeln!(
                out,
                "First {:.0} % of the samples fitted, the rest unseen.",
                100.0 * part
            );
        }
        if !case.validate.is_empty() {
            let _ = writeln!(out, "Unseen: {}.", case.validate.join(", "));
        }
        let _ = writeln!(out);
        for note in &outcome.result.axis.conditioning {
            let _ = writeln!(out, "- {note}");
        }
        let _ = writeln!(out, "\n| what | measured | at most | |\n|---|---|---|---|");
        for limit in case.limits {
            let found = measure::measure(case, limit, &outcome, &data);
            let verdict = if found.holds() { "holds" } else { "**MISSED**" };
            let _ = writeln!(
                out,
                "| {} | {} | {} | {verdict} |",
                found.what,
                short(found.value),
                found.most
            );
        }
        let _ = writeln!(
            out,
            "\n| parameter | value | unit | std | |\n|---|---|---|---|---|"
        );
        for p in &outcome.result.parameters {
            let std = match p.std {
                Some(std) if p.value != 0.0 => format!("{:.2} %", 100.0 * std / p.value.abs()),
                _ => "–".into(),
            };
            let flag = if p.identifiable {
                ""
            } else {
                "not identifiable"
            };
            let _ = writeln!(
                out,
                "| {} | {:.5e} | {} | {std} | {flag} |",
                p.name, p.value, p.unit
            );
        }
    }
    stiction::commands::write_atomic(workspace().join("docs/validation.md"), out.as_bytes())
        .map_err(std::io::Error::other)
}

/// Four decimals, and more where they would leave no digits.
fn short(x: f64) -> String {
    if x.abs() < 0.01 {
        format!("{x:.3e}")
    } else {
        format!("{x:.4}")
    }
}
