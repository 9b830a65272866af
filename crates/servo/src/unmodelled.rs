//! Forces on an axis that its law does not have: their size is known, their course is not.

use crate::integrator::Integrator;
use crate::noise::Noise;
use crate::plant::{Load, Motion, Plant};
use std::f64::consts::TAU;
use stiction_friction::Held;

/// Forces against the motion beside the friction law. All of them are continuous in time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Unmodelled {
    /// What comes and goes on the way from a reversal.
    pub shapes: Vec<Shape>,
    /// What differs from place to place.
    pub waves: Vec<Wave>,
    /// What changes by itself.
    pub wandering: Option<Wandering>,
}

/// A force in the direction of motion that rises over the first length after a reversal and falls over the second:
/// `force (exp(-s/long) - exp(-s/short))` with the travel s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// Either sign, N (N m).
    pub force: f64,
    /// > 0, m (rad).
    pub short: f64,
    /// > `short`, m (rad).
    pub long: f64,
}

/// `force sin(2 pi x/length + phase)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// N (N m)
    pub force: f64,
    /// > 0, m (rad).
    pub length: f64,
    /// rad
    pub phase: f64,
}

/// A random force of constant power that forgets itself exponentially (Ornstein and Uhlenbeck).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wandering {
    /// Root mean square, N (N m).
    pub force: f64,
    /// Time constant, > 0, s.
    pub memory: f64,
    /// Seed of its course.
    pub seed: u64,
}

/// An integrator for an axis with such forces; they are held over each span.
#[derive(Clone, Debug)]
pub struct Beside<I> {
    integrator: I,
    forces: Unmodelled,
    /// Where the elements of each shape are, -1 to 1: the direction of motion after a length of travel.
    turned: Vec<[f64; 2]>,
    noise: Noise,
    wanders: f64,
    held: f64,
}

impl<I> Beside<I> {
    /// At rest: no shape has begun.
    pub fn new(integrator: I, forces: Unmodelled) -> Self {
        Beside {
            integrator,
            turned: vec![[0.0; 2]; forces.shapes.len()],
            noise: Noise::new(forces.wandering.map_or(0, |w| w.seed)),
            wanders: 0.0,
            held: 0.0,
            forces,
        }
    }

    /// What moves the axis.
    pub fn integrator_mut(&mut self) -> &mut I {
        &mut self.integrator
    }

    /// Against the positive direction, N (N m).
    fn force(&mut self, position: f64, span: f64) -> f64 {
        let mut force = 0.0;
        for (shape, turned) in self.forces.shapes.iter().zip(&self.turned) {
            // After a reversal each element goes from -1 to 1: twice the exponential.
            force += 0.5 * shape.force * (turned[0] - turned[1]);
        }
        for wave in &self.forces.waves {
            force += wave.force * libm::sin(TAU * position / wave.length + wave.phase);
        }
        if let Some(wandering) = &self.forces.wandering {
            let kept = libm::exp(-span / wandering.memory);
            self.wanders *= kept;
            self.wanders += libm::sqrt(1.0 - kept * kept) * self.noise.normal();
            force += wandering.force * self.wanders;
        }
        force
    }

    fn moved(&mut self, way: f64) {
        for (shape, turned) in self.forces.shapes.iter().zip(&mut self.turned) {
            for (element, length) in turned.iter_mut().zip([shape.short, shape.long]) {
                // The implicit step of dq/ds = (sgn ds - q)/length, which stays within 1 however long it is.
                let part = way.abs() / (length + way.abs());
                *element += part * (1.0_f64.copysign(way) - *element);
            }
        }
    }
}

impl<L: Held<f64>, I: Integrator<L>> Integrator<L> for Beside<I> {
    fn advance(
        &mut self,
        plant: &Plant<L>,
        from: Motion<L::State>,
        span: f64,
        load: Load,
        rate: f64,
    ) -> Motion<L::State> {
        self.held = self.force(from.position, span);
        let load = Load {
            force: load.force - self.held,
            ..load
        };
        let to = self.integrator.advance(plant, from, span, load, rate);
        self.moved(to.position - from.position);
        to
    }

    fn expect(&mut self, next: f64) {
        self.integrator.expect(next - self.held);
    }

    fn forget(&mut self) {
        self.integrator.forget();
    }
}
