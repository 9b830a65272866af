//! An axis: what it shows, in which unit, over which range; and its map from data to the plot.

use crate::text::Text;

/// How values are spread along an axis.
#[derive(Debug, Clone, PartialEq)]
pub enum Scale {
    /// Proportional.
    Linear,
    /// By powers of ten. Values that are not positive have no place and are left out.
    Log,
    /// One name at each of 0, 1, 2, ...; the first name is at the left or at the top.
    Names(Vec<Text>),
}

/// The part of an axis that is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Range {
    /// All finite values of the layers, with a little room.
    Auto,
    /// From one value to another, whichever is smaller; [`Range::Auto`] when that is no range
    /// (not finite, or not positive on a logarithmic axis).
    Fixed(f64, f64),
}

/// One axis of a panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// The quantity, such as "Velocity".
    pub label: Text,
    /// The unit of the data, such as `m/s`; empty for a number. Figures put an SI prefix before it
    /// where that gives shorter tick labels.
    pub unit: String,
    /// How values are spread.
    pub scale: Scale,
    /// The part shown.
    pub range: Range,
}

impl Axis {
    /// A linear axis over all data.
    pub fn new(label: impl Into<Text>, unit: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            unit: crate::number::unit(&unit.into()),
            scale: Scale::Linear,
            range: Range::Auto,
        }
    }

    /// An axis with a name at each whole number from 0.
    pub fn names<T: Into<Text>>(names: impl IntoIterator<Item = T>) -> Self {
        let scale = Scale::Names(names.into_iter().map(Into::into).collect());
        Self {
            scale,
            ..Self::new("", "")
        }
    }

    /// Makes it logarithmic.
    pub fn log(mut self) -> Self {
        self.scale = Scale::Log;
        self
    }

    /// Fixes the part shown.
    pub fn range(mut self, low: f64, high: f64) -> Self {
        self.range = Range::Fixed(low, high);
        self
    }
}

/// The map from data values to 0 ... 1 along an axis. Both ends are finite, apart by more than
/// rounding, and positive when logarithmic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Map {
    pub low: f64,
    pub high: f64,
    pub log: bool,
    /// Low values last (names from top to bottom).
    flipped: bool,
    /// What the value, or its logarithm, is divided by before it is placed, so that the span of
    /// the largest numbers does not overflow; then the two ends.
    divisor: f64,
    ends: (f64, f64),
}

impl Map {
    /// The map of `axis` whose layers span `data` (none when they hold no value that can be shown);
    /// `room` is the share of the span left free at either end.
    pub fn new(axis: &Axis, data: Option<(f64, f64)>, room: f64, is_y: bool) -> Self {
        let fixed = match axis.range {
            Range::Fixed(a, b) => usable(a, b, axis.scale == Scale::Log),
            Range::Auto => None,
        };
        match &axis.scale {
            Scale::Names(names) => Self {
                flipped: is_y,
                ..Self::linear(-0.5, names.len().max(1) as f64 - 0.5)
            },
            Scale::Linear => {
                let (low, high) = fixed
                    .map(|(low, high)| widened(low, high))
                    .or_else(|| data.map(|(low, high)| with_room(low, high, room, is_y)))
                    .unwrap_or((0.0, 1.0));
                Self::linear(low, high)
            }
            Scale::Log => {
                let (low, high) = fixed
                    .filter(|(low, high)| libm::log10(*high) - libm::log10(*low) > 1e-6)
                    .or_else(|| data.map(|(low, high)| with_log_room(low, high, room)))
                    .unwrap_or((1.0, 10.0));
                let ends = (libm::log10(low), libm::log10(high));
                Self {
                    log: true,
                    divisor: 1.0,
                    ends,
                    ..Self::linear(low, high)
                }
            }
        }
    }

    fn linear(low: f64, high: f64) -> Self {
        let divisor = if (high - low).is_finite() { 1.0 } else { 2.0 };
        let ends = (low / divisor, high / divisor);
        Self {
            low,
            high,
            log: false,
            flipped: false,
            divisor,
            ends,
        }
    }

