//! Switches off a compensation that makes tracking worse.

use super::input::Input;
use crate::{ParamError, Real};

/// Largest single error with compensation that is allowed, over `ratio` times the largest one without (decision 0035).
const PEAK_ALLOWANCE: f64 = 1.5;
/// Length of a window in which the reference does not reverse, in [`Watchdog::window`]s.
const WINDOWS_WITHOUT_REVERSAL: f64 = 10.0;

/// Compares the tracking error with and without compensation and switches the compensation off, until a reset, where
/// the error is larger with it: its mean square over a window, or any single error beyond one and a half times the
/// largest without.
///
/// A window goes from one reversal of the reference to another in the same sense, over two strokes, four and so on, so that
/// all windows contain the same: the same reversals, and as many strokes each way. Where the reference does not reverse,
/// a window ends after ten times its length. The watchdog first lets the axis move for a
/// window without compensation to learn what is normal, and learns again whenever no force is added, be it that
/// compensation is not enabled or that the gain is 0. The first window after the gain has been reached is not judged:
/// the incoming force disturbs the controller, whose integrator had overcome the friction. Only time in which the
/// reference moves counts, and with compensation only time in which a force is added. A window should hold a cycle of
/// the motion; before a motion of another kind, disable the compensation for a window or reset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Watchdog<T> {
    /// Moving time that is compared, > 0, s; it should hold at least two reversals.
    pub window: T,
    /// Largest allowed rms error with compensation over that without, > 0.
    pub ratio: T,
}

/// The state of a watchdog.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Watch<T> {
    /// Integral of the squared error over the present window, m^2 s (rad^2 s).
    pub sum: T,
    /// Largest error in the present window, m (rad).
    pub peak: T,
    /// Moving time in the present window, s.
    pub time: T,
    /// Reversals of the reference in the present window, the one at its beginning included: 1, 2, 3, and from then on 2 and 3
    /// alternately, 3 being in the sense of the first; 0: the window did not begin at a reversal.
    pub turns: u8,
    /// The reference moved in the positive direction last.
    pub forward: bool,
    /// The present window is one with compensation.
    pub with: bool,
    /// The present window is judged: it is not the first with this gain.
    pub judged: bool,
    /// Mean square of the error without compensation, m^2 (rad^2); negative: not known yet.
    pub without: T,
    /// Largest error without compensation, m (rad).
    pub peak_without: T,
    /// It has switched off.
    pub tripped: bool,
}

impl<T: Real> Default for Watchdog<T> {
    /// A window of 2 s and a ratio of 1: it switches off where the rms error is larger with compensation than
    /// without.
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
            turns: 0,
            forward: false,
            with: false,
            judged: false,
            without: -T::ONE,
            peak_without: T::ZERO,
            tripped: false,
        }
    }
}

impl<T: Real> Watch<T> {
    /// Whether the compensation may be on: the error without it is known, and the watchdog has not tripped.
    #[inline]
    pub fn allows(&self) -> bool {
        self.without >= T::ZERO && !self.tripped
    }

    /// Begins a window.
    fn clear(&mut self) {
        (self.sum, self.peak, self.time) = (T::ZERO, T::ZERO, T::ZERO);
        self.turns = 0;
    }
}

impl<T: Real> Watchdog<T> {
    pub(super) fn validate(&self) -> Result<(), ParamError> {
        ParamError::positive("watchdog_window", self.window)?;
        ParamError::positive("watchdog_ratio", self.ratio)
    }

    /// Counts a sample of `h` seconds that began with a `share` of the friction applied, of the wanted share `gain`, and gave
    /// the force `output`.
    #[inline]
    pub(super) fn step(
        &self,
        watch: &mut Watch<T>,
        h: T,
        input: &Input<T>,
        (share, gain, output): (T, T, T),
    ) {
        let off = share == T::ZERO && output == T::ZERO;
        let on = share == gain && share > T::ZERO;
        if !(off || on) || on != watch.with {
            // While the force ramps up, down or to another gain: a window must lie entirely with or entirely without
            // compensation, and have one gain.
            watch.clear();
            (watch.with, watch.judged) = (on, false);
        }
        let idle = on && output == T::ZERO;
        if !(off || on) || idle || input.reference_velocity == T::ZERO {
            return;
        }
        let forward = input.reference_velocity > T::ZERO;
        let turned = forward != watch.forward && watch.time > T::ZERO;
        watch.forward = forward;
        if turned {
            if watch.turns == 0 {
                watch.clear();
            }
            // The third reversal has the direction of the first, so the next one has that of the second.
            watch.turns = if watch.turns == 3 { 2 } else { watch.turns + 1 };
        }
        let error = input.tracking_error.abs();
        watch.sum = watch.sum + error * error * h;
        watch.peak = watch.peak.max(error);
        watch.time = watch.time + h;
        let far = T::from_f64(PEAK_ALLOWANCE) * self.ratio * watch.peak_without;
        if watch.judged && error > far {
            watch.tripped = true;
        }
        let whole = turned && watch.turns == 3 && watch.time >= self.window;
        if !(whole || watch.time >= T::from_f64(WINDOWS_WITHOUT_REVERSAL) * self.window) {
            return;
        }
        let mean_square = watch.sum / watch.time;
        if off {
            watch.without = mean_square.min(T::MAX);
            watch.peak_without = watch.peak;
        } else if watch.judged && mean_square > self.ratio * self.ratio * watch.without {
            watch.tripped = true;
        }
        watch.judged = on;
        watch.clear();
        watch.turns = u8::from(turned);
    }
}
