//! What is sent to be drawn: numbers as they are in memory, in the units that are shown, little-endian, nothing to parse.

use super::{Channel, Series};
use crate::pyramid::Tiles;
use crate::refused::Refused;
use crate::units::Shown;

/// Most pixels that are asked for at once.
const MOST_PIXELS: usize = 8192;
/// Most points of a map.
const MOST_POINTS: usize = 6000;

/// Channels from one time to another, for a screen of so many pixels.
///
/// Four 32-bit numbers: how many tiles there are, how many channels, whether they are single samples, 0. Then as 64-bit floats
/// the times of the tiles, and of each channel its values where they are single, and else all lowest, then all highest ones.
pub fn tiles(
    series: &Series,
    names: &[&str],
    (from, to): (f64, f64),
    pixels: usize,
) -> Result<Vec<u8>, Refused> {
    let channels = names.iter().map(|name| {
        let missing = || Refused::missing(format!("{name}: no such channel"));
        series.channel(name).ok_or_else(missing)
    });
    let channels: Vec<&Channel> = channels.collect::<Result<_, _>>()?;
    let tiles = Tiles::of(series.range(from, to), pixels.min(MOST_PIXELS));
    let single = tiles.size == 1;
    let count = tiles.ranges().count();
    let columns = 1 + channels.len() * if single { 1 } else { 2 };
    let mut out = Vec::with_capacity(16 + 8 * count * columns);
    for number in [count, channels.len(), usize::from(single), 0] {
        out.extend((number as u32).to_le_bytes());
    }
    let mut put = |value: f64| out.extend(value.to_le_bytes());
    tiles
        .ranges()
        .for_each(|range| put(series.time[range.start]));
    for channel in channels {
        let shown = Shown::of(&channel.unit);
        let mut put = |value: f64| put(shown.number(value));
        if single {
            channel.values[tiles.start..tiles.end]
                .iter()
                .copied()
                .for_each(put);
            continue;
        }
        let span = |range| channel.pyramid.span(&channel.values, range);
        let spans: Vec<_> = tiles.ranges().map(span).collect();
        spans.iter().for_each(|(low, _)| put(*low));
        spans.iter().for_each(|(_, high)| put(*high));
    }
    Ok(out)
}

/// What is mapped of a log.
pub const MAPPED: [&str; 3] = ["velocity", "force", "position"];
/// Most channels of a map.
const MOST_MAPPED: usize = 16;

/// A step of the time that is so many times the usual one is a gap.
const GAP: f64 = 10.0;

/// Channels of a stretch, every n-th sample of it; what the log lacks, and a point at each gap of the time, is not a number.
///
/// Two 32-bit numbers: how many points there are, and how many samples apart they are. Then the columns as 64-bit floats.
pub fn map(series: &Series, names: &[&str], (from, to): (f64, f64)) -> Vec<u8> {
    let start = series.time.partition_point(|t| *t < from);
    let end = series.time.partition_point(|t| *t <= to).max(start);
    let step = (end - start).div_ceil(MOST_POINTS).max(1);
    let points = points(series.time.get(start..end).unwrap_or(&[]), step);
    let count = points.len();
    let names = &names[..names.len().min(MOST_MAPPED)];
    let mut out = Vec::with_capacity(8 + 8 * names.len() * count);
    for number in [count, step] {
        out.extend((number as u32).to_le_bytes());
    }
    for name in names {
        let channel = series.channel(name);
        for point in &points {
            let at = point.map(|point| start + point);
            let value = channel.and_then(|own| {
                let value = own.values.get(at?)?;
                Some(Shown::of(&own.unit).number(*value))
            });
            out.extend(value.unwrap_or(f64::NAN).to_le_bytes());
        }
    }
    out
}

/// Every n-th of some samples, with nothing between two that have a gap between them.
fn points(time: &[f64], step: usize) -> Vec<Option<usize>> {
    let all: Vec<usize> = (0..time.len()).step_by(step).collect();
    let far = |pair: &[usize]| time[pair[1]] - time[pair[0]];
    let mut steps: Vec<f64> = all.windows(2).map(far).collect();
    let middle = steps.len() / 2;
    let usual = match steps.is_empty() {
        true => f64::INFINITY,
        false => *steps.select_nth_unstable_by(middle, f64::total_cmp).1,
    };
    let mut out = Vec::with_capacity(all.len());
    for (k, at) in all.iter().enumerate() {
        if k > 0 && time[*at] - time[all[k - 1]] > GAP * usual {
            out.push(None);
        }
        out.push(Some(*at));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::{MAPPED, map, tiles};
    use crate::logs::{Channel, Series};
    use crate::pyramid::Pyramid;

    fn series(samples: usize) -> Series {
        let values: Vec<f64> = (0..samples).map(|k| (0.01 * k as f64).sin()).collect();
        let channel = |name: &str| Channel {
            name: name.into(),
            unit: "m".into(),
            derived: false,
            pyramid: Pyramid::new(&values),
            values: values.clone(),
        };
        Series {
            time: (0..samples).map(|k| 1e-3 * k as f64).collect(),
            channels: vec![channel("position"), channel("force")],
        }
    }

    #[test]
    fn a_gap_of_the_time_breaks_a_map() {
        let mut series = series(1000);
        series.time[500..].iter_mut().for_each(|t| *t += 0.5);
        let points = map(&series, &["position"], (0.0, 2.0));
        let count = u32::from_le_bytes(points[..4].try_into().unwrap()) as usize;
        let missing: Vec<usize> = (0..count)
            .filter(|k| number(&points, 8 + 8 * k).is_nan())
            .collect();
        assert_eq!((count, missing), (1001, vec![500]));
    }

    fn number(bytes: &[u8], at: usize) -> f64 {
        f64::from_le_bytes(bytes[at..at + 8].try_into().unwrap())
    }

    #[test]
    fn tiles_are_spans_or_samples() {
        let series = series(100_000);
        let all = tiles(&series, &["position", "force"], (0.0, 1e9), 1000).unwrap();
        let count = u32::from_le_bytes(all[..4].try_into().unwrap()) as usize;
        assert!((500..=1001).contains(&count), "{count}");
        assert_eq!(all.len(), 16 + 8 * count * 5);
        let near = tiles(&series, &["force"], (50.0, 50.5), 1000).unwrap();
        assert_eq!(near[8], 1);
        assert_eq!(number(&near, 16), 49.999);
        assert!(tiles(&series, &["none"], (0.0, 1.0), 100).is_err());
        // Nothing at all, and what is no interval.
        for part in [(200.0, 300.0), (5.0, 1.0), (f64::NAN, f64::NAN)] {
            assert!(tiles(&series, &["force"], part, 100).unwrap().len() < 64);
        }
    }

    #[test]
    fn a_map_has_what_there_is() {
        let points = map(&series(100_000), &MAPPED, (10.0, 20.0));
        let count = u32::from_le_bytes(points[..4].try_into().unwrap()) as usize;
        assert!((4000..=6000).contains(&count), "{count}");
        assert!(number(&points, 8).is_nan());
        assert!(number(&points, 8 + 8 * count).is_finite());
    }
}
