//! A model file as text: every key asked for, and where each stands.

use super::fault;
use super::form::{BacklashEntry, ModelFile, ModelParameter, SCHEMA, SourceEntry, SourceInput};
use crate::config::{ANY_COUNT, Form, Given, Places, Source, Table};
use crate::error::Error;
use crate::hash::sha256_of;
use crate::result::{
    CovarianceEntry, FrictionLineEntry, PitchEntry, RangeEntry, RemainingEntry, ShapeEntry,
    ValueEntry,
};
use crate::symbols;
use std::ops::RangeInclusive;
use std::path::Path;
use stiction_log::Motion;
use stiction_parameters::Name;

/// The method of a model that was written by hand.
pub(crate) const BY_HAND: &str = "by hand";

/// Most faults of one file that are said.
const MOST_SAID: usize = 20;

/// What the text of a model is called in messages where it is in no file.
const IN_MEMORY: &str = "model";

/// A model with the text it was read from, for messages about its values.
pub struct ReadModel {
    /// The model.
    pub model: ModelFile,
    /// SHA-256 of the text, hexadecimal.
    pub sha256: String,
    places: Places,
}

impl ReadModel {
    /// Reads a model file from disk.
    ///
    /// # Errors
    /// As [`ModelFile::read`].
    pub fn read(file: impl AsRef<Path>) -> Result<Self, Error> {
        let file = file.as_ref();
        let text = crate::config::read(file, Form::Model)?;
        Self::named(&text, file)
    }

    /// Reads the text of a model file.
    ///
    /// # Errors
    /// As [`ModelFile::parse`].
    pub fn parse(text: &str) -> Result<Self, Error> {
        Self::named(text, Path::new(IN_MEMORY))
    }

    /// A model in memory, checked by the same rules; messages have keys and no lines. The hash is that of the file
    /// that it would be written as.
    ///
    /// # Errors
    /// When its parameters do not fit its law.
    pub fn of(model: &ModelFile) -> Result<Self, Error> {
        Self::checked(
            model.clone(),
            model.to_toml().as_bytes(),
            Places::in_memory(IN_MEMORY, Form::Model),
            Faults::default(),
        )
    }

    pub(crate) fn named(text: &str, file: &Path) -> Result<Self, Error> {
        let source = Source {
            file,
            text,
            form: Form::Model,
            swept: None,
        };
        let entries = source.parse()?;
        let mut faults = Faults::default();
        let model = model(&Table::root(source, &entries), &mut faults)?;
        let places = Places::of(&source, &entries);
        Self::checked(model, text.as_bytes(), places, faults)
    }

    /// Everything that is wrong, of the form and of the values, is said at once.
    fn checked(
        mut model: ModelFile,
        text: &[u8],
        places: Places,
        mut faults: Faults,
    ) -> Result<Self, Error> {
        if let Some(unit) = fault::drive(&model.force_unit) {
            model.force_unit = unit;
        }
        let of_a_parameter = |key: &String| key.starts_with("parameter");
        let whole = !faults.unread.iter().any(of_a_parameter);
        for (key, found, allowed) in fault::faults(&model, whole) {
            // What could not be read has no value that could be wrong.
            let unread = |unread: &String| key.starts_with(unread);
            if !faults.unread.iter().any(unread) {
                faults.errors.push(places.refuse(&key, found, &allowed));
            }
        }
        let by_hand = model.source.method == BY_HAND;
        let read = ReadModel {
            model,
            sha256: sha256_of(text),
            places,
        };
        let named = read.model.parameter.iter().all(|p| !p.name.is_empty());
        let whole = named && faults.knows_the_law();
        if let Some(missing) = read.missing().filter(|_| by_hand && whole) {
            let allowed = format!(
                "a [[parameter]] for each that the law {} has",
                read.model.law
            );
            let error = read.refuse("parameter", format!("no {missing}"), &allowed);
            faults.errors.push(error);
        }
        faults.errors.truncate(MOST_SAID);
        match Error::of_all(faults.errors) {
            Some(error) => Err(error),
            None => Ok(read),
        }
    }

    /// The parameters of its law that it does not have.
    pub fn missing(&self) -> Option<String> {
        let values = self.model.values()?;
        let names: Vec<_> = values.missing().map(|quantity| quantity.stem()).collect();
        (!names.is_empty()).then(|| names.join(", "))
    }

