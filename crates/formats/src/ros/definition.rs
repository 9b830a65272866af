//! Message definitions of ROS 2: which fields a message has, in which order.
//!
//! Format: the text of `.msg` files, <https://docs.ros.org/en/rolling/Concepts/Basic/About-Interfaces.html>; the definitions of
//! the types that it uses follow below lines of `=`, each after a line `MSG: package/Type`.

use std::collections::HashMap;

/// Deepest nesting of messages.
const MAX_DEPTH: usize = 16;

/// Most fields of all definitions of one schema.
const MAX_FIELDS: usize = 16_384;

/// What a field is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Truth,
    /// A byte that may be part of a picture or of text.
    Byte,
    Signed(usize),
    Unsigned(usize),
    Float(usize),
    Text,
    WideText,
    /// Seconds and nanoseconds since an epoch.
    Time,
    /// Seconds and nanoseconds.
    Duration,
    /// Another definition.
    Message(usize),
}

/// How many values a field has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Count {
    One,
    Fixed(u32),
    /// As many as the message says.
    Said,
}

#[derive(Debug)]
pub(super) struct Field {
    pub(super) name: String,
    pub(super) kind: Kind,
    pub(super) count: Count,
}

/// The definitions of a schema; the first is that of the message.
#[derive(Debug)]
pub(crate) struct Definitions {
    pub(super) all: Vec<Vec<Field>>,
    /// Whether a message says when it was made.
    stamped: bool,
}

impl Definitions {
    /// Reads the text of a schema; the error says what of it is not understood.
    pub(crate) fn new(name: &str, text: &str) -> Result<Self, String> {
        let mut sections = vec![(short(name), Vec::new())];
        let mut below_rule = false;
        let mut fields = 0;
        for line in text.lines() {
            let line = line.split('#').next().unwrap_or("").trim();
            if line.len() > 2 && line.bytes().all(|byte| byte == b'=') {
                below_rule = true;
            } else if let (true, Some(name)) = (below_rule, line.strip_prefix("MSG:")) {
                sections.push((short(name.trim()), Vec::new()));
                below_rule = false;
            } else if let Some(field) = parts(line) {
                fields += 1;
                if fields > MAX_FIELDS {
                    return Err(format!("more than {MAX_FIELDS} fields"));
                }
                sections
                    .last_mut()
                    .expect("one from the start")
                    .1
                    .push(field);
            }
        }
        let names = sections.iter().enumerate().rev();
        let names: HashMap<&str, usize> =
            names.map(|(at, (name, _))| (name.as_str(), at)).collect();
        let mut all = Vec::new();
        for (inside, fields) in &sections {
            let field = |(kind, name, count): &(&str, &str, Count)| {
                Ok(Field {
                    name: (*name).to_owned(),
                    kind: kind_of(kind, inside, &names)
                        .ok_or_else(|| format!("the type {kind} of {name} is not defined"))?,
                    count: *count,
                })
            };
            let mut fields = fields
                .iter()
                .map(field)
                .collect::<Result<Vec<_>, String>>()?;
            if fields.is_empty() {
                // A message without fields has one byte nevertheless.
                fields.push(Field {
                    name: String::new(),
                    kind: Kind::Byte,
                    count: Count::One,
                });
            }
            all.push(fields);
        }
        // Each round looks one message further down, in a definition that has itself without end.
        let mut depth = vec![0; all.len()];
        for _ in 0..=MAX_DEPTH {
            for (at, fields) in all.iter().enumerate() {
                let below = fields.iter().filter_map(|field: &Field| match field.kind {
                    Kind::Message(inner) => Some(depth[inner] + 1),
                    _ => None,
                });
                depth[at] = below.max().unwrap_or(0);
            }
        }
        match depth[0] > MAX_DEPTH {
            true => Err(format!("messages nested deeper than {MAX_DEPTH}")),
            false => Ok(Self {
                stamped: all[0].iter().any(|field| match field.kind {
                    Kind::Message(inner) => all[inner].iter().any(|field| field.kind == Kind::Time),
                    kind => kind == Kind::Time,
                }),
                all,
            }),
        }
    }

