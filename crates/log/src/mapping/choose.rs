//! Columns for what a mapping leaves open, by name and by unit.

use super::channel::{Channel, Motion, Role, Selector};
use super::convert::{is_force, of_role};
use super::enable::{self, Enable};
use super::flags::is_flag;
use super::names::{self, Hint};
use super::select::{distinct, select};
use super::still::{has_to_change, never_changes};
use super::{Detected, Mapping, bases, counted, describe, endings, motion, offered, rate, wanted};
use crate::findings::Finding;
use crate::{Dimension, Error, Kind, Table, Unit, Value};
use stiction_say::{ForceLine, Found};

/// Sample times, s, that a file may give: those of the rates that an axis file may give.
const PLAUSIBLE_SAMPLE_TIME: std::ops::RangeInclusive<f64> = 1e-9..=1e3;

/// What must be of one axis: a motion and the force that drives it.
const MOVED_AND_MOVING: [Role; 3] = [Role::Position, Role::Velocity, Role::Force];

/// A table with what its names and units say.
struct Scan<'a> {
    table: &'a Table,
    hints: Vec<Option<Hint>>,
    units: Vec<Option<Unit>>,
    /// Columns of 0 and 1.
    flags: Vec<bool>,
    /// Columns that never change.
    still: Vec<bool>,
    used: Vec<bool>,
    /// Letter of the axis whose columns are named so far.
    axis: Option<char>,
    /// Group in the file in which they are: `elbow` of `elbow.position`.
    group: Option<&'a str>,
}

