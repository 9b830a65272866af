//! The report of the paper's experiments: every one of its figures as a picture of ours.

mod beside;
mod corners;
mod drawings;
mod identified;
mod measured;
mod parts;
mod searches;
mod simulated;
mod slow;

use super::checks::verdict;
use stiction_files::reproduce_file::ReproduceFile;
use stiction_report::{Block, Callout, Document, Severity, Text};
use stiction_workflows::reproduce::Paper;

pub(super) fn report(file: &ReproduceFile, paper: &Paper) -> Document {
    let mut document = Document::new("The experiments of Zhang et al. 2025")
        .subtitle(
            "Friction of a linear motor axis identified by an annealing genetic algorithm and fed forward \
             (doi 10.1371/journal.pone.0322844), on a simulated axis of 4.6 kg",
        )
        .footer(format!("stiction {}", file.version))
        .block(verdict(file));
    if file.status == "interrupted" {
        document = document.block(Callout {
            severity: Severity::Warning,
            code: String::new(),
            text: Text::from("Stopped early: later experiments are missing."),
            link: String::new(),
        });
    }
    document = document.paragraph(
        "The numbers that are checked are those of the simulated axis: the experiments have to find them to \
         1 %, the mass of a changed load to 2 %. The paper's own friction parameters, gains and search boxes \
         are not available as text, so the axis is one of this project and nothing here repeats the paper's run; what \
         was assumed is listed at the end. Everything is simulated with ode4 at 0.1 ms, as there. FIG. n names \
         the figure of the paper that a picture stands for; the drawings stand for its schematics (FIG. 2, 3, 8, 11, 18).",
    );
    document = identified::sections(document, file, paper);
    document = simulated::sections(document, file, paper);
    document = beside::sections(document, file);
    document
        .heading(2, "Assumptions")
        .paragraph("Where the paper gives no number, and what was assumed.")
        .block(Block::List(
            file.assumptions
                .iter()
                .map(|a| Text::from(a.as_str()))
                .collect(),
        ))
}
