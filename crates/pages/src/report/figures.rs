//! The figures of the report.

use std::ops::Range;
use stiction_files::symbols;
use stiction_identify::{Effect, Series};
use stiction_parameters::SteadyCurve;
use stiction_report::{Axis, Color, Dash, Figure, Heatmap, Layer, Panel, Text};
use stiction_signal::autocorrelation as correlate;
use stiction_workflows::identify::{Outcome, presliding_length, slowest_turn};

/// Most lags of the autocorrelation that are drawn, samples.
const MOST_LAGS: usize = 200;

/// Fewest samples that are drawn: fewer show nothing.
const FEWEST_SAMPLES_DRAWN: usize = 10;

/// What drives the axis: force, torque, current. The signal of a fit may be the position.
fn driver(outcome: &Outcome) -> &'static str {
    symbols::driver(outcome.motion, &outcome.force_unit)
}

pub(super) fn force_axis(outcome: &Outcome) -> Axis {
    let name = driver(outcome);
    Axis::new(
        format!("{}{}", name[..1].to_uppercase(), &name[1..]),
        outcome.force_unit.as_str(),
    )
}

pub(super) fn friction_axis(outcome: &Outcome) -> Axis {
    Axis::new(
        format!("Friction {}", driver(outcome)),
        outcome.force_unit.as_str(),
    )
}

pub(super) fn velocity_axis(outcome: &Outcome) -> Axis {
    Axis::new("Velocity", symbols::speed_unit(outcome.motion))
}

/// Friction in the measured force: what is left after inertia and the other terms.
fn friction(values: &[f64], series: &Series) -> Vec<f64> {
    values
        .iter()
        .zip(&series.other)
        .map(|(u, o)| u - o)
        .collect()
}

/// Samples before which a line is interrupted: samples were left out there, or a log begins.
pub(super) fn breaks(series: &Series) -> Vec<bool> {
    let n = series.time.len();
    let mut steps: Vec<f64> = series.time.windows(2).map(|t| t[1] - t[0]).collect();
    let usual = if steps.is_empty() {
        0.0
    } else {
        let middle = steps.len() / 2;
        *steps.select_nth_unstable_by(middle, f64::total_cmp).1
    };
    (0..n)
        .map(|i| {
            i > 0
                && (series.log[i] != series.log[i - 1]
                    || series.time[i] - series.time[i - 1] > 1.5 * usual)
        })
        .collect()
}

/// A channel with a hole before each break.
pub(super) fn broken(values: &[f64], breaks: &[bool]) -> Vec<f64> {
    let mut out = Vec::with_capacity(values.len() + 16);
    for (x, &hole) in values.iter().zip(breaks) {
        if hole {
            out.push(f64::NAN);
        }
        out.push(*x);
    }
    out
}

/// Friction over velocity: measured cloud, model, the steady curve with its band.
pub(super) fn velocity_map(outcome: &Outcome) -> Figure {
    let series = &outcome.law().series;
    let holes = breaks(series);
    let [band, curve] = steady_layers(outcome, &series.velocity);
    let panel = Panel::new(velocity_axis(outcome), friction_axis(outcome))
        .layer(
            Layer::points(series.velocity.clone(), friction(&series.measured, series))
                .color(Color::Grey)
                .label("Measured, inertia taken off"),
        )
        .layer(
            Layer::line(
                broken(&series.velocity, &holes),
                broken(&friction(&series.model, series), &holes),
            )
            .color(Color::Blue)
            .width(1.0)
            .opacity(0.7)
            .label("Model along the log"),
        )
        .layer(band)
        .layer(curve)
        .height(320.0);
    Figure::new("Friction over velocity").panel(panel).caption(
        "The steady curve is what the law gives at constant velocity; the model along the log also \
         shows presliding and lag around reversals.",
    )
}

/// The steady curve with its band, over the speeds of a log.
pub(super) fn steady_layers(outcome: &Outcome, velocity: &[f64]) -> [Layer; 2] {
    let top = velocity.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let v: Vec<f64> = grid(top);
    let steady = steady(outcome);
    let curve: Vec<f64> = v.iter().map(|&v| steady.force(v)).collect();
    let band: Vec<f64> = v
        .iter()
        .map(|&v| 1.96 * steady_deviation(outcome, &steady, v))
        .collect();
    let low: Vec<f64> = curve.iter().zip(&band).map(|(f, b)| f - b).collect();
    let high: Vec<f64> = curve.iter().zip(&band).map(|(f, b)| f + b).collect();
    [
        Layer::band(v.clone(), low, high)
            .color(Color::Vermilion)
            .label("95 % band"),
        Layer::line(v, curve)
            .color(Color::Vermilion)
            .width(2.0)
            .label("Steady curve"),
    ]
}

