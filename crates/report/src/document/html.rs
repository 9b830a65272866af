//! The document as HTML. Every element is closed, so the file is well-formed XML, too.

use std::collections::BTreeSet;

use super::{Block, Callout, Document, KeyFigure};
use crate::escape;
use crate::figure::svg;
use crate::text::Text;

const STYLE: &str = include_str!("document.css");
/// Fewest headings for a table of contents.
const MIN_HEADINGS_FOR_CONTENTS: usize = 4;

pub(crate) fn render(document: &Document) -> String {
    let mut body = Body::default();
    body.blocks(&document.blocks);
    let title = escape::escaped(&document.title.to_plain());
    let contents = contents(&body.headings);
    let layout = if contents.is_empty() {
        ""
    } else {
        " class=\"with-contents\""
    };
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
         <meta name=\"color-scheme\" content=\"light dark\"/>\n\
         <meta http-equiv=\"Content-Security-Policy\" \
         content=\"default-src 'none'; style-src 'unsafe-inline'\"/>\n\
         <title>{title}</title>\n<style>\n{STYLE}{}</style>\n</head>\n<body{layout}>\n",
        svg::style()
    );
    out.push_str(&format!(
        "<header>\n<h1>{}</h1>\n",
        document.title.to_html()
    ));
    if !document.subtitle.is_empty() {
        out.push_str(&format!(
            "<p class=\"subtitle\">{}</p>\n",
            document.subtitle.to_html()
        ));
    }
    out.push_str("</header>\n");
    out.push_str(&contents);
    out.push_str(&format!("<main>\n{}</main>\n", body.out));
    if !document.footer.is_empty() {
        out.push_str(&format!("<footer>{}</footer>\n", document.footer.to_html()));
    }
    out.push_str("</body>\n</html>\n");
    out
}

fn contents(headings: &[(u8, String, Text)]) -> String {
    if headings.len() < MIN_HEADINGS_FOR_CONTENTS {
        return String::new();
    }
    let mut out = String::from(
        "<nav aria-label=\"Contents\">\n<details open=\"open\"><summary>Contents</summary>\n<ul>\n",
    );
    for (level, id, text) in headings {
        let text = escape::escaped(&text.to_plain());
        out.push_str(&format!(
            "<li class=\"level-{level}\"><a href=\"#{id}\">{text}</a></li>\n"
        ));
    }
    out.push_str("</ul>\n</details>\n</nav>\n");
    out
}

/// Attributes of a part that may scroll, so that it can be scrolled with the keyboard.
fn reachable(name: &str) -> String {
    format!("role=\"group\" aria-label=\"{name}\" tabindex=\"0\"")
}

#[derive(Default)]
struct Body {
    out: String,
    headings: Vec<(u8, String, Text)>,
    anchors: BTreeSet<String>,
    figures: usize,
    tables: usize,
}

impl Body {
    fn blocks(&mut self, blocks: &[Block]) {
        for block in blocks {
            self.block(block);
        }
    }

    fn block(&mut self, block: &Block) {
        match block {
            Block::Heading(level, text) => self.heading(*level, text),
            Block::Paragraph(text) => self.push(&format!("<p>{}</p>\n", text.to_html())),
            Block::List(items) => {
                self.push("<ul>\n");
                for item in items {
                    self.push(&format!("<li>{}</li>\n", item.to_html()));
                }
                self.push("</ul>\n");
            }
            Block::Facts(facts) => {
                self.push("<dl class=\"facts\">\n");
                for (term, fact) in facts {
                    let (term, fact) = (term.to_html(), fact.to_html());
                    self.push(&format!("<div><dt>{term}</dt><dd>{fact}</dd></div>\n"));
                }
                self.push("</dl>\n");
            }
            Block::Table(table) => {
                let mut number = String::new();
                if !table.caption.is_empty() {
                    self.tables += 1;
                    number = format!("Table {}.", self.tables);
                }
                // Wide tables scroll by themselves; the frame can be reached by keyboard.
                let name = if number.is_empty() {
                    "Table"
                } else {
                    number.trim_end_matches('.')
                };
                self.push(&format!(
                    "<div class=\"scroll table\" {}>\n",
                    reachable(name)
                ));
                table.push_html(&number, &mut self.out);
                self.push("</div>\n");
            }
            Block::Figure(figure) => {
                let class = if figure.width <= 500.0 {
                    "half"
                } else {
                    "full"
                };
                let svg = figure.to_inline_svg();
                self.figure(class, "", &svg, &figure.title, &figure.caption);
            }
            Block::Drawing(drawing) => {
                let class = if drawing.half { "half" } else { "full" };
                self.figure(class, "", drawing.svg, &drawing.title, &drawing.caption);
            }
            Block::Heatmap(map) => {
                let (width, svg) = map.to_inline_svg();
                let style = format!(" style=\"max-width:{width}px\"");
                self.figure("matrix", &style, &svg, &map.title, &map.caption);
            }
            Block::Formula(lines, caption) => {
                self.push("<div class=\"formula\">\n");
                self.push(&format!(
                    "<div class=\"scroll\" {}>\n",
                    reachable("Formula")
                ));
                for line in lines {
                    self.push(&format!("{}\n", line.to_mathml()));
                }
                self.push("</div>\n");
                if !caption.is_empty() {
                    self.push(&format!("<p class=\"caption\">{}</p>\n", caption.to_html()));
                }
                self.push("</div>\n");
            }
            Block::Callout(callout) => self.callout(callout),
            Block::KeyFigures(figures) => self.key_figures(figures),
            Block::Columns(blocks) => {
                self.push("<div class=\"columns\">\n");
                for block in blocks {
                    self.push("<div>\n");
                    self.block(block);
                    self.push("</div>\n");
                }
                self.push("</div>\n");
            }
            Block::Details(summary, blocks) => {
                self.push(&format!(
                    "<details>\n<summary>{}</summary>\n<div class=\"inside\">\n",
                    summary.to_html()
                ));
                self.blocks(blocks);
                self.push("</div>\n</details>\n");
            }
        }
    }

