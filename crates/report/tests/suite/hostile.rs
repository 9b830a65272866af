//! Names and paths from outside cannot become markup, and nothing is loaded from outside.

use stiction_report::{
    Align, Axis, Block, Callout, Document, Figure, Heatmap, KeyFigure, Layer, Math, Panel,
    Severity, Table, Text,
};

const EVIL: &str =
    "</script></style></title>\"'><script>alert(1)</script><img src=x onerror=alert(1)>\u{0}";

fn evil() -> Document {
    let text = || {
        Text::from(EVIL)
            .bold(EVIL)
            .code(EVIL)
            .subscript(EVIL)
            .link(EVIL, EVIL)
    };
    let panel = Panel::new(Axis::new(text(), EVIL), Axis::new(text(), EVIL))
        .title(text())
        .layer(Layer::line([0.0, 1.0], [0.0, 1.0]).label(text()))
        .layer(Layer::note(0.0, 0.0, text()));
    Document::new(text())
        .subtitle(text())
        .footer(text())
        .heading(2, text())
        .heading(2, text())
        .heading(2, text())
        .heading(2, text())
        .paragraph(text().link("x", "javascript:alert(1)"))
        .block(Figure::new(text()).caption(text()).panel(panel))
        .block(Heatmap::square(text(), [text()], [1.0]).caption(text()))
        .block(
            Table::new([(text(), Align::Left)])
                .caption(text())
                .row([text(), text()]),
        )
        .block(Block::Formula(
            vec![Math::Id(EVIL.into()), Math::Op(EVIL.into())],
            text(),
        ))
        .block(Block::List(vec![text()]))
        .block(Block::Facts(vec![(text(), text())]))
        .block(Block::KeyFigures(vec![
            KeyFigure::new(text(), text(), EVIL).note(text()),
        ]))
        .block(Callout {
            severity: Severity::Warning,
            code: EVIL.into(),
            text: text(),
            link: "JavaScript:alert(1)".into(),
        })
        .block(Block::Details(
            text(),
            vec![Block::Columns(vec![Block::Paragraph(text())])],
        ))
}

#[test]
fn nothing_becomes_an_element_or_a_script() {
    let html = evil().to_html();
    let options = roxmltree::ParsingOptions {
        allow_dtd: true,
        ..Default::default()
    };
    let tree = roxmltree::Document::parse_with_options(&html, options).unwrap();
    for node in tree.descendants().filter(|n| n.is_element()) {
        assert!(!["script", "img"].contains(&node.tag_name().name()));
        for attribute in node.attributes() {
            assert!(!attribute.name().starts_with("on"));
            if attribute.name() == "href" {
                assert!(
                    !attribute
                        .value()
                        .to_ascii_lowercase()
                        .contains("javascript:")
                );
            }
        }
    }
    // The HTML parser ends raw text earlier than an XML parser does.
    assert_eq!(html.matches("</style>").count(), 1);
    assert_eq!(
        html.matches("</title>").count(),
        html.matches("<title>").count()
    );
    assert!(!html.contains("<script") && !html.contains("<img") && !html.contains('\0'));
}

#[test]
fn nothing_is_loaded_from_outside() {
    let html = evil().to_html();
    let (_, style) = html.split_once("<style>").unwrap();
    let (style, _) = style.split_once("</style>").unwrap();
    assert!(!style.contains("url(") && !style.contains("@import") && !style.contains('<'));
    let options = roxmltree::ParsingOptions {
        allow_dtd: true,
        ..Default::default()
    };
    let tree = roxmltree::Document::parse_with_options(&html, options).unwrap();
    for attribute in tree.descendants().flat_map(|n| n.attributes()) {
        assert!(
            !["src", "srcset", "data", "action", "style"].contains(&attribute.name())
                || attribute.value().starts_with("max-width:")
        );
    }
    assert!(html.contains("default-src 'none'"));
}
