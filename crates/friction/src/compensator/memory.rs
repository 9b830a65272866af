//! What a compensator has learnt, as numbers that a drive keeps while it is off.

use super::adaptation::Adaptation;
use super::watchdog::{Trip, Watch};
use super::{Compensator, Friction};
use crate::{Real, Shape};
use core::fmt;

/// How many numbers a memory has.
pub const MEMORY: usize = 2 * KEPT;
/// Those that it keeps; the other half are the same with the opposite sign.
const KEPT: usize = 6;
/// Form of a memory: the next one counts on.
const VERSION: u64 = 2;
/// Keys are whole numbers below this: single precision holds each of them exactly, and so do tools that write six digits.
const KEYS: u64 = 1_000_000;

/// Part of the rms error that the peak is at least, but for rounding.
const LEAST_PEAK: f64 = 0.999;

/// A memory that was not taken: of another law, mass or version, damaged, beyond what can be learnt, or too late.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ForeignMemory;

impl fmt::Display for ForeignMemory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(
            "the memory is of another model or version, damaged or beyond what can be learnt, or force is let out already; \
             nothing was taken from it",
        )
    }
}

impl core::error::Error for ForeignMemory {}

impl<T: Real> Compensator<T> {
    /// What it has learnt, to be kept while it is off: a key of law, mass and version; the factors on the dry part of friction and
    /// on the viscous one; mean square and largest error without compensation, the former negative where they are not known; why
    /// the watchdog has switched off, 0 if it has not. Each a second time with the opposite sign.
    pub fn memory(&self) -> [T; MEMORY] {
        let (learnt, watch) = (&self.state.learnt, &self.state.watch);
        let reason = match watch.trip {
            None => 0.0,
            Some(Trip::Mean) => 1.0,
            Some(Trip::Peak) => 2.0,
        };
        let kept = [
            T::from_f64(f64::from(self.key())),
            learnt.level,
            learnt.viscous,
            watch.without,
            watch.peak_without,
            T::from_f64(reason),
        ];
        core::array::from_fn(|k| if k < KEPT { kept[k] } else { -kept[k - KEPT] })
    }

    /// Takes what [`memory`](Self::memory) gave before: factors, and what the watchdog had learnt, so that compensation may come in
    /// at once. A watchdog that had switched off still has. To be called before the first step.
    ///
    /// # Errors
    /// Where the memory is of another law, mass or version, damaged, has a factor beyond the range of the adaptation or a mean square
    /// beyond the square of the peak, or where force is let out already; nothing is taken then.
    ///
    /// ```
    /// # use stiction_friction::compensator::{Compensator, Friction, Settings, Source};
    /// # use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
    /// # let both = Direction { coulomb: 12.0, static_friction: 18.0, stribeck_velocity: 3e-3, viscous: 30.0 };
    /// # let law = LuGre::new(2e6, Damping::Capped(1.5e3), Stribeck::symmetric(Shape::Gaussian, both, 0.0)?)?;
    /// # let mut compensator = Compensator::new(Friction::LuGre(law), Source::Reference, Settings::new(1e-3, 40.0))?;
    /// let mut kept = compensator.memory();
    /// assert!(compensator.recall(&kept).is_ok());
    /// kept[1] = 1.2; // not in its second copy
    /// assert!(compensator.recall(&kept).is_err());
    /// # Ok::<(), stiction_friction::ParamError>(())
    /// ```
    pub fn recall(&mut self, memory: &[T; MEMORY]) -> Result<(), ForeignMemory> {
        let (kept, copies) = memory.split_at(KEPT);
        let whole = kept.iter().zip(copies).all(|(a, b)| *a + *b == T::ZERO);
        let &[key, level, viscous, without, peak, reason] = kept else {
            return Err(ForeignMemory);
        };
        let known = without >= T::ZERO;
        let trip = match reason.to_f64() {
            0.0 => None,
            1.0 => Some(Trip::Mean),
            2.0 => Some(Trip::Peak),
            _ => return Err(ForeignMemory),
        };
        let own = key == T::from_f64(f64::from(self.key()));
        let running = self.state.share > T::ZERO;
        let rms = without.max(T::ZERO).sqrt();
        let possible = peak >= T::ZERO && T::from_f64(LEAST_PEAK) * rms <= peak;
        let credible = !running && possible && self.takes([level, viscous]);
        if !(whole && own && credible && (known || without == -T::ONE)) {
            return Err(ForeignMemory);
        }
        if self.settings.adaptation.is_some() {
            self.state.learnt.recall(level, viscous);
        }
        // One that has switched off since is not armed again.
        let trip = self.state.watch.trip.or(trip);
        self.state.watch = match known {
            true => Watch::recalled(without, peak, trip),
            false => Watch {
                trip,
                ..Watch::default()
            },
        };
        Ok(())
    }

    /// Whether factors are within the range of the adaptation; without one they count for nothing, and are above 0.
    fn takes(&self, factors: [T; 2]) -> bool {
        let within = |factor: T| match self.settings.adaptation {
            Some(Adaptation { range, .. }) => factor >= T::ONE - range && factor <= T::ONE + range,
            None => factor > T::ZERO,
        };
        factors.into_iter().all(within)
    }

    /// A whole number below 10^6 that another law or mass hardly shares; the code that is exported has it as a constant.
    pub fn key(&self) -> u32 {
        let mut hash = Hash::new();
        hash.add(VERSION);
        if let Friction::Coulomb(law) = &self.friction {
            hash.numbers(law.coulomb());
            hash.numbers(law.viscous());
        }
        if let Some(curve) = self.friction.curve() {
            for side in [curve.positive(), curve.negative()] {
                hash.numbers([side.coulomb, side.static_friction]);
                hash.numbers([side.stribeck_velocity, side.viscous]);
            }
            let exponent = match curve.shape() {
                Shape::Gaussian => T::from_f64(2.0),
                Shape::Exponential => T::ONE,
                Shape::Lorentzian => -T::ONE,
                Shape::Power(exponent) => exponent,
            };
            hash.numbers([exponent]);
        }
        if let Some(law) = self.friction.bristle() {
            hash.numbers([law.stiffness(), law.damping().at_rest()]);
        }
        match &self.friction {
            Friction::ElastoPlastic(law) => hash.numbers([law.breakaway()]),
            Friction::Gms(law) => {
                hash.numbers([law.attraction()]);
                for element in law.elements() {
                    hash.numbers([element.stiffness, element.share]);
                }
            }
            Friction::Coulomb(_) | Friction::Stribeck(_) | Friction::LuGre(_) => {}
        }
        let mass = self.settings.adaptation.map_or(T::ZERO, |a| a.mass);
        hash.numbers([self.friction.offset(), mass]);
        if let Some(terms) = &self.terms {
            terms.numbers(&mut |number| hash.numbers([number]));
        }
        hash.key()
    }
}

/// FNV-1a over whole numbers (Fowler, Noll, Vo; draft-eastlake-fnv).
struct Hash(u64);

impl Hash {
    fn new() -> Self {
        Hash(0xcbf2_9ce4_8422_2325)
    }

    fn add(&mut self, number: u64) {
        for byte in number.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    fn numbers<T: Real, const N: usize>(&mut self, numbers: [T; N]) {
        for number in numbers {
            self.add(number.to_f64().to_bits());
        }
    }

    /// Both ends of the hash in one, and never 0, which an empty memory has.
    fn key(&self) -> u32 {
        let folded = (self.0 ^ (self.0 >> 24) ^ (self.0 >> 48)) % KEYS;
        u32::try_from(folded.max(1)).unwrap_or(1)
    }
}
