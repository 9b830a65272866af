//! The curve through the points: vs (and delta) on a grid, everything else exact, then refined.

use super::robust::{ROUNDS, Rows, Solved};

/// Points of the grid of vs.
const GRID_POINTS: usize = 64;
/// Rounds of reweighting on the grid.
const GRID_ROUNDS: usize = 12;
/// Minima of the grid that are followed.
const FOLLOWED: usize = 3;
/// Width in ln vs at which the refinement ends: far below any interval, far above the rounding of the loss.
const SETTLED_WIDTH: f64 = 1e-7;
/// Exponents that are tried where the exponent is an unknown.
const EXPONENTS_TRIED: [f64; 6] = [0.5, 0.75, 1.0, 1.5, 2.0, 3.0];
/// Least and largest exponent: a choice, wider than the .5 to 2 of the literature.
pub(super) const EXPONENT_RANGE: (f64, f64) = (0.4, 4.0);
/// Width in the exponent at which its refinement ends: each trial of it is a whole search for vs, and no interval of an
/// exponent is narrower than a thousand times this.
const EXPONENT_SETTLED_WIDTH: f64 = 1e-5;

/// Points that share one Stribeck velocity: all of a symmetric map, or those of one direction.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    /// Speed, m/s or rad/s.
    pub speed: Vec<f64>,
    /// Columns of the Coulomb level, of the viscous term and what stands beside them.
    pub columns: Vec<Vec<f64>>,
    pub nonnegative: Vec<bool>,
    /// Force, in the direction of the motion for a block of one direction.
    pub target: Vec<f64>,
    /// Standard deviation that each point is expected to have.
    pub deviation: Vec<f64>,
    /// Range of vs, m/s or rad/s; `None` leaves the Stribeck curve out.
    pub range: Option<(f64, f64)>,
}

/// The best curve of a block.
#[derive(Clone, Debug)]
pub(crate) struct Best {
    /// Stribeck velocity; 0 without a Stribeck curve.
    pub velocity: f64,
    /// Coefficients of the block's columns, then of the Stribeck rise where there is one.
    pub solved: Solved,
    /// Whether vs stands at the end of its range.
    pub at_bound: bool,
    /// Every vs of the grid with the least loss there, in order.
    pub profile: Vec<(f64, f64)>,
}

impl Best {
    /// The lowest and highest vs of the grid whose loss is within `most` of the least, and whether
    /// either is an end of the grid.
    pub fn within(&self, most: f64) -> Option<(f64, f64, bool)> {
        let allowed = |x: &(f64, f64)| x.1 - self.solved.cost <= most;
        let first = self.profile.iter().position(allowed)?;
        let last = self.profile.iter().rposition(allowed)?;
        let open = first == 0 || last + 1 == self.profile.len();
        Some((self.profile[first].0, self.profile[last].0, open))
    }
}

/// `exp(-(v/vs)^delta)`.
pub(super) fn fall(speed: f64, velocity: f64, exponent: f64) -> f64 {
    libm::exp(-libm::pow(speed / velocity, exponent))
}

impl Block {
    /// The rows of the linear problem at a Stribeck velocity.
    fn columns_at(&self, velocity: f64, exponent: f64) -> (Vec<Vec<f64>>, Vec<bool>) {
        let mut columns = self.columns.clone();
        let mut nonnegative = self.nonnegative.clone();
        if self.range.is_some() {
            let level = self.columns[0].iter().zip(&self.speed);
            columns.push(
                level
                    .map(|(s, v)| s * fall(*v, velocity, exponent))
                    .collect(),
            );
            nonnegative.push(true);
        }
        (columns, nonnegative)
    }

