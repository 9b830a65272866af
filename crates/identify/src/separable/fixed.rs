//! Columns of the regression that no parameter of the law changes: made once for all trials.

use crate::conditioning::record::{Record, Segment};
use crate::conditioning::shift::Shift;
use crate::law::terms::{ColumnKind, Side};
use std::sync::Arc;

/// A column of the regression at the kept samples; one that nothing changes is shared by all trials.
pub(crate) type Column = Arc<Vec<f64>>;

/// A known column of the regression.
#[derive(Clone, Debug)]
pub(super) enum Fixed {
    /// At the kept samples: without a delay it never changes.
    Thin(Column),
    /// At the full rate, filtered, for each segment: a delay moves it.
    Full(Vec<Vec<f64>>),
}

/// The columns that do not depend on the parameters of the law; `None` for those that do. All pass the common filter at
/// once.
pub(super) fn fixed_columns(
    record: &Record,
    kinds: &[ColumnKind],
    moves: bool,
) -> Vec<Option<Fixed>> {
    let stays = |kind: ColumnKind| kind == ColumnKind::One && !moves;
    let mut full: Vec<Option<Vec<Vec<f64>>>> = kinds
        .iter()
        .map(|&kind| full_column(record, kind).filter(|_| !stays(kind)))
        .collect();
    for i in 0..record.segments.len() {
        record.filter(full.iter_mut().flatten().map(|column| &mut column[i]));
    }
    let fixed = |(&kind, full): (&ColumnKind, Option<Vec<Vec<f64>>>)| {
        if stays(kind) {
            return Some(Fixed::Thin(Arc::new(vec![1.0; record.kept()])));
        }
        let full = full?;
        if moves {
            return Some(Fixed::Full(full));
        }
        let mut thin = Vec::new();
        for (segment, full) in record.segments.iter().zip(full) {
            record.thin_whole(segment, full, Shift::NONE, &mut thin);
        }
        Some(Fixed::Thin(Arc::new(thin)))
    };
    kinds.iter().zip(full).map(fixed).collect()
}

/// A column at the full rate, for each segment, before the common filter; `None` for one that the law makes.
fn full_column(record: &Record, column: ColumnKind) -> Option<Vec<Vec<f64>>> {
    let each = |f: &dyn Fn(&Segment) -> Vec<f64>| -> Vec<Vec<f64>> {
        record.segments.iter().map(f).collect()
    };
    let of = |x: &[f64], f: &dyn Fn(f64) -> f64| -> Vec<f64> { x.iter().map(|&x| f(x)).collect() };
    let one_way = |side: Option<Side>, v: f64| match side {
        Some(side) if !side.selects(v) => 0.0,
        _ => v,
    };
    Some(match column {
        ColumnKind::Level
        | ColumnKind::Element(_)
        | ColumnKind::Rate
        | ColumnKind::LevelTimes(..) => return None,
        ColumnKind::Sign(side) => each(&|s| {
            of(&s.velocity, &|v| {
                if side.selects(v) { v.signum() } else { 0.0 }
            })
        }),
        ColumnKind::Speed(side) => each(&|s| of(&s.velocity, &|v| one_way(side, v))),
        ColumnKind::Square(side) => each(&|s| of(&s.velocity, &|v| one_way(side, v) * v.abs())),
        ColumnKind::SpeedTimes(factor, side) => each(&|s| {
            let velocity = s.velocity.iter().map(|&v| one_way(side, v));
            velocity.zip(factor.along(s)).map(|(v, f)| v * f).collect()
        }),
        ColumnKind::Acceleration => each(&|s| s.acceleration.clone()),
        ColumnKind::One => each(&|s| vec![1.0; s.velocity.len()]),
        ColumnKind::Sine(rate) => each(&|s| of(&s.position, &|x| libm::sin(rate * x))),
        ColumnKind::Cosine(rate) => each(&|s| of(&s.position, &|x| libm::cos(rate * x))),
    })
}
