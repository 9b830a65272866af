//! A function block of IEC 61131-3 that computes the pieces.

use super::{Carried, Carrier, Job};
use crate::atom::Atom;
use stiction_number::short;
use stiction_servo::motion::{Limits, Profile};

const BLOCK: &str = include_str!("block.st.in");
/// Numbers in a line of a table.
const IN_A_LINE: usize = 6;

/// The block, with its pieces as tables of constants.
pub(super) fn carry(job: &Job) -> Carried {
    let motion = job.motion;
    let count = motion.atoms().len().to_string();
    let all: Vec<[f64; 4]> = motion.atoms().iter().map(numbers).collect();
    let column = |k: usize| table(all.iter().map(|row| real(row[k])));
    let begins = table(motion.timed().map(|(start, _)| real(start)));
    let lasts = table(motion.atoms().iter().map(|atom| real(atom.duration())));
    let is_sine = motion.atoms().iter().map(|atom| match atom {
        Atom::Sine { .. } => "TRUE".to_string(),
        Atom::Move { .. } => "FALSE".to_string(),
    });
    let is_sine = table(is_sine);
    let text = BLOCK
        .replace("@name@", job.identifier)
        .replace("@duration@", &short(motion.duration()))
        .replace("@count@", &count)
        .replace("@cycle@", &real(1.0 / job.rate))
        .replace("@x_unit@", job.length())
        .replace("@begins@", &begins)
        .replace("@lasts@", &lasts)
        .replace("@is_sine@", &is_sine)
        .replace("@n1@", &column(0))
        .replace("@n2@", &column(1))
        .replace("@n3@", &column(2))
        .replace("@n4@", &column(3));
    Carried {
        carrier: Carrier::St,
        text,
        note: format!(
            "FB_{}_Motion gives position, velocity and acceleration in {} for each cycle, from where the axis stands; pace 0.3 first",
            job.identifier,
            job.length()
        ),
    }
}

/// The four numbers of a piece in the block.
fn numbers(atom: &Atom) -> [f64; 4] {
    match *atom {
        Atom::Sine {
            amplitude,
            frequency,
            fade_in,
            fade_out,
            ..
        } => [
            amplitude,
            std::f64::consts::TAU * frequency,
            fade_in,
            fade_out,
        ],
        Atom::Move {
            distance,
            speed,
            acceleration,
            jerk,
        } => {
            let limits = Limits {
                velocity: speed,
                acceleration,
                jerk,
            };
            // Pieces of a motion are within their ranges.
            Profile::new(distance, limits).map_or([0.0; 4], |there| {
                [
                    distance,
                    jerk,
                    there.peak_acceleration() / jerk,
                    there.ramp(),
                ]
            })
        }
    }
}

/// A literal of LREAL: with a point before its exponent.
fn real(x: f64) -> String {
    let text = format!("{x:E}");
    match text.split_once('E') {
        Some((digits, exponent)) if !digits.contains('.') => format!("{digits}.0E{exponent}"),
        _ => text,
    }
}

fn table(values: impl Iterator<Item = String>) -> String {
    let values: Vec<String> = values.collect();
    let lines: Vec<String> = values
        .chunks(IN_A_LINE)
        .map(|line| line.join(", "))
        .collect();
    lines.join(",\n        ")
}
