//! Filling in what a mapping leaves open: columns first, then units, then the kind of motion.

use super::channel::{Channel, Motion, Role};
use super::convert::{Source, is_force};
use super::select::select;
use super::{
    Detected, Mapping, choose, counted, describe, enable, endings, motion, names, offered, rate,
    understood,
};
use crate::findings::Finding;
use crate::{Column, Dimension, Error, Kind, Table, Unit};
use stiction_number::full;
use stiction_policy::clock;
use stiction_say::Found;

/// One role with its column found and, where anything tells it, its unit.
pub(super) struct Part {
    pub role: Role,
    pub channel: Channel,
    pub column: usize,
    pub unit: Option<Unit>,
    /// Whether the unit is assumed.
    pub assumed: bool,
}

pub(super) fn complete(given: &Mapping, table: &Table) -> Result<Detected, Error> {
    let mut out = Detected {
        mapping: given.clone(),
        phrases: Vec::new(),
        findings: Vec::new(),
        columns: Vec::new(),
    };
    let is_found = |role| Role::OPTIONAL.contains(&role) && given.channel(role).is_none();
    let mut refused = Vec::new();
    choose::columns(&mut out, table, &mut refused)?;
    let mut parts = Vec::new();
    for role in Role::ALL {
        let Some(channel) = out.mapping.channel(role) else {
            continue;
        };
        let channel = channel.clone();
        let column = select(table, &channel.column, role)?;
        match written_unit(table, column, &channel, role, &mut out.findings) {
            Ok(unit) => parts.push(Part {
                role,
                channel,
                column,
                unit,
                assumed: false,
            }),
            Err(e) if is_found(role) => leave_out(&mut out, role, &e),
            Err(e) => refused.push(e),
        }
    }
    let (kind, seconds) = settled(&mut out, table, &parts, refused)?;
    assume_units(&mut out.findings, table, &mut parts, (kind, seconds))?;
    let mut misfits = Vec::new();
    let mut used = Vec::new();
    for part in parts {
        let unit = part
            .unit
            .clone()
            .unwrap_or_else(|| Unit::si(Dimension::ONE));
        let source = Source::new(table, part.column, &unit, &part.channel, part.role)?;
        if let Err(e) = source.check(table, part.role, kind) {
            if is_found(part.role) {
                leave_out(&mut out, part.role, &e);
                continue;
            }
            misfits.push((part.role, of_kind(e, (given, &part), source.dimension)));
        }
        out.phrases.push(phrase(table, &part, &unit));
        // A motor makes a force of its current, voltage or duty.
        let driven = part.role == Role::Force && out.mapping.drive.is_some();
        judge(&mut out.findings, &part, (&unit, driven), &source, kind);
        *out.mapping.slot(part.role) = Some(Channel {
            unit: Some(unit),
            ..part.channel.clone()
        });
        used.push(part);
    }
    // A wrong kind of motion is one thing, however many columns show it.
    let mut moved = misfits.iter().filter(|(role, _)| is_moved(*role));
    let first = moved.next().map(|(role, _)| *role);
    misfits.retain(|(role, _)| !is_moved(*role) || Some(*role) == first);
    let misfits = misfits.into_iter().map(|(_, e)| e).collect();
    if let Some(e) = Error::of_all(misfits) {
        return Err(e);
    }
    out.findings.extend(enable::ignored(given, table));
    out.columns = understood::all(table, given, &used);
    Ok(out)
}

/// Leaves out a column that was found by its name and is of no use as it stands.
fn leave_out(out: &mut Detected, role: Role, why: &Error) {
    *out.mapping.slot(role) = None;
    out.phrases.push(format!("{role} = none: {}", why.found));
}

/// The refusal of a unit, at the kind of motion where that is given and the unit that the file gives is one of the other kind.
fn of_kind(mut error: Error, (given, part): (&Mapping, &Part), dimension: Dimension) -> Error {
    let is_own = given
        .channel(part.role)
        .is_some_and(|c| c.unit.is_some() || c.scale.is_some());
    match motion::of(part.role, dimension) {
        Some(other) if given.motion.is_some() && !is_own => {
            error.allowed.push_str(&format!("; or kind = \"{other}\""));
            error.of_setting("kind")
        }
        _ => error,
    }
}

