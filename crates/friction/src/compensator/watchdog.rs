//! Switches off a compensation that makes tracking worse.

use super::input::Input;
use crate::{ParamError, Real};

/// Largest error with compensation that is allowed, over `ratio` times the largest one without (decision 0035).
const PEAK_ALLOWANCE: f64 = 1.5;
/// Length of a window in which the reference does not reverse, in [`Watchdog::window`]s.
const WINDOWS_WITHOUT_REVERSAL: f64 = 10.0;
/// Strokes with an error beyond what is allowed that switch off: one may be a fault of the measurement.
const STRIKES: u8 = 2;
/// Share of a window after which an error that stays beyond what is allowed is no fault of the measurement any more.
const LONG: f64 = 0.5;
/// Windows without compensation whose median is what is normal.
const LEARNT_WINDOWS: u8 = 5;

/// Compares the tracking error with and without compensation and switches the compensation off, until a reset, where
/// the error is larger with it: its mean square over a window, or its peaks beyond one and a half times those without.
///
/// A window goes from one reversal of the reference to another in the same sense, over two strokes, four and so on, so that
/// all windows contain the same: the same reversals, and as many strokes each way. Where the reference does not reverse,
/// a window ends after ten times its length. The watchdog first lets the axis move for five
/// windows without compensation to learn what is normal, the median of the last five, and goes on learning whenever no
/// force is added, be it that compensation is not enabled or that the gain is 0. The first window after the gain has been
/// reached is not judged: the incoming force disturbs the controller, whose integrator had overcome the friction. Only time
/// in which the reference moves counts, and with compensation only time in which a force is added. A window should hold a
/// cycle of the motion; before a motion of another kind, disable the compensation for five windows or reset.
///
/// Faults of the measurement neither blind it nor switch off (decision 0067): of three samples the middle one counts, so a
/// single bad sample does not exist for it; two windows that are spoilt while it learns, such as by one fault that begins in
/// the one and ends in the other, are outvoted by the others; and while it
/// judges, an error beyond what is allowed switches off only where it comes back in another stroke of this window or
/// the next, or lasts for half a window, and does not count in the mean square.
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
    /// Integral of the squared error over the present window, without errors beyond what is allowed, m^2 s (rad^2 s).
    pub sum: T,
    /// Largest of these errors, m (rad).
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
    /// Sizes of the error at the two samples before, the last first, m (rad).
    pub before: [T; 2],
    /// Mean square of the error and largest error of the four last windows without compensation, the last first.
    pub learnt: [(T, T); 4],
    /// Windows without compensation so far, at most five.
    pub windows: u8,
    /// Time since the present stroke began, at most one window, s.
    pub stroke: T,
    /// This stroke has had an error beyond what is allowed.
    pub struck: bool,
    /// Such strokes, in this window and those before it without one between that had none.
    pub strikes: u8,
    /// The present window has had an error beyond what is allowed.
    pub hit: bool,
    /// Time for which the error has been beyond what is allowed, s.
    pub high: T,
    /// Why it has switched off, if it has.
    pub trip: Option<Trip>,
}

/// Why a watchdog has switched off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trip {
    /// The mean square of the error over a window was larger than without compensation.
    Mean,
    /// Errors beyond one and a half times the largest without, again and again or for long.
    Peak,
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
            before: [T::ZERO; 2],
            learnt: [(T::ZERO, T::ZERO); 4],
            windows: 0,
            stroke: T::ZERO,
            struck: false,
            strikes: 0,
            hit: false,
            high: T::ZERO,
            trip: None,
        }
    }
}

impl<T: Real> Watch<T> {
    /// Whether the compensation may be on: the error without it is known, and the watchdog has not tripped.
    #[inline]
    pub fn allows(&self) -> bool {
        self.learned() && !self.tripped()
    }

    /// Whether the error without compensation is known.
    #[inline]
    pub fn learned(&self) -> bool {
        self.without >= T::ZERO
    }

    /// The rms error without compensation, m (rad), once it is known.
    pub fn baseline(&self) -> Option<T> {
        self.learned().then(|| self.without.sqrt())
    }

    /// Whether it has switched off.
    #[inline]
    pub fn tripped(&self) -> bool {
        self.trip.is_some()
    }

    /// What is learnt, and nothing else.
    pub(super) fn knowledge(&self) -> Self {
        Watch {
            without: self.without,
            peak_without: self.peak_without,
            learnt: self.learnt,
            windows: self.windows,
            ..Watch::default()
        }
    }

    /// What was kept: mean square and largest error without compensation, and whether it has switched off.
    pub(super) fn recalled(without: T, peak_without: T, trip: Option<Trip>) -> Self {
        Watch {
            without,
            peak_without,
            learnt: [(without, peak_without); 4],
            windows: LEARNT_WINDOWS,
            trip,
            ..Watch::default()
        }
    }

