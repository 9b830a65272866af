//! sigma0 and sigma1 of a LuGre law whose steady curve is known.

use super::problem::{Candidates, Named, checked};
use super::six::SixParameters;
use crate::error::Error;
use libm::log;
use stiction_friction::Direction;
use stiction_search::{Bounds, CostsOnly, Derivatives, Fidelity, Points, Problem};

/// Genes.
const GENES: usize = 2;

/// The cost of [`SixParameters`] with the steady curve held: the dynamic step of Zhang et al. 2025 (doi
/// 10.1371/journal.pone.0322844), eqs. (9) and (35)-(38). The genome is the natural logarithms of `[sigma0, sigma1]`, SI.
pub struct Dynamic {
    bounds: Bounds,
    all: SixParameters,
    /// Logarithms of `[sigma2, Fc, Fs - Fc, vs]`.
    curve: [f64; 4],
}

impl Dynamic {
    /// The six-parameter cost with these numbers held, over the first two dimensions of its box.
    ///
    /// # Errors
    /// For a curve of which no logarithm can be taken: every number, and the rise of the static friction, must be above 0.
    pub fn new(all: SixParameters, curve: &Direction<f64>) -> Result<Self, Error> {
        let rise = curve.static_friction - curve.coulomb;
        let held = [
            ("sigma2", curve.viscous),
            ("coulomb", curve.coulomb),
            ("static - coulomb", rise),
            ("stribeck_velocity", curve.stribeck_velocity),
        ];
        if let Some((name, found)) = held.into_iter().find(|(_, x)| !(*x > 0.0 && x.is_finite())) {
            return Err(Error::Setting {
                name,
                found,
                allowed: "a finite number above 0 to search sigma0 and sigma1 beside: the search takes logarithms",
            });
        }
        let ends = |ends: &[f64]| ends[..GENES].to_vec();
        let own = all.bounds();
        let bounds = Bounds::new(ends(own.low()), ends(own.high()));
        let bounds = bounds.map_err(|_| Error::Setting {
            name: "dimensions of the box",
            found: own.dimensions() as f64,
            allowed: "one for each unknown",
        })?;
        Ok(Self {
            bounds: checked(bounds, GENES)?,
            all,
            curve: held.map(|(_, x)| log(x)),
        })
    }

    fn whole(&self, point: &[f64]) -> [f64; 6] {
        let [s2, fc, excess, vs] = self.curve;
        [point[0], point[1], s2, fc, excess, vs]
    }

    fn points(&self, points: &Points) -> Points {
        let mut whole = Points::new(6);
        for point in points.rows() {
            whole.push(&self.whole(point));
        }
        whole
    }
}

impl Problem for Dynamic {
    fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    fn costs(&self, points: &Points, fidelity: Fidelity, out: &mut [f64]) {
        self.all.costs(&self.points(points), fidelity, out);
    }

    fn derivatives(
        &self,
        points: &Points,
        fidelity: Fidelity,
        out: &mut [Derivatives],
    ) -> Result<(), CostsOnly> {
        let mut all = vec![Derivatives::zeros(6); out.len()];
        let whole = self.points(points);
        self.all.derivatives(&whole, fidelity, &mut all)?;
        for (all, out) in all.iter().zip(out) {
            out.cost = all.cost;
            out.gradient.copy_from_slice(&all.gradient[..GENES]);
            let rows = out.normal.chunks_mut(GENES).zip(all.normal.chunks(6));
            rows.for_each(|(out, all)| out.copy_from_slice(&all[..GENES]));
        }
        Ok(())
    }

    fn coarse_share(&self) -> f64 {
        self.all.coarse_share()
    }
}

impl Candidates for Dynamic {
    fn parameters(&self, point: &[f64]) -> Named {
        self.all.parameters(&self.whole(point))
    }
}
