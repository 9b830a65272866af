//! `[[path]]`

use super::dimensions::Dimensions;
use super::entry::{name, sampled};
use super::usual::Usual;
use super::{crawl, file};
use crate::config::Table;
use crate::error::Error;
use crate::study::plan::{PathPlan, Study};
use std::path::Path as FilePath;
use stiction_formats::Dimension;
use stiction_friction::ParamError;
use stiction_number::full;
use stiction_servo::motion::{Chirp, Limits, Move, Moves, SetPoints, Sine};
use stiction_servo::path::Path;
use stiction_servo::trajectory::Trajectory;

const KINDS: [&str; 9] = [
    "sine",
    "chirp",
    "move",
    "staircase",
    "constant-velocity",
    "excitation",
    "crawl",
    "hold",
    "file",
];

/// Rest after a move, s.
const DWELL: f64 = 0.2;
/// The same where it is the rest that is looked at: hunting goes through some cycles in it.
const HOLD_DWELL: f64 = 20.0;

type Boxed = Box<dyn Trajectory + Send + Sync>;

/// The paths of an entry: one, or one for each velocity of a crawl.
pub(super) fn paths(
    table: &Table<'_>,
    folder: &FilePath,
    study: &mut Study,
) -> Result<Vec<PathPlan>, Error> {
    let motion = study.machine.motion;
    let is = Dimensions::of(motion);
    if let Some(kind @ ("circle" | "corner" | "square" | "figure-eight")) = table.text("kind")? {
        let allowed = "a [[contour]] has two axes; the part of one axis in a circle is a sine, in a corner a move";
        return Err(table.refuse("kind", format!("{kind:?}"), allowed));
    }
    let found = table.choice("kind", &KINDS)?;
    let found = table.required("kind", found, &format!("one of {}", KINDS.join(", ")))?;
    // The choice gave one of them.
    let kind = KINDS.into_iter().find(|k| *k == found).unwrap_or(KINDS[0]);
    let asked = Asked {
        table,
        is,
        rate: study.machine.rate,
        usual: Usual::of(motion),
    };
    let one = match kind {
        "sine" => asked.sine()?,
        "chirp" => asked.chirp()?,
        "move" => asked.there_and_back()?,
        "staircase" => asked.staircase()?,
        "constant-velocity" => asked.constant_velocity()?,
        "excitation" => asked.excitation()?,
        "hold" => asked.hold()?,
        "crawl" => {
            let name = name(table, kind.into())?;
            let plans = crawl::motions(table, &study.machine)?.into_iter();
            let plans = plans.map(|(velocity, motion)| {
                let trajectory = asked.moves("hold", Ok(motion), (1, 0.0))?;
                let name = format!("{name} at {velocity}");
                asked.plan(name, kind, trajectory)
            });
            let plans = plans.collect::<Result<_, _>>()?;
            table.end()?;
            return Ok(plans);
        }
        _ => {
            let points = file::points::<1>(table, folder, asked.is.length, &file::POSITION)?;
            let [positions] = points.axes;
            study.reads(&points.file, points.sha256, points.warning);
            let points = asked.made(SetPoints::timed(points.times, positions))?;
            asked.sampled("file", "a motion", points.duration())?;
            points
        }
    };
    let plan = asked.plan(name(table, kind.into())?, kind, one)?;
    table.end()?;
    Ok(vec![plan])
}

struct Asked<'t, 'a> {
    table: &'t Table<'a>,
    is: Dimensions,
    /// Hz
    rate: f64,
    usual: Usual,
}

impl Asked<'_, '_> {
    /// A path of a name, with the part of it that does not count.
    fn plan(&self, name: String, kind: &'static str, trajectory: Boxed) -> Result<PathPlan, Error> {
        let duration = trajectory.duration();
        let default = if kind == "sine" { 0.5 * duration } else { 0.0 };
        let skip = self.table.not_negative("skip", Dimension::TIME)?;
        let skip = skip.unwrap_or(default);
        if skip >= duration {
            let allowed = format!("shorter than the path, {} s", full(duration));
            return Err(self
                .table
                .refuse("skip", format!("{} s", full(skip)), &allowed));
        }
        Ok(PathPlan {
            name,
            kind,
            trajectory,
            skip,
        })
    }

    fn value(&self, key: &'static str, dimension: Dimension, example: &str) -> Result<f64, Error> {
        let value = self.table.positive(key, dimension)?;
        self.table.required(key, value, example)
    }

