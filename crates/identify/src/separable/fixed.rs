//! Columns of the regression that no parameter of the law changes: made once for all trials.

use crate::conditioning::record::{Record, Segment};
use crate::conditioning::shift::Shift;
use crate::law::terms::{ColumnKind, Side};
use crate::separable::moving::Moving;
use std::borrow::Cow;
use std::sync::Arc;
use stiction_signal::Thinning;

/// A column of the regression at the kept samples; one that nothing changes is shared by all trials.
pub(crate) type Column = Arc<Vec<f64>>;

/// A known column of the regression.
#[derive(Clone, Debug)]
pub(super) enum Fixed {
    /// The same for all trials.
    Thin(Column),
    /// A fitted delay moves it: its number among those of [`Moving`].
    Moving(usize),
}

/// The columns that do not depend on the parameters of the law, at a shift that is known, else to be moved by a fitted one;
/// `None` for those that do.
pub(super) fn fixed_columns(
    record: &Record,
    kinds: &[ColumnKind],
    known: Option<Shift>,
    thinning: Option<&Thinning>,
) -> (Vec<Option<Fixed>>, Moving) {
    // No filter and no delay changes a constant.
    let varies = |kind: &ColumnKind| is_known(*kind) && *kind != ColumnKind::One;
    let varying: Vec<ColumnKind> = kinds.iter().copied().filter(varies).collect();
    let mut columns: Vec<Fixed> = match known {
        Some(shift) => {
            let columns = at_shift(record, &varying, shift, thinning).into_iter();
            columns
                .map(|column| Fixed::Thin(Arc::new(column)))
                .collect()
        }
        None => (0..varying.len()).map(Fixed::Moving).collect(),
    };
    columns.reverse();
    let fixed = kinds.iter().map(|kind| match kind {
        ColumnKind::One => Some(Fixed::Thin(Arc::new(vec![1.0; record.kept()]))),
        kind if is_known(*kind) => columns.pop(),
        _ => None,
    });
    (fixed.collect(), Moving::new(varying))
}

/// Known columns at the kept samples, taken earlier by a shift. All pass the common filter at once.
fn at_shift(
    record: &Record,
    kinds: &[ColumnKind],
    shift: Shift,
    thinning: Option<&Thinning>,
) -> Vec<Vec<f64>> {
    let mut out = vec![Vec::new(); kinds.len()];
    for segment in &record.segments {
        let full: Vec<Cow<[f64]>> = kinds
            .iter()
            .map(|kind| full_column(segment, *kind))
            .collect();
        if record.common.is_none() {
            for (out, full) in out.iter_mut().zip(full) {
                record.thin_whole(segment, full.into_owned(), shift, out);
            }
            continue;
        }
        let views: Vec<&[f64]> = full.iter().map(|full| &**full).collect();
        let kept = record.filtered(segment, &views, &[shift], thinning);
        for (out, kept) in out.iter_mut().zip(kept.into_iter().flatten()) {
            match out.is_empty() {
                true => *out = kept,
                false => out.extend(kept),
            }
        }
    }
    out
}

/// Whether no parameter of the law changes a column.
fn is_known(column: ColumnKind) -> bool {
    !matches!(
        column,
        ColumnKind::Level
            | ColumnKind::Element(_)
            | ColumnKind::Rate
            | ColumnKind::LevelTimes(..)
            | ColumnKind::RateTimes(_)
    )
}

/// A known column of a segment at the full rate, before the common filter; a column that the law makes is empty.
pub(super) fn full_column(segment: &Segment, column: ColumnKind) -> Cow<'_, [f64]> {
    let velocity = &segment.velocity;
    let of = |x: &[f64], f: &dyn Fn(f64) -> f64| -> Cow<'_, [f64]> {
        x.iter().map(|&x| f(x)).collect::<Vec<_>>().into()
    };
    let one_way = |side: Option<Side>, v: f64| match side {
        Some(side) if !side.selects(v) => 0.0,
        _ => v,
    };
    match column {
        ColumnKind::Level
        | ColumnKind::Element(_)
        | ColumnKind::Rate
        | ColumnKind::LevelTimes(..)
        | ColumnKind::RateTimes(_) => Cow::default(),
        ColumnKind::Sign(side) => of(velocity, &|v| {
            if side.selects(v) { v.signum() } else { 0.0 }
        }),
        ColumnKind::Speed(None) => velocity.into(),
        ColumnKind::Speed(side) => of(velocity, &|v| one_way(side, v)),
        ColumnKind::Square(side) => of(velocity, &|v| one_way(side, v) * v.abs()),
        ColumnKind::SpeedTimes(factor, side) => {
            let velocity = velocity.iter().map(|&v| one_way(side, v));
            let column = velocity.zip(factor.along(segment)).map(|(v, f)| v * f);
            column.collect::<Vec<_>>().into()
        }
        ColumnKind::Acceleration => (&segment.acceleration).into(),
        ColumnKind::One => vec![1.0; velocity.len()].into(),
        ColumnKind::Sine(rate) => of(&segment.position, &|x| libm::sin(rate * x)),
        ColumnKind::Cosine(rate) => of(&segment.position, &|x| libm::cos(rate * x)),
    }
}
