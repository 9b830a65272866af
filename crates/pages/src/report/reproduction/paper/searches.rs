//! The searches: how J falls, what they found, how the methods compare over all seeds.

use super::drawings;
use crate::report::reproduction::checks::numbers;
use stiction_files::reproduce_file::ReproduceFile;
use stiction_files::symbols;
use stiction_number::Percent;
use stiction_report::{Align, Axis, Color, Document, Figure, Layer, Panel, Table, number};
use stiction_workflows::reproduce::{Dynamics, PARAMETERS, Paper, REACHED, Searched, Statics};

/// Evaluations after which the searches are compared early.
const EARLY: f64 = 500.0;

/// Methods by name with the colour of their lines.
const METHODS: [(&str, &str, Color); 3] = [
    ("ga", "Genetic", Color::Grey),
    ("adaptive-ga", "Adaptive", Color::Orange),
    ("annealing-ga", "Annealing", Color::Blue),
];

pub(super) fn sections(
    document: Document,
    file: &ReproduceFile,
    paper: &Paper,
    statics: &Statics,
    dynamics: &Dynamics,
) -> Document {
    document
        .heading(2, "The searches")
        .paragraph(
            "J is the mean square of what the model leaves over that of the force. All six parameters at once \
             are searched from the record of the dynamic test by each method, with each seed. The paper names a module for \
             the precision of the optimum after its annealing search and does not describe it; least squares from the \
             best that the search found stand for it here, after that search only. Of the numbers that are checked the \
             worst of all seeds is taken.",
        )
        .block(drawings::search())
        .block(numbers(file, "six"))
        .block(convergence(statics, dynamics))
        .block(methods(dynamics))
        .block(beside(dynamics))
        .paragraph(convergence_claim(dynamics))
        .block(values(paper, statics, dynamics))
}

/// A course as steps, and its end drawn on to `until`.
fn course(search: &Searched, until: f64) -> Layer {
    let (mut x, mut y): (Vec<f64>, Vec<f64>) = search.course.iter().copied().unzip();
    if let Some(last) = y.last().copied() {
        x.push(until);
        y.push(last);
    }
    Layer::steps(x, y)
}

/// Where its rounds end, or its last new best if that comes later.
fn end(search: &Searched) -> f64 {
    let last = |course: &[(f64, f64)]| course.last().map_or(0.0, |(n, _)| *n);
    last(&search.course).max(last(&search.rounds))
}

fn convergence(statics: &Statics, dynamics: &Dynamics) -> Figure {
    let searches = [
        ("Static: Fc, Fs, vs, σ₂", vec![&statics.search]),
        ("Dynamic: σ₀, σ₁", vec![&dynamics.two]),
        ("All six, every seed", dynamics.annealing().collect()),
    ];
    let figure = Figure::new("Convergence of J, annealing search alone (FIG. 4–6)");
    let figure = searches.into_iter().fold(figure, |figure, (title, all)| {
        let panel = Panel::new(Axis::new("Evaluations", ""), Axis::new("J", "").log());
        let panel = panel.title(title).height(150.0);
        let panel = all.iter().fold(panel, |panel, search| {
            panel.layer(course(search, end(search)).color(Color::Blue).opacity(0.8))
        });
        let ends = all.iter().flat_map(|s| s.rounds.iter().copied());
        let (x, y): (Vec<f64>, Vec<f64>) = ends.unzip();
        let ends = Layer::points(x, y).color(Color::Vermilion).width(6.0);
        figure.panel(panel.layer(ends.opacity(1.0).label("End of a round")))
    });
    figure.caption(
        "After each round the population is drawn anew in a box of half the width: where a curve falls in a step just after a \
         mark, the smaller box did it.",
    )
}

fn methods(dynamics: &Dynamics) -> Figure {
    let until = dynamics.six.iter().map(end).fold(0.0, f64::max);
    let mut panel = Panel::new(Axis::new("Evaluations", "").log(), Axis::new("J", "").log());
    for (method, label, color) in METHODS {
        for (i, search) in of(dynamics, method).enumerate() {
            let layer = course(search, until).color(color).opacity(0.8);
            panel = panel.layer(if i == 0 { layer.label(label) } else { layer });
        }
    }
    panel = panel.layer(Layer::hline(REACHED).color(Color::Ink).label("J = 0.001"));
    Figure::new("Plain, adaptive and annealing search (FIG. 7)")
        .panel(panel)
        .caption("All six parameters, one line a seed, without the least squares that follow.")
}

fn of<'d>(dynamics: &'d Dynamics, method: &str) -> impl Iterator<Item = &'d Searched> {
    dynamics.six.iter().filter(move |s| s.method == method)
}

/// The middle of values, the lower one of two; infinite ones count.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len().saturating_sub(1) / 2;
    values.get(middle).copied().unwrap_or(f64::NAN)
}

