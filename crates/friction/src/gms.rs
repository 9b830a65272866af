//! The generalised Maxwell-slip law; its steps are in `record` and `realtime`.

mod maxwell_slip;
mod realtime;
mod record;

use crate::error::require;
use crate::{ParamError, Real, Stribeck};

pub use maxwell_slip::{MOST_ELEMENTS, MaxwellSlip};
pub use realtime::GmsState;

/// One element of a [`Gms`] law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Element<T> {
    /// Stiffness k_i > 0, N/m (N m/rad).
    pub stiffness: T,
    /// Share nu_i > 0 of the friction level; only the ratios of the shares matter, [`Gms::new`] makes their sum 1. So where
    /// the yield deflections of the elements are known, stiffness times yield deflection can be given.
    pub share: T,
}

/// State of the elements of a [`Gms`] law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elements<T, const N: usize> {
    /// Spring force F_i of each, N (N m).
    pub force: [T; N],
    /// Which of them slip; the others stick.
    pub slips: [bool; N],
    /// The direction in which they slip: towards positive velocity or not.
    pub forward: bool,
}

impl<T: Real, const N: usize> Default for Elements<T, N> {
    /// Unloaded and sticking.
    fn default() -> Self {
        Elements {
            force: [T::ZERO; N],
            slips: [false; N],
            forward: true,
        }
    }
}

impl<T: Real, const N: usize> Elements<T, N> {
    /// Sum of the spring forces, N (N m).
    #[inline]
    pub fn total(&self) -> T {
        self.force.iter().fold(T::ZERO, |sum, &f| sum + f)
    }
}

/// The generalised Maxwell-slip (GMS) friction law of `N` = 1 to 10 elements, validated and immutable.
///
/// ```text
/// F_i' = k_i v                              an element sticks until |F_i| reaches nu_i g(v),
/// F_i' = sgn(v) C (nu_i - |F_i|/g(v))       then slips until the velocity goes through zero
/// F    = sum F_i + sigma1 (sum F_i')/(sum k_i) + sigma2 v + F0
/// ```
/// Source: Al-Bender, Lampaert, Swevers 2005, doi 10.1109/TAC.2005.858676: the states of stick and of slip in terms of the
/// element forces, with shares nu_i whose sum is 1, so the attraction C is a force rate, N/s (N m/s), the same for all
/// elements, and in sliding all forces follow the curve g(v) with the time constant g/C. An infinite C is Maxwell slip:
/// a slipping element stays at its limit. In terms of deflections, `z_i = F_i/k_i`, slip reads
/// `z_i' = sgn(v) (C/k_i)(nu_i - k_i z_i/g)`.
/// The micro-damping on the elements is spread like their stiffness: each element has the damping time
/// `sigma1/(sum k_i)`, and while all stick the law damps as LuGre does, by sigma1.
/// Asymmetric: g and sigma2 per direction of motion, the element forces continuous through reversal.
///
/// Since elements slip in time rather than in path, friction that rises while the axis slows down can return energy: the
/// law is passive where g is constant (Fs = Fc), at any sigma1, but not in general.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gms<T, const N: usize> {
    elements: [Element<T>; N],
    attraction: T,
    damping: T,
    curve: Stribeck<T>,
    stiffness: T,
}

impl<T: Real, const N: usize> Gms<T, N> {
    /// The elements; `attraction` C in N/s (N m/s), > 0, infinite for Maxwell slip; `damping` sigma1 >= 0 in N s/m
    /// (N m s/rad); the steady curve with sigma2 and F0.
    pub fn new(
        elements: [Element<T>; N],
        attraction: T,
        damping: T,
        curve: Stribeck<T>,
    ) -> Result<Self, ParamError> {
        let mut elements = elements;
        let stiffness = checked(&mut elements, attraction, damping, &curve)?;
        Ok(Gms {
            elements,
            attraction,
            damping,
            curve,
            stiffness,
        })
    }

