//! What comes back from one visit of a part of the motion to another.

/// Blocks of time; what a block adds to a part of the motion is one visit of it.
pub(super) const BLOCKS: usize = 256;
/// Blocks between two visits that are compared, at least: noise with a memory of that many is not the same in both.
const APART: usize = 3;
/// Draws of signs for the blocks, from which chance is known.
const DRAWS: usize = 24;

/// Sums over the parts of a motion, block by block.
pub(super) struct Visits {
    /// Of each part, in order of time.
    parts: Vec<Vec<Visit>>,
    samples: usize,
}

struct Visit {
    block: usize,
    /// Sum of the residual times its weight.
    product: f64,
    /// Sum of the square of the weight.
    square: f64,
}

impl Visits {
    pub fn new(parts: &[usize]) -> Self {
        let count = parts.iter().max().map_or(0, |most| most + 1);
        Self {
            parts: (0..count).map(|_| Vec::new()).collect(),
            samples: parts.len(),
        }
    }

    /// Adds a sample; blocks come in order.
    pub fn add(&mut self, block: usize, part: usize, weight: f64, residual: f64) {
        let visits = &mut self.parts[part];
        if visits.last().is_none_or(|last| last.block != block) {
            visits.push(Visit {
                block,
                product: 0.0,
                square: 0.0,
            });
        }
        if let Some(visit) = visits.last_mut() {
            visit.product += weight * residual;
            visit.square += weight * weight;
        }
    }

    /// Mean square of what comes back: the products of the sums of any two visits apart, over those of their weights, the parts
    /// weighted with what they have of such pairs.
    ///
    /// Noise adds nothing in the mean, so that it may come out negative.
    pub fn energy(&self) -> f64 {
        let [energy] = self.energies(|_| [1.0]);
        energy
    }

    /// Root mean square of that where nothing comes back: blocks with signs as drawn.
    pub fn chance(&self) -> f64 {
        let draw = |seed: usize, block: usize| {
            let bit = hash((seed as u64 + 1) << 32 | block as u64) & 1;
            1.0 - 2.0 * bit as f64
        };
        let signs: Vec<[f64; DRAWS]> = (0..BLOCKS)
            .map(|block| std::array::from_fn(|seed| draw(seed, block)))
            .collect();
        let square: f64 = self
            .energies(|block| signs[block])
            .map(|e| e * e)
            .iter()
            .sum();
        (square / DRAWS as f64).sqrt()
    }

    /// The energies with the blocks in several signs.
    fn energies<const N: usize>(&self, signs: impl Fn(usize) -> [f64; N]) -> [f64; N] {
        let mut products = [0.0; N];
        let (mut squares, mut all) = (0.0, 0.0);
        for visits in &self.parts {
            let mut before = visits.iter().peekable();
            let (mut product, mut square) = ([0.0; N], 0.0);
            let (mut pairs, mut weights, mut own) = ([0.0; N], 0.0, 0.0);
            for visit in visits {
                while let Some(early) = before.next_if(|v| v.block + APART <= visit.block) {
                    for (sum, sign) in product.iter_mut().zip(signs(early.block)) {
                        *sum += sign * early.product;
                    }
                    square += early.square;
                }
                let twice = 2.0 * visit.product;
                for ((pairs, sum), sign) in pairs.iter_mut().zip(&product).zip(signs(visit.block)) {
                    *pairs += sign * twice * sum;
                }
                weights += 2.0 * visit.square * square;
                own += visit.square;
            }
            if own > 0.0 {
                for (all, pairs) in products.iter_mut().zip(&pairs) {
                    *all += pairs / own;
                }
                squares += weights / own;
                all += own;
            }
        }
        let scale = if squares > 0.0 {
            all / squares / self.samples as f64
        } else {
            0.0
        };
        products.map(|product| product * scale)
    }
}

/// A number as good as drawn (the finalizer of Steele, Lea, Flood 2014, doi 10.1145/2660193.2660195).
fn hash(number: u64) -> u64 {
    let mut x = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}
