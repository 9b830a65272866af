//! Exported C beside the compensator that it was written from.

use super::motion;
use super::rows::less;
use super::{Trace, courses};
use stiction_files::study::result::ExportedEntry;
use stiction_number::quantity;
use stiction_report::{Align, Block, Table, Text};
use stiction_workflows::study::StudyOutcome;

/// Most paths and controllers with a figure.
const MOST_FIGURES: usize = 4;

/// The columns of the table, of which the first two are text.
const HEADER: [&str; 9] = [
    "path",
    "controller",
    "without",
    "in Rust",
    "less",
    "exported C",
    "less",
    "forces differ by",
    "",
];

/// The table with its header: the largest error of the three runs, and the largest difference of the forces on the same inputs.
pub(crate) fn exported_rows(entry: &ExportedEntry) -> Vec<Vec<String>> {
    let mut lines = vec![HEADER.map(String::from).to_vec()];
    for run in &entry.runs {
        let Some(m) = run.metric("peak_error") else {
            continue;
        };
        let error = |x: f64| quantity(x, &m.unit);
        let reduction = |x: Option<f64>| x.map_or(String::new(), less);
        let mut remarks = Vec::new();
        if run.differs {
            remarks.push("NOT THE SAME");
        }
        if run.switched_off {
            remarks.push("watchdog switched off");
        }
        lines.push(vec![
            run.path.clone(),
            run.controller.clone(),
            error(m.without),
            error(m.rust),
            reduction(m.rust_reduction_percent),
            error(m.c),
            reduction(m.c_reduction_percent),
            quantity(run.force_difference, &run.force_unit),
            remarks.join(", "),
        ]);
    }
    lines
}

/// The section of the report.
pub(super) fn blocks(outcome: &StudyOutcome) -> Vec<Block> {
    let Some(entry) = &outcome.file.exported_c else {
        return Vec::new();
    };
    let lines = exported_rows(entry);
    let columns = HEADER.iter().enumerate().map(|(c, name)| match c {
        2..8 => (*name, Align::Right),
        _ => (*name, Align::Left),
    });
    let mut table = Table::new(columns).caption(
        "Largest error of the axis as modelled. Both forces are compared on the same inputs, sample by sample, in the run with the C.",
    );
    for line in &lines[1..] {
        table = table.row(line.iter().map(String::as_str));
    }
    let text = format!(
        "{}, compiled on this machine and fed sample by sample; in Rust the compensator that this version exports of the model of the \
         study, with the settings of the C.",
        entry.folder
    );
    let mut blocks: Vec<Block> = vec![Block::Paragraph(Text::from(text)), table.into()];
    let figures = outcome.exported_traces.chunks(3).take(MOST_FIGURES);
    blocks.extend(figures.map(|traces| {
        let title = format!("{}, {}", traces[0].path, traces[0].controller);
        let traces: Vec<&Trace> = traces.iter().collect();
        let motion = motion(&outcome.file.axis);
        courses(&title, &traces, motion, &|t| &t.whole, &[]).into()
    }));
    blocks
}
