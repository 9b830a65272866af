//! Refuses what no axis does: a travel, speed or force beyond all measure, for which a unit is wrong; and names what no machine is
//! known to do, for which one probably is.

use super::Log;
use crate::findings::{Finding, extremes, median, short};
use crate::mapping::{RATES, Role, Source};
use crate::{Error, Kind, Motion, Table};
use std::ops::RangeInclusive;
use stiction_policy::signal;
use stiction_say::{Found, Size, Value};

/// Travels of a position (m, rad) and largest velocities, accelerations and forces that a log may have, in SI units: a thousandth
/// of the diameter of an atom to far more than any machine.
const SIZES: RangeInclusive<f64> = 1e-12..=1e12;
/// Seconds over which a motion is looked at, so that noise and steps of an encoder are neither speed nor acceleration.
const LOOK: f64 = 0.01;
/// Rounding errors of the largest number up to which a signal counts as constant.
const CONSTANT_WITHIN: f64 = 8.0;

/// Names the rate and the columns that are not those of any machine. A column that never changes is told elsewhere.
pub(super) fn unlikely(log: &Log, table: &Table, sources: &[(Role, Source)]) -> Vec<Finding> {
    let (length, speed) = (
        log.motion.position().si_text(),
        log.motion.velocity().si_text(),
    );
    let (travels, fastest) = match log.motion {
        Motion::Linear => (signal::USUAL_TRAVELS, signal::MAX_SPEED),
        Motion::Rotary => (signal::USUAL_ANGLES, signal::MAX_ANGULAR_SPEED),
    };
    let duration = log.time.last().zip(log.time.first()).map(|(b, a)| b - a);
    let mut found = Vec::new();
    let mut tell = |role: Role, size: Size, range: &RangeInclusive<f64>| {
        let Some((_, source)) = sources.iter().find(|(own, _)| *own == role) else {
            return;
        };
        let value = size.value().number;
        // What never changes has no size.
        if value == 0.0 || range.contains(&value) {
            return;
        }
        found.push(Finding::warning(Found::UnlikelySize {
            size,
            usual: [*range.start(), *range.end()],
            column: source.place(table),
            unit: source.unit.to_string(),
            line: source.line(table, role, value < *range.start()),
        }));
    };
    let step = 1.0 / log.rate_hz;
    let steps = 1.0 / signal::USUAL_RATES.end()..=1.0 / signal::USUAL_RATES.start();
    tell(Role::Time, Size::TimeStep(Value::new(step, "s")), &steps);
    for (role, values) in [
        (Role::Position, &log.position),
        (Role::Reference, &log.reference),
    ] {
        let Some((low, high)) = values.as_deref().and_then(extremes) else {
            continue;
        };
        if high - low <= CONSTANT_WITHIN * f64::EPSILON * low.abs().max(high.abs()) {
            continue;
        }
        let travel = Value::new(high - low, &length);
        tell(role, Size::Travel(role.name(), travel), &travels);
        let path = |x: &[f64]| x.windows(2).map(|w| (w[1] - w[0]).abs()).sum::<f64>();
        let (Some(x), Some(duration)) = (values, duration.filter(|d| *d > 0.0)) else {
            continue;
        };
        let mean = path(x) / duration;
        if travels.contains(&(high - low)) && mean > fastest {
            let size = Size::MeanSpeed(role.name(), Value::new(mean, &speed));
            tell(role, size, &(0.0..=fastest));
        }
    }
    let force = log.force_unit.as_str();
    for (role, values, range, unit) in [
        (Role::Velocity, &log.velocity, 0.0..=fastest, speed.as_str()),
        (Role::Force, &log.force, signal::USUAL_FORCES, force),
    ] {
        if let Some((low, high)) = values.as_deref().and_then(extremes) {
            let largest = low.abs().max(high.abs());
            let size = Size::Largest(role.name(), Value::new(largest, unit));
            tell(role, size, &range);
        }
    }
    if found.is_empty() {
        found.extend(no_servo(log, table, sources));
    }
    found
}

/// Names a motion that is both faster and more accelerated than that of any servo axis: most often millimetres that are read as
/// metres, or milliseconds as microseconds.
fn no_servo(log: &Log, table: &Table, sources: &[(Role, Source)]) -> Option<Finding> {
    let steps = ((LOOK * log.rate_hz).round() as usize).max(1);
    let over = steps as f64 / log.rate_hz;
    let positions = log.position.as_deref().map(|x| (Role::Position, x));
    let velocities = log.velocity.as_deref().map(|v| (Role::Velocity, v));
    let (role, values) = positions.or(velocities)?;
    let (_, source) = sources.iter().find(|(own, _)| *own == role)?;
    let rates = |x: &[f64]| -> Vec<f64> {
        let rate = |k: usize| (x[k + steps] - x[k]) / over;
        (0..x.len().saturating_sub(steps)).map(rate).collect()
    };
    let velocities = match role {
        Role::Position => rates(values),
        _ => values.to_vec(),
    };
    let (speed, acceleration) = (all_but_few(&velocities)?, all_but_few(&rates(&velocities))?);
    let [fastest, hardest] = match log.motion {
        Motion::Linear => signal::MAX_LINEAR_SERVO,
        Motion::Rotary => signal::MAX_ROTARY_SERVO,
    };
    if speed <= fastest || acceleration <= hardest {
        return None;
    }
    let units = [log.motion.velocity(), log.motion.acceleration()];
    let [of_speed, of_acceleration] = units.map(|dimension| dimension.si_text());
    let time = sources.iter().find(|(own, _)| *own == Role::Time);
    Some(Finding::warning(Found::NoServo {
        channel: role.name(),
        speed: Value::new(speed, &of_speed),
        acceleration: Value::new(acceleration, &of_acceleration),
        most: [
            Value::new(fastest, &of_speed),
            Value::new(hardest, &of_acceleration),
        ],
        column: source.place(table),
        unit: source.unit.to_string(),
        time: time.map(|(_, time)| (time.place(table), time.unit.to_string())),
        line: source.line(table, role, false),
    }))
}

