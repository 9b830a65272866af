//! `[log]`, what holds for every log, and `[[log]]`, what holds for one.

use super::resolver::{FORCES, LENGTHS, Resolver};
use crate::axis::listed::{ListedLog, Validated};
use crate::axis::values::Axis;
use crate::config::{Given, Table};
use crate::error::Error;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use stiction_formats::Dimension;
use stiction_log::mapping::{FORCE_LIMITS, RESOLUTIONS, WRAP_COUNTS, WRAPS};
use stiction_log::{Mapping, Rests, Wrap};

/// Most logs that an axis file may list.
const MOST_LOGS: usize = 1000;
/// Most stretches of a log.
const MOST_STRETCHES: usize = 1000;

impl Resolver {
    /// What is said of logs.
    pub(super) fn log(&self, root: &Table<'_>, axis: &mut Axis, file: &Path) -> Result<(), Error> {
        let Some(given) = root.get("log") else {
            return Ok(());
        };
        if let Some(log) = given.as_table() {
            self.every_log(&log, &mut axis.mapping)?;
            return log.end();
        }
        let folder = file.parent().unwrap_or(Path::new(""));
        let most = root.tables("log", MOST_LOGS);
        let allowed = format!("a table [log], or [[log]] for each log, at most {MOST_LOGS}");
        let tables = most.map_err(|_| given.refused(&allowed))?;
        // One file may have several paths.
        let mut numbers: HashMap<PathBuf, usize> = HashMap::new();
        for (i, table) in tables.iter().enumerate() {
            let listed = self.one_log(table, &axis.mapping, folder, i + 1)?;
            let place = listed.file.canonicalize();
            let place = place.unwrap_or_else(|_| listed.file.clone());
            if let Some(before) = numbers.insert(place, i + 1) {
                let name = table.find("file").map(|given| given.shown());
                let allowed = "one [[log]] for each file, with all its stretches";
                let found = format!(
                    "{} a second time: it is the file of log[{before}]",
                    name.unwrap_or_default()
                );
                return Err(table.refuse("file", found, allowed));
            }
            axis.logs.push(listed);
        }
        // The finest encoder step counts for all of them.
        let steps = axis.logs.iter().filter_map(|log| log.mapping.resolution);
        axis.mapping.resolution = steps.reduce(f64::min);
        Ok(())
    }

    /// Keys that may stand in `[log]` and in any `[[log]]`.
    pub(super) fn every_log(&self, log: &Table<'_>, mapping: &mut Mapping) -> Result<(), Error> {
        let within = |given: Option<Given<'_>>, dimensions: &[Dimension], range| {
            given
                .map(|given| self.within(&given, dimensions, range))
                .transpose()
        };
        let wrap = log.get("wrap").map(|given| self.wrap(&given));
        mapping.wrap = wrap.transpose()?;
        mapping.resolution = within(log.get("resolution"), &LENGTHS, &RESOLUTIONS)?;
        mapping.force_limit = within(log.get("force_limit"), &FORCES, &FORCE_LIMITS)?;
        if let Some(given) = log.get("crop") {
            mapping.crop = Some(stretch(&given)?);
        }
        mapping.rests = match log.choice("rests", &["cut", "keep"])? {
            None => None,
            Some("cut") => Some(Rests::Cut),
            Some(_) => Some(Rests::Keep),
        };
        Ok(())
    }

    /// A travel, or the counts of a counter.
    fn wrap(&self, given: &Given<'_>) -> Result<Wrap, Error> {
        let (counts, dimension) =
            given.value(&[Dimension::LENGTH, Dimension::ANGLE, Dimension::COUNTS])?;
        if dimension != Dimension::COUNTS {
            return Ok(Wrap::Travel(self.within(given, &LENGTHS, &WRAPS)?));
        }
        match WRAP_COUNTS.contains(&counts) && counts.fract() == 0.0 {
            true => Ok(Wrap::Counts(counts)),
            false => {
                let allowed = format!(
                    "a whole number from {} to {} counts, such as \"65536 counts\" of 16 bits",
                    WRAP_COUNTS.start(),
                    WRAP_COUNTS.end()
                );
                Err(given.refused(&allowed))
            }
        }
    }

    fn one_log(
        &self,
        table: &Table<'_>,
        common: &Mapping,
        folder: &Path,
        number: usize,
    ) -> Result<ListedLog, Error> {
        let mut mapping = common.clone();
        self.every_log(table, &mut mapping)?;
        let file = table.get("file");
        let file = table.required(
            "file",
            file,
            "the file of the log, from the folder of the axis file",
        )?;
        let fit = table.get("fit");
        let validate = table.get("validate");
        let all = validate
            .as_ref()
            .is_some_and(|given| given.as_text() == Some("all"));
        if let (Some(fit), true) = (&fit, all) {
            let found = format!("{} together with validate = \"all\"", fit.shown());
            return Err(fit.refuse(found, "the one or the other: nothing is left to fit"));
        }
        let read = |given: &Given<'_>| stretches(given, mapping.crop);
        let validated = match &validate {
            None => Validated::None,
            Some(_) if all => Validated::All,
            Some(given) => Validated::Stretches(read(given)?),
        };
        let fitted = fit.as_ref().map(read).transpose()?;
        if let (Some(fitted), Validated::Stretches(held_out), Some(given)) =
            (&fitted, &validated, &validate)
        {
            let meets = |a: &&(f64, f64)| fitted.iter().any(|b| a.0 < b.1 && b.0 < a.1);
            if let Some((from, to)) = held_out.iter().find(meets) {
                let found = format!("{from} to {to} s, of which a part is fitted");
                return Err(given.refuse(found, "stretches that are not in fit"));
            }
        }
        table.end()?;
        Ok(ListedLog {
            file: folder.join(file.path("a log")?),
            key: format!("log[{number}]"),
            mapping,
            fit: fitted,
            validated,
        })
    }
}

/// One stretch or a list of them, within what is kept of the log.
fn stretches(given: &Given<'_>, crop: Option<(f64, f64)>) -> Result<Vec<(f64, f64)>, Error> {
    let allowed =
        "two times from the first sample, such as [\"1 s\", \"20 s\"], or a list of such pairs";
    let list = given.as_list().unwrap_or_default();
    let nested = list.iter().all(|entry| entry.as_list().is_some());
    let each = match nested {
        true => list,
        false => vec![given.clone()],
    };
    if each.is_empty() || each.len() > MOST_STRETCHES {
        return Err(given.refused(&format!("{allowed}, at most {MOST_STRETCHES}")));
    }
    let mut out = Vec::new();
    for entry in &each {
        let (from, to) = stretch(entry)?;
        if let Some((first, last)) = crop.filter(|(first, last)| from < *first || to > *last) {
            let found = format!("{from} to {to} s, and crop keeps {first} to {last} s");
            return Err(entry.refuse(found, "times within crop"));
        }
        out.push((from, to));
    }
    Ok(out)
}

/// Two times from the first sample, s.
fn stretch(given: &Given<'_>) -> Result<(f64, f64), Error> {
    let allowed = "two times from the first sample, from 0 s on, the first before the second, such as [\"1 s\", \"20 s\"]";
    let list = given.as_list().unwrap_or_default();
    let [from, to] = list.as_slice() else {
        return Err(given.refused(allowed));
    };
    let time = |given: &Given<'_>| Ok::<f64, Error>(given.not_negative(&[Dimension::TIME])?.0);
    let (a, b) = (time(from)?, time(to)?);
    if a >= b {
        let found = format!("{} to {}", from.shown(), to.shown());
        return Err(given.refuse(found, allowed));
    }
    Ok((a, b))
}
