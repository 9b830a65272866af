//! A recording in SI, checked: what an identification starts from.
//!
//! [`Log::from_table`] goes through a table in this order, in linear passes:
//!
//! 1. the mapping is completed (see [`Mapping`]);
//! 2. columns are cut to one length: up to 1 % may be missing at the end of one of them, more is
//!    refused, since a column at half the rate would be misaligned;
//! 3. time stamps are reduced to the first kept one before anything is rounded; a 16-, 31- or 32-bit
//!    counter that overflows is unwrapped; any other backward step is refused with its row;
//! 4. the record is cropped, in seconds from its first sample; faults outside the crop do not matter;
//! 5. rows without a time stamp, and all but the first of equal time stamps, are dropped, each
//!    refused above 5 % (stamps coarser than the sampling: give the rate instead);
//! 6. units, scale and sign are applied; zeros that stand for missing samples of position, force and load
//!    become missing cells, and so do temperatures below 0 K and dropouts of temperature and load; a position that wraps
//!    is unwrapped;
//! 7. rows in which the enable column says that the axis is not enabled are left out, and so are those in parts of the record
//!    that are not asked for; they leave gaps at which the record is split, however short, as it is where another recording
//!    begins in the file ([`Table::starts`]);
//! 8. missing cells of position, velocity and force: up to 5 in a row are interpolated
//!    linearly in time and excluded; longer runs are dropped with their rows and leave a gap. In
//!    reference, temperature and load every missing cell is interpolated or held: they vary slowly; so it is in an
//!    acceleration, which no fit has to rely on. A temperature or load without a number for most of the time is left out;
//! 9. a rate, travel, speed or force that no axis has is refused: its unit is wrong;
//! 10. the log is inspected (see [`Finding`]);
//! 11. where the motor is known, its force follows from the current, voltage or duty of the column.
//!
//! No sample is resampled, filtered or moved in time.

mod cells;
mod chosen;
mod clock;
pub(crate) mod coarse;
mod credible;
mod driven;
mod dropout;
mod filled;
mod held;
mod made;
pub(crate) mod overflow;
pub(crate) mod unwrap;

use crate::findings::{self, Finding, Found, Severity};
use crate::join::Joined;
use crate::mapping::{
    Enable, Mapping, Motion, Role, Source, Understood, Wrap, another_unit, parts,
};
use crate::{Channel, Dimension, Error, Kind, Table, Unit, Value};
use cells::LeftOut;
pub use chosen::NotEnabled;
use std::borrow::Cow;
use std::ops::Range;
use stiction_codes::Code;
use stiction_signal::{undo_low_pass, undo_mean};

/// Samples missing between two time stamps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Last sample before the gap, counted from 0.
    pub start_index: usize,
    /// Time from that sample to the next, s.
    pub seconds: f64,
    /// Samples that are missing at the median rate; at least 1.
    pub missing_samples: usize,
}

/// Samples that are in the log and should not be fitted to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Excluded {
    /// The samples, counted from 0.
    pub samples: Range<usize>,
    /// Code of the finding that says why.
    pub code: Code,
}