/// The size that all but a few are below.
fn all_but_few(values: &[f64]) -> Option<f64> {
    let mut sizes: Vec<f64> = values.iter().map(|x| x.abs()).collect();
    sizes.retain(|x| x.is_finite());
    if sizes.is_empty() {
        return None;
    }
    let place = ((1.0 - signal::MAX_FASTER_SHARE) * (sizes.len() - 1) as f64) as usize;
    let (_, size, _) = sizes.select_nth_unstable_by(place, f64::total_cmp);
    Some(*size)
}

/// Refuses a log whose rate or one of whose columns cannot be that of an axis. A column that never changes is told elsewhere.
pub(super) fn check(log: &Log, table: &Table, sources: &[(Role, Source)]) -> Result<(), Error> {
    if let Some((_, source)) = sources.iter().find(|(role, _)| *role == Role::Time)
        && !RATES.contains(&log.rate_hz)
    {
        let step = 1.0 / log.rate_hz;
        let size = Size::TimeStep(Value::new(step, "s"));
        let steps = 1.0 / RATES.end()..=1.0 / RATES.start();
        return Err(refusal(table, Role::Time, source, &size, &steps));
    }
    let force = log.force_unit.as_str();
    let units = [
        log.motion.position(),
        log.motion.velocity(),
        log.motion.acceleration(),
    ];
    let [length, speed, acceleration] = units.map(|dimension| dimension.si_text());
    for (role, values, unit) in [
        (Role::Position, &log.position, length.as_str()),
        (Role::Reference, &log.reference, &length),
        (Role::Velocity, &log.velocity, &speed),
        (Role::Acceleration, &log.acceleration, &acceleration),
        (Role::Force, &log.force, force),
    ] {
        let (Some((low, high)), Some((_, source))) = (
            values.as_deref().and_then(extremes),
            sources.iter().find(|(r, _)| *r == role),
        ) else {
            continue;
        };
        let largest = low.abs().max(high.abs());
        let travels = [Role::Position, Role::Reference].contains(&role);
        let size = if travels { high - low } else { largest };
        let constant = size <= CONSTANT_WITHIN * f64::EPSILON * if travels { largest } else { 0.0 };
        if constant || SIZES.contains(&size) {
            continue;
        }
        if let Some(few) = values.as_deref().and_then(|x| Few::of(x, travels)) {
            return Err(few.refusal(log, table, role, source, unit));
        }
        let value = Value::new(size, unit);
        let size = match travels {
            true => Size::Travel(role.name(), value),
            false => Size::Largest(role.name(), value),
        };
        return Err(refusal(table, role, source, &size, &SIZES));
    }
    Ok(())
}

/// Few samples that are far beyond all others, which are of a credible size: cells that are damaged, not a unit that is wrong.
struct Few {
    first: usize,
    value: f64,
    count: usize,
    /// The most that the others have.
    rest: f64,
}

impl Few {
    /// `None` where the others are no better.
    fn of(values: &[f64], travels: bool) -> Option<Self> {
        let middle = match travels {
            true => median(&mut values.to_vec())?,
            false => 0.0,
        };
        let size = |x: &f64| (x - middle).abs();
        let beyond = |x: &f64| size(x) > *SIZES.end();
        let count = values.iter().filter(|x| beyond(x)).count();
        let first = values.iter().position(beyond)?;
        let others = values.iter().filter(|x| !beyond(x));
        let rest = others.map(size).fold(0.0, f64::max);
        let few = count as f64 <= (signal::MAX_DAMAGED_SHARE * values.len() as f64).max(1.0);
        (few && SIZES.contains(&rest)).then_some(Few {
            first,
            value: values[first],
            count,
            rest,
        })
    }

    fn refusal(&self, log: &Log, table: &Table, role: Role, source: &Source, unit: &str) -> Error {
        let time = log.start + log.time.get(self.first).copied().unwrap_or_default();
        let more = match self.count {
            1 => String::new(),
            count => format!(", the first of {count} such samples"),
        };
        let about = match role {
            Role::Position | Role::Reference => " of their middle",
            _ => "",
        };
        let found = format!(
            "{role} is {} {unit} at {} s{more}; all others lie within {} {unit}{about}",
            short(self.value),
            short(time),
            short(self.rest)
        );
        let allowed = format!(
            "at most {:e} {unit}: that is a damaged cell; empty it, or keep a part without it with crop under [log] of axis.toml",
            SIZES.end()
        );
        Error::new(Kind::Value, found, allowed).in_column(source.place(table))
    }
}

fn refusal(
    table: &Table,
    role: Role,
    source: &Source,
    size: &Size,
    range: &RangeInclusive<f64>,
) -> Error {
    let Value { number, unit } = size.value();
    let allowed = format!(
        "allowed: from {:e} to {:e} {unit}; its unit ({}) or its scale is wrong: give the right one in axis.toml under [columns], as in: {}",
        range.start(),
        range.end(),
        source.unit,
        source.line(table, role, *number < *range.start()),
    );
    Error::new(Kind::Value, size.to_string(), allowed)
        .in_column(source.place(table))
        .of_setting(role.key("unit"))
}
