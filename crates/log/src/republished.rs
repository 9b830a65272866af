//! Rows of a robot's log that were sent again: a publisher whose rate is above that of its source repeats a reading now and then,
//! and stamps all rows with its own clock.

use crate::Table;
use crate::mapping::JointColumns;
use crate::{Role, Selector};
use stiction_policy::clock;

/// A table without the rows that repeat the one before, its rows evenly in time as their source has read them.
#[derive(Clone, Debug, PartialEq)]
pub struct Republished {
    /// The table.
    pub table: Table,
    /// How many rows were repeats.
    pub repeats: usize,
    /// Rate of the source, Hz.
    pub rate_hz: f64,
}

/// Takes repeated rows out of a table with the columns of joints; `None` where there are none, or where the logged velocities do not
/// agree clearly better with the positions afterwards. `time` is the column of the time stamps.
pub fn republished(table: &Table, time: usize, joints: &[JointColumns]) -> Option<Republished> {
    let column = |own: &JointColumns, role: Role| {
        let (_, channel) = own.iter().find(|(found, _)| *found == role)?;
        match channel.column {
            Selector::Index(number) => table.index(number),
            Selector::Name(_) => None,
        }
    };
    let of =
        |role: Role| -> Vec<Option<usize>> { joints.iter().map(|own| column(own, role)).collect() };
    let (positions, velocities) = (of(Role::Position), of(Role::Velocity));
    let moved: Vec<&[f64]> = [&positions, &velocities, &of(Role::Force)]
        .into_iter()
        .flatten()
        .flatten()
        .map(|column| table.columns[*column].values.as_slice())
        .collect();
    let rows = moved.iter().map(|values| values.len()).min()?;
    let stamps = table.columns[time].values.get(..rows)?;
    let repeats = |row: usize| {
        row > 0
            && moved
                .iter()
                .all(|x| x[row].to_bits() == x[row - 1].to_bits())
    };
    let kept: Vec<usize> = (0..rows).filter(|row| !repeats(*row)).collect();
    let count = rows - kept.len();
    let most = clock::MAX_REPEATED_SHARE * rows as f64;
    if count < clock::MIN_REPEATED_ROWS || count as f64 > most {
        return None;
    }
    let (first, last) = (stamps[kept[0]], stamps[*kept.last()?]);
    let step = (last - first) / (kept.len() - 1) as f64;
    let even: Vec<f64> = (0..kept.len()).map(|k| first + step * k as f64).collect();
    let pairs: Vec<[&[f64]; 2]> = positions
        .iter()
        .zip(&velocities)
        .filter_map(|(q, dq)| Some([(*q)?, (*dq)?].map(|c| table.columns[c].values.as_slice())))
        .collect();
    let all: Vec<usize> = (0..rows).collect();
    let before = slip(&pairs, &all, stamps);
    let after = slip(&pairs, &kept, &even);
    if after.is_nan() || after >= clock::MAX_REPEATED_SLIP * before {
        return None;
    }
    let columns = table.columns.iter().enumerate().map(|(at, own)| {
        let mut own = own.clone();
        own.values = match at == time {
            true => even.clone(),
            false => {
                let rows = kept.iter().filter_map(|row| own.values.get(*row));
                rows.copied().collect()
            }
        };
        own
    });
    Some(Republished {
        repeats: count,
        rate_hz: 1.0 / step,
        table: Table {
            columns: columns.collect(),
            starts: table.starts_among(&kept),
            ..table.clone()
        },
    })
}

/// Mean square of the difference of logged velocities and differences of the positions, over that of the velocities.
fn slip(pairs: &[[&[f64]; 2]], rows: &[usize], time: &[f64]) -> f64 {
    let (mut off, mut all) = (0.0, 0.0);
    for [position, velocity] in pairs {
        for k in 1..rows.len().saturating_sub(1) {
            let slope =
                (position[rows[k + 1]] - position[rows[k - 1]]) / (time[k + 1] - time[k - 1]);
            if slope.is_finite() && velocity[rows[k]].is_finite() {
                off += (slope - velocity[rows[k]]).powi(2);
                all += velocity[rows[k]].powi(2);
            }
        }
    }
    off / all
}