/// A recording in SI; every column has one finite number a sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Log {
    /// Linear (m, m/s) or rotary (rad, rad/s).
    pub motion: Motion,
    /// Seconds from the first kept sample, strictly increasing.
    pub time: Vec<f64>,
    /// Time of the first kept sample on the clock of the file, s.
    pub start: f64,
    /// Position, m or rad; unwrapped.
    pub position: Option<Vec<f64>>,
    /// Travel after which the position wraps in the file, m or rad, where the mapping gives it.
    pub wrap: Option<f64>,
    /// Velocity as recorded, m/s or rad/s.
    pub velocity: Option<Vec<f64>>,
    /// Acceleration as recorded, m/s^2 or rad/s^2.
    pub acceleration: Option<Vec<f64>>,
    /// Force in `force_unit`, positive where it drives towards positive position.
    pub force: Option<Vec<f64>>,
    /// SI unit of the force: `N`, `N*m`, `A`, `V`, or `1` for a fraction of the rated force.
    pub force_unit: String,
    /// Reference (commanded) position, m or rad; unwrapped, in the turns of the position.
    pub reference: Option<Vec<f64>>,
    /// Samples whose reference was missing and is on a straight line between its neighbours, in order.
    pub without_reference: Vec<Range<usize>>,
    /// Temperature, K.
    pub temperature: Option<Vec<f64>>,
    /// Normal load in `load_unit`.
    pub load: Option<Vec<f64>>,
    /// SI unit of the load.
    pub load_unit: String,
    /// Force that acts on the axis from outside in `force_unit`, positive where it drives towards positive position.
    pub external: Option<Vec<f64>>,
    /// Rate of the median time step, Hz, to nine digits; where stamps are rounded, the one rate that they show.
    pub rate_hz: f64,
    /// Encoder step, m or rad: as given, or as detected in the data.
    pub quantum: Option<f64>,
    /// Missing samples, in order.
    pub gaps: Vec<Gap>,
    /// Stretches without a long gap or jump inside, in order; together they are the whole log.
    pub segments: Vec<Range<usize>>,
    /// Samples not to be fitted to, by first sample; they may overlap. Those of [`Code::RestAtEnd`] are left out of
    /// fits of the whole record only: for a procedure that starts from rest they are data.
    pub excluded: Vec<Excluded>,
    /// Rows that the enable column leaves out; `None` without such a column.
    pub not_enabled: Option<NotEnabled>,
    /// Whether the force comes from another file whose time stamps are taken as they are.
    pub force_as_stamped: bool,
    /// First samples after rows that were left out by choice, and of another recording in the same file, in order, counted from 0.
    pub(crate) resumed: Vec<usize>,
    /// Stretches of at least 1 s in which the axis stands still, in order.
    pub rests: Vec<Range<usize>>,
    /// What is wrong or worth knowing.
    pub findings: Vec<Finding>,
    /// How the file and its columns were understood.
    pub detected: Vec<String>,
    /// What became of every column of the file, in order.
    pub columns: Vec<Understood>,
    /// The mapping that was used, with nothing left open.
    pub mapping: Mapping,
}

/// Fewest samples of a log; derivatives need three.
const MIN_SAMPLES: usize = 3;

impl Log {
    /// Reads a table as this mapping says; what the mapping leaves open is detected.
    ///
    /// # Errors
    /// Those of [`Mapping::complete`]; [`Kind::Time`] for time stamps that no rule mends, with the
    /// row; [`Kind::Value`] where too little is left or too much is missing.
    pub fn from_table(table: &Table, mapping: &Mapping) -> Result<Self, Error> {
        Self::of_rows(Cow::Borrowed(table), mapping, (&[], table.columns.len()))
    }

    /// As [`Log::from_table`], and lets go of every column as soon as it is not needed: half of the memory.
    ///
    /// # Errors
    /// As [`Log::from_table`].
    pub fn of_table(table: Table, mapping: &Mapping) -> Result<Self, Error> {
        let own = table.columns.len();
        Self::of_rows(Cow::Owned(table), mapping, (&[], own))
    }

    /// The same of a table to which columns of other files were joined.
    ///
    /// # Errors
    /// As [`Log::from_table`].
    pub fn from_joined(joined: &Joined) -> Result<Self, Error> {
        let mut log = Self::of_rows(
            Cow::Borrowed(&joined.table),
            &joined.mapping,
            (&joined.outside, joined.own),
        )?;
        log.force_as_stamped = joined.force_as_stamped;
        if log.force_as_stamped {
            findings::sign_of_another_clock(&mut log.findings);
        }
        log.findings.splice(0..0, joined.findings.iter().cloned());
        Ok(log)
    }

