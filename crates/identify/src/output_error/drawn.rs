//! A logged force as it acts on the axis, however it is shifted in time: in open loop the whole, in closed loop what acts beside
//! the controller.

use crate::output_error::run::{Hold, Run};
use crate::output_error::simulate::{Drive, periods};

/// Distance to a whole sample below which an instant counts as one, in samples.
const ROUNDING: f64 = 1e-9;

/// The force of each row, constant for one sample: from its instant on where it is held, about its instant where it is
/// centred, earlier by the delay. A plant step gets its mean over the step.
pub(crate) struct Drawn<'a> {
    force: &'a [f64],
    steps: Vec<Place>,
    /// Plant steps in one second.
    rate: f64,
}

/// Where a plant step reads among forces that are held, relative to the one that begins with its sample.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    /// The row at the beginning of the step.
    pub row: isize,
    /// Part of the step that it covers; the next row covers the rest.
    pub share: f64,
    /// The rows on both sides of the beginning and of the end of the step, equal inside of a row.
    pub begins: [isize; 2],
    pub ends: [isize; 2],
}

/// The places of the plant steps of a sample that read `ahead` samples later.
pub(crate) fn places(substeps: usize, ahead: f64) -> Vec<Place> {
    let n = substeps as f64;
    let place = |j: usize| {
        let (begin, is_whole) = snapped(j as f64 / n + ahead);
        let (end, ends_whole) = snapped((j + 1) as f64 / n + ahead);
        let row = begin.floor();
        let sides = |at: f64, whole: bool| {
            let row = at.floor() as isize;
            [row - isize::from(whole), row]
        };
        Place {
            row: row as isize,
            share: ((row + 1.0 - begin) * n).min(1.0),
            begins: sides(begin, is_whole),
            ends: sides(end, ends_whole),
        }
    };
    (0..substeps).map(place).collect()
}

impl<'a> Drawn<'a> {
    /// The delay is that of the force that drives the axis.
    pub fn new(run: &'a Run, drive: &Drive, delay: f64) -> Self {
        let (force, delay) = match drive.controller {
            None => (&run.force, delay),
            Some(_) => (&run.external, 0.0),
        };
        let substeps = periods(run) * drive.substeps;
        let middle = match drive.hold {
            Hold::Held => 0.0,
            Hold::Centred => 0.5,
        };
        Self {
            force,
            steps: places(substeps, middle + delay / run.step),
            rate: substeps as f64 / run.step,
        }
    }

    /// The row that is `by` after row `k`; the first and the last go on beyond the ends.
    #[inline]
    fn row(&self, k: usize, by: isize) -> f64 {
        let last = self.force.len() - 1;
        self.force[k.saturating_add_signed(by).min(last)]
    }

    /// The mean force over plant step `j` after sample `k`; 0 where nothing acts.
    #[inline]
    pub fn at(&self, k: usize, j: usize) -> f64 {
        if self.force.is_empty() {
            return 0.0;
        }
        let place = &self.steps[j];
        let here = self.row(k, place.row);
        if place.share == 1.0 {
            return here;
        }
        place.share * here + (1.0 - place.share) * self.row(k, place.row + 1)
    }

    /// Its derivative with respect to the delay, per second; in the middle of both sides where it jumps.
    #[inline]
    pub fn slope(&self, k: usize, j: usize) -> f64 {
        let place = &self.steps[j];
        let mean = |[a, b]: [isize; 2]| 0.5 * (self.row(k, a) + self.row(k, b));
        self.rate * (mean(place.ends) - mean(place.begins))
    }
}

/// An instant in samples, exactly whole where it is nearly so.
fn snapped(x: f64) -> (f64, bool) {
    let whole = libm::round(x);
    match (x - whole).abs() < ROUNDING {
        true => (whole, true),
        false => (x, false),
    }
}
