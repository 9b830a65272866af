//! A steady curve fitted to points of speed and force: a static law without internal state, fitted
//! without a time record.

use super::problem::{Candidates, Named, checked};
use crate::error::Error;
use stiction_parameters::{Name, Quantity, Side};
use stiction_search::{Bounds, CostsOnly, Derivatives, Fidelity, Points, Problem};

/// Genes of one direction.
const GENES: usize = 4;

/// Mean square of measured force minus `(Fc + (Fs - Fc) exp(-|v/vs|^delta)) sgn v + sigma2 v`, over that of
/// the force; delta is 2 unless another is given. The genome is the natural logarithms of `[sigma2, Fc, Fs - Fc, vs]`, SI, once for both
/// directions or once for each, the positive one first.
///
/// ```
/// use stiction_identify::candidates::Curve;
/// use stiction_search::{Bounds, Fidelity, Points, Problem};
///
/// let truth = [0.02, 0.28, 0.06, 0.2].map(f64::ln); // N m s/rad, N m, N m, rad/s
/// let speeds: Vec<f64> = (-20..=20).map(|i| 0.05 * f64::from(i)).collect(); // rad/s
/// let force: Vec<f64> = speeds
///     .iter()
///     .map(|v: &f64| (0.28 + 0.06 * (-(v / 0.2).powi(2)).exp()) * v.signum() + 0.02 * v)
///     .collect(); // N m
/// let bounds = Bounds::new(truth.map(|x| x - 1.0).into(), truth.map(|x| x + 1.0).into())?;
/// let curve = Curve::new(speeds, force, bounds)?;
/// let mut points = Points::new(4);
/// points.push(&truth);
/// let mut cost = [1.0];
/// curve.costs(&points, Fidelity::Full, &mut cost);
/// assert!(cost[0] < 1e-28);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Curve {
    bounds: Bounds,
    speed: Vec<f64>,
    force: Vec<f64>,
    energy: f64,
    exponent: f64,
    offset: bool,
}

impl Curve {
    /// Points of a static map, and a box of 4 or 8 dimensions. Friction at zero speed is not defined by
    /// the curve, so points at standstill are left out.
    ///
    /// # Errors
    /// For lengths that differ, fewer points than unknowns, numbers that are not finite, or another
    /// number of dimensions.
    pub fn new(speed: Vec<f64>, force: Vec<f64>, bounds: Bounds) -> Result<Self, Error> {
        let genes = if bounds.dimensions() == GENES { 4 } else { 8 };
        let bounds = checked(bounds, genes)?;
        let usable = |(v, f): &(f64, f64)| *v != 0.0 && v.is_finite() && f.is_finite();
        let whole = speed.len() == force.len();
        let pairs = speed.into_iter().zip(force).filter(usable);
        let (speed, force): (Vec<f64>, Vec<f64>) = pairs.unzip();
        if !whole || speed.len() < genes {
            return Err(Error::Setting {
                name: "points of the curve",
                found: speed.len() as f64,
                allowed: "as many speeds as forces, finite, at least one for each unknown",
            });
        }
        let energy: f64 = force.iter().map(|f| f * f).sum();
        if !(energy > 0.0 && energy.is_finite()) {
            return Err(Error::NoForce { value: energy });
        }
        Ok(Self {
            bounds,
            speed,
            force,
            energy,
            exponent: 2.0,
            offset: false,
        })
    }

    /// The same with another Stribeck exponent, above 0.
    pub fn exponent(self, exponent: f64) -> Self {
        Self { exponent, ..self }
    }

    /// The same with a constant force beside the curve, which is solved for each candidate; beside one curve for both
    /// directions only, as it cannot be told from two.
    pub fn with_offset(self) -> Self {
        Self {
            offset: self.bounds.dimensions() == GENES,
            ..self
        }
    }

    /// Residuals with their slopes at every point of the map, the constant force taken out.
    fn rows(&self, x: &[f64]) -> Vec<(f64, [f64; GENES])> {
        let p: Vec<f64> = x.iter().map(|&x| libm::exp(x)).collect();
        let each = self.speed.iter().zip(&self.force);
        let mut rows: Vec<_> = each
            .map(|(&v, &f)| residual(&p[self.side(v)..], v, f, self.exponent))
            .collect();
        if self.offset {
            let n = rows.len() as f64;
            let mean = rows.iter().map(|row| row.0).sum::<f64>() / n;
            let means: [f64; GENES] =
                std::array::from_fn(|i| rows.iter().map(|row| row.1[i]).sum::<f64>() / n);
            for row in &mut rows {
                row.0 -= mean;
                row.1.iter_mut().zip(means).for_each(|(x, mean)| *x -= mean);
            }
        }
        rows
    }

    /// Where the genes of the direction of a speed begin.
    fn side(&self, speed: f64) -> usize {
        if speed < 0.0 && self.bounds.dimensions() > GENES {
            GENES
        } else {
            0
        }
    }
}

/// Residual (model minus measured) and its derivatives with respect to the four genes.
fn residual(p: &[f64], v: f64, force: f64, exponent: f64) -> (f64, [f64; GENES]) {
    let [s2, fc, excess, vs] = [p[0], p[1], p[2], p[3]];
    let power = if exponent == 2.0 {
        (v / vs) * (v / vs)
    } else {
        libm::pow((v / vs).abs(), exponent)
    };
    let fall = excess * libm::exp(-power) * v.signum();
    let level = fc * v.signum();
    // Far above vs the exponential term is zero, and so are its derivatives.
    let slope = if fall == 0.0 {
        0.0
    } else {
        exponent * fall * power
    };
    (level + fall + s2 * v - force, [s2 * v, level, fall, slope])
}

impl Problem for Curve {
    fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    fn costs(&self, points: &Points, _: Fidelity, out: &mut [f64]) {
        for (x, out) in points.rows().zip(out) {
            let sum: f64 = self.rows(x).iter().map(|(r, _)| r * r).sum();
            *out = sum / self.energy;
        }
    }

    fn derivatives(
        &self,
        points: &Points,
        _: Fidelity,
        out: &mut [Derivatives],
    ) -> Result<(), CostsOnly> {
        let n = self.bounds.dimensions();
        for (x, out) in points.rows().zip(out) {
            for (&v, (r, slopes)) in self.speed.iter().zip(self.rows(x)) {
                let side = self.side(v);
                out.cost += r * r / self.energy;
                for (i, a) in slopes.iter().enumerate() {
                    out.gradient[side + i] += a * r / self.energy;
                    for (j, b) in slopes.iter().enumerate() {
                        out.normal[n * (side + i) + side + j] += a * b / self.energy;
                    }
                }
            }
        }
        Ok(())
    }
}

impl Candidates for Curve {
    fn parameters(&self, point: &[f64]) -> Named {
        let sides = Side::all(point.len() != GENES);
        let sides = sides.iter().zip(point.chunks(GENES));
        sides
            .flat_map(|(side, x)| {
                let [s2, fc, excess, vs] = std::array::from_fn(|i| libm::exp(x[i]));
                [
                    (Quantity::Sigma2, s2),
                    (Quantity::Coulomb, fc),
                    (Quantity::Static, fc + excess),
                    (Quantity::StribeckVelocity, vs),
                ]
                .map(|(name, value)| (Name::new(name, *side), value))
            })
            .collect()
    }
}
