//! Joints whose motors move several of them: from motors to joints.

use super::load::JointLogs;
use super::motion::Part;
use crate::error::Error;
use crate::source::Source;
use nalgebra::DMatrix;
use stiction_files::Robot;
use stiction_rigid as rigid;

/// Makes positions, velocities and torques of motors those of the joints that they are coupled to: with `q = C m`, torques are
/// `C^-T` times those of the motors.
pub(super) fn uncouple(
    file: &Robot,
    robot: &rigid::Robot,
    joints: &mut [JointLogs],
) -> Result<(), Error> {
    for (number, coupling) in file.couplings.iter().enumerate() {
        let key = format!("coupling[{}]", number + 1);
        let size = coupling.joints.len();
        let matrix = DMatrix::from_fn(size, size, |i, j| coupling.matrix[i][j]);
        let Some(inverse) = matrix.clone().try_inverse() else {
            let key = format!("{key}.matrix");
            let found = "has no inverse";
            let allowed = "rows that are independent: each motor moves the joints in its own way";
            return Err(file.refuse(&key, found, allowed).into());
        };
        let places: Option<Vec<usize>> = coupling
            .joints
            .iter()
            .map(|name| {
                let joint = robot.joint(name)?;
                joints.iter().position(|own| own.joint == joint)
            })
            .collect();
        let Some(places) = places else {
            let found = "a joint of it is not in the log";
            let allowed = "columns of all joints of a coupling";
            return Err(file.refuse(&key, found, allowed).into());
        };
        for part in [Part::Fitted, Part::HeldOut] {
            let logs = part.of(&joints[places[0]]).len();
            for log in 0..logs {
                let mut sources: Vec<Source> = places
                    .iter()
                    .filter_map(|place| part.of(&joints[*place]).get(log).cloned())
                    .collect();
                let same =
                    |a: &Source, b: &Source| a.log.start == b.log.start && a.log.time == b.log.time;
                let one_clock = sources.windows(2).all(|pair| same(&pair[0], &pair[1]));
                if sources.len() < size || !one_clock {
                    let found = "its joints do not have the same rows in a log";
                    let allowed = "a log without missing cells in the columns of coupled joints";
                    return Err(file.refuse(&key, found, allowed).into());
                }
                let is_whole = turn(&mut sources, &matrix, |s| s.log.position.as_mut())
                    && turn(&mut sources, &matrix, |s| s.log.velocity.as_mut())
                    && turn(&mut sources, &inverse.transpose(), |s| s.log.force.as_mut());
                if !is_whole {
                    let found = "some of its joints have a position, velocity or torque and others have none";
                    let allowed = "the same columns of all joints of a coupling";
                    return Err(file.refuse(&key, found, allowed).into());
                }
                for (place, source) in places.iter().zip(sources) {
                    part.of_mut(&mut joints[*place])[log] = source;
                }
            }
        }
    }
    Ok(())
}

/// Replaces a channel that all logs have by a matrix times it; false where some have it and others have not.
fn turn(
    sources: &mut [Source],
    matrix: &DMatrix<f64>,
    channel: impl Fn(&mut Source) -> Option<&mut Vec<f64>>,
) -> bool {
    let before: Vec<Vec<f64>> = sources
        .iter_mut()
        .filter_map(|source| channel(source).cloned())
        .collect();
    if before.len() < sources.len() {
        return before.is_empty();
    }
    for (row, source) in sources.iter_mut().enumerate() {
        let Some(values) = channel(source) else {
            continue;
        };
        for (k, value) in values.iter_mut().enumerate() {
            *value = before
                .iter()
                .enumerate()
                .map(|(column, motor)| matrix[(row, column)] * motor[k])
                .sum();
        }
    }
    true
}
