//! The report of the paper's experiments: every one of its figures as a picture of ours.

mod identified;
mod simulated;

use super::checks::verdict;
use stiction_files::reproduce_file::{ClaimEntry, ReproduceFile};
use stiction_number::Percent;
use stiction_number::quantity;
use stiction_report::{Align, Block, Callout, Document, Severity, Table, Text};
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
         the figure of the paper that a picture stands for.",
    );
    document = identified::sections(document, file, paper);
    document = simulated::sections(document, file, paper);
    if !file.claims.is_empty() {
        document = document
            .heading(2, "Beside the paper's claims")
            .paragraph(
                "Not the same experiment: the paper gives neither baseline nor metric for its two figures, and \
                 concludes from simulation. Those here are of an axis whose friction follows the law and was identified \
                 to a few tenths of a percent; a machine does worse. The effect of wrong parameters is shown by a \
                 study with parameter errors.",
            )
            .block(claims(&file.claims));
    }
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

fn claims(claims: &[ClaimEntry]) -> Table {
    let columns = [
        ("Metric", Align::Left),
        ("Without", Align::Right),
        ("Law fed by", Align::Left),
        ("With", Align::Right),
        ("Less", Align::Right),
        ("The paper's words", Align::Left),
    ];
    claims.iter().fold(Table::new(columns), |table, claim| {
        table.row([
            claim.name.clone(),
            quantity(claim.without, &claim.unit),
            claim.compensation.clone(),
            quantity(claim.with, &claim.unit),
            Percent::error(claim.reduction_percent).digits(4),
            match claim.published.as_str() {
                "" => "–".into(),
                words => words.to_string(),
            },
        ])
    })
}