/// Friction by speed with its band.
pub(super) fn friction_curve(outcome: &Outcome) -> Option<Figure> {
    let curve = outcome.result.friction_curve.as_ref();
    let curve = curve.filter(|curve| curve.speed.len() > 1)?;
    let all = [
        (
            &curve.both,
            Color::Green,
            "half of the sum of both directions",
        ),
        (&curve.forward, Color::Blue, "forward"),
        (&curve.back, Color::Vermilion, "back"),
    ];
    let mut panel = Panel::new(
        Axis::new("Speed", curve.speed_unit.as_str()),
        friction_axis(outcome),
    );
    for (band, color, label) in all {
        let Some(band) = band else {
            continue;
        };
        let end = |sign: f64| -> Vec<f64> {
            let both = band.force.iter().zip(&band.repeat);
            both.map(|(force, half)| force + sign * half).collect()
        };
        let x = || curve.speed.clone();
        panel = panel
            .layer(Layer::band(x(), end(-1.0), end(1.0)).color(color))
            .layer(
                Layer::line(x(), band.force.clone())
                    .color(color)
                    .label(label),
            );
    }
    let caption = "In steady sliding, whatever the law. Each direction has the constant force; half of their sum has none. With the 95 % \
                   band for the same test on another day.";
    Some(
        Figure::new("Friction by speed")
            .panel(panel)
            .caption(caption)
            .half(),
    )
}

/// The level of friction along the stroke with its band, where it has a line or a map.
pub(super) fn level_along(outcome: &Outcome) -> Option<Figure> {
    let entries = &outcome.result.level_along;
    let length = symbols::length_unit(outcome.motion);
    let colors = [Color::Blue, Color::Vermilion];
    let mut panel = Panel::new(
        Axis::new("Position", length),
        Axis::new("Coulomb friction", outcome.force_unit.as_str()),
    );
    for (entry, color) in entries.iter().zip(colors) {
        let x = || entry.position.clone();
        let meaning = symbols::meaning(&entry.name, outcome.motion);
        panel = panel
            .layer(Layer::band(x(), entry.low.clone(), entry.high.clone()).color(color))
            .layer(
                Layer::line(x(), entry.level.clone())
                    .color(color)
                    .label(meaning),
            );
    }
    let figure = Figure::new("Coulomb friction along the stroke")
        .panel(panel)
        .half();
    let caption = "With its 95 % band, at each place by itself. Beyond the stroke a compensator holds the level of its end.";
    (!entries.is_empty()).then(|| figure.caption(caption))
}

/// Points dense near zero speed, none at it.
pub(super) fn grid(top: f64) -> Vec<f64> {
    let half: Vec<f64> = (0..160)
        .map(|i| top * (i as f64 / 159.0).powi(3))
        .skip(1)
        .collect();
    half.iter()
        .rev()
        .map(|v| -v)
        .chain(half.iter().copied())
        .collect()
}

/// Steady friction, where load, temperature and position are at their references.
pub(super) fn steady(outcome: &Outcome) -> SteadyCurve {
    SteadyCurve::of(&outcome.law().values())
}

/// Standard deviation of the steady curve, from the covariance of the parameters.
pub(super) fn steady_deviation(outcome: &Outcome, steady: &SteadyCurve, v: f64) -> f64 {
    let covariance = &outcome.law().covariance;
    covariance.deviation(|name| steady.slope(name, v))
}

/// The map near zero speed.
pub(super) fn low_speed(outcome: &Outcome) -> Option<Figure> {
    let series = &outcome.law().series;
    let bound = 2.0 * outcome.law().low_speed_bound;
    let near: Vec<bool> = series.velocity.iter().map(|v| v.abs() <= bound).collect();
    if near.iter().filter(|&&n| n).count() < FEWEST_SAMPLES_DRAWN {
        return None;
    }
    let holes = breaks(series);
    // A gap breaks the line, so that two passes are not joined.
    let pick = |x: &[f64]| -> Vec<f64> {
        x.iter()
            .zip(&near)
            .map(|(x, &n)| if n { *x } else { f64::NAN })
            .collect()
    };
    let panel = Panel::new(
        velocity_axis(outcome).range(-bound, bound),
        friction_axis(outcome),
    )
    .layer(
        Layer::points(
            pick(&series.velocity),
            pick(&friction(&series.measured, series)),
        )
        .color(Color::Grey)
        .label("Measured"),
    )
    .layer(
        Layer::line(
            broken(&pick(&series.velocity), &holes),
            broken(&pick(&friction(&series.model, series)), &holes),
        )
        .color(Color::Blue)
        .label("Model"),
    );
    Some(Figure::new("Near zero speed").panel(panel).half())
}

