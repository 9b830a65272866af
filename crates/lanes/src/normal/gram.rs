//! Products of columns, added up lane by lane.

use super::Sums;
use crate::exp::fma;
use crate::lane_array::Aligned;
use crate::sensitive::OWN;

/// Lanes of a sum.
pub(super) const LANES: usize = 8;
/// Columns whose products are added up together, in registers.
pub(super) const BLOCK: usize = 4;

/// The own columns at a node, for each lane.
pub(super) type Row = Aligned<[[f64; LANES]; OWN]>;
/// Four shared columns at a node, for each lane.
pub(super) type SharedRow = Aligned<[[f64; LANES]; BLOCK]>;
type Products = [[[f64; LANES]; BLOCK]; BLOCK];

/// Running sums of products.
pub(super) struct Gram {
    own: [Aligned<Products>; 3],
    /// For each four shared columns, the products with the first and the last four own columns.
    shared: Vec<[Aligned<Products>; 2]>,
    count: usize,
}

const NONE: Aligned<Products> = Aligned([[[0.0; LANES]; BLOCK]; BLOCK]);

impl Gram {
    /// For this many shared columns.
    pub fn new(count: usize) -> Self {
        Gram {
            own: [NONE; 3],
            shared: vec![[NONE; 2]; count.div_ceil(BLOCK)],
            count,
        }
    }

    /// Adds the products of own columns.
    #[inline(always)]
    pub fn add_own(&mut self, rows: &[Row]) {
        add(&mut self.own[0].0, rows, 0, rows, 0);
        add(&mut self.own[1].0, rows, BLOCK, rows, 0);
        add(&mut self.own[2].0, rows, BLOCK, rows, BLOCK);
    }

    /// How many times [`add_shared`](Self::add_shared) is to be called.
    pub fn shared_blocks(&self) -> usize {
        self.shared.len()
    }

    /// Adds the products with the `b`-th four shared columns; what is beyond the last column is not read.
    #[inline(always)]
    pub fn add_shared(&mut self, b: usize, shared: &[SharedRow], rows: &[Row]) {
        let [first, last] = &mut self.shared[b];
        add(&mut first.0, shared, 0, rows, 0);
        add(&mut last.0, shared, 0, rows, BLOCK);
    }

    /// The sums, where `pick` makes one number of the lanes.
    pub fn sums(&self, pick: impl Fn(&[f64; LANES]) -> f64) -> Sums {
        let own = |i: usize, j: usize| {
            let (i, j) = (i.max(j), i.min(j));
            let block = &self.own[i / BLOCK + j / BLOCK].0;
            pick(&block[i % BLOCK][j % BLOCK])
        };
        let shared =
            |s: usize, i: usize| pick(&self.shared[s / BLOCK][i / BLOCK].0[s % BLOCK][i % BLOCK]);
        Sums {
            own: std::array::from_fn(|i| std::array::from_fn(|j| own(i, j))),
            shared: (0..self.count)
                .map(|s| std::array::from_fn(|i| shared(s, i)))
                .collect(),
        }
    }
}

#[inline(always)]
fn add<const A: usize, const B: usize>(
    sums: &mut Products,
    a: &[Aligned<[[f64; LANES]; A]>],
    first_a: usize,
    b: &[Aligned<[[f64; LANES]; B]>],
    first_b: usize,
) {
    let mut local = *sums;
    for (a, b) in a.iter().zip(b) {
        for i in 0..BLOCK {
            for j in 0..BLOCK {
                for l in 0..LANES {
                    let product = (a.0[first_a + i][l], b.0[first_b + j][l]);
                    local[i][j][l] = fma(product.0, product.1, local[i][j][l]);
                }
            }
        }
    }
    *sums = local;
}
