//! Motions that people record, to compare with.

use crate::atom::Atom;
use crate::dictionary::{FAST, fits, sine, there_and_back};
use crate::limits::Limits;
use crate::motion::Motion;
use crate::rig::Rig;
use stiction_friction::ParamError;

/// A motion that needs no design.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HandMade {
    /// A sine of 1 Hz at the largest speed.
    Sine,
    /// There and back over the whole stroke, again and again.
    Trapezoid,
    /// Six constant speeds in equal ratios, there and back.
    SixSpeeds,
    /// Three sines: fast, slow about the Stribeck velocity, quick and small (that of the README).
    ThreeSines,
}

impl HandMade {
    /// All of them.
    pub const ALL: [HandMade; 4] = [
        HandMade::Sine,
        HandMade::Trapezoid,
        HandMade::SixSpeeds,
        HandMade::ThreeSines,
    ];

    /// What it is, for people.
    pub fn name(self) -> &'static str {
        match self {
            HandMade::Sine => "sine of 1 Hz",
            HandMade::Trapezoid => "full strokes",
            HandMade::SixSpeeds => "six speeds",
            HandMade::ThreeSines => "three sines",
        }
    }
}

/// Ratio of neighbouring speeds of the six.
const SPEED_RATIO: f64 = 3.0;
/// Speed and frequency of the three sines (`Path::three_segments` of stiction-servo).
const THREE: [(f64, f64); 3] = [(1.0, 1.0), (0.0189, 1.2), (0.128, 28.0)];
/// The motion in at most `time` s, within the limits. `None` where the time is too short for it, or the axis stands at an
/// end of its stroke.
pub fn hand_made(
    kind: HandMade,
    limits: &Limits,
    rig: &Rig,
    time: f64,
) -> Result<Option<Motion>, ParamError> {
    let speed = FAST * limits.speed;
    let fitted = |atom: Atom| atom.scaled(fits(&atom, limits));
    let atoms: Option<Vec<Atom>> = match kind {
        HandMade::Sine => Some(vec![fitted(sine(speed, 1.0, time))]),
        HandMade::Trapezoid => {
            let once = there_and_back(limits, (speed, 0.9 * limits.acceleration), 0.5 * time);
            once.map(|once| {
                let times = (time / once.duration() + 1e-9) as usize;
                vec![fitted(once); times]
            })
        }
        HandMade::SixSpeeds => (0..6)
            .map(|k| {
                let speed = (0..k).fold(speed, |speed, _| speed / SPEED_RATIO);
                let atom = there_and_back(limits, (speed, 0.9 * limits.acceleration), time / 12.0)?;
                Some(fitted(atom))
            })
            .collect(),
        HandMade::ThreeSines => {
            let highest = 0.5 * rig.rate / 10.0;
            let sines =
                THREE.map(|(part, f)| fitted(sine(part * speed, f.min(highest), time / 3.0)));
            Some(sines.to_vec())
        }
    };
    match atoms {
        // Of an axis that stands at an end of its stroke nothing is left of a sine.
        Some(atoms) if !atoms.is_empty() => Ok(Motion::new(atoms).ok()),
        _ => Ok(None),
    }
}
