//! What the procedures found: static map, two steps against one, force steps, break-away.

use super::figures;
use stiction_files::result::{BreakAwayEntry, PreslidingStepEntry, StaticMapEntry, TwoStepEntry};
use stiction_files::symbols;
use stiction_number::Percent;
use stiction_report::{Align, Axis, Block, Color, Dash, Figure, Layer, Panel, Table, Text, number};
use stiction_workflows::identify::Outcome;

/// Headings, tables and figures of every procedure that was used.
pub(super) fn sections(outcome: &Outcome) -> Vec<Block> {
    let result = &outcome.result;
    let mut out: Vec<Block> = Vec::new();
    let heading = |text: &str| Block::Heading(2, Text::from(text));
    if let Some(map) = &result.static_map {
        out.push(heading("Static map"));
        // The curve is that of this result, which a step fit takes from elsewhere.
        out.push(static_figure(outcome, map).into());
        out.push(static_table(map).into());
    }
    if let Some(entry) = &result.static_then_dynamic {
        out.push(heading("Static parameters first, against all at once"));
        out.push(two_step_table(entry).into());
        out.extend(
            entry
                .explanation
                .iter()
                .map(|line| Block::Paragraph(Text::from(line.as_str()))),
        );
    }
    if let Some(entry) = &result.presliding_step {
        out.push(heading("Presliding steps"));
        out.push(step_table(outcome, entry).into());
        out.extend(step_figures(outcome, entry).into_iter().map(Block::from));
    }
    if !result.break_away.is_empty() {
        out.push(heading("Break-away"));
        out.push(break_away_table(outcome, &result.break_away).into());
        out.push(break_away_figure(outcome, &result.break_away).into());
    }
    out
}

/// Points with their error bars, the curve with its band; all speeds, and those near zero.
fn static_figure(outcome: &Outcome, map: &StaticMapEntry) -> Figure {
    let top = map
        .points
        .iter()
        .fold(0.0_f64, |m, p| m.max(p.velocity.abs()));
    let vs = ["stribeck_velocity", "stribeck_velocity_pos"]
        .iter()
        .find_map(|name| outcome.law().value(name))
        .unwrap_or(top);
    let offset = outcome.law().value("offset").unwrap_or(0.0);
    let panel = |reach: f64, title: &str| {
        let near: Vec<_> = map
            .points
            .iter()
            .filter(|p| p.velocity.abs() <= reach)
            .collect();
        let v = figures::grid(reach);
        let steady = figures::steady(outcome);
        let curve: Vec<f64> = v.iter().map(|&v| steady.force(v) + offset).collect();
        let band: Vec<f64> = v
            .iter()
            .map(|&v| 1.96 * figures::steady_deviation(outcome, &steady, v))
            .collect();
        let edge = |sign: f64| -> Vec<f64> {
            let pairs = curve.iter().zip(&band);
            pairs.map(|(f, b)| f + sign * b).collect()
        };
        let x: Vec<f64> = near.iter().map(|p| p.velocity).collect();
        let of = |f: &dyn Fn(usize) -> f64| -> Vec<f64> { (0..near.len()).map(f).collect() };
        Panel::new(
            Axis::new("Velocity", map.velocity_unit.as_str()).range(-reach, reach),
            Axis::new("Force", map.force_unit.as_str()),
        )
        .title(title)
        .layer(
            Layer::band(v.clone(), edge(-1.0), edge(1.0))
                .color(Color::Vermilion)
                .label("95 % band"),
        )
        .layer(
            Layer::line(v, curve)
                .color(Color::Vermilion)
                .width(2.0)
                .label("Static map"),
        )
        .layer(
            Layer::error_bars(
                x.clone(),
                of(&|i| near[i].force - 1.96 * near[i].force_std),
                of(&|i| near[i].force + 1.96 * near[i].force_std),
            )
            .color(Color::Blue),
        )
        .layer(
            Layer::points(x, of(&|i| near[i].force))
                .color(Color::Blue)
                .label("Constant velocities"),
        )
    };
    Figure::new("Static map")
        .panel(panel(1.05 * top, "All speeds"))
        .panel(panel((6.0 * vs).min(1.05 * top), "Near the Stribeck velocity"))
        .caption(
            "Each point is the mean force over a stretch of constant velocity; the bars are its 95 % \
             interval, the correlation of its samples counted.",
        )
}

