//! The offset between the clocks of two files, from what both show of the same motion.

use super::lag::{self, Is, Lag, Unclear};
use super::{Course, Elsewhere, Joined, micro};
use crate::findings::{Finding, short};
use crate::log::unwrap;
use crate::mapping::{Channel, Mapping, Role, Source, clear, select, time_source};
use crate::{Dimension, Error, Kind, Table, Unit};
use stiction_number::Percent;
use stiction_policy::join;
use stiction_say::Found;

/// What tells the offset where both files show it, or one of them a motion and the other the force of it.
pub(super) const SHARED: [Role; 3] = [Role::Position, Role::Velocity, Role::Force];

/// What a file shows of the motion.
#[derive(Default)]
struct Shown {
    motion: Option<Signal>,
    force: Option<Signal>,
}

struct Signal {
    course: Course,
    is: Is,
    /// The column in words.
    column: String,
}

/// An offset that was found.
pub(super) struct Estimate {
    /// What is added to the time stamps of the other file, s: a whole number of microseconds, so that it can be written down.
    pub seconds: f64,
    lag: Lag,
    /// What was compared, in words.
    by: String,
}

impl Estimate {
    pub fn finding(&self, name: &str, role: Role) -> Finding {
        Finding::note(Found::Offset {
            channel: role.name(),
            file: name.to_string(),
            columns: self.by.clone(),
            seconds: micro(self.seconds),
            half_width: self.lag.half_width,
            explained: self.lag.explained,
        })
    }
}

impl Joined {
    /// The offset of the clock of another table.
    pub(super) fn estimate(
        &self,
        name: &str,
        other: &Table,
        from: &Elsewhere,
    ) -> Result<Estimate, Error> {
        let at = |e: Error| e.of_setting(from.role.key("offset"));
        let clock = time_source(&self.table, self.mapping.time.as_ref())?;
        let other_clock = time_source(other, from.time.as_ref()).map_err(at)?;
        let own = self.shown(&clock, from.role)?;
        let others = shown_elsewhere(other, &other_clock, &self.mapping, from).map_err(at)?;
        let begin = |table: &Table, clock: &Source| {
            let stamps = table.columns[clock.column].values.iter();
            let mut known = stamps.map(|t| clock.si(*t)).filter(|t| t.is_finite());
            known.next().unwrap_or(0.0)
        };
        let between = begin(&self.table, &clock) - begin(other, &other_clock);
        let pairs = [
            (&own.motion, &others.motion),
            (&own.motion, &others.force),
            (&own.force, &others.motion),
            (&own.force, &others.force),
        ];
        let mut why: Option<(Error, Unclear)> = None;
        for (own, other) in pairs {
            let (Some(own), Some(other)) = (own, other) else {
                continue;
            };
            let steps = (own.course.step, other.course.step);
            let step = if steps.1 >= join::MIN_THINNED_RATIO * steps.0 {
                steps.1
            } else {
                steps.0
            };
            let allowed = join::MAX_OFFSET_ERROR * step;
            let by = format!("{} of the log and {} of {name}", own.column, other.column);
            let found = lag::between((&own.course, own.is), (&other.course, other.is), allowed);
            match found {
                // What two columns that say more rule out is a chance likeness.
                Ok(lag)
                    if why
                        .as_ref()
                        .is_some_and(|(_, unclear)| unclear.excludes(&lag)) => {}
                Ok(lag) => {
                    let seconds = (1e6 * (between + lag.seconds)).round() / 1e6;
                    return Ok(Estimate { seconds, lag, by });
                }
                Err(unclear) => {
                    let more = |before: &Unclear| unclear.explained() > before.explained();
                    if why.as_ref().is_none_or(|(_, before)| more(before)) {
                        why = Some((refusal(&unclear, &by, between, allowed), unclear));
                    }
                }
            }
        }
        let nothing = || {
            let found = format!("no motion or force in {name} to compare with this log");
            Error::new(
                Kind::Missing,
                found,
                "a column of position, velocity or force in both files, or what is to be added to the time stamps of the other one, \
                 such as offset = \"12 ms\"",
            )
        };
        Err(at(why.map_or_else(nothing, |(error, _)| error)))
    }

    /// What the log shows, but for the column that is to come.
    fn shown(&self, clock: &Source, coming: Role) -> Result<Shown, Error> {
        let clear = clear(&self.table);
        let pick = |role: Role| {
            let given = self.mapping.channel(role).filter(|_| role != coming);
            given.or(clear.channel(role)).cloned()
        };
        let mut out = Shown::of(&self.table, clock, &pick)?;
        if let (Some(wrap), Some(Signal { course, is, .. })) = (self.mapping.wrap, &mut out.motion)
            && matches!(is, Is::Position | Is::Angle)
        {
            let channel = pick(Role::Position);
            let source = channel.and_then(|channel| source(&self.table, &channel, Role::Position));
            let period = unwrap::period(wrap, source.as_ref())?;
            straighten(&mut course.values, period);
        }
        Ok(out)
    }
}

