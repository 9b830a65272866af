//! A plan as text: its pieces, and what its log is expected to show.

use crate::config::{Form, Source, Table, read};
use crate::error::Error;
use crate::hash::sha256_of;
use std::path::{Path, PathBuf};
use stiction_friction::ParamError;
use stiction_number::{four_digits as short, full};
use stiction_plan::{Atom, Motion};

/// Longest motion of a plan, s: one that is planned has ten minutes at most.
const LONGEST: f64 = 3600.0;

/// Most pieces: those of a motion of ten minutes.
const MOST_PIECES: usize = 10_000;
const MOST_PARAMETERS: usize = 100;
/// Largest number that is read, and largest frequency of a sine, Hz, which is looked at period by period.
const LARGEST: f64 = 1e12;
const LARGEST_FREQUENCY: f64 = 1e3;

/// A plan that was carried out.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadPlan {
    /// The file.
    pub file: PathBuf,
    /// SHA-256 of its text, hexadecimal.
    pub sha256: String,
    /// `linear` or `rotary`.
    pub kind: String,
    /// The pieces.
    pub motion: Motion,
    /// What was expected of each parameter.
    pub expected: Vec<ReadExpected>,
}

/// Expected for one parameter: half of its 95 % interval, percent of its value or of what `of` says.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadExpected {
    /// Name, such as `sigma0`.
    pub name: String,
    /// Of a term beside the law: the parameter of which it is given in percent, and what the term is multiplied by for that, SI.
    pub of: Option<(String, f64)>,
    /// On half of the axes at most.
    pub interval_percent: f64,
    /// On nine of ten axes at most.
    pub interval90_percent: f64,
}

impl ReadPlan {
    /// Reads a plan.
    ///
    /// # Errors
    /// With file, line, column and key, what was found and what is allowed.
    pub fn read(file: &Path) -> Result<Self, Error> {
        let text = read(file, Form::Plan)?;
        Self::parse(&text, file)
    }

    fn parse(text: &str, file: &Path) -> Result<Self, Error> {
        let source = Source {
            file,
            text,
            form: Form::Plan,
            swept: None,
        };
        let entries = source.parse()?;
        let root = Table::root(source, &entries);
        root.required(
            "schema",
            root.choice("schema", &[super::SCHEMA])?,
            Form::Plan.what(),
        )?;
        let kind = root.choice("kind", &["linear", "rotary"])?;
        let kind = root.required("kind", kind, "linear or rotary")?;
        let mut expected = Vec::new();
        for table in root.tables("parameter", MOST_PARAMETERS)? {
            expected.push(ReadExpected {
                name: table
                    .required("name", table.line("name")?, "a name")?
                    .into(),
                of: match table.line("of")? {
                    Some(of) => Some((of.to_string(), number(&table, "at")?)),
                    None => None,
                },
                interval_percent: percent(&table, "interval_percent")?,
                interval90_percent: percent(&table, "interval90_percent")?,
            });
        }
        let limits = root.table("limits")?.as_ref().map(Most::of).transpose()?;
        let (mut atoms, mut start) = (Vec::new(), 0.0);
        for table in root.tables("atom", MOST_PIECES)? {
            let atom = atom(&table)?;
            atom.validate().map_err(|e| table.together(&e))?;
            if let Some(limits) = &limits {
                limits.hold(&table, &atom)?;
            }
            in_order(&table, &atom, start)?;
            start += atom.duration();
            atoms.push(atom);
        }
        let motion = Motion::new(atoms).and_then(|motion| match motion.duration() {
            seconds if seconds > LONGEST => {
                let allowed = "pieces of at most an hour in all";
                Err(ParamError::new("atom", seconds, allowed))
            }
            seconds if seconds > 0.0 => Ok(motion),
            _ => Err(ParamError::new("atom", 0.0, "at least one piece")),
        });
        Ok(Self {
            file: file.to_path_buf(),
            sha256: sha256_of(text.as_bytes()),
            kind: kind.into(),
            motion: motion.map_err(|e| root.refuse("atom", full(e.value), e.allowed))?,
            expected,
        })
    }
}

/// Part of a limit, and of a time, that rounding of a file makes of it.
const ROUNDED: f64 = 1e-6;
/// Part by which the bound of an extreme may lie above it: that of a sine on its grid.
const BOUNDED: f64 = 2e-3;

/// What the pieces of a plan may reach.
struct Most {
    stroke: [f64; 2],
    speed: f64,
    acceleration: f64,
    jerk: f64,
}

impl Most {
    fn of(table: &Table) -> Result<Self, Error> {
        let list = table.get("stroke").and_then(|stroke| stroke.as_list());
        let ends = list.map(|ends| {
            ends.iter()
                .map(|end| end.number(-LARGEST, LARGEST))
                .collect()
        });
        let ends: Option<Vec<f64>> = ends.transpose()?;
        let [low, high] = ends
            .and_then(|ends| <[f64; 2]>::try_from(ends).ok())
            .filter(|[low, high]| low <= high)
            .ok_or_else(|| table.refused("stroke", "two numbers, the larger one last"))?;
        Ok(Most {
            stroke: [low, high],
            speed: above(table, "speed")?,
            acceleration: above(table, "acceleration")?,
            jerk: above(table, "jerk")?,
        })
    }