    /// 0 at the low end, 1 at the high end, beyond outside; NaN for what has no place.
    pub fn place(&self, value: f64) -> f64 {
        let value = match self.log {
            true if value <= 0.0 => f64::NAN,
            true => libm::log10(value),
            false => value / self.divisor,
        };
        let t = (value - self.ends.0) / (self.ends.1 - self.ends.0);
        if self.flipped { 1.0 - t } else { t }
    }
}

fn usable(a: f64, b: f64, log: bool) -> Option<(f64, f64)> {
    let (low, high) = (a.min(b), a.max(b));
    (a.is_finite() && b.is_finite() && (!log || low > 0.0)).then_some((low, high))
}

/// A range that can be divided: a constant gets 5 % of itself on both sides.
fn widened(low: f64, high: f64) -> (f64, f64) {
    let size = low.abs().max(high.abs());
    if high / 2.0 - low / 2.0 > 1e-12 * size && high - low > 1e-300 {
        return (low, high);
    }
    let half = if size > 1e-290 { 0.05 * size } else { 1.0 };
    (finite(low - half), finite(high + half))
}

/// What ends at zero may stay there: bars then stand on the axis.
fn with_room(low: f64, high: f64, room: f64, from_zero: bool) -> (f64, f64) {
    let (low, high) = widened(low, high);
    let room = room * (high / 2.0 - low / 2.0) * 2.0;
    let outwards = |end: f64, room: f64| {
        if end == 0.0 && from_zero {
            0.0
        } else {
            finite(end + room)
        }
    };
    (outwards(low, -room), outwards(high, room))
}

fn with_log_room(low: f64, high: f64, room: f64) -> (f64, f64) {
    let (a, b) = (libm::log10(low), libm::log10(high));
    let room = if b - a > 1e-6 { room * (b - a) } else { 0.5 };
    let power = |e: f64| libm::exp10(e).clamp(f64::from_bits(1), f64::MAX);
    (power(a - room), power(b + room))
}

fn finite(value: f64) -> f64 {
    value.clamp(-f64::MAX, f64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(map: Map) {
        assert!(
            map.low.is_finite() && map.high.is_finite() && map.low < map.high,
            "{map:?}"
        );
        assert_eq!(
            (map.place(map.low), map.place(map.high)),
            (0.0, 1.0),
            "{map:?}"
        );
    }

    #[test]
    fn every_span_gives_a_map() {
        let linear = Axis::new("x", "m");
        let edges = [0.0, 1e-320, 1e-300, 1.0, 1.0 + 1e-15, 1e300, f64::MAX];
        for a in edges {
            for b in edges {
                for (low, high) in [(a.min(b), a.max(b)), (-a, b), (-a.max(b), -a.min(b))] {
                    check(Map::new(&linear, Some((low, high)), 0.05, false));
                    check(Map::new(&linear.clone().range(low, high), None, 0.0, false));
                    if low > 0.0 {
                        check(Map::new(
                            &linear.clone().log(),
                            Some((low, high)),
                            0.05,
                            false,
                        ));
                    }
                }
            }
        }
        check(Map::new(&linear, None, 0.05, false));
    }

    #[test]
    fn impossible_fixed_ranges_fall_back_to_the_data() {
        let data = Some((1.0, 100.0));
        for (a, b) in [(f64::NAN, 1.0), (0.0, f64::INFINITY)] {
            let map = Map::new(&Axis::new("", "").range(a, b), data, 0.0, false);
            assert_eq!((map.low, map.high), (1.0, 100.0));
        }
        let map = Map::new(&Axis::new("", "").log().range(-1.0, 10.0), data, 0.0, false);
        assert!(
            (map.low - 1.0).abs() < 1e-12 && (map.high - 100.0).abs() < 1e-9,
            "{map:?}"
        );
        let map = Map::new(&Axis::new("", "").range(3.0, -1.0), data, 0.0, false);
        assert_eq!((map.low, map.high), (-1.0, 3.0));
    }

    #[test]
    fn logarithmic_place_is_by_decades() {
        let map = Map::new(
            &Axis::new("", "").log().range(0.01, 100.0),
            None,
            0.0,
            false,
        );
        for (value, place) in [(0.01, 0.0), (0.1, 0.25), (1.0, 0.5), (100.0, 1.0)] {
            assert!((map.place(value) - place).abs() < 1e-15);
        }
        assert!(map.place(0.0).is_nan() && map.place(-1.0).is_nan());
    }
}