    /// A value that cannot be used: its key, such as `law` or `parameter[2].value`, what was found, what is allowed.
    pub fn refuse(&self, key: &str, found: impl Into<String>, allowed: &str) -> Error {
        self.places.refuse(key, found.into(), allowed)
    }

    /// The same of a parameter by its name, or of all of them where the model has no such parameter.
    pub fn refuse_parameter(&self, name: &str, found: impl Into<String>, allowed: &str) -> Error {
        self.refuse(&self.value_key(name), found, allowed)
    }

    /// The file that it was read from; `model` where it was in memory.
    pub fn file(&self) -> &Path {
        self.places.file()
    }

    /// The place of a key or, where it is missing, of the table that lacks it, as errors begin:
    /// `line 4, column 7, law: `.
    pub fn place(&self, key: &str) -> String {
        self.places.place(key)
    }

    /// Where the value of a parameter stands, or all of them where the model has no such parameter, as errors begin:
    /// `line 28, column 9, parameter[2].value: `.
    pub fn place_of_parameter(&self, name: &str) -> String {
        self.places.place(&self.value_key(name))
    }

    fn value_key(&self, name: &str) -> String {
        let sided = format!("{name}_pos");
        let of = |name: &str| self.model.parameter.iter().position(|p| p.name == name);
        match of(name).or_else(|| of(&sided)) {
            Some(i) => format!("parameter[{}].value", i + 1),
            None => "parameter".into(),
        }
    }
}

/// What is wrong with the form of a file, gathered so that all of it is said at once.
#[derive(Default)]
struct Faults {
    errors: Vec<Error>,
    /// Beginnings of the keys that could not be read.
    unread: Vec<String>,
}

impl Faults {
    /// What was read, if it could be; `key` is what could not.
    fn take<T>(&mut self, key: impl Into<String>, read: Result<T, Error>) -> Option<T> {
        read.map_err(|e| {
            self.errors.push(e);
            self.unread.push(key.into());
        })
        .ok()
    }

    /// Whether the law could be read, and a list of parameters.
    fn knows_the_law(&self) -> bool {
        let unread = ["law", "parameter"];
        !self.unread.iter().any(|key| unread.contains(&key.as_str()))
    }
}

/// The model; keys that could not be read stand in the faults. What an identification writes beside law, parameters and
/// units may be left out of a file that is written by hand.
fn model(root: &Table<'_>, faults: &mut Faults) -> Result<ModelFile, Error> {
    let schema = root.text("schema").and_then(|schema| match schema {
        Some(schema) if schema != SCHEMA => {
            let allowed = format!("this version reads {SCHEMA:?}");
            Err(root.refuse("schema", format!("{schema:?}"), &allowed))
        }
        _ => Ok(()),
    });
    // Another schema has other keys.
    schema?;
    let name = faults.take("name", root.line("name")).flatten();
    let law = text(root, "law", "a law such as \"lugre\"");
    let law = faults.take("law", law);
    let kind = faults.take("kind", root.text("kind")).flatten();
    let unit = faults.take("force_unit", root.text("force_unit")).flatten();
    let asymmetric = faults.take("asymmetric", root.flag("asymmetric")).flatten();
    let trustworthy = faults.take("trustworthy", root.flag("trustworthy"));
    let source = root.table("source").and_then(|table| match table {
        Some(table) => self::source(&table),
        None => Ok(SourceEntry {
            version: String::new(),
            method: BY_HAND.into(),
            seed: 0,
            top_speed: None,
            rate_hz: None,
            inputs: Vec::new(),
        }),
    });
    let source = faults.take("source", source);
    let covariance = root.table("covariance").and_then(|table| match table {
        Some(table) => self::covariance(&table),
        None => Ok(CovarianceEntry::default()),
    });
    let covariance = faults.take("covariance", covariance);
    let remaining = root.table("remaining").and_then(|table| match table {
        Some(table) => self::remaining(&table).map(Some),
        None => Ok(None),
    });
    let remaining = faults.take("remaining", remaining).flatten();
    let line = root.table("line").and_then(|table| match table {
        Some(table) => self::line(&table).map(Some),
        None => Ok(None),
    });
    let line = faults.take("line", line).flatten();
    let range = root.table("range").and_then(|table| match table {
        Some(table) => self::range(&table),
        None => Ok(RangeEntry::default()),
    });
    let range = faults.take("range", range);
    let pitch = root.table("pitch").and_then(|table| match table {
        Some(table) => pitches(&table),
        None => Ok(PitchEntry::default()),
    });
    let pitch = faults.take("pitch", pitch);
    let backlash = root.table("backlash").and_then(|table| match table {
        Some(table) => gap(&table).map(Some),
        None => Ok(None),
    });
    let backlash = faults.take("backlash", backlash).flatten();
    let listed = list(root, "parameter", "tables [[parameter]]");
    let listed = faults.take("parameter", listed).unwrap_or_default();
    let parameter: Vec<_> = (listed.iter().enumerate())
        .map(|(i, given)| parameter(given, &format!("parameter[{}]", i + 1), faults))
        .collect();
    faults.errors.extend(root.strangers());
    let sided = |p: &ModelParameter| p.name.ends_with("_pos") || p.name.ends_with("_neg");
    let force_unit = unit.map_or_else(|| unit_of_force(&parameter), str::to_string);
    Ok(ModelFile {
        schema: SCHEMA.into(),
        name: name.map(str::to_string),
        kind: match kind {
            Some(kind) => kind.into(),
            None => kind_of(&parameter, &force_unit).into(),
        },
        law: law.unwrap_or_default(),
        asymmetric: asymmetric.unwrap_or_else(|| parameter.iter().any(sided)),
        force_unit,
        trustworthy: trustworthy.flatten().unwrap_or(true),
        source: source.unwrap_or_default(),
        range: range.unwrap_or_default(),
        pitch: pitch.unwrap_or_default(),
        backlash,
        parameter,
        covariance: covariance.unwrap_or_default(),
        line,
        remaining,
    })
}

