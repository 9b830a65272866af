//! Pieces one after the other.

use crate::atom::{Atom, Extremes, Instant};
use crate::limits::Limits;
use stiction_friction::ParamError;
use stiction_servo::path::Reference;
use stiction_servo::trajectory::Trajectory;

/// A motion: pieces from rest to rest, joined without a pause. It starts and ends at rest where the axis stands.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    atoms: Vec<Atom>,
    /// When each starts, and the end, s.
    starts: Vec<f64>,
}

impl Motion {
    /// Refuses pieces with numbers out of range.
    pub fn new(atoms: Vec<Atom>) -> Result<Self, ParamError> {
        atoms.iter().try_for_each(Atom::validate)?;
        let mut starts = vec![0.0];
        for atom in &atoms {
            starts.push(starts[starts.len() - 1] + atom.duration());
        }
        Ok(Motion { atoms, starts })
    }

    /// The pieces in their order.
    pub fn atoms(&self) -> &[Atom] {
        &self.atoms
    }

    /// The pieces with the instants at which they start, s.
    pub fn timed(&self) -> impl Iterator<Item = (f64, &Atom)> {
        self.starts.iter().copied().zip(&self.atoms)
    }

    /// s
    pub fn duration(&self) -> f64 {
        self.starts.last().copied().unwrap_or(0.0)
    }

    /// The reference `t` seconds after the start, relative to where it starts; at rest before and after.
    pub fn at(&self, t: f64) -> Instant {
        let after = self.starts.partition_point(|start| *start <= t);
        match after
            .checked_sub(1)
            .and_then(|i| Some((self.starts[i], self.atoms.get(i)?)))
        {
            Some((start, atom)) => atom.at(t - start),
            None => Instant::default(),
        }
    }

    /// Bounds between samples too.
    pub fn extremes(&self) -> Extremes {
        let bounds = self.atoms.iter().map(Atom::extremes);
        bounds.fold(Extremes::default(), Extremes::with)
    }

    /// Whether it stays within the limits at every instant.
    pub fn holds(&self, limits: &Limits) -> bool {
        self.extremes().within(limits)
    }
}

impl Extremes {
    /// Whether the bounds lie within the limits.
    pub fn within(&self, limits: &Limits) -> bool {
        let [low, high] = limits.reach();
        self.position[0] >= low
            && self.position[1] <= high
            && self.speed <= limits.speed
            && self.acceleration <= limits.acceleration
            && self.jerk <= limits.jerk
    }
}

impl Trajectory for Motion {
    fn duration(&self) -> f64 {
        Motion::duration(self)
    }

    fn at(&self, t: f64) -> Reference {
        reference(Motion::at(self, t))
    }
}

impl Trajectory for Atom {
    fn duration(&self) -> f64 {
        Atom::duration(self)
    }

    fn at(&self, t: f64) -> Reference {
        reference(Atom::at(self, t))
    }
}

fn reference(at: Instant) -> Reference {
    Reference {
        position: at.position,
        velocity: at.velocity,
        acceleration: at.acceleration,
    }
}
