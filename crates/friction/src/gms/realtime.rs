//! The step that runs on the drive, and what a simulation needs.

use super::{Element, Elements, Gms};
use crate::{Real, Stribeck};

/// What a running GMS law remembers between samples. Start from [`Gms::rest`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GmsState<T, const N: usize> {
    /// The elements.
    pub elements: Elements<T, N>,
    /// The force last returned, N (N m).
    pub force: T,
}

/// A stretch of time at a held velocity.
pub(super) struct Way<T> {
    /// Its length, s.
    pub h: T,
    /// m/s (rad/s)
    pub v: T,
    /// Attraction C, N/s (N m/s).
    pub attraction: T,
    /// Whether an element that slips is loaded no faster than one that sticks.
    pub passive: bool,
}

/// Elements after a stretch of time at a held velocity, exactly; all slip with the same exponential.
pub(super) fn hold<T: Real, const N: usize>(
    elements: &[Element<T>],
    curve: &Stribeck<T>,
    way: &Way<T>,
    at: &mut Elements<T, N>,
) {
    let &Way { h, v, .. } = way;
    if h <= T::ZERO {
        return;
    }
    let forward = v > T::ZERO;
    if v == T::ZERO || at.forward != forward {
        at.slips = [false; N];
    }
    if v == T::ZERO {
        return;
    }
    at.forward = forward;
    let g = curve.level(v);
    let path = h * v.abs();
    let e = (-(h * (way.attraction / g))).expm1();
    let each = at.force.iter_mut().zip(&mut at.slips).zip(elements);
    for ((force, slips), element) in each {
        let along = if forward { *force } else { -*force };
        let limit = element.share * g;
        let stuck = along + element.stiffness * path;
        let mut end = stuck;
        if *slips || along >= limit {
            // It may begin beyond its limit: where the limit has fallen, or where the other direction has the higher level.
            *slips = true;
            end = along + (along - limit) * e;
            if way.passive {
                end = end.min(stuck);
            }
        } else if stuck >= limit {
            *slips = true;
            end = limit;
        }
        *force = if forward { end } else { -end };
    }
}

/// The sum of the spring forces after `h > 0` seconds at the velocity `v`, and its derivative with respect to `v`.
pub(super) fn held_slope<T: Real, const N: usize>(
    elements: &[Element<T>],
    curve: &Stribeck<T>,
    attraction: T,
    from: &Elements<T, N>,
    (h, v): (T, T),
) -> (T, T) {
    let forward = v >= T::ZERO;
    let mut to = *from;
    let way = Way {
        h,
        v,
        attraction,
        passive: false,
    };
    hold(elements, curve, &way, &mut to);
    let (g, g_slope) = curve.level_and_slope(v);
    let sign = if forward { T::ONE } else { -T::ONE };
    let mut slope = T::ZERO;
    for (i, element) in elements.iter().enumerate() {
        let limit = element.share * g;
        let start = sign * from.force[i];
        let slipped = from.slips[i] && from.forward == forward;
        slope = slope
            + if !to.slips[i] {
                element.stiffness * h
            } else {
                // Where it has reached the limit inside the step it stays there; else it still approaches it.
                let gap = if slipped || start > limit {
                    start - limit
                } else {
                    T::ZERO
                };
                let a = h * (attraction / g);
                let left = (-a).exp();
                // Where one of the factors is 0 the derivative is 0 too; a may be infinite there, and the product
                // NaN.
                let by_pull = if left == T::ZERO || gap == T::ZERO {
                    T::ZERO
                } else {
                    gap * left * (a * g_slope / g)
                };
                let by_limit = if gap == T::ZERO {
                    T::ONE
                } else {
                    T::ONE - left
                };
                sign * (element.share * g_slope * by_limit + by_pull)
            };
    }
    (to.total(), slope)
}

impl<T: Real, const N: usize> Gms<T, N> {
    /// The state at rest: unloaded elements, the offset as force.
    pub fn rest(&self) -> GmsState<T, N> {
        GmsState {
            elements: Elements::default(),
            force: self.curve.offset(),
        }
    }

    /// The elements after `h` seconds at the velocity `v` (m/s, rad/s), exact for a held velocity, each within its share
    /// of the largest static level.
    ///
    /// `h <= 0` leaves the elements as they are, within that bound.
    pub fn step_held(&self, from: Elements<T, N>, h: T, v: T) -> Elements<T, N> {
        let mut to = from;
        let way = Way {
            h,
            v,
            attraction: self.attraction,
            passive: false,
        };
        hold(&self.elements, &self.curve, &way, &mut to);
        self.clamp(to)
    }

    /// [`step_held`](Self::step_held) without the clamp, as the sum of the spring forces and its derivative with respect
    /// to `v` (N s/m, N m s/rad): what an implicit simulation needs. `h > 0`; where `v` changes sign the derivative is
    /// that from above.
    pub fn total_held_slope(&self, from: &Elements<T, N>, h: T, v: T) -> (T, T) {
        held_slope(&self.elements, &self.curve, self.attraction, from, (h, v))
    }

    /// One sample of the law in real time: advances `state` by `h` seconds at the velocity `v` (m/s, rad/s) and returns
    /// the friction force, N (N m), with the mean rate of the elements over the sample.
    ///
    /// The force is finite whatever comes in: a sample whose `v` or `h` is not finite, whose `h` is negative, or whose
    /// force would overflow, leaves the elements as they are and returns the force of the sample before (the offset, if
    /// there was none). `h = 0` gives the force at the present elements. The elements are held within their share of the
    /// largest static level, a force that is not a number becomes 0.
    pub fn step(&self, state: &mut GmsState<T, N>, h: T, v: T) -> T {
        state.elements = self.clamp(state.elements);
        if !state.force.is_finite() {
            state.force = self.curve.offset();
        }
        if v.is_finite() && h.is_finite() && h >= T::ZERO {
            let elements = self.step_held(state.elements, h, v);
            let rate = if h > T::ZERO {
                (elements.total() - state.elements.total()) / h
            } else {
                self.total_rate(&elements, v)
            };
            let force = self.force_at_rate(elements.total(), rate, v);
            if force.is_finite() {
                *state = GmsState { elements, force };
            }
        }
        state.force
    }

    fn clamp(&self, mut at: Elements<T, N>) -> Elements<T, N> {
        let level = self.bound();
        for (force, element) in at.force.iter_mut().zip(&self.elements) {
            let limit = element.share * level;
            *force = if force.is_finite() {
                force.max(-limit).min(limit)
            } else {
                T::ZERO
            };
        }
        at
    }
}
