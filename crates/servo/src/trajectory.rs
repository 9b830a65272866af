//! References over time.

use crate::path::{Path, Reference};
use crate::speeds::Speeds;

/// A reference over time.
pub trait Trajectory {
    /// Total length, s.
    fn duration(&self) -> f64;

    /// The reference at the time `t`, s; at rest before 0 and after the end.
    fn at(&self, t: f64) -> Reference;
}

impl Trajectory for Path {
    fn duration(&self) -> f64 {
        Path::duration(self)
    }

    fn at(&self, t: f64) -> Reference {
        Path::at(self, t)
    }
}

impl Trajectory for Speeds {
    fn duration(&self) -> f64 {
        Speeds::duration(self)
    }

    fn at(&self, t: f64) -> Reference {
        Speeds::at(self, t)
    }
}

/// Longest preview, in samples; enough for the delay and current loop of a drive at usual rates.
pub const MAX_PREVIEW: f64 = 7.0;
/// References that are kept for it.
const KNOWN: usize = MAX_PREVIEW as usize + 1;

/// How far ahead: whole samples, and the part of one beyond them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Preview {
    whole: usize,
    part: f64,
}

impl Preview {
    /// 0 to [`MAX_PREVIEW`] samples, more counting as that.
    pub fn new(samples: f64) -> Self {
        let samples = samples.clamp(0.0, MAX_PREVIEW);
        let whole = (libm::ceil(samples) - 1.0).max(0.0);
        Preview {
            whole: whole as usize,
            part: samples - whole,
        }
    }

    /// How many samples have to be known, the present one included.
    pub fn count(self) -> usize {
        self.whole + 1 + usize::from(self.part > 0.0)
    }

    /// The velocity ahead, m/s (rad/s), from the samples of now on: that of
    /// [`ahead`](stiction_friction::compensator::ahead).
    #[inline]
    pub fn velocity(self, known: &[Reference]) -> f64 {
        let from = known[self.whole].velocity;
        if self.part == 0.0 {
            return from;
        }
        from + self.part * (known[self.whole + 1].velocity - from)
    }
}

/// A trajectory sample by sample, each evaluated once, with the velocity of a later instant beside it.
#[derive(Clone, Debug)]
pub struct Lookahead<'a, T: ?Sized> {
    trajectory: &'a T,
    rate: f64,
    preview: Preview,
    /// The references known, from that of now on.
    known: [Reference; KNOWN],
    count: usize,
    next: u64,
}

impl<'a, T: Trajectory + ?Sized> Lookahead<'a, T> {
    /// Samples at `rate` Hz with a preview of 0 to [`MAX_PREVIEW`] samples, more counting as that.
    pub fn new(trajectory: &'a T, rate: f64, preview: f64) -> Self {
        let preview = Preview::new(preview);
        let mut lookahead = Lookahead {
            trajectory,
            rate,
            preview,
            known: [Reference::default(); KNOWN],
            count: preview.count(),
            next: 0,
        };
        for _ in 0..lookahead.count {
            lookahead.read();
        }
        lookahead
    }

    #[inline]
    fn read(&mut self) {
        // Without a preview, the common case, there is nothing to move.
        if self.count > 1 {
            self.known.copy_within(1..self.count, 0);
        }
        self.known[self.count - 1] = self.trajectory.at(self.next as f64 / self.rate);
        self.next += 1;
    }

    /// The reference of this sample and the velocity `preview` samples later, m/s (rad/s); the next call is the next sample.
    #[inline]
    pub fn sample(&mut self) -> (Reference, f64) {
        let now = self.known[0];
        let later = self.preview.velocity(&self.known);
        self.read();
        (now, later)
    }
}
