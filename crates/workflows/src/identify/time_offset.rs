//! A force that was logged much later or earlier than its motion is taken as it belongs.

use super::condition::{Conditioned, condition};
use super::disagree;
use super::load::{Asked, Loaded};
use super::logs::paths;
use crate::error::Error;
use crate::source::Source;
use stiction_files::{Axis, Warning, shell};
use stiction_identify::{
    Alignment, Delay, FittedLaw, ForceFilter, Observer, Smoothing, alignment, force_filter,
    lateness,
};
use stiction_log::{Found, Offset, Role};
use stiction_parameters::Quantity;
use stiction_policy::delay;
use stiction_say::{Notice, Whole};

/// Lays force and motion beside each other, where no delay is given and whole records are fitted.
pub(super) fn aligned(asked: Asked, mut loaded: Loaded) -> Result<Loaded, Error> {
    if !is_sought(asked, &loaded) {
        return Ok(loaded);
    }
    let samples: Result<Vec<_>, Error> = loaded.sources.iter().map(Source::fitted).collect();
    let samples = samples?;
    let each = samples
        .iter()
        .map(|log| lateness(std::slice::from_ref(log)));
    let each: Vec<usize> = each.map(Option::unwrap_or_default).collect();
    loaded.apart = apart(&loaded.sources, &each);
    if loaded.apart.is_none()
        && let Some(rows) = lateness(&samples)
    {
        loaded.take_force_from(rows as isize);
    }
    Ok(loaded)
}

/// The log whose force is the latest and the one whose is the least late, where no delay is that of both.
fn apart(sources: &[Source], each: &[usize]) -> Option<String> {
    let by_rows = |log: &(&Source, &usize)| *log.1;
    let logs = || sources.iter().zip(each);
    let (least, most) = (logs().min_by_key(by_rows)?, logs().max_by_key(by_rows)?);
    (most.1 - least.1 > delay::MAX_ROWS_APART).then(|| {
        format!(
            "the force of {} was logged about {} rows later than its motion, that of {} about {}: no delay is that of both",
            most.0.name(),
            most.1,
            least.0.name(),
            least.1
        )
    })
}

/// The same where the fits that choose the cut-offs found the delay at the end of its range: by fits further on. Gives the rows
/// that explain the force better, where they are not sure to be its cause.
pub(super) fn realigned(
    asked: Asked,
    mut loaded: Loaded,
    conditioned: Conditioned,
    observer: &mut dyn Observer,
) -> Result<(Loaded, Conditioned, Option<Alignment>), Error> {
    if loaded.apart.is_some() || !is_sought(asked, &loaded) {
        return Ok((loaded, conditioned, None));
    }
    let near = conditioned.settings.near.as_ref();
    let samples: Result<Vec<_>, Error> = loaded.sources.iter().map(Source::fitted).collect();
    let found = alignment(
        &samples?,
        &conditioned.conditioning,
        (near, loaded.rows_late()),
        conditioned.terms(false),
        &conditioned.settings,
        observer,
    );
    let Some(found) = found.filter(|found| found.is_sure) else {
        return Ok((loaded, conditioned, found));
    };
    loaded.take_force_from(found.rows);
    let conditioned = condition(asked, &loaded, observer)?;
    Ok((loaded, conditioned, None))
}

/// The same where the force was logged behind a low-pass, which is undone, or later by rows that explain more than a low-pass does.
pub(super) fn unfiltered(
    asked: Asked,
    (mut loaded, conditioned, further): (Loaded, Conditioned, Option<Alignment>),
    observer: &mut dyn Observer,
) -> Result<(Loaded, Conditioned), Error> {
    if loaded.apart.is_some() || !is_sought(asked, &loaded) {
        return Ok((loaded, conditioned));
    }
    let Some(near) = conditioned.settings.near.as_ref() else {
        return Ok((loaded, conditioned));
    };
    // What a position that is held hides of the motion looks like a force that is smoothed.
    let is_held = |found: &Found| matches!(found, Found::HeldPosition { .. });
    if loaded
        .sources
        .iter()
        .any(|source| source.log.finds(is_held))
    {
        return Ok((loaded, conditioned));
    }
    let samples: Result<Vec<_>, Error> = loaded.sources.iter().map(Source::fitted).collect();
    let found = force_filter(
        &samples?,
        &conditioned.conditioning,
        (near, loaded.rows_late()),
        conditioned.terms(false),
        &conditioned.settings,
        observer,
    );
    let found = found.filter(ForceFilter::is_certain);
    let least = found.map_or(f64::INFINITY, |filter| filter.left);
    let is_as_good = |further: &Alignment| further.left < delay::MAX_ROWS_OVER_FILTER * least;
    if let Some(further) = further.filter(is_as_good) {
        loaded.take_force_from(further.rows);
        let conditioned = condition(asked, &loaded, observer)?;
        return Ok((loaded, conditioned));
    }
    let Some(found) = found else {
        return Ok((loaded, conditioned));
    };
    for source in loaded.sources.iter_mut().chain(&mut loaded.held_out) {
        match found.what {
            Smoothing::LowPass(time) => source.log.undo_force_filter(time),
            Smoothing::Mean(rows) => source.log.undo_force_mean(rows),
        }
    }
    loaded.filter = Some(found);
    loaded.take_force_from(found.rows);
    let conditioned = condition(asked, &loaded, observer)?;
    Ok((loaded, conditioned))
}