    /// A log of the rows of a table that are not `outside`, whose first `own` columns are of one file.
    fn of_rows(
        mut table: Cow<'_, Table>,
        mapping: &Mapping,
        (outside, own): (&[bool], usize),
    ) -> Result<Self, Error> {
        // Before what else could be the time, or a motion, is missed.
        if let (Some(enable), Ok(Some(column))) = (&mapping.enable, Enable::of(mapping, &table)) {
            chosen::refuse_many(&table, column, enable)?;
        }
        let completed = mapping.complete(&table)?;
        let mut mapping = completed.mapping;
        let mut findings = completed.findings;
        if let Some(drive) = mapping.drive {
            let (drive, assumed) = drive.of_log(&table.scalars);
            mapping.drive = Some(drive);
            findings.extend(assumed.filter(|_| mapping.force.is_none()));
        }
        let mut sources = Vec::new();
        for role in Role::ALL {
            if let Some(mut source) = Source::of(&mapping, &table, role)? {
                // A position that jumps so wraps, which the axis file says.
                if matches!(
                    role,
                    Role::Velocity | Role::Acceleration | Role::Force | Role::External
                ) && let Some(bits) = source.restore_sign(&table)
                {
                    let channel = role.name();
                    findings.push(Finding::note(Found::Unsigned { channel, bits }));
                }
                sources.push((role, source));
            }
        }
        let motion = mapping.motion.unwrap_or(Motion::Linear);
        if let Some(drive) = &mapping.drive {
            driven::check(drive, motion, mapping.force_limit)?;
        }
        same_force(&sources, mapping.drive.map(|_| motion.force()))?;
        let enable = Enable::of(&mapping, &table)?;
        let length = common_length(&table, &mapping, &sources, &mut findings)?;
        refuse_mixed(&table, &mapping, own)?;
        let sign = made::sign_column(&mapping, &table)?;
        keep_columns(&mut table, |column| {
            [enable, sign].contains(&Some(column))
                || sources.iter().any(|(_, source)| source.column == column)
        });
        let clock = clock::read(&table, &sources, &mapping, length, &mut findings)?;
        let sign = made::sign_of(sign, &table, &clock);
        let started = chosen::started(&table, &clock);
        let mut columns = cells::Columns::read(&mut table, &sources, &clock);
        let mut chosen = chosen::Chosen::read(&table, &mapping, &clock, outside)?;
        filled::clear(&mut columns, &mut findings)?;
        let mut left_out = dropout::clear(&mut columns, &table, &sources, &clock, &mut findings);
        keep_columns(&mut table, |_| false);
        let mut time = clock.time;
        let mut wrap = None;
        if let Some(given) = mapping.wrap
            && let Some(mut position) = columns.take(Role::Position)
        {
            let source = |role| {
                let found = sources.iter().find(|(r, _)| *r == role);
                found.map(|(_, source)| source)
            };
            let period = unwrap::period(given, source(Role::Position))?;
            let unit = motion.position().si_text();
            unwrap::resolved(&position, period, mapping.resolution, &unit)?;
            let reference = columns.get_mut(Role::Reference).map(Vec::as_mut_slice);
            let counts = match given {
                Wrap::Counts(counts) => Some(counts),
                Wrap::Travel(_) => None,
            };
            let wrapped = (period, counts);
            findings.push(unwrap::unwrap(&mut position, reference, wrapped, &unit));
            if let Some(slot) = columns.get_mut(Role::Position) {
                *slot = position;
            }
            wrap = Some(period);
        }
        made::force(&mut columns, &mapping, sign)?;
        let held = columns
            .get_mut(Role::Position)
            .and_then(|position| held::period(&time, position));
        if let Some((rows, first)) = held {
            let rate = rate(&time) / rows as f64;
            findings.push(Finding::warning(Found::HeldPosition { rows, rate }));
            for role in [Role::Force, Role::External] {
                if let Some(force) = columns.get_mut(role) {
                    *force = held::meaned(force, rows);
                }
            }
            columns.keep(&mut time, |row| row % rows == first);
            chosen.keep(|row| row % rows == first);
        }
        // The rate is that of the rows as they were recorded: those that are left out leave no other one.
        let recorded = chosen.leaves_out().then(|| rate(&time));
        let mut resumed = chosen.cut(&mut time, &mut columns);
        resumed.extend(started);
        resumed.sort_by(f64::total_cmp);
        findings.extend(chosen.finding());
        let mended = columns.mend(&mut time)?;
        findings.extend(mended.findings);
        left_out.extend(mended.left_out);
        if time.len() < MIN_SAMPLES {
            let mut found = format!("{} left", findings::count(time.len(), "sample"));
            if let Some(left_out) = chosen.not_enabled() {
                let NotEnabled { column, rows, of } = left_out;
                found.push_str(&format!(
                    ", where enable, column {column}, leaves out {rows} of {of} rows"
                ));
            }
            let allowed = format!("at least {MIN_SAMPLES}, and some thousand to identify friction");
            let error = Error::new(Kind::Value, found, allowed);
            return Err(match &mapping.parts {
                Some(_) => error.of_setting(parts::KEY),
                None => error,
            });
        }
        let unit = |role| {
            let source = sources.iter().find(|(r, _)| *r == role).map(|(_, s)| s);
            source.map_or(String::new(), |s| s.dimension.si_text())
        };
        let mut detected = table.detected.clone();
        detected.extend(completed.phrases);
        // Missing cells may have taken rows since.
        let resumed = resumed.iter().map(|at| time.partition_point(|t| t < at));
        let mut resumed: Vec<usize> = resumed.filter(|at| (1..time.len()).contains(at)).collect();
        resumed.dedup();
        let first = time[0];
        time.iter_mut().for_each(|t| *t -= first);
        let mut log = Self {
            motion,
            rate_hz: recorded.unwrap_or_else(|| rate(&time)),
            segments: std::iter::once(0..time.len()).collect(),
            start: clock.start + first,
            time,
            position: columns.take(Role::Position),
            wrap,
            velocity: columns.take(Role::Velocity),
            acceleration: columns.take(Role::Acceleration),
            force: columns.take(Role::Force),
            force_unit: unit(Role::Force),
            reference: columns.take(Role::Reference),
            without_reference: mended.without_reference,
            temperature: columns.take(Role::Temperature),
            load: columns.take(Role::Load),
            load_unit: unit(Role::Load),
            external: columns.take(Role::External),
            quantum: None,
            gaps: Vec::new(),
            excluded: mended.bridged,
            not_enabled: chosen.not_enabled(),
            force_as_stamped: false,
            resumed,
            rests: Vec::new(),
            findings,
            detected,
            columns: without(completed.columns, &left_out),
            mapping,
        };
        credible::check(&log, &table, &sources)?;
        let unlikely = credible::unlikely(&log, &table, &sources);
        log.findings.extend(unlikely);
        let mapping = log.mapping.clone();
        findings::inspect(&mut log, &mapping);
        let force = sources.iter().find(|(role, _)| *role == Role::Force);
        if let (Some(drive), true) = (&mapping.drive, log.force.is_some()) {
            let dimension = force.map_or(Dimension::ONE, |(_, force)| force.dimension);
            driven::drive(&mut log, drive, dimension)?;
        }
        log.excluded
            .sort_by_key(|e| (e.samples.start, e.samples.end));
        Ok(log)
    }

