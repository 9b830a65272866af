//! Friction that depends on where the axis is, on its load and its temperature, and viscous friction that bends.

use crate::integrator::Integrator;
use crate::law::{AxisLaw, OfAxis};
use crate::plant::{Load, Motion, Plant};
use crate::surroundings::Surroundings;
use stiction_friction::compensator::{Changes, Channels, Levels};
use stiction_friction::{Held, Pace, Stribeck};

/// A law whose level is changed, as a compensator has it: the force of the deflections by a factor for the direction in which
/// they are bent, viscous friction by an addition. Micro-damping, presliding length and offset stay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Levelled<L> {
    law: L,
    changes: Changes<f64>,
}

impl<L> Levelled<L> {
    /// The law as it is.
    pub fn unchanged(law: L) -> Self {
        Levelled {
            law,
            changes: Changes::none(),
        }
    }

    /// The same law, changed by this and nothing else.
    #[must_use]
    pub fn with_changes(self, changes: Changes<f64>) -> Self {
        Levelled { changes, ..self }
    }

    /// What the force of deflections gains; the factor on its derivative.
    fn gain(&self, spring: f64) -> (f64, f64) {
        let more = self.changes.level[usize::from(spring <= 0.0)] - 1.0;
        (more * spring, more)
    }

    /// What viscous friction gains, as a force.
    fn viscous(&self, v: f64) -> f64 {
        self.changes.viscous(v).0 * v
    }
}

impl<L: Held<f64>> Held<f64> for Levelled<L> {
    type State = L::State;

    fn curve(&self) -> &Stribeck<f64> {
        self.law.curve()
    }

    fn hold(&self, from: L::State, h: f64, v: f64) -> L::State {
        self.law.hold(from, h, v)
    }

    fn mean_force(&self, from: L::State, to: L::State, h: f64, v: f64) -> f64 {
        let ends = [from, to].map(|state| self.gain(self.law.spring(state)).0);
        self.law.mean_force(from, to, h, v) + 0.5 * (ends[0] + ends[1]) + self.viscous(v)
    }

    fn mean_force_slope(&self, from: L::State, pace: &Pace<f64>, v: f64) -> (f64, f64) {
        let (force, slope) = self.law.mean_force_slope(from, pace, v);
        let (end, end_slope) = self.law.spring_slope(from, pace.h, v);
        let (begin, _) = self.gain(self.law.spring(from));
        let (end, more) = self.gain(end);
        let (viscous, more_viscous) = self.changes.viscous(v);
        (
            force + 0.5 * (begin + end) + viscous * v,
            slope + 0.5 * more * end_slope + more_viscous,
        )
    }

    fn force_now(&self, state: L::State, v: f64) -> f64 {
        self.law.force_now(state, v) + self.gain(self.law.spring(state)).0 + self.viscous(v)
    }

    fn spring_slope(&self, from: L::State, h: f64, v: f64) -> (f64, f64) {
        let (end, slope) = self.law.spring_slope(from, h, v);
        let (gain, more) = self.gain(end);
        (end + gain, slope + more * slope)
    }

    fn spring(&self, state: L::State) -> f64 {
        let spring = self.law.spring(state);
        spring + self.gain(spring).0
    }

    fn reach(&self, h: f64) -> f64 {
        let [forward, back] = self.changes.level;
        self.law.reach(h) * forward.max(back).max(1.0)
    }
}

impl<L: OfAxis> OfAxis for Levelled<L> {
    fn of(law: &AxisLaw) -> Option<Self> {
        L::of(law).map(Levelled::unchanged)
    }
}

/// What the friction of an axis depends on, and what that is while it runs; its default is nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Depends {
    /// How the level changes.
    pub levels: Levels<f64>,
    /// With what: references and ranges.
    pub channels: Channels<f64>,
    /// Load, temperature and place of the axis.
    pub surroundings: Surroundings,
}

impl Depends {
    /// Whether friction depends on the load.
    pub fn on_load(&self) -> bool {
        self.levels.load != [0.0; 2]
    }

    /// Whether friction depends on the temperature.
    pub fn on_temperature(&self) -> bool {
        [self.levels.temperature, self.levels.viscous] != [[0.0; 2]; 2]
    }

    /// Whether friction depends on the position.
    pub fn on_position(&self) -> bool {
        let waves = self.levels.waves.iter().flatten();
        self.levels.position != [0.0; 2] || waves.into_iter().any(|wave| wave.rate > 0.0)
    }
}

/// An integrator for an axis whose friction depends on more than its velocity; the level is held over each span.
#[derive(Clone, Debug)]
pub struct Depending<I> {
    integrator: I,
    depends: Depends,
}

impl<I> Depending<I> {
    /// Moves the axis by `integrator`.
    pub fn new(integrator: I, depends: Depends) -> Self {
        Depending {
            integrator,
            depends,
        }
    }
}

impl<L: Held<f64>, I: Integrator<Levelled<L>>> Integrator<Levelled<L>> for Depending<I> {
    fn advance(
        &mut self,
        plant: &Plant<Levelled<L>>,
        from: Motion<L::State>,
        span: f64,
        load: Load,
        rate: f64,
    ) -> Motion<L::State> {
        let Depends {
            levels,
            channels,
            surroundings,
        } = &self.depends;
        let middle = from.position + 0.5 * span * from.velocity;
        let curve = plant.law().curve();
        let sigma2 = [curve.positive(), curve.negative()].map(|side| side.viscous);
        let changes = levels.changes(channels, surroundings.seen(middle), sigma2);
        let there = plant.with_law(plant.law().with_changes(changes));
        self.integrator.advance(&there, from, span, load, rate)
    }

    fn expect(&mut self, next: f64) {
        self.integrator.expect(next);
    }

    fn forget(&mut self) {
        self.integrator.forget();
    }
}