/// What of a window around a sample goes on without a hole.
fn within(breaks: &[bool], at: usize, window: Range<usize>) -> Range<usize> {
    let before = (window.start..=at.min(window.end)).rev();
    let start = before.into_iter().find(|i| breaks.get(*i) == Some(&true));
    let end = (at + 1..window.end).find(|i| breaks.get(*i) == Some(&true));
    start.unwrap_or(window.start)..end.unwrap_or(window.end)
}

/// Friction over position around the reversal where most is recorded.
pub(super) fn presliding(outcome: &Outcome) -> Option<Figure> {
    let series = &outcome.law().series;
    let length = symbols::length_unit(outcome.motion);
    let way = presliding_length(&outcome.law().values()).unwrap_or(0.0);
    let (turn, window) = slowest_turn(&series.velocity, &series.position, way)?;
    let window = within(&breaks(series), turn, window);
    if window.len() < FEWEST_SAMPLES_DRAWN || !outcome.law().law.kind.has_bristle() {
        return None;
    }
    let origin = series.position.get(turn).copied().unwrap_or(0.0);
    let x: Vec<f64> = series.position[window.clone()]
        .iter()
        .map(|x| x - origin)
        .collect();
    let measured = friction(&series.measured, series)[window.clone()].to_vec();
    let model = friction(&series.model, series)[window].to_vec();
    let panel = Panel::new(
        Axis::new("Position from the reversal", length),
        friction_axis(outcome),
    )
    .layer(
        Layer::line(x.clone(), measured)
            .color(Color::Grey)
            .label("Measured"),
    )
    .layer(Layer::line(x, model).color(Color::Blue).label("Model"));
    let figure = Figure::new("Presliding around a reversal");
    Some(figure.panel(panel).half())
}

/// Measured, model and residual in time.
pub(super) fn time(outcome: &Outcome) -> Figure {
    in_time(outcome, &outcome.law().series, "Force in time")
}

/// The same on data that were not fitted.
pub(super) fn validation(outcome: &Outcome, path: &str, series: &Series) -> Figure {
    in_time(outcome, series, &format!("Validation: {path}"))
}

fn in_time(outcome: &Outcome, series: &Series, title: &str) -> Figure {
    let holes = breaks(series);
    let time = broken(&clock(series), &holes);
    let line = |values: &[f64]| Layer::line(time.clone(), broken(values, &holes));
    let axis = || Axis::new("Time", "s");
    let top = Panel::new(axis(), force_axis(outcome))
        .layer(line(&series.measured).color(Color::Grey).label("Measured"))
        .layer(line(&series.model).color(Color::Blue).label("Model"));
    let middle = Panel::new(axis(), Axis::new("Residual", outcome.force_unit.as_str()))
        .layer(line(&series.residual()).color(Color::Vermilion))
        .height(110.0);
    let bottom = Panel::new(axis(), velocity_axis(outcome))
        .layer(line(&series.velocity).color(Color::Green))
        .height(90.0);
    Figure::new(title)
        .panel(top)
        .panel(middle)
        .panel(bottom)
        .shared_x()
}

/// The residual over the position, in which cogging and levels along the stroke show; `None` without a stroke.
pub(super) fn residual_over_position(outcome: &Outcome) -> Option<Figure> {
    let series = &outcome.law().series;
    let mut places = series.position.iter();
    let first = places.next()?;
    places.any(|x| x != first).then_some(())?;
    let length = symbols::length_unit(outcome.motion);
    let panel = Panel::new(
        Axis::new("Position", length),
        Axis::new("Residual", outcome.force_unit.as_str()),
    )
    .layer(Layer::points(series.position.clone(), series.residual()).color(Color::Vermilion));
    Some(Figure::new("Residual over position").panel(panel).half())
}