    /// The rate of the rows of a table, Hz, where the clock of this mapping's time column is coarser than the sampling: its stamps are
    /// rounded, or repeat. `None` where they are to be kept, and where their unit is open.
    pub fn rate_of_coarse_clock(table: &Table, mapping: &Mapping) -> Option<f64> {
        let time = mapping.time.as_ref()?;
        time.unit
            .as_ref()
            .or(time.scale.as_ref().map(|scale| &scale.unit))?;
        let source = Source::of(mapping, table, Role::Time).ok()??;
        clock::rate_of_coarse(&table.columns[source.column].values, &source)
    }

    /// The column of a role in the next larger unit, for numbers that come out too small, or in the next smaller one; `None` where the
    /// log has no such column, or its scale says what the unit is worth.
    pub fn in_another_unit(&self, role: Role, too_small: bool) -> Option<Channel> {
        let own = self.mapping.channel(role).filter(|c| c.scale.is_none())?;
        let unit = own.unit.as_ref()?;
        let (unit, scale) = another_unit(unit, unit.dimension(), role, too_small);
        Some(Channel {
            unit: Unit::parse(&unit).ok(),
            scale: scale.and_then(|scale| Value::parse(&scale.to_string()).ok()),
            ..own.clone()
        })
    }

    /// Counts of the counter that overflows where the position jumps by this much, m or rad; `None` where the position is not
    /// logged in counts, or the jump is none of a counter of 8 to 48 bits.
    pub fn counter(&self, jump: f64) -> Option<u64> {
        let channel = self.mapping.position.as_ref()?;
        let counts = channel.unit.as_ref()?.dimension() == Dimension::COUNTS;
        let count = channel.scale.as_ref().filter(|_| counts)?.si();
        unwrap::bits(jump, count).map(|bits| 1 << bits)
    }

