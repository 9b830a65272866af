//! PLCopen TC6 XML, version 2.01: the variables as elements, the statements as text.

use super::unit::Unit;
use crate::Model;
use std::fmt::Write;

/// The date is not that of the export: the same model gives the same bytes.
const DATE: &str = "2000-01-01T00:00:00";

pub(super) fn project(model: &Model, units: &[Unit]) -> String {
    let mut out = String::from("<?xml version=\"1.0\" encoding=\"utf-8\"?>\n");
    let _ = write!(
        out,
        "<project xmlns=\"http://www.plcopen.org/xml/tc6_0201\" xmlns:xhtml=\"http://www.w3.org/1999/xhtml\">\n\
         \x20 <fileHeader companyName=\"\" productName=\"stiction\" productVersion=\"{}\" creationDateTime=\"{DATE}\"/>\n\
         \x20 <contentHeader name=\"{}_friction\">\n\
         \x20   <coordinateInfo>\n\
         \x20     <fbd><scaling x=\"1\" y=\"1\"/></fbd>\n\
         \x20     <ld><scaling x=\"1\" y=\"1\"/></ld>\n\
         \x20     <sfc><scaling x=\"1\" y=\"1\"/></sfc>\n\
         \x20   </coordinateInfo>\n\
         \x20 </contentHeader>\n\
         \x20 <types>\n\
         \x20   <dataTypes/>\n\
         \x20   <pous>\n",
        escape(&model.provenance.version),
        model.identifier
    );
    for unit in units {
        pou(unit, &mut out);
    }
    out.push_str(
        "    </pous>\n  </types>\n  <instances>\n    <configurations/>\n  </instances>\n</project>\n",
    );
    out
}

fn pou(unit: &Unit, out: &mut String) {
    let kind = if unit.program {
        "program"
    } else {
        "functionBlock"
    };
    let name = &unit.name;
    let _ = writeln!(
        out,
        "      <pou name=\"{name}\" pouType=\"{kind}\">\n        <interface>"
    );
    // Its own line, the comment, then the variables.
    let (_, after) = unit.declaration.split_once('\n').unwrap_or_default();
    let at = after.find("\nVAR").map_or(0, |i| i + 1);
    let (head, declaration) = after.split_at(at);
    for line in declaration.lines().map(str::trim) {
        match line {
            "VAR_INPUT" => out.push_str("          <inputVars>\n"),
            "VAR_OUTPUT" => out.push_str("          <outputVars>\n"),
            "VAR" => out.push_str("          <localVars>\n"),
            "VAR RETAIN" => out.push_str("          <localVars retain=\"true\">\n"),
            "END_VAR" => {
                // Closes what was opened last.
                let opened = ["inputVars", "outputVars", "localVars"];
                let last = opened
                    .iter()
                    .max_by_key(|tag| out.rfind(&format!("<{tag}")));
                let _ = writeln!(out, "          </{}>", last.unwrap_or(&"localVars"));
            }
            _ => variable(line, out),
        }
    }
    let text = escape(&format!("{head}{}", unit.body));
    let _ = write!(
        out,
        "        </interface>\n        <body>\n          <ST>\n            <xhtml:p>{text}</xhtml:p>\n          </ST>\n        </body>\n      </pou>\n"
    );
}

/// `name : TYPE := value; (* words *)`; other lines are comments.
fn variable(line: &str, out: &mut String) {
    let Some((declared, words)) = line.split_once(';') else {
        return;
    };
    let Some((name, rest)) = declared.split_once(" : ") else {
        return;
    };
    let (kind, value) = match rest.split_once(" := ") {
        Some((kind, value)) => (kind, Some(value)),
        None => (rest, None),
    };
    let kind = match kind {
        "BOOL" | "DINT" | "REAL" | "LREAL" => format!("<{kind}/>"),
        other => format!("<derived name=\"{other}\"/>"),
    };
    let _ = write!(
        out,
        "            <variable name=\"{name}\">\n              <type>{kind}</type>\n"
    );
    if let Some(value) = value {
        let _ = writeln!(
            out,
            "              <initialValue><simpleValue value=\"{value}\"/></initialValue>"
        );
    }
    let words = words
        .trim()
        .trim_start_matches("(*")
        .trim_end_matches("*)")
        .trim();
    if !words.is_empty() {
        let words = escape(words);
        let _ = writeln!(
            out,
            "              <documentation><xhtml:p>{words}</xhtml:p></documentation>"
        );
    }
    out.push_str("            </variable>\n");
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}
