//! The likelihood of encoder counts under a force: an extended Kalman filter with its derivatives.
//!
//! Each count is compared with what the axis, known up to the count before, would have shown: with the innovation `e` and
//! its variance `S`, the log likelihood is the sum of `-(ln S + e^2/S)/2` (prediction error decomposition: Schweppe 1965,
//! doi 10.1109/TIT.1965.1053737), its information `e' e'/S + (ln S)' (ln S)'/2` (Ljung 1999, ISBN 0-13-656695-2,
//! section 7.4).

use crate::state_space::axis::{Axis, Jacobian, State};
use crate::state_space::tangent::{LANES, Lanes, Sensitive, Tangent};
use stiction_dispatch::{InstructionSet, Kernel};

/// A stretch of samples without a gap.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Stretch {
    /// Force on the axis from each sample to the next, N (N m).
    pub force: Vec<f64>,
    /// Position read, from the first one, m or rad.
    pub reading: Vec<f64>,
    /// Variance of its error; infinite where it does not count.
    pub variance: Vec<f64>,
    /// Velocity at the start, m/s or rad/s.
    pub velocity: f64,
}

/// What is known of the axis at the start of a stretch: standard deviations.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    /// m/s or rad/s
    pub velocity: f64,
    /// m or rad
    pub deflection: f64,
}

/// Sums over a part of the samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sums {
    /// Log likelihood.
    pub value: f64,
    /// Its derivatives.
    pub score: Lanes,
    /// Their expected information.
    pub information: [Lanes; LANES],
    /// Samples that count.
    pub samples: usize,
}

impl Sums {
    pub const NONE: Self = Self {
        value: 0.0,
        score: Lanes([0.0; LANES]),
        information: [Lanes([0.0; LANES]); LANES],
        samples: 0,
    };

    /// The sums over both parts.
    pub fn and(mut self, other: &Self) -> Self {
        self.value += other.value;
        self.samples += other.samples;
        for i in 0..LANES {
            self.score.0[i] += other.score.0[i];
            for j in 0..LANES {
                self.information[i].0[j] += other.information[i].0[j];
            }
        }
        self
    }

    /// Counts an innovation and its variance.
    #[inline(always)]
    fn add(&mut self, error: f64, error_slope: &Lanes, spread: &Sensitive, variance: f64) {
        let total = spread.value + variance;
        let inverse = 1.0 / total;
        let square = error * error * inverse;
        self.value -= 0.5 * (libm::log(total) + square);
        self.samples += 1;
        let by_error = -error * inverse;
        let by_spread = -0.5 * (1.0 - square) * inverse;
        let half = 0.5 * inverse * inverse;
        for k in 0..LANES {
            let sum = by_error.mul_add(error_slope.0[k], self.score.0[k]);
            self.score.0[k] = by_spread.mul_add(spread.slope.0[k], sum);
        }
        for i in 0..LANES {
            let e = inverse * error_slope.0[i];
            let s = half * spread.slope.0[i];
            let slopes = error_slope.0.iter().zip(&spread.slope.0);
            for (element, (error, spread)) in self.information[i].0.iter_mut().zip(slopes) {
                let sum = e.mul_add(*error, *element);
                *element = s.mul_add(*spread, sum);
            }
        }
    }
}

/// Sums over `blocks` parts of equal length of all samples, in order.
pub(super) fn likelihood(
    axis: &Axis,
    stretches: &[Stretch],
    start: Start,
    blocks: usize,
    set: InstructionSet,
) -> Vec<Sums> {
    set.run(Filter {
        axis,
        stretches,
        start,
        blocks,
    })
}

struct Filter<'a> {
    axis: &'a Axis,
    stretches: &'a [Stretch],
    start: Start,
    blocks: usize,
}

/// Covariance of the state: the upper triangle, row by row.
type Spread = [Sensitive; 10];

impl Kernel for Filter<'_> {
    type Output = Vec<Sums>;

    #[inline(always)]
    fn run(self) -> Vec<Sums> {
        let total: usize = self.stretches.iter().map(|s| s.force.len()).sum();
        let mut out = vec![Sums::NONE; self.blocks];
        let mut number = 0;
        for stretch in self.stretches {
            let mut state = [Sensitive::ZERO; 4];
            state[1].value = stretch.velocity;
            let mut spread = [Sensitive::ZERO; 10];
            let first = stretch.variance.first().copied().unwrap_or(0.0);
            spread[0].value = if first.is_finite() { first } else { 0.0 };
            spread[4].value = self.start.velocity * self.start.velocity;
            spread[7].value = self.start.deflection * self.start.deflection;
            spread[9] = self.axis.disturbance;
            let mut jacobian = [[Sensitive::ZERO; 3]; 3];
            let samples = stretch.force.iter().zip(&stretch.reading);
            let samples = samples.zip(&stretch.variance).enumerate();
            for (k, ((&force, &reading), &variance)) in samples {
                // The first reading is where the state begins.
                if k > 0 && variance.is_finite() {
                    let sums = &mut out[number * self.blocks / total];
                    correct(&mut state, &mut spread, reading, variance, sums);
                }
                number += 1;
                self.axis.advance(&mut state, &mut jacobian, force);
                self.spread_out(&mut spread, &jacobian);
            }
        }
        out
    }
}