/// The unit of the first parameter that is a force.
fn unit_of_force(parameters: &[ModelParameter]) -> String {
    let forces = [
        "coulomb",
        "coulomb_pos",
        "coulomb_neg",
        "static",
        "static_pos",
    ];
    let found = forces
        .iter()
        .find_map(|name| parameters.iter().find(|p| p.name == *name));
    found.map_or("N".into(), |p| p.unit.clone())
}

/// Linear or rotary, as more of the units have it.
fn kind_of(parameters: &[ModelParameter], force: &str) -> &'static str {
    let fits = |motion: Motion| {
        let fits = |p: &&ModelParameter| {
            let name: Option<Name> = p.name.parse().ok();
            name.is_some_and(|name| {
                let unit = symbols::unit(name.quantity.dimension(), motion, force, "");
                fault::same_unit(&p.unit, &unit)
            })
        };
        parameters.iter().filter(fits).count()
    };
    match fits(Motion::Rotary) > fits(Motion::Linear) {
        true => "rotary",
        false => "linear",
    }
}

fn source(table: &Table<'_>) -> Result<SourceEntry, Error> {
    let seed = table.count("seed", 0, ANY_COUNT)?;
    let inputs = list(table, "inputs", "a list of logs, which may be empty")?;
    let source = SourceEntry {
        version: text(table, "version", "the version that wrote the model")?,
        method: text(
            table,
            "method",
            "the method that found it, such as \"separable\"",
        )?,
        seed: table.required("seed", seed, "the seed of the search, such as 0")?,
        top_speed: table.get("top_speed").map(|x| number(&x)).transpose()?,
        rate_hz: table.get("rate_hz").map(|x| number(&x)).transpose()?,
        inputs: each(&inputs, |table| {
            let input = SourceInput {
                path: text(table, "path", "the path of a log")?,
                sha256: text(table, "sha256", "the SHA-256 of the log")?,
            };
            table.end()?;
            Ok(input)
        })?,
    };
    table.end()?;
    Ok(source)
}

