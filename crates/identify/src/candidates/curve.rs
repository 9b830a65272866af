//! A steady curve fitted to points of speed and force: a static law without internal state, fitted
//! without a time record.

use super::problem::{Candidates, Named, checked};
use crate::error::Error;
use crate::procedure::robust::{self, ROUNDS, Rows, Tukey};
use crate::procedure::{Exponent, StaticPoint, StaticSettings, Weighed, weighed};
use stiction_parameters::{Name, Quantity, Side};
use stiction_search::{Bounds, CostsOnly, Derivatives, Fidelity, Points, Problem};

/// Genes of one direction.
const GENES: usize = 4;

/// Mean square of measured force minus `(Fc + (Fs - Fc) exp(-|v/vs|^delta)) sgn v + sigma2 v`, over that of
/// the force, or twice the robust loss of a [static map](crate::procedure::static_map()) in its place; delta is 2 unless another is given. The genome is the natural logarithms of `[sigma2, Fc, Fs - Fc, vs]`, SI, once for both
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
    /// Standard deviation that each point is expected to have; 1 for a mean square.
    deviation: Vec<f64>,
    /// Least scale of Tukey's loss, deviations; `None` for a mean square.
    scale: Option<f64>,
    energy: f64,
    exponent: f64,
    offset: bool,
}

/// A point of the map beside a candidate, in units of its deviation.
struct Row {
    residual: f64,
    slopes: [f64; GENES],
    weight: f64,
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
            deviation: vec![1.0; speed.len()],
            scale: None,
            speed,
            force,
            energy,
            exponent: 2.0,
            offset: false,
        })
    }

    /// The robust loss that [`static_map`](crate::procedure::static_map()) minimises, of the same points and settings. Where the
    /// residuals of a candidate are larger than the scatter of the points, their own median is the scale: beyond a few times
    /// its scale the loss is constant, and a search would not see where to go. A fitted exponent is taken as 2.
    ///
    /// # Errors
    /// As [`Curve::new`] and `static_map`.
    pub fn robust(
        points: &[StaticPoint],
        settings: &StaticSettings,
        bounds: Bounds,
    ) -> Result<Self, Error> {
        let Weighed { blocks, scale, .. } = weighed(points, settings)?;
        let (mut speed, mut force, mut deviation) = (Vec::new(), Vec::new(), Vec::new());
        for (block, turn) in blocks.iter().zip([1.0, -1.0]) {
            let along = block.columns[0].iter().zip(&block.speed);
            speed.extend(along.map(|(sign, v)| turn * sign * v));
            force.extend(block.target.iter().map(|f| turn * f));
            deviation.extend(&block.deviation);
        }
        let curve = Self::new(speed, force, bounds)?;
        let each = curve.force.iter().zip(&deviation);
        Ok(Self {
            energy: each.map(|(f, s)| (f / s) * (f / s)).sum(),
            exponent: match settings.exponent {
                Exponent::Given(exponent) => exponent,
                Exponent::Fitted => curve.exponent,
            },
            offset: settings.offset && !settings.asymmetric,
            scale: Some(scale),
            deviation,
            ..curve
        })
    }

    /// What each point says of a candidate, the constant force taken out, and the loss of a residual.
    fn rows(&self, x: &[f64]) -> (Vec<Row>, Option<Tukey>) {
        let p: Vec<f64> = x.iter().map(|&x| libm::exp(x)).collect();
        let each = self.speed.iter().zip(&self.force);
        let (mut left, slopes): (Vec<f64>, Vec<[f64; GENES]>) = each
            .map(|(&v, &f)| residual(&p[self.side(v)..], v, f, self.exponent))
            .unzip();
        let own =
            |left: &[f64]| robust::scale(left.iter().zip(&self.deviation).map(|(r, s)| r / s), 0);
        let loss = self.scale.map(|least| {
            if !self.offset {
                return Tukey::new(least.max(own(&left)));
            }
            let problem = Rows {
                columns: &[vec![1.0; left.len()]],
                nonnegative: &[false],
                target: &left,
                deviation: &self.deviation,
            };
            let rough = problem.absolute(ROUNDS);
            let scale = least.max(own(&rough.residual));
            left = problem.tukey(scale, &rough.weights, ROUNDS).residual;
            Tukey::new(scale)
        });
        let each = left.iter().zip(slopes).zip(&self.deviation);
        let mut rows: Vec<Row> = each
            .map(|((r, slopes), s)| Row {
                residual: r / s,
                slopes: slopes.map(|slope| slope / s),
                weight: loss.map_or(1.0, |loss| loss.weight(r / s)),
            })
            .collect();
        if self.offset {
            // The constant force follows each unknown.
            let all = || rows.iter().zip(&self.deviation);
            let total: f64 = all().map(|(row, s)| row.weight / (s * s)).sum();
            let moved: [f64; GENES] = std::array::from_fn(|i| {
                all()
                    .map(|(row, s)| row.weight * row.slopes[i] / s)
                    .sum::<f64>()
                    / total
            });
            for (row, s) in rows.iter_mut().zip(&self.deviation) {
                row.slopes
                    .iter_mut()
                    .zip(moved)
                    .for_each(|(x, moved)| *x -= moved / s);
            }
        }
        (rows, loss)
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

impl Row {
    fn cost(&self, loss: Option<Tukey>) -> f64 {
        match loss {
            Some(loss) => 2.0 * loss.cost(self.residual),
            None => self.residual * self.residual,
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
            let (rows, loss) = self.rows(x);
            *out = rows.iter().map(|row| row.cost(loss)).sum::<f64>() / self.energy;
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
            let (rows, loss) = self.rows(x);
            for (&v, row) in self.speed.iter().zip(&rows) {
                let side = self.side(v);
                let part = row.weight / self.energy;
                out.cost += row.cost(loss) / self.energy;
                for (i, a) in row.slopes.iter().enumerate() {
                    out.gradient[side + i] += part * a * row.residual;
                    for (j, b) in row.slopes.iter().enumerate() {
                        out.normal[n * (side + i) + side + j] += part * a * b;
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
