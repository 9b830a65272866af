//! Filling in what a mapping leaves open: columns first, then units, then the kind of motion.

use super::channel::{Channel, Motion, Role};
use super::convert::{Source, is_force};
use super::select::select;
use super::{Detected, Mapping, choose, describe, endings, motion, names, rate, understood};
use crate::findings::{Finding, Severity};
use crate::{Column, Dimension, Error, Kind, Table, Unit};
use stiction_codes::Code;
use stiction_number::full;

/// Median spacings, s, with which a time column without a unit is taken as seconds: 5 Hz to 1 MHz.
pub(super) const PLAUSIBLE_SPACING: std::ops::RangeInclusive<f64> = 1e-6..=0.2;

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
    choose::columns(&mut out, table)?;
    let mut parts = Vec::new();
    for role in Role::ALL {
        let Some(channel) = out.mapping.channel(role) else {
            continue;
        };
        let channel = channel.clone();
        let column = select(table, &channel.column, role)?;
        let unit = written_unit(table, column, &channel, role, &mut out.findings)?;
        parts.push(Part {
            role,
            channel,
            column,
            unit,
            assumed: false,
        });
    }
    let written = |column: &Column| column.unit.is_some() && !column.stamps;
    let labelled = table.columns.iter().any(written)
        || parts
            .iter()
            .any(|p| p.channel.unit.is_some() || p.channel.scale.is_some());
    refuse_half_labelled(table, &parts, labelled)?;
    let kind = settle_motion(&mut out, table, &parts)?;
    assume_units(&mut out.findings, table, &mut parts, kind)?;
    for part in &parts {
        let unit = part
            .unit
            .clone()
            .unwrap_or_else(|| Unit::si(Dimension::ONE));
        let source = Source::new(table, part.column, &unit, &part.channel, part.role)?;
        source.check(table, part.role, kind)?;
        out.phrases.push(phrase(table, part, &unit));
        // A motor makes a force of its current, voltage or duty.
        let driven = part.role == Role::Force && out.mapping.drive.is_some();
        judge(&mut out.findings, part, (&unit, driven), &source, kind);
        *out.mapping.slot(part.role) = Some(Channel {
            unit: Some(unit),
            ..part.channel.clone()
        });
    }
    out.columns = understood::all(table, given, &parts);
    Ok(out)
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
            let message = format!(
                "{role}: the recording gives {other}, the axis file {unit}; the axis file takes precedence"
            );
            findings.push(Finding::new(Code::UnitOverride, Severity::Note, message));
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

/// Refuses a motion or force column without a unit in a file where others have one.
fn refuse_half_labelled(table: &Table, parts: &[Part], labelled: bool) -> Result<(), Error> {
    let core = [Role::Position, Role::Velocity, Role::Force];
    let mut bare = parts
        .iter()
        .filter(|p| p.unit.is_none() && core.contains(&p.role))
        .peekable();
    let Some(part) = bare.peek().copied().filter(|_| labelled) else {
        return Ok(());
    };
    let motion = likely(table, parts);
    let line = |part: &Part| {
        let current = names::says_current(&table.columns[part.column].name);
        let unit = match (part.role, motion) {
            (Role::Position, Motion::Linear) => "mm",
            (Role::Position, Motion::Rotary) => "deg",
            (Role::Velocity, Motion::Linear) => "mm/s",
            (Role::Velocity, Motion::Rotary) => "deg/s",
            _ if current => "A",
            (_, Motion::Linear) => "N",
            (_, Motion::Rotary) => "N m",
        };
        describe::line_with(table, part.column, part.role, &format!("unit = \"{unit}\""))
    };
    let lines: Vec<String> = bare.map(line).collect();
    Err(Error::new(
        Kind::Unit,
        format!("{} has no unit while other columns have one", part.role),
        format!(
            "give it in axis.toml under [columns], as in: {}",
            lines.join(" and ")
        ),
    )
    .in_column(describe::place(table, part.column)))
}