/// Evaluations to J = 0.001 of every seed; infinite where it was not reached.
fn reached(dynamics: &Dynamics, method: &str) -> Vec<f64> {
    let all = of(dynamics, method);
    all.map(|s| s.evaluations_to(REACHED).unwrap_or(f64::INFINITY))
        .collect()
}

/// J of every seed after a few evaluations.
fn early(dynamics: &Dynamics, method: &str) -> Vec<f64> {
    let all = of(dynamics, method);
    let by_then = |s: &Searched| {
        let course = s.course.iter().take_while(|(n, _)| *n <= EARLY);
        course.last().map_or(f64::INFINITY, |(_, cost)| *cost)
    };
    all.map(by_then).collect()
}

fn beside(dynamics: &Dynamics) -> Table {
    let columns = [
        ("Search", Align::Left),
        ("Seeds", Align::Right),
        ("J after 500 evaluations, median", Align::Right),
        ("Evaluations to J = 0.001, median", Align::Right),
        ("the slowest", Align::Right),
        ("J at the end, median", Align::Right),
        ("the worst", Align::Right),
    ];
    let table = Table::new(columns).caption("All six at once, each method by itself.");
    METHODS.iter().fold(table, |table, (method, label, _)| {
        let reached = reached(dynamics, method);
        let costs: Vec<f64> = of(dynamics, method).map(Searched::cost).collect();
        let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
        table.row([
            (*label).to_string(),
            costs.len().to_string(),
            number::sig(median(early(dynamics, method)), 2),
            evaluations(median(reached.clone())),
            evaluations(largest(&reached)),
            number::sig(median(costs.clone()), 2),
            number::sig(largest(&costs), 2),
        ])
    })
}

/// A number of evaluations.
fn evaluations(n: f64) -> String {
    match n.is_finite() {
        true => number::count(n as u64),
        false => "not reached".into(),
    }
}

/// What the paper shows its search for, and what came out here.
fn convergence_claim(dynamics: &Dynamics) -> String {
    let [plain, adaptive, annealing] =
        METHODS.map(|(method, _, _)| median(early(dynamics, method)));
    let first = match annealing > plain.min(adaptive) {
        true => {
            "It is behind early, since ranks press less towards the best than the roulette of the others and annealing keeps \
                 what is worse"
        }
        false => "Early it is not behind",
    };
    let early = format!(
        "{first}: after {EARLY} evaluations J is {} in the median of the seeds, that of the plain search {}, of the \
         adaptive one {}.",
        number::sig(annealing, 2),
        number::sig(plain, 2),
        number::sig(adaptive, 2)
    );
    let [plain, adaptive, annealing] = METHODS.map(|(method, _, _)| {
        let costs = of(dynamics, method).map(Searched::cost).collect();
        median(costs)
    });
    let late = match annealing < plain.min(adaptive) {
        true => "At the end it is ahead",
        false => "At the end it is not ahead",
    };
    format!(
        "The paper presents its annealing search as the best of the three (FIG. 7); by how much stands only in its \
         pictures. {early} {late}: J is {}, that of the plain search {}, of the adaptive one {}. What it gains it gains \
         after the ends of rounds, in a smaller box. No genetic search by itself finds all six parameters; other methods \
         do (docs/searches.md).",
        number::sig(annealing, 2),
        number::sig(plain, 2),
        number::sig(adaptive, 2)
    )
}

fn values(paper: &Paper, statics: &Statics, dynamics: &Dynamics) -> Table {
    let columns = [
        ("Parameter", Align::Left),
        ("True", Align::Right),
        ("Static then dynamic", Align::Right),
        ("with least squares", Align::Right),
        ("Six at once: worst of all seeds", Align::Right),
        ("with least squares", Align::Right),
        ("Unit", Align::Left),
    ];
    let own = paper.worst(dynamics.annealing().map(|s| &s.own));
    let found = paper.worst(dynamics.annealing().map(|s| &s.found));
    let table = Table::new(columns)
        .caption("What the annealing search found by itself, and after least squares.");
    let units = paper.stage.units();
    PARAMETERS.iter().fold(table, |table, name| {
        let two = match *name {
            "sigma0" | "sigma1" => &dynamics.two,
            _ => &statics.search,
        };
        let truth = paper.true_value(name);
        let cell = |all: &[(_, f64)]| {
            let value = all.iter().find(|(n, _)| n == name);
            value.map_or("–".into(), |(_, x): &(_, f64)| {
                let off = Percent::error(100.0 * (x / truth - 1.0)).digits(2);
                format!("{} ({off})", number::sig(*x, 4))
            })
        };
        table.row([
            symbols::symbol(name),
            number::sig(truth, 4),
            cell(&two.own),
            cell(&two.found),
            cell(&own),
            cell(&found),
            number::unit(units.of_parameter(name)),
        ])
    })
}
