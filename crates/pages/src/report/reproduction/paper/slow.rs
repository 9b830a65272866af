//! Crawling at low speed, and the sine over the stiffness of the bristles.

use super::simulated::{axis, over_time};
use stiction_number::{Percent, quantity};
use stiction_report::{Align, Color, Document, Figure, Layer, Panel, Table, number};
use stiction_workflows::reproduce::{Compensation, Crawled, Paper, Pull, Stage, Stiffness, Units};

/// Colours from soft to stiff.
const COLORS: [Color; 4] = [Color::Vermilion, Color::Orange, Color::Green, Color::Blue];

/// Deflections at break-away that the loops are shown for.
const SHOWN: f64 = 20.0;

pub(super) fn sections(mut document: Document, paper: &Paper) -> Document {
    let units = paper.stage.units();
    if !paper.crawled.is_empty() {
        document = document
            .heading(2, "Crawling at low speed")
            .paragraph(
                "A reference of constant low velocity for 3 s pulls the axis by a spring with a damper, and then the controllers \
                 do. Below the Stribeck velocity friction falls as the speed rises: a soft drive lets the axis stick and slip, \
                 a stiff one does not. The force of the law at the reference velocity takes the load off the spring; it does \
                 not take away that friction falls.",
            )
            .block(crawl(&paper.crawled, &paper.stage))
            .block(evenness(&paper.crawled, &paper.stage));
    }
    if !paper.stiffnesses.is_empty() {
        document = document
            .heading(2, "The stiffness of the bristles")
            .paragraph(
                "The same sine with bristles from soft to stiff, all other parameters as they are, under the fuzzy PID. The \
                 compensation keeps the law that was identified at the stiffness of the axis. With the published step of \
                 0.1 ms ode4 is stable only to some stiffness, which depends on the speed; beyond it nothing was run.",
            )
            .block(stiffness(&paper.stiffnesses, units))
            .block(loops(&paper.stiffnesses, paper.stage.truth.law.bound(), units));
    }
    document
}

/// What pulls, for tables and legends.
fn pulled(run: &Crawled, stage: &Stage) -> String {
    match run.pull {
        Pull::Spring(stiffness) => format!("Spring, {}", stiff(stiffness, stage.units())),
        Pull::Control(control) => {
            format!(
                "{}, {}",
                control.name(),
                quantity(stage.bandwidths()[0], "Hz")
            )
        }
    }
}

/// A stiffness with a prefix: `29.4 kN/m`.
fn stiff(x: f64, units: Units) -> String {
    let (factor, prefix) = match x {
        x if x < 1e3 => (1.0, ""),
        x if x < 1e6 => (1e-3, "k"),
        _ => (1e-6, "M"),
    };
    let unit = number::unit(units.stiffness);
    format!("{} {prefix}{unit}", number::sig(factor * x, 3))
}

fn crawl(runs: &[Crawled], stage: &Stage) -> Figure {
    let units = stage.units();
    let bare = |c: &&Crawled| c.compensation == Compensation::Nothing;
    let springs: Vec<&Crawled> = runs.iter().filter(bare).collect();
    // The softest, the last that rests, the first that does not, and the fuzzy PID.
    let rests = springs.iter().rposition(|c| c.crawl.rest_share > 0.0);
    let last = springs.len().saturating_sub(1);
    let mut shown = vec![0];
    shown.extend(rests);
    shown.extend(rests.map(|i| (i + 1).min(last)));
    shown.push(last);
    shown.sort_unstable();
    shown.dedup();
    let mut position = over_time("Position", units.length).height(200.0);
    let mut velocity = over_time("Velocity", units.speed).height(200.0);
    if let Some(first) = springs.first() {
        let reference = Layer::line(first.time.clone(), first.position[0].clone());
        position = position.layer(reference.color(Color::Grey).label("Reference"));
    }
    for (i, color) in shown.into_iter().zip(COLORS) {
        let run = springs[i];
        let line = |y: &[f64]| Layer::line(run.time.clone(), y).color(color);
        position = position.layer(line(&run.position[1]).label(pulled(run, stage)));
        velocity = velocity.layer(line(&run.velocity));
    }
    Figure::new("Low speed: stick and slip on a soft spring")
        .panel(position)
        .panel(velocity)
        .shared_x()
        .caption("Without compensation.")
}

fn evenness(runs: &[Crawled], stage: &Stage) -> Table {
    let columns = [
        ("Pulled by", Align::Left),
        ("At rest, without", Align::Right),
        ("with LuGre", Align::Right),
        ("Ripple of the velocity, without", Align::Right),
        ("with LuGre", Align::Right),
    ];
    let table = Table::new(columns).caption(
        "From the middle of the constant velocity on: part of the time below a tenth of the velocity, and rms \
         deviation of the velocity over it. The law is driven by the reference velocity.",
    );
    let percent = |x: f64| Percent::error(100.0 * x).digits(2);
    runs.chunks(2).fold(table, |table, pair| {
        let [without, with] = pair else { return table };
        table.row([
            pulled(without, stage),
            percent(without.crawl.rest_share),
            percent(with.crawl.rest_share),
            percent(without.crawl.ripple),
            percent(with.crawl.ripple),
        ])
    })
}

fn stiffness(runs: &[Stiffness], units: Units) -> Table {
    let columns = [
        ("σ₀", Align::Right),
        ("ode4 at 0.1 ms", Align::Left),
        ("Largest error at reversals, without", Align::Right),
        ("with the law identified", Align::Right),
    ];
    runs.iter().fold(Table::new(columns), |table, run| {
        let [without, with] = run.reversal_peak;
        let error = |x: f64| match run.unstable {
            None => quantity(x, units.length),
            Some(_) => "–".into(),
        };
        table.row([
            stiff(run.sigma0, units),
            match run.unstable {
                None => "stable".into(),
                Some(step) => format!("unstable: at most {}", quantity(step, "s")),
            },
            error(without),
            error(with),
        ])
    })
}

/// About the first reversal; `presliding` is the deflection at break-away of the axis.
fn loops(runs: &[Stiffness], presliding: f64, units: Units) -> Figure {
    let panel = Panel::new(
        axis("Position less that of the reversal", units.length)
            .range(-SHOWN * presliding, presliding),
        axis("Friction", units.force),
    );
    let stable = runs.iter().filter(|r| r.unstable.is_none());
    let panel = stable.zip(COLORS).fold(panel, |panel, (run, color)| {
        let [position, friction] = &run.friction;
        let turn = position.iter().copied().fold(f64::MIN, f64::max);
        let x: Vec<f64> = position.iter().map(|p| p - turn).collect();
        let line = Layer::line(x, friction.clone()).color(color);
        panel.layer(line.label(stiff(run.sigma0, units)))
    });
    Figure::new("Friction over displacement at a reversal, by the stiffness of the bristles")
        .panel(panel)
}
