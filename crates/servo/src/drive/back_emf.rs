//! What motion takes from the voltage of an amplifier.

use super::Drive;

/// The current that the voltage of the motion makes: `L i' + R i = -k v`, beside that of the amplifier's voltage, which the
/// drive computes as that of a current loop. Exact for a constant velocity over a substep. What of it depends on that
/// velocity is a damper, which the plant's implicit step takes; the rest is left from before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BackEmf {
    /// N/A (N m/A)
    force_constant: f64,
    /// Final current per distance moved in a substep, -k/(R h), A/m (A/rad).
    per_distance: f64,
    /// Kf k/R, N s/m (N m s/rad).
    damping: f64,
    /// Remaining fraction of the distance to the final current at the end of a substep, and on average.
    left: f64,
    mean: f64,
    /// A
    current: f64,
}

impl BackEmf {
    /// At rest, for substeps of `span` seconds; `None` where the amplifier controls the current.
    pub fn new(drive: &Drive, span: f64) -> Option<Self> {
        if drive.back_emf == 0.0 {
            return None;
        }
        let (left, mean) = drive.remaining(span);
        let per_speed = drive.amplifier_gain * drive.back_emf;
        Some(BackEmf {
            force_constant: drive.force_constant,
            per_distance: -per_speed / span,
            damping: drive.force_constant * per_speed,
            left,
            mean,
            current: 0.0,
        })
    }

    /// A
    pub fn current(&self) -> f64 {
        self.current
    }

    /// What the velocity of a substep does within it, N s/m (N m s/rad).
    pub fn damper(&self) -> f64 {
        self.damping * (1.0 - self.mean)
    }

    /// Mean force, N (N m), that is left over the next substep.
    #[inline]
    pub fn force(&self) -> f64 {
        self.force_constant * self.current * self.mean
    }

    /// After a substep in which the axis moved by `distance`, m (rad).
    #[inline]
    pub fn moved(&mut self, distance: f64) {
        let end = self.per_distance * distance;
        self.current = end + (self.current - end) * self.left;
    }
}
