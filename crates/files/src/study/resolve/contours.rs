//! `[[contour]]`, `[second_axis]` and `[coupling]`

use super::dimensions::Dimensions;
use super::entry::{below_half_the_rate, name, sampled};
use super::machine::machine;
use super::usual::Usual;
use super::{controllers, file};
use crate::config::Table;
use crate::error::Error;
use crate::study::plan::{ContourPlan, Second};
use crate::study::plan::{Machine, Study};
use crate::study::result::StudyInput;
use std::path::Path;
use stiction_formats::Dimension;
use stiction_friction::ParamError;
use stiction_number::full;
use stiction_servo::cross_coupling::CrossCoupling;
use stiction_servo::law::AxisLaw;
use stiction_servo::motion::Limits;
use stiction_servo::plane::{Along, Circle, Curve, FigureEight, FreeForm, PlaneMotion, Polygon};

const KINDS: [&str; 5] = ["circle", "corner", "square", "figure-eight", "file"];

type Boxed = Box<dyn PlaneMotion + Send + Sync>;

/// The second axis and what couples both. Its controllers and beliefs come with those of the first. What was read for it is
/// added to `inputs`.
pub(super) fn second(
    root: &Table<'_>,
    table: &Table<'_>,
    folder: &Path,
    first: &Machine,
    inputs: &mut Vec<StudyInput>,
) -> Result<Second, Error> {
    let machine = machine(table, folder, Some(first.rate), inputs)?;
    if machine.motion != first.motion {
        let allowed = "linear or rotary, as the first axis";
        return Err(table.refuse("model", "is of the other kind".into(), allowed));
    }
    for of in [first, &machine] {
        if !matches!(of.law, AxisLaw::LuGre(_)) {
            let found = format!("beside an axis with the law {}", of.model.kind.name());
            let allowed = "lugre or dahl on both axes: with other laws a study has one axis";
            return Err(table.refuse("model", found, allowed));
        }
    }
    Ok(Second {
        machine,
        controllers: Vec::new(),
        families: Vec::new(),
        coupling: coupling(root, &Dimensions::of(first.motion), first.rate)?,
    })
}

fn coupling(root: &Table<'_>, is: &Dimensions, rate: f64) -> Result<Option<CrossCoupling>, Error> {
    let Some(table) = root.table("coupling")? else {
        return Ok(None);
    };
    let bandwidth = below_half_the_rate(&table, "bandwidth", rate)?;
    let example = "the bandwidth of the slower axis, such as \"45 Hz\"";
    let bandwidth = table.required("bandwidth", bandwidth, example)?;
    let limit = table.positive("limit", is.speed)?;
    let limit = table.required("limit", limit, "the largest velocity, such as \"100 mm/s\"")?;
    table.end()?;
    let coupling = CrossCoupling::tuned(bandwidth, limit).map_err(|e| table.together(&e))?;
    Ok(Some(coupling))
}

/// A controller for the second axis from the table of one for the first.
pub(super) fn controller(table: &Table<'_>, study: &mut Study) -> Result<(), Error> {
    let Some(second) = &mut study.second else {
        return Ok(());
    };
    let controller = controllers::second(table, &second.machine)?;
    second.controllers.push(controller);
    Ok(())
}

pub(super) fn contour(
    table: &Table<'_>,
    folder: &Path,
    study: &mut Study,
) -> Result<ContourPlan, Error> {
    if study.second.is_none() {
        let allowed = "give a table [second_axis]: a contour needs two";
        return Err(table.refuse("kind", "is for two axes".into(), allowed));
    }
    let found = table.choice("kind", &KINDS)?;
    let found = table.required("kind", found, &format!("one of {}", KINDS.join(", ")))?;
    // The choice gave one of them.
    let kind = KINDS.into_iter().find(|k| *k == found).unwrap_or(KINDS[0]);
    let asked = Asked {
        table,
        is: Dimensions::of(study.machine.motion),
        usual: Usual::of(study.machine.motion),
    };
    // The key that gives the size, and the part of the motion that must have enough samples.
    let (size, part) = match kind {
        "circle" => ("radius", "a turn"),
        "corner" | "square" => ("side", "a side"),
        "figure-eight" => ("width", "a turn"),
        _ => ("file", "a motion"),
    };
    let (motion, turns, parts) = match kind {
        "circle" => asked.circle()?,
        "corner" => (asked.corner()?, 1.0, 2.0),
        "square" => (asked.square()?, 1.0, 4.0),
        "figure-eight" => asked.figure_eight()?,
        _ => {
            let points = file::points::<2>(table, folder, asked.is.length, &file::PLANE)?;
            let [x, y] = points.axes;
            study.reads(&points.file, points.sha256, points.warning);
            let motion = FreeForm::timed(points.times, x, y).map_err(|e| table.together(&e))?;
            (Box::new(motion) as Boxed, 1.0, 1.0)
        }
    };
    let duration = motion.duration();
    sampled(table, size, part, duration / parts, study.machine.rate)?;
    let usual = if turns >= 2.0 {
        first_turn(motion.as_ref(), turns)
    } else {
        0.0
    };
    let skip = table.not_negative("skip", Dimension::TIME)?;
    let skip = skip.unwrap_or(usual);
    if skip >= duration {
        let allowed = format!("shorter than the contour, {} s", full(duration));
        return Err(table.refuse("skip", format!("{} s", full(skip)), &allowed));
    }
    let plan = ContourPlan {
        name: name(table, kind.into())?,
        kind,
        motion,
        skip,
    };
    table.end()?;
    Ok(plan)
}

