//! The identification problem: six parameters in logarithms, in a box about the truth but not
//! centred on it.

use crate::kernel;
use crate::record::{Record, SETS, measured};
use std::cell::Cell;
use std::time::{Duration, Instant};
use stiction_search::{Bounds, CostsOnly, Derivatives, Fidelity, Points, Problem};

/// Decades by which the middle of the box is off the truth.
const SHIFT: [f64; 6] = [0.31, -0.27, 0.23, -0.35, 0.29, -0.33];

pub struct Axis {
    bounds: Bounds,
    full: Record,
    coarse: Record,
    share: f64,
    /// Time spent in the model: costs, derivatives.
    pub spent: Cell<[Duration; 2]>,
}

impl Axis {
    /// A set of parameters in a box of `decades` to each side; the coarse record keeps one sample in
    /// `every`.
    pub fn new(set: usize, decades: f64, every: usize) -> Self {
        Self::boxed(set, SHIFT, decades, every)
    }

    /// The same in a small box about the truth, where nothing but the optimum is.
    pub fn near(set: usize) -> Self {
        Self::boxed(set, [0.0; 6], 0.1, 1)
    }

    fn boxed(set: usize, shift: [f64; 6], decades: f64, every: usize) -> Self {
        let truth = SETS[set].1;
        let force = measured(&truth, 1);
        let at = |side: f64| {
            let ends = truth.iter().zip(shift);
            ends.map(|(p, shift)| (p.log10() + shift + side * decades) * std::f64::consts::LN_10)
                .collect()
        };
        let (full, coarse) = (Record::new(&force, 1), Record::new(&force, every));
        Self {
            bounds: Bounds::new(at(-1.0), at(1.0)).expect("a box"),
            share: coarse.points.len() as f64 / full.points.len() as f64,
            full,
            coarse,
            spent: Cell::default(),
        }
    }

    fn record(&self, fidelity: Fidelity) -> &Record {
        match fidelity {
            Fidelity::Full => &self.full,
            Fidelity::Coarse => &self.coarse,
        }
    }

    fn spend(&self, kind: usize, since: Instant) {
        let mut spent = self.spent.get();
        spent[kind] += since.elapsed();
        self.spent.set(spent);
    }
}

fn physical(x: &[f64]) -> [f64; 6] {
    std::array::from_fn(|i| libm::exp(x[i]))
}

impl Problem for Axis {
    fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    fn costs(&self, points: &Points, fidelity: Fidelity, costs: &mut [f64]) {
        let since = Instant::now();
        let candidates: Vec<[f64; 6]> = points.rows().map(physical).collect();
        kernel::costs(self.record(fidelity), &candidates, costs);
        self.spend(0, since);
    }

    fn derivatives(
        &self,
        points: &Points,
        fidelity: Fidelity,
        out: &mut [Derivatives],
    ) -> Result<(), CostsOnly> {
        let since = Instant::now();
        for (x, out) in points.rows().zip(out) {
            let (cost, gradient, normal) = kernel::derivatives(self.record(fidelity), &physical(x));
            out.cost = cost;
            out.gradient.copy_from_slice(&gradient);
            for (row, from) in out.normal.chunks_mut(6).zip(&normal) {
                row.copy_from_slice(from);
            }
        }
        self.spend(1, since);
        Ok(())
    }

    fn coarse_share(&self) -> f64 {
        self.share
    }
}
