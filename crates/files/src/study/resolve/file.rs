//! Values over time from a file: `kind = "file"` of a path, a contour or a disturbance.

use super::entry::{MOST_SAMPLES, MOST_WAY};
use crate::config::{LARGEST_SI, Table};
use crate::error::{Error, Warning};
use crate::hash::Hash;
use std::path::{Path, PathBuf};
use stiction_codes::Code;
use stiction_formats::{Column, Dimension, Kind, ReadOptions, Unit, read_table_with};
use stiction_number::{four_digits as short, full};

/// Largest file, bytes.
const MOST_BYTES: u64 = 256 << 20;

/// Shortest time from one row to the next, s: a thousandth of the shortest control period.
const SHORTEST_STEP: f64 = 1e-9;

/// What the columns of a file are to be.
pub(super) struct Columns {
    /// A header for example.
    example: &'static str,
    /// What is needed, with their number.
    needed: &'static str,
}

/// Set points of one axis.
pub(super) const POSITION: Columns = Columns {
    example: "`t [s],x [mm]`",
    needed: "two: time and position",
};

/// Set points of two axes.
pub(super) const PLANE: Columns = Columns {
    example: "`t [s],x [mm]`",
    needed: "three: time, x and y",
};

/// A force.
pub(super) const FORCE: Columns = Columns {
    example: "`t [s],force [N]`",
    needed: "two: time and force",
};

/// Times, s, and values, SI, of the axes.
pub(super) struct Points<const AXES: usize> {
    pub times: Vec<f64>,
    pub axes: [Vec<f64>; AXES],
    pub file: PathBuf,
    /// Of exactly the bytes that were read, hexadecimal.
    pub sha256: String,
    pub warning: Option<Warning>,
}

/// The first columns of the file that the key `file` names: time, then a value of this dimension for each axis.
pub(super) fn points<const AXES: usize>(
    table: &Table<'_>,
    folder: &Path,
    dimension: Dimension,
    columns: &Columns,
) -> Result<Points<AXES>, Error> {
    let what = format!("a file with columns such as {}", columns.example);
    let given = table.required("file", table.get("file"), &what)?;
    let file = folder.join(given.path(&what)?);
    if let Some(bytes) = std::fs::metadata(&file).ok().map(|about| about.len())
        && bytes > MOST_BYTES
    {
        let found = format!("{}: a file of {bytes} bytes", file.display());
        let allowed = format!("at most {MOST_BYTES} bytes");
        return Err(given.refuse_as(Code::LogLimit, found, &allowed));
    }
    let mut hash = Hash::default();
    let read = read_table_with(&file, &ReadOptions::default(), |bytes| hash.take(bytes));
    let read = read.map_err(|e| match e.kind {
        Kind::Io => given.refuse(
            format!("{}: {}", file.display(), e.found),
            &format!("give the path of {what}"),
        ),
        code => {
            let mut found = e;
            let allowed = std::mem::take(&mut found.allowed);
            given.refuse_as(code.code(), found.to_string(), &allowed)
        }
    })?;
    let refuse = |place: String, found: String, allowed: &str| {
        given.refuse(format!("{}: {place}{found}", file.display()), allowed)
    };
    if read.columns.len() < 1 + AXES {
        let found = format!("{} columns of numbers", read.columns.len());
        return Err(refuse(String::new(), found, columns.needed));
    }
    if read.rows() > MOST_SAMPLES {
        let found = format!("{} rows", read.rows());
        return Err(refuse(
            String::new(),
            found,
            &format!("at most {MOST_SAMPLES}"),
        ));
    }
    let lengths = [Dimension::LENGTH, Dimension::ANGLE];
    let si = |i: usize, dimension: Dimension| -> Result<Vec<f64>, Error> {
        let column = &read.columns[i];
        let place = |row: usize| format!("data row {}, column {}: ", row + 1, named(column, i));
        let unit = match &column.unit {
            None => Unit::si(dimension),
            Some(text) => Unit::parse(text).map_err(|e| {
                let place = format!("column {}: ", named(column, i));
                refuse(place, e.found, &e.allowed)
            })?,
        };
        if unit.dimension() != dimension {
            let allowed = format!("a {} such as {}", dimension.name(), dimension.si_text());
            let place = format!("column {}: ", named(column, i));
            return Err(refuse(place, format!("unit {}", unit.text()), &allowed));
        }
        let values: Vec<f64> = column.values.iter().map(|x| unit.to_si(*x)).collect();
        let most = if lengths.contains(&dimension) {
            MOST_WAY
        } else {
            LARGEST_SI
        };
        let large = |x: &f64| x.is_finite() && x.abs() > most;
        if let Some(row) = values.iter().position(large) {
            let is = dimension.si_text();
            let found = format!("{} {is}", short(values[row]));
            let allowed = format!("from -{most:e} to {most:e} {is}");
            return Err(refuse(place(row), found, &allowed));
        }
        match values.iter().position(|x| !x.is_finite()) {
            Some(row) => Err(refuse(
                place(row),
                "no number".into(),
                "a number in every row",
            )),
            None if values.len() < read.rows() => Err(refuse(
                place(values.len()),
                "is missing".into(),
                "a number in every row",
            )),
            None => Ok(values),
        }
    };
    let times = si(0, Dimension::TIME)?;
    if times.len() < 2 {
        return Err(refuse(
            String::new(),
            format!("{} rows", times.len()),
            "at least two",
        ));
    }
    let rises = |pair: &[f64]| pair[1] - pair[0] >= SHORTEST_STEP;
    if let Some(row) = times.windows(2).position(|pair| !rises(pair)) {
        let place = format!(
            "data row {}, column {}: ",
            row + 2,
            named(&read.columns[0], 0)
        );
        let found = format!("{} s", full(times[row + 1]));
        let allowed = "later than the row before, by 1 ns at least";
        return Err(refuse(place, found, allowed));
    }
    let mut axes = [const { Vec::new() }; AXES];
    for (i, axis) in axes.iter_mut().enumerate() {
        *axis = si(1 + i, dimension)?;
    }
    let bare = read.columns[..=AXES]
        .iter()
        .enumerate()
        .filter(|(_, c)| c.unit.is_none());
    let bare: Vec<String> = bare.map(|(i, column)| named(column, i)).collect();
    let warning = (!bare.is_empty()).then(|| {
        let columns = bare.join(", ");
        let message = format!(
            "{}: no unit at {columns}; taken as s and {}",
            file.display(),
            dimension.si_text()
        );
        Warning::new(Code::UnitAssumed, message)
    });
    Ok(Points {
        times,
        axes,
        file,
        sha256: hash.finish(),
        warning,
    })
}

/// A column by its name, or by its place where it has none.
fn named(column: &Column, i: usize) -> String {
    match column.name.trim() {
        "" => (i + 1).to_string(),
        name => format!("{name:?}"),
    }
}
