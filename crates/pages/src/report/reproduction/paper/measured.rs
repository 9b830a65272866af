//! The same parameters from exact values and from what a drive records.

use crate::report::reproduction::checks::numbers;
use stiction_files::reproduce_file::ReproduceFile;
use stiction_files::symbols;
use stiction_number::Percent;
use stiction_report::{Align, Document, Table, number};
use stiction_workflows::reproduce::{Measured, PARAMETERS, Paper, Searched, annealing};

pub(super) fn sections(document: Document, file: &ReproduceFile, paper: &Paper) -> Document {
    if paper.measured.is_empty() {
        return document;
    }
    document
        .heading(2, "From an encoder and with noise")
        .paragraph(
            "The simulation has velocity and acceleration exactly, a drive has not. The same steps from positions of the \
             encoder, with noise of half a step before it, and a force with noise of 1 % of the static level: velocity and \
             acceleration follow from the positions, and everything passes the same low-pass filters, whose cut-offs are \
             chosen from the record as for the log of any drive. Least squares follow each search. What is allowed is what \
             encoder and noise allow, but not less than 1 %: bias and four deviations of what least squares from the true \
             parameters find on twenty other draws of the noise. A bias that is large shows that the encoder is too coarse for \
             the motion; stiction identify corrects for it. What six at once know of σ₂ is little, since the motion is slow.",
        )
        .block(numbers(file, "measured"))
        .block(table(paper))
}

/// What a step of the identification makes of a draw.
type Step = fn(&Measured) -> &Searched;

fn table(paper: &Paper) -> Table {
    let columns = [
        ("Parameter", Align::Left),
        ("True", Align::Right),
        ("Static then dynamic: exact, worst", Align::Right),
        ("encoder, median error", Align::Right),
        ("worst", Align::Right),
        ("Six at once: exact, worst", Align::Right),
        ("encoder, median error", Align::Right),
        ("worst", Align::Right),
    ];
    let worst = |all: Option<&Vec<Searched>>| {
        let all = all.map_or(&[][..], Vec::as_slice);
        paper.worst(annealing(all).map(|s| &s.found))
    };
    let dynamics = paper.dynamics.as_ref();
    let six = worst(dynamics.map(|d| &d.six));
    let two = worst(dynamics.map(|d| &d.two));
    let steady = worst(paper.statics.as_ref().map(|s| &s.searches));
    PARAMETERS
        .iter()
        .fold(Table::new(columns), |table, name| {
            let truth = paper.stage.true_value(name);
            let off = |found: &[(_, f64)]| {
                let value = found.iter().find(|(n, _)| n == name);
                value.map(|(_, x): &(_, f64)| 100.0 * (x / truth - 1.0))
            };
            let (exact, step): (_, Step) = match *name {
                "sigma0" | "sigma1" => (&two, |m| &m.two),
                _ => (&steady, |m| &m.statics),
            };
            let spread = |step: Step| {
                let errors = paper.measured.iter().filter_map(|m| off(&step(m).found));
                let mut errors: Vec<f64> = errors.map(f64::abs).collect();
                errors.sort_by(f64::total_cmp);
                let at = |i: usize| errors.get(i).copied();
                let last = errors.len().saturating_sub(1);
                [at(last / 2), at(last)]
            };
            let cell = |percent: Option<f64>| {
                percent.map_or("–".into(), |x| Percent::error(x.abs()).digits(2))
            };
            let two = spread(step).map(cell);
            let all = spread(|m| &m.six).map(cell);
            let exact = off(exact);
            let [two_median, two_worst] = two;
            let [all_median, all_worst] = all;
            table.row([
                symbols::symbol(name),
                number::sig(truth, 5),
                cell(exact),
                two_median,
                two_worst,
                cell(off(&six)),
                all_median,
                all_worst,
            ])
        })
        .caption("Errors of the parameters without their sign.")
}