impl Filter<'_> {
    /// The covariance a sample later.
    #[inline(always)]
    fn spread_out(&self, spread: &mut Spread, jacobian: &Jacobian) {
        let Axis {
            white,
            renewed,
            kept,
            ..
        } = self.axis;
        let p = spread.map(|element| element.value);
        let mut values = [0.0; 10];
        for k in 0..LANES {
            let lane = |i: usize| Tangent {
                value: p[i],
                slope: spread[i].slope.0[k],
            };
            let [p00, p01, p02, p03] = [lane(0), lane(1), lane(2), lane(3)];
            let [p11, p12, p13] = [lane(4), lane(5), lane(6)];
            let [p22, p23, p33] = [lane(7), lane(8), lane(9)];
            let row = |i: usize| -> [Tangent; 3] {
                let [a, b, c] = &jacobian[i];
                [a.lane(k), b.lane(k), c.lane(k)]
            };
            let rows = [row(0), row(1), row(2)];
            let (kept, renewed, white) = (kept.lane(k), renewed.lane(k), white.lane(k));
            let dot = |a: [Tangent; 3], x: Tangent, y: Tangent, z: Tangent| {
                a[0].times(x).plus_product(a[1], y).plus_product(a[2], z)
            };
            // Rows of the Jacobian times the covariance.
            let half = |a: [Tangent; 3]| {
                [
                    dot(a, p11, p12, p13),
                    dot(a, p12, p22, p23),
                    dot(a, p13, p23, p33),
                ]
            };
            let [x, v, z] = [half(rows[0]), half(rows[1]), half(rows[2])];
            let own = p00.plus(dot(rows[0], p01, p02, p03));
            let x = [x[0].plus(p01), x[1].plus(p02), x[2].plus(p03)];
            let noise = |i: usize| rows[i][2].times(white);
            let noise = [noise(0), noise(1), noise(2)];
            let both = |h: [Tangent; 3], i: usize, j: usize| {
                dot(rows[j], h[0], h[1], h[2]).plus_product(noise[i], rows[j][2])
            };
            let next = [
                own.plus(both(x, 0, 0)),
                both(x, 0, 1),
                both(x, 0, 2),
                x[2].times(kept),
                both(v, 1, 1),
                both(v, 1, 2),
                v[2].times(kept),
                both(z, 2, 2),
                z[2].times(kept),
                renewed.plus_product(p33.times(kept), kept),
            ];
            for i in 0..10 {
                spread[i].slope.0[k] = next[i].slope;
                values[i] = next[i].value;
            }
        }
        for (element, value) in spread.iter_mut().zip(values) {
            element.value = value;
        }
    }
}