    /// Refuses a piece that goes beyond: an axis that follows a file like this one would.
    fn hold(&self, table: &Table, atom: &Atom) -> Result<(), Error> {
        let size = match atom {
            Atom::Sine { .. } => "amplitude",
            Atom::Move { .. } => "distance",
        };
        let found = atom.extremes();
        let [low, high] = self.stroke;
        let beyond = [
            ("stroke", -found.position[0], -low),
            ("stroke", found.position[1], high),
            ("speed", found.speed, self.speed),
            ("acceleration", found.acceleration, self.acceleration),
            ("jerk", found.jerk, self.jerk),
        ];
        let Some((limit, reached, most)) = (beyond.into_iter())
            .find(|(_, reached, most)| *reached > (1.0 + BOUNDED) * most + ROUNDED * reached.abs())
        else {
            return Ok(());
        };
        let key = match table.find(limit) {
            Some(_) => limit,
            None => size,
        };
        let found = format!("a piece that reaches {} of {limit}", short(reached));
        Err(table.refuse(
            key,
            found,
            &format!("at most {}, as [limits] of this file says", short(most)),
        ))
    }
}

/// Refuses a piece that does not start where the one before ends, or that lasts another time than it says.
fn in_order(table: &Table, atom: &Atom, start: f64) -> Result<(), Error> {
    for (key, due) in [("start", start), ("duration", atom.duration())] {
        let found = table.number(key, -LARGEST, LARGEST)?;
        if let Some(found) = found.filter(|found| (found - due).abs() > ROUNDED * (1.0 + due)) {
            let allowed = format!(
                "{} s: the pieces follow each other from rest to rest",
                short(due)
            );
            return Err(table.refuse(key, full(found), &allowed));
        }
    }
    Ok(())
}

/// Half of an interval.
fn percent(table: &Table, key: &'static str) -> Result<f64, Error> {
    table.required(
        key,
        table.number(key, 0.0, LARGEST)?,
        "a number of 0 or more",
    )
}

fn above(table: &Table, key: &'static str) -> Result<f64, Error> {
    let found = table.number(key, f64::MIN_POSITIVE, LARGEST)?;
    table.required(key, found, "a number above 0")
}

fn number(table: &Table, key: &'static str) -> Result<f64, Error> {
    table.required(key, table.number(key, -LARGEST, LARGEST)?, "a number")
}

fn atom(table: &Table) -> Result<Atom, Error> {
    let kind = table.choice("kind", &["sine", "move"])?;
    let number = |key| number(table, key);
    Ok(
        match table.required("kind", kind, "\"sine\" or \"move\"")? {
            "sine" => Atom::Sine {
                amplitude: number("amplitude")?,
                frequency: {
                    let found = table.number("frequency", 0.0, LARGEST_FREQUENCY)?;
                    table.required("frequency", found, "a number")?
                },
                duration: number("duration")?,
                fade_in: number("fade_in")?,
                fade_out: number("fade_out")?,
            },
            _ => Atom::Move {
                distance: number("distance")?,
                speed: number("speed")?,
                acceleration: number("acceleration")?,
                jerk: number("jerk")?,
            },
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_beyond_the_limits_or_out_of_order_are_refused_where_they_stand() {
        let plan = |amplitude: &str, starts: [&str; 2], interval: &str| {
            let sine = |start: &str| {
                format!(
                    "[[atom]]\nstart = {start}\nkind = \"sine\"\namplitude = {amplitude}\nfrequency = 1.0\nduration = 2.0\n\
                     fade_in = 0.5\nfade_out = 0.5\n"
                )
            };
            let text = format!(
                "schema = \"{}\"\nkind = \"linear\"\n[limits]\nstroke = [-0.1, 0.1]\nspeed = 0.2\nacceleration = 6.0\njerk = 1500.0\n\
                 [[parameter]]\nname = \"sigma0\"\ninterval_percent = {interval}\ninterval90_percent = 2.0\n{}{}",
                super::super::SCHEMA,
                sine(starts[0]),
                sine(starts[1]),
            );
            ReadPlan::parse(&text, Path::new("plan.toml")).map_err(|e| e.to_string())
        };
        assert!(plan("0.01", ["0.0", "2.0"], "1.0").is_ok());
        let refused = |found: Result<ReadPlan, String>, words: [&str; 2]| {
            let message = found.unwrap_err();
            assert!(words.iter().all(|w| message.contains(w)), "{message}");
        };
        refused(
            plan("0.05", ["0.0", "2.0"], "1.0"),
            ["amplitude", "of speed; at most 0.2"],
        );
        refused(
            plan("0.01", ["0.0", "1.5"], "1.0"),
            ["atom[2].start", "2.000 s"],
        );
        refused(plan("0.01", ["nan", "2.0"], "1.0"), ["start", "nan"]);
        refused(
            plan("0.01", ["0.0", "2.0"], "-1.0"),
            ["interval_percent", "-1"],
        );
    }

    #[test]
    fn a_motion_that_nobody_waits_for_is_refused() {
        let plan = |duration: &str| {
            let text = format!(
                "schema = \"{}\"\nkind = \"linear\"\n[[atom]]\nkind = \"sine\"\namplitude = 0.01\nfrequency = 1.0\n\
                 duration = {duration}\nfade_in = 0.5\nfade_out = 0.5\n",
                super::super::SCHEMA
            );
            ReadPlan::parse(&text, Path::new("plan.toml")).map(|plan| plan.motion.duration())
        };
        assert!(plan("9.0").unwrap() > 0.0);
        let refused = plan("1e5").unwrap_err().to_string();
        assert!(
            refused.contains("plan.toml") && refused.contains("at most an hour"),
            "{refused}"
        );
    }
}
