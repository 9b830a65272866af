//! What was identified: map, static and dynamic parameters, searches, step response.

use super::simulated::axis;
use super::{drawings, measured, searches};
use crate::report::reproduction::checks::numbers;
use stiction_files::reproduce_file::ReproduceFile;
use stiction_files::symbols;
use stiction_friction::LuGre;
use stiction_log::Motion;
use stiction_number::Percent;
use stiction_report::{Align, Axis, Color, Dash, Document, Figure, Layer, Panel, Table, number};
use stiction_workflows::reproduce::{Outliers, Paper, Presliding, Statics, Units};

pub(super) fn sections(mut document: Document, file: &ReproduceFile, paper: &Paper) -> Document {
    let Some(statics) = &paper.statics else {
        return document;
    };
    document = document
        .block(drawings::law())
        .heading(2, "Static parameters")
        .block(numbers(file, "static"));
    if !statics.left_out.is_empty() {
        document = document.paragraph(left_out(statics, paper.stage.units()));
    }
    document = document
        .block(map(paper, statics))
        .paragraph(
            "Two runs that went wrong, such as one that something held up, kept in the data: the mean square of the paper follows \
             them, the robust loss of stiction identify --method static does not.",
        )
        .block(outliers(paper, &statics.outliers))
        .block(stribeck(&paper.stage.truth.law, paper.stage.units()));
    let Some(dynamics) = &paper.dynamics else {
        return document;
    };
    document = document
        .heading(2, "Dynamic parameters")
        .block(numbers(file, "dynamic"));
    document = searches::sections(document, file, paper, statics, dynamics);
    document = measured::sections(document, file, paper);
    match &paper.presliding {
        Some(step) => document
            .heading(2, "Presliding")
            .block(numbers(file, "step"))
            .paragraph(inversion(paper, step))
            .block(response(step, paper.stage.units())),
        None => document,
    }
}

/// The runs that are no points of the map.
fn left_out(statics: &Statics, units: Units) -> String {
    let each = statics.left_out.iter().map(|run| {
        let velocity = number::quantity(run.velocity, units.speed);
        format!("{velocity}, {}", run.reason.name())
    });
    format!(
        "Left out, as the loop does not hold a steady velocity there, which is the stick-slip that the paper compensates: {}. \
         Their mean force is no point of the steady curve.",
        each.collect::<Vec<String>>().join("; ")
    )
}

/// The parameters that two bad runs leave to either cost.
fn outliers(paper: &Paper, outliers: &Outliers) -> Table {
    let columns = [
        ("Parameter", Align::Left),
        ("True", Align::Right),
        ("Mean square", Align::Right),
        ("Robust loss", Align::Right),
        ("Unit", Align::Left),
    ];
    let units = paper.stage.units();
    outliers.plain.iter().zip(&outliers.robust).fold(
        Table::new(columns),
        |table, ((name, plain), (_, robust))| {
            let name = name.to_string();
            let truth = paper.stage.true_value(&name);
            let cell = |x: f64| {
                let off = Percent::error(100.0 * (x / truth - 1.0)).signed(2);
                format!("{} ({off})", number::sig(x, 4))
            };
            table.row([
                symbols::symbol(&name),
                number::sig(truth, 4),
                cell(*plain),
                cell(*robust),
                number::unit(units.of_parameter(&name)),
            ])
        },
    )
}

/// Steady friction of a law over velocities, N.
fn steady(law: &LuGre<f64>, speeds: &[f64]) -> Vec<f64> {
    speeds.iter().map(|v| law.curve().force(*v)).collect()
}

/// Velocities from `low` to `high`, without standstill.
fn speeds(low: f64, high: f64) -> Vec<f64> {
    let at = |k: i32| low + (high - low) * f64::from(k) / 800.0;
    (0..=800).map(at).filter(|v| *v != 0.0).collect()
}