    fn push(&mut self, html: &str) {
        self.out.push_str(html);
    }

    fn heading(&mut self, level: u8, text: &Text) {
        let level = level.clamp(2, 4);
        let id = self.anchor(&text.to_plain());
        self.push(&format!(
            "<h{level} id=\"{id}\">{}</h{level}>\n",
            text.to_html()
        ));
        if level <= 3 {
            self.headings.push((level, id, text.clone()));
        }
    }

    /// A readable anchor of its own for a heading.
    fn anchor(&mut self, text: &str) -> String {
        let mut id = String::new();
        for c in text.chars().take(80) {
            if c.is_ascii_alphanumeric() {
                id.push(c.to_ascii_lowercase());
            } else if !id.is_empty() && !id.ends_with('-') {
                id.push('-');
            }
        }
        let id = format!("section-{id}").trim_end_matches('-').to_string();
        let mut free = id.clone();
        let mut number = 2;
        while !self.anchors.insert(free.clone()) {
            free = format!("{id}-{number}");
            number += 1;
        }
        free
    }

    fn figure(&mut self, class: &str, style: &str, svg: &str, title: &Text, caption: &Text) {
        self.figures += 1;
        let n = self.figures;
        self.push(&format!(
            "<figure id=\"figure-{n}\" class=\"{class}\">\n<div class=\"scroll\" {}>\
             <div class=\"plot\"{style}>\n{svg}</div></div>\n",
            reachable(&format!("Figure {n}"))
        ));
        let point = |text: &Text| {
            let ends = text.to_plain().trim_end().ends_with(['.', '?', '!', ':']);
            if ends || text.is_empty() { "" } else { "." }
        };
        self.push(&format!(
            "<figcaption><b>Figure {n}.</b> <strong>{}{}</strong> {}</figcaption>\n</figure>\n",
            title.to_html(),
            point(title),
            caption.to_html()
        ));
    }

    fn callout(&mut self, callout: &Callout) {
        let severity = callout.severity;
        self.push(&format!(
            "<div class=\"callout {}\" role=\"note\">{}<div><p class=\"what\">{}",
            severity.class(),
            severity.sign(),
            severity.word()
        ));
        if !callout.code.is_empty() {
            let code = Text::new().code(callout.code.as_str()).to_html();
            if escape::is_safe_link(&callout.link) {
                let target = escape::escaped(callout.link.trim());
                self.push(&format!(" <a href=\"{target}\">{code}</a>"));
            } else {
                self.push(&format!(" {code}"));
            }
        }
        self.push(&format!(
            "</p><p>{}</p></div></div>\n",
            callout.text.to_html()
        ));
    }

    fn key_figures(&mut self, figures: &[KeyFigure]) {
        self.push("<dl class=\"key-figures\">\n");
        for figure in figures {
            let (class, sign) = match figure.severity {
                Some(severity) => (format!(" class=\"{}\"", severity.class()), severity.sign()),
                None => (String::new(), String::new()),
            };
            let (label, value) = (figure.label.to_html(), figure.value.to_html());
            let unit = match figure.unit.as_str() {
                "" => String::new(),
                unit => format!(" <span class=\"unit\">{}</span>", escape::escaped(unit)),
            };
            self.push(&format!(
                "<div{class}><dt>{label}{sign}</dt><dd><span class=\"value\">{value}</span>{unit}</dd>"
            ));
            if !figure.note.is_empty() {
                self.push(&format!(
                    "<dd class=\"remark\">{}</dd>",
                    figure.note.to_html()
                ));
            }
            self.push("</div>\n");
        }
        self.push("</dl>\n");
    }
}
