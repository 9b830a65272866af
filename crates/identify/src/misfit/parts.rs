//! Ways to divide a motion into parts.

use crate::conditioning::record::{Record, Segment};
use crate::conditioning::shift::Shift;

/// Parts of a motion in one way.
const PARTS: usize = 16;
/// Places on the stroke at which a ripple is looked for.
const PLACES: usize = 64;
/// Decades of speed and of travel that are told apart, for each direction.
const DECADES: f64 = 3.0;
/// Shortest time, s, over which something is said to change with it: friction of no machine changes within less, nor do clocks come
/// apart by what a log shows, and what moves on meanwhile looks alike. Of the demo cut into pieces, those of 2 s and more name
/// neither, a third of those of half a second one of them.
pub(super) const SHORTEST_COURSE: f64 = 2.0;
/// Counts by which an axis must turn back before it counts as reversed.
const REVERSED_COUNTS: f64 = 4.0;

/// By what a motion is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Divided {
    /// Stretches of time; the level of friction in each.
    LevelOverTime,
    /// Places on the stroke; the level of friction at each.
    LevelOverPosition,
    /// Normal loads, where the log has them; the level of friction under each.
    LevelOverLoad,
    /// Temperatures, where the log has them; the level of friction at each.
    LevelOverTemperature,
    /// Places on the stroke, each with a force of its own.
    Position,
    /// Speeds, direction by direction.
    Speed,
    /// Travel since the last reversal, direction by direction.
    Travel,
    /// Accelerations.
    Acceleration,
    /// Travel since the last reversal and speed.
    TravelAndSpeed,
    /// Travel since the last reversal and place.
    TravelAndPosition,
    /// The way after a reversal in which a bristle turns round, and the rest of the motion. A law that is wrong there after
    /// reversals of different depth leaves what does not come back, but more than elsewhere.
    AfterReversals,
}

impl Divided {
    /// All of them, simple ones first.
    pub const ALL: [Divided; 11] = [
        Divided::LevelOverTime,
        Divided::LevelOverPosition,
        Divided::LevelOverLoad,
        Divided::LevelOverTemperature,
        Divided::Position,
        Divided::Speed,
        Divided::Travel,
        Divided::Acceleration,
        Divided::TravelAndSpeed,
        Divided::TravelAndPosition,
        Divided::AfterReversals,
    ];

    /// Whether a level of friction is sought in each part instead of a force.
    pub fn is_a_level(self) -> bool {
        matches!(
            self,
            Divided::LevelOverTime
                | Divided::LevelOverPosition
                | Divided::LevelOverLoad
                | Divided::LevelOverTemperature
        )
    }

    /// Its name in results.
    pub fn name(self) -> &'static str {
        match self {
            Divided::LevelOverTime => "level over time",
            Divided::LevelOverPosition => "level over position",
            Divided::LevelOverLoad => "level over load",
            Divided::LevelOverTemperature => "level over temperature",
            Divided::Position => "position",
            Divided::Speed => "velocity",
            Divided::Travel => "travel since the last reversal",
            Divided::Acceleration => "acceleration",
            Divided::TravelAndSpeed => "travel since the last reversal and velocity",
            Divided::TravelAndPosition => "travel since the last reversal and position",
            Divided::AfterReversals => "the way after a reversal",
        }
    }

    /// Whether the course over the parts of a division shows this one: it is the same, or one half of this pair.
    pub(super) fn is_shown_by(self, course: Divided) -> bool {
        match self {
            Divided::AfterReversals => course == Divided::Travel,
            Divided::TravelAndSpeed if course != self => {
                matches!(course, Divided::Travel | Divided::Speed)
            }
            Divided::TravelAndPosition if course != self => {
                matches!(course, Divided::Travel | Divided::Position)
            }
            own => own == course,
        }
    }
}

/// What a motion is divided by, at the kept samples.
pub(super) struct Measures {
    /// s; each log begins where the one before ended.
    pub time: Vec<f64>,
    /// m or rad.
    pub position: Vec<f64>,
    /// m/s or rad/s.
    pub speed: Vec<f64>,
    /// Signed distance from the last reversal, m or rad.
    travel: Vec<f64>,
    acceleration: Vec<f64>,
    /// In the unit of the log; empty where a log has none.
    load: Vec<f64>,
    /// K; empty where a log has none.
    temperature: Vec<f64>,
}

impl Measures {
    pub fn of(record: &Record) -> Self {
        Self {
            time: times(record),
            position: record.pick(|s| &s.position),
            speed: record.pick(|s| &s.velocity),
            travel: travel(record),
            acceleration: record.pick(|s| &s.acceleration),
            load: in_every_log(record, |s| &s.channels.load),
            temperature: in_every_log(record, |s| &s.channels.temperature),
        }
    }

    /// What a division divides by; of a pair the first.
    pub fn along(&self, by: Divided) -> &[f64] {
        match by {
            Divided::LevelOverTime => &self.time,
            Divided::LevelOverPosition | Divided::Position => &self.position,
            Divided::LevelOverLoad => &self.load,
            Divided::LevelOverTemperature => &self.temperature,
            Divided::Speed => &self.speed,
            Divided::Acceleration => &self.acceleration,
            Divided::Travel
            | Divided::TravelAndSpeed
            | Divided::TravelAndPosition
            | Divided::AfterReversals => &self.travel,
        }
    }

