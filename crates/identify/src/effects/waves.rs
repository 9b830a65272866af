//! A force, or a level of friction, that repeats with the position.
//!
//! The residual is summed over the places of the stroke, and the spectrum of that over the position says at which pitch most of it
//! repeats, down to two counts of the encoder. The pitch is then refined beside the law.

use super::beside::Beside;
use super::{Candidate, Effect, Fitted, Wave};
use crate::law::terms::Terms;
use crate::separable::objective::{Evaluation, Objective};
use std::f64::consts::TAU;
use stiction_parameters::{Quantity, Wave as Part};
use stiction_policy::effect;
use stiction_signal::Lags;

/// Places for each shortest wave, and the transform over the stroke in parts of itself: between two pitches the phase at the end of
/// the stroke differs by a quarter.
const PLACES: usize = 4;
const FINE: usize = 4;
/// Most places, and fewest kept samples for each wave.
const MOST_PLACES: usize = 1 << 14;
const SAMPLES: usize = 8;
/// Steps of the golden section.
const STEPS: usize = 24;

pub(super) fn candidates(fitted: &Fitted, beside: &Beside) -> Vec<Candidate> {
    let mut out = Vec::new();
    let Some((low, high)) = fitted.stroke() else {
        return out;
    };
    let stroke = high - low;
    let ones = vec![1.0; fitted.level.len()];
    for (is_of_level, weight) in [(false, &ones), (true, &fitted.level)] {
        let position = &fitted.measures.position;
        let along = Along {
            position,
            weight,
            low,
            stroke,
        };
        let made = move |wave: Wave| match is_of_level {
            true => Effect::LevelWave(wave),
            false => Effect::Ripple(wave),
        };
        if let Some(pitch) = along.best(fitted, beside) {
            let of = move |c: &[f64]| {
                let amplitude = c[0].hypot(c[1]);
                Some(made(Wave {
                    pitch,
                    amplitude,
                    stroke,
                    replaces: None,
                }))
            };
            let mut candidate = Candidate::new(along.wave(pitch).into(), of);
            // Of a wave of amplitude 1 by the relative change of its pitch.
            candidate.slope = Some(along.slope(pitch));
            (candidate.along, candidate.is_of_level) = (position.to_vec(), is_of_level);
            out.push(candidate);
        }
        for given in given(fitted.objective, fitted.at, fitted.terms, is_of_level) {
            let slope = along.moved(&given);
            let off = beside.explained(&slope).coefficient;
            let Given {
                place,
                pitch,
                factors,
            } = given;
            let found = pitch * (1.0 + off);
            let is_another = found > 0.0
                && found <= effect::MAX_PITCH * stroke
                && stroke * (1.0 / pitch - 1.0 / found).abs() >= effect::MIN_PITCH_SHIFT;
            if is_another {
                let amplitude = factors[0].hypot(factors[1]);
                let of = move |c: &[f64]| {
                    let pitch = pitch * (1.0 + c[0]);
                    let replaces = Some(place);
                    Some(made(Wave {
                        pitch,
                        amplitude,
                        stroke,
                        replaces,
                    }))
                };
                let mut candidate = Candidate::new(vec![slope], of);
                (candidate.along, candidate.is_of_level) = (position.to_vec(), is_of_level);
                out.push(candidate);
            }
        }
    }
    out
}

/// Where a wave is looked for.
struct Along<'a> {
    position: &'a [f64],
    /// What the wave multiplies at each sample.
    weight: &'a [f64],
    low: f64,
    stroke: f64,
}