/// Whether the unit of a role follows from the kind of motion.
fn is_moved(role: Role) -> bool {
    use Role::{Acceleration, Position, Reference, Velocity};
    matches!(role, Position | Velocity | Acceleration | Reference)
}

/// The kind of motion, and the unit of a time that has none; `refused` is what is wrong already.
///
/// # Errors
/// With everything that has to be decided.
fn settled(
    out: &mut Detected,
    table: &Table,
    parts: &[Part],
    mut refused: Vec<Error>,
) -> Result<(Motion, Option<Unit>), Error> {
    let clock = parts.iter().find(|p| p.role == Role::Time);
    let clock = clock.filter(|part| part.unit.is_none());
    let seconds = clock.map(|part| seconds(table, part)).transpose();
    // The lines that tell columns of one role apart give them a unit.
    let told_apart = |e: &Error| e.kind == Kind::Ambiguous && e.setting().is_none();
    let asked = seconds.is_err() || refused.iter().any(told_apart);
    let missing = half_labelled(table, parts, asked);
    let is_bare = missing.is_some();
    let seconds = seconds.unwrap_or_else(|e| {
        refused.push(e);
        None
    });
    refused.extend(missing);
    let mut known = Vec::new();
    for part in parts {
        let Some(unit) = &part.unit else { continue };
        match Source::new(table, part.column, unit, &part.channel, part.role) {
            Ok(source) => known.push((part.role, source.dimension)),
            Err(e) => refused.push(e),
        }
    }
    let counted = match is_bare {
        true => Vec::new(),
        false => bare_counts(table, parts, &known, out.mapping.motion),
    };
    // The units that are to be given tell the kind of motion, and so do columns that are not found yet.
    let is_told = is_bare || !counted.is_empty() || lacks_column(&out.mapping, table, parts);
    refused.extend(counted);
    let kind = settle_motion(out, table, parts, &known);
    if refused.is_empty() || !is_told {
        refused.extend(kind.as_ref().err().cloned());
    }
    match Error::of_all(refused) {
        Some(e) => Err(e),
        None => Ok((kind?, seconds)),
    }
}

/// Whether a column that tells the kind of motion is not known yet.
fn lacks_column(mapping: &Mapping, table: &Table, parts: &[Part]) -> bool {
    let tells = |column: usize| {
        let hint = endings::hint(table, column);
        hint.is_some_and(|hint| hint.role == Role::Force)
            && names::motion(&table.columns[column].name).is_some()
    };
    if mapping.force.is_none() && (0..table.columns.len()).any(tells) {
        return true;
    }
    let is_there = |role: Role| parts.iter().any(|part| part.role == role);
    let core = [Role::Position, Role::Velocity, Role::Force];
    let mut named = core
        .into_iter()
        .filter(|role| mapping.channel(*role).is_some());
    named.any(|role| !is_there(role)) || !(is_there(Role::Position) || is_there(Role::Velocity))
}