    fn limits(&self) -> Result<Limits, Error> {
        let acceleration = Dimensions::per(self.is.speed, Dimension::TIME);
        let jerk = Dimensions::per(acceleration, Dimension::TIME);
        Ok(Limits {
            velocity: self.value("velocity", self.is.speed, "the largest velocity")?,
            acceleration: self.value("acceleration", acceleration, "the largest acceleration")?,
            jerk: self.value("jerk", jerk, "the largest jerk, such as \"100 m/s3\"")?,
        })
    }

    fn made<T: Trajectory + Send + Sync + 'static>(
        &self,
        made: Result<T, ParamError>,
    ) -> Result<Boxed, Error> {
        match made {
            Ok(trajectory) => Ok(Box::new(trajectory)),
            Err(e) => Err(self.table.together(&e)),
        }
    }

    fn sampled(&self, key: &str, what: &str, seconds: f64) -> Result<(), Error> {
        sampled(self.table, key, what, seconds, self.rate)
    }

    /// A frequency whose period has enough samples.
    fn frequency(&self, key: &'static str, example: &str) -> Result<f64, Error> {
        let frequency = self.value(key, Dimension::FREQUENCY, example)?;
        self.sampled(key, "a period", 1.0 / frequency)?;
        Ok(frequency)
    }

    /// Moves of the same length, each `dwell` seconds before the next.
    fn moves(
        &self,
        key: &str,
        made: Result<Moves, ParamError>,
        (count, dwell): (u32, f64),
    ) -> Result<Boxed, Error> {
        let moves = self.made(made)?;
        let one = (moves.duration() / f64::from(count) - dwell).max(0.0);
        self.sampled(key, "a move", one)?;
        Ok(moves)
    }

    fn sine(&self) -> Result<Boxed, Error> {
        let amplitude = self.value("amplitude", self.is.length, "a way such as \"5 mm\"")?;
        let frequency = self.frequency("frequency", "one such as \"0.5 Hz\"")?;
        let cycles = self.table.number("cycles", 0.5, 1000.0)?.unwrap_or(4.0);
        self.made(Sine::new(amplitude, frequency, cycles))
    }

    fn chirp(&self) -> Result<Boxed, Error> {
        let amplitude = self.value("amplitude", self.is.length, "a way such as \"1 mm\"")?;
        let from = self.frequency("from", "a frequency such as \"0.1 Hz\"")?;
        let to = self.frequency("to", "a frequency such as \"10 Hz\"")?;
        let duration = self.value("duration", Dimension::TIME, "a time such as \"10 s\"")?;
        self.sampled("duration", "a chirp", duration)?;
        self.made(Chirp::new(amplitude, from, to, duration))
    }

    fn dwell(&self, usual: f64) -> Result<f64, Error> {
        let dwell = self.table.not_negative("dwell", Dimension::TIME)?;
        Ok(dwell.unwrap_or(usual))
    }

    fn hold(&self) -> Result<Boxed, Error> {
        let distance = self.table.positive("distance", self.is.length)?;
        let dwell = self.dwell(HOLD_DWELL)?;
        let limits = self.usual.limits(self.table)?;
        let distance = distance.unwrap_or(self.usual.way);
        let made = Moves::new(&[Move { distance, dwell }], limits);
        self.moves("distance", made, (1, dwell))
    }

    fn there_and_back(&self) -> Result<Boxed, Error> {
        let distance = self.value("distance", self.is.length, "a way such as \"20 mm\"")?;
        let (dwell, limits) = (self.dwell(DWELL)?, self.limits()?);
        let made = Moves::there_and_back(distance, dwell, limits);
        self.moves("distance", made, (2, dwell))
    }

    fn staircase(&self) -> Result<Boxed, Error> {
        let distance = self.value("distance", self.is.length, "one step, such as \"1 um\"")?;
        let steps = self.table.count("steps", 1, 1000)?.unwrap_or(5) as u32;
        let (dwell, limits) = (self.dwell(DWELL)?, self.limits()?);
        let made = Moves::staircase(distance, steps, dwell, limits);
        self.moves("distance", made, (2 * steps, dwell))
    }

    fn constant_velocity(&self) -> Result<Boxed, Error> {
        let hold = self.value("hold", Dimension::TIME, "a time such as \"2 s\"")?;
        let made = Moves::constant_velocity(hold, self.limits()?);
        self.moves("hold", made, (2, 0.0))
    }

    fn excitation(&self) -> Result<Boxed, Error> {
        let speed = self.value("speed", self.is.speed, "the largest speed")?;
        let duration = self.value("duration", Dimension::TIME, "a time such as \"9 s\"")?;
        let path = Path::three_segments(speed, duration).map_err(|e| self.table.together(&e))?;
        for segment in path.segments() {
            self.sampled("kind", "a period", 1.0 / segment.frequency)?;
            self.sampled("duration", "a third", segment.duration)?;
        }
        Ok(Box::new(path))
    }
}
