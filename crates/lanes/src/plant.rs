//! A mass with friction under a given force: many candidates at a time.

use crate::Error;
use midpoint::Midpoint;
use rayon::prelude::*;
use semi_implicit::SemiImplicit;
use stiction_dispatch::InstructionSet;
use stiction_friction::ParamError;

mod drive;
mod midpoint;
mod semi_implicit;

pub use drive::{Axis, Drive, Measured, Motion, Outcome};

/// How velocity and bristle are stepped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stepping {
    /// The accurate one, the implicit-midpoint step MID with the mean force from the mean of both ends:
    ///
    /// ```text
    /// 2 M (w - v)/h = u - [sigma0 (z + z+(w))/2 + sigma1 (z+(w) - z)/h + sigma2 w]
    /// z+(w) = z + (z - sgn(w) g(w)/sigma0) expm1(-h sigma0 |w|/g(w)),   x+ = x + h w,  v+ = 2 w - v
    /// ```
    /// Second order and A-stable. The equation is solved by Newton's method inside a bracket; an axis that is
    /// solved waits for the others in its lanes.
    #[default]
    Midpoint,
    /// The cheap one, for the first generations of a search: the bristle by Euler's implicit rule with the
    /// velocity held, then the velocity with the damping taken at the end of the step:
    ///
    /// ```text
    /// z+ = (z + h v)/(1 + h sigma0 |v|/g(v))
    /// M (v+ - v)/h = u - [sigma0 z+ + sigma1 (v+ - sigma0 |v|/g(v) z+) + sigma2 v+],   x+ = x + h v+
    /// ```
    /// First order: its error is proportional to the step. Nothing is solved by iteration, and it takes a
    /// fifteenth of the time. Stable below the same limit of the step, see [`plants`].
    SemiImplicit,
}

/// Number of axes that share the lanes in the midpoint step.
const LANES: usize = 16;
/// The same for the semi-implicit step. A step of it is one long chain of operations: more axes fill the waiting
/// time.
const SEMI_IMPLICIT_LANES: usize = 64;

/// Simulates every axis under the drive. Keep `h sqrt(sigma0/M)` below about 2.
///
/// Spread over the current rayon pool. The bits of an outcome depend on drive and axis only.
///
/// ```
/// use stiction_lanes::{Axis, Candidate, Drive, InstructionSet, Measured, Motion, Stepping, plants};
///
/// let friction = Candidate::gaussian([1.2e5, 600.0, 60.0, 20.0, 30.0, 5e-3]);
/// let axes = [4.0, 5.0].map(|mass| Axis { mass, friction }); // kg
/// let drive = Drive {
///     step: 1e-3,              // s
///     force: &[50.0; 2000],    // N
///     start: Motion::default(),
///     measured: Measured::Velocity(&[0.5; 2000]),
/// };
/// let found = plants(&drive, &axes, Stepping::Midpoint, InstructionSet::best())?;
/// assert!((found[0].end.velocity - 0.5).abs() < 1e-6); // (50 N - Fc)/sigma2
/// assert!(found[0].cost < found[1].cost);
/// # Ok::<(), stiction_lanes::Error>(())
/// ```
pub fn plants(
    drive: &Drive,
    axes: &[Axis],
    stepping: Stepping,
    instructions: InstructionSet,
) -> Result<Vec<Outcome>, Error> {
    check_drive(drive)?;
    for (index, axis) in axes.iter().enumerate() {
        check_axis(axis).map_err(|source| Error::Candidate { index, source })?;
    }
    let power = |group: &[Axis]| group.iter().any(|a| a.friction.exponent != 2.0);
    let groups: Vec<Vec<Outcome>> = match stepping {
        Stepping::Midpoint => axes
            .par_chunks(LANES)
            .map(|group| match power(group) {
                true => instructions.run(Midpoint::<LANES, true>::new(drive, group)),
                false => instructions.run(Midpoint::<LANES, false>::new(drive, group)),
            })
            .collect(),
        Stepping::SemiImplicit => {
            axes.par_chunks(SEMI_IMPLICIT_LANES)
                .map(|group| match power(group) {
                    true => instructions
                        .run(SemiImplicit::<SEMI_IMPLICIT_LANES, true>::new(drive, group)),
                    false => instructions.run(SemiImplicit::<SEMI_IMPLICIT_LANES, false>::new(
                        drive, group,
                    )),
                })
                .collect()
        }
    };
    Ok(groups.into_iter().flatten().collect())
}

fn check_axis(axis: &Axis) -> Result<(), ParamError> {
    ParamError::positive("mass", axis.mass)?;
    axis.friction.law().map(|_| ())
}

fn check_drive(drive: &Drive) -> Result<(), Error> {
    if !(drive.step > 0.0 && drive.step.is_finite()) {
        return Err(Error::Step {
            segment: 0,
            found: drive.step,
        });
    }
    let (channel, measured) = match drive.measured {
        Measured::Position(x) => ("position", x),
        Measured::Velocity(v) => ("velocity", v),
    };
    if measured.len() != drive.force.len() {
        return Err(Error::Length {
            segment: 0,
            channel: "measured",
            found: measured.len(),
            expected: drive.force.len(),
        });
    }
    let Motion {
        position,
        velocity,
        deflection,
    } = drive.start;
    for (channel, values) in [
        ("force", drive.force),
        (channel, measured),
        ("start", &[position, velocity, deflection]),
    ] {
        if let Some(sample) = values.iter().position(|x| !x.is_finite()) {
            return Err(Error::Sample {
                segment: 0,
                channel,
                sample,
                found: values[sample],
                allowed: "finite",
            });
        }
    }
    Ok(())
}
