//! Forces of the terms beside friction on a simulated axis, and its law where it depends on the position.

use crate::candidate::Candidate;
use crate::subject::{Shape, Term};
use stiction_friction::Held;
use stiction_friction::compensator::{Channel, Channels, Levels, Wave};
use stiction_parameters::{Quantity, Wave as Part};
use stiction_servo::integrator::Integrator;
use stiction_servo::levelled::Depends;
use stiction_servo::plant::{Load, Motion, Plant};
use stiction_servo::surroundings::Surroundings;

/// The terms that push the axis, with their sizes.
#[derive(Clone, Debug)]
pub(crate) struct Push {
    terms: Vec<(Term, f64)>,
}

impl Push {
    pub fn of(candidate: &Candidate) -> Self {
        let terms = candidate.subject.terms.iter().zip(&candidate.sizes);
        let own = terms.filter(|(term, _)| !term.is_level());
        Push {
            terms: own.map(|(term, size)| (*term, *size)).collect(),
        }
    }

    /// Whether there are none.
    pub fn is_none(&self) -> bool {
        self.terms.is_empty()
    }

    /// The force of the motor that they ask for, N (N m).
    pub fn asks(&self, position: f64, velocity: f64) -> f64 {
        let each = self.terms.iter();
        each.map(|(term, size)| size * term.at(0.0, position, velocity))
            .sum()
    }
}

/// An integrator for an axis that is pushed.
#[derive(Clone, Debug)]
pub(crate) struct Pushed<I> {
    integrator: I,
    push: Push,
    /// The force of the step before, N (N m).
    last: f64,
}

impl<I> Pushed<I> {
    pub fn new(integrator: I, push: Push) -> Self {
        Pushed {
            integrator,
            push,
            last: 0.0,
        }
    }
}

impl<L: Held<f64>, I: Integrator<L>> Integrator<L> for Pushed<I> {
    fn advance(
        &mut self,
        plant: &Plant<L>,
        from: Motion<L::State>,
        span: f64,
        load: Load,
        rate: f64,
    ) -> Motion<L::State> {
        let middle = from.position + 0.5 * span * from.velocity;
        self.last = -self.push.asks(middle, from.velocity);
        let load = Load {
            force: load.force + self.last,
            ..load
        };
        self.integrator.advance(plant, from, span, load, rate)
    }

    fn expect(&mut self, next: f64) {
        // It changes little over a step.
        self.integrator.expect(next + self.last);
    }

    fn forget(&mut self) {
        self.integrator.forget();
    }
}

/// How the level of friction depends on the position; `None` where it does not.
pub(crate) fn depends(candidate: &Candidate) -> Option<Depends> {
    if !candidate.subject.has_levels() {
        return None;
    }
    let mut levels = Levels::default();
    let mut middle = 0.0;
    let mut origin = 0.0;
    let terms = candidate.subject.terms.iter().zip(&candidate.sizes);
    for (term, size) in terms {
        for side in [0, 1] {
            if !term.name.side.holds(side) {
                continue;
            }
            let part = size / candidate.direction(side).coulomb;
            match (term.shape, term.name.quantity) {
                (Shape::Level(from), _) => {
                    middle = from;
                    levels.position[side] = part;
                }
                (Shape::LevelWave(along), Quantity::CoulombPitch(k, _)) => {
                    origin = along.origin;
                    if let Some(wave) = levels.waves[side].get_mut(k as usize - 1) {
                        *wave = Wave {
                            rate: along.rate,
                            whole: true,
                            ..*wave
                        };
                        match along.wave {
                            Part::Sine => wave.sine = part,
                            Part::Cosine => wave.cosine = part,
                        }
                    }
                }
                _ => {}
            }
        }
    }
    let position = Channel {
        reference: origin + middle,
        range: [-FAR, FAR],
        turns: false,
    };
    Some(Depends {
        levels,
        channels: Channels {
            position,
            ..Channels::default()
        },
        surroundings: Surroundings {
            origin,
            ..Surroundings::default()
        },
    })
}

/// No axis goes so far, m (rad).
const FAR: f64 = 1e12;