/// A parameter; one that could not be read is empty and stands in the faults by `place`.
fn parameter(given: &Given<'_>, place: &str, faults: &mut Faults) -> ModelParameter {
    let Some(table) = given.as_table() else {
        let read: Result<(), Error> = Err(given.refused("a table [[parameter]]"));
        faults.take(place, read);
        return ModelParameter::default();
    };
    let name = text(&table, "name", "a parameter such as \"sigma0\"");
    let name = faults.take(place, name).unwrap_or_default();
    let value = table.required("value", table.get("value"), "a number in its unit");
    let value = faults.take(place, value.and_then(|value| number(&value)));
    let unit = faults.take(place, text(&table, "unit", "a unit such as \"N/m\""));
    let symbol = faults.take(place, table.text("symbol")).flatten();
    let std = table.get("std").map(|x| number(&x)).transpose();
    let std = faults.take(place, std).flatten();
    let ci95 = table.get("ci95").map(|x| self::interval(&x)).transpose();
    let ci95 = faults.take(place, ci95).flatten();
    let transfer = table.get("transfer").map(|x| half_width(&x)).transpose();
    let transfer = faults.take(place, transfer).flatten();
    let interval = faults.take(place, table.text("interval")).flatten();
    let identifiable = faults.take(place, table.flag("identifiable")).flatten();
    let origin = faults.take(place, table.text("origin")).flatten();
    faults.errors.extend(table.strangers());
    let measured = std.is_some() || ci95.is_some();
    ModelParameter {
        symbol: symbol.map_or_else(|| symbols::symbol(&name), str::to_string),
        name,
        value: value.unwrap_or_default(),
        unit: unit.unwrap_or_default(),
        std,
        ci95,
        transfer,
        interval: interval.map(str::to_string),
        identifiable: identifiable.unwrap_or(true),
        origin: match origin {
            Some(origin) => origin.into(),
            None if measured => "identified".into(),
            None => "given".into(),
        },
    }
}

fn covariance(table: &Table<'_>) -> Result<CovarianceEntry, Error> {
    let names = list(table, "names", "a list of names, which may be empty")?;
    let rows = list(table, "matrix", "a row of numbers for each name")?;
    let names = names.iter().map(|name| Ok(name.text()?.to_string()));
    let rows = rows.iter().map(|row| {
        let numbers = row
            .as_list()
            .ok_or_else(|| row.refused("a row of numbers"))?;
        numbers.iter().map(number).collect()
    });
    let covariance = CovarianceEntry {
        names: names.collect::<Result<_, Error>>()?,
        matrix: rows.collect::<Result<_, Error>>()?,
    };
    table.end()?;
    Ok(covariance)
}

/// Coulomb and viscous friction as simulators take it.
fn line(table: &Table<'_>) -> Result<FrictionLineEntry, Error> {
    let value = |key: &'static str| {
        let allowed = "a table with value, at_once, repeat and transfer";
        let own = table.required(key, table.table(key)?, allowed)?;
        let half = |key: &'static str| {
            let given = own.required(key, own.get(key), "half of a 95 % interval")?;
            half_width(&given)
        };
        let given = own.required("value", own.get("value"), "a number in its unit")?;
        let number = number(&given)?;
        if number.is_nan() || number.abs() > LARGEST_SEEN {
            return Err(given.refuse(format!("{number:?}"), "from -1e15 to 1e15"));
        }
        let value = ValueEntry {
            value: number,
            at_once: half("at_once")?,
            repeat: half("repeat")?,
            transfer: half("transfer")?,
        };
        own.end()?;
        Ok(value)
    };
    let line = FrictionLineEntry {
        coulomb: value("coulomb")?,
        viscous: value("viscous")?,
        viscous_unit: text(table, "viscous_unit", "a unit such as \"N*s/m\"")?,
        correlation: (table.get("correlation"))
            .map(|given| correlation(&given))
            .transpose()?,
        correlation_with_mass: (table.get("correlation_with_mass"))
            .map(|given| match given.as_list().as_deref() {
                Some([coulomb, viscous]) => Ok([correlation(coulomb)?, correlation(viscous)?]),
                _ => Err(given.refused("two numbers from -1 to 1")),
            })
            .transpose()?,
    };
    table.end()?;
    Ok(line)
}

fn correlation(given: &Given<'_>) -> Result<f64, Error> {
    let found = number(given)?;
    let known = (-1.0..=1.0).contains(&found);
    known
        .then_some(found)
        .ok_or_else(|| given.refuse(format!("{found:?}"), "from -1 to 1"))
}