/// What another file shows; the column that comes from it goes before what its names say.
fn shown_elsewhere(
    other: &Table,
    clock: &Source,
    mapping: &Mapping,
    from: &Elsewhere,
) -> Result<Shown, Error> {
    let clear = clear(other);
    let pick = |role: Role| {
        let given = mapping.channel(role).filter(|_| role == from.role);
        given.or(clear.channel(role)).cloned()
    };
    Shown::of(other, clock, &pick)
}

impl Shown {
    fn of(
        table: &Table,
        clock: &Source,
        pick: &dyn Fn(Role) -> Option<Channel>,
    ) -> Result<Self, Error> {
        let begin = table.columns[clock.column].values.iter();
        let mut begin = begin.map(|t| clock.si(*t)).filter(|t| t.is_finite());
        let begin = begin.next().unwrap_or(0.0);
        let signal = |role: Role| -> Result<Option<Signal>, Error> {
            let Some(channel) = pick(role) else {
                return Ok(None);
            };
            let Ok(index) = select(table, &channel.column, role) else {
                return Ok(None);
            };
            let source = source(table, &channel, role);
            let angle = source
                .as_ref()
                .is_some_and(|s| s.dimension == Dimension::ANGLE);
            let sign = if channel.invert { -1.0 } else { 1.0 };
            let si = |x: &f64| source.as_ref().map_or(sign * x, |source| source.si(*x));
            let values: Vec<f64> = table.columns[index].values.iter().map(si).collect();
            // What has hardly a number tells nothing.
            let Ok(course) = Course::of(table, clock, &values, (begin, 0.0)) else {
                return Ok(None);
            };
            let is = match role {
                Role::Position if angle => Is::Angle,
                Role::Position => Is::Position,
                Role::Velocity => Is::Velocity,
                _ => Is::Force,
            };
            let name = &table.columns[index].name;
            let column = match name.is_empty() {
                true => format!("{role}, column {},", table.number(index)),
                false => format!("{role} {name:?}"),
            };
            Ok(Some(Signal { course, is, column }))
        };
        let motion = match signal(Role::Position)? {
            Some(position) => Some(position),
            None => signal(Role::Velocity)?,
        };
        Ok(Self {
            motion,
            force: signal(Role::Force)?,
        })
    }
}

/// The column of a channel in SI, where its unit is known and is one of its role.
fn source(table: &Table, channel: &Channel, role: Role) -> Option<Source> {
    let column = select(table, &channel.column, role).ok()?;
    let written = table.columns[column].unit.as_deref();
    let unit = channel
        .unit
        .clone()
        .or_else(|| Unit::parse(written?).ok())?;
    Source::new(table, column, &unit, channel, role).ok()
}

/// Lets a position that starts again after a period run on.
fn straighten(values: &mut [f64], period: f64) {
    let (mut turns, mut before) = (0.0, None::<f64>);
    for value in values {
        if let Some(before) = before {
            turns -= ((*value - before) / period).round();
        }
        before = Some(*value);
        *value += turns * period;
    }
}

fn refusal(unclear: &Unclear, by: &str, between: f64, allowed: f64) -> Error {
    let line = |lag: &Lag| format!("offset = \"{} s\"", micro(between + lag.seconds));
    let cannot = format!("the offset cannot be told from {by}");
    let (found, allowed) = match unclear {
        Unclear::Little => (
            format!("{cannot}: fewer than 100 samples, or nothing that varies"),
            "a longer record, or the offset itself, such as offset = \"12 ms\"".into(),
        ),
        Unclear::Weak(explained) => (
            format!("{cannot}: whatever it is, at most {} of the variance is explained", Percent::error(100.0 * explained).decimals(1)),
            "two columns of one axis with the signs of [columns] (invert = true turns one round), of which one explains at least half of \
             the other; or the offset itself, such as offset = \"12 ms\""
                .into(),
        ),
        Unclear::Several(lags) => {
            let each = lags.iter().map(|lag| {
                let part = Percent::error(100.0 * lag.explained).decimals(1);
                format!("{} s, to {} s ({part})", micro(between + lag.seconds), short(lag.half_width))
            });
            let each: Vec<String> = each.collect();
            let lines: Vec<String> = lags.iter().map(line).collect();
            (
                format!("{cannot}: several explain about as much, {}", each.join("; ")),
                format!(
                    "the one that is right: {}; or a record of a motion that does not repeat itself",
                    lines.join(" or ")
                ),
            )
        }
        Unclear::Blunt(lag) => (
            format!(
                "{cannot} closely enough: {} s, to {} s (95 %)",
                micro(between + lag.seconds),
                short(lag.half_width)
            ),
            format!(
                "to {} s, four samples, within which a fit finds the delay of the force: a longer record with more reversals; or the \
                 offset itself: {}",
                short(allowed),
                line(lag)
            ),
        ),
    };
    let kind = match unclear {
        Unclear::Several(_) => Kind::Ambiguous,
        _ => Kind::Time,
    };
    Error::new(kind, found, allowed)
}
