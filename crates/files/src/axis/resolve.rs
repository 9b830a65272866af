//! From the axis file as typed to SI values that the libraries take.

mod columns;
mod drive;
mod ethercat;
mod joint;
mod limits;
mod log;
mod resolver;
mod search;
mod simulation;
mod terms;

pub use terms::MOST_PITCHES;

use super::values::Axis;
use crate::config::{Form, Given, Places, Source, Table};
use crate::error::Error;
use resolver::{Resolver, SPEEDS};
use std::path::Path;
use stiction_formats::Dimension;
use stiction_formats::text::{Decimal, MAX_PREAMBLE_LINES, Separator, TextOptions};
use stiction_identify::{Conditioning, Cutoff, Source as Signal};
use stiction_log::mapping::RATES;
use stiction_log::{Mapping, Motion};

/// What the text of an axis is called in messages where it is in no file.
const IN_MEMORY: &str = "axis";

/// Largest decimation: 10 kHz down to 1 Hz.
const MAX_DECIMATE: u64 = 10_000;

impl Axis {
    /// Reads and checks an axis file.
    ///
    /// # Errors
    /// With file, line, column and key, what was found and what is allowed.
    pub fn read(file: impl AsRef<Path>) -> Result<Self, Error> {
        let file = file.as_ref();
        let text = crate::config::read(file, Form::Axis)?;
        let mut axis = resolve(&text, file)?;
        axis.read_from = Some(file.into());
        axis.sha256 = Some(crate::hash::sha256_of(text.as_bytes()));
        Ok(axis)
    }

    /// Checks the text of an axis file.
    ///
    /// # Errors
    /// With line, column and key, what was found and what is allowed.
    pub fn parse(text: &str) -> Result<Self, Error> {
        resolve(text, Path::new(IN_MEMORY))
    }
}

/// Checks the text of an axis file; `file` is for messages.
fn resolve(text: &str, file: &Path) -> Result<Axis, Error> {
    let source = Source {
        file,
        text,
        form: Form::Axis,
        swept: None,
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
    axis.places = Places::of(&source, &entries);
    Ok(axis)
}

impl Resolver {
    fn axis(&self, root: &Table<'_>, axis: &mut Axis) -> Result<(), Error> {
        let name = root.line("name")?.map(str::to_string);
        axis.name = name.filter(|name| !name.trim().is_empty());
        self.mapping(root, &mut axis.mapping)?;
        let folder = axis.file.parent().unwrap_or(Path::new(""));
        axis.joined = columns::columns(root, &mut axis.mapping, folder)?;
        drive::drive(root, &mut axis.mapping)?;
        self.log(root, axis, &axis.file.clone())?;
        text_options(root, &mut axis.text)?;
        axis.ethercat = ethercat::process_data(root)?;
        axis.conditioning = self.conditioning(root)?;
        axis.conditioning.resolution = axis.mapping.resolution;
        self.terms(root, axis)?;
        self.simulation(root, axis)?;
        self.controller(root, axis)?;
        axis.limits = limits::limits(root, axis.mapping.motion)?;
        axis.search = search::search(root)?;
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
        let within = |given: Option<Given<'_>>, dimensions: &[Dimension], range| {
            given
                .map(|given| self.within(&given, dimensions, range))
                .transpose()
        };
        mapping.rate_hz = within(root.get("rate"), &[Dimension::FREQUENCY], &RATES)?;
        Ok(())
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
            force_is_filtered: false,
            decimate: table
                .count("decimate", 1, MAX_DECIMATE)?
                .map(|n| n as usize),
            resolution: None,
            min_speed: self
                .positive(table.get("min_speed"), &SPEEDS)?
                .unwrap_or(0.0),
            settling: 0.0,
        };
        table.end()?;
        Ok(conditioning)
    }

    fn cutoff(&self, given: Option<Given<'_>>) -> Result<Cutoff, Error> {
        let Some(given) = given else {
            return Ok(Cutoff::Auto);
        };
        match given.or_word(&["auto", "off"]) {
            (_, Some("auto")) => Ok(Cutoff::Auto),
            (_, Some(_)) => Ok(Cutoff::Off),
            (given, None) => self
                .above_zero(&given, &[Dimension::FREQUENCY])
                .map(Cutoff::Hz),
        }
    }
}

fn text_options(root: &Table<'_>, out: &mut TextOptions) -> Result<(), Error> {
    let Some(table) = root.table("text")? else {
        return Ok(());
    };
    out.header = table.flag("header")?;
    out.preamble = table
        .count("preamble", 0, MAX_PREAMBLE_LINES as u64)?
        .map(|n| n as usize);
    if let Some(given) = table.get("separator") {
        out.separator = Some(match given.as_text() {
            Some("tab" | "\t") => Separator::Tab,
            Some(";" | "semicolon") => Separator::Semicolon,
            Some("," | "comma") => Separator::Comma,
            Some("|" | "pipe") => Separator::Pipe,
            Some(" " | "blanks") => Separator::Blanks,
            _ => {
                let allowed = "tab, semicolon (;), comma (,), pipe (|) or blanks";
                return Err(given.refused(allowed));
            }
        });
    }
    if let Some(given) = table.get("decimal") {
        out.decimal = Some(match given.as_text() {
            Some("." | "point") => Decimal::Point,
            Some("," | "comma") => Decimal::Comma,
            _ => return Err(given.refused("point (.) or comma (,)")),
        });
        if out.separator == Some(Separator::Comma) && out.decimal == Some(Decimal::Comma) {
            let found = "a comma, and the separator is one too".into();
            return Err(given.refuse(found, "only one of the two can be a comma"));
        }
    }
    table.end()
}
