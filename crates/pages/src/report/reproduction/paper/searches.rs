//! The searches: how J falls, how the methods compare over all seeds, what they found.

use super::drawings;
use crate::report::reproduction::checks::numbers;
use stiction_files::reproduce_file::ReproduceFile;
use stiction_files::symbols;
use stiction_number::Percent;
use stiction_report::{Align, Axis, Color, Document, Figure, Layer, Panel, Table, number};
use stiction_workflows::reproduce::{
    Dynamics, PARAMETERS, Paper, REACHED, Searched, Statics, annealing,
};

/// Methods by name with the colour of their lines.
const METHODS: [(&str, &str, Color); 3] = [
    ("ga", "Plain", Color::Grey),
    ("adaptive-ga", "Adaptive", Color::Orange),
    ("annealing-ga", "Annealing", Color::Blue),
];

/// Evaluations of the first population, and points of a curve over them.
const FIRST: f64 = 50.0;
const POINTS: usize = 100;

pub(super) fn sections(
    document: Document,
    file: &ReproduceFile,
    paper: &Paper,
    statics: &Statics,
    dynamics: &Dynamics,
) -> Document {
    let steps = [
        ("Static step: Fc, Fs, vs, σ₂", &statics.searches),
        ("Dynamic step: σ₀, σ₁", &dynamics.two),
        ("All six at once", &dynamics.six),
    ];
    let document = document
        .heading(2, "The searches")
        .paragraph(
            "J is the mean square of what the model leaves over that of the force. The static step, the dynamic step and all \
             six parameters at once, these from the record of the dynamic test, are searched by each method with each seed. \
             The paper names a module for the precision of the optimum after its annealing search and does not describe it; \
             least squares from the best points that the search found, apart from each other, stand for it here, after that \
             search only. Of the numbers that are checked the worst of all seeds is taken.",
        )
        .block(drawings::search())
        .block(numbers(file, "six"))
        .block(convergence(&steps))
        .block(methods(&steps));
    let document = steps.iter().fold(document, |document, (title, all)| {
        document.block(beside(title, all))
    });
    document
        .paragraph(claims(&steps))
        .block(values(paper, statics, dynamics))
}

/// What is searched, in words, and all searches of it.
type Step<'a> = (&'static str, &'a Vec<Searched>);

/// The first seed of the annealing search.
fn convergence(steps: &[Step]) -> Figure {
    let figure = Figure::new("Convergence of J, annealing search alone, first seed (FIG. 4–6)");
    let figure = steps.iter().fold(figure, |figure, (title, all)| {
        let panel = Panel::new(Axis::new("Evaluations", ""), Axis::new("J", "").log());
        let panel = panel.title(*title).height(150.0);
        let Some(search) = annealing(all).next() else {
            return figure.panel(panel);
        };
        let (x, y): (Vec<f64>, Vec<f64>) = search.course.iter().copied().unzip();
        let (at, ends): (Vec<f64>, Vec<f64>) = search.rounds.iter().copied().unzip();
        let ends = Layer::points(at, ends).color(Color::Vermilion).width(6.0);
        figure.panel(
            panel
                .layer(Layer::steps(x, y).color(Color::Blue))
                .layer(ends.opacity(1.0).label("End of a round")),
        )
    });
    figure.caption(
        "After each round the population is drawn anew in a box of half the width: where a curve falls in a step just after a \
         mark, the smaller box did it.",
    )
}

/// J over evaluations by each method: the median of the seeds and their quartiles.
fn methods(steps: &[Step]) -> Figure {
    let figure = Figure::new("Plain, adaptive and annealing search (FIG. 7)");
    let figure = steps.iter().fold(figure, |figure, (title, all)| {
        let until = all.iter().filter_map(|s| s.course.last());
        let until = until.fold(2.0 * FIRST, |most, (n, _)| most.max(*n));
        let grid =
            (0..POINTS).map(|i| FIRST * (until / FIRST).powf(i as f64 / (POINTS - 1) as f64));
        let grid: Vec<f64> = grid.collect();
        let axes = [Axis::new("Evaluations", "").log(), Axis::new("J", "").log()];
        let [x, y] = axes;
        let panel = Panel::new(x, y).title(*title).height(180.0);
        let panel = METHODS.iter().fold(panel, |panel, (method, label, color)| {
            let at = grid
                .iter()
                .map(|n| quartiles(of(all, method).map(|s| by_then(s, *n))));
            let at: Vec<[f64; 3]> = at.collect();
            let line = |i: usize| at.iter().map(|q| q[i]).collect::<Vec<f64>>();
            let band = Layer::band(grid.clone(), line(0), line(2)).color(*color);
            let median = Layer::line(grid.clone(), line(1)).color(*color);
            panel.layer(band).layer(median.label(*label))
        });
        figure.panel(panel.layer(Layer::hline(REACHED[0]).color(Color::Ink)))
    });
    figure.caption(
        "Median of all seeds, and the quartiles as a band, without the least squares that follow. The horizontal line is \
         J = 0.003.",
    )
}

