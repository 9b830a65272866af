//! Writes every building block of a report with synthetic friction data:
//! `cargo run -p stiction-report --example all_figures -- figures.html`

use std::f64::consts::TAU;

use stiction_report::math::{abs, dot, frac, id, num, op, paren, quantity, row, sub, sup};
use stiction_report::number::{concise, count, interval, sig};
use stiction_report::{
    Align, Axis, Block, Callout, Color, Dash, Document, Figure, Heatmap, KeyFigure, Layer, Math,
    Panel, Severity, Table, Text,
};

/// A repeatable source of noise of unit variance.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        let mut uniform = || {
            self.0 = self
                .0
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (self.0 >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..12).map(|_| uniform()).sum::<f64>() - 6.0
    }
}

const SIGMA0: f64 = 7.41e6;
const SIGMA1: f64 = 3200.0;
const SIGMA2: f64 = 28.5;
const FC: f64 = 20.4;
const FS: f64 = 27.9;
const VS: f64 = 0.012;

fn stribeck(v: f64) -> f64 {
    FC + (FS - FC) * (-(v / VS) * (v / VS)).exp()
}

/// The LuGre force along a velocity record, with its bristle deflection held in `z`; the bristle
/// damping, too small to be seen here, is left out.
fn lugre(v: f64, dt: f64, z: &mut f64) -> f64 {
    let g = stribeck(v);
    let limit = g / SIGMA0 * v.signum();
    let decay = (-SIGMA0 * v.abs() / g * dt).exp();
    *z = limit + (*z - limit) * decay;
    SIGMA0 * *z + SIGMA2 * v
}

struct Record {
    t: Vec<f64>,
    v: Vec<f64>,
    x: Vec<f64>,
    measured: Vec<f64>,
    model: Vec<f64>,
}

fn record(samples: usize, rate: f64) -> Record {
    let mut noise = Noise(7);
    let (mut z, mut x, dt) = (0.0, 0.0, 1.0 / rate);
    let mut r = Record {
        t: vec![],
        v: vec![],
        x: vec![],
        measured: vec![],
        model: vec![],
    };
    for i in 0..samples {
        let t = i as f64 * dt;
        let v = 0.22 * (TAU * 0.13 * t).sin() * (0.35 + 0.65 * (TAU * 0.017 * t).cos().abs());
        x += v * dt;
        let model = lugre(v, dt, &mut z);
        let ripple = 0.55 * (TAU * x / 0.024).sin();
        r.t.push(t);
        r.v.push(v);
        r.x.push(x);
        r.model.push(model);
        r.measured.push(model + ripple + 0.8 * noise.next());
    }
    r
}

fn grid(low: f64, high: f64, n: usize) -> Vec<f64> {
    (0..n)
        .map(|i| low + (high - low) * i as f64 / (n - 1) as f64)
        .collect()
}

fn friction_map(r: &Record) -> Figure {
    let curve = |vs: &[f64]| -> Vec<f64> {
        vs.iter()
            .map(|v| v.signum() * stribeck(*v) + SIGMA2 * v)
            .collect()
    };
    let spread = |v: f64| 0.5 + 2.4 * (-(v / VS).powi(2)).exp() + 25.0 * v * v;
    let v: Vec<f64> = [
        grid(-0.23, -1e-4, 400),
        vec![f64::NAN],
        grid(1e-4, 0.23, 400),
    ]
    .concat();
    let f = curve(&v);
    let edge = |s: f64| {
        v.iter()
            .zip(&f)
            .map(|(v, f)| f + s * spread(*v))
            .collect::<Vec<_>>()
    };
    let panel = Panel::new(
        Axis::new("Velocity", "m/s"),
        Axis::new("Friction force", "N"),
    )
    .height(330.0)
    .layer(
        Layer::points(r.v.clone(), r.measured.clone())
            .label("Measured")
            .color(Color::Grey),
    )
    .layer(
        Layer::band(v.clone(), edge(-1.0), edge(1.0))
            .label("95 % band")
            .color(Color::Vermilion)
            .opacity(0.3),
    )
    .layer(
        Layer::line(v, f)
            .label("LuGre, steady state")
            .color(Color::Vermilion)
            .width(2.0),
    );
    Figure::new("Friction over velocity").panel(panel).caption(
        "The stronger a cell, the more samples it holds. The band holds the steady-state curve with 95 % \
         probability; scatter around it is presliding, ripple of the drive and noise.",
    )
}