/// Fills in the columns that are left open. What is refused, each of which stands whatever is done about the others, goes to
/// `refused`.
///
/// # Errors
/// Where nothing more can be said before it is mended.
pub(super) fn columns(
    out: &mut Detected,
    table: &Table,
    refused: &mut Vec<Error>,
) -> Result<(), Error> {
    let given = out.mapping.clone();
    let mut scan = Scan::new(table);
    let mut told: Vec<(usize, Role)> = Vec::new();
    for role in Role::ALL {
        if let Some(channel) = given.channel(role) {
            let of_role = |e: Error| e.of_setting(role.key("column"));
            let selected = select(table, &channel.column, role);
            // One axis file serves all logs of an axis, and not every one of them was recorded with this sensor.
            if role == Role::Acceleration && selected.is_err() {
                out.mapping.acceleration = None;
                out.phrases
                    .push("acceleration = none: no such column in this recording".to_string());
                continue;
            }
            let column = match selected {
                Ok(column) => column,
                Err(e) => {
                    refused.push(of_role(e));
                    *out.mapping.slot(role) = None;
                    continue;
                }
            };
            let taken = told.iter().find(|(other, _)| *other == column);
            if let Some((_, other)) = taken {
                let found = format!("{} is {other} already", describe::column(table, column));
                let error = Error::new(Kind::Ambiguous, found, "a column of its own for each role");
                refused.push(of_role(error));
                *out.mapping.slot(role) = None;
                continue;
            }
            if scan.is_time(column) && role != Role::Time && given.time.is_none() {
                let found = format!(
                    "{} is the time, by its name and unit",
                    describe::column(table, column)
                );
                let allowed = format!("the column of the {role}; {}", describe::columns(table));
                refused.push(of_role(Error::new(Kind::Ambiguous, found, allowed)));
                *out.mapping.slot(role) = None;
                continue;
            }
            let no_motion = given.position.is_none() && given.velocity.is_none();
            if role == Role::Force && no_motion && scan.is_position(column) {
                refused.push(of_role(scan.position_as_force(column)));
                *out.mapping.slot(role) = None;
                continue;
            }
            scan.used[column] = true;
            told.push((column, role));
            if MOVED_AND_MOVING.contains(&role) {
                scan.axis = scan
                    .axis
                    .or(names::axis_letter(&table.columns[column].name));
                scan.group = scan.group.or(names::group(&table.columns[column].name));
            }
        }
    }
    let enable = Enable::of(&given, table).unwrap_or_else(|e| {
        refused.push(e);
        None
    });
    if let Some(column) = enable {
        if let Some((_, role)) = told.iter().find(|(other, _)| *other == column) {
            let found = format!("{} is {role} already", describe::column(table, column));
            let allowed = "a column of its own that says in which rows the axis is enabled";
            let error = Error::new(Kind::Ambiguous, found, allowed);
            refused.push(error.of_setting(format!("{}.column", enable::KEY)));
        }
        scan.used[column] = true;
    }
    if given.time.is_some() && given.rate_hz.is_some() {
        let found = "both a time column and a rate are given";
        let allowed = "one of the two: delete the line time under [columns], where the clock is too coarse or wrong, or else the line rate";
        let error = Error::new(Kind::Ambiguous, found, allowed);
        refused.push(error.of_setting("rate"));
    }
    // What else would be taken depends on these.
    if !refused.is_empty() {
        return Ok(());
    }
    let nothing_told = given.position.is_none() && given.velocity.is_none();
    if nothing_told && describe::unnamed(table) {
        return Err(nameless(table));
    }
    if let Some(hertz) = given.rate_hz {
        let stamps = scan.pick(Role::Time).ok().flatten();
        let stamps = stamps.map(|column| (column, scan.units[column].as_ref()));
        let missing = stamps.and_then(|stamps| {
            let finding = rate::missing_rows(table, stamps, (hertz, given.crop))?;
            Some((stamps.0, finding))
        });
        match missing {
            Some((column, finding)) => {
                out.findings.push(finding);
                out.mapping.rate_hz = None;
                out.mapping.time = Some(scan.take(column));
            }
            None => match rate::compare(table, stamps, (hertz, given.crop)) {
                Ok(finding) => out.findings.extend(finding),
                Err(e) => refused.push(e),
            },
        }
    }
    if given.time.is_none() && given.rate_hz.is_none() {
        match scan.pick(Role::Time) {
            Ok(Some(column)) => out.mapping.time = Some(scan.take(column)),
            Ok(None) => match scan.stated_rate() {
                Ok(rate) => out.mapping.rate_hz = Some(rate),
                Err(e) => refused.push(e),
            },
            Err(e) => refused.push(e),
        }
    }
    if let Some(rate) = out.mapping.rate_hz {
        out.phrases.push(format!("time = row number at {rate} Hz"));
    }
    let mut is_known = true;
    if given.position.is_none()
        && given.velocity.is_none()
        && let Err(e) = scan.motion_columns(&mut out.mapping)
    {
        refused.push(e);
        is_known = false;
    }
    // A servo's own loop says more than the current that it states.
    let is_made = given
        .drive
        .is_some_and(|drive| drive.position_loop.is_some());
    if given.force.is_none() && !given.absent.contains(&Role::Force) && !is_made {
        match scan.force_column(&out.mapping) {
            Ok(Some(column)) => out.mapping.force = Some(scan.take(column)),
            Ok(None) => out.findings.push(scan.no_force()),
            // Which force goes with it is clear once the motion is, where names tell axes apart.
            Err(_) if !is_known && scan.tells_axes() => {}
            Err(e) => refused.push(e),
        }
    }
    let is_open = |role: &Role| given.channel(*role).is_none() && !given.absent.contains(role);
    for role in Role::OPTIONAL.into_iter().filter(is_open) {
        match scan.pick(role) {
            Ok(Some(column)) => *out.mapping.slot(role) = scan.beside(&given, role, column),
            Ok(None) => {}
            Err(_) => out
                .phrases
                .push(format!("{role}: several columns fit, so none is taken")),
        }
    }
    Ok(())
}

