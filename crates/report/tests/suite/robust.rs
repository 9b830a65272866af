//! Whatever the data and the strings are, the output is well-formed and holds finite numbers only.

use proptest::prelude::*;
use stiction_report::{
    Align, Axis, Block, Callout, Color, Dash, Document, Figure, Heatmap, KeyFigure, Layer, Math,
    Panel, Severity, Shape, Table, Text, math, number,
};

fn value() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -100.0..100.0,
        1 => any::<f64>(),
        1 => prop::sample::select(vec![
            f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0, 1e-300, 1e300, -1e300,
            f64::MAX, f64::MIN, f64::MIN_POSITIVE, 5e-324, 1.0, 1.0 + f64::EPSILON,
        ]),
    ]
}

fn values() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(value(), 0..40)
}

/// Any characters, with those that matter in markup often.
fn string() -> impl Strategy<Value = String> {
    prop_oneof![
        "\\PC{0,12}",
        "[<>&\"'/=a-z\\x00-\\x1f]{0,16}",
        any::<String>()
    ]
}

fn layer() -> impl Strategy<Value = Layer> {
    let columns = (values(), values(), values(), value(), value());
    let look = (
        0_usize..14,
        string(),
        value(),
        value(),
        0_usize..3,
        any::<bool>(),
    );
    (columns, look).prop_map(
        |((a, b, c, p, q), (kind, label, width, opacity, dash, labelled))| {
            let layer = match kind {
                0 => Layer::line(a, b),
                1 => Layer::steps(a, b),
                2 => Layer::points(a, b),
                3 => Layer::new(Shape::Bars {
                    x: a.into(),
                    y: b.into(),
                    base: p,
                }),
                4 => Layer::band(a, b, c),
                5 => Layer::error_bars(a, b, c),
                6 => Layer::intervals(a, b, c),
                7 => Layer::hline(p),
                8 => Layer::vline(p),
                9 => Layer::hband(p, q),
                10 => Layer::vband(p, q),
                11 => Layer::note(p, q, label.as_str()),
                // Long enough for every kind of reduction.
                12 => Layer::points(repeated(&a, 5000), repeated(&b, 5000)),
                _ => Layer::line(repeated(&a, 30_000), repeated(&b, 30_001)),
            };
            let dash = [Dash::Solid, Dash::Dashed, Dash::Dotted][dash];
            let layer = layer
                .dash(dash)
                .width(width)
                .opacity(opacity)
                .color(Color::Green);
            if labelled { layer.label(label) } else { layer }
        },
    )
}

fn repeated(values: &[f64], length: usize) -> Vec<f64> {
    values
        .iter()
        .copied()
        .cycle()
        .take(if values.is_empty() { 0 } else { length })
        .collect()
}

fn axis() -> impl Strategy<Value = Axis> {
    (string(), string(), 0..4, value(), value()).prop_map(|(label, unit, kind, a, b)| match kind {
        0 => Axis::new(label, unit).range(a, b),
        1 => Axis::new(label, unit).log(),
        2 => Axis::names([label, unit]),
        _ => Axis::new(label, unit),
    })
}

fn panel() -> impl Strategy<Value = Panel> {
    (
        axis(),
        axis(),
        prop::collection::vec(layer(), 0..4),
        value(),
        any::<bool>(),
        string(),
    )
        .prop_map(|(x, y, layers, height, square, title)| Panel {
            title: title.into(),
            x,
            y,
            layers,
            height,
            square,
        })
}

fn figure() -> impl Strategy<Value = Figure> {
    (
        prop::collection::vec(panel(), 0..3),
        string(),
        string(),
        any::<bool>(),
        value(),
    )
        .prop_map(|(panels, title, caption, shared_x, width)| Figure {
            title: title.into(),
            caption: caption.into(),
            panels,
            shared_x,
            width,
        })
}

