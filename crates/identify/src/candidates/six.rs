//! The six parameters of a symmetric LuGre law, motion in and force out.

use super::Scheme;
use super::algebra::Products;
use super::problem::{Candidates, Named, checked, named, physical, thinned};
use super::sums::Sampled;
use crate::conditioning::record::Record;
use crate::error::Error;
use crate::law::terms::Terms;
use crate::law::{Law, LawKind};
use stiction_lanes::{Candidate, Trial};
use stiction_parameters::{Name, Quantity};
use stiction_search::{Bounds, CostsOnly, Derivatives, Fidelity, Points, Problem};

/// The cost of Zhang et al. 2025, eqs. (13)-(15) and (35)-(38): mean square of measured minus model
/// force over that of the measured force. The genome is the natural logarithms of
/// `[sigma0, sigma1, sigma2, Fc, Fs - Fc, vs]`, SI.
///
/// ```
/// use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
/// use stiction_identify::candidates::{Candidates, Scheme, SixParameters, box_of_six};
/// use stiction_identify::{Conditioning, Cutoff, Law, LawKind, Mass, Samples, Terms, condition};
/// use stiction_search::{Limits, Plan, Run, Silent};
///
/// // A log of known friction: 20 N of Coulomb friction and 60 N s/m.
/// let side = Direction {
///     coulomb: 20.0,
///     static_friction: 30.0,
///     stribeck_velocity: 0.01,
///     viscous: 60.0,
/// };
/// let curve = Stribeck::symmetric(Shape::Gaussian, side, 0.0)?;
/// let axis = LuGre::new(5e5, Damping::Constant(800.0), curve)?;
/// let time: Vec<f64> = (0..2000).map(|i| 1e-3 * f64::from(i)).collect();
/// let velocity: Vec<f64> = time.iter().map(|t| 0.05 * (12.0 * t).sin()).collect();
/// let (mut z, mut before) = (0.0, 0.0);
/// let force = velocity.iter().map(|&v| {
///     z = axis.step_record(z, 1e-3, before, v);
///     before = v;
///     axis.force(z, v)
/// });
/// let force = force.collect();
/// let log = Samples { time, velocity: Some(velocity), force, ..Samples::default() };
/// let raw = Conditioning {
///     source_cutoff: Cutoff::Off,
///     common_cutoff: Cutoff::Off,
///     ..Conditioning::default()
/// };
/// let record = condition(&[log], &raw)?;
/// let terms = Terms { mass: Mass::Absent, offset: false, ..Terms::default() };
/// let law = Law::new(LawKind::LuGre);
/// let problem = SixParameters::new(&record, law, &terms, box_of_six(&record)?, Scheme::Explin)?;
/// let mut run = Run::new(Plan::named("niched-ga").expect("a method").start(6, 1)?, &problem);
/// run.advance(&problem, &Limits::default(), &mut Silent)?;
/// let best = run.best().expect("a finite cost");
/// let found = problem.parameters(&best.point);
/// assert!(best.cost < 1e-9);
/// assert_eq!(found[3].0, "coulomb");
/// assert!((found[3].1 / 20.0 - 1.0).abs() < 1e-3, "{found:?}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct SixParameters {
    bounds: Bounds,
    full: Sampled,
    coarse: Option<Sampled>,
    exponent: f64,
    scheme: Scheme,
}

