//! The output for small inputs, to be looked at when it changes.

use stiction_report::math::{frac, id, op, quantity, row, sub};
use stiction_report::{
    Align, Axis, Block, Callout, Color, Dash, Document, Figure, Heatmap, KeyFigure, Layer, Panel,
    Severity, Table, Text,
};

/// Without the style sheet, which is a file of its own.
fn without_style(text: &str) -> String {
    let (before, rest) = text.split_once("<style>").unwrap();
    let (_, after) = rest.split_once("</style>").unwrap();
    format!("{before}<style/>{after}")
}

#[test]
fn friction_map() {
    let v = [-0.2, -0.1, -0.001, f64::NAN, 0.001, 0.1, 0.2];
    let f = [-25.0, -22.5, -27.0, f64::NAN, 27.0, 22.5, 25.0];
    let low = f.map(|f| f - 1.0);
    let high = f.map(|f| f + 1.0);
    let panel = Panel::new(
        Axis::new("Velocity", "m/s"),
        Axis::new("Friction force", "N"),
    )
    .height(120.0)
    .layer(
        Layer::band(v, low, high)
            .label("95 %")
            .color(Color::Vermilion),
    )
    .layer(Layer::line(v, f).label(Text::from("Model ").then(Text::symbol("F", "f"))))
    .layer(Layer::points([-0.15, 0.05], [-23.0, 24.1]).label("Measured"));
    let figure = Figure::new("Friction over velocity")
        .half()
        .panel(panel)
        .caption("Two runs.");
    insta::assert_snapshot!(without_style(&figure.to_svg()));
}

#[test]
fn shared_time_axis() {
    let t = [0.0, 0.01, 0.02, 0.03];
    let figure = Figure::new("In time")
        .shared_x()
        .panel(
            Panel::new(Axis::new("Time", "s"), Axis::new("Cost", "").log())
                .height(60.0)
                .layer(Layer::steps(t, [1e5, 1e3, 20.0, 19.0]).label("Best")),
        )
        .panel(
            Panel::new(Axis::new("Time", "s"), Axis::new("Residual", "N"))
                .title("Second")
                .height(60.0)
                .layer(Layer::hband(-0.5, 0.5))
                .layer(Layer::bars(t, [0.1, -0.2, 0.7, 0.0]))
                .layer(Layer::vline(0.015).dash(Dash::Dashed)),
        );
    insta::assert_snapshot!(without_style(&figure.to_svg()));
}

#[test]
fn names_and_intervals() {
    let panel = Panel::new(
        Axis::new("Ratio", ""),
        Axis::names([Text::symbol("σ", "0"), Text::symbol("F", "c")]),
    )
    .height(60.0)
    .layer(Layer::intervals([0.0, 1.0], [0.9, 0.99], [1.2, 1.01]))
    .layer(Layer::note(1.0, 1.0, "true"));
    insta::assert_snapshot!(without_style(
        &Figure::new("Ladder").half().panel(panel).to_svg()
    ));
}

#[test]
fn heat_map() {
    let map = Heatmap::square("Correlation", ["a", "b"], [1.0, -0.75, -0.75, f64::NAN]);
    insta::assert_snapshot!(without_style(&map.to_svg()));
}

#[test]
fn document() {
    let document = Document::new("Friction of <X>")
        .subtitle("One log")
        .footer("end")
        .block(Block::KeyFigures(vec![
            KeyFigure::new("Error", "2.3", "%")
                .note("held out: 2.4 %")
                .severity(Severity::Good),
        ]))
        .heading(2, "Result")
        .heading(2, "Result")
        .heading(3, Text::from("Of ").code("a.csv"))
        .heading(2, "§")
        .paragraph(
            Text::from("See ")
                .link("the page", "codes/W1.html")
                .plain("."),
        )
        .block(
            Table::new([("Name", Align::Left), ("Value", Align::Right)])
                .caption("Parameters")
                .row(["mass", "95.1"])
                .marked(Severity::Warning, ["damping"]),
        )
        .block(Block::Formula(
            vec![row([
                sub(id("F"), id("c")),
                op("="),
                frac(quantity("20", "N"), id("exp")),
            ])],
            "As fitted.".into(),
        ))
        .block(Callout {
            severity: Severity::Error,
            code: "E1".into(),
            text: "No motion.".into(),
            link: "codes/E1.html".into(),
        })
        .block(Block::Facts(vec![("Rate".into(), "1 kHz".into())]))
        .block(Block::Details(
            "More".into(),
            vec![Block::List(vec!["one".into()])],
        ));
    insta::assert_snapshot!(without_style(&document.to_html()));
}