    /// The refusal of a position that begins again, as a counter that overflows or an angle after each turn does, where no wrap is
    /// given: then it is not the position of the axis. `None` of any other.
    pub fn overflow(&self) -> Option<Error> {
        let position = self.position.as_deref()?;
        let mut found = self.findings.iter();
        let jump = found.find(|finding| matches!(finding.kind, Found::Jumps { .. }))?;
        findings::begins_again(self, position).then(|| {
            Error::new(Kind::Value, jump.to_string(), "")
                .in_column("position")
                .settled_by_line()
        })
    }

    /// Counts of a position that is logged in counts with a scale, in place of m or rad; `None` of any other.
    pub(crate) fn counts(&self) -> Option<Vec<f64>> {
        let channel = self.mapping.position.as_ref()?;
        let counts = channel.unit.as_ref()?.dimension() == Dimension::COUNTS;
        let count = channel.scale.as_ref().filter(|_| counts)?.si();
        let position = self.position.as_ref()?;
        Some(position.iter().map(|x| x / count).collect())
    }

    /// Which samples may be fitted to: those that nothing excludes but a rest at an end, which for a procedure that
    /// starts from rest is data.
    pub fn valid(&self) -> Vec<bool> {
        let mut valid = vec![true; self.time.len()];
        let faulty = |e: &&Excluded| !matches!(e.code, Code::RestAtEnd | Code::RestBetween);
        for excluded in self.excluded.iter().filter(faulty) {
            valid[excluded.samples.clone()].fill(false);
        }
        valid
    }

    /// Which samples a fit of the whole record carries along and does not fit: the axis is at rest.
    pub fn at_rest(&self) -> Vec<bool> {
        let mut at_rest = vec![false; self.time.len()];
        for e in self.excluded.iter().filter(|e| e.code == Code::RestBetween) {
            at_rest[e.samples.clone()].fill(true);
        }
        at_rest
    }

    /// The samples of a record that is fitted as a whole: without rests at the ends but for half a second in which
    /// filters settle, and of which most is excluded.
    pub fn fitted(&self) -> Range<usize> {
        let carried = |from: f64, to: f64| {
            self.time.partition_point(|t| *t < from)..self.time.partition_point(|t| *t <= to)
        };
        let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
        for rest in self.rests_left_out() {
            if rest.start == 0 {
                from = self.time[rest.end - 1] - stiction_policy::rest::CARRIED_TIME;
            } else {
                to = self.time[rest.start] + stiction_policy::rest::CARRIED_TIME;
            }
        }
        carried(from, to)
    }