/// The unit that follows from the mapping, the file or the scale.
fn written_unit(
    table: &Table,
    column: usize,
    channel: &Channel,
    role: Role,
    findings: &mut Vec<Finding>,
) -> Result<Option<Unit>, Error> {
    let in_file = table.columns[column]
        .unit
        .as_deref()
        .filter(|u| !u.trim().is_empty());
    if let Some(unit) = &channel.unit {
        let in_name = || endings::unit(table, column).map(|unit| unit.to_string());
        let said = in_file.map(str::to_owned).or_else(in_name);
        if let Some(other) = said.filter(|text| {
            let same = |other: Unit| {
                other.dimension() == unit.dimension() && other.factor() == unit.factor()
            };
            !Unit::parse(text).is_ok_and(same)
        }) {
            findings.push(Finding::note(Found::UnitOverride {
                channel: role.name(),
                recording: other,
                axis_file: unit.to_string(),
            }));
        }
        return Ok(Some(unit.clone()));
    }
    if let Some(text) = in_file {
        let unit = format!("unit = \"{}\"", usual(role));
        let place = |mut e: Error| {
            let line = describe::line_with(table, column, role, &unit);
            e.allowed = format!(
                "{}; or say what it is in axis.toml under [columns], as in: {line}",
                e.allowed
            );
            e.in_column(describe::place(table, column))
        };
        return Unit::parse(text).map(Some).map_err(place);
    }
    if let Some(unit) = endings::of_channel(table, column, channel, role) {
        return Ok(Some(unit));
    }
    let counts = channel.scale.as_ref().is_some_and(|scale| {
        [Motion::Linear, Motion::Rotary].into_iter().any(|kind| {
            [kind.position(), kind.velocity(), kind.force()]
                .into_iter()
                .any(|wanted| wanted.per(scale.unit.dimension()) == Some(Dimension::COUNTS))
        })
    });
    Ok(counts.then(|| Unit::si(Dimension::COUNTS)))
}

/// A unit that a column of a role is often in, as an example.
fn usual(role: Role) -> &'static str {
    match role {
        Role::Time => "ms",
        Role::Position | Role::Reference => "mm",
        Role::Velocity => "mm/s",
        Role::Acceleration => "mm/s^2",
        Role::Force | Role::External | Role::Load => "N",
        Role::Temperature => "degC",
    }
}

/// The refusal of motion or force columns without a unit in a file where others have one; `asked` where another column is to be given
/// one.
fn half_labelled(table: &Table, parts: &[Part], asked: bool) -> Option<Error> {
    let written = |column: &Column| column.unit.is_some() && !column.stamps;
    let labelled = table.columns.iter().any(written)
        || parts
            .iter()
            .any(|p| p.channel.unit.is_some() || p.channel.scale.is_some());
    let core = [Role::Position, Role::Velocity, Role::Force];
    let mut bare = parts
        .iter()
        .filter(|p| p.unit.is_none() && core.contains(&p.role))
        .peekable();
    let part = bare.peek().copied().filter(|_| labelled || asked)?;
    let names = || table.columns.iter().map(|own| own.name.as_str());
    let told = likely(table, parts).or_else(|| motion::from_names(names()).ok());
    let motion = told.unwrap_or(Motion::Linear);
    let line = |part: &Part| match counted::is_counted(table, part.column) {
        true => offered::line(table, part.column, part.role, told),
        false => offered::line(table, part.column, part.role, Some(motion)),
    };
    let lines: Vec<String> = bare.map(line).collect();
    let found = match labelled {
        true => format!("{} has no unit while other columns have one", part.role),
        false => format!(
            "{} has no unit, and needs one where another column is given one",
            part.role
        ),
    };
    let allowed = format!(
        "give it in axis.toml under [columns], as in: {}{}",
        lines.join(" and "),
        match told {
            Some(_) => "",
            None => "; deg and N m where the axis is rotary",
        }
    );
    let error = Error::new(Kind::Unit, found, allowed);
    Some(error.in_column(describe::place(table, part.column)))
}

/// The kind of motion that the units tell, else the names; `None` where nothing tells it.
fn likely(table: &Table, parts: &[Part]) -> Option<Motion> {
    let known = parts.iter().filter_map(|part| {
        let unit = part.unit.as_ref()?;
        Some((part.role, unit.dimension()))
    });
    let names = parts.iter().map(|p| table.columns[p.column].name.as_str());
    let told = motion::from_units(&known.collect::<Vec<_>>()).map(|(motion, _)| motion);
    told.or_else(|| motion::from_names(names).ok())
}