fn map(paper: &Paper, statics: &Statics) -> Figure {
    let units = paper.stage.units();
    let top = statics
        .points
        .iter()
        .fold(0.0_f64, |m, p| m.max(p.velocity));
    let slow = paper.stage.truth.law.curve().positive().stribeck_velocity;
    let panel = |title: &str, reach: f64| {
        let v = speeds(-reach, reach);
        let runs = statics.points.iter().map(|p| (p.velocity, p.force));
        let shown: (Vec<f64>, Vec<f64>) = runs.filter(|(v, _)| v.abs() <= reach).unzip();
        let mut panel = Panel::new(axis("Velocity", units.speed), axis("Friction", units.force))
            .title(title)
            .layer(
                Layer::line(v.clone(), steady(&paper.stage.truth.law, &v))
                    .color(Color::Grey)
                    .label("True"),
            );
        if let Some(law) = &paper.law {
            let line = Layer::line(v.clone(), steady(law, &v)).dash(Dash::Dashed);
            panel = panel.layer(line.color(Color::Blue).label("Identified"));
        }
        let out = statics.left_out.iter().map(|run| (run.velocity, run.force));
        let out: (Vec<f64>, Vec<f64>) = out.filter(|(v, _)| v.abs() <= reach).unzip();
        let points = |(x, y): (Vec<f64>, Vec<f64>)| Layer::points(x, y).width(6.0).opacity(1.0);
        panel = panel.layer(points(shown).color(Color::Vermilion).label("Runs"));
        match out.0.is_empty() {
            true => panel,
            false => panel.layer(points(out).color(Color::Sky).label("Left out")),
        }
    };
    Figure::new("Friction over velocity (FIG. 12)")
        .panel(panel("", top))
        .panel(panel("Low speeds", 3.5 * slow))
        .caption("Mean control force of each run at constant velocity.")
}

fn stribeck(law: &LuGre<f64>, units: Units) -> Figure {
    let side = law.curve().positive();
    let v = speeds(0.0, 10.0 * side.stribeck_velocity);
    let viscous: Vec<f64> = v.iter().map(|v| side.viscous * v).collect();
    let line = |y: Vec<f64>| Layer::line(v.clone(), y);
    let panel = Panel::new(
        axis("Velocity", units.speed),
        axis("Friction", units.force).range(0.0, 1.1 * side.static_friction),
    )
    .layer(line(steady(law, &v)).color(Color::Blue).label("Whole"))
    .layer(line(viscous).color(Color::Orange).label("Viscous"))
    .layer(Layer::hline(side.coulomb).color(Color::Green).label("Fc"))
    .layer(
        Layer::hline(side.static_friction)
            .color(Color::Vermilion)
            .dash(Dash::Dashed)
            .label("Fs"),
    )
    .layer(
        Layer::vline(side.stribeck_velocity)
            .color(Color::Sky)
            .label("vs"),
    );
    Figure::new("The Stribeck curve of the axis (FIG. 1)").panel(panel)
}

fn inversion(paper: &Paper, step: &Presliding) -> String {
    let units = paper.stage.units();
    let off = |found: f64, name: &str| {
        let true_value = paper.stage.true_value(name);
        Percent::error(100.0 * (found / true_value - 1.0)).signed(1)
    };
    let overshoot = step.overshoot.map_or(String::new(), |part| {
        format!(", {} overshoot", Percent::error(100.0 * part).digits(3))
    });
    let damping = match step.inverted.sigma1 {
        Some(s1) => format!(
            " and {} {} {} ({})",
            symbols::meaning("sigma1", Motion::Linear).to_lowercase(),
            number::sig(s1, 4),
            number::unit(units.damping),
            off(s1, "sigma1")
        ),
        None => String::new(),
    };
    format!(
        "A step of {} settles at {}{overshoot}. The paper takes the axis for a second-order system, which \
         gives {} {} {} ({}){damping}: the bristles slip long before break-away, which that leaves out. The \
         numbers above are of a simulation of mass and law fitted to the response.",
        number::quantity(step.height, units.force),
        number::quantity(step.settled, units.length),
        symbols::meaning("sigma0", Motion::Linear).to_lowercase(),
        number::sig(step.inverted.sigma0, 4),
        number::unit(units.stiffness),
        off(step.inverted.sigma0, "sigma0"),
    )
}

fn response(step: &Presliding, units: Units) -> Figure {
    let time: Vec<f64> = step.series.time.iter().map(|t| t - step.onset).collect();
    let panel = Panel::new(
        Axis::new("Time after the step", "s"),
        axis("Displacement", units.length),
    )
    .layer(
        Layer::line(time.clone(), step.series.measured.clone())
            .color(Color::Grey)
            .width(3.0)
            .label("Simulated axis"),
    )
    .layer(
        Layer::line(time, step.series.model.clone())
            .color(Color::Blue)
            .dash(Dash::Dashed)
            .label("Fitted"),
    );
    Figure::new("Response to a voltage step below break-away (FIG. 16)").panel(panel)
}
