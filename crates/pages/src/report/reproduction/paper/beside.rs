//! Controllers and compensations beside each other, and beside the paper's claims.

use stiction_files::reproduce_file::{ClaimEntry, ReproduceFile, RunEntry};
use stiction_number::{Percent, quantity};
use stiction_report::{Align, Document, Table};

pub(super) fn sections(mut document: Document, file: &ReproduceFile) -> Document {
    let mut experiments: Vec<&str> = file.runs.iter().map(|r| r.experiment.as_str()).collect();
    experiments.dedup();
    if !experiments.is_empty() {
        document = document
            .heading(2, "Baselines")
            .paragraph(
                "Every run, with how much less a metric is than under the same controller without compensation. The PID has \
                 the gains that the fuzzy rules change by up to 30 %. Coulomb, Stribeck and the simplified law (bristles \
                 without the Stribeck effect) are parts of the same identified law, driven by the reference velocity.",
            );
    }
    for experiment in experiments {
        let runs = file.runs.iter().filter(|r| r.experiment == experiment);
        let runs: Vec<&RunEntry> = runs.collect();
        document = document.heading(3, capital(experiment)).block(table(&runs));
    }
    if file.claims.is_empty() {
        return document;
    }
    document
        .heading(2, "Beside the paper's claims")
        .paragraph(
            "Not the same experiment: the paper gives neither baseline nor metric for its two figures, and \
             concludes from simulation. Beside them stand the metrics here that are like them: the feed error beside the \
             feed error, the corner beside the corner, both with the axes coupled as there. They are of an axis whose \
             friction follows the law and was identified to a few tenths of a percent; a machine does worse. The effect of \
             wrong parameters is shown by a study with parameter errors.",
        )
        .block(claims(&file.claims))
}

fn capital(name: &str) -> String {
    let mut letters = name.chars();
    let first = letters.next().map(|c| c.to_ascii_uppercase());
    first.into_iter().chain(letters).collect()
}

/// The runs of one experiment, each metric with what it is less than without compensation.
fn table(runs: &[&RunEntry]) -> Table {
    let metrics = runs.first().map_or(&[][..], |r| &r.metrics);
    let names = metrics.iter().map(|m| (capital(&m.name), Align::Right));
    let left = ["Controller", "Compensation"].map(|n| (n.to_string(), Align::Left));
    let table = Table::new(left.into_iter().chain(names));
    runs.iter().fold(table, |table, run| {
        let bare = runs
            .iter()
            .find(|r| r.controller == run.controller && r.compensation == "none");
        let cells = run.metrics.iter().enumerate().map(|(i, metric)| {
            let value = quantity(metric.value, &metric.unit);
            match bare.and_then(|b| b.metrics.get(i)) {
                Some(without) if run.compensation != "none" => {
                    let less = 100.0 * (1.0 - metric.value / without.value);
                    let sign = if less < 0.0 { "+" } else { "" };
                    format!("{value} ({sign}{})", Percent::error(-less).digits(4))
                }
                _ => value,
            }
        });
        let names = [run.controller.clone(), run.compensation.clone()];
        table.row(names.into_iter().chain(cells))
    })
}

fn claims(claims: &[ClaimEntry]) -> Table {
    let columns = [
        ("Metric", Align::Left),
        ("Without", Align::Right),
        ("Compensation", Align::Left),
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