/// The columns whose role is clear, whatever is wrong with the others.
pub(crate) fn clear(table: &Table) -> Mapping {
    let mut out = Mapping::default();
    let mut scan = Scan::new(table);
    for role in Role::ALL {
        let picked = scan.pick(role).ok().flatten();
        if let Some(column) = picked.filter(|c| scan.refuse_other_axis(&out, role, *c).is_ok()) {
            let counted = || {
                let is_counted = role == Role::Position && counted::is_counted(table, column);
                Unit::parse("counts").ok().filter(|_| is_counted)
            };
            let unit = scan.units[column].clone().or_else(counted);
            let channel = scan.take(column);
            *out.slot(role) = Some(Channel { unit, ..channel });
        }
    }
    if out.position.is_none() && out.velocity.is_none() {
        let counts = |c: &usize| {
            let by_unit = scan.units[*c].as_ref().map(Unit::dimension) == Some(Dimension::COUNTS);
            let free = !scan.used[*c] && !scan.flags[*c] && !scan.is_hinted(*c, Role::Force);
            free && (by_unit || names::says_counts(&table.columns[*c].name))
        };
        let mut counted = (0..table.columns.len()).filter(counts);
        if let (Some(column), None) = (counted.next(), counted.next()) {
            let unit = Unit::parse("counts").ok();
            let channel = scan.take(column);
            out.position = Some(Channel { unit, ..channel });
        }
    }
    let known = Role::ALL.into_iter().filter_map(|role| {
        let channel = out.channel(role)?;
        Some((role, channel.unit.as_ref()?.dimension()))
    });
    out.motion = motion::from_units(&known.collect::<Vec<_>>()).map(|(motion, _)| motion);
    out
}

fn nameless(table: &Table) -> Error {
    let steps_by_one =
        |values: &[f64]| values.len() > 1 && values.windows(2).all(|p| p[1] - p[0] == 1.0);
    let allowed = if table
        .columns
        .first()
        .is_some_and(|c| steps_by_one(&c.values))
    {
        "say which is which in axis.toml: rate = \"1 kHz\" where column 1 numbers the samples, as halsampler -t does, or \
         under [columns] time = { column = 1, unit = \"ms\" } where it counts milliseconds; and under [columns], by number \
         counted from 1, as in: position = { column = 2, unit = \"mm\" }, force = { column = 3, unit = \"N\" }"
    } else if table.columns.len() == 2 {
        "say which is which in axis.toml: rate = \"1 kHz\", since so few columns are none of time beside motion and force, and under \
         [columns], by number counted from 1, as in: position = { column = 1, unit = \"rad\" }, force = { column = 2, unit = \"N*m\" }"
    } else {
        "say which is which in axis.toml: rate = \"1 kHz\" where there is no time column, \
                   and under [columns], by number counted from 1, as in: time = { column = 1, unit = \
                   \"s\" }, position = { column = 2, unit = \"rad\" }, force = { column = 3, unit = \
                   \"N*m\" }"
    };
    Error::new(
        Kind::Missing,
        format!(
            "nothing identifies the columns: {}",
            describe::columns(table)
        ),
        allowed,
    )
}

impl<'a> Scan<'a> {
    fn new(table: &'a Table) -> Self {
        let unit = |text: &String| Unit::parse(text).ok();
        let units = table.columns.iter();
        let mut scan = Self {
            table,
            hints: (0..table.columns.len())
                .map(|c| endings::hint(table, c))
                .collect(),
            units: units
                .enumerate()
                .map(|(c, own)| {
                    own.unit
                        .as_ref()
                        .and_then(unit)
                        .or_else(|| endings::unit(table, c))
                })
                .collect(),
            flags: (0..table.columns.len())
                .map(|c| is_flag(table, c))
                .collect(),
            still: (0..table.columns.len())
                .map(|c| never_changes(table, c))
                .collect(),
            used: vec![false; table.columns.len()],
            axis: None,
            group: None,
        };
        scan.hint_axes();
        scan
    }