impl Along<'_> {
    /// Sine and cosine of a pitch.
    fn wave(&self, pitch: f64) -> [Vec<f64>; 2] {
        let both = self.position.iter().zip(self.weight);
        let both = both.map(|(x, w)| {
            let (s, c) = libm::sincos(TAU * x / pitch);
            (w * s, w * c)
        });
        let (sine, cosine) = both.unzip();
        [sine, cosine]
    }

    /// What a relative change of the pitch does to a wave of amplitude 1, as far as its phase, which is taken to be that in the middle of
    /// the stroke, does not matter.
    fn slope(&self, pitch: f64) -> Vec<f64> {
        let middle = self.low + 0.5 * self.stroke;
        let both = self.position.iter().zip(self.weight);
        both.map(|(x, w)| {
            let phase = TAU * (x - middle) / pitch;
            w * phase * libm::cos(phase)
        })
        .collect()
    }

    /// What a relative change of the pitch of a fitted wave changes the force by.
    fn moved(&self, given: &Given) -> Vec<f64> {
        let [sine, cosine] = given.factors;
        let both = self.position.iter().zip(self.weight);
        both.map(|(x, w)| {
            let phase = TAU * x / given.pitch;
            let (s, c) = libm::sincos(phase);
            -w * (sine * c - cosine * s) * phase
        })
        .collect()
    }

    /// The pitch with which most of a residual repeats.
    fn best(&self, fitted: &Fitted, beside: &Beside) -> Option<f64> {
        let counts = fitted
            .objective
            .record()
            .resolution
            .filter(|count| *count > 0.0);
        let by_counts = counts.map_or(f64::INFINITY, |count| {
            self.stroke / (effect::MIN_PITCH_COUNTS * count)
        });
        let by_samples = (self.position.len() / SAMPLES) as f64;
        let most = by_counts.min(by_samples).min((MOST_PLACES / PLACES) as f64);
        if most < effect::MIN_WAVES {
            return None;
        }
        let places = (PLACES * most.ceil() as usize)
            .next_power_of_two()
            .min(MOST_PLACES);
        let mut sums = vec![0.0; places];
        for ((x, w), r) in self.position.iter().zip(self.weight).zip(beside.residual()) {
            let place = (places as f64 * (x - self.low) / self.stroke) as usize;
            sums[place.min(places - 1)] += w * r;
        }
        let lags = Lags::new(places, (FINE - 1) * places + 1);
        let power = lags.spectrum(&sums).power();
        let waves = |k: usize| k as f64 / FINE as f64;
        let all = (0..power.len()).take_while(|k| waves(*k) <= most);
        let near = all
            .filter(|k| waves(*k) >= effect::MIN_WAVES)
            .max_by(|a, b| power[*a].total_cmp(&power[*b]))?;
        let explained = |waves: f64| beside.pair(&self.wave(self.stroke / waves)).0;
        let step = 1.0 / FINE as f64;
        let found = highest(waves(near), step, STEPS, explained);
        (found >= effect::MIN_WAVES).then_some(self.stroke / found)
    }
}

/// Where a function with one maximum within `reach` of a point is highest, by golden section.
pub(super) fn highest(near: f64, reach: f64, steps: usize, of: impl Fn(f64) -> f64) -> f64 {
    let part = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut from, mut to) = (near - reach, near + reach);
    let (mut a, mut b) = (to - part * (to - from), from + part * (to - from));
    let (mut at_a, mut at_b) = (of(a), of(b));
    for _ in 0..steps {
        if at_a > at_b {
            (to, b, at_b) = (b, a, at_a);
            a = to - part * (to - from);
            at_a = of(a);
        } else {
            (from, a, at_a) = (a, b, at_b);
            b = from + part * (to - from);
            at_b = of(b);
        }
    }
    0.5 * (from + to)
}

/// A wave that a law has.
struct Given {
    /// Its place among those of its kind, from 0.
    place: usize,
    pitch: f64,
    /// Factors of its sine and cosine; in the unit of the force, of a level in parts of it.
    factors: [f64; 2],
}

/// The waves of a fit, those of an asymmetric level in the mean of both directions.
fn given(objective: &Objective, at: &Evaluation, terms: &Terms, is_of_level: bool) -> Vec<Given> {
    let factor = |quantity: Quantity| {
        let both = objective.linear().iter().zip(&at.solution.coefficients);
        let own = both.filter(|(term, _)| term.name.quantity == quantity);
        let (sum, count) = own.fold((0.0, 0.0), |(sum, count), (_, c)| (sum + c, count + 1.0));
        (count > 0.0).then(|| sum / count)
    };
    let level = factor(Quantity::Coulomb).filter(|level| *level > 0.0);
    let (pitches, size) = match is_of_level {
        true => (terms.level_pitches(), level.unwrap_or(1.0)),
        false => (terms.cogging.clone(), 1.0),
    };
    let each = pitches.into_iter().enumerate();
    each.filter_map(|(place, pitch)| {
        let number = place as u32 + 1;
        let of = |part: Part| match is_of_level {
            true => Quantity::CoulombPitch(number, part),
            false => Quantity::Cogging(number, part),
        };
        let factors = [
            factor(of(Part::Sine))? / size,
            factor(of(Part::Cosine))? / size,
        ];
        Some(Given {
            place,
            pitch,
            factors,
        })
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::highest;

    #[test]
    fn the_highest_place_is_found() {
        let found = highest(0.9, 0.5, 40, |x| -(x - 1.1) * (x - 1.1));
        assert!((found - 1.1).abs() < 1e-6, "{found}");
    }
}
