//! A plan as text: its pieces, and what its log is expected to show.

use crate::config::{Form, Source, Table, read};
use crate::error::Error;
use crate::hash::sha256_of;
use std::path::{Path, PathBuf};
use stiction_friction::ParamError;
use stiction_plan::{Atom, Motion};

/// Longest motion of a plan, s: one that is planned has ten minutes at most.
const LONGEST: f64 = 3600.0;

/// Most pieces: those of a motion of ten minutes.
const MOST_PIECES: usize = 10_000;
const MOST_PARAMETERS: usize = 100;
/// Largest number that is read.
const LARGEST: f64 = 1e12;

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
                interval_percent: number(&table, "interval_percent")?,
                interval90_percent: number(&table, "interval90_percent")?,
            });
        }
        let mut atoms = Vec::new();
        for table in root.tables("atom", MOST_PIECES)? {
            let atom = atom(&table)?;
            atom.validate().map_err(|e| table.together(&e))?;
            atoms.push(atom);
        }
        let motion = Motion::new(atoms).and_then(|motion| match motion.duration() {
            seconds if seconds > LONGEST => {
                let allowed = "pieces of at most an hour in all";
                Err(ParamError::new("atom", seconds, allowed))
            }
            seconds if seconds > 0.0 => Ok(motion),
            seconds => Err(ParamError::new("atom", seconds, "at least one piece")),
        });
        Ok(Self {
            file: file.to_path_buf(),
            sha256: sha256_of(text.as_bytes()),
            kind: kind.into(),
            motion: motion.map_err(|e| root.together(&e))?,
            expected,
        })
    }
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
                frequency: number("frequency")?,
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