impl SixParameters {
    /// The cost of a record over a box in the order of the genome.
    ///
    /// # Errors
    /// For another law than the symmetric LuGre law, for friction that depends on other channels or
    /// on the square of the speed, for a record that nothing can be identified from, and for a scheme
    /// other than EXPLIN where the record has a common filter or further terms.
    pub fn new(
        record: &Record,
        law: Law,
        terms: &Terms,
        bounds: Bounds,
        scheme: Scheme,
    ) -> Result<Self, Error> {
        let plain = law.kind == LawKind::LuGre
            && !law.asymmetric
            && !law.exponent_fitted
            && !law.flat
            && !law.undamped;
        if !plain || !terms.dependences.is_empty() {
            return Err(Error::Setting {
                name: "nonlinear unknowns",
                found: law.nonlinear() as f64,
                allowed: "the symmetric LuGre law with a given Stribeck exponent and friction that \
                          depends on nothing else; the separable cost takes every law with one curve",
            });
        }
        let full = Sampled::new(record, law, terms)?;
        if scheme != Scheme::Explin && !full.is_bare() {
            return Err(Error::Setting {
                name: "further terms or filters",
                found: full.nonnegative.len() as f64,
                allowed: "none beside an explicit integrator: mass = \"none\" and offset = false in the axis file, no common \
                          filter, no delay",
            });
        }
        let coarse = match thinned(record) {
            Some(record) => Some(Sampled::new(&record, law, terms)?),
            None => None,
        };
        Ok(Self {
            bounds: checked(bounds, 6)?,
            full,
            // An explicit scheme gives a different result at a longer step, so it has no coarse record.
            coarse: coarse.filter(|_| scheme == Scheme::Explin),
            exponent: law.exponent,
            scheme,
        })
    }

    /// The nonlinear unknowns of the separable method at a point: `ln kappa`, `ln(Fs/Fc - 1)`, `ln vs`.
    pub fn nonlinear(point: &[f64]) -> Vec<f64> {
        vec![point[0] - point[3], point[4] - point[3], point[5]]
    }

    /// The coefficients of the separable method that a point gives: sigma1, sigma2, Fc, SI.
    pub fn held(point: &[f64]) -> [(Name, f64); 3] {
        let [_, s1, s2, fc, ..] = physical(point);
        [
            (Quantity::Sigma1.into(), s1),
            (Quantity::Sigma2.into(), s2),
            (Quantity::Coulomb.into(), fc),
        ]
    }

    fn sampled(&self, fidelity: Fidelity) -> &Sampled {
        match (fidelity, &self.coarse) {
            (Fidelity::Coarse, Some(coarse)) => coarse,
            _ => &self.full,
        }
    }

    fn trial(&self, point: &[f64]) -> Trial {
        let [ln_kappa, ln_excess, ln_velocity] =
            [point[0] - point[3], point[4] - point[3], point[5]];
        Trial {
            ln_kappa,
            ln_excess,
            ln_velocity,
            exponent: self.exponent,
        }
    }
}

impl Problem for SixParameters {
    fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    fn costs(&self, points: &Points, fidelity: Fidelity, out: &mut [f64]) {
        let candidate = |x| Candidate {
            exponent: self.exponent,
            ..Candidate::gaussian(physical(x))
        };
        let candidates: Vec<Candidate> = points.rows().map(candidate).collect();
        let found = self.sampled(fidelity).costs(&candidates, self.scheme);
        for (out, cost) in out.iter_mut().zip(found) {
            *out = cost;
        }
    }

    fn derivatives(
        &self,
        points: &Points,
        fidelity: Fidelity,
        out: &mut [Derivatives],
    ) -> Result<(), CostsOnly> {
        if self.scheme != Scheme::Explin {
            return Err(CostsOnly);
        }
        let sampled = self.sampled(fidelity);
        let trials: Vec<Trial> = points.rows().map(|x| self.trial(x)).collect();
        // A checked box holds only points that can be computed, so the sums always exist.
        let sums = sampled.sums(&trials).unwrap_or_default();
        for ((x, out), sums) in points.rows().zip(out).zip(&sums) {
            let six = physical(x);
            let products = Products::new(sums, &sampled.shared, &six, &sampled.nonnegative);
            products.derivatives(&six, sampled.energy, out);
        }
        Ok(())
    }

    fn coarse_share(&self) -> f64 {
        match &self.coarse {
            Some(coarse) => coarse.samples as f64 / self.full.samples as f64,
            None => 1.0,
        }
    }
}

impl Candidates for SixParameters {
    fn parameters(&self, point: &[f64]) -> Named {
        named(physical(point))
    }
}