    /// `Y act` is a position where `X act` is one too: by itself `x` is the name of any position, beside other
    /// letters that of one axis of several.
    fn hint_axes(&mut self) {
        let of_axis = |c: usize| {
            names::hint_of_axis(endings::stem(self.table, c))
                .filter(|hint| self.unit_allows(c, hint.role))
        };
        let hints: Vec<_> = (0..self.hints.len()).map(of_axis).collect();
        let letter = |c: usize| names::axis_letter(&self.table.columns[c].name);
        let mut letters = (0..hints.len()).filter(|c| hints[*c].is_some()).map(letter);
        let Some(first) = letters.next() else { return };
        if letters.any(|other| other != first) {
            for (own, of_axis) in self.hints.iter_mut().zip(hints) {
                *own = own.or(of_axis);
            }
        }
    }

    /// Takes position and velocity.
    fn motion_columns(&mut self, out: &mut Mapping) -> Result<(), Error> {
        for role in [Role::Position, Role::Velocity] {
            if let Some(column) = self.pick(role)? {
                self.refuse_other_axis(out, role, column)?;
                let name = &self.table.columns[column].name;
                self.group = self.group.or(names::group(name));
                *out.slot(role) = Some(self.take(column));
            }
        }
        match (&out.position, &out.velocity) {
            (None, None) => Err(self.no_motion()),
            _ => Ok(()),
        }
    }

    /// The force of the motion that is taken.
    fn force_column(&self, out: &Mapping) -> Result<Option<usize>, Error> {
        let column = self.pick(Role::Force)?;
        if let Some(column) = column {
            self.refuse_other_axis(out, Role::Force, column)?;
        }
        Ok(column)
    }

    /// Whether the name of a force tells to which of several axes it belongs.
    fn tells_axes(&self) -> bool {
        let by_unit = |c: usize| {
            let unit = self.units[c].as_ref().map(Unit::dimension);
            unit.is_some_and(|unit| unit != Dimension::ONE && is_force(unit))
        };
        let mut forces =
            (0..self.hints.len()).filter(|c| self.is_hinted(*c, Role::Force) || by_unit(*c));
        forces.any(|c| {
            let name = &self.table.columns[c].name;
            names::axis_letter(name).is_some() || names::group(name).is_some()
        })
    }

    /// Whether a column is time by its name, in a unit of time or none.
    fn is_time(&self, column: usize) -> bool {
        let unit = self.units[column].as_ref();
        self.hints[column].is_some_and(|hint| hint.role == Role::Time)
            && unit.is_none_or(|unit| unit.dimension() == Dimension::TIME)
    }

    /// Whether a column is a measured position by its name, in a unit of a position or none.
    fn is_position(&self, column: usize) -> bool {
        self.hints[column].is_some_and(|hint| hint.role == Role::Position && !hint.weak)
            && self.unit_allows(column, Role::Position)
    }

    /// The refusal of a position that is named as the force of a log, with the line of what could be the force.
    fn position_as_force(&self, column: usize) -> Error {
        let found = format!(
            "{} is the position, by its name and unit",
            describe::column(self.table, column)
        );
        let mut forces = (0..self.units.len())
            .filter(|c| self.is_hinted(*c, Role::Force) && self.unit_allows(*c, Role::Force));
        let line = forces.next().map(|c| {
            format!(
                ", as in: {}",
                offered::line(self.table, c, Role::Force, self.kind())
            )
        });
        let allowed = format!(
            "the column of the force{}; {}",
            line.unwrap_or_default(),
            describe::columns(self.table)
        );
        Error::new(Kind::Ambiguous, found, allowed)
    }

    fn take(&mut self, column: usize) -> Channel {
        self.used[column] = true;
        let name = &self.table.columns[column].name;
        let unique = self
            .table
            .columns
            .iter()
            .filter(|c| c.name == *name)
            .count()
            == 1;
        if unique && !name.trim().is_empty() && name.trim() == name {
            Channel {
                column: Selector::Name(name.clone()),
                ..Channel::index(0)
            }
        } else {
            Channel::index(self.table.number(column))
        }
    }

