//! Positions and labels of the ticks of an axis.

use super::axis::{Axis, Map, Scale};
use crate::text::Text;
use stiction_number::{exponent, plain, prefixed, superscript, ten, times_ten};

/// The ticks of one axis.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ticks {
    /// Places with a label.
    pub labelled: Vec<(f64, Text)>,
    /// Places between them with a fainter line.
    pub minor: Vec<f64>,
    /// The title of the axis: quantity and unit, with the power of ten taken out of the labels.
    pub title: Text,
}

impl Ticks {
    /// About `most` labelled ticks or fewer, at least two where there is a range.
    pub fn new(axis: &Axis, map: &Map, most: usize) -> Self {
        let most = most.clamp(2, 40);
        match &axis.scale {
            Scale::Names(names) => Self {
                labelled: names
                    .iter()
                    .enumerate()
                    .map(|(i, n)| (i as f64, n.clone()))
                    .collect(),
                minor: Vec::new(),
                title: titled(&axis.label, &axis.unit),
            },
            Scale::Linear => linear(axis, map.low, map.high, most),
            Scale::Log => {
                let (a, b) = (libm::log10(map.low), libm::log10(map.high));
                if b - a < 0.7 {
                    linear(axis, map.low, map.high, most)
                } else {
                    log(axis, map, (a.ceil() as i32, b.floor() as i32), most)
                }
            }
        }
    }
}

fn titled(label: &Text, unit: &str) -> Text {
    if unit.is_empty() {
        label.clone()
    } else {
        label.clone().plain(format!(" ({unit})"))
    }
}

/// Multiples of 1, 2 or 5 times a power of ten. The labels are made from the integers, so they are
/// exact whatever the range.
fn linear(axis: &Axis, low: f64, high: f64, most: usize) -> Ticks {
    let (mut unit_step, mut power) = first_step(high / most as f64 - low / most as f64);
    let ends = |unit_step: i64, power: i32| {
        let step = parse(unit_step, power);
        // An end that is a tick up to rounding counts as one.
        ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor())
    };
    let (mut first, mut last) = ends(unit_step, power);
    while last - first + 1.0 > most as f64 {
        let (coarser, coarser_power) = match unit_step {
            1 => (2, power),
            2 => (5, power),
            _ => (1, power + 1),
        };
        let coarse = ends(coarser, coarser_power);
        // A single tick shows no scale: rather one too many.
        if coarse.1 - coarse.0 < 1.0 {
            break;
        }
        (unit_step, power, first, last) = (coarser, coarser_power, coarse.0, coarse.1);
    }
    let taken_out = power_taken_out(low.abs().max(high.abs()), &axis.unit);
    let labelled = (first as i64..=last as i64)
        .map(|k| {
            let whole = k * unit_step;
            let digits = plain(&whole.unsigned_abs().to_string(), power - taken_out);
            let digits = if whole == 0 {
                plain("0", (power - taken_out).min(0))
            } else {
                digits
            };
            let sign = if whole < 0 { "−" } else { "" };
            (parse(whole, power), Text::from(format!("{sign}{digits}")))
        })
        .collect();
    let title = match prefixed(&axis.unit, taken_out) {
        _ if taken_out == 0 => titled(&axis.label, &axis.unit),
        Some(unit) => titled(&axis.label, &unit),
        None => {
            let factor = times_ten(taken_out);
            let space = if axis.unit.is_empty() { "" } else { " " };
            titled(&axis.label, &format!("{factor}{space}{}", axis.unit))
        }
    };
    Ticks {
        labelled,
        minor: Vec::new(),
        title,
    }
}

fn first_step(raw: f64) -> (i64, i32) {
    let power = exponent(raw);
    let lead = raw / ten(power) * (1.0 - 1e-9);
    match lead {
        l if l <= 1.0 => (1, power),
        l if l <= 2.0 => (2, power),
        l if l <= 5.0 => (5, power),
        _ => (1, power + 1),
    }
}

fn parse(whole: i64, power: i32) -> f64 {
    format!("{whole}e{power}").parse().unwrap_or(f64::NAN)
}

/// The power of ten, a multiple of three, that makes labels short: none while they are short
/// already.
fn power_taken_out(largest: f64, unit: &str) -> i32 {
    let largest = exponent(largest);
    let power = 3 * largest.div_euclid(3);
    let takes_prefix = prefixed(unit, power).is_some();
    let short = if takes_prefix { -1..4 } else { -2..5 };
    if short.contains(&largest) { 0 } else { power }
}