    /// Begins a window.
    fn clear(&mut self) {
        (self.sum, self.peak, self.time) = (T::ZERO, T::ZERO, T::ZERO);
        self.turns = 0;
    }

    /// Begins a stroke.
    fn begin_stroke(&mut self) {
        (self.stroke, self.struck) = (T::ZERO, false);
    }

    /// The size of the error without single bad samples: the middle one of the last three.
    #[inline]
    fn usual(&mut self, error: T) -> T {
        let [last, earlier] = self.before;
        self.before = [error, last];
        median(error, last, earlier)
    }

    /// Takes a window without compensation.
    fn learn(&mut self, mean_square: T, peak: T) {
        let [a, b, c, d] = self.learnt;
        if self.windows < LEARNT_WINDOWS {
            self.windows += 1;
        }
        if self.windows == LEARNT_WINDOWS {
            self.without = middle([a.0, b.0, c.0, d.0], mean_square);
            self.peak_without = middle([a.1, b.1, c.1, d.1], peak);
        }
        self.learnt = [(mean_square, peak), a, b, c];
    }

    fn switch_off(&mut self, why: Trip) {
        self.trip = self.trip.or(Some(why));
    }
}

fn median<T: Real>(a: T, b: T, c: T) -> T {
    let (low, high) = (a.min(b), a.max(b));
    low.max(high.min(c))
}

/// The median of five: of four neither the least nor the largest can be it.
fn middle<T: Real>([a, b, c, d]: [T; 4], e: T) -> T {
    let low = a.min(b).max(c.min(d));
    let high = a.max(b).min(c.max(d));
    median(e, low, high)
}

impl<T: Real> Watchdog<T> {
    pub(super) fn validate(&self) -> Result<(), ParamError> {
        ParamError::positive("watchdog_window", self.window)?;
        ParamError::positive("watchdog_ratio", self.ratio)
    }

    /// Counts a sample of `h` seconds that began with a `share` of the friction applied, of the wanted share `gain`, and gave
    /// the force `output`; what is fed forward beside friction is `whole`.
    #[inline]
    pub(super) fn step(
        &self,
        watch: &mut Watch<T>,
        h: T,
        input: &Input<T>,
        (share, gain, output, whole): (T, T, T, bool),
    ) {
        let error = watch.usual(input.tracking_error.abs());
        let off = share == T::ZERO && output == T::ZERO;
        let on = share == gain && share > T::ZERO && whole;
        if !(off || on) || on != watch.with {
            // While the force ramps up, down or to another gain: a window must lie entirely with or entirely without
            // compensation, and have one gain.
            watch.clear();
            watch.begin_stroke();
            (watch.with, watch.judged) = (on, false);
            (watch.strikes, watch.hit, watch.high) = (0, false, T::ZERO);
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
        if turned || watch.stroke >= self.window {
            watch.begin_stroke();
        }
        watch.time = watch.time + h;
        watch.stroke = watch.stroke + h;
        if watch.judged && error > T::from_f64(PEAK_ALLOWANCE) * self.ratio * watch.peak_without {
            self.strike(watch, h);
        } else {
            watch.sum = watch.sum + error * error * h;
            watch.peak = watch.peak.max(error);
            watch.high = T::ZERO;
        }
        let whole = turned && watch.turns == 3 && watch.time >= self.window;
        if !(whole || watch.time >= T::from_f64(WINDOWS_WITHOUT_REVERSAL) * self.window) {
            return;
        }
        let mean_square = watch.sum / watch.time;
        if off {
            watch.learn(mean_square.min(T::MAX), watch.peak);
        } else if watch.judged {
            if mean_square > self.ratio * self.ratio * watch.without {
                watch.switch_off(Trip::Mean);
            }
            if !watch.hit {
                watch.strikes = 0;
            }
            watch.hit = false;
        }
        watch.judged = on;
        watch.clear();
        watch.turns = u8::from(turned);
    }

    /// Takes an error beyond what is allowed: switches off where it comes back in another stroke, or stays.
    #[inline]
    fn strike(&self, watch: &mut Watch<T>, h: T) {
        // One that goes on into the next stroke is the same.
        if watch.high == T::ZERO && !watch.struck {
            watch.struck = true;
            watch.strikes = watch.strikes.saturating_add(1);
        }
        watch.high = watch.high + h;
        watch.hit = true;
        if watch.strikes >= STRIKES || watch.high >= T::from_f64(LONG) * self.window {
            watch.switch_off(Trip::Peak);
        }
    }
}