    /// A column that is found beside those of a mapping: with the sign of its motion, and a reference as its position where the
    /// file has both in one unit. `None` where the motion has a scale, such as that of a gear, and nothing tells whether the
    /// column needs it too.
    fn beside(&mut self, given: &Mapping, role: Role, column: usize) -> Option<Channel> {
        let motion = given.position.as_ref().or(given.velocity.as_ref());
        let moves = matches!(role, Role::Reference | Role::Acceleration);
        let Some(motion) = motion.filter(|_| moves) else {
            return Some(self.take(column));
        };
        let of_position = given.position.is_some() && role == Role::Reference;
        let at = select(self.table, &motion.column, Role::Position).ok();
        if of_position && at.is_some_and(|at| self.units[at] == self.units[column]) {
            let column = self.take(column).column;
            return Some(Channel {
                column,
                ..motion.clone()
            });
        }
        let counted = |scale: &Value| {
            let of = [Dimension::LENGTH, Dimension::ANGLE].into_iter();
            of.map(|d| d.per(scale.unit.dimension()))
                .any(|unit| unit == Some(Dimension::COUNTS))
        };
        let in_si = motion.scale.as_ref().is_none_or(counted);
        in_si.then(|| Channel {
            invert: motion.invert,
            ..self.take(column)
        })
    }

    /// The one column that fits a role; an error where several fit equally well.
    fn pick(&self, role: Role) -> Result<Option<usize>, Error> {
        let mut fits: Vec<(usize, Hint)> = self
            .hints
            .iter()
            .enumerate()
            .filter(|(column, _)| !self.used[*column] && !self.flags[*column])
            .filter(|(column, _)| self.unit_allows(*column, role))
            .filter_map(|(column, hint)| hint.filter(|h| h.role == role).map(|h| (column, h)))
            .collect();
        if fits.is_empty() {
            return self.pick_by_unit(role);
        }
        // Each preference only counts where something is left of it.
        let preferences: [fn(&Hint) -> bool; 3] = [
            |h| !h.commanded || h.role == Role::Reference,
            |h| !h.weak,
            |h| h.measured,
        ];
        for prefer in preferences {
            if fits.len() > 1 && fits.iter().any(|(_, h)| prefer(h)) {
                fits.retain(|(_, h)| prefer(h));
            }
        }
        // A commanded velocity is no measurement of motion; a commanded force is what drives it.
        let is_motion = matches!(role, Role::Velocity | Role::Acceleration);
        if is_motion && fits.iter().all(|(_, h)| h.commanded) {
            return Ok(None);
        }
        let mut fits: Vec<usize> = fits.into_iter().map(|(column, _)| column).collect();
        // A measured position that never changes is a fault to be seen, whatever else is commanded; of equals it is none.
        if has_to_change(role) && fits.iter().any(|c| !self.still[*c]) {
            fits.retain(|c| !self.still[*c]);
        }
        if role == Role::Time
            && let Some(motion) = self.motion()
        {
            fits = bases::as_long(self.table, fits, motion);
        }
        self.only(distinct(self.table, fits), role)
    }

    /// The column that is clearly the motion.
    fn motion(&self) -> Option<usize> {
        let picked = |role| self.pick(role).ok().flatten();
        picked(Role::Position).or_else(|| picked(Role::Velocity))
    }

    /// The one column without a telling name that is in a unit of this role.
    fn pick_by_unit(&self, role: Role) -> Result<Option<usize>, Error> {
        if is_told_by_name(role) {
            return Ok(None);
        }
        let telling = |unit: &Unit| {
            let d = unit.dimension();
            d != Dimension::COUNTS && d != Dimension::ONE && allows(role, d)
        };
        let fits: Vec<usize> = (0..self.table.columns.len())
            .filter(|&c| !self.used[c] && !self.flags[c] && self.hints[c].is_none())
            .filter(|&c| !names::passed_over(&self.table.columns[c].name))
            .filter(|&c| !(self.still[c] && has_to_change(role)))
            .filter(|&c| self.units[c].as_ref().is_some_and(telling))
            .collect();
        self.only(distinct(self.table, fits), role)
    }