/// Half of an interval.
fn half_width(given: &Given<'_>) -> Result<f64, Error> {
    let found = number(given)?;
    let known = (0.0..=LARGEST_SEEN).contains(&found);
    known
        .then_some(found)
        .ok_or_else(|| given.refuse(format!("{found:?}"), "from 0 to 1e15"))
}

/// What the log has seen.
fn range(table: &Table<'_>) -> Result<RangeEntry, Error> {
    let ends = |key: &'static str| {
        let Some(given) = table.get(key) else {
            return Ok(None);
        };
        let allowed = "the least and the largest value, such as [0.0, 0.4]";
        let ends = match given.as_list().as_deref() {
            Some([low, high]) => [number(low)?, number(high)?],
            _ => return Err(given.refused(allowed)),
        };
        let known = ends.iter().all(|x| x.abs() <= LARGEST_SEEN) && ends[0] <= ends[1];
        match known {
            true => Ok(Some(ends)),
            false => Err(given.refuse(format!("{ends:?}"), allowed)),
        }
    };
    let largest = |key: &'static str| {
        let there = table.get(key).is_some();
        there.then(|| size(table, key)).transpose()
    };
    let range = RangeEntry {
        position: ends("position")?,
        wrap: largest("wrap")?,
        load: ends("load")?,
        temperature: ends("temperature")?,
        transmitted: ends("transmitted")?,
        acceleration: largest("acceleration")?,
        speed: largest("speed")?,
    };
    table.end()?;
    Ok(range)
}

/// Largest size of a value that a log has seen, SI.
const LARGEST_SEEN: f64 = 1e15;

/// Pitches of waves.
fn pitches(table: &Table<'_>) -> Result<PitchEntry, Error> {
    let of = |key: &'static str| {
        let allowed = "a list of at most 4 lengths from 1e-12 to 1e12, such as [0.024]";
        let Some(given) = table.get(key) else {
            return Ok(Vec::new());
        };
        let listed = given.as_list().ok_or_else(|| given.refused(allowed))?;
        let numbers: Vec<f64> = listed.iter().map(number).collect::<Result<_, Error>>()?;
        let good = numbers.len() <= 4 && numbers.iter().all(|x| (1e-12..=1e12).contains(x));
        match good {
            true => Ok(numbers),
            false => Err(given.refuse(format!("{numbers:?}"), allowed)),
        }
    };
    let pitch = PitchEntry {
        cogging: of("cogging")?,
        coulomb: of("coulomb")?,
    };
    table.end()?;
    Ok(pitch)
}

/// A gap between motor and load.
fn gap(table: &Table<'_>) -> Result<BacklashEntry, Error> {
    let width = extent(table, "width")?;
    let ci95 = table.get("ci95").map(|given| {
        let ends = interval(&given)?;
        match ends[0] <= width && width <= ends[1] {
            true => Ok(ends),
            false => Err(given.refuse(format!("{ends:?}"), "an interval around the width")),
        }
    });
    let load = table.get("load").map(|given| {
        let part = number(&given)?;
        let allowed = "the load as a part of the moving mass, above 0 and below 1";
        match part > 0.0 && part < 1.0 {
            true => Ok(part),
            false => Err(given.refused(allowed)),
        }
    });
    let entry = BacklashEntry {
        width,
        ci95: ci95.transpose()?,
        load: load.transpose()?,
    };
    table.end()?;
    Ok(entry)
}

/// Whether a gap is such as is read.
pub(super) fn is_gap(gap: &BacklashEntry) -> bool {
    let around = |[low, high]: [f64; 2]| low <= gap.width && gap.width <= high;
    EXTENTS.contains(&gap.width)
        && gap.ci95.is_none_or(around)
        && gap.load.is_none_or(|load| load > 0.0 && load < 1.0)
}

/// Most forces after a reversal that a law leaves.
const MOST_SHAPES: usize = 16;

/// What the law leaves: sizes that are not negative, lengths and times above 0.
fn remaining(table: &Table<'_>) -> Result<RemainingEntry, Error> {
    let allowed = "a list of at most 16 forces after a reversal";
    let shapes = list(table, "shapes", allowed)?;
    if shapes.len() > MOST_SHAPES
        && let Some(given) = table.get("shapes")
    {
        return Err(given.refused(allowed));
    }
    let remaining = RemainingEntry {
        level: part(table, "level")?,
        shapes: each(&shapes, |table| {
            let shape = ShapeEntry {
                force: size(table, "force")?,
                short: extent(table, "short")?,
                long: extent(table, "long")?,
            };
            if shape.short >= shape.long
                && let Some(long) = table.get("long")
            {
                return Err(long.refused("a length above that of `short`"));
            }
            table.end()?;
            Ok(shape)
        })?,
        place: size(table, "place")?,
        place_length: extent(table, "place_length")?,
        wandering: size(table, "wandering")?,
        memory: extent(table, "memory")?,
    };
    table.end()?;
    Ok(remaining)
}

