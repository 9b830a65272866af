//! Values of an axis file whose unit has to fit the kind of axis (linear or rotary), which only the log may tell.

use crate::axis::tied::Tied;
use crate::config::Given;
use crate::error::Error;
use std::cell::RefCell;
use std::ops::RangeInclusive;
use stiction_formats::Dimension;

/// Dimensions of a position.
pub(super) const LENGTHS: [Dimension; 2] = [Dimension::LENGTH, Dimension::ANGLE];
/// Dimensions of a velocity.
pub(super) const SPEEDS: [Dimension; 2] = [Dimension::LINEAR_VELOCITY, Dimension::ANGULAR_VELOCITY];
/// Dimensions of what drives an axis.
pub(super) const FORCES: [Dimension; 4] = [
    Dimension::FORCE,
    Dimension::TORQUE,
    Dimension::CURRENT,
    Dimension::VOLTAGE,
];

/// Takes values, and notes those that are to be checked again.
#[derive(Default)]
pub(super) struct Resolver {
    /// Values that are to be checked when the log says what kind of axis it is.
    pub tied: RefCell<Vec<Tied>>,
}

impl Resolver {
    /// A value above 0, if it is given.
    pub fn positive(
        &self,
        given: Option<Given<'_>>,
        dimensions: &[Dimension],
    ) -> Result<Option<f64>, Error> {
        given
            .map(|given| self.above_zero(&given, dimensions))
            .transpose()
    }

    /// A value above 0 whose unit may have to fit the kind of axis.
    pub fn above_zero(&self, given: &Given<'_>, dimensions: &[Dimension]) -> Result<f64, Error> {
        Ok(self.tie(given, given.positive(dimensions)?))
    }

    /// The same within a range in SI.
    pub fn within(
        &self,
        given: &Given<'_>,
        dimensions: &[Dimension],
        range: &RangeInclusive<f64>,
    ) -> Result<f64, Error> {
        Ok(self.tie(given, given.among(dimensions, range)?))
    }

    /// Notes a value that has to fit the kind of axis.
    fn tie(&self, given: &Given<'_>, (value, dimension): (f64, Dimension)) -> f64 {
        let free = [Dimension::TIME, Dimension::FREQUENCY, Dimension::ONE];
        if !free.contains(&dimension) {
            self.tied.borrow_mut().push(Tied {
                place: given.place(),
                text: given.shown(),
                dimension,
            });
        }
        value
    }
}