    fn only(&self, mut fits: Vec<usize>, role: Role) -> Result<Option<usize>, Error> {
        // Of several axes the one whose force or motion is named; what a log may lack is of no other one.
        let letter = |c: &usize| names::axis_letter(&self.table.columns[*c].name);
        if MOVED_AND_MOVING.contains(&role) && fits.iter().any(|c| self.axis == letter(c)) {
            fits.retain(|c| self.axis.is_none() || self.axis == letter(c));
        }
        if matches!(role, Role::Reference | Role::Acceleration) && self.axis.is_some() {
            fits.retain(|c| letter(c).is_none_or(|own| self.axis == Some(own)));
        }
        // Of several groups that of what is named.
        let group = |c: &usize| names::group(&self.table.columns[*c].name);
        if self.group.is_some() && fits.iter().any(|c| group(c) == self.group) {
            fits.retain(|c| group(c) == self.group);
        }
        match fits.as_slice() {
            [] => Ok(None),
            [one] => Ok(Some(*one)),
            several => {
                let shown = several.iter().map(|&c| describe::place(self.table, c));
                let found = format!(
                    "{} columns could be the {role}, {}",
                    several.len(),
                    describe::listed(shown)
                );
                let lines: Vec<_> = several
                    .iter()
                    .take(4)
                    .map(|&c| self.lines_of_axis(c, role))
                    .collect();
                let allowed = format!(
                    "say which in axis.toml under [columns]: {}",
                    lines.join(" or ")
                );
                Err(Error::new(Kind::Ambiguous, found, allowed))
            }
        }
    }

    /// The line that makes a column a role, and for a motion the line of the force of the same axis.
    fn lines_of_axis(&self, column: usize, role: Role) -> String {
        let motion = self.kind();
        let line = offered::line(self.table, column, role, motion);
        let letter = |c: usize| names::axis_letter(&self.table.columns[c].name);
        let is_force = |c: usize| match self.hints[c] {
            Some(hint) => hint.role == Role::Force && self.unit_allows(c, Role::Force),
            None => self.units[c]
                .as_ref()
                .is_some_and(|unit| is_force(unit.dimension())),
        };
        let mut forces = (0..self.units.len())
            .filter(|&c| letter(c).is_some() && letter(c) == letter(column) && is_force(c));
        match (forces.next(), forces.next()) {
            (Some(force), None) if role == Role::Position => {
                let force = offered::line(self.table, force, Role::Force, motion);
                format!("{line} with {force}")
            }
            _ => line,
        }
    }

    /// The kind of motion that the units of positions and velocities tell, else the names of all columns.
    fn kind(&self) -> Option<Motion> {
        let roles = [Role::Position, Role::Velocity];
        let by_unit = |unit: &Unit| {
            roles
                .iter()
                .find_map(|role| motion::of(*role, unit.dimension()))
        };
        let names = self.table.columns.iter().map(|own| own.name.as_str());
        let told = self.units.iter().flatten().find_map(by_unit);
        told.or_else(|| motion::from_names(names).ok())
    }

