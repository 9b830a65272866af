//! Columns over time, each with its pyramid.

use super::{Column, Drawable};
use crate::pyramid::Pyramid;
use crate::units::Shown;
use stiction_log as recording;
use stiction_workflows::check::speeds;

/// Columns that are drawn of a file before it is clear what they are.
const MOST_UNDECIDED: usize = 8;

/// Channels over a common time.
#[derive(Debug, Default)]
pub struct Series {
    /// s, never falling.
    pub time: Vec<f64>,
    /// What is drawn over it.
    pub channels: Vec<Channel>,
}

/// A channel.
#[derive(Debug)]
pub struct Channel {
    /// `position`, `force`.
    pub name: String,
    /// SI.
    pub unit: String,
    /// Whether it follows from another one.
    pub derived: bool,
    /// In that unit.
    pub values: Vec<f64>,
    pub pyramid: Pyramid,
}

/// Whether a column of a table that stiction writes is its time, by its name with or without a unit.
pub fn is_time(name: &str) -> bool {
    ["t", "time"].contains(&name.split(' ').next().unwrap_or_default())
}

impl Channel {
    fn new(name: &str, unit: &str, values: Vec<f64>) -> Self {
        Self {
            name: name.into(),
            unit: unit.into(),
            derived: false,
            pyramid: Pyramid::new(&values),
            values,
        }
    }
}

/// Friction, measured and of the model, in the table of a fit: what is left of the force without its other parts.
fn friction(channels: &[Channel]) -> Vec<Channel> {
    let of = |name: &str| channels.iter().find(|own| own.name == name);
    let Some(other) = of("other") else {
        return Vec::new();
    };
    let pairs = [("measured", "friction"), ("model", "model friction")];
    let made = pairs.into_iter().filter_map(|(whole, name)| {
        let whole = of(whole)?;
        let parts = whole.values.iter().zip(&other.values);
        let values = parts.map(|(force, other)| force - other).collect();
        Some(Channel {
            derived: true,
            ..Channel::new(name, &whole.unit, values)
        })
    });
    made.collect()
}

impl Series {
    /// The channels of a log, SI; a velocity that was not recorded follows from the position.
    pub fn of_log(mut log: recording::Log) -> Self {
        let speeds = match log.velocity {
            Some(_) => None,
            None => speeds(&log),
        };
        let length = log.motion.position().si_text();
        let speed = log.motion.velocity().si_text();
        let force = log.force_unit.clone();
        let load = log.load_unit.clone();
        let all = [
            ("position", &length, log.position.take()),
            ("velocity", &speed, log.velocity.take()),
            ("force", &force, log.force.take()),
            ("reference", &length, log.reference.take()),
            ("external", &force, log.external.take()),
            ("load", &load, log.load.take()),
            ("temperature", &"K".to_string(), log.temperature.take()),
        ];
        let mut channels: Vec<Channel> = all
            .into_iter()
            .filter_map(|(name, unit, values)| Some(Channel::new(name, unit, values?)))
            .collect();
        if let Some(values) = speeds {
            let at = channels.iter().position(|own| own.name == "force");
            let channel = Channel {
                derived: true,
                ..Channel::new("velocity", &speed, values)
            };
            channels.insert(at.unwrap_or(channels.len()), channel);
        }
        Self {
            time: log.time,
            channels,
        }
    }

    /// Columns of a file that is no log yet, by their numbers, those first of which it is clear what they are; and what they
    /// are over: the time where that is clear, else the rows.
    pub fn of_undecided(mut table: recording::Table, columns: &[Column]) -> (Self, String) {
        let rows = table.rows();
        let mut take = |at: usize| std::mem::take(&mut table.columns[at].values);
        let is_time = |own: &Column| own.role.as_deref() == Some("time");
        let clock = columns.iter().position(is_time);
        let time = clock.map(|at| (&columns[at], take(at)));
        let time = time.filter(|(_, time)| time.len() == rows && time.is_sorted());
        let (time, over) = match time {
            Some((own, time)) => (time, format!("time [{}]", own.unit)),
            None => ((0..rows).map(|k| k as f64).collect(), "row".into()),
        };
        let moves = |own: &Column| own.range.is_some_and(|(low, high)| low < high);
        let all = || columns.iter().enumerate();
        let drawn = |is_clear: bool| {
            all().filter(move |(at, own)| {
                own.role.is_some() == is_clear && Some(*at) != clock && moves(own)
            })
        };
        let drawn = drawn(true).chain(drawn(false)).take(MOST_UNDECIDED);
        let channels = drawn.map(|(at, own)| {
            let mut values = take(at);
            values.resize(rows, f64::NAN);
            // As the file has it: its unit may be what has to be said.
            Channel::new(&own.number.to_string(), "", values)
        });
        let channels = channels.collect();
        (Self { time, channels }, over)
    }

    /// The numeric columns of a table over its time, of one run where there are several: a run ends where the time falls.
    pub fn of_table(table: recording::Table, run: usize) -> Self {
        let mut columns = table.columns;
        let is_clock = |column: &stiction_log::Column| is_time(&column.name);
        let Some(at) = columns.iter().position(is_clock) else {
            return Self::default();
        };
        let mut time = columns.remove(at).values;
        let falls = time.windows(2).enumerate();
        let falls = falls.filter(|(_, pair)| pair[1] < pair[0]);
        let mut ends: Vec<usize> = falls.map(|(at, _)| at + 1).collect();
        ends.push(time.len());
        let run = run.min(ends.len() - 1);
        let start = run.checked_sub(1).map_or(0, |before| ends[before]);
        let cut = |values: &mut Vec<f64>| {
            values.truncate(ends[run]);
            values.drain(..start.min(values.len()));
        };
        cut(&mut time);
        let channels = columns.into_iter().map(|mut column| {
            cut(&mut column.values);
            let unit = column.unit.as_deref().unwrap_or("");
            Channel::new(&column.name, unit, column.values)
        });
        let mut channels: Vec<Channel> = channels.collect();
        channels.extend(friction(&channels));
        Self { time, channels }
    }

    /// What can be drawn.
    pub fn about(&self) -> Vec<Drawable> {
        let one = |channel: &Channel| Drawable {
            name: channel.name.clone(),
            unit: Shown::of(&channel.unit).unit.into(),
            derived: channel.derived,
        };
        self.channels.iter().map(one).collect()
    }

    /// A channel by name.
    pub fn channel(&self, name: &str) -> Option<&Channel> {
        self.channels.iter().find(|own| own.name == name)
    }

    /// The samples from one time to another, one more at each side, so that lines leave the picture.
    pub fn range(&self, from: f64, to: f64) -> std::ops::Range<usize> {
        let start = self.time.partition_point(|t| *t < from).saturating_sub(1);
        let end = self.time.partition_point(|t| *t <= to) + 1;
        start..end.clamp(start, self.time.len())
    }
}
