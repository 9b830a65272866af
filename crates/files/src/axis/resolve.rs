//! From the axis file as typed to SI values that the libraries take.

mod columns;
mod resolver;
mod simulation;
mod terms;

use super::values::Axis;
use crate::config::{Given, Source, Table};
use crate::error::Error;
use resolver::{FORCES, LENGTHS, Resolver, SPEEDS};
use std::path::Path;
use stiction_identify::{Conditioning, Cutoff, Source as Signal};
use stiction_log::text::{Decimal, Separator, TextOptions};
use stiction_log::{Dimension, Mapping, Motion, Wrap};

/// Largest decimation: 10 kHz down to 1 Hz.
const MAX_DECIMATE: u64 = 10_000;

impl Axis {
    /// Reads and checks an axis file.
    ///
    /// # Errors
    /// With file, line, column and key, what was found and what is allowed.
    pub fn read(file: &Path) -> Result<Self, Error> {
        let text = crate::config::read(file, "an axis file")?;
        Self::parse(&text, file)
    }

    /// Checks the text of an axis file; `file` is named in errors.
    ///
    /// # Errors
    /// As [`Axis::read`].
    pub fn parse(text: &str, file: &Path) -> Result<Self, Error> {
        resolve(text, file)
    }
}

/// Checks the text of an axis file; `file` is for messages.
fn resolve(text: &str, file: &Path) -> Result<Axis, Error> {
    let source = Source {
        file,
        text,
        page: "docs/axis.md",
    };
    let entries = source.parse()?;
    let root = Table::root(source, &entries);
    let resolver = Resolver::default();
    let mut axis = Axis {
        file: file.to_path_buf(),
        ..Axis::default()
    };
    resolver.axis(&root, &mut axis)?;
    root.end()?;
    axis.tied = resolver.tied.into_inner();
    Ok(axis)
}

impl Resolver {
    fn axis(&self, root: &Table<'_>, axis: &mut Axis) -> Result<(), Error> {
        let name = root.text("name")?.map(str::to_string);
        axis.name = name.filter(|name| !name.trim().is_empty());
        self.mapping(root, &mut axis.mapping)?;
        text_options(root, &mut axis.text)?;
        axis.conditioning = self.conditioning(root)?;
        axis.conditioning.resolution = axis.mapping.resolution;
        self.terms(root, axis)?;
        self.simulation(root, axis)?;
        self.controller(root, axis)?;
        if let Some(table) = root.table("report")? {
            axis.low_speed = self.positive(table.get("low_speed"), &SPEEDS)?;
            table.end()?;
        }
        Ok(())
    }

    fn mapping(&self, root: &Table<'_>, mapping: &mut Mapping) -> Result<(), Error> {
        mapping.motion = match root.choice("kind", &["linear", "rotary"])? {
            None => None,
            Some("linear") => Some(Motion::Linear),
            Some(_) => Some(Motion::Rotary),
        };
        mapping.rate_hz = self.positive(root.get("rate"), &[Dimension::FREQUENCY])?;
        columns::columns(root, mapping)?;
        let Some(log) = root.table("log")? else {
            return Ok(());
        };
        let wrap = self.positive(log.get("wrap"), &LENGTHS)?;
        mapping.wrap = wrap.map(|period| Wrap { period });
        mapping.resolution = self.positive(log.get("resolution"), &LENGTHS)?;
        mapping.force_limit = self.positive(log.get("force_limit"), &FORCES)?;
        if let Some(given) = log.get("crop") {
            mapping.crop = Some(crop(&given)?);
        }
        log.end()
    }

    fn conditioning(&self, root: &Table<'_>) -> Result<Conditioning, Error> {
        let Some(table) = root.table("conditioning")? else {
            return Ok(Conditioning::default());
        };
        let source = match table.choice("source", &["position", "velocity", "auto"])? {
            None | Some("auto") => None,
            Some("position") => Some(Signal::Position),
            Some(_) => Some(Signal::Velocity),
        };
        let conditioning = Conditioning {
            source,
            source_cutoff: self.cutoff(table.get("source_cutoff"))?,
            common_cutoff: self.cutoff(table.get("common_cutoff"))?,
            decimate: table
                .count("decimate", 1, MAX_DECIMATE)?
                .map(|n| n as usize),
            resolution: None,
            min_speed: self
                .positive(table.get("min_speed"), &SPEEDS)?
                .unwrap_or(0.0),
        };
        table.end()?;
        Ok(conditioning)
    }

    fn cutoff(&self, given: Option<Given<'_>>) -> Result<Cutoff, Error> {
        let Some(given) = given else {
            return Ok(Cutoff::Auto);
        };
        match given.as_text() {
            Some("auto") => Ok(Cutoff::Auto),
            Some("off") => Ok(Cutoff::Off),
            _ => self
                .above_zero(&given, &[Dimension::FREQUENCY])
                .map(Cutoff::Hz),
        }
    }
}

/// Two times from the first sample, s.
fn crop(given: &Given<'_>) -> Result<(f64, f64), Error> {
    let allowed =
        "two times from the first sample, the first before the second, such as [\"1 s\", \"20 s\"]";
    let list = given.as_list().unwrap_or_default();
    let [from, to] = list.as_slice() else {
        return Err(given.refused(allowed));
    };
    let time = |given: &Given<'_>| Ok::<f64, Error>(given.value(&[Dimension::TIME])?.0);
    let (a, b) = (time(from)?, time(to)?);
    if a >= b {
        let found = format!("{} to {}", from.shown(), to.shown());
        return Err(given.refuse(found, allowed));
    }
    Ok((a, b))
}

fn text_options(root: &Table<'_>, out: &mut TextOptions) -> Result<(), Error> {
    let Some(table) = root.table("text")? else {
        return Ok(());
    };
    out.header = table.flag("header")?;
    out.preamble = table
        .count("preamble", 0, u64::from(u32::MAX))?
        .map(|n| n as usize);
    if let Some(given) = table.get("separator") {
        out.separator = Some(match given.as_text() {
            Some("tab" | "\t") => Separator::Tab,
            Some(";" | "semicolon") => Separator::Semicolon,
            Some("," | "comma") => Separator::Comma,
            Some("|" | "pipe") => Separator::Pipe,
            Some(" " | "blanks") => Separator::Blanks,
            _ => return Err(given.refused("tab, semicolon, comma, pipe or blanks")),
        });
    }
    if let Some(given) = table.get("decimal") {
        out.decimal = Some(match given.as_text() {
            Some("." | "point") => Decimal::Point,
            Some("," | "comma") => Decimal::Comma,
            _ => return Err(given.refused("point or comma")),
        });
    }
    table.end()
}