    fn solve(&self, velocity: f64, exponent: f64, how: impl Fn(&Rows<'_>) -> Solved) -> Solved {
        let (columns, nonnegative) = self.columns_at(velocity, exponent);
        how(&Rows {
            columns: &columns,
            nonnegative: &nonnegative,
            target: &self.target,
            deviation: &self.deviation,
        })
    }

    /// The fit of least absolute residuals over all vs, for a first estimate of the scatter.
    pub fn rough(&self, exponent: f64) -> Solved {
        let mut grid = self.grid(exponent);
        let best = (0..grid.len()).min_by(|&a, &b| grid[a].1.cost.total_cmp(&grid[b].1.cost));
        grid.swap_remove(best.unwrap_or(0)).1
    }

    /// ln vs and the least absolute residual there.
    fn grid(&self, exponent: f64) -> Vec<(f64, Solved)> {
        let Some((low, high)) = self.range else {
            return vec![(
                0.0,
                self.solve(1.0, exponent, |rows| rows.absolute(GRID_ROUNDS)),
            )];
        };
        let (low, high) = (libm::log(low), libm::log(high));
        (0..GRID_POINTS)
            .map(|i| {
                let p = low + (high - low) * i as f64 / (GRID_POINTS - 1) as f64;
                let solved = self.solve(libm::exp(p), exponent, |rows| rows.absolute(GRID_ROUNDS));
                (p, solved)
            })
            .collect()
    }

    /// The fit of least Tukey loss over all vs: the minima of the grid are followed and the best is taken; or only the place
    /// of the grid that is next to a given vs.
    pub fn best(&self, exponent: f64, scale: f64, near: Option<f64>) -> Best {
        let grid = self.grid(exponent);
        let Some((low, high)) = self.range else {
            let start = &grid[0].1.weights;
            let solved = self.solve(1.0, exponent, |rows| rows.tukey(scale, start, ROUNDS));
            return Best {
                velocity: 0.0,
                solved,
                at_bound: false,
                profile: Vec::new(),
            };
        };
        let cost = |i: usize| grid[i].1.cost;
        let mut minima: Vec<usize> = (0..GRID_POINTS)
            .filter(|&i| {
                (i == 0 || cost(i) <= cost(i - 1))
                    && (i + 1 == GRID_POINTS || cost(i) <= cost(i + 1))
            })
            .collect();
        minima.sort_by(|&a, &b| cost(a).total_cmp(&cost(b)));
        minima.truncate(FOLLOWED);
        if let Some(near) = near.filter(|vs| *vs > 0.0) {
            let off = |i: &usize| (grid[*i].0 - libm::log(near)).abs();
            let next = (0..GRID_POINTS).min_by(|a, b| off(a).total_cmp(&off(b)));
            minima = next.into_iter().collect();
        }
        let mut best: Option<(f64, Solved)> = None;
        for i in minima {
            let start = &grid[i].1.weights;
            let at = |p: f64| {
                self.solve(libm::exp(p), exponent, |rows| {
                    rows.tukey(scale, start, ROUNDS)
                })
            };
            let ends = (
                grid[i.saturating_sub(1)].0,
                grid[(i + 1).min(GRID_POINTS - 1)].0,
            );
            let p = golden(ends, SETTLED_WIDTH, |p| at(p).cost);
            let found = at(p);
            if best.as_ref().is_none_or(|(_, b)| found.cost < b.cost) {
                best = Some((p, found));
            }
        }
        let (p, solved) = best.unwrap_or_else(|| grid[0].clone());
        let margin = 1e-6 * (libm::log(high) - libm::log(low));
        let profile = grid
            .iter()
            .map(|(p, start)| {
                let here = self.solve(libm::exp(*p), exponent, |rows| {
                    rows.tukey(scale, &start.weights, GRID_ROUNDS)
                });
                (libm::exp(*p), here.cost)
            })
            .collect();
        Best {
            profile,
            velocity: libm::exp(p),
            solved,
            at_bound: p - libm::log(low) < margin || libm::log(high) - p < margin,
        }
    }
}

/// The exponent with the least loss over all blocks together.
pub(super) fn best_exponent(blocks: &[Block], scale: f64) -> f64 {
    let cost = |delta: f64| -> f64 {
        blocks
            .iter()
            .map(|b| b.best(delta, scale, None).solved.cost)
            .sum()
    };
    let costs = EXPONENTS_TRIED.map(cost);
    let best = (0..costs.len())
        .min_by(|&a, &b| costs[a].total_cmp(&costs[b]))
        .unwrap_or(0);
    let low = best
        .checked_sub(1)
        .map_or(EXPONENT_RANGE.0, |i| EXPONENTS_TRIED[i]);
    let high = EXPONENTS_TRIED
        .get(best + 1)
        .copied()
        .unwrap_or(EXPONENT_RANGE.1);
    golden((low, high), EXPONENT_SETTLED_WIDTH, cost)
}

/// Least of a function with one minimum between two ends, by golden section.
pub(super) fn golden(ends: (f64, f64), width: f64, f: impl Fn(f64) -> f64) -> f64 {
    /// (√5 - 1)/2: of the two points inside the bracket one is used again in the next bracket.
    const GOLDEN_SECTION: f64 = 0.618_033_988_749_894_9;
    let (mut a, mut b) = ends;
    let (mut c, mut d) = (b - GOLDEN_SECTION * (b - a), a + GOLDEN_SECTION * (b - a));
    let (mut fc, mut fd) = (f(c), f(d));
    while b - a > width {
        if fc <= fd {
            (b, d, fd) = (d, c, fc);
            c = b - GOLDEN_SECTION * (b - a);
            fc = f(c);
        } else {
            (a, c, fc) = (c, d, fd);
            d = a + GOLDEN_SECTION * (b - a);
            fd = f(d);
        }
    }
    // The minimum may be at an end of the bracket, where the function falls towards it.
    [a, 0.5 * (a + b), b]
        .into_iter()
        .min_by(|x, y| f(*x).total_cmp(&f(*y)))
        .unwrap_or(a)
}
