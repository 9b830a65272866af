//! Forces that follow from other columns: a magnitude with the sign of a following error, the duty of a servo's position loop.

use super::cells::Columns;
use super::clock::Clock;
use crate::mapping::{Mapping, Role, Sign, select};
use crate::{Error, Kind, Table};

/// The column of the sign of the force, if it is another one.
pub(super) fn sign_column(mapping: &Mapping, table: &Table) -> Result<Option<usize>, Error> {
    match mapping.force.as_ref().and_then(|force| force.sign.as_ref()) {
        Some(Sign::Column(column)) => select(table, column, Role::Force)
            .map(Some)
            .map_err(|e| e.of_setting(Role::Force.key("sign"))),
        _ => Ok(None),
    }
}

/// Numbers of the kept rows of that column.
pub(super) fn sign_of(column: Option<usize>, table: &Table, clock: &Clock) -> Option<Vec<f64>> {
    let values = &table.columns[column?].values;
    let value = |row: usize| values.get(row).copied().unwrap_or(f64::NAN);
    Some(clock.rows().map(value).collect())
}

/// Gives a magnitude its sign and makes the duty of a position loop.
pub(super) fn force(
    columns: &mut Columns,
    mapping: &Mapping,
    sign: Option<Vec<f64>>,
) -> Result<(), Error> {
    let by_error =
        mapping.force.as_ref().and_then(|f| f.sign.as_ref()) == Some(&Sign::FollowingError);
    let invert = mapping.force.as_ref().is_some_and(|force| force.invert);
    let position_loop = mapping.drive.and_then(|drive| drive.position_loop);
    let position_loop = position_loop.filter(|_| mapping.force.is_none());
    let source = match (sign, by_error || position_loop.is_some()) {
        (Some(sign), _) => signed(sign),
        (None, false) => return Ok(()),
        (None, true) => following_error(columns, by_error)?,
    };
    if let Some(position_loop) = position_loop {
        columns.add(
            Role::Force,
            source.iter().map(|e| position_loop.duty(*e)).collect(),
        );
    } else if let Some(force) = columns.get_mut(Role::Force) {
        for (force, source) in force.iter_mut().zip(source) {
            // Without an error the loop commands nothing.
            let sign = if source == 0.0 { 0.0 } else { source.signum() };
            *force = force.abs() * if invert { -sign } else { sign };
        }
    }
    Ok(())
}

/// The numbers of a sign; of a direction bit, 0 and 1, 0 is back.
fn signed(mut sign: Vec<f64>) -> Vec<f64> {
    if sign.iter().all(|x| [0.0, 1.0].contains(x) || x.is_nan()) {
        sign.iter_mut().for_each(|x| *x = 2.0 * *x - 1.0);
    }
    sign
}

/// Reference less position, rad or m; for a duty the mean error about the sample: a command is held until the next one, while the axis
/// moves on.
fn following_error(columns: &mut Columns, of_sign: bool) -> Result<Vec<f64>, Error> {
    let mut taken = |role: Role| columns.get_mut(role).map(|values| values.clone());
    let (Some(position), Some(reference)) = (taken(Role::Position), taken(Role::Reference)) else {
        let (what, setting) = match of_sign {
            true => ("the sign of the force", Role::Force.key("sign")),
            false => ("the duty of the servo", "servo".into()),
        };
        let found = format!("{what} follows from reference and position, and the log has not both");
        let allowed = "the commanded position under [columns]: reference = { column = \"NAME\", unit = \"rad\" }, with file = \"FILE\" if it is in another file";
        return Err(Error::new(Kind::Missing, found, allowed).of_setting(setting));
    };
    let before = |i: usize| match i {
        0 => reference[0],
        _ if of_sign => reference[i],
        _ => reference[i - 1],
    };
    let error = |(i, x): (usize, &f64)| 0.5 * (before(i) + reference[i]) - x;
    Ok(position.iter().enumerate().map(error).collect())
}