/// Corrects state and covariance by a reading, and counts its likelihood.
#[inline(always)]
fn correct(state: &mut State, spread: &mut Spread, reading: f64, variance: f64, sums: &mut Sums) {
    let x = [0, 1, 2, 3].map(|i| state[i].value);
    let p = spread.map(|element| element.value);
    let error = reading - x[0];
    let mut error_slope = Lanes::ZERO;
    for k in 0..LANES {
        error_slope.0[k] = -state[0].slope.0[k];
    }
    sums.add(error, &error_slope, &spread[0], variance);
    let mut states = [0.0; 4];
    let mut values = [0.0; 10];
    for k in 0..LANES {
        let lane = |i: usize| Tangent {
            value: p[i],
            slope: spread[i].slope.0[k],
        };
        let first = [lane(0), lane(1), lane(2), lane(3)];
        let inverse = first[0].raised(variance).inverse();
        let share = |i: usize| first[i].times(inverse);
        let shares = [share(0), share(1), share(2), share(3)];
        let error = Tangent {
            value: error,
            slope: error_slope.0[k],
        };
        let moved = |i: usize| {
            let before = Tangent {
                value: x[i],
                slope: state[i].slope.0[k],
            };
            before.plus_product(shares[i], error)
        };
        let moved = [moved(0), moved(1), moved(2), moved(3)];
        let left = |at: usize, i: usize, j: usize| lane(at).minus_product(shares[i], first[j]);
        let left = [
            left(0, 0, 0),
            left(1, 0, 1),
            left(2, 0, 2),
            left(3, 0, 3),
            left(4, 1, 1),
            left(5, 1, 2),
            left(6, 1, 3),
            left(7, 2, 2),
            left(8, 2, 3),
            left(9, 3, 3),
        ];
        for i in 0..4 {
            state[i].slope.0[k] = moved[i].slope;
            states[i] = moved[i].value;
        }
        for i in 0..10 {
            spread[i].slope.0[k] = left[i].slope;
            values[i] = left[i].value;
        }
    }
    for (number, value) in state.iter_mut().zip(states) {
        number.value = value;
    }
    for (element, value) in spread.iter_mut().zip(values) {
        element.value = value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state_space::axis::GAUSSIAN;
    use crate::state_space::unknowns::UNKNOWNS;

    const STEP: f64 = 5e-4;
    const COUNT: f64 = 1e-7;

    /// A move to and fro with a rest before, between and after, as counts of an encoder; a force that is about right.
    fn stretch() -> Stretch {
        let samples = 900;
        let speed = |k: usize| match k % 450 {
            150..350 => {
                let s = ((k % 450 - 150) as f64 / 200.0).min(1.0);
                let sign = if k < 450 { 1.0 } else { -1.0 };
                sign * 0.02 * libm::sin(std::f64::consts::PI * s)
            }
            _ => 0.0,
        };
        let mut x = 0.0;
        let reading: Vec<f64> = (0..samples)
            .map(|k| {
                x += STEP * speed(k);
                libm::round(x / COUNT) * COUNT
            })
            .collect();
        let force = (0..samples).map(|k| {
            let acceleration = (speed(k + 1) - speed(k)) / STEP;
            let sign = if k < 500 { 1.0 } else { -1.0 };
            60.0 * acceleration + 130.0 * sign * libm::tanh((k as f64 - 150.0).abs() / 20.0)
        });
        Stretch {
            force: force.collect(),
            reading,
            variance: vec![COUNT * COUNT / 12.0; samples],
            velocity: 0.0,
        }
    }

    fn unknowns() -> [f64; UNKNOWNS] {
        let size = libm::log;
        [
            size(2.5e7),
            size(1.5e4),
            size(60.0),
            2.0,
            size(8.0),
            size(10.0),
            size(7.0),
            size(120.0),
            size(1.4),
            size(3e-3),
            size(600.0),
            size(125.0),
            size(1.3),
            size(4e-3),
            size(500.0),
        ]
    }

    fn sums(at: &[f64; UNKNOWNS], set: InstructionSet) -> Sums {
        sums_of(at, GAUSSIAN, set)
    }

    fn sums_of(at: &[f64; UNKNOWNS], exponent: f64, set: InstructionSet) -> Sums {
        let axis = Axis::at(at, exponent, true, STEP, 2);
        let start = Start {
            velocity: COUNT / STEP,
            deflection: 2e-6,
        };
        let blocks = likelihood(&axis, &[stretch()], start, 4, set);
        assert_eq!(blocks.iter().map(|b| b.samples).sum::<usize>(), 899);
        blocks.iter().fold(Sums::NONE, Sums::and)
    }

    #[test]
    fn the_score_is_the_slope_of_the_likelihood() {
        let best = InstructionSet::best();
        for (exponent, lane) in [GAUSSIAN, 0.7, 3.0]
            .into_iter()
            .flat_map(|exponent| (0..UNKNOWNS).map(move |lane| (exponent, lane)))
        {
            let own = sums_of(&unknowns(), exponent, best);
            // The mean speed of a step is found to a part of itself, so a shorter way sees no slope.
            let h = 1e-5;
            let moved = |by: f64| {
                let mut at = unknowns();
                at[lane] += by;
                sums_of(&at, exponent, best).value
            };
            let slope = (moved(h) - moved(-h)) / (2.0 * h);
            let off = (own.score.0[lane] - slope).abs();
            assert!(
                off < 1e-3 * (1.0 + slope.abs()),
                "{lane}: {} {slope}",
                own.score.0[lane]
            );
        }
    }

    #[test]
    fn every_instruction_set_gives_the_same_bits() {
        let own = sums(&unknowns(), InstructionSet::best());
        for set in InstructionSet::all() {
            assert_eq!(sums(&unknowns(), set), own, "{}", set.name());
        }
    }
}
