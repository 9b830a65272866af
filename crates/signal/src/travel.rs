//! How far a position travels in each direction, whatever its speed.

/// Shortest movement that counts, in steps of the encoder: at rest it may alternate between two counts.
const LEAST_STEPS: f64 = 3.0;
/// Shortest movement that counts, in standard deviations of the noise of the position: white noise deviates from its
/// mean by more than five only about once in two million samples, and ten need a swing from one side to the other.
const LEAST_DEVIATIONS: f64 = 10.0;
/// Least travel in the direction with less travel that counts as motion in that direction, as a part of the range:
/// the overshoot of an axis at the end of a motion, or its springing back, is less.
const LEAST_SHARE_OF_RANGE: f64 = 0.01;

/// The distance that a position travels in each direction, and the range that it covers.
///
/// A movement ends where the position turns back by more than the noise and the encoder explain; so
/// neither the speed nor how long the axis stands still matters, and one fast motion among slow ones
/// does not hide them.
///
/// ```
/// use stiction_signal::Travel;
///
/// // To and fro by 10 mm with an encoder of 1 um.
/// let there_and_back = [0.0, 0.005, 0.010, 0.005, 0.0];
/// let travel = Travel::of(there_and_back, Travel::shortest_movement(1e-6, 0.0));
/// assert!(!travel.is_one_way());
/// // Forward, with an encoder that alternates between two counts.
/// let forward = [0.0, 1e-6, 0.0, 0.005, 0.004999, 0.005, 0.010];
/// assert!(Travel::of(forward, Travel::shortest_movement(1e-6, 0.0)).is_one_way());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Travel {
    /// Sum of all movements up, in the unit of the position.
    pub up: f64,
    /// Sum of all movements down, likewise.
    pub down: f64,
    /// Largest less smallest position.
    pub range: f64,
}

impl Travel {
    /// The shortest movement that is neither encoder steps (0 where they are not known) nor noise (its
    /// standard deviation).
    pub fn shortest_movement(encoder_step: f64, noise: f64) -> f64 {
        (LEAST_STEPS * encoder_step).max(LEAST_DEVIATIONS * noise)
    }

    /// The same for a position that is the integral of a velocity with white noise of this standard deviation, over so many
    /// seconds and samples: the noise makes it walk at random.
    pub fn shortest_integrated(velocity_noise: f64, seconds: f64, samples: usize) -> f64 {
        Self::shortest_movement(
            0.0,
            velocity_noise * seconds / (samples.max(1) as f64).sqrt(),
        )
    }

    /// Of positions in order, where a movement counts if it is longer than `shortest`. Positions that are not numbers
    /// are passed over.
    pub fn of(positions: impl IntoIterator<Item = f64>, shortest: f64) -> Self {
        let mut positions = positions.into_iter().filter(|x| x.is_finite());
        let Some(first) = positions.next() else {
            return Self::default();
        };
        let mut out = Self::default();
        let (mut low, mut high) = (first, first);
        // The ends of the movement that goes on, and its direction once it is long enough.
        let (mut bottom, mut top) = (first, first);
        let mut rises = None;
        for x in positions {
            low = low.min(x);
            high = high.max(x);
            match rises {
                Some(true) if top - x > shortest => {
                    out.up += top - bottom;
                    (bottom, rises) = (x, Some(false));
                }
                Some(false) if x - bottom > shortest => {
                    out.down += top - bottom;
                    (top, rises) = (x, Some(true));
                }
                Some(true) => top = top.max(x),
                Some(false) => bottom = bottom.min(x),
                None => {
                    (bottom, top) = (bottom.min(x), top.max(x));
                    if top - bottom > shortest {
                        rises = Some(x == top);
                    }
                }
            }
        }
        match rises {
            Some(true) => out.up += top - bottom,
            Some(false) => out.down += top - bottom,
            None => {}
        }
        out.range = high - low;
        out
    }

    /// The travel of two stretches together.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            up: self.up + other.up,
            down: self.down + other.down,
            range: self.range.max(other.range),
        }
    }

    /// Whether the axis moves in one direction only: in the direction with less travel it travels at most 1 % of its
    /// range in all. False for a position that does not move at all.
    pub fn is_one_way(&self) -> bool {
        self.up.max(self.down) > 0.0 && self.up.min(self.down) <= LEAST_SHARE_OF_RANGE * self.range
    }
}

#[cfg(test)]
mod tests {
    use super::Travel;

    #[test]
    fn each_movement_counts_once() {
        let travel = Travel::of([0.0, 1.0, 3.0, 2.9, 4.0, 1.0, 1.05, 0.5], 0.2);
        assert_eq!(
            travel,
            Travel {
                up: 4.0,
                down: 3.5,
                range: 4.0
            }
        );
        assert_eq!(Travel::of([], 0.0), Travel::default());
        assert_eq!(Travel::of([2.0], 0.0), Travel::default());
        assert!(!Travel::of([2.0; 9], 0.0).is_one_way());
    }

    #[test]
    fn a_fast_motion_does_not_hide_the_slow_ones() {
        // Three periods of 1 mm up and down, then 100 mm in two samples.
        let slow = (0..3000).map(|i| 0.5e-3 * (std::f64::consts::TAU * f64::from(i) / 1e3).sin());
        let travel = Travel::of(slow.chain([0.05, 0.1]), 3e-6);
        assert!(!travel.is_one_way(), "{travel:?}");
    }

    #[test]
    fn neither_noise_nor_overshoot_is_motion_back() {
        let noise = |i: i32| 1e-6 * (f64::from(i) * 12.9898).sin();
        let rising = (0..5000).map(|i| 1e-7 * f64::from(i) + noise(i));
        let shortest = Travel::shortest_movement(0.0, 0.7e-6);
        assert!(Travel::of(rising, shortest).is_one_way());
        assert!(Travel::of([0.0, 0.05, 0.1002, 0.1], 3e-6).is_one_way());
        let at_rest = (0..5000).map(noise);
        assert!(!Travel::of(at_rest, shortest).is_one_way());
    }
}