    /// The elements, their shares with the sum 1.
    pub fn elements(&self) -> &[Element<T>; N] {
        &self.elements
    }

    /// Attraction C, N/s (N m/s).
    pub fn attraction(&self) -> T {
        self.attraction
    }

    /// Micro-damping sigma1 while all elements stick, N s/m (N m s/rad).
    pub fn damping(&self) -> T {
        self.damping
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

    /// The same law in another number type; an error if a number does not survive the change.
    pub fn cast<U: Real>(&self) -> Result<Gms<U, N>, ParamError> {
        let to = |x: T| U::from_f64(x.to_f64());
        Gms::new(
            self.elements.map(|e| Element {
                stiffness: to(e.stiffness),
                share: to(e.share),
            }),
            to(self.attraction),
            to(self.damping),
            self.curve.cast()?,
        )
    }

    /// Rate of the sum of the spring forces, N/s (N m/s), at velocity `v` (m/s, rad/s).
    ///
    /// With an infinite attraction slipping elements count as steady: the rate at which the limit itself moves is known
    /// over a step only.
    pub fn total_rate(&self, at: &Elements<T, N>, v: T) -> T {
        if v == T::ZERO {
            return T::ZERO;
        }
        let forward = v > T::ZERO;
        let sign = if forward { T::ONE } else { -T::ONE };
        let g = self.curve.level(v);
        let mut rate = T::ZERO;
        for ((element, &force), &slips) in self.elements.iter().zip(&at.force).zip(&at.slips) {
            let along = sign * force;
            let slips = slips && at.forward == forward;
            rate = rate
                + if !slips && along < element.share * g {
                    element.stiffness * v
                } else if self.attraction.is_finite() {
                    sign * (self.attraction * (element.share - along / g))
                } else {
                    T::ZERO
                };
        }
        rate
    }

    /// Friction force in N (N m) of the elements at velocity `v` (m/s, rad/s), with their rates from the state equations.
    #[inline]
    pub fn force(&self, at: &Elements<T, N>, v: T) -> T {
        self.force_at_rate(at.total(), self.total_rate(at, v), v)
    }

    /// Friction force in N (N m) at a sum of the spring forces (N, N m), its rate (N/s, N m/s) and the velocity `v`.
    #[inline]
    pub fn force_at_rate(&self, total: T, rate: T, v: T) -> T {
        total
            + self.damping * (rate / self.stiffness)
            + self.curve.direction(v).viscous * v
            + self.curve.offset()
    }
}

/// Refuses elements, attraction C, micro-damping or a curve that make no law; gives the shares the sum 1, and returns the sum of
/// the stiffnesses.
fn checked<T: Real>(
    elements: &mut [Element<T>],
    attraction: T,
    damping: T,
    curve: &Stribeck<T>,
) -> Result<T, ParamError> {
    require(
        (1..=MOST_ELEMENTS).contains(&elements.len()),
        "elements",
        T::from_f64(elements.len() as f64),
        "1 to 10",
    )?;
    for element in elements.iter() {
        ParamError::positive("element_stiffness", element.stiffness)?;
        ParamError::positive("element_share", element.share)?;
    }
    require(attraction > T::ZERO, "attraction", attraction, "> 0")?;
    ParamError::not_negative("sigma1", damping)?;
    let sum = |of: fn(&Element<T>) -> T| elements.iter().fold(T::ZERO, |sum, e| sum + of(e));
    let stiffness = sum(|e| e.stiffness);
    ParamError::positive("sum of element_stiffness", stiffness)?;
    let shares = sum(|e| e.share);
    ParamError::positive("sum of element_share", shares)?;
    // Differences of two forces must not overflow.
    let level = curve.largest_static_level();
    require(
        (level * T::from_f64(4.0)).is_finite(),
        "static",
        level,
        "well within the range of the number type",
    )?;
    for element in elements {
        element.share = element.share / shares;
    }
    Ok(stiffness)
}