    /// Which samples a fit of the whole record may see.
    pub fn valid_in_motion(&self) -> Vec<bool> {
        let mut valid = self.valid();
        for rest in self.rests_left_out() {
            valid[rest.clone()].fill(false);
        }
        valid
    }

    /// The rests at the ends that fits of the whole record leave out.
    fn rests_left_out(&self) -> impl Iterator<Item = &Range<usize>> {
        let rests = self.excluded.iter().filter(|e| e.code == Code::RestAtEnd);
        rests
            .map(|e| &e.samples)
            .filter(|samples| !samples.is_empty())
    }

    /// Whether any finding is of a kind.
    pub fn finds(&self, is: impl Fn(&Found) -> bool) -> bool {
        self.findings.iter().any(|finding| is(&finding.kind))
    }

    /// Whether any finding is a warning.
    pub fn has_warnings(&self) -> bool {
        self.findings
            .iter()
            .any(|f| f.severity == Severity::Warning)
    }

    /// Whether the force takes so few values that what a fit makes of their steps is no constant of a machine: more than one, and
    /// fewer than ten.
    pub fn has_few_force_levels(&self) -> bool {
        let levels = self.force.as_deref().map(crate::findings::levels);
        levels.is_some_and(|levels| (2..stiction_policy::force::MIN_VALUES).contains(&levels.len()))
    }

    /// Which samples are excluded.
    pub(crate) fn skipped(&self) -> Vec<bool> {
        self.valid().into_iter().map(|valid| !valid).collect()
    }

    /// Whether a gap begins after a sample, or another recording.
    pub(crate) fn gap_after(&self, sample: usize) -> bool {
        let gap = self.gaps.binary_search_by_key(&sample, |g| g.start_index);
        gap.is_ok() || self.resumed.binary_search(&(sample + 1)).is_ok()
    }

    /// Whether a segment begins with this sample.
    pub(crate) fn starts_segment(&self, sample: usize) -> bool {
        self.segments
            .binary_search_by_key(&sample, |s| s.start)
            .is_ok()
    }

    /// Lets a new segment begin at each of these samples, which are in order.
    pub(crate) fn split(&mut self, at: &[usize]) {
        let mut starts: Vec<usize> = self.segments.iter().map(|s| s.start).collect();
        starts.extend(at);
        starts.sort_unstable();
        starts.dedup();
        let ends = starts.iter().skip(1).copied().chain([self.time.len()]);
        self.segments = starts
            .iter()
            .copied()
            .zip(ends)
            .map(|(from, to)| from..to)
            .collect();
    }

    /// Takes the force of every row so many rows later (earlier where negative), within each segment, since it was logged beside
    /// other motion than its own; with those before, `whole` rows. Rows at the ends of a segment whose force is not in it are
    /// excluded.
    pub fn take_force_from(&mut self, rows: isize, whole: isize) {
        let seconds = whole.unsigned_abs() as f64 / self.rate_hz;
        let found = Found::ForceLate {
            rows: whole,
            seconds,
        };
        let code = found.code();
        // A row or two more than the low-pass itself are how a drive counts its filter.
        let filtered = self.finds(Found::is_force_smoothed);
        let least = if filtered { 3 } else { 1 };
        self.findings
            .retain(|f| !matches!(f.kind, Found::ForceLate { .. }));
        if whole.unsigned_abs() >= least {
            self.findings.push(Finding::warning(found));
        }
        for segment in self.segments.clone() {
            let moved = rows.unsigned_abs().min(segment.len());
            if let Some(force) = &mut self.force {
                let own = &mut force[segment.clone()];
                match rows > 0 {
                    true => own.copy_within(moved.., 0),
                    false => own.copy_within(..own.len() - moved, moved),
                }
            }
            let lost = |way: isize| (way * whole).max(way * rows).max(0) as usize;
            let [start, end] = [lost(-1), lost(1)].map(|rows| rows.min(segment.len()));
            for without in [
                segment.start..segment.start + start,
                segment.end - end..segment.end,
            ] {
                if !without.is_empty() {
                    self.exclude(without, code);
                }
            }
        }
        let length = self.time.len();
        let own = |row: usize| row.saturating_add_signed(-rows).min(length);
        for excluded in &mut self.excluded {
            // What the force shows moves with it.
            if [Code::Saturation, Code::ForceDead].contains(&excluded.code) {
                excluded.samples = own(excluded.samples.start)..own(excluded.samples.end);
            }
        }
        self.excluded
            .sort_by_key(|e| (e.samples.start, e.samples.end));
    }