/// Whether a delay is looked for.
fn is_sought(asked: Asked, loaded: &Loaded) -> bool {
    // A force of the wrong sign looks late, by half of a period.
    let is_inverted = super::logs::has_wrong_sign;
    // A force made of the positions themselves is of their instants.
    let is_made = |source: &Source| {
        let drive = source.log.mapping.drive;
        source.log.mapping.force.is_none() && drive.is_some_and(|own| own.position_loop.is_some())
    };
    asked.axis.terms.delay == Delay::Fitted
        && asked.options.procedures.method.fits_force()
        && loaded.contradicted.is_none()
        && !loaded
            .sources
            .iter()
            .any(|source| is_inverted(source) || is_made(source))
}

impl Loaded {
    /// By how many rows later than in the file the force is taken.
    fn rows_late(&self) -> isize {
        (self.late * self.sources[0].log.rate_hz).round() as isize
    }

    fn take_force_from(&mut self, rows: isize) {
        let whole = self.rows_late() + rows;
        self.late = whole as f64 / self.sources[0].log.rate_hz;
        for source in self.sources.iter_mut().chain(&mut self.held_out) {
            source.log.take_force_from(rows, whole);
        }
    }
}

/// Adds to the warning of a force that is late or early the line that states the whole delay, and the command that then takes it.
pub(super) fn stated(asked: Asked, loaded: &Loaded, law: &FittedLaw, warnings: &mut [Warning]) {
    let late = warnings.iter_mut().rev().find_map(|warning| {
        let kind = warning.kind()?.clone();
        let is_late = matches!(kind.found(), Some(Found::ForceLate { .. }));
        is_late.then_some((warning, kind))
    });
    let Some((warning, kind)) = late else { return };
    let (further, in_table) = match (law.value(Quantity::Delay), law.terms.delay) {
        (Some(delay), _) => (delay, true),
        (None, Delay::Given(delay)) => (delay, false),
        (None, Delay::Fitted) => (0.0, false),
    };
    let late = loaded.late + further;
    let logs = paths(&loaded.sources);
    let typed: Vec<String> = logs.iter().map(|log| shell::quoted(log)).collect();
    let options = disagree::options(asked);
    let (file, axis) = match asked.axis.file() {
        Some(file) => (format!("in {}", file.display()), String::new()),
        None => {
            let file = shell::axis_file(&logs[0]);
            (format!("in a new file {file}"), format!(" --axis {file}"))
        }
    };
    let command = |axis: &str| {
        format!(
            "stiction identify {}{axis}{options} --out another",
            typed.join(" ")
        )
    };
    let whole = match of_another_clock(asked.axis) {
        // A delay that is given turns the search for the low-pass off.
        _ if loaded.filter.is_some() => Whole::Unfiltered,
        Some(added) => Whole::Offset {
            in_table,
            offset: (1e6 * (added - late)).round() / 1e6,
            replaces: added != 0.0,
            file,
            command: command(""),
        },
        None => Whole::Delay {
            in_table,
            delay: late,
            file,
            command: command(&axis),
        },
    };
    let found = Box::new(kind);
    *warning = Notice::Late { found, whole }.into();
}

/// What is added to the time stamps of a force that comes from another file, s; `None` where it comes from the log.
fn of_another_clock(axis: &Axis) -> Option<f64> {
    let mut joined = axis.joined.iter().filter(|column| column.file.is_some());
    match joined
        .find(|column| column.from.role == Role::Force)?
        .from
        .offset
    {
        Offset::Given(added) => Some(added),
        // What was estimated has been laid upon the motion already.
        Offset::Estimated => None,
    }
}
