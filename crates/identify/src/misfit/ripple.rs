//! A wave over the position.

use super::coupling::beside::Beside;
use std::f64::consts::TAU;

/// Waves that are tried for each one that fits the stroke: between two of them the phase at the end differs by a quarter.
const FINE: f64 = 4.0;
/// Most waves over the stroke.
const MOST_WAVES: f64 = 64.0;
/// Samples on which waves are tried, at most: many times the waves.
const MOST_SAMPLES: usize = 2000;
/// Steps of the search beside the best of them, and of the one beside the law, which starts near.
const REFINED: usize = 40;
const REFINED_BESIDE: usize = 24;
/// Part of a residual that a wave explains, beyond all that a law can take up, from which it is a cause of its own, how surely
/// its pitch is known then, and how often it comes back along the stroke.
const SHARP_SHARE: f64 = 0.3;
const SHARP_PITCH: f64 = 0.1;
const FEWEST_WAVES: f64 = 2.0;
/// Independent ways in which a law is taken to be wrong (decision 0061): a pitch is that of a fit to so many samples of what is
/// left.
const WAYS: f64 = 4.0;

/// What repeats with the position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Repeats {
    /// A force that acts whatever the axis does.
    Force,
    /// The level of friction.
    Level,
}

/// A force, or a level of friction, that repeats with the position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ripple {
    /// What repeats.
    pub what: Repeats,
    /// Its pitch, m or rad.
    pub pitch: f64,
    /// Standard deviation of the pitch, m or rad: that of a fit to four samples of what it leaves.
    pub deviation: f64,
    /// Its amplitude: in the unit of the force or, of a level, as a part of it.
    pub amplitude: f64,
    /// Part of the variance of the residual that it explains, 0 to 1.
    pub share: f64,
    /// The stroke, m or rad.
    pub stroke: f64,
    /// Which wave of its kind in the terms of the law, counted from 0, has this pitch in place of its own; `None` for one more.
    pub replaces: Option<usize>,
}

impl Ripple {
    /// Whether the residual says what its pitch is: a bump looks like a wave of many.
    pub(super) fn has_known_pitch(&self) -> bool {
        self.deviation <= SHARP_PITCH * self.pitch
    }

    /// Whether it is told from friction of another shape, which comes back at the same places too: such a residual has no one
    /// pitch. Of simulated axes with friction of other shapes a wave explained up to a quarter, with a pitch known to 18 %; of
    /// axes with cogging beside it a third to two thirds, known to 2 to 7 %.
    pub(super) fn is_sharp(&self) -> bool {
        self.share >= SHARP_SHARE
            && self.has_known_pitch()
            && self.stroke >= FEWEST_WAVES * self.pitch
    }
}

/// Where a wave is looked for.
pub(super) struct Along<'a> {
    pub what: Repeats,
    pub position: &'a [f64],
    /// What the wave multiplies at each sample: 1 for a force, the friction for a level.
    pub weight: &'a [f64],
}

impl Along<'_> {
    /// Length of the stroke; `None` where there is none.
    fn stroke(&self) -> Option<f64> {
        let extent = |(low, high): (f64, f64), x: &f64| (low.min(*x), high.max(*x));
        let (low, high) = self
            .position
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), extent);
        let stroke = high - low;
        (stroke > 0.0 && stroke.is_finite()).then_some(stroke)
    }

    /// Sine and cosine of so many waves in a unit of length, and their slopes over the pitch for a unit of amplitude each.
    fn wave(&self, frequency: f64) -> [Vec<f64>; 2] {
        let both = self.position.iter().zip(self.weight);
        let both = both.map(|(x, w)| {
            let (s, c) = libm::sincos(TAU * frequency * x);
            (w * s, w * c)
        });
        let (sine, cosine) = both.unzip();
        [sine, cosine]
    }

    /// What a wave with these factors of sine and cosine changes by with its pitch.
    fn slope(&self, pitch: f64, [sine, cosine]: [f64; 2]) -> Vec<f64> {
        let along = self.position.iter().zip(self.weight);
        let slope = |(x, w): (&f64, &f64)| {
            let phase = TAU * x / pitch;
            let (s, c) = libm::sincos(phase);
            -w * (sine * c - cosine * s) * phase / pitch
        };
        along.map(slope).collect()
    }

    /// The wave that explains most of a residual beyond all that the columns of a law take up; `None` for a stroke of no length.
    pub fn best(&self, residual: &[f64], beside: &Beside) -> Option<Ripple> {
        let stroke = self.stroke()?;
        let every = self.position.len().div_ceil(MOST_SAMPLES).max(1);
        let some = |x: &[f64]| -> Vec<f64> { x.iter().step_by(every).copied().collect() };
        let [few, weight, left] = [self.position, self.weight, residual].map(some);
        let at = |waves: f64| fitted((&few, &weight), &left, waves / stroke);
        let tried = (FINE as usize..(FINE * MOST_WAVES) as usize).map(|i| i as f64 / FINE);
        let (best, _) = tried
            .map(|waves| (waves, at(waves)))
            .max_by(|a, b| a.1.total_cmp(&b.1))?;
        let near = highest(best, 1.0 / FINE, REFINED, at);
        // The law has taken up a part of the wave, with which the best of what it left is another one.
        let explained = |waves: f64| beside.pair(&self.wave(waves / stroke));
        let waves = highest(near, 0.5 / FINE, REFINED_BESIDE, |w| explained(w).0);
        let (share, factors) = explained(waves);
        let pitch = stroke / waves;
        let [sine, cosine] = self.wave(waves / stroke);
        let left = beside.with(&sine).with(&cosine);
        Some(Ripple {
            what: self.what,
            pitch,
            deviation: left.deviation(&self.slope(pitch, factors), WAYS),
            amplitude: factors[0].hypot(factors[1]),
            share,
            stroke,
            replaces: None,
        })
    }

    /// What another pitch of a wave that is fitted explains; `factors` are those of its sine and cosine.
    pub fn moved(&self, pitch: f64, factors: [f64; 2], beside: &Beside) -> Option<Ripple> {
        let stroke = self.stroke()?;
        let slope = self.slope(pitch, factors);
        let found = beside.explained(&slope);
        Some(Ripple {
            what: self.what,
            pitch: pitch + found.coefficient,
            deviation: beside.deviation(&slope, WAYS) * (1.0 - found.share).max(0.0).sqrt(),
            amplitude: factors[0].hypot(factors[1]),
            share: found.share,
            stroke,
            replaces: None,
        })
    }
}