    /// Undoes a low-pass of first order of that time constant, s, behind which the force was logged, within each segment; the
    /// first row of each, whose force from before is not known, is excluded.
    pub fn undo_force_filter(&mut self, time: f64) {
        let samples = time * self.rate_hz;
        let found = Found::ForceLowPass { seconds: time };
        self.undo_smoothing(found, |force| undo_low_pass(force, samples));
    }

    /// Undoes a mean over so many rows that the logged force is, within each segment; the first and the last row of each are
    /// excluded.
    pub fn undo_force_mean(&mut self, rows: usize) {
        self.undo_smoothing(Found::ForceMean { rows }, |force| {
            undo_mean(force, rows as f64)
        });
        for segment in self.segments.clone() {
            self.exclude(segment.end - 1..segment.end, Code::ForceFiltered);
        }
    }

    fn undo_smoothing(&mut self, found: Found, undo: impl Fn(&mut [f64])) {
        self.findings.push(Finding::warning(found));
        for segment in self.segments.clone() {
            if let Some(force) = &mut self.force {
                undo(&mut force[segment.clone()]);
            }
            self.exclude(segment.start..segment.start + 1, Code::ForceFiltered);
        }
    }

    /// Marks samples as not to be fitted to.
    pub(crate) fn exclude(&mut self, samples: Range<usize>, code: Code) {
        self.excluded.push(Excluded { samples, code });
    }
}

/// Lets go of the samples of the other columns, where the table is ours. Names and units stay, for messages.
fn keep_columns(table: &mut Cow<'_, Table>, wanted: impl Fn(usize) -> bool) {
    if let Cow::Owned(table) = table {
        let columns = table.columns.iter_mut().enumerate();
        for (_, column) in columns.filter(|(index, _)| !wanted(*index)) {
            column.values = Vec::new();
        }
    }
}

/// What became of every column, where some channels are no use.
fn without(mut columns: Vec<Understood>, left_out: &[LeftOut]) -> Vec<Understood> {
    for LeftOut { role, why } in left_out {
        for column in columns.iter_mut().filter(|c| c.role == Some(*role)) {
            column.reason = format!("left out: {why}");
            column.assumed = None;
        }
    }
    columns
}

/// Rate of the median step, to nine digits: time stamps are decimal, their differences are not. Stamps that are rounded to the step
/// of a clock, or as seconds since 1970 to what 64 bits resolve, have two steps, of which neither is the time between samples: it is
/// their mean.
fn rate(time: &[f64]) -> f64 {
    /// What is left of a step by the arithmetic of decimal numbers, of the step.
    const SAME: f64 = 1e-3;
    if let Some((clock, _)) = coarse::Coarse::of_a_part(time) {
        return clock.rate_hz;
    }
    let mut steps: Vec<f64> = time.windows(2).map(|w| w[1] - w[0]).collect();
    let step = findings::median(&mut steps).unwrap_or(1.0);
    let whole = || {
        steps
            .iter()
            .copied()
            .filter(|s| *s < stiction_policy::clock::MIN_MISSING_STEP * step)
    };
    let (least, most) = whole().fold((f64::INFINITY, 0.0_f64), |(a, b), s| (a.min(s), b.max(s)));
    let apart = most - least;
    let of_two = |s: f64| (s - least).min(most - s) <= SAME * step.min(apart);
    let is_rounded = apart > 1e-6 * step
        && apart <= stiction_policy::clock::MAX_ROUNDED_STEP * step
        && whole().all(of_two);
    let step = match is_rounded {
        true => whole().sum::<f64>() / whole().count() as f64,
        false => step,
    };
    let rate = 1.0 / step;
    format!("{rate:.8e}").parse().unwrap_or(rate)
}