/// Decades; when there are few, also 2 and 5 between them, and fainter lines at every digit.
fn log(axis: &Axis, map: &Map, (first, last): (i32, i32), most: usize) -> Ticks {
    let decades = (last - first + 1).max(0) as usize;
    let every = [1, 2, 3, 5, 10, 20, 30, 50, 100, 200, 500]
        .into_iter()
        .find(|every| decades.div_ceil(*every) <= most)
        .unwrap_or(1000) as i32;
    let inside = |value: f64| (map.low..=map.high).contains(&value);
    let mut labelled: Vec<(f64, Text)> = Vec::new();
    let mut minor = Vec::new();
    let digits: &[i64] = match decades {
        0..=2 if most >= 3 * decades.max(1) => &[1, 2, 5],
        _ => &[1],
    };
    let in_powers = first < -3 || last > 3;
    for power in first - 1..=last {
        for digit in 1..10 {
            let value = parse(digit, power);
            if !inside(value) || value == 0.0 {
                continue;
            }
            if digits.contains(&digit) && power.rem_euclid(every) == 0 {
                labelled.push((value, log_label(digit, power, in_powers)));
            } else if 2 * decades <= most {
                minor.push(value);
            }
        }
    }
    Ticks {
        labelled,
        minor,
        title: titled(&axis.label, &axis.unit),
    }
}

fn log_label(digit: i64, power: i32, in_powers: bool) -> Text {
    if !in_powers || power == 0 || power == 1 {
        return plain(&digit.to_string(), power).into();
    }
    let factor = if digit == 1 {
        String::new()
    } else {
        format!("{digit}·")
    };
    format!("{factor}10{}", superscript(power)).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ticks(axis: Axis, low: f64, high: f64, most: usize) -> (String, String) {
        let axis = axis.range(low, high);
        let map = Map::new(&axis, None, 0.0, false);
        let ticks = Ticks::new(&axis, &map, most);
        assert!((2..=most).contains(&ticks.labelled.len()), "{ticks:?}");
        let labels: Vec<_> = ticks.labelled.iter().map(|(_, l)| l.to_plain()).collect();
        (labels.join(" "), ticks.title.to_plain())
    }

    #[test]
    fn linear_labels_are_round_and_exact() {
        let t = |low, high| ticks(Axis::new("v", "m/s"), low, high, 6);
        assert_eq!(t(-0.3, 0.3), ("−0.2 0.0 0.2".into(), "v (m/s)".into()));
        assert_eq!(t(0.0, 1.0).0, "0.0 0.2 0.4 0.6 0.8 1.0");
        assert_eq!(
            t(0.0, 0.002),
            ("0.0 0.5 1.0 1.5 2.0".into(), "v (mm/s)".into())
        );
        assert_eq!(t(-4.1e6, 0.0), ("−4 −3 −2 −1 0".into(), "v (Mm/s)".into()));
        assert_eq!(
            t(999.9995, 1000.0005).0,
            "999.9996 999.9998 1000.0000 1000.0002 1000.0004"
        );
    }

    #[test]
    fn units_without_prefix_get_a_power_of_ten() {
        let t = |unit: &str, low, high| ticks(Axis::new("a", unit), low, high, 5).1;
        assert_eq!(t("kg", 0.0, 3e-4), "a (×10⁻⁶ kg)");
        assert_eq!(t("", 0.0, 2e7), "a (×10⁶)");
        assert_eq!(t("%", 0.0, 40.0), "a (%)");
        assert_eq!(t("m", 1e-30, 3e-30), "a (×10⁻³⁰ m)");
    }

    #[test]
    fn logarithmic_labels() {
        let t = |low, high, most| ticks(Axis::new("cost", "").log(), low, high, most).0;
        assert_eq!(t(0.001, 10.0, 6), "0.001 0.01 0.1 1 10");
        assert_eq!(t(1.0, 30.0, 9), "1 2 5 10 20");
        assert_eq!(t(1e-12, 1e3, 6), "10⁻¹² 10⁻⁹ 10⁻⁶ 10⁻³ 1 10³");
        assert_eq!(t(3.0, 4.0, 6), "3.0 3.2 3.4 3.6 3.8 4.0");
        assert!(t(1e-300, 1e300, 6).contains("10⁻²⁰⁰"));
    }

    #[test]
    fn extreme_ranges_have_few_ticks_inside() {
        let edges = [
            -f64::MAX,
            -1e300,
            -1.0,
            -1e-300,
            0.0,
            1e-320,
            1e-300,
            1.0,
            1e9,
            f64::MAX,
        ];
        for (i, low) in edges.iter().enumerate() {
            for high in &edges[i..] {
                let axis = Axis::new("x", "m").range(*low, *high);
                let map = Map::new(&axis, None, 0.0, false);
                let ticks = Ticks::new(&axis, &map, 7);
                assert!(
                    (2..=7).contains(&ticks.labelled.len()),
                    "{low} {high} {ticks:?}"
                );
                for (at, _) in ticks.labelled {
                    assert!(
                        (-1e-9..1.0 + 1e-9).contains(&map.place(at)),
                        "{low} {high}: {at}"
                    );
                }
            }
        }
    }
}