    /// Refuses a column of another axis than that of the columns chosen so far: nothing in the samples would show
    /// that a motion and a force have nothing to do with each other.
    fn refuse_other_axis(&self, chosen: &Mapping, role: Role, column: usize) -> Result<(), Error> {
        // A force that is called `y` is no force of the axis Y.
        let letter = |role: Role, c: usize| {
            let name = &self.table.columns[c].name;
            let axis = names::axis_letter(name);
            axis.filter(|_| role != Role::Force || names::hint_of_axis(name).is_none())
        };
        if !MOVED_AND_MOVING.contains(&role) {
            return Ok(());
        }
        let Some(own) = letter(role, column) else {
            return Ok(());
        };
        for other in MOVED_AND_MOVING {
            let channel = chosen.channel(other);
            let Some(index) = channel.and_then(|c| select(self.table, &c.column, other).ok())
            else {
                continue;
            };
            if letter(other, index).is_some_and(|letter| letter != own) {
                let found = format!(
                    "the {role} would be {}, and the {other} {}: by their names two axes",
                    describe::column(self.table, column),
                    describe::column(self.table, index)
                );
                let allowed = format!(
                    "say which belong together in axis.toml under [columns], as in: {} with {}",
                    offered::line(self.table, column, role, self.kind()),
                    offered::line(self.table, index, other, self.kind())
                );
                return Err(Error::new(Kind::Ambiguous, found, allowed));
            }
        }
        Ok(())
    }

    fn unit_allows(&self, column: usize, role: Role) -> bool {
        self.units[column]
            .as_ref()
            .is_none_or(|unit| allows(role, of_role(unit, role).dimension()))
    }

    /// The rate that the file states, where it has no time.
    fn stated_rate(&self) -> Result<f64, Error> {
        let table = self.table;
        let step = table
            .sample_time
            .filter(|dt| PLAUSIBLE_SAMPLE_TIME.contains(dt));
        if let Some(step) = step {
            return Ok(1.0 / step);
        }
        let found = format!(
            "no time column was recognised, and no rate is given; {}",
            describe::columns(table)
        );
        let open = |c: &usize| !self.used[*c] && !self.flags[*c] && self.hints[*c].is_none();
        // Of other columns no samples may have been read; one that is left out may have been the time by its name.
        let read = |c: &usize| table.left_out.is_empty() && wanted::may_run_on(table, *c);
        let mut runs_on = (0..self.units.len()).filter(|c| open(c) && read(c));
        let line = runs_on.find_map(|c| rate::time_line(table, c));
        let line = line
            .unwrap_or_else(|| "time = \"t\" (or the number of the column, counted from 1)".into());
        let allowed =
            format!("give one of them in axis.toml: rate = \"1 kHz\", or under [columns]: {line}");
        Err(Error::new(Kind::Missing, found, allowed))
    }

    fn no_motion(&self) -> Error {
        let found = format!(
            "no column was recognised as position or velocity; {}",
            describe::columns(self.table)
        );
        let parts = Unit::parse("%").map(|unit| unit.dimension());
        let in_parts = |c: &usize| {
            let unit = self.units[*c].as_ref();
            unit.is_some_and(|unit| Ok(unit.dimension()) == parts)
                && self.is_hinted(*c, Role::Position)
        };
        if let Some(column) = (0..self.units.len()).find(in_parts) {
            let unit = self.table.columns[column].unit.as_deref().unwrap_or("%");
            let found = format!(
                "{found}; {} has the name of a position, but is in {unit}, a part of something",
                describe::column(self.table, column)
            );
            let rest = format!("unit = \"{unit}\", scale = \"2 mm/{unit}\"");
            let allowed = format!(
                "say in axis.toml under [columns] how far 1 {unit} is, as in: {}",
                describe::line_with(self.table, column, Role::Position, &rest)
            );
            return Error::new(Kind::Missing, found, allowed);
        }
        // A column that may be a position: none that is something else by its name or its unit.
        let open = |c: &usize| {
            let named = self.hints[*c].is_some_and(|hint| hint.role != Role::Position);
            let free = !self.used[*c] && !self.flags[*c] && !self.still[*c];
            free && !named && self.unit_allows(*c, Role::Position)
        };
        // Counts are of an encoder, whatever else could be a position.
        let mut counted = (0..self.units.len()).filter(|c| counted::is_counted(self.table, *c));
        let counted = counted.find(|c| open(c) && !self.is_hinted(*c, Role::Force));
        let example = match counted.or_else(|| (0..self.units.len()).find(open)) {
            Some(column) => offered::line(self.table, column, Role::Position, None),
            None => "position = { column = NUMBER, unit = \"mm\" }".into(),
        };
        let allowed = format!(
            "say which in axis.toml under [columns], by name or by number counted from 1, as in: {example}"
        );
        Error::new(Kind::Missing, found, allowed)
    }

