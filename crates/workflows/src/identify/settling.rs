//! The part of a log in which what changes with time hardly does: a level of friction that has settled, clocks that have not come apart.

use crate::source::Source;
use stiction_files::result::Action;
use stiction_identify::Found;
use stiction_log::Log;
use stiction_number::short;
use stiction_policy::effect;

/// The only log, unless a part of it was chosen already.
fn whole(sources: &[Source]) -> Option<&Log> {
    let [source] = sources else { return None };
    let chosen = source.log.mapping.crop.is_some() || source.part.is_some();
    (!chosen).then_some(&source.log)
}

fn crop(from: f64, to: f64) -> Action {
    Action::Line {
        table: "log".into(),
        line: format!("crop = [\"{} s\", \"{} s\"]", short(from), short(to)),
        replaces: false,
    }
}

/// The line of the axis file that keeps the settled part of a log; `None` where there is none.
pub(super) fn part(drift: &Found, sources: &[Source]) -> Option<Action> {
    let log = whole(sources)?;
    let levels: Vec<f64> = drift.course.iter().map(|(_, level)| *level).collect();
    let first = settled_from(&levels)?;
    let (begin, to) = (*log.time.first()?, *log.time.last()?);
    let from = begin + (to - begin) * first as f64 / levels.len() as f64;
    // In tenths of a second, the end not cut off.
    let tenth = |x: f64| (10.0 * x).ceil() / 10.0;
    (to - from >= effect::MIN_CROP).then(|| crop(tenth(from), tenth(to + 0.05)))
}

/// The part at the beginning of the log within which a delay that grows so fast (s/s) hardly does; `None` where it is too short.
pub(super) fn before_the_clocks_part(drift: f64, sources: &[Source]) -> Option<Action> {
    let log = whole(sources)?;
    let (first, last) = (*log.time.first()?, *log.time.last()?);
    let part = (effect::MAX_CROP_DELAY_GROWTH / log.rate_hz / drift.abs()).floor();
    (part >= effect::MIN_CROP && part < last - first).then(|| crop(first, first + part))
}

/// From which of the means in order of time on the level has settled.
fn settled_from(levels: &[f64]) -> Option<usize> {
    let span = |levels: &[f64]| {
        let ends = levels
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
                (low.min(*x), high.max(*x))
            });
        ends.1 - ends.0
    };
    let whole = span(levels);
    let first =
        (1..levels.len()).find(|&i| span(&levels[i..]) <= effect::MAX_UNSETTLED_CHANGE * whole)?;
    let part = 1.0 - first as f64 / levels.len() as f64;
    (part >= effect::MIN_SETTLED_SHARE).then_some(first)
}

#[cfg(test)]
mod tests {
    use super::settled_from;

    fn course(level: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..16)
            .map(|i| level((f64::from(i) + 0.5) / 16.0))
            .collect()
    }

    #[test]
    fn what_goes_on_has_not_settled() {
        assert_eq!(settled_from(&course(|t| 0.1 - 0.2 * t)), None);
        assert_eq!(settled_from(&course(|t| 0.1 * libm::sin(20.0 * t))), None);
        assert_eq!(settled_from(&[]), None);
    }

    #[test]
    fn what_warms_up_settles() {
        let first = settled_from(&course(|t| 0.2 * libm::exp(-4.0 * t))).unwrap();
        assert!((4..8).contains(&first), "{first}");
    }
}
