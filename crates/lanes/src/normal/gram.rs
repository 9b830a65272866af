//! Products of columns, added up lane by lane.

use super::sums::Sums;
use crate::exp::fma;
use crate::lane_array::Aligned;

/// Lanes of a sum.
pub(super) const LANES: usize = 8;
/// Columns whose products are added up together, in registers.
const BLOCK: usize = 4;

type Products = [[[f64; LANES]; BLOCK]; BLOCK];

/// Running sums of products.
pub(super) struct Gram {
    own: [Aligned<Products>; 3],
    /// For each four shared columns, the products with the first and the last four own columns.
    shared: Vec<[Aligned<Products>; 2]>,
    count: usize,
}

const NONE: Aligned<Products> = Aligned([[[0.0; LANES]; BLOCK]; BLOCK]);

/// Columns at some places, in lanes. Its methods must be `#[inline(always)]`.
pub(super) trait Columns {
    /// How many places there are.
    fn places(&self) -> usize;
    /// A column at a place.
    fn at(&self, place: usize, column: usize) -> [f64; LANES];
}

impl Gram {
    /// For this many shared columns.
    pub fn new(count: usize) -> Self {
        Gram {
            own: [NONE; 3],
            shared: vec![[NONE; 2]; count.div_ceil(BLOCK)],
            count,
        }
    }

    /// Adds the products of own columns with each other and with the shared ones, at the places of the own.
    #[inline(always)]
    pub fn add(&mut self, own: &impl Columns, shared: &impl Columns) {
        add::<true, BLOCK>(&mut self.own[0].0, own, 0, own, 0);
        add::<false, BLOCK>(&mut self.own[1].0, own, BLOCK, own, 0);
        add::<true, BLOCK>(&mut self.own[2].0, own, BLOCK, own, BLOCK);
        for (b, [low, high]) in self.shared.iter_mut().enumerate() {
            let first = b * BLOCK;
            for (sums, of) in [(&mut low.0, 0), (&mut high.0, BLOCK)] {
                match self.count - first {
                    1 => add::<false, 1>(sums, shared, first, own, of),
                    2 => add::<false, 2>(sums, shared, first, own, of),
                    3 => add::<false, 3>(sums, shared, first, own, of),
                    _ => add::<false, BLOCK>(sums, shared, first, own, of),
                }
            }
        }
    }

    /// The sums, where `pick` reduces the lanes of each to one number.
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

/// Adds the products of `ROWS` columns of `a` with four columns of `b`. `TRIANGLE`: both are the same
/// columns, and the products on and below the diagonal are enough.
#[inline(always)]
fn add<const TRIANGLE: bool, const ROWS: usize>(
    sums: &mut Products,
    a: &impl Columns,
    first_a: usize,
    b: &impl Columns,
    first_b: usize,
) {
    let mut local = *sums;
    for place in 0..b.places() {
        let mut columns = [[0.0; LANES]; BLOCK];
        for j in 0..BLOCK {
            columns[j] = b.at(place, first_b + j);
        }
        for i in 0..ROWS {
            let row = a.at(place, first_a + i);
            for j in 0..if TRIANGLE { i + 1 } else { BLOCK } {
                for l in 0..LANES {
                    local[i][j][l] = fma(row[l], columns[j][l], local[i][j][l]);
                }
            }
        }
    }
    *sums = local;
}