    /// Whether the log is long enough to tell what changes with time.
    pub fn is_long(&self) -> bool {
        let ends = self.time.first().zip(self.time.last());
        ends.is_some_and(|(first, last)| last - first >= SHORTEST_COURSE)
    }

    /// How often the axis turns back.
    pub fn reversals(&self) -> usize {
        turns(&self.travel)
    }

    /// Whether each kept sample lies within that distance of the last reversal, m or rad.
    pub fn after_reversals(&self, within: f64) -> Vec<bool> {
        self.travel.iter().map(|x| x.abs() < within).collect()
    }

    /// The part that each kept sample belongs to; none where the log has not what the motion would be divided by.
    pub fn parts(&self, by: Divided) -> Vec<usize> {
        let both = |a, b| -> Vec<usize> {
            let pairs = self.parts(a).into_iter().zip(self.parts(b));
            pairs.map(|(a, b)| a * PARTS + b).collect()
        };
        let along = self.along(by);
        match by {
            Divided::LevelOverTime => {
                let n = along.len();
                (0..n).map(|t| t * PARTS / n).collect()
            }
            Divided::LevelOverPosition
            | Divided::LevelOverLoad
            | Divided::LevelOverTemperature
            | Divided::Acceleration => even(along, PARTS),
            Divided::Position => even(along, PLACES),
            Divided::Speed | Divided::Travel | Divided::AfterReversals => logarithmic(along),
            Divided::TravelAndSpeed => both(Divided::Travel, Divided::Speed),
            Divided::TravelAndPosition => both(Divided::Travel, Divided::LevelOverPosition),
        }
    }
}

/// A channel at the kept samples; empty where a log has none.
fn in_every_log(record: &Record, channel: impl Fn(&Segment) -> &[f64]) -> Vec<f64> {
    let missing = |s: &Segment| channel(s).len() != s.velocity.len();
    match record.segments.iter().any(missing) {
        true => Vec::new(),
        false => record.pick(channel),
    }
}

/// Times of the kept samples, s; each log begins where the one before ended.
fn times(record: &Record) -> Vec<f64> {
    let mut out = Vec::with_capacity(record.kept());
    let (mut shift, mut log, mut last) = (0.0, None, 0.0);
    for segment in &record.segments {
        let Some(&first) = segment.time.first() else {
            continue;
        };
        if log != Some(segment.log) {
            shift = last - first;
            log = Some(segment.log);
        }
        let kept = segment.time.iter().zip(&segment.keep);
        out.extend(kept.filter(|(_, keep)| **keep).map(|(t, _)| t + shift));
        last = segment.time.last().map_or(last, |t| t + shift);
    }
    out
}

/// Signed distance from the last reversal at the kept samples, m or rad.
fn travel(record: &Record) -> Vec<f64> {
    let least = REVERSED_COUNTS * record.resolution.unwrap_or(0.0);
    let mut out = Vec::with_capacity(record.kept());
    for segment in &record.segments {
        let travel = along(segment, least);
        record.thin(segment, &travel, Shift::NONE, &mut out);
    }
    out
}

/// How often the axis turns back.
pub(crate) fn reversals(record: &Record) -> usize {
    turns(&travel(record))
}

/// How often a signed distance from the last reversal changes its sign.
fn turns(travel: &[f64]) -> usize {
    let mut moves = travel.iter().filter(|x| **x != 0.0);
    let mut way = moves.next().map_or(0.0, |x| x.signum());
    let turned = moves.filter(|x| {
        let turned = x.signum() != way;
        way = x.signum();
        turned
    });
    turned.count()
}

/// The same at the full rate; a reversal is a way back of more than `least`.
fn along(segment: &Segment, least: f64) -> Vec<f64> {
    let Some(&first) = segment.position.first() else {
        return Vec::new();
    };
    let (mut turned, mut farthest, mut direction) = (first, first, 0.0_f64);
    let step = |&x: &f64| {
        let on = (x - farthest) * direction;
        if direction == 0.0 {
            if (x - first).abs() > least {
                (direction, farthest) = ((x - first).signum(), x);
            }
        } else if on > 0.0 {
            farthest = x;
        } else if -on > least {
            (turned, farthest, direction) = (farthest, x, -direction);
        }
        x - turned
    };
    segment.position.iter().map(step).collect()
}

/// Parts of equally many samples.
fn even(values: &[f64], parts: usize) -> Vec<usize> {
    let n = values.len();
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let bounds: Vec<f64> = (1..parts)
        .filter_map(|i| sorted.get(i * n / parts).copied())
        .collect();
    let part = |x: &f64| bounds.partition_point(|bound| bound <= x);
    values.iter().map(part).collect()
}

/// Parts of equal width on a logarithmic scale below the largest magnitude, for each sign.
fn logarithmic(values: &[f64]) -> Vec<usize> {
    let half = PARTS / 2;
    let most = values.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let part = |x: &f64| {
        let decades = libm::log10(most / x.abs().max(f64::MIN_POSITIVE));
        let step = (decades / DECADES * half as f64) as usize;
        let side = if *x < 0.0 { half } else { 0 };
        side + step.min(half - 1)
    };
    values.iter().map(part).collect()
}