fn static_table(map: &StaticMapEntry) -> Table {
    let mut table = Table::new([
        (
            format!("Velocity, {}", number::unit(&map.velocity_unit)),
            Align::Right,
        ),
        (
            format!("Force, {}", number::unit(&map.force_unit)),
            Align::Right,
        ),
        ("Std. error".into(), Align::Right),
        ("Map".into(), Align::Right),
        ("Weight".into(), Align::Right),
        ("From, s".into(), Align::Right),
        ("To, s".into(), Align::Right),
        ("Dropped, s".into(), Align::Right),
        ("Log".into(), Align::Left),
    ])
    .caption(format!(
        "Points of the static map. Scatter beyond their standard errors: {} {}.",
        number::sig(map.scatter, 2),
        number::unit(&map.force_unit)
    ));
    for p in &map.points {
        table = table.row([
            number::sig(p.velocity, 4),
            number::sig(p.force, 5),
            number::sig(p.force_std, 2),
            number::sig(p.model, 5),
            number::sig(p.weight, 2),
            number::sig(p.start_s, 5),
            number::sig(p.end_s, 5),
            number::sig(p.dropped_s, 2),
            p.path.clone(),
        ]);
    }
    table
}

fn two_step_table(entry: &TwoStepEntry) -> Table {
    let mut table = Table::new([
        ("Parameter", Align::Left),
        ("Two steps", Align::Right),
        ("Std. dev.", Align::Right),
        ("All at once", Align::Right),
        ("Std. dev.", Align::Right),
        ("Apart, std. of all at once", Align::Right),
        ("Unit", Align::Left),
    ])
    .caption(format!(
        "Static parameters from the {}. Residual rms on this record: {} in two steps, {} all at once.",
        entry.statics,
        number::sig(entry.rmse, 3),
        number::sig(entry.joint_rmse, 3)
    ));
    let std = |std: Option<f64>| std.map_or("–".into(), |s| number::sig(s, 2));
    for p in &entry.parameters {
        table = table.row([
            symbols::symbol(&p.name),
            number::sig(p.value, 5),
            std(p.std),
            number::sig(p.joint, 5),
            std(p.joint_std),
            p.difference_in_std
                .map_or("–".into(), |d| number::sig(d, 2)),
            number::unit(&p.unit),
        ]);
    }
    table
}

fn step_table(outcome: &Outcome, entry: &PreslidingStepEntry) -> Table {
    let mut table = Table::new([
        ("Method".to_string(), Align::Left),
        (
            format!("Step, {}", number::unit(&entry.force_unit)),
            Align::Right,
        ),
        ("Overshoot".into(), Align::Right),
        ("Damping ratio".into(), Align::Right),
        ("σ₀".into(), Align::Right),
        ("off".into(), Align::Right),
        ("σ₁".into(), Align::Right),
        ("off".into(), Align::Right),
    ])
    .caption(
        "The published inversion reads σ₀ off the displacement and σ₁ off the overshoot, as if the \
         bristles were linear. They slip well below break-away, so it gives too soft a σ₀ and too \
         high a σ₁. The result of this report is the fit by simulation.",
    );
    let percent = |x: Option<f64>| x.map_or("–".into(), |x| Percent::error(x).digits(3));
    let plain = |x: Option<f64>| x.map_or("–".into(), |x| number::sig(x, 4));
    for p in &entry.published {
        table = table.row([
            format!("inverted, {}", p.path),
            number::sig(p.height, 4),
            percent(p.overshoot.map(|x| 100.0 * x)),
            plain(p.damping_ratio),
            number::sig(p.sigma0, 4),
            percent(Some(p.sigma0_off_percent)),
            p.sigma1.map_or("refused".into(), |x| number::sig(x, 4)),
            percent(p.sigma1_off_percent),
        ]);
    }
    table.row([
        "simulated, used".to_string(),
        String::new(),
        String::new(),
        number::sig(entry.damping_ratio, 4),
        plain(outcome.law().value("sigma0")),
        String::new(),
        plain(outcome.law().value("sigma1")),
        String::new(),
    ])
}

/// Measured, simulated, and what the linear system of the published inversion would do.
fn step_figures(outcome: &Outcome, entry: &PreslidingStepEntry) -> Vec<Figure> {
    let series = &outcome.law().series;
    let mass = outcome.law().value("mass");
    let viscous = outcome.law().value("sigma2").unwrap_or(0.0);
    entry
        .published
        .iter()
        .enumerate()
        .map(|(log, published)| {
            let own: Vec<usize> = (0..series.log.len())
                .filter(|&i| series.log[i] == log)
                .collect();
            let pick = |x: &[f64]| -> Vec<f64> { own.iter().map(|&i| x[i]).collect() };
            let (time, measured) = (pick(&series.time), pick(&series.measured));
            let mut panel = Panel::new(
                Axis::new("Time", "s"),
                Axis::new("Displacement", entry.displacement_unit.as_str()),
            )
            .layer(
                Layer::points(time.clone(), measured.clone())
                    .color(Color::Grey)
                    .label("Measured"),
            );
            if let (Some(mass), Some(sigma1)) = (mass, published.sigma1) {
                let linear = Linear {
                    settled: published.settled * published.height.signum(),
                    omega: (published.sigma0 / mass).sqrt(),
                    damping: 0.5 * (sigma1 + viscous) / mass,
                };
                // The step is taken to begin where the axis has moved a hundredth of its travel.
                let start = measured
                    .iter()
                    .position(|x| x.abs() > 0.01 * published.settled)
                    .map_or(0.0, |i| time[i.saturating_sub(1)]);
                let y: Vec<f64> = time.iter().map(|t| linear.at(t - start)).collect();
                panel = panel.layer(
                    Layer::line(time.clone(), y)
                        .color(Color::Blue)
                        .dash(Dash::Dashed)
                        .label("Linear system of the inversion"),
                );
            }
            panel = panel.layer(
                Layer::line(time, pick(&series.model))
                    .color(Color::Vermilion)
                    .label("Simulated"),
            );
            Figure::new(format!("Step response, {}", published.path)).panel(panel)
        })
        .collect()
}