    /// That friction needs a force, and the line that names one.
    fn no_force(&self) -> Finding {
        let open = |c: &usize| {
            let named =
                self.hints[*c].is_some() || names::passed_over(&self.table.columns[*c].name);
            let free = !self.used[*c] && !self.flags[*c] && !self.still[*c];
            free && !named && self.unit_allows(*c, Role::Force)
        };
        let of_column = |column: usize| {
            let with = |unit| describe::line_with(self.table, column, Role::Force, unit);
            let (line, open_unit) = match &self.units[column] {
                Some(_) => (describe::line(self.table, column, Role::Force), false),
                None if names::says_current(&self.table.columns[column].name) => {
                    (with("unit = \"A\""), false)
                }
                None => (with("unit = \"UNIT\""), true),
            };
            ForceLine::Column { line, open_unit }
        };
        let column = || (0..self.units.len()).rev().find(open).map(of_column);
        let line = self.nanometres().or_else(|| self.counted_force());
        Finding::warning(Found::NoForce {
            columns: describe::columns(self.table),
            line: line.or_else(column).unwrap_or(ForceLine::OtherFile),
        })
    }

    /// What to write where newton metres of a torque were written as nanometres.
    fn nanometres(&self) -> Option<ForceLine> {
        let written = |c: &usize| self.table.columns[*c].unit.as_deref() == Some("nm");
        let column =
            (0..self.units.len()).find(|c| written(c) && self.is_hinted(*c, Role::Force))?;
        Some(ForceLine::Nanometres {
            column: describe::column(self.table, column),
            line: describe::line_with(self.table, column, Role::Force, "unit = \"N m\""),
        })
    }

    /// What to write where a force is in counts, which measure nothing until their size is given.
    fn counted_force(&self) -> Option<ForceLine> {
        let in_counts =
            |c: &usize| self.is_hinted(*c, Role::Force) && counted::is_counted(self.table, *c);
        let column = (0..self.units.len()).find(in_counts)?;
        Some(ForceLine::Counts {
            column: describe::column(self.table, column),
            line: offered::line(self.table, column, Role::Force, self.kind()),
        })
    }

    fn is_hinted(&self, column: usize, role: Role) -> bool {
        self.hints[column].is_some_and(|hint| hint.role == role)
    }
}

/// Whether a column in a unit of this role may be something else, unless its name tells.
pub(super) fn is_told_by_name(role: Role) -> bool {
    matches!(role, Role::Reference | Role::Load | Role::External)
}

/// Whether a column of this dimension may be offered for a role at all.
pub(super) fn allows(role: Role, dimension: Dimension) -> bool {
    let per_second = |d: Dimension| d.per(Dimension::TIME) == Some(dimension);
    match role {
        Role::Time => dimension == Dimension::TIME,
        Role::Position | Role::Reference => {
            [Dimension::LENGTH, Dimension::ANGLE, Dimension::COUNTS].contains(&dimension)
        }
        Role::Acceleration => [Motion::Linear, Motion::Rotary]
            .iter()
            .any(|motion| dimension == motion.acceleration()),
        Role::Velocity => [Dimension::LENGTH, Dimension::ANGLE, Dimension::COUNTS]
            .into_iter()
            .any(per_second),
        Role::Force | Role::External => is_force(dimension),
        Role::Temperature => dimension == Dimension::TEMPERATURE,
        Role::Load => true,
    }
}
