//! What acts on a simulated axis beside its law, inertia and drive.
//!
//! A force that follows the recorded motion is one more load. What changes the level of friction is not: the axis turns round
//! within a few samples of the recorded motion, not with it, and a level that changed sign with the recorded velocity would act
//! early or late by that time, which a fit takes for a delay and then for micro-damping. Its factor follows the record, where
//! it hardly changes in such a time; the bristles that it multiplies are those of the simulated axis.

use crate::conditioning::record::Segment;
use crate::law::dependence::Factor;
use crate::law::terms::{ColumnKind, LinearTerm};
use stiction_friction::LuGre;
use stiction_friction::compensator::Changes;
use stiction_servo::integrator::{Integrator, Mid, Quick};
use stiction_servo::levelled::Levelled;
use stiction_servo::plant::{Load, Motion, Plant};

/// Along a segment.
pub(super) struct Beside {
    /// Force that follows the recorded motion, N (N m).
    force: Vec<f64>,
    /// Factor on the level for bristles that are bent forward and back, at the instants of the samples; empty where nothing
    /// changes it.
    level: Vec<[f64; 2]>,
}

impl Beside {
    /// Of the terms beside a law with their coefficients; `None` where one cannot be simulated.
    pub fn of<'t>(
        segment: &Segment,
        law: &LuGre<f64>,
        terms: impl Iterator<Item = (&'t LinearTerm, &'t f64)>,
    ) -> Option<Self> {
        let n = segment.position.len();
        let coulomb = law.curve().positive().coulomb;
        let (mut out, mut level) = (vec![0.0; n], Vec::new());
        for (term, c) in terms {
            match term.column {
                ColumnKind::Level
                | ColumnKind::Rate
                | ColumnKind::Speed(_)
                | ColumnKind::Acceleration
                | ColumnKind::LevelTimes(Factor::Log(_), _)
                | ColumnKind::RateTimes(Factor::Log(_))
                | ColumnKind::SpeedTimes(Factor::Log(_), _) => {}
                ColumnKind::One => out.iter_mut().for_each(|y| *y += c),
                ColumnKind::Sine(k) => {
                    for (y, x) in out.iter_mut().zip(&segment.position) {
                        *y += c * libm::sin(k * x);
                    }
                }
                ColumnKind::Cosine(k) => {
                    for (y, x) in out.iter_mut().zip(&segment.position) {
                        *y += c * libm::cos(k * x);
                    }
                }
                ColumnKind::LevelTimes(factor, side) => {
                    level.resize(n, [1.0; 2]);
                    for (of, along) in level.iter_mut().zip(factor.along(segment)) {
                        for (gain, bent) in of.iter_mut().zip([1.0, -1.0]) {
                            *gain += c / coulomb * factor.of(along, bent, side);
                        }
                    }
                }
                ColumnKind::SpeedTimes(factor, side) => {
                    let along = factor.along(segment);
                    for ((y, f), &v) in out.iter_mut().zip(along).zip(&segment.velocity) {
                        if side.is_none_or(|side| side.selects(v)) {
                            *y += c * f * v;
                        }
                    }
                }
                ColumnKind::Square(side) => {
                    for (y, &v) in out.iter_mut().zip(&segment.velocity) {
                        if side.is_none_or(|side| side.selects(v)) {
                            *y += c * v * v.abs();
                        }
                    }
                }
                ColumnKind::Element(_) | ColumnKind::Sign(_) | ColumnKind::RateTimes(_) => {
                    return None;
                }
            }
        }
        Some(Self { force: out, level })
    }

    /// What changes the law from this sample to the next.
    fn changes(&self, sample: usize) -> Changes<f64> {
        let mut changes = Changes::none();
        let now = self.level[sample];
        let then = self.level.get(sample + 1).copied().unwrap_or(now);
        for ((gain, now), then) in changes.level.iter_mut().zip(now).zip(then) {
            *gain = (0.5 * (now + then)).max(0.0);
        }
        changes
    }
}

/// The axis with what is beside it, moved sample by sample.
pub(super) struct Stepped<'a> {
    beside: &'a Beside,
    mover: Mover<'a>,
}

#[expect(
    clippy::large_enum_variant,
    reason = "one of a run, on its stack: a box would be read in every step"
)]
enum Mover<'a> {
    Steady(&'a Plant, Quick),
    Levelled(Plant<Levelled<LuGre<f64>>>, Mid),
}

impl<'a> Stepped<'a> {
    /// In so many steps each time that it is moved; `None` for none.
    pub fn new(plant: &'a Plant, beside: &'a Beside, steps: u32) -> Option<Self> {
        let mover = match beside.level.is_empty() {
            true => Mover::Steady(plant, Quick::new(steps).ok()?),
            false => {
                let law = Levelled::unchanged(*plant.law());
                let levelled = Plant::new(plant.mass(), law).ok()?;
                Mover::Levelled(levelled, Mid::new(steps).ok()?)
            }
        };
        Some(Self { beside, mover })
    }

    /// The motion a time of `span` s after `from`, both between this sample and the next, under this force of the drive, N (N m).
    pub fn advance(&mut self, sample: usize, from: Motion, span: f64, force: f64) -> Motion {
        let load = Load::force(force - self.beside.force[sample]);
        match &mut self.mover {
            Mover::Steady(plant, quick) => quick.advance(plant, from, span, load, 0.0),
            Mover::Levelled(plant, mid) => {
                let law = plant.law().with_changes(self.beside.changes(sample));
                mid.advance(&plant.with_law(law), from, span, load, 0.0)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stiction_friction::{Damping, Direction, Shape, Stribeck};

    fn plant(level: f64) -> Plant {
        let side = Direction {
            coulomb: 9.0 * level,
            static_friction: 12.0 * level,
            stribeck_velocity: 0.03,
            viscous: 14.0,
        };
        let curve = Stribeck::symmetric(Shape::Gaussian, side, 0.0).unwrap();
        let law = LuGre::new(12_000.0 * level, Damping::Constant(60.0), curve).unwrap();
        Plant::new(1.2, law).unwrap()
    }

    /// A level that is a quarter higher everywhere is a bristle that is as much stiffer and stronger.
    #[test]
    fn a_level_multiplies_the_bristles_of_the_axis_itself() {
        const SAMPLES: usize = 400;
        let [nothing, higher] = [Vec::new(), vec![[1.25; 2]; SAMPLES]].map(|level| Beside {
            force: vec![0.0; SAMPLES],
            level,
        });
        let (as_it_is, stronger) = (plant(1.0), plant(1.25));
        let mut own = Stepped::new(&as_it_is, &higher, 20).unwrap();
        let mut other = Stepped::new(&stronger, &nothing, 20).unwrap();
        let start = Motion {
            position: 0.0,
            velocity: 0.0,
            deflection: 0.0,
        };
        let (mut a, mut b) = (start, start);
        let mut fastest = 0.0_f64;
        for k in 0..SAMPLES {
            let force = 20.0 * libm::sin(0.05 * k as f64);
            a = own.advance(k, a, 1e-3, force);
            b = other.advance(k, b, 1e-3, force);
            fastest = fastest.max(b.velocity.abs());
            assert!(
                (a.velocity - b.velocity).abs() < 1e-4,
                "sample {k}: {a:?} {b:?}"
            );
        }
        assert!(fastest > 0.1, "{fastest}");
    }
}