/// A linear second-order step response.
struct Linear {
    settled: f64,
    omega: f64,
    /// Decay rate, 1/s.
    damping: f64,
}

impl Linear {
    fn at(&self, t: f64) -> f64 {
        if t <= 0.0 {
            return 0.0;
        }
        let ring = (self.omega * self.omega - self.damping * self.damping)
            .max(0.0)
            .sqrt();
        let swing = if ring > 0.0 {
            libm::cos(ring * t) + self.damping / ring * libm::sin(ring * t)
        } else {
            1.0 + self.damping * t
        };
        self.settled * (1.0 - libm::exp(-self.damping * t) * swing)
    }
}

fn break_away_table(outcome: &Outcome, runs: &[BreakAwayEntry]) -> Table {
    let unit = number::unit(&outcome.force_unit);
    let mut table = Table::new([
        ("Log".to_string(), Align::Left),
        (format!("Rate, {unit}/s"), Align::Right),
        (format!("Force, {unit}"), Align::Right),
        ("Inertia".into(), Align::Right),
        ("Offset".into(), Align::Right),
        ("Friction".into(), Align::Right),
        ("Predicted".into(), Align::Right),
        ("Largest friction".into(), Align::Right),
        (
            format!("Displacement, {}", symbols::length_unit(outcome.motion)),
            Align::Right,
        ),
        (
            format!("Threshold, {}", symbols::speed_unit(outcome.motion)),
            Align::Right,
        ),
        ("Slips".into(), Align::Right),
    ])
    .caption(
        "The axis has broken away at the last instant at which it is slower than the threshold; where it sticks again \
         (slips: how often), before its first slip. \
         Friction is the force of the drive without inertia (mass times acceleration there) and offset. \
         Predicted is the friction of a simulated ramp of the same rate at the same speed; the largest \
         friction before it is what no sensor sees. Break-away is not a point of the static map: the \
         faster the force rises, the lower is that friction, while the force of the drive may rise with its rate, since it \
         accelerates the axis too.",
    );
    let plain = |x: Option<f64>| x.map_or("–".into(), |x| number::sig(x, 4));
    for run in runs {
        table = table.row([
            run.path.clone(),
            number::sig(run.rate, 4),
            number::sig(run.force, 4),
            plain(run.inertia),
            number::sig(run.offset, 4),
            plain(run.friction),
            plain(run.predicted_friction_there),
            plain(run.predicted_friction),
            number::sig(run.displacement, 3),
            number::sig(run.threshold, 3),
            match run.slips {
                0 => "–".into(),
                n => n.to_string(),
            },
        ]);
    }
    table
}

fn break_away_figure(outcome: &Outcome, runs: &[BreakAwayEntry]) -> Figure {
    let unit = &outcome.force_unit;
    let rate: Vec<f64> = runs.iter().map(|r| r.rate.abs()).collect();
    let force: Vec<f64> = runs.iter().map(|r| r.force.abs()).collect();
    let mut panel = Panel::new(
        Axis::new("Rate of the force", format!("{unit}/s")),
        Axis::new("Break-away force", unit.as_str()),
    )
    .layer(
        Layer::points(rate.clone(), force)
            .color(Color::Blue)
            .label("Measured"),
    );
    let mut predicted: Vec<(f64, f64)> = runs
        .iter()
        .filter_map(|r| Some((r.rate.abs(), r.predicted_force?.abs())))
        .collect();
    predicted.sort_by(|a, b| a.0.total_cmp(&b.0));
    if !predicted.is_empty() {
        let (x, y): (Vec<f64>, Vec<f64>) = predicted.into_iter().unzip();
        panel = panel.layer(
            Layer::line(x, y)
                .color(Color::Vermilion)
                .label("Predicted by the model"),
        );
    }
    Figure::new("Break-away force over the rate of the force").panel(panel)
}