fn settle_motion(
    out: &mut Detected,
    table: &Table,
    parts: &[Part],
    known: &[(Role, Dimension)],
) -> Result<Motion, Error> {
    if let Some(kind) = out.mapping.motion {
        return Ok(kind);
    }
    let kind = if let Some((kind, role)) = motion::from_units(known) {
        out.phrases
            .push(format!("kind = {kind}, from the unit of {role}"));
        kind
    } else {
        let core = [Role::Position, Role::Velocity, Role::Force];
        let chosen = parts.iter().filter(|p| core.contains(&p.role));
        let kind = motion::from_names(chosen.map(|p| table.columns[p.column].name.as_str()))?;
        out.phrases
            .push(format!("kind = {kind}, from the names of the columns"));
        kind
    };
    out.mapping.motion = Some(kind);
    Ok(kind)
}

/// The refusals of a position and a force in counts, by their unit or their name, whose size is not given.
fn bare_counts(
    table: &Table,
    parts: &[Part],
    known: &[(Role, Dimension)],
    kind: Option<Motion>,
) -> Vec<Error> {
    let refused = |part: &Part| {
        let by_unit = known.contains(&(part.role, Dimension::COUNTS));
        let by_name = part.unit.is_none() && counted::is_counted(table, part.column);
        (by_unit || by_name).then_some(())?;
        let told = kind.or_else(|| likely(table, parts).filter(|_| by_name));
        let lines = counted::lines(table, part.column, part.role, told);
        let name = &table.columns[part.column].name;
        let of = match part.role {
            Role::Position => "encoder counts, and the size of a count",
            Role::Force if names::says_torque_object(name) => {
                "thousandths of the rated torque (6077h), and that torque"
            }
            _ => "counts, and the size of a count",
        };
        let error = Error::new(
            Kind::Unit,
            format!("{} is in {of} is not given", part.role),
            format!("give it in axis.toml under [columns], as in: {lines}"),
        );
        let error = error.in_column(describe::place(table, part.column));
        Some(match by_unit && part.channel.unit.is_some() {
            true => error.of_setting(part.role.key("unit")),
            false => error,
        })
    };
    let counted = [Role::Position, Role::Force];
    let parts_of = parts.iter().filter(|part| counted.contains(&part.role));
    parts_of.filter_map(refused).collect()
}

/// Fills in the units that nothing tells, with one finding that lists them.
fn assume_units(
    findings: &mut Vec<Finding>,
    table: &Table,
    parts: &mut [Part],
    (kind, seconds): (Motion, Option<Unit>),
) -> Result<(), Error> {
    let position = parts
        .iter()
        .find(|p| p.role == Role::Position)
        .and_then(|p| p.unit.clone());
    let force = parts.iter().find(|p| p.role == Role::Force);
    let force = force.and_then(|p| p.unit.clone());
    let mut told = Vec::new();
    for part in parts.iter_mut().filter(|p| p.unit.is_none()) {
        let name = &table.columns[part.column].name;
        let unit = match part.role {
            Role::Time => seconds.clone().unwrap_or_else(|| Unit::si(Dimension::TIME)),
            Role::Position => Unit::si(kind.position()),
            Role::Velocity => Unit::si(kind.velocity()),
            Role::Acceleration => Unit::si(kind.acceleration()),
            Role::Force if names::says_current(name) => Unit::si(Dimension::CURRENT),
            Role::Force => Unit::si(kind.force()),
            Role::Reference => position
                .clone()
                .unwrap_or_else(|| Unit::si(kind.position())),
            Role::Temperature => Unit::parse("degC")?,
            Role::Load => Unit::si(Dimension::ONE),
            Role::External => force.clone().unwrap_or_else(|| Unit::si(kind.force())),
        };
        told.push(format!("{} {unit}", part.role));
        part.unit = Some(unit);
        part.assumed = true;
    }
    if !told.is_empty() {
        findings.push(Finding::note(Found::UnitsAssumed(told)));
    }
    Ok(())
}