fn of<'s>(all: &'s [Searched], method: &str) -> impl Iterator<Item = &'s Searched> {
    all.iter().filter(move |s| s.method == method)
}

/// The least J after so many evaluations.
fn by_then(search: &Searched, evaluations: f64) -> f64 {
    let course = search.course.iter().take_while(|(n, _)| *n <= evaluations);
    let first = search
        .course
        .first()
        .map_or(f64::INFINITY, |(_, cost)| *cost);
    course.last().map_or(first, |(_, cost)| *cost)
}

/// Lower quartile, median and upper quartile, each the lower of two; infinite values count.
fn quartiles(values: impl Iterator<Item = f64>) -> [f64; 3] {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let last = values.len().saturating_sub(1);
    [1, 2, 3].map(|q| values.get(q * last / 4).copied().unwrap_or(f64::NAN))
}

/// Evaluations to a J; infinite where it was not reached.
fn to(all: &[Searched], method: &str, target: f64) -> [f64; 3] {
    quartiles(of(all, method).map(|s| s.evaluations_to(target).unwrap_or(f64::INFINITY)))
}

fn at_the_end(all: &[Searched], method: &str) -> [f64; 3] {
    quartiles(of(all, method).map(Searched::cost))
}

fn beside(title: &str, all: &[Searched]) -> Table {
    let columns = [
        ("Search", Align::Left),
        ("Seeds", Align::Right),
        ("Evaluations to J = 0.003", Align::Right),
        ("J at the end", Align::Right),
        ("the worst", Align::Right),
    ];
    let table = Table::new(columns).caption(format!(
        "{title}, each method by itself: median, and quartiles in brackets."
    ));
    let spread = |[low, middle, high]: [f64; 3], text: fn(f64) -> String| match low < high {
        true => format!("{} ({} to {})", text(middle), text(low), text(high)),
        false => text(middle),
    };
    METHODS.iter().fold(table, |table, (method, label, _)| {
        let worst = of(all, method).map(Searched::cost).fold(0.0, f64::max);
        let two = |x: f64| number::sig(x, 2);
        table.row([
            (*label).to_string(),
            of(all, method).count().to_string(),
            spread(to(all, method, REACHED[0]), evaluations),
            spread(at_the_end(all, method), two),
            number::sig(worst, 2),
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

/// The paper's two claims about its search, and which of them holds here.
fn claims(steps: &[Step]) -> String {
    let names = ["static step", "dynamic step", "six at once"];
    let ranked = |of: &dyn Fn(&[Searched], &str) -> f64| {
        let each = names.iter().zip(steps).map(|(name, (_, all))| {
            let mut order =
                METHODS.map(|(method, label, _)| (of(all, method), label.to_lowercase()));
            order.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut words = format!("{name}: {}", order[0].1);
            for pair in order.windows(2) {
                // Those that share a rank began with the same population.
                let between = if pair[0].0 == pair[1].0 {
                    " and "
                } else {
                    ", "
                };
                words.push_str(between);
                words.push_str(&pair[1].1);
            }
            words
        });
        each.collect::<Vec<String>>().join("; ")
    };
    format!(
        "The paper makes two claims about its annealing search: it is \u{201c}faster and more accurate\u{201d} (its section 3), and its \
         convergence \u{201c}surpasses the adaptive algorithm, still lags behind the conventional\u{201d} one (its section 6). Here, by the \
         medians above, the first to J = 0.003 are, in this order, {}. Lowest at the end are {}. What annealing gains it \
         gains after the ends of rounds, in a smaller box. No genetic search by itself finds all six parameters; other \
         methods do (docs/searches.md).",
        ranked(&|all, method| to(all, method, REACHED[0])[1]),
        ranked(&|all, method| at_the_end(all, method)[1]),
    )
}

fn values(paper: &Paper, statics: &Statics, dynamics: &Dynamics) -> Table {
    let columns = [
        ("Parameter", Align::Left),
        ("True", Align::Right),
        ("Static then dynamic: worst of all seeds", Align::Right),
        ("with least squares", Align::Right),
        ("Six at once: worst of all seeds", Align::Right),
        ("with least squares", Align::Right),
        ("Unit", Align::Left),
    ];
    let worst = |all: &[Searched]| {
        [
            paper.worst(annealing(all).map(|s| &s.own)),
            paper.worst(annealing(all).map(|s| &s.found)),
        ]
    };
    let [steady, two, six] = [&statics.searches, &dynamics.two, &dynamics.six].map(|a| worst(a));
    let table = Table::new(columns)
        .caption("What the annealing search found by itself, and after least squares.");
    let units = paper.stage.units();
    PARAMETERS.iter().fold(table, |table, name| {
        let by_steps = match *name {
            "sigma0" | "sigma1" => &two,
            _ => &steady,
        };
        let truth = paper.stage.true_value(name);
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
            cell(&by_steps[0]),
            cell(&by_steps[1]),
            cell(&six[0]),
            cell(&six[1]),
            number::unit(units.of_parameter(name)),
        ])
    })
}