/// The kind of motion that the units tell, else the names; linear where nothing tells it.
fn likely(table: &Table, parts: &[Part]) -> Motion {
    let known = parts.iter().filter_map(|part| {
        let unit = part.unit.as_ref()?;
        Some((part.role, unit.dimension()))
    });
    let names = parts.iter().map(|p| table.columns[p.column].name.as_str());
    let told = motion::from_units(&known.collect::<Vec<_>>()).map(|(motion, _)| motion);
    told.or_else(|| motion::from_names(names).ok())
        .unwrap_or(Motion::Linear)
}

fn settle_motion(out: &mut Detected, table: &Table, parts: &[Part]) -> Result<Motion, Error> {
    if let Some(kind) = out.mapping.motion {
        return Ok(kind);
    }
    let mut known = Vec::new();
    for part in parts {
        let Some(unit) = &part.unit else { continue };
        let source = Source::new(table, part.column, unit, &part.channel, part.role)?;
        refuse_bare_counts(table, part, source.dimension)?;
        known.push((part.role, source.dimension));
    }
    let kind = if let Some((kind, role)) = motion::from_units(&known) {
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

fn refuse_bare_counts(table: &Table, part: &Part, dimension: Dimension) -> Result<(), Error> {
    if part.role != Role::Position || dimension != Dimension::COUNTS {
        return Ok(());
    }
    let linear = describe::line_with(table, part.column, part.role, "scale = \"1 um/count\"");
    let rotary = describe::line_with(table, part.column, part.role, "scale = \"0.5 mrad/count\"");
    Err(Error::new(
        Kind::Unit,
        "position is in encoder counts, and the size of a count is not given",
        format!("give it in axis.toml under [columns], as in: {linear} or {rotary}"),
    )
    .in_column(describe::place(table, part.column)))
}

/// Fills in the units that nothing tells, with one finding that lists them.
fn assume_units(
    findings: &mut Vec<Finding>,
    table: &Table,
    parts: &mut [Part],
    kind: Motion,
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
            Role::Time => seconds(table, part)?,
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
        let message = format!(
            "no unit is given for some columns; assumed: {}",
            told.join(", ")
        );
        findings.push(Finding::new(Code::UnitAssumed, Severity::Note, message));
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
    let plausible =
        |unit: &Unit| median.is_some_and(|dt| PLAUSIBLE_SPACING.contains(&(unit.factor() * dt)));
    if median.is_some_and(|dt| PLAUSIBLE_SPACING.contains(&dt)) {
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
    let fits = |unit: &&str| Unit::parse(unit).is_ok_and(|unit| plausible(&unit));
    let mut units: Vec<&str> = ["ms", "us", "ns", "min"].into_iter().filter(fits).collect();
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
    if let Some(note) = unit.note() {
        let message = format!("{}: {unit} is {note}", part.role);
        findings.push(Finding::new(Code::UnitConvention, Severity::Note, message));
    }
    if part.role != Role::Force
        || driven
        || !is_force(source.dimension)
        || source.dimension == kind.force()
    {
        return;
    }
    let is = source.dimension.si_text();
    let wanted = kind.force().si_text();
    let mixed = [Dimension::FORCE, Dimension::TORQUE].contains(&source.dimension);
    findings.push(if mixed {
        let message = format!(
            "the force is in {is}, but on a {kind} axis it has to be in {wanted}; a scale \
             for the lead or radius is missing, or the kind is wrong"
        );
        Finding::new(Code::ForceUnit, Severity::Warning, message)
    } else {
        let message = format!(
            "the force is in {is}; parameters come out in {is} too, unless a scale in {wanted}/{} is \
             given{}",
            unit.text(),
            match [Dimension::VOLTAGE, Dimension::ONE].contains(&source.dimension) {
                true => ", or the motor under [drive]: docs/axis.md#drive",
                false => "",
            }
        );
        Finding::new(Code::ForceNotCalibrated, Severity::Note, message)
    });
}