/// When the first of `turns` ends, s: it is the run-up. The motion's parameter only grows.
fn first_turn(motion: &dyn PlaneMotion, turns: f64) -> f64 {
    let turned = motion.end() / turns;
    let (mut before, mut after) = (0.0, motion.duration());
    // Bisection, down to the last bit.
    for _ in 0..64 {
        let middle = 0.5 * (before + after);
        if motion.at(middle).parameter < turned {
            before = middle;
        } else {
            after = middle;
        }
    }
    after
}

struct Asked<'t, 'a> {
    table: &'t Table<'a>,
    is: Dimensions,
    usual: Usual,
}

impl Asked<'_, '_> {
    /// A length that has a usual value, and limits that have, divided by the scale that belongs to the length.
    fn sized(&self, key: &'static str, scale: fn(f64) -> f64) -> Result<(f64, Limits), Error> {
        let length = self.table.positive(key, self.is.length)?;
        let length = length.unwrap_or(self.usual.way);
        let Limits {
            velocity,
            acceleration,
            jerk,
        } = self.usual.limits(self.table)?;
        let scale = scale(length);
        let limits = Limits {
            velocity: velocity / scale,
            acceleration: acceleration / scale,
            jerk: jerk / scale,
        };
        Ok((length, limits))
    }

    fn length(&self, key: &'static str) -> Result<f64, Error> {
        let value = self.table.positive(key, self.is.length)?;
        self.table
            .required(key, value, "a length such as \"10 mm\"")
    }

    /// Limits along the contour, m, divided by `scale`, the length of path for one unit of its parameter.
    fn limits(&self, scale: f64) -> Result<Limits, Error> {
        let acceleration = Dimensions::per(self.is.speed, Dimension::TIME);
        let jerk = Dimensions::per(acceleration, Dimension::TIME);
        let value = |key, dimension, example| -> Result<f64, Error> {
            let value = self.table.positive(key, dimension)?;
            Ok(self.table.required(key, value, example)? / scale)
        };
        Ok(Limits {
            velocity: value("velocity", self.is.speed, "the largest velocity")?,
            acceleration: value("acceleration", acceleration, "the largest acceleration")?,
            jerk: value("jerk", jerk, "the largest jerk, such as \"100 m/s3\"")?,
        })
    }

    fn turns(&self) -> Result<f64, Error> {
        Ok(self.table.number("turns", 0.25, 1000.0)?.unwrap_or(2.0))
    }

    fn along<C: Curve + Send + Sync + 'static>(
        &self,
        curve: Result<C, ParamError>,
        limits: Limits,
    ) -> Result<Boxed, Error> {
        match curve.and_then(|curve| Along::new(curve, limits)) {
            Ok(along) => Ok(Box::new(along)),
            Err(e) => Err(self.table.together(&e)),
        }
    }

    fn circle(&self) -> Result<(Boxed, f64, f64), Error> {
        let ((radius, limits), turns) = (self.sized("radius", |radius| radius)?, self.turns()?);
        let circle = self.along(Circle::new(radius, turns), limits)?;
        Ok((circle, turns, turns.max(1.0)))
    }

    fn corner(&self) -> Result<Boxed, Error> {
        let (side, limits) = self.sized("side", |_| 1.0)?;
        self.along(Polygon::corner(side), limits)
    }

    fn square(&self) -> Result<Boxed, Error> {
        let side = self.length("side")?;
        self.along(Polygon::square(side), self.limits(1.0)?)
    }

    fn figure_eight(&self) -> Result<(Boxed, f64, f64), Error> {
        let (width, height, turns) = (self.length("width")?, self.length("height")?, self.turns()?);
        let (a, b) = (0.5 * width, 0.5 * height);
        // Fastest in the middle, where both axes are.
        let limits = self.limits(libm::hypot(a, 2.0 * b))?;
        let eight = self.along(FigureEight::new(a, b, turns), limits)?;
        Ok((eight, turns, turns.max(1.0)))
    }
}
