//! The unknowns: the parameters of the law and of the axis, common to all runs.
//!
//! What is positive by nature enters as its logarithm, so no step of the search can make it negative.

use crate::law::terms::{Delay, Mass, Terms};
use crate::law::{Law, LawKind};
use crate::output_error::elements::MOST_ELEMENTS;
use crate::output_error::plant::{Axis, Wave};
use std::f64::consts::TAU;
use stiction_parameters::{Name, Quantity, Side, Wave as Part};

/// Unknowns of each run: position, velocity, bristle deflection over `Fc/s0`, and with a PI controller
/// its integral.
pub(crate) const LOCALS: usize = 4;
/// Most unknowns in all: two of each of ten elements, ten more of an asymmetric law with them, gravity and cogging, those of a
/// run.
pub(crate) const MOST: usize = 44;

/// One unknown that all runs share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unknown {
    /// `ln s0`.
    Stiffness,
    /// `ln s1`.
    MicroDamping,
    /// `s2`, not negative.
    Viscous(Side),
    /// `ln Fc`; Fs changes in proportion.
    Coulomb(Side),
    /// `ln (Fs/Fc - 1)`.
    Excess(Side),
    /// `ln vs`.
    Velocity(Side),
    /// `ln d` of a Maxwell-slip element, by its place.
    Reach(usize),
    /// `ln W`, the yield force of a Maxwell-slip element at rest, by its place.
    Yield(usize),
    /// `ln` of the limit of the elements in the negative direction over that in the positive one.
    Ratio,
    /// `ln a`, the rate at which slipping elements follow the Stribeck curve.
    Attraction,
    /// `ln M`.
    Mass,
    /// Constant force.
    Offset,
    /// Delay of the logged force, s.
    Delay,
    /// Factor of a sine or cosine of the position, by its place.
    Wave(usize),
}

/// The unknowns of a law with its terms, and what is given.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Layout {
    /// In the order of the vector of the search.
    pub unknowns: Vec<Unknown>,
    /// Factors of the position that the waves have, with whether it is a cosine, and their names.
    pub waves: Vec<(Wave, Name)>,
}

impl Layout {
    pub fn new(law: &Law, terms: &Terms) -> Self {
        let sides = Side::all(law.asymmetric);
        let mut unknowns = Vec::new();
        let elements = law.kind.has_elements();
        if law.kind.has_bristle() && !elements {
            unknowns.push(Unknown::Stiffness);
        }
        if law.kind == LawKind::LuGre {
            unknowns.push(Unknown::MicroDamping);
        }
        unknowns.extend(sides.iter().map(|&side| Unknown::Viscous(side)));
        if elements {
            let many = law.elements.min(MOST_ELEMENTS);
            unknowns.extend((0..many).map(Unknown::Reach));
            unknowns.extend((0..many).map(Unknown::Yield));
            unknowns.extend(law.asymmetric.then_some(Unknown::Ratio));
        } else {
            unknowns.extend(sides.iter().map(|&side| Unknown::Coulomb(side)));
        }
        if law.kind.has_stribeck() {
            unknowns.extend(sides.iter().map(|&side| Unknown::Excess(side)));
            unknowns.extend(sides.iter().map(|&side| Unknown::Velocity(side)));
            unknowns.extend(elements.then_some(Unknown::Attraction));
        }
        if terms.mass == Mass::Fitted {
            unknowns.push(Unknown::Mass);
        }
        if terms.offset {
            unknowns.push(Unknown::Offset);
        }
        if terms.delay == Delay::Fitted {
            unknowns.push(Unknown::Delay);
        }
        let mut waves = Vec::new();
        if terms.gravity {
            waves.push((Wave::sine(1.0), Quantity::Gravity(Part::Sine).into()));
            waves.push((Wave::cosine(1.0), Quantity::Gravity(Part::Cosine).into()));
        }
        for (i, pitch) in terms.cogging.iter().enumerate() {
            let of = |part| Quantity::Cogging(i as u32 + 1, part).into();
            waves.push((Wave::sine(TAU / pitch), of(Part::Sine)));
            waves.push((Wave::cosine(TAU / pitch), of(Part::Cosine)));
        }
        unknowns.extend((0..waves.len()).map(Unknown::Wave));
        Self { unknowns, waves }
    }

