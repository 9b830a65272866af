//! `[[sweep]]`: a key with several values in turn, each of which makes a study of its own.

use crate::config::{Given, Source, Swept, Table};
use crate::error::Error;
use crate::study::plan::{Sweep, SweepPoint};
use std::cell::Cell;
use stiction_formats::{Dimension, Kind, Value};
use toml::de::DeTable;

/// Most sweeps, and most values of one: each is a study in memory, with its paths.
const MOST_SWEEPS: usize = 4;
const MOST_VALUES: usize = 16;
/// Tables whose keys can be swept; `law` has the parameters of the first axis.
const TABLES: [&str; 7] = [
    "law",
    "axis",
    "path",
    "contour",
    "controller",
    "compensator",
    "event",
];

/// A sweep as it stands in the file.
pub(super) struct Asked<'a> {
    key: Given<'a>,
    name: &'a str,
    dimension: Dimension,
    values: Vec<(f64, Given<'a>)>,
}

/// The sweeps of a study file.
pub(super) fn asked<'a>(root: &Table<'a>) -> Result<Vec<Asked<'a>>, Error> {
    let mut all: Vec<Asked<'a>> = Vec::new();
    for table in root.tables("sweep", MOST_SWEEPS)? {
        let key = table.required("key", table.get("key"), "one such as \"law.sigma0\"")?;
        let name = key.text()?;
        let known = |(first, rest): &(&str, &str)| TABLES.contains(first) && !rest.is_empty();
        let Some((first, rest)) = name.split_once('.').filter(known) else {
            let allowed = format!(
                "a key with its table, {}, such as \"law.sigma0\" or \"path.amplitude\"",
                TABLES.join(", ")
            );
            return Err(key.refused(&allowed));
        };
        if is_text(root, first, rest) {
            let allowed = format!(
                "a key whose value is a number or has a unit, of {}: such as law.sigma0, axis.mass, path.amplitude, \
                 controller.bandwidth or compensator.gain; for other texts give a study each, or a [[path]], [[controller]] or \
                 [[compensator]] each",
                TABLES.join(", ")
            );
            return Err(key.refuse(format!("{name:?} is a text"), &allowed));
        }
        if all.iter().any(|other| other.name == name) {
            return Err(key.refuse(format!("{name:?} twice"), "each key once"));
        }
        let example = "a list such as [\"1e6 N/m\", \"2e6 N/m\"]";
        let list = table.required("values", table.get("values"), example)?;
        let values = list.as_list().ok_or_else(|| list.refused(example))?;
        if !(2..=MOST_VALUES).contains(&values.len()) {
            let found = format!("{} values", values.len());
            return Err(list.refuse(found, &format!("2 to {MOST_VALUES}")));
        }
        let (values, dimension) = ascending(name, values)?;
        table.end()?;
        all.push(Asked {
            key,
            name,
            dimension,
            values,
        });
    }
    Ok(all)
}

/// Whether the file has text for a key of a table, or of an entry of a list, that is neither a value with its unit nor the
/// word for having none.
fn is_text(root: &Table<'_>, first: &str, rest: &str) -> bool {
    let Some(given) = root.find(first) else {
        return false;
    };
    let tables = match given.as_list() {
        Some(list) => list.iter().filter_map(Given::as_table).collect(),
        None => Vec::from_iter(given.as_table()),
    };
    let text = |given: Given<'_>| {
        let text = given.as_text();
        text.is_some_and(|text| text != "none" && Value::parse(text).is_err())
    };
    tables.iter().filter_map(|table| table.find(rest)).any(text)
}

/// The values of a key in SI, each larger than the one before, and what they measure.
fn ascending<'a>(
    name: &str,
    values: Vec<Given<'a>>,
) -> Result<(Vec<(f64, Given<'a>)>, Dimension), Error> {
    let mut known: Vec<(f64, Given<'a>)> = Vec::new();
    let mut dimension = Dimension::ONE;
    for (i, given) in values.into_iter().enumerate() {
        let (x, of) = match given.as_number().filter(|x| x.is_finite()) {
            Some(x) => (x, Dimension::ONE),
            None => {
                let text = given.as_text();
                if text.is_some_and(|text| Value::parse(text).is_err_and(|e| e.kind == Kind::Value))
                {
                    let found = format!("{} for {name}", given.shown());
                    let allowed = "a number, or a value with its unit such as \"1e6 N/m\"; a text cannot be swept";
                    return Err(given.refuse(found, allowed));
                }
                let value = given.quantity("\"1e6 N/m\", or a number")?;
                (value.si(), value.unit.dimension())
            }
        };
        if i > 0 && of != dimension {
            let first = known[0].1.shown();
            let found = format!("{} beside {first}, the first of the list", given.shown());
            let allowed =
                format!("all with units of one kind, that of {name}: one of both is wrong");
            return Err(given.refuse(found, &allowed));
        }
        if known.last().is_some_and(|(before, _)| x <= *before) {
            return Err(given.refused("above the value before it"));
        }
        dimension = of;
        known.push((x, given));
    }
    Ok((known, dimension))
}

impl<'a> Asked<'a> {
    /// The study of each value.
    pub fn resolve(&self, source: Source<'a>, entries: &'a DeTable<'a>) -> Result<Sweep, Error> {
        let point = |(value, given): &(f64, Given<'a>)| {
            let taken = Cell::new(false);
            let swept = Swept {
                key: self.name,
                value: given,
                taken: &taken,
            };
            let swept = Source {
                swept: Some(swept),
                ..source
            };
            let study = super::study(&Table::root(swept, entries), source);
            let study = study.map_err(|e| self.with(given, e))?;
            if !taken.get() {
                let allowed = "a parameter that the law has, a key of [axis], or one that a path, contour, controller, compensator or \
                               event of this study gives";
                return Err(self.key.refused(allowed));
            }
            Ok(SweepPoint {
                value: *value,
                study,
            })
        };
        Ok(Sweep {
            key: self.name.into(),
            unit: self.unit(),
            points: self.values.iter().map(point).collect::<Result<_, _>>()?,
        })
    }

    /// SI unit of the values; a rate that is written in hertz is one.
    fn unit(&self) -> String {
        let first = self.values.first().and_then(|(_, given)| given.as_text());
        match self.dimension {
            Dimension::ONE => String::new(),
            Dimension::FREQUENCY if first.is_some_and(|text| text.ends_with("Hz")) => "Hz".into(),
            dimension => dimension.si_text(),
        }
    }

    /// What is refused with a value of the sweep, at another place than that value.
    fn with(&self, given: &Given<'_>, error: Error) -> Error {
        match error {
            Error::Config {
                file,
                place,
                found,
                allowed,
            } if place != given.place() || !found.contains(&given.shown()) => Error::Config {
                found: format!("{found}, with {} = {}", self.name, given.shown()),
                file,
                place,
                allowed,
            },
            other => other,
        }
    }
}
