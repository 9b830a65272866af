//! Switches off a compensation that makes tracking worse.

use super::Input;
use crate::{ParamError, Real};

/// Compares the tracking error with and without compensation and switches off, until a reset, where it is larger with:
/// its mean square over a window, or any one error beyond one and a half times the largest without.
///
/// It first lets the axis move for a window without compensation to learn what is normal, and learns again whenever
/// compensation is not enabled. Only time in which the reference moves counts. A window is to hold a cycle of the motion;
/// before a motion of another kind, disable for a window or reset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Watchdog<T> {
    /// Moving time that is compared, > 0, s.
    pub window: T,
    /// Largest allowed error with compensation over that without, > 0.
    pub ratio: T,
}

/// What a watchdog remembers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Watch<T> {
    /// Integral of the squared error over the present window, m^2 s (rad^2 s).
    pub sum: T,
    /// Largest error in the present window, m (rad).
    pub peak: T,
    /// Moving time in the present window, s.
    pub time: T,
    /// Mean square of the error without compensation, m^2 (rad^2); negative: not known yet.
    pub without: T,
    /// Largest error without compensation, m (rad).
    pub peak_without: T,
    /// It has switched off.
    pub tripped: bool,
}

impl<T: Real> Default for Watchdog<T> {
    /// A window of 2 s and a ratio of 1: off where the rms error is larger with than without.
    fn default() -> Self {
        Watchdog {
            window: T::from_f64(2.0),
            ratio: T::ONE,
        }
    }
}

impl<T: Real> Default for Watch<T> {
    fn default() -> Self {
        Watch {
            sum: T::ZERO,
            peak: T::ZERO,
            time: T::ZERO,
            without: -T::ONE,
            peak_without: T::ZERO,
            tripped: false,
        }
    }
}

impl<T: Real> Watch<T> {
    /// Whether it lets the compensation on: it knows the error without, and has not switched off.
    #[inline]
    pub fn allows(&self) -> bool {
        self.without >= T::ZERO && !self.tripped
    }

    /// Begins a window.
    fn clear(&mut self) {
        (self.sum, self.peak, self.time) = (T::ZERO, T::ZERO, T::ZERO);
    }
}

impl<T: Real> Watchdog<T> {
    pub(super) fn validate(&self) -> Result<(), ParamError> {
        ParamError::positive("watchdog_window", self.window)?;
        ParamError::positive("watchdog_ratio", self.ratio)
    }

    /// Counts a sample of `h` seconds with a compensation let through by `share`.
    #[inline]
    pub(super) fn step(&self, watch: &mut Watch<T>, h: T, input: &Input<T>, share: T) {
        let (off, on) = (share <= T::ZERO, share >= T::ONE);
        if !(off || on) {
            // Coming or going: a window that begins now belongs to one side only.
            watch.clear();
            return;
        }
        if input.reference_velocity == T::ZERO {
            return;
        }
        let error = input.tracking_error.abs();
        watch.sum = watch.sum + error * error * h;
        watch.peak = watch.peak.max(error);
        watch.time = watch.time + h;
        let far = T::from_f64(1.5) * self.ratio * watch.peak_without;
        if on && error > far {
            watch.tripped = true;
        }
        if watch.time < self.window {
            return;
        }
        let mean_square = watch.sum / watch.time;
        if off {
            watch.without = mean_square.min(T::MAX);
            watch.peak_without = watch.peak;
        } else if mean_square > self.ratio * self.ratio * watch.without {
            watch.tripped = true;
        }
        watch.clear();
    }
}