/// The time stamps of a table: the column that is given, or the one that is clear.
pub(crate) fn time_source(table: &Table, given: Option<&Channel>) -> Result<Source, Error> {
    let clear = match given {
        Some(_) => None,
        None => choose::clear(table).time,
    };
    let Some(channel) = given.or(clear.as_ref()).cloned() else {
        let found = format!(
            "no time column was recognised; {}",
            describe::columns(table)
        );
        let allowed = "time stamps, which join the files: name their column as time";
        return Err(Error::new(Kind::Missing, found, allowed));
    };
    let column = select(table, &channel.column, Role::Time)?;
    let mut part = Part {
        unit: written_unit(table, column, &channel, Role::Time, &mut Vec::new())?,
        role: Role::Time,
        channel,
        column,
        assumed: false,
    };
    let unit = match part.unit.take() {
        Some(unit) => unit,
        None => seconds(table, &part)?,
    };
    let source = Source::new(table, column, &unit, &part.channel, Role::Time)?;
    source.check(table, Role::Time, Motion::Linear)?;
    Ok(source)
}

/// Seconds, where the spacing is that of a motion log in seconds.
fn seconds(table: &Table, part: &Part) -> Result<Unit, Error> {
    let values = &table.columns[part.column].values;
    let steps = values
        .windows(2)
        .map(|w| w[1] - w[0])
        .filter(|d| d.is_finite());
    let median = crate::findings::median(&mut steps.collect::<Vec<_>>());
    if median.is_some_and(|dt| clock::PLAUSIBLE_SPACING.contains(&dt)) {
        return Unit::parse("s");
    }
    let numbers = match median == Some(1.0) {
        true => "; where it numbers the samples, above [columns] in place of it: rate = \"1 kHz\"",
        false => "",
    };
    let median = median.map_or("no two samples".to_string(), |dt| {
        format!("a median spacing of {}", full(dt))
    });
    let line = |unit: &str| {
        describe::line_with(
            table,
            part.column,
            Role::Time,
            &format!("unit = \"{unit}\""),
        )
    };
    // Those that would do; of none of them milliseconds and seconds, which are most usual.
    let mut units = offered::times(values);
    if units.is_empty() {
        units = vec!["ms", "s"];
    }
    let lines: Vec<String> = match rate::are_ticks(values) {
        true => vec![describe::line_with(
            table,
            part.column,
            Role::Time,
            rate::TICKS,
        )],
        false => units.into_iter().map(line).collect(),
    };
    Err(Error::new(
        Kind::Unit,
        format!("time has no unit and {median}, which is implausible in seconds for a motion log"),
        format!(
            "say which in axis.toml under [columns]: {}{numbers}",
            lines.join(" or ")
        ),
    )
    .in_column(describe::place(table, part.column)))
}

fn phrase(table: &Table, part: &Part, unit: &Unit) -> String {
    let mut text = format!(
        "{} = {}, unit {unit}",
        part.role,
        describe::column(table, part.column)
    );
    if let Some(scale) = &part.channel.scale {
        text.push_str(&format!(", scale {scale}"));
    }
    if part.channel.invert {
        text.push_str(", sign inverted");
    }
    text
}

/// What a reader should know about the unit of a channel.
fn judge(
    findings: &mut Vec<Finding>,
    part: &Part,
    (unit, driven): (&Unit, bool),
    source: &Source,
    kind: Motion,
) {
    if let Some(meaning) = unit.note() {
        findings.push(Finding::note(Found::UnitConvention {
            channel: part.role.name(),
            unit: unit.to_string(),
            meaning,
        }));
    }
    if part.role != Role::Force
        || driven
        || !is_force(source.dimension)
        || source.dimension == kind.force()
    {
        return;
    }
    let dimension = source.dimension.si_text();
    let wanted = kind.force().si_text();
    let typed = || unit.text().to_string();
    findings.push(match source.dimension {
        Dimension::FORCE | Dimension::TORQUE => Finding::warning(Found::ForceUnit {
            unit: dimension,
            motion: kind.to_string(),
            wanted,
        }),
        Dimension::VOLTAGE => Finding::warning(Found::ForceIsVoltage {
            wanted,
            unit: typed(),
        }),
        own => Finding::note(Found::Uncalibrated {
            dimension,
            wanted,
            per: (own != Dimension::ONE).then(typed),
        }),
    });
}