fn force_in_time(r: &Record) -> Figure {
    let residual: Vec<f64> = r
        .measured
        .iter()
        .zip(&r.model)
        .map(|(a, b)| a - b)
        .collect();
    let time = || Axis::new("Time", "s");
    Figure::new("Force in time")
        .shared_x()
        .panel(
            Panel::new(time(), Axis::new("Velocity", "m/s"))
                .height(100.0)
                .layer(Layer::line(r.t.clone(), r.v.clone()).color(Color::Ink).width(1.2)),
        )
        .panel(
            Panel::new(time(), Axis::new("Friction force", "N"))
                .height(210.0)
                .layer(
                    Layer::line(r.t.clone(), r.measured.clone())
                        .label("Measured")
                        .color(Color::Grey)
                        .width(1.0),
                )
                .layer(
                    Layer::line(r.t.clone(), r.model.clone())
                        .label("Model")
                        .color(Color::Blue)
                        .width(1.6),
                ),
        )
        .panel(
            Panel::new(time(), Axis::new("Residual", "N"))
                .height(100.0)
                .layer(Layer::line(r.t.clone(), residual).color(Color::Vermilion).width(1.0))
                .layer(Layer::hline(1.8).color(Color::Ink).dash(Dash::Dashed).label("± 2 rms"))
                .layer(Layer::hline(-1.8).color(Color::Ink).dash(Dash::Dashed)),
        )
        .caption("All samples were used; each pixel column shows the lowest and the highest of its samples.")
}

fn low_speed(r: &Record) -> Figure {
    let panel = Panel::new(
        Axis::new("Velocity", "m/s").range(-0.02, 0.02),
        Axis::new("Friction force", "N").range(-36.0, 36.0),
    )
    .layer(
        Layer::points(r.v.clone(), r.measured.clone())
            .color(Color::Grey)
            .label("Measured"),
    )
    .layer(
        Layer::line(r.v.clone(), r.model.clone())
            .color(Color::Blue)
            .label("Model"),
    );
    Figure::new("Near zero speed")
        .half()
        .panel(panel)
        .caption("Hysteresis of the bristles at reversals.")
}

fn presliding() -> Figure {
    let (mut z, mut x) = (0.0, 0.0);
    let (mut xs, mut fs) = (vec![], vec![]);
    let dt = 1e-4;
    for i in 0..40_000 {
        let t = i as f64 * dt;
        let turns = t * 2.0;
        let amplitude = if turns.fract() < 0.5 { 1.0 } else { 0.55 };
        let v = 4.5e-5 * amplitude * TAU * (TAU * turns).cos();
        x += v * dt;
        xs.push(x);
        fs.push(lugre(v, dt, &mut z));
    }
    let panel = Panel::new(Axis::new("Position", "m"), Axis::new("Friction force", "N"))
        .layer(Layer::line(xs, fs).color(Color::Blue).label("Model"))
        .layer(Layer::hline(FS).dash(Dash::Dashed).label("Break-away"))
        .layer(
            Layer::note(
                -1.5e-6,
                -22.0,
                Text::from("slope ").then(Text::symbol("σ", "0")),
            )
            .color(Color::Ink),
        );
    Figure::new("Presliding")
        .half()
        .panel(panel)
        .caption("Friction force over position within some micrometres.")
}

fn autocorrelation() -> Figure {
    let lags = grid(0.0, 60.0, 61);
    let mut noise = Noise(3);
    let acf = lags
        .iter()
        .map(|l| {
            if *l == 0.0 {
                1.0
            } else {
                0.42 * (-l / 9.0).exp() * (l * 0.5).cos() + 0.025 * noise.next()
            }
        })
        .collect::<Vec<_>>();
    let panel = Panel::new(
        Axis::new("Lag", "samples"),
        Axis::new("Autocorrelation", "").range(-0.4, 1.05),
    )
    .layer(
        Layer::hband(-0.08, 0.08)
            .color(Color::Green)
            .label("White noise, 95 %"),
    )
    .layer(Layer::bars(lags, acf).color(Color::Blue));
    Figure::new("Residual autocorrelation").half().panel(panel)
}