    pub fn len(&self) -> usize {
        self.unknowns.len()
    }

    /// Place of an unknown in the vector.
    pub fn place(&self, unknown: Unknown) -> Option<usize> {
        self.unknowns.iter().position(|u| *u == unknown)
    }

    /// The values of the unknowns that an axis has.
    pub fn read(&self, axis: &Axis) -> Vec<f64> {
        let ln = |x: f64| libm::log(x.max(f64::MIN_POSITIVE));
        self.unknowns
            .iter()
            .map(|unknown| match *unknown {
                Unknown::Stiffness => ln(axis.stiffness),
                Unknown::MicroDamping => ln(axis.micro_damping),
                Unknown::Viscous(side) => axis.sides[side.index()].viscous,
                Unknown::Coulomb(side) => ln(axis.sides[side.index()].coulomb),
                Unknown::Excess(side) => {
                    let s = &axis.sides[side.index()];
                    ln(s.fixed / s.coulomb - 1.0)
                }
                Unknown::Velocity(side) => ln(axis.sides[side.index()].velocity),
                Unknown::Reach(i) => ln(axis.element(i).reach),
                Unknown::Yield(i) => ln(axis.element(i).force),
                Unknown::Ratio => ln(axis.elements.as_ref().map_or(1.0, |e| e.ratio)),
                Unknown::Attraction => ln(axis.elements.as_ref().map_or(1.0, |e| e.attraction)),
                Unknown::Mass => ln(axis.mass),
                Unknown::Offset => axis.offset,
                Unknown::Delay => axis.delay,
                Unknown::Wave(i) => axis.waves.get(i).map_or(0.0, |w| w.factor),
            })
            .collect()
    }

    /// The axis with these values; what is not sought stays as it is in `base`.
    pub fn write(&self, base: &Axis, q: &[f64]) -> Axis {
        let mut axis = base.clone();
        let each = |side: Side| match side {
            Side::Both => 0..2,
            Side::Positive => 0..1,
            Side::Negative => 1..2,
        };
        // The Coulomb level comes before the excess in the vector, so Fs uses the new level.
        for (unknown, &x) in self.unknowns.iter().zip(q) {
            match *unknown {
                Unknown::Stiffness => axis.stiffness = libm::exp(x),
                Unknown::MicroDamping => axis.micro_damping = libm::exp(x),
                Unknown::Viscous(side) => each(side).for_each(|s| axis.sides[s].viscous = x),
                Unknown::Coulomb(side) => each(side).for_each(|s| {
                    let ratio = axis.sides[s].fixed / axis.sides[s].coulomb;
                    axis.sides[s].coulomb = libm::exp(x);
                    axis.sides[s].fixed = ratio * libm::exp(x);
                }),
                Unknown::Excess(side) => each(side).for_each(|s| {
                    axis.sides[s].fixed = axis.sides[s].coulomb * (1.0 + libm::exp(x));
                }),
                Unknown::Velocity(side) => {
                    each(side).for_each(|s| axis.sides[s].velocity = libm::exp(x));
                }
                Unknown::Reach(_) | Unknown::Yield(_) | Unknown::Ratio | Unknown::Attraction => {
                    if let Some(elements) = &mut axis.elements {
                        elements.set(*unknown, libm::exp(x));
                    }
                }
                Unknown::Mass => axis.mass = libm::exp(x),
                Unknown::Offset => axis.offset = x,
                Unknown::Delay => axis.delay = x,
                Unknown::Wave(i) => {
                    if let Some(wave) = axis.waves.get_mut(i) {
                        wave.factor = x;
                    }
                }
            }
        }
        axis.follow_elements();
        axis
    }
}