/// Parses the output and checks every number in it.
fn check(xml: &str) -> Result<(), TestCaseError> {
    let options = roxmltree::ParsingOptions {
        allow_dtd: true,
        ..Default::default()
    };
    let tree = match roxmltree::Document::parse_with_options(xml, options) {
        Ok(tree) => tree,
        Err(error) => return Err(TestCaseError::fail(format!("{error}\n{xml}"))),
    };
    let numeric = [
        "x",
        "y",
        "width",
        "height",
        "cx",
        "cy",
        "opacity",
        "stroke-width",
        "dy",
    ];
    for node in tree.descendants().filter(|n| n.is_element()) {
        for attribute in node.attributes() {
            let (name, value) = (attribute.name(), attribute.value());
            if numeric.contains(&name) && node.tag_name().name() != "mspace" {
                let number: f64 = value
                    .parse()
                    .map_err(|_| TestCaseError::fail(format!("{name}=\"{value}\"")))?;
                prop_assert!(number.is_finite(), "{name}=\"{value}\"");
            }
            if ["d", "viewBox", "transform"].contains(&name) {
                prop_assert!(
                    !value.contains("NaN") && !value.contains("inf"),
                    "{name}=\"{value}\""
                );
            }
            prop_assert!(!name.starts_with("on"), "event handler {name}");
        }
        prop_assert!(
            !["script", "iframe", "img", "link", "object"].contains(&node.tag_name().name())
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn figures_are_well_formed(figure in figure()) {
        let svg = figure.to_svg();
        check(&svg)?;
        prop_assert_eq!(svg, figure.to_svg());
    }

    #[test]
    fn heat_maps_are_well_formed(
        names in prop::collection::vec(string(), 0..8),
        values in prop::collection::vec(value(), 0..70),
        caption in string(),
    ) {
        check(&Heatmap::square("m", names, values).caption(caption).to_svg())?;
    }

    #[test]
    fn documents_are_well_formed(
        s in prop::collection::vec(string(), 24),
        figure in figure(),
        level: u8,
        cells in prop::collection::vec(prop::collection::vec(string(), 0..5), 0..4),
    ) {
        let t = |i: usize| Text::from(s[i].as_str());
        let mut table = Table::new([(t(0), Align::Left), (t(1), Align::Right)]).caption(t(2));
        for row in cells {
            table = table.marked(Severity::Error, row);
        }
        let html = Document::new(t(3))
            .subtitle(t(4))
            .footer(t(5))
            .heading(level, t(6)).heading(2, t(6)).heading(2, t(6)).heading(3, t(6))
            .paragraph(Text::new().bold(&*s[7]).italic(&*s[8]).code(&*s[9]).subscript(&*s[10])
                .superscript(&*s[11]).link(&*s[12], &*s[13]))
            .block(table)
            .block(figure)
            .block(Block::List(vec![t(14)]))
            .block(Block::Facts(vec![(t(15), t(16))]))
            .block(Block::Formula(vec![math::sub(math::id(&*s[17]), Math::Unit(s[18].clone()))], t(19)))
            .block(Callout { severity: Severity::Info, code: s[20].clone(), text: t(21), link: s[13].clone() })
            .block(Block::KeyFigures(vec![KeyFigure::new(t(22), t(23), &*s[0]).note(t(1))]))
            .block(Block::Details(t(2), vec![Block::Columns(vec![Block::Paragraph(t(3))])]))
            .to_html();
        check(&html)?;
    }

    #[test]
    fn any_number_can_be_written(a in value(), b in value(), digits in 0_usize..40) {
        for text in [
            number::sig(a, digits),
            number::concise(a, b),
            number::plus_minus(a, b),
            number::interval(a, b),
            number::si(a, "m/s", digits),
        ] {
            prop_assert!(!text.is_empty() && text.len() < 120, "{}", text);
            prop_assert!(!text.contains("NaN") && !text.contains("inf") && !text.contains('-'), "{}", text);
        }
    }

    /// What is written is what was given, to the digits written.
    #[test]
    fn significant_digits_read_back(value in prop::num::f64::NORMAL, digits in 1_usize..17) {
        let text = number::sig(value, digits).replace('−', "-");
        let (mantissa, exponent) = text.split_once("×10").unwrap_or((&text, "⁰"));
        let exponent: String = exponent
            .chars()
            .map(|c| match c {
                '⁻' => '-', '¹' => '1', '²' => '2', '³' => '3',
                c => char::from_digit(c as u32 - '⁰' as u32, 10).unwrap(),
            })
            .collect();
        let back: f64 = format!("{mantissa}e{exponent}").parse().unwrap();
        // Half a unit of the last digit written, and the rounding of reading it back.
        let half_unit = 0.5 * 10_f64.powi(1 - digits as i32) * value.abs();
        let tolerance = half_unit + f64::EPSILON * value.abs();
        prop_assert!(back.is_infinite() || (back - value).abs() <= tolerance, "{} {}", value, text);
    }
}
