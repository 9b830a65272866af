//! Writes `docs/validation.md`: every measured recording, its recipe, what was found and what must
//! hold. Run by `cargo xtask validation`.

mod made;
#[path = "../tests/suite/measure/mod.rs"]
mod measure;

use std::fmt::Write;
use std::path::Path;
use stiction_files::result::Action;
use stiction_testkit::{CASES, DEFAULT_RUNS, recordings, workspace};

fn main() -> std::io::Result<()> {
    let Some(data) = recordings() else {
        std::process::exit(2)
    };
    let mut out = format!(
        "# Validation on measured recordings\n\n\
         {}.\n\n\
         Written by `cargo xtask validation`; do not edit. The recordings are not part of the project \
         ([decision 0010](decisions/0010-recordings-are-not-committed.md)); their axis files are in `validation/`.\n\n\
         Relative error = 100 rms(residual) / rms(measured force). Unless the axis file says otherwise, cut-offs are \
         chosen by the data and the delay is fitted ([identification](identification.md#conditioning)). Fits by \
         simulation (`--method output-error`) compare the position as measured.\n",
        made::described()
    );
    defaults(&data, &mut out);
    let mut last = "";
    for case in CASES {
        if case.name != last {
            let (name, axis) = (case.name, case.axis);
            let _ = writeln!(
                out,
                "\n## {name}\n\nAxis file: [`{axis}`](../validation/{axis})."
            );
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
    }
    stiction_files::write_atomic(workspace().join("docs/validation.md"), out.as_bytes())
        .map_err(std::io::Error::other)
}

/// What each recording gives with columns and units in the axis file, and no option.
fn defaults(data: &Path, out: &mut String) {
    out.push_str(
        "\n## Default runs\n\n\
         `stiction identify LOG --axis AXIS.toml --out DIR` with an axis file that names columns and units only. \
         Best: the least held-out error of the laws that can be exported. Friction left: rms of the residual over \
         that of the friction, on held-out samples. Time: of the whole command without its report, two threads.\n\n\
         | recording | exit | law | held-out error | best | friction left | time | next |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for run in &DEFAULT_RUNS {
        let outcome = measure::run_by_default(run, data);
        let result = &outcome.result;
        let (law, least) = measure::reported(result);
        let side = if law.asymmetric { ", asymmetric" } else { "" };
        let without = match law.without.as_slice() {
            [] => String::new(),
            names => format!(", without {}", names.join(" and ")),
        };
        let left = result.trust.compensation.as_ref();
        let _ = writeln!(
            out,
            "| {} | {} | {}{side}{without} | {:.2} % | {least:.2} % | {:.1} % | {:.1} s | {} |",
            run.name,
            u8::from(!result.trust.trustworthy),
            law.law,
            law.held_out_error_percent.unwrap_or(f64::NAN),
            left.map_or(f64::NAN, |seen| seen.friction_left_percent),
            result.search.wall_s,
            match &result.trust.next {
                Action::Export => "`stiction export DIR/model.toml --target c --out DIR/c`",
                other => stiction_pages::text::why(other),
            }
        );
    }
}

/// Four decimals, and more where they would leave no digits.
fn short(x: f64) -> String {
    if x.abs() < 0.01 {
        format!("{x:.3e}")
    } else {
        format!("{x:.4}")
    }
}