impl Ripple {
    /// By what part of a wave another pitch is off at one end of the stroke where it is right at the other.
    pub fn off_by(&self, pitch: f64) -> f64 {
        self.stroke * (1.0 / pitch - 1.0 / self.pitch).abs()
    }
}

/// Where a function with one maximum within `reach` of a point is highest, by golden section.
fn highest(near: f64, reach: f64, steps: usize, of: impl Fn(f64) -> f64) -> f64 {
    let (mut from, mut to) = (near - reach, near + reach);
    let part = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..steps {
        let (a, b) = (to - part * (to - from), from + part * (to - from));
        if of(a) > of(b) {
            to = b;
        } else {
            from = a;
        }
    }
    0.5 * (from + to)
}

/// Part of the squares that a wave of a spatial frequency (1/m) explains, by least squares.
fn fitted((position, weight): (&[f64], &[f64]), residual: &[f64], frequency: f64) -> f64 {
    let (mut ss, mut sc, mut cc, mut sr, mut cr, mut rr) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for ((x, w), r) in position.iter().zip(weight).zip(residual) {
        let (s, c) = libm::sincos(TAU * frequency * x);
        let (s, c) = (w * s, w * c);
        ss += s * s;
        sc += s * c;
        cc += c * c;
        sr += s * r;
        cr += c * r;
        rr += r * r;
    }
    let determinant = ss * cc - sc * sc;
    if determinant.is_nan() || determinant <= 0.0 || rr <= 0.0 {
        return 0.0;
    }
    let a = (cc * sr - sc * cr) / determinant;
    let b = (ss * cr - sc * sr) / determinant;
    (a * sr + b * cr) / rr
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wave that a line and a constant have taken a part of, beside noise.
    fn left(pitch: f64, position: &[f64], columns: &[&[f64]]) -> Vec<f64> {
        let force: Vec<f64> = position
            .iter()
            .enumerate()
            .map(|(i, x)| libm::sin(TAU * x / pitch + 0.4) + 0.05 * libm::sin((i * i) as f64))
            .collect();
        Beside::new(columns, &force).residual().to_vec()
    }

    fn position() -> Vec<f64> {
        (0..6000)
            .map(|i| 0.26 * (1.0 - libm::cos(TAU * f64::from(i) / 1500.0)))
            .collect()
    }

    #[test]
    fn a_pitch_is_found_beside_what_the_law_took_up_of_its_wave() {
        let x = position();
        let ones = vec![1.0; x.len()];
        let columns: [&[f64]; 2] = [&x, &ones];
        for pitch in [0.19, 0.2618, 0.45, 0.031] {
            let residual = left(pitch, &x, &columns);
            let beside = Beside::new(&columns, &residual);
            let along = Along {
                what: Repeats::Force,
                position: &x,
                weight: &ones,
            };
            let found = along.best(&residual, &beside).unwrap();
            assert!(found.off_by(pitch) < 0.003, "{pitch}: {found:?}");
            assert!(
                (found.pitch - pitch).abs() < 2.0 * found.deviation,
                "{pitch}: {found:?}"
            );
            assert!(found.share > 0.9, "{pitch}: {found:?}");
        }
    }

    #[test]
    fn a_pitch_that_is_off_is_moved_to_its_place() {
        let (x, pitch) = (position(), 0.2618);
        let ones = vec![1.0; x.len()];
        let along = Along {
            what: Repeats::Force,
            position: &x,
            weight: &ones,
        };
        for given in [0.259, 0.2605, 0.2618, 0.265] {
            let [sine, cosine] = along.wave(1.0 / given);
            let columns: [&[f64]; 3] = [&sine, &cosine, &ones];
            let residual = left(pitch, &x, &columns);
            let beside = Beside::new(&columns, &residual);
            // Factors of the wave as fitted: of its phase but for the part of a wave by which it is off.
            let factors = [libm::cos(0.4), libm::sin(0.4)];
            let moved = along.moved(given, factors, &beside).unwrap();
            assert!(moved.deviation < 0.01 * pitch, "{given}: {moved:?}");
            assert!(
                moved.off_by(pitch) < 0.2 * moved.off_by(given) + 0.002,
                "{given}: {moved:?}"
            );
        }
    }
}
