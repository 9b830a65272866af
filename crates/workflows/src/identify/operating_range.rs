//! The ranges of what friction and the forces beside it depend on, the pitches of their waves, the level along the stroke.

use crate::source::Source;
use stiction_files::result::{LevelAlongEntry, PitchEntry, RangeEntry};
use stiction_identify::{FittedLaw, LevelAlong, Series, Terms};
use stiction_log::Log;
use stiction_parameters::{Name, Quantity};
use stiction_policy::conditioning;

/// What the samples that were fitted have seen.
pub(super) fn range(sources: &[Source], series: &Series, terms: &Terms) -> RangeEntry {
    let of = |column: fn(&Log) -> Option<&Vec<f64>>| {
        let logs = sources.iter().map(|source| &source.log);
        let values = logs.flat_map(|log| column(log).into_iter().flat_map(|x| fitted(log, x)));
        values.fold(None, |range: Option<[f64; 2]>, x| match range {
            None => Some([x, x]),
            Some([low, high]) => Some([x.min(low), x.max(high)]),
        })
    };
    RangeEntry {
        position: of(|log| log.position.as_ref()),
        wrap: sources.iter().find_map(|source| source.log.wrap),
        load: of(|log| log.load.as_ref()),
        temperature: of(|log| log.temperature.as_ref()),
        transmitted: transmitted(sources, terms),
        acceleration: acceleration(series),
        speed: None,
    }
}

/// The size of what is transmitted, where friction depends on it.
fn transmitted(sources: &[Source], terms: &Terms) -> Option<[f64; 2]> {
    let of = terms.transmitted()?;
    let along = |log: &Log| {
        let [position, external] = [&log.position, &log.external].map(|x| x.as_deref());
        of.of(position.unwrap_or_default(), external.unwrap_or_default())
    };
    let mut range: Option<[f64; 2]> = None;
    for source in sources {
        let along = along(&source.log);
        for tau in fitted(&source.log, &along).map(f64::abs) {
            let [low, high] = range.unwrap_or([tau, tau]);
            range = Some([low.min(tau), high.max(tau)]);
        }
    }
    range
}

/// A column where nothing excludes it.
fn fitted<'a>(log: &'a Log, column: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
    let out = |i: usize| log.excluded.iter().any(|part| part.samples.contains(&i));
    let each = column.iter().copied().enumerate();
    each.filter(move |(i, _)| !out(*i)).map(|(_, x)| x)
}

/// The largest acceleration, m/s^2 or rad/s^2, by central differences within a log.
fn acceleration(series: &Series) -> Option<f64> {
    let (t, v) = (&series.time, &series.velocity);
    let step = t.windows(2).map(|t| t[1] - t[0]).find(|step| *step > 0.0)?;
    let inside = |i: &usize| {
        let span = t[i + 1] - t[i - 1];
        let one = series.log.get(i - 1) == series.log.get(i + 1);
        one && span > 0.0 && span <= 2.0 * conditioning::MAX_STEP * step
    };
    let inner = (1..t.len().saturating_sub(1)).filter(inside);
    let largest = inner
        .map(|i| ((v[i + 1] - v[i - 1]) / (t[i + 1] - t[i - 1])).abs())
        .fold(0.0, f64::max);
    (largest > 0.0 && largest.is_finite()).then_some(largest)
}

/// The pitches of the waves that were fitted.
pub(super) fn pitch(terms: &Terms) -> PitchEntry {
    PitchEntry {
        cogging: terms.cogging.clone(),
        coulomb: terms.level_pitches(),
    }
}

/// The level along the stroke, where it has a line or a map.
pub(super) fn level_along(law: &FittedLaw) -> Vec<LevelAlongEntry> {
    let entry = |along: LevelAlong| LevelAlongEntry {
        name: Name::new(Quantity::Coulomb, along.side).to_string(),
        position: along.position,
        level: along.level,
        low: along.low,
        high: along.high,
    };
    law.level_along().into_iter().map(entry).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_acceleration_is_that_within_a_log() {
        let series = Series {
            log: vec![0, 0, 0, 1, 1, 1],
            time: vec![0.0, 0.1, 0.2, 0.0, 0.1, 0.2],
            velocity: vec![0.0, 0.2, 0.4, -9.0, -9.1, -9.2],
            ..Series::default()
        };
        let found = acceleration(&series).unwrap();
        assert!((found - 2.0).abs() < 1e-12, "{found}");
        assert_eq!(acceleration(&Series::default()), None);
    }
}