fn convergence() -> Figure {
    let n = grid(0.0, 120.0, 121);
    let best: Vec<f64> = n
        .iter()
        .map(|i| 3.1 + 4e4 * (-i / 7.0).exp() + 40.0 * (-i / 22.0).exp())
        .collect();
    let spread: Vec<f64> = n
        .iter()
        .zip(&best)
        .map(|(i, b)| b * (1.0 + 9.0 * (-i / 50.0).exp()))
        .collect();
    let panel = Panel::new(Axis::new("Iteration", ""), Axis::new("Cost", "N²").log())
        .layer(
            Layer::band(n.clone(), best.clone(), spread)
                .color(Color::Purple)
                .label("Starts"),
        )
        .layer(Layer::steps(n, best).color(Color::Purple).label("Best"));
    Figure::new("Convergence").half().panel(panel)
}

fn recovery() -> Figure {
    let names = [
        Text::symbol("σ", "0"),
        Text::symbol("σ", "1"),
        Text::symbol("σ", "2"),
        Text::symbol("F", "c"),
        Text::symbol("F", "s"),
        Text::symbol("v", "s"),
    ];
    let ratio = [1.004, 0.91, 1.002, 0.9985, 1.012, 0.985];
    let half = [0.017, 0.16, 0.008, 0.004, 0.021, 0.03];
    let rows: Vec<f64> = (0..6).map(f64::from).collect();
    let end = |s: f64| {
        ratio
            .iter()
            .zip(half)
            .map(|(r, h)| r + s * h)
            .collect::<Vec<_>>()
    };
    let panel = Panel::new(Axis::new("Identified / true", ""), Axis::names(names))
        .height(190.0)
        .layer(Layer::vline(1.0).dash(Dash::Dashed).label("True"))
        .layer(
            Layer::intervals(rows.clone(), end(-1.0), end(1.0))
                .color(Color::Blue)
                .label("95 % interval"),
        )
        .layer(
            Layer::points(ratio, rows)
                .color(Color::Blue)
                .width(7.0)
                .opacity(1.0),
        );
    Figure::new("Identified against true parameters").panel(panel)
}

fn bode() -> Figure {
    let f: Vec<f64> = grid(0.0, 3.0, 300)
        .iter()
        .map(|e| 10_f64.powf(*e))
        .collect();
    let pole = |f: f64| 1.0 + (f / 42.0).powi(2);
    let gain = f
        .iter()
        .map(|f| -10.0 * pole(*f).log10())
        .collect::<Vec<_>>();
    let phase = f
        .iter()
        .map(|f| -(f / 42.0).atan().to_degrees())
        .collect::<Vec<_>>();
    let axis = || Axis::new("Frequency", "Hz").log();
    Figure::new("Frequency response")
        .shared_x()
        .panel(
            Panel::new(axis(), Axis::new("Magnitude", "dB"))
                .height(140.0)
                .layer(Layer::vline(42.0).dash(Dash::Dotted))
                .layer(Layer::line(f.clone(), gain).label("Velocity loop")),
        )
        .panel(
            Panel::new(axis(), Axis::new("Phase", "deg"))
                .height(120.0)
                .layer(Layer::line(f, phase)),
        )
}

fn methods() -> Figure {
    let panel = Panel::new(
        Axis::names([
            "separable",
            "Levenberg–Marquardt",
            "genetic",
            "adaptive genetic",
            "CMA-ES",
        ]),
        Axis::new("Relative error", "%"),
    )
    .height(180.0)
    .layer(Layer::bars(
        [0.0, 1.0, 2.0, 3.0, 4.0],
        [2.31, 2.96, 4.4, 3.7, 2.35],
    ))
    .layer(
        Layer::error_bars(
            [0.0, 1.0, 2.0, 3.0, 4.0],
            [2.28, 2.4, 3.6, 3.2, 2.3],
            [2.35, 4.1, 5.6, 4.4, 2.47],
        )
        .color(Color::Ink),
    );
    Figure::new("Error by method")
        .panel(panel)
        .caption("Median and range of 20 seeds.")
}

