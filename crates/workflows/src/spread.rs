//! A problem whose points are evaluated on all threads.

use rayon::prelude::*;
use stiction_search::{Bounds, CostsOnly, Derivatives, Fidelity, Points, Problem};

/// Spreads each batch of points over the threads. The cost of a point does not depend on the other points of its
/// batch, so the result does not depend on how many threads there are.
pub(crate) struct Spread<'a, P: ?Sized>(pub &'a P);

/// Points that a thread takes at a time: two fills of the widest lanes (`stiction-lanes`).
const POINTS_PER_TASK: usize = 16;

fn part(points: &Points, from: usize) -> Points {
    let mut out = Points::new(points.dimensions());
    for row in points.rows().skip(from).take(POINTS_PER_TASK) {
        out.push(row);
    }
    out
}

impl<P: Problem + Sync + ?Sized> Problem for Spread<'_, P> {
    fn bounds(&self) -> &Bounds {
        self.0.bounds()
    }

    fn costs(&self, points: &Points, fidelity: Fidelity, costs: &mut [f64]) {
        let parts = costs.par_chunks_mut(POINTS_PER_TASK).enumerate();
        parts.for_each(|(i, costs)| {
            self.0
                .costs(&part(points, i * POINTS_PER_TASK), fidelity, costs);
        });
    }

    fn derivatives(
        &self,
        points: &Points,
        fidelity: Fidelity,
        out: &mut [Derivatives],
    ) -> Result<(), CostsOnly> {
        let parts = out.par_chunks_mut(POINTS_PER_TASK).enumerate();
        parts
            .map(|(i, out)| {
                self.0
                    .derivatives(&part(points, i * POINTS_PER_TASK), fidelity, out)
            })
            .collect()
    }

    fn coarse_share(&self) -> f64 {
        self.0.coarse_share()
    }
}