    /// Whether a message says when it was made, itself or in its header.
    pub(super) fn is_stamped(&self) -> bool {
        self.stamped
    }
}

/// `package/Type` of `package/msg/Type`.
pub(super) fn short(name: &str) -> String {
    name.replace("/msg/", "/")
}

/// Type, name and count of a line that declares a field.
fn parts(line: &str) -> Option<(&str, &str, Count)> {
    let (kind, rest) = line.split_once(char::is_whitespace)?;
    let rest = rest.trim_start();
    let end = rest
        .find(|c: char| !c.is_ascii_alphanumeric() && c != '_')
        .unwrap_or(rest.len());
    let (name, after) = rest.split_at(end);
    if name.is_empty() || after.trim_start().starts_with('=') {
        // A constant has no place in a message.
        return None;
    }
    let (kind, count) = match kind.split_once('[') {
        None => (kind, Count::One),
        Some((kind, size)) => match size.strip_suffix(']')?.parse() {
            // It has no place in a message, and a list of many of them no end.
            Ok(0) => return None,
            Ok(size) => (kind, Count::Fixed(size)),
            Err(_) => (kind, Count::Said),
        },
    };
    // `string<=10` is a text like others.
    Some((kind.split("<=").next()?, name, count))
}

fn kind_of(kind: &str, inside: &str, names: &HashMap<&str, usize>) -> Option<Kind> {
    let wanted = short(kind);
    Some(match wanted.as_str() {
        "bool" => Kind::Truth,
        "byte" | "char" | "uint8" => Kind::Byte,
        "int8" => Kind::Signed(1),
        "int16" => Kind::Signed(2),
        "int32" => Kind::Signed(4),
        "int64" => Kind::Signed(8),
        "uint16" => Kind::Unsigned(2),
        "uint32" => Kind::Unsigned(4),
        "uint64" => Kind::Unsigned(8),
        "float32" => Kind::Float(4),
        "float64" => Kind::Float(8),
        "string" => Kind::Text,
        "wstring" => Kind::WideText,
        "builtin_interfaces/Time" | "time" => Kind::Time,
        "builtin_interfaces/Duration" | "duration" => Kind::Duration,
        wanted => {
            let package = inside.split('/').next().unwrap_or("");
            let full = match wanted {
                "Header" => "std_msgs/Header".to_owned(),
                wanted if wanted.contains('/') => wanted.to_owned(),
                wanted => format!("{package}/{wanted}"),
            };
            Kind::Message(*names.get(full.as_str())?)
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_constants_and_defaults() {
        let text = "# about\nuint8 A=1\nstring<=5 name\nint32[<=3] n # some\nfloat64[3] v [1,2,3]\nHeader header\n\
                    Inner inner\n===\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n\
                    ====\nMSG: a_msgs/Inner\nint16 x 7\n";
        let all = Definitions::new("a_msgs/msg/Outer", text).unwrap().all;
        let seen: Vec<_> = all[0]
            .iter()
            .map(|f| (f.name.as_str(), f.kind, f.count))
            .collect();
        assert_eq!(
            seen,
            [
                ("name", Kind::Text, Count::One),
                ("n", Kind::Signed(4), Count::Said),
                ("v", Kind::Float(8), Count::Fixed(3)),
                ("header", Kind::Message(1), Count::One),
                ("inner", Kind::Message(2), Count::One),
            ]
        );
        assert_eq!(all[1][0].kind, Kind::Time);
        assert_eq!(all[2][0].kind, Kind::Signed(2));
        assert!(Definitions::new("a/A", "Missing m").is_err());
        assert!(
            Definitions::new("a/A", "A again")
                .unwrap_err()
                .contains("deeper")
        );
    }
}