fn correlation() -> Heatmap {
    let names = ["σ|0", "σ|1", "σ|2", "F|c", "F|s", "v|s", "m|"];
    let names = names.map(|n| {
        n.split_once('|')
            .map_or_else(Text::new, |(b, s)| Text::symbol(b, s))
    });
    #[rustfmt::skip]
    let lower = [
        1.0,
        -0.31, 1.0,
        0.02, -0.05, 1.0,
        -0.11, 0.04, -0.88, 1.0,
        0.27, -0.12, 0.21, -0.36, 1.0,
        0.08, 0.02, 0.44, -0.61, -0.72, 1.0,
        -0.02, 0.01, -0.13, 0.06, 0.03, -0.07, 1.0,
    ];
    let at = |i: usize, j: usize| {
        let (i, j) = (i.max(j), i.min(j));
        lower[i * (i + 1) / 2 + j]
    };
    let values: Vec<f64> = (0..49).map(|k| at(k / 7, k % 7)).collect();
    Heatmap::square("Correlation of the estimates", names, values)
        .caption("Pairs beyond ± 0.9 cannot be told apart by this log.")
}

fn formula() -> Vec<Math> {
    let s = |base: &str, below: &str| {
        let below = if below.parse::<u8>().is_ok() {
            num(below)
        } else {
            id(below)
        };
        sub(id(base), below)
    };
    let stribeck = |fc: Math, fs: Math, vs: Math| {
        row([
            fc.clone(),
            op("+"),
            paren(row([fs, op("−"), fc])),
            id("exp"),
            paren(row([op("−"), sup(abs(frac(id("v"), vs)), num("2"))])),
        ])
    };
    let g = || row([id("g"), paren(id("v"))]);
    vec![
        row([
            id("F"),
            op("="),
            s("σ", "0"),
            id("z"),
            op("+"),
            s("σ", "1"),
            dot(id("z")),
            op("+"),
            s("σ", "2"),
            id("v"),
            op(","),
            Math::Unit("  ".into()),
            dot(id("z")),
            op("="),
            id("v"),
            op("−"),
            s("σ", "0"),
            frac(abs(id("v")), g()),
            id("z"),
        ]),
        row([
            g(),
            op("="),
            stribeck(s("F", "c"), s("F", "s"), s("v", "s")),
        ]),
        row([
            g(),
            op("="),
            quantity(sig(FC, 3), "N"),
            op("+"),
            quantity(sig(FS - FC, 3), "N"),
            id("exp"),
            paren(row([
                op("−"),
                sup(abs(frac(id("v"), quantity(sig(VS, 3), "m/s"))), num("2")),
            ])),
        ]),
    ]
}

fn parameters() -> Table {
    let columns = [
        ("Parameter", Align::Left),
        ("Symbol", Align::Left),
        ("Value", Align::Right),
        ("Unit", Align::Left),
        ("95 % interval", Align::Right),
        ("Origin", Align::Left),
    ];
    let cells = |name: &str, symbol: Text, value: f64, std: f64, unit: &str, origin: &str| {
        [
            name.into(),
            symbol,
            concise(value, std).into(),
            unit.into(),
            interval(value - 1.96 * std, value + 1.96 * std).into(),
            Text::from(origin),
        ]
    };
    let id = "identified";
    Table::new(columns)
        .caption(
            "Parameters of the LuGre law. In brackets the standard uncertainty of the last digits.",
        )
        .row(cells(
            "Bristle stiffness",
            Text::symbol("σ", "0"),
            SIGMA0,
            1.2e5,
            "N/m",
            id,
        ))
        .marked(
            Severity::Warning,
            cells(
                "Bristle damping",
                Text::symbol("σ", "1"),
                SIGMA1,
                2900.0,
                "N·s/m",
                "not identifiable",
            ),
        )
        .row(cells(
            "Viscous coefficient",
            Text::symbol("σ", "2"),
            SIGMA2,
            0.21,
            "N·s/m",
            id,
        ))
        .row(cells(
            "Coulomb force",
            Text::symbol("F", "c"),
            FC,
            0.062,
            "N",
            id,
        ))
        .row(cells(
            "Static force",
            Text::symbol("F", "s"),
            FS,
            0.34,
            "N",
            id,
        ))
        .row(cells(
            "Stribeck velocity",
            Text::symbol("v", "s"),
            VS,
            2.6e-4,
            "m/s",
            id,
        ))
        .row([
            "Moving mass".into(),
            Text::symbol("m", ""),
            "95.10".into(),
            "kg".into(),
            "–".into(),
            "given".into(),
        ])
}

