//! The document in JSON, schema `stiction.domain/1`.

use super::draw::{self, Draws, Width};
use super::{Head, Number, Own};
use crate::joint::six_digits;

/// Name of the schema.
const SCHEMA: &str = "stiction.domain/1";

/// The whole text, plain ASCII.
pub(super) fn text(head: &Head, joints: &[Own], draws: Option<&Draws>) -> String {
    let inputs = head.provenance.inputs.iter();
    let inputs = inputs.map(|(path, sum)| {
        format!(
            "{{\"path\": {}, \"sha256\": {}}}",
            string(path),
            string(sum)
        )
    });
    let notes = head.notes.iter().map(|note| string(note));
    let mut out = format!(
        "{{\n  \"schema\": \"{SCHEMA}\",\n  \"name\": {},\n  \"version\": {},\n  \"model_sha256\": {},\n  \"inputs\": {},\n  \
         \"notes\": {},\n  \"joints\": [",
        string(head.title),
        string(&head.provenance.version),
        string(&head.provenance.model_sha256),
        list(inputs),
        list(notes),
    );
    for (k, own) in joints.iter().enumerate() {
        out.push_str(if k == 0 { "\n" } else { ",\n" });
        out.push_str(&joint(own));
    }
    out.push_str("\n  ]");
    if let Some(draws) = draws {
        out.push_str(&format!(
            ",\n  \"draws\": {{\n    \"count\": {}, \"seed\": {}, \"width\": \"{}\",\n    \"joints\": {{",
            draws.count,
            draws.seed,
            draws.width.name()
        ));
        for (k, own) in joints.iter().enumerate() {
            out.push_str(if k == 0 { "\n" } else { ",\n" });
            let drawn = draw::of(own, k, draws);
            let lines = drawn.iter().map(|(name, values)| {
                let values = values.iter().map(|x| number(*x));
                format!("        {}: {}", string(name), list(values))
            });
            let lines: Vec<String> = lines.collect();
            out.push_str(&format!(
                "      {}: {{\n{}\n      }}",
                string(&own.name),
                lines.join(",\n")
            ));
        }
        out.push_str("\n    }\n  }");
    }
    out.push_str("\n}\n");
    out
}

fn joint(own: &Own) -> String {
    let line = |n: &Number| {
        let range = |width| match n.range(width) {
            Some(ends) if ends.iter().all(|end| end.is_finite()) => {
                list(ends.into_iter().map(number))
            }
            _ => "null".into(),
        };
        let [repeatability, transfer] = Width::ALL.map(range);
        format!(
            "        {}: {{\"unit\": {}, \"nominal\": {}, \"repeatability\": {repeatability}, \"transfer\": {transfer}, \"determined\": {}}}",
            string(&n.name),
            string(&n.unit),
            number(n.nominal),
            n.is_determined
        )
    };
    let numbers: Vec<String> = own.domain.numbers.iter().map(line).collect();
    let names = own.domain.numbers.iter().map(|n| string(&n.name));
    let rows = own.domain.root.iter().map(|a| {
        let along = |b: &Vec<f64>| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let row = own.domain.root.iter().map(|b| {
            let three = (1e3 * along(b)).round() / 1e3;
            number(if three == 0.0 { 0.0 } else { three })
        });
        list(row)
    });
    format!(
        "    {{\n      \"name\": {}, \"kind\": \"{}\", \"law\": {},\n      \"numbers\": {{\n{}\n      }},\n      \"correlation\": {{\n        \
         \"names\": {},\n        \"matrix\": {}\n      }}\n    }}",
        string(&own.name),
        if own.model.rotary { "rotary" } else { "linear" },
        string(own.model.law()),
        numbers.join(",\n"),
        list(names),
        list(rows),
    )
}

fn list(each: impl Iterator<Item = String>) -> String {
    let each: Vec<String> = each.collect();
    format!("[{}]", each.join(", "))
}

/// Six digits.
fn number(x: f64) -> String {
    format!("{:?}", six_digits(x))
}

/// A text as JSON has it, plain ASCII.
pub(crate) fn string(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.encode_utf16() {
        match char::from_u32(u32::from(c)) {
            Some(c @ ('"' | '\\')) => out.extend(['\\', c]),
            Some(c @ ' '..='~') => out.push(c),
            _ => out.push_str(&format!("\\u{c:04x}")),
        }
    }
    out.push('"');
    out
}
