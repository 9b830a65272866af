//! Draws of the numbers of a joint.

use super::{Number, Own, Scale};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Half of a 95 % interval in deviations.
const Q95: f64 = 1.959_963_984_540_054;
/// Deviations from its nominal value up to which a number is drawn.
const MOST: f64 = 3.0;
/// Draws of a joint before one that has numbers beyond their limits is cut at them.
const TRIES: usize = 1000;

/// What is to be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Draws {
    /// How many.
    pub count: usize,
    /// Seed: the same gives the same draws.
    pub seed: u64,
    /// Which intervals.
    pub width: Width,
}

/// Which intervals draws are from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// The same motion on another day.
    Repeatability,
    /// Another motion.
    Transfer,
}

impl Width {
    /// Both.
    pub const ALL: [Width; 2] = [Width::Repeatability, Width::Transfer];

    /// Name as typed.
    pub fn name(self) -> &'static str {
        match self {
            Width::Repeatability => "repeatability",
            Width::Transfer => "transfer",
        }
    }

    pub(super) fn place(self) -> usize {
        match self {
            Width::Repeatability => 0,
            Width::Transfer => 1,
        }
    }
}

impl Number {
    /// Deviation that it is drawn with, on its scale; `None` where it is not varied. Where only the other interval is known, that
    /// of the other.
    fn deviation(&self, width: Width) -> Option<f64> {
        let own = self.half[width.place()].or(self.half[0]).or(self.half[1])?;
        let size = match self.scale {
            Scale::Log => own / self.nominal,
            _ => own,
        };
        let is_varied = size > 0.0 && size.is_finite();
        is_varied.then_some(size / Q95)
    }

    fn at(&self, deviation: f64, z: f64) -> f64 {
        match self.scale {
            Scale::Log => self.nominal * libm::exp(deviation * z),
            _ => self.nominal + deviation * z,
        }
    }

    fn allows(&self, value: f64) -> bool {
        self.scale != Scale::NotNegative || value >= 0.0
    }
}

/// A level that is not below another: each of static friction and the sliding friction of its direction.
const NOT_BELOW: [(&str, &str); 7] = [
    ("static_friction", "frictionloss"),
    ("static", "coulomb"),
    ("static", "coulomb_pos"),
    ("static", "coulomb_neg"),
    ("static_pos", "coulomb_pos"),
    ("static_neg", "coulomb_neg"),
    ("static_pos", "coulomb"),
];

/// The numbers of a joint that vary, each with its draws. Each joint has a stream of its own, by its place.
pub(super) fn of<'a>(own: &'a Own, place: usize, draws: &Draws) -> Vec<(&'a str, Vec<f64>)> {
    let mut bits = Xoshiro256PlusPlus::seed_from_u64(draws.seed);
    for _ in 0..place {
        bits.jump();
    }
    let numbers = &own.domain.numbers;
    let deviations: Vec<Option<f64>> = (numbers.iter())
        .map(|number| number.deviation(draws.width))
        .collect();
    let width = own.domain.root.iter().map(Vec::len).max().unwrap_or(0);
    let mut out: Vec<(&str, Vec<f64>)> = numbers
        .iter()
        .zip(&deviations)
        .filter(|(_, deviation)| deviation.is_some())
        .map(|(number, _)| (number.name.as_str(), Vec::with_capacity(draws.count)))
        .collect();
    let pairs: Vec<(usize, usize)> = NOT_BELOW
        .iter()
        .filter_map(|(above, below)| {
            let find = |name: &str| numbers.iter().position(|own| own.name == name);
            Some((find(above)?, find(below)?))
        })
        .collect();
    for _ in 0..draws.count {
        let mut values = vec![0.0; numbers.len()];
        for attempt in 1..=TRIES {
            let normal: Vec<f64> = (0..width).map(|_| normal(&mut bits)).collect();
            let mut is_good = true;
            for (i, number) in numbers.iter().enumerate() {
                let row = own.domain.root.get(i).map_or(&[][..], Vec::as_slice);
                let z: f64 = row.iter().zip(&normal).map(|(r, n)| r * n).sum();
                let deviation = deviations[i].unwrap_or(0.0);
                let value = number.at(deviation, z.clamp(-MOST, MOST));
                is_good &= deviations[i].is_none() || z.abs() <= MOST && number.allows(value);
                values[i] = if number.allows(value) { value } else { 0.0 };
            }
            if is_good || attempt == TRIES {
                break;
            }
        }
        for (above, below) in &pairs {
            values[*above] = values[*above].max(values[*below]);
        }
        let drawn = values.iter().zip(&deviations);
        let drawn = drawn.filter(|(_, deviation)| deviation.is_some());
        for ((_, all), (value, _)) in out.iter_mut().zip(drawn) {
            all.push(*value);
        }
    }
    out
}

/// Normal with mean 0 and deviation 1 (Box and Muller).
fn normal(bits: &mut Xoshiro256PlusPlus) -> f64 {
    let mut unit = || (bits.next_u64() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64);
    // 1 - u lies in (0, 1]: its logarithm is finite.
    let radius = libm::sqrt(-2.0 * libm::log(1.0 - unit()));
    radius * libm::cos(std::f64::consts::TAU * unit())
}