fn document() -> Document {
    let r = record(100_000, 1000.0);
    let facts = |pairs: &[(&str, Text)]| {
        Block::Facts(
            pairs
                .iter()
                .map(|(term, fact)| (Text::from(*term), fact.clone()))
                .collect(),
        )
    };
    let warning = |code: &str, text: Text| Callout {
        severity: Severity::Warning,
        code: code.into(),
        text,
        link: format!("codes/{code}.html"),
    };
    Document::new("Friction of the X axis")
        .subtitle("LuGre law identified from one recording of 100 s")
        .block(Block::KeyFigures(vec![
            KeyFigure::new("Relative error", "2.31", "%").note("held-out half: 2.44\u{a0}%").severity(Severity::Good),
            KeyFigure::new("Coulomb force", concise(FC, 0.062), "N").note("95\u{a0}%: 20.28\u{a0}…\u{a0}20.52"),
            KeyFigure::new("Break-away force", concise(FS, 0.34), "N").note("95\u{a0}%: 27.2\u{a0}…\u{a0}28.6"),
            KeyFigure::new("Stiffness", "7.41", "MN/m").note("95 %: 7.17 … 7.65"),
            KeyFigure::new("Damping", "3.2", "kN·s/m").note("not identifiable").severity(Severity::Warning),
        ]))
        .block(warning(
            "W12",
            Text::symbol("σ", "1").plain(
                " is not determined by this log: its interval reaches from zero to twice its value. Record slow \
                 reversals within some micrometres at 5 kHz or faster, or give the value in ",
            ).code("axis.toml").plain("."),
        ))
        .heading(2, "Result")
        .paragraph(
            Text::from("The friction force of the axis follows the LuGre law with the parameters below. The moving mass was ")
                .bold("given")
                .plain(", everything else was identified from ")
                .code("logs/x-axis-2024-11-20.csv")
                .plain("."),
        )
        .block(parameters())
        .block(Block::Formula(formula(), "LuGre law after Canudas de Wit et al., 1995, with numbers in SI units.".into()))
        .heading(2, "How well it fits")
        .heading(3, "Over velocity")
        .block(friction_map(&r))
        .heading(3, "In time")
        .block(force_in_time(&r))
        .heading(3, "Where friction is hard")
        .block(Block::Columns(vec![low_speed(&r).into(), presliding().into()]))
        .heading(2, "How sure it is")
        .block(Block::Columns(vec![autocorrelation().into(), convergence().into()]))
        .block(correlation())
        .block(recovery())
        .heading(2, "What was read")
        .block(facts(&[
            ("File", Text::new().code("logs/x-axis-2024-11-20.csv")),
            ("Samples", Text::from(format!("{} at 1000 Hz", count(r.t.len() as u64)))),
            ("Position", Text::from("column ").code("qm").plain(" in mm")),
            ("Force", Text::from("column ").code("<b>vir</b>").plain(" in V, 35.15 N/V")),
            ("SHA-256", Text::new().code("9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08")),
        ]))
        .heading(3, "How it was conditioned")
        .block(Block::List(vec![
            "Zero-phase Butterworth low-pass, order 4, 80 Hz, applied to the force and to every regressor".into(),
            Text::from("Velocity by central differences after the same filter, ").italic("not").plain(" from the drive"),
        ]))
        .block(Callout { severity: Severity::Info, code: "I03".into(), text: "Three gaps of 12 ms were bridged.".into(), link: String::new() })
        .block(Callout { severity: Severity::Error, code: "E21".into(), text: "The force stands at its limit for 4 % of the time.".into(), link: String::new() })
        .block(Callout { severity: Severity::Good, code: String::new(), text: "The residual is white below 40 Hz.".into(), link: String::new() })
        .block(Block::Details(
            "All settings".into(),
            vec![
                Block::Paragraph("Everything that is needed to repeat the run.".into()),
                Table::new([("Setting", Align::Left), ("Value", Align::Right)])
                    .row(["Seed", "1"])
                    .row(["Starts", "64"])
                    .into(),
            ],
        ))
        .heading(2, "Other figures")
        .block(bode())
        .block(methods())
        .footer("stiction 0.1.0, seed 1")
}

fn main() -> std::io::Result<()> {
    let path = std::env::args()
        .nth(1)
        .unwrap_or_else(|| "gallery.html".into());
    let html = document().to_html();
    println!("{path}: {} bytes", html.len());
    std::fs::write(path, html)
}