/// One time axis through all logs: each starts where the one before ended.
pub(super) fn clock(series: &Series) -> Vec<f64> {
    let mut shift = 0.0;
    let mut out: Vec<f64> = Vec::with_capacity(series.time.len());
    for i in 0..series.time.len() {
        if i > 0 && series.log[i] != series.log[i - 1] {
            shift = out[i - 1] - series.time[i];
        }
        out.push(series.time[i] + shift);
    }
    out
}

/// Autocorrelation of the residual with the band of white noise.
pub(super) fn autocorrelation(outcome: &Outcome) -> Figure {
    let residual = outcome.law().series.residual();
    let lags = MOST_LAGS.min(residual.len().saturating_sub(1));
    let acf = correlate(&residual, lags).unwrap_or_default();
    let band = 1.96 / (residual.len().max(1) as f64).sqrt();
    let x: Vec<f64> = (0..acf.len()).map(|i| i as f64).collect();
    let panel = Panel::new(
        Axis::new("Lag", "samples"),
        Axis::new("Autocorrelation", ""),
    )
    .layer(Layer::hband(-band, band).label("White noise, 95 %"))
    .layer(Layer::line(x, acf).color(Color::Blue));
    Figure::new("Autocorrelation of the residual")
        .panel(panel)
        .half()
}

/// The course of the strongest effect that the residual shows.
pub(super) fn left(outcome: &Outcome) -> Option<Figure> {
    let found = outcome.law().effects.first()?;
    let length = symbols::length_unit(outcome.motion);
    let explained = Axis::new("Explained of what the law leaves", "%");
    let force = Axis::new("Mean residual", outcome.force_unit.as_str());
    let level = Axis::new("Level of friction about its mean", "%");
    let (along, across, scale) = match found.effect {
        Effect::Drift(_) => (Axis::new("Time", "s"), level, 100.0),
        Effect::Position(..) | Effect::LevelWave(_) => {
            (Axis::new("Position", length), level, 100.0)
        }
        Effect::Load(_) => (Axis::new("Load", outcome.load_unit.as_str()), level, 100.0),
        Effect::Temperature(_) => (Axis::new("Temperature", "K"), level, 100.0),
        Effect::Ripple(_) | Effect::SpringForce(_) => (Axis::new("Position", length), force, 1.0),
        Effect::Clocks(_) => (Axis::new("Time", "s"), force, 1.0),
        Effect::Curve => (velocity_axis(outcome), force, 1.0),
        Effect::Resonance { .. } => {
            let along = Axis::new("Frequency of the load on its spring", "Hz");
            (along.log(), explained, 100.0)
        }
        Effect::Backlash { .. } => {
            let along = Axis::new("Lost motion between motor and load", length);
            (along.log(), explained, 100.0)
        }
        Effect::Dynamics(_)
        | Effect::Limit(..)
        | Effect::Mass(_)
        | Effect::Delay(_)
        | Effect::Bristles => return None,
    };
    let course = found.course.iter();
    let (x, y): (Vec<f64>, Vec<f64>) = course.map(|(x, y)| (*x, scale * y)).unzip();
    if x.is_empty() {
        return None;
    }
    let panel = Panel::new(along, across)
        .layer(Layer::line(x.clone(), y.clone()).color(Color::Vermilion))
        .layer(Layer::points(x, y).color(Color::Vermilion));
    Some(Figure::new("What the residual shows").panel(panel))
}

/// Relative residual over evaluations.
pub(super) fn convergence(outcome: &Outcome) -> Figure {
    let history = &outcome.law().history;
    let x: Vec<f64> = history.iter().map(|(n, _)| *n as f64).collect();
    let y: Vec<f64> = history.iter().map(|(_, r)| 100.0 * r).collect();
    let panel = Panel::new(
        Axis::new("Evaluations", ""),
        Axis::new("Relative error", "%").log(),
    )
    .layer(
        Layer::line(x.clone(), y.clone())
            .color(Color::Blue)
            .dash(Dash::Dotted),
    )
    .layer(Layer::points(x, y).color(Color::Blue));
    Figure::new("Convergence on the full record")
        .panel(panel)
        .half()
}

/// Correlation of the parameters.
pub(super) fn correlation(outcome: &Outcome) -> Heatmap {
    let covariance = &outcome.law().covariance;
    let names: Vec<Text> = covariance
        .names
        .iter()
        .map(|n| Text::from(n.symbol()))
        .collect();
    let values: Vec<f64> = covariance.correlation().into_iter().flatten().collect();
    Heatmap::square("Correlation of the parameters", names, values).caption(
        "Pairs near ±1 move together: the log determines their combination, not each of them.",
    )
}