/// Parts of a level.
const PARTS: RangeInclusive<f64> = 0.0..=100.0;
/// Forces, N (N m).
const SIZES: RangeInclusive<f64> = 0.0..=1e15;
/// Lengths, m (rad), and times, s.
const EXTENTS: RangeInclusive<f64> = 1e-12..=1e12;

/// Whether all sizes of what a law leaves are such as are read.
pub(super) fn is_read(remaining: &RemainingEntry) -> bool {
    let shapes = &remaining.shapes;
    let mut sizes =
        (shapes.iter().map(|shape| shape.force)).chain([remaining.place, remaining.wandering]);
    let mut extents = (shapes.iter().flat_map(|shape| [shape.short, shape.long]))
        .chain([remaining.place_length, remaining.memory]);
    PARTS.contains(&remaining.level)
        && sizes.all(|size| SIZES.contains(&size))
        && extents.all(|extent| EXTENTS.contains(&extent))
}

/// A part of a level.
fn part(table: &Table<'_>, key: &'static str) -> Result<f64, Error> {
    within(table, key, PARTS, "a number from 0 to 100")
}

/// A force.
fn size(table: &Table<'_>, key: &'static str) -> Result<f64, Error> {
    within(table, key, SIZES, "a number from 0 to 1e15")
}

/// A length or a time.
fn extent(table: &Table<'_>, key: &'static str) -> Result<f64, Error> {
    within(table, key, EXTENTS, "a number from 1e-12 to 1e12")
}

fn within(
    table: &Table<'_>,
    key: &'static str,
    range: RangeInclusive<f64>,
    allowed: &str,
) -> Result<f64, Error> {
    let given = table.required(key, table.get(key), allowed)?;
    let value = number(&given)?;
    match range.contains(&value) {
        true => Ok(value),
        false => Err(given.refused(allowed)),
    }
}

fn text(table: &Table<'_>, key: &'static str, example: &str) -> Result<String, Error> {
    let text = table.text(key)?.map(str::to_string);
    table.required(key, text, example)
}

/// Any number, also infinite or NaN: its range is checked later, together with the others.
fn number(given: &Given<'_>) -> Result<f64, Error> {
    given
        .as_number()
        .ok_or_else(|| given.refused("a number, without quotes"))
}

fn interval(given: &Given<'_>) -> Result<[f64; 2], Error> {
    match given.as_list().as_deref() {
        Some([low, high]) => Ok([number(low)?, number(high)?]),
        _ => Err(given.refused("two numbers in brackets, such as [-inf, 0.5]")),
    }
}

fn list<'a>(table: &Table<'a>, key: &'static str, what: &str) -> Result<Vec<Given<'a>>, Error> {
    let given = table.required(key, table.get(key), what)?;
    given.as_list().ok_or_else(|| given.refused(what))
}

fn each<'a, T>(
    list: &[Given<'a>],
    read: impl Fn(&Table<'a>) -> Result<T, Error>,
) -> Result<Vec<T>, Error> {
    let read = |given: &Given<'a>| {
        let table = given.as_table();
        read(&table.ok_or_else(|| given.refused("a table"))?)
    };
    list.iter().map(read).collect()
}

impl ModelFile {
    /// Reads a model file from disk.
    ///
    /// # Errors
    /// When the file cannot be read, or its text is no model of this schema.
    pub fn read(file: impl AsRef<Path>) -> Result<Self, Error> {
        Ok(ReadModel::read(file)?.model)
    }

    /// Reads the text of a model file.
    ///
    /// # Errors
    /// When the text is no model of this schema, or its parameters do not fit its law: their names, units and values.
    pub fn parse(text: &str) -> Result<Self, Error> {
        Ok(ReadModel::parse(text)?.model)
    }
}