/// What acts from outside adds to the force, and so is in its unit: that of the column, or the one that a motor makes of it.
fn same_force(sources: &[(Role, Source)], made: Option<Dimension>) -> Result<(), Error> {
    let of = |role| sources.iter().find(|(own, _)| *own == role);
    let (Some((_, force)), Some((_, external))) = (of(Role::Force), of(Role::External)) else {
        return Ok(());
    };
    let wanted = made.unwrap_or(force.dimension);
    if wanted == external.dimension {
        return Ok(());
    }
    let (own, wanted) = (external.dimension.si_text(), wanted.si_text());
    let found = format!("external is in {own} and the force in {wanted}");
    let allowed = format!(
        "both in one unit, such as external = {{ column = \"...\", scale = \"0.1 {wanted}/{own}\" }}"
    );
    Err(Error::new(Kind::Unit, found, allowed).in_column(Role::External.name()))
}

/// Refuses columns that stand behind other time stamps than those of the log: their rows have nothing to do with each other.
/// Columns from `joined` on were joined by their stamps already.
fn refuse_mixed(table: &Table, mapping: &Mapping, joined: usize) -> Result<(), Error> {
    let own = mapping.own_stamps(table);
    let own: Vec<_> = own.iter().filter(|own| own.column < joined).collect();
    let Some(first) = own.first() else {
        return Ok(());
    };
    let found = format!(
        "{} stands behind the time stamps of {}, which are others than those of the log",
        first.role,
        first.place(table)
    );
    let lines: Vec<&str> = own.iter().map(|own| own.line.as_str()).collect();
    let allowed = format!(
        "say in axis.toml under [columns] which it has, and it is joined by them: {}; or the same with the time of the log, where \
         it belongs to that",
        lines.join(" and ")
    );
    Err(Error::new(Kind::Ambiguous, found, allowed))
}

/// The length of the shortest column in use, if that costs little.
fn common_length(
    table: &Table,
    mapping: &Mapping,
    sources: &[(Role, Source)],
    findings: &mut Vec<Finding>,
) -> Result<usize, Error> {
    let length = |source: &Source| table.columns[source.column].values.len();
    let longest = sources.iter().map(|(_, s)| length(s)).max().unwrap_or(0);
    let Some((role, source)) = sources.iter().min_by_key(|(_, s)| length(s)) else {
        return Ok(0);
    };
    let shortest = length(source);
    let lost = longest - shortest;
    if lost == 0 {
        return Ok(longest);
    }
    let found = format!(
        "{role} has {}, other columns up to {longest}",
        findings::count(shortest, "sample")
    );
    if lost as f64 > stiction_policy::clock::MAX_CUT_SHARE * longest as f64 && lost > 2 {
        let own = mapping.own_stamps(table);
        let lines: Vec<&str> = own.iter().map(|own| own.line.as_str()).collect();
        let allowed = match lines.is_empty() {
            true => "all columns need the same rate; export them with one sample time".into(),
            false => format!(
                "a column with time stamps of its own names them in axis.toml under [columns], and is joined by them: {}",
                lines.join(" and ")
            ),
        };
        return Err(Error::new(Kind::Value, found, allowed));
    }
    let cut = Found::ShortColumn {
        channel: role.name(),
        samples: shortest,
        longest,
    };
    findings.push(Finding::warning(cut).at(shortest.saturating_sub(1)));
    Ok(shortest)
}
