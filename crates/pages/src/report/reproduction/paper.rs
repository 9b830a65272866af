//! The report of the paper's experiments: every one of its figures as a picture of ours.

mod beside;
mod corners;
mod delayed;
mod drawings;
mod identified;
mod measured;
mod parts;
mod rested;
mod searches;
mod simulated;
mod slow;

use super::checks::verdict;
use stiction_files::reproduce_file::ReproduceFile;
use stiction_files::symbols;
use stiction_report::{Block, Callout, Document, Severity, Text, number};
use stiction_workflows::reproduce::Paper;

pub(super) fn report(file: &ReproduceFile, paper: &Paper) -> Document {
    let truth = &paper.stage.truth;
    let axis = match &paper.stage.name {
        Some(name) => name.clone(),
        None => "a simulated axis".into(),
    };
    let mut document = Document::new("The experiments of Zhang et al. 2025")
        .subtitle(format!(
            "Friction of a linear motor axis identified by an annealing genetic algorithm and fed forward \
             (doi 10.1371/journal.pone.0322844), on {axis} of {} {}",
            number::sig(truth.mass, 3),
            number::unit(paper.stage.units().mass)
        ))
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
    document = document.paragraph(format!(
        "The numbers that are checked are those of the simulated axis: the experiments have to find them to \
         1 %, the mass of a changed load to 2 %, from an encoder as far as that and the noise allow. {} What was assumed is listed at the end. Everything is simulated \
         with ode4 at 0.1 ms, as there. FIG. n names the figure of the paper that a picture stands for; its schematic \
         FIG. 11 is left out, and FIG. 9 and 10 are photographs of its machine.",
        match paper.stage.is_own() {
            false =>
                "The paper's own friction parameters, gains and search boxes are not available as text, so the axis is one of \
                 this project and nothing here repeats the paper's run.",
            true =>
                "The axis is simulated from the model and the axis file that were given: what comes out shows what the \
                 paper's steps find on such an axis, not how well the model describes the machine.",
        }
    ));
    let absent = paper.stage.without();
    if !absent.is_empty() {
        let names: Vec<String> = absent.iter().map(|n| symbols::symbol(n)).collect();
        document = document.paragraph(format!(
            "Not checked, since this axis has none: {}.",
            names.join(", ")
        ));
    }
    if !file.not_run.is_empty() {
        document = document
            .heading(2, "Not run on this axis")
            .block(list(&file.not_run));
    }
    document = identified::sections(document, file, paper);
    document = simulated::sections(document, file, paper);
    document = beside::sections(document, file);
    document
        .heading(2, "Assumptions")
        .paragraph("Where the paper gives no number, and what was assumed.")
        .block(list(&file.assumptions))
}

fn list(items: &[String]) -> Block {
    let items = items.iter().map(|item| Text::from(item.as_str()));
    Block::List(items.collect())
}
