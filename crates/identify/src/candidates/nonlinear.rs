//! The nonlinear unknowns of the separable method, everything linear solved.

use super::problem::{Candidates, Named, checked};
use crate::conditioning::record::Record;
use crate::error::Error;
use crate::law::Law;
use crate::law::physical::physical;
use crate::law::terms::{Delay, Terms};
use crate::separable::objective::Objective;
use crate::separable::search_box::SearchBox;
use stiction_search::{Bounds, CostsOnly, Derivatives, Fidelity, Points, Problem};

/// The cost that the separable method descends, over its own box; any law but those of Maxwell slip.
/// A delay that would be fitted is taken as zero here.
pub struct Nonlinear<'a> {
    bounds: Bounds,
    full: Objective<'a>,
    coarse: Option<Objective<'a>>,
}

impl<'a> Nonlinear<'a> {
    /// The cost of a record, with its [`thinned`](super::problem::thinned) stand-in where there is one.
    ///
    /// # Errors
    /// For a law without nonlinear unknowns or of Maxwell slip, and for a record that nothing can be
    /// identified from.
    pub fn new(
        record: &'a Record,
        thinned: Option<&'a Record>,
        law: Law,
        terms: &Terms,
        bounds: &SearchBox,
    ) -> Result<Self, Error> {
        if law.nonlinear() == 0 || law.kind.has_elements() {
            return Err(Error::Setting {
                name: "nonlinear unknowns",
                found: law.nonlinear() as f64,
                allowed: "at least one, and no Maxwell-slip law: there is nothing else to search",
            });
        }
        let terms = match terms.delay {
            Delay::Fitted => &Terms {
                delay: Delay::NONE,
                ..terms.clone()
            },
            Delay::Given(_) => terms,
        };
        let full = crate::separable::checked::checked(record, law, terms)?;
        let ends =
            |end: fn(&SearchBox, usize) -> f64| (0..bounds.len()).map(|i| end(bounds, i)).collect();
        let bounds = Bounds::new(ends(SearchBox::low), ends(SearchBox::high));
        let bounds = bounds.map_err(|_| Error::Setting {
            name: "box",
            found: law.nonlinear() as f64,
            allowed: "finite bounds for each unknown, the lower first",
        })?;
        Ok(Self {
            bounds: checked(bounds, law.nonlinear())?,
            full,
            coarse: thinned.map(|record| Objective::new(record, law, terms)),
        })
    }

    fn objective(&self, fidelity: Fidelity) -> &Objective<'a> {
        match (fidelity, &self.coarse) {
            (Fidelity::Coarse, Some(coarse)) => coarse,
            _ => &self.full,
        }
    }
}

impl Problem for Nonlinear<'_> {
    fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    fn costs(&self, points: &Points, fidelity: Fidelity, out: &mut [f64]) {
        let objective = self.objective(fidelity);
        for (p, out) in points.rows().zip(out) {
            *out = objective.evaluate(p, false).cost / objective.energy();
        }
    }

    fn derivatives(
        &self,
        points: &Points,
        fidelity: Fidelity,
        out: &mut [Derivatives],
    ) -> Result<(), CostsOnly> {
        let objective = self.objective(fidelity);
        let energy = objective.energy();
        for (p, out) in points.rows().zip(out) {
            let at = objective.evaluate(p, true);
            out.cost = at.cost / energy;
            for (g, d) in out.gradient.iter_mut().zip(at.descent.iter()) {
                *g = -d / energy;
            }
            for (n, h) in out.normal.iter_mut().zip(at.hessian.iter()) {
                *n = h / energy;
            }
        }
        Ok(())
    }

    fn coarse_share(&self) -> f64 {
        let len = |objective: &Objective| objective.record().len() as f64;
        self.coarse
            .as_ref()
            .map_or(1.0, |coarse| len(coarse) / len(&self.full))
    }
}

impl Candidates for Nonlinear<'_> {
    fn parameters(&self, point: &[f64]) -> Named {
        let objective = &self.full;
        let c = objective.evaluate(point, false).solution.coefficients;
        let step = objective.record().step();
        let all = physical(objective.law(), objective.linear(), step, point, &c);
        all.into_iter().map(|p| (p.name, p.value)).collect()
    }
}
