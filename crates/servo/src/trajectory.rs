//! What an axis is told to do over time.

use crate::path::{Path, Reference};
use crate::speeds::Speeds;
use stiction_friction::compensator::ahead;

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

/// Looks at most this many samples ahead.
pub const FARTHEST: f64 = 7.0;
const KNOWN: usize = FARTHEST as usize + 1;

/// A trajectory sample by sample, each evaluated once, with the velocity of a later instant beside it.
#[derive(Clone, Debug)]
pub struct Lookahead<'a, T: ?Sized> {
    trajectory: &'a T,
    rate: f64,
    preview: f64,
    /// The references known, from that of now on.
    known: [Reference; KNOWN],
    count: usize,
    next: u64,
}

impl<'a, T: Trajectory + ?Sized> Lookahead<'a, T> {
    /// Samples at `rate` Hz with a preview of 0 to [`FARTHEST`] samples, more counting as that.
    pub fn new(trajectory: &'a T, rate: f64, preview: f64) -> Self {
        let preview = preview.clamp(0.0, FARTHEST);
        let mut lookahead = Lookahead {
            trajectory,
            rate,
            preview,
            known: [Reference::default(); KNOWN],
            count: libm::ceil(preview) as usize + 1,
            next: 0,
        };
        for _ in 0..lookahead.count {
            lookahead.read();
        }
        lookahead
    }

    #[inline]
    fn read(&mut self) {
        self.known.copy_within(1..self.count, 0);
        self.known[self.count - 1] = self.trajectory.at(self.next as f64 / self.rate);
        self.next += 1;
    }

    /// The reference of this sample and the velocity `preview` samples later, m/s (rad/s); the next call is the next sample.
    #[inline]
    pub fn sample(&mut self) -> (Reference, f64) {
        let now = self.known[0];
        if self.count == 1 {
            self.known[0] = self.trajectory.at(self.next as f64 / self.rate);
            self.next += 1;
            return (now, now.velocity);
        }
        let velocities = self.known.map(|r| r.velocity);
        let later = ahead(&velocities[..self.count], self.preview);
        self.read();
        (now, later)
    }
}
