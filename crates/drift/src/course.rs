//! A number over time, as it was estimated.

use crate::robust::median;
use stiction_policy::drift;

/// One estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// When it was measured, s.
    pub time: f64,
    /// The estimate, in its unit.
    pub value: f64,
    /// Its standard deviation, at least 0, in the same unit.
    pub std: f64,
    /// Temperature of the machine, if it is known.
    pub temperature: Option<f64>,
}

/// How changes of a number are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// As parts of it: of a number that is far above 0.
    Relative,
    /// In its unit: of a number that may be 0 or change its sign.
    Absolute,
}

impl Measure {
    /// How changes of the number of these courses are counted.
    pub fn of(courses: &[&[Point]]) -> Self {
        let all = || courses.iter().flat_map(|course| course.iter());
        let positive = all().all(|point| point.value > 0.0);
        let mut values: Vec<f64> = all().map(|point| point.value).collect();
        let mut stds: Vec<f64> = all().map(|point| point.std).collect();
        match positive && median(&mut values) > drift::MIN_RELATIVE_LEVEL * median(&mut stds) {
            true => Measure::Relative,
            false => Measure::Absolute,
        }
    }

    /// A value on the scale on which its changes are differences.
    pub(crate) fn scaled(self, value: f64) -> f64 {
        match self {
            Measure::Relative => libm::log(value),
            Measure::Absolute => value,
        }
    }

    /// The deviation of a value on that scale.
    pub(crate) fn deviation(self, point: &Point) -> f64 {
        match self {
            Measure::Relative => point.std / point.value,
            Measure::Absolute => point.std,
        }
    }

    /// A difference on that scale as a change: a part of the number, or in its unit.
    pub fn change(self, difference: f64) -> f64 {
        match self {
            Measure::Relative => libm::expm1(difference),
            Measure::Absolute => difference,
        }
    }

    /// The value of a place on that scale.
    pub(crate) fn value(self, scaled: f64) -> f64 {
        match self {
            Measure::Relative => libm::exp(scaled),
            Measure::Absolute => scaled,
        }
    }
}
