//! The law with as many elements as the program finds when it runs, and the step that runs on the drive.

use super::realtime::{Way, held_slope, hold};
use super::{Element, Elements, Gms, GmsState, checked};
use crate::{Held, Pace, ParamError, Real, Stribeck};

/// Most elements of a law.
pub const MOST_ELEMENTS: usize = 10;

/// A (generalised) Maxwell-slip law of 1 to 10 elements, validated and immutable: what [`Gms`] is, with the number of elements
/// known when the program runs, and without micro-damping.
///
/// Its [`step`](Self::step) is that of a compensator: passive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaxwellSlip<T> {
    /// Those beyond the count stay at rest.
    elements: [Element<T>; MOST_ELEMENTS],
    count: usize,
    attraction: T,
    curve: Stribeck<T>,
    stiffness: T,
}

impl<T: Real> MaxwellSlip<T> {
    /// The elements; `attraction` C in N/s (N m/s), > 0, infinite for Maxwell slip; the steady curve with sigma2 and F0.
    pub fn new(
        elements: &[Element<T>],
        attraction: T,
        curve: Stribeck<T>,
    ) -> Result<Self, ParamError> {
        let none = Element {
            stiffness: T::ZERO,
            share: T::ZERO,
        };
        let mut own = [none; MOST_ELEMENTS];
        let count = elements.len().min(MOST_ELEMENTS);
        own[..count].copy_from_slice(&elements[..count]);
        if elements.len() > MOST_ELEMENTS {
            let found = T::from_f64(elements.len() as f64);
            return Err(ParamError::new("elements", found, "1 to 10"));
        }
        let stiffness = checked(&mut own[..count], attraction, T::ZERO, &curve)?;
        Ok(MaxwellSlip {
            elements: own,
            count,
            attraction,
            curve,
            stiffness,
        })
    }

    /// The elements, their shares with the sum 1.
    pub fn elements(&self) -> &[Element<T>] {
        &self.elements[..self.count]
    }

    /// Attraction C, N/s (N m/s).
    pub fn attraction(&self) -> T {
        self.attraction
    }

    /// The steady curve.
    pub fn curve(&self) -> &Stribeck<T> {
        &self.curve
    }

    /// Stiffness while all elements stick, the sum of the k_i, N/m (N m/rad).
    pub fn stiffness(&self) -> T {
        self.stiffness
    }

    /// The largest |sum F_i| that any motion can lead to, `max(Fs+, Fs-)`, N (N m).
    #[inline]
    pub fn bound(&self) -> T {
        self.curve.largest_static_level()
    }

    /// The way from rest after which the last element slips at the largest static level, m (rad).
    pub fn longest_yield(&self) -> T {
        let level = self.bound();
        self.elements().iter().fold(T::ZERO, |most, element| {
            most.max(element.share * level / element.stiffness)
        })
    }

    /// The law of `N` elements; `None` where there are more or fewer.
    pub fn gms<const N: usize>(&self) -> Option<Gms<T, N>> {
        Some(Gms {
            elements: self.elements().try_into().ok()?,
            attraction: self.attraction,
            damping: T::ZERO,
            curve: self.curve,
            stiffness: self.stiffness,
        })
    }

    /// The same law in another number type; an error if a number does not survive the change.
    pub fn cast<U: Real>(&self) -> Result<MaxwellSlip<U>, ParamError> {
        let to = |x: T| U::from_f64(x.to_f64());
        let elements = self.elements.map(|e| Element {
            stiffness: to(e.stiffness),
            share: to(e.share),
        });
        let attraction = to(self.attraction);
        MaxwellSlip::new(&elements[..self.count], attraction, self.curve.cast()?)
    }

    /// The state at rest: unloaded elements, the offset as force.
    pub fn rest(&self) -> GmsState<T, MOST_ELEMENTS> {
        GmsState {
            elements: Elements::default(),
            force: self.curve.offset(),
        }
    }

    /// One sample of the law in real time: advances `state` by `h` seconds at the velocity `v` (m/s, rad/s) and returns
    /// the friction force, N (N m).
    ///
    /// Exact for a held velocity, with one thing more than [`Gms::step_held`]: an element that slips is loaded no faster than
    /// one that sticks, `dF_i <= k_i h |v|`, so its slider never moves against the axis. Where the level rises because
    /// the axis slows down the law itself loads elements in time, without motion, and could give that energy back. With this no sample
    /// creates energy: work done on the law is at least the growth of `sum F_i^2/(2 k_i)`.
    ///
    /// The force is finite whatever comes in, as with [`Gms::step`].
    pub fn step(&self, state: &mut GmsState<T, MOST_ELEMENTS>, h: T, v: T) -> T {
        let level = self.bound();
        for (force, element) in state.elements.force.iter_mut().zip(self.elements()) {
            let limit = element.share * level;
            *force = match force.is_finite() {
                true => force.max(-limit).min(limit),
                false => T::ZERO,
            };
        }
        if !state.force.is_finite() {
            state.force = self.curve.offset();
        }
        if v.is_finite() && h >= T::ZERO && h <= T::MAX {
            let mut elements = state.elements;
            let way = Way {
                h,
                v,
                attraction: self.attraction,
                passive: true,
            };
            hold(self.elements(), &self.curve, &way, &mut elements);
            let total = self.total(&elements);
            let force = total + self.curve.direction(v).viscous * v + self.curve.offset();
            if force.is_finite() {
                *state = GmsState { elements, force };
            }
        }
        state.force
    }

    /// Sum of the spring forces, N (N m).
    #[inline]
    pub fn total(&self, at: &Elements<T, MOST_ELEMENTS>) -> T {
        let own = at.force.iter().take(self.count);
        own.fold(T::ZERO, |sum, &force| sum + force)
    }
}

/// The law as it is, not that of a compensator: what [`Gms`] does.
impl<T: Real> Held<T> for MaxwellSlip<T> {
    type State = Elements<T, MOST_ELEMENTS>;

    fn curve(&self) -> &Stribeck<T> {
        &self.curve
    }

    fn hold(&self, mut from: Self::State, h: T, v: T) -> Self::State {
        let way = Way {
            h,
            v,
            attraction: self.attraction,
            passive: false,
        };
        hold(self.elements(), &self.curve, &way, &mut from);
        from
    }

    fn mean_force(&self, from: Self::State, to: Self::State, _: T, v: T) -> T {
        let mean = T::from_f64(0.5) * (self.total(&from) + self.total(&to));
        mean + self.curve.direction(v).viscous * v + self.curve.offset()
    }

    fn mean_force_slope(&self, from: Self::State, &Pace { h, .. }: &Pace<T>, v: T) -> (T, T) {
        let (end, slope) = held_slope(self.elements(), &self.curve, self.attraction, &from, (h, v));
        let half = T::from_f64(0.5);
        let viscous = self.curve.direction(v).viscous;
        let mean = half * (self.total(&from) + end);
        (
            mean + viscous * v + self.curve.offset(),
            half * slope + viscous,
        )
    }

    fn force_now(&self, state: Self::State, v: T) -> T {
        self.total(&state) + self.curve.direction(v).viscous * v + self.curve.offset()
    }

    fn spring_slope(&self, from: Self::State, h: T, v: T) -> (T, T) {
        held_slope(self.elements(), &self.curve, self.attraction, &from, (h, v))
    }

    fn spring(&self, state: Self::State) -> T {
        self.total(&state)
    }

    fn reach(&self, _: T) -> T {
        self.bound()
    }
}
