//! The static map: Fc, Fs, vs, sigma2 from forces at constant velocities.
//!
//! ```text
//! F(v) = [Fc + (Fs - Fc) exp(-|v/vs|^delta)] sgn v + sigma2 v + F0
//! ```
//! (Zhang et al. 2025, doi 10.1371/journal.pone.0322844, eqs. 7-8.) For a given vs (and delta)
//! everything else is linear, so a grid over vs finds the global optimum. The loss is Tukey's, its
//! scale taken from the data.

use super::parameter::{Found, quantile};
use super::profile::{Best, Block, EXPONENT_RANGE, best_exponent, fall};
use super::robust;
use super::stretch::StaticPoint;
use crate::agreement::{Disagreement, Placed, disagreement};
use crate::error::Error;
use crate::estimate::advice;
use crate::estimate::uncertainty::ROUNDED_EIGENVALUE;
use crate::parameter::covariance::Covariance;
use crate::parameter::{NORMAL_Q95, Parameter, too_uncertain};
use nalgebra::{DMatrix, SymmetricEigen};
use stiction_parameters::{Name, Quantity, Side};
use stiction_policy::{interval, procedure};

/// Smallest assumed resolution of a force, relative to its range. Without it noise-free points would give
/// parameters with a certainty that no measurement can reach.
const FORCE_RESOLUTION: f64 = 1e-6;
/// The Stribeck velocity is searched from this share of the slowest speed up to the top speed: with a
/// lower Stribeck velocity the exponential is practically zero at the slowest speed already.
pub(crate) const LEAST_VELOCITY_SHARE: f64 = 0.2;
/// Rise of static friction, as a part of the Coulomb level, below which the curve has no rise. It
/// also stands for no rise where a logarithm is needed; it is far below any rise that a log determines.
pub(super) const LEAST_RISE: f64 = 1e-9;

/// The Stribeck exponent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exponent {
    /// Known, > 0; 2 is the Gaussian curve.
    Given(f64),
    /// One more unknown, 0.4 to 4, the same in both directions.
    Fitted,
}

/// What is fitted to the points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StaticSettings {
    /// Parameters of its own for each direction.
    pub asymmetric: bool,
    /// A constant force. Not beside an asymmetric map: it cannot be told from the two levels.
    pub offset: bool,
    /// Whether there is a Stribeck curve; without it Coulomb and viscous friction are fitted.
    pub stribeck: bool,
    /// Its exponent.
    pub exponent: Exponent,
}

impl Default for StaticSettings {
    fn default() -> Self {
        Self {
            asymmetric: false,
            offset: true,
            stribeck: true,
            exponent: Exponent::Given(2.0),
        }
    }
}

/// The fitted map.
#[derive(Clone, Debug)]
pub struct StaticMap {
    /// What was fitted.
    pub settings: StaticSettings,
    /// The points, in order of velocity.
    pub points: Vec<StaticPoint>,
    /// Force of the map at each point.
    pub model: Vec<f64>,
    /// Standard deviation that each point was expected to have: standard error and scatter.
    pub deviation: Vec<f64>,
    /// Weight that the robust loss left each point, 0 to 1.
    pub weights: Vec<f64>,
    /// Scatter of the points beyond their standard errors, in the unit of the force.
    pub scatter: f64,
    /// The robust loss, dimensionless: that of two maps of the same points can be compared.
    pub loss: f64,
    /// The parameters, in the order of tables.
    pub parameters: Vec<Parameter>,
    /// Their covariance, without what was given.
    pub covariance: Covariance,
    /// Two logs that have another level of friction at the same speeds.
    pub disagreement: Option<Disagreement>,
}

impl StaticMap {
    /// The value of a parameter.
    pub fn value<N>(&self, name: N) -> Option<f64>
    where
        Name: PartialEq<N>,
    {
        let found = self.parameters.iter().find(|p| p.name == name);
        found.map(|p| p.value)
    }

    /// Points that lie off the curve: the robust loss leaves them less than a tenth of their weight.
    pub fn outlying(&self) -> impl Iterator<Item = &StaticPoint> {
        let points = self.points.iter().zip(&self.weights);
        points.filter_map(|(point, weight)| {
            (*weight < procedure::MAX_OUTLYING_WEIGHT).then_some(point)
        })
    }

    /// The exponent of the curve.
    pub fn exponent(&self) -> f64 {
        self.value(Quantity::StribeckExponent).unwrap_or(2.0)
    }
}

/// Fits the static map to points.
///
/// # Errors
/// For too few points ([`Error::TooFewSpeeds`]), numbers that are not finite, or an exponent out of
/// range.
pub fn static_map(points: &[StaticPoint], settings: &StaticSettings) -> Result<StaticMap, Error> {
    static_map_near(points, settings, &[])
}

/// The same with the Stribeck velocity sought only around the one that is given for each curve, m/s or rad/s, of positive
/// velocities first: what a search has found. Without any it is sought everywhere.
///
/// # Errors
/// As [`static_map`].
pub fn static_map_near(
    points: &[StaticPoint],
    settings: &StaticSettings,
    near: &[f64],
) -> Result<StaticMap, Error> {
    let Weighed {
        points,
        blocks,
        scatter,
        scale,
        unknowns,
    } = weighed(points, settings)?;
    let exponent = match settings.exponent {
        Exponent::Given(delta) => delta,
        Exponent::Fitted => best_exponent(&blocks, scale),
    };
    let each = blocks.iter().enumerate();
    let best: Vec<Best> = each
        .map(|(k, b)| b.best(exponent, scale, near.get(k).copied()))
        .collect();
    Ok(Fitted {
        settings,
        points,
        blocks,
        best,
        exponent,
        scale,
        scatter,
        unknowns,
    }
    .map())
}

/// Points as the robust loss sees them, before any curve is fitted.
pub(crate) struct Weighed {
    /// In order of velocity.
    points: Vec<StaticPoint>,
    /// The linear problems, with the deviation that each point is expected to have.
    pub blocks: Vec<Block>,
    scatter: f64,
    /// The scale of the loss, deviations.
    pub scale: f64,
    unknowns: usize,
}

/// Finds what the points scatter by, with outliers among them, from fits of least absolute residuals.
pub(crate) fn weighed(points: &[StaticPoint], settings: &StaticSettings) -> Result<Weighed, Error> {
    let points = checked(points, settings)?;
    let mut blocks = blocks(&points, settings)?;
    let first = match settings.exponent {
        Exponent::Given(delta) => delta,
        Exponent::Fitted => 2.0,
    };
    let unknowns = unknowns(&blocks, settings);
    let scatter = expect(&mut blocks, &points, first, unknowns);
    let rough = |b| standardised(&Block::rough(b, first).residual, b).collect::<Vec<_>>();
    let scale = robust::scale(blocks.iter().flat_map(rough), unknowns).max(1.0);
    Ok(Weighed {
        points,
        blocks,
        scatter,
        scale,
        unknowns,
    })
}

/// Points in order of velocity, all usable.
fn checked(points: &[StaticPoint], settings: &StaticSettings) -> Result<Vec<StaticPoint>, Error> {
    if let Exponent::Given(delta) = settings.exponent
        && !(delta > 0.0 && delta.is_finite())
    {
        return Err(Error::Setting {
            name: "stribeck_exponent",
            found: delta,
            allowed: "a finite number above 0",
        });
    }
    for (i, p) in points.iter().enumerate() {
        let channels = [
            ("velocity", p.velocity, p.velocity != 0.0),
            ("force", p.force, true),
            ("standard error of the force", p.error, p.error >= 0.0),
        ];
        if let Some((channel, ..)) = channels.iter().find(|(_, x, ok)| !(x.is_finite() && *ok)) {
            return Err(Error::NotFinite {
                log: p.log + 1,
                channel,
                index: i + 1,
            });
        }
    }
    let mut points = points.to_vec();
    points.sort_by(|a, b| a.velocity.total_cmp(&b.velocity));
    Ok(points)
}

/// The linear problems: one for a symmetric map, one each way for an asymmetric one.
fn blocks(points: &[StaticPoint], settings: &StaticSettings) -> Result<Vec<Block>, Error> {
    let sides: &[Option<f64>] = if settings.asymmetric {
        &[Some(1.0), Some(-1.0)]
    } else {
        &[None]
    };
    let mut out = Vec::new();
    for &side in sides {
        let own: Vec<&StaticPoint> = points
            .iter()
            .filter(|p| side.is_none_or(|s| p.velocity * s > 0.0))
            .collect();
        // In a block of one direction force and velocity count along the motion.
        let turn = side.unwrap_or(1.0);
        let sign = |p: &StaticPoint| side.map_or(p.velocity.signum(), |_| 1.0);
        let mut columns: Vec<Vec<f64>> = vec![
            own.iter().map(|p| sign(p)).collect(),
            own.iter().map(|p| turn * p.velocity).collect(),
        ];
        let mut nonnegative = vec![true, true];
        if side.is_none() && settings.offset {
            columns.push(vec![1.0; own.len()]);
            nonnegative.push(false);
        }
        let speed: Vec<f64> = own.iter().map(|p| p.velocity.abs()).collect();
        let needed = columns.len() + if settings.stribeck { 3 } else { 1 };
        if own.len() < needed {
            return Err(Error::TooFewSpeeds {
                found: own.len(),
                needed,
                direction: match side {
                    None => "",
                    Some(s) if s > 0.0 => " in the positive direction",
                    Some(_) => " in the negative direction",
                },
            });
        }
        let (slowest, top) = speed
            .iter()
            .fold((f64::INFINITY, 0.0_f64), |(a, b), v| (a.min(*v), b.max(*v)));
        out.push(Block {
            range: settings
                .stribeck
                .then_some((LEAST_VELOCITY_SHARE * slowest, top)),
            target: own.iter().map(|p| turn * p.force).collect(),
            deviation: vec![1.0; own.len()],
            speed,
            columns,
            nonnegative,
        });
    }
    Ok(out)
}

/// Number of unknowns of all blocks.
fn unknowns(blocks: &[Block], settings: &StaticSettings) -> usize {
    let curve = if settings.stribeck { 2 } else { 0 };
    let fitted = usize::from(settings.stribeck && settings.exponent == Exponent::Fitted);
    blocks
        .iter()
        .map(|b| b.columns.len() + curve)
        .sum::<usize>()
        + fitted
}

/// Widens the levels of logs that differ.
fn scattered(found: &Disagreement, parameters: &mut [Parameter]) {
    let levels = [Quantity::Coulomb, Quantity::Static];
    for p in parameters
        .iter_mut()
        .filter(|p| p.identified && levels.contains(&p.name.quantity))
    {
        let Some(std) = p.std else { continue };
        let wider = (std * std + found.between(p.value)).sqrt();
        // Friction is positive, and its interval that of a logarithm.
        let reach = NORMAL_Q95 * wider / p.value;
        p.std = Some(wider);
        p.ci95 = Some((p.value * libm::exp(-reach), p.value * libm::exp(reach)));
        if p.identifiable && reach > interval::MAX_HALF_WIDTH {
            p.identifiable = false;
            p.reason = too_uncertain(reach, "its value");
        }
    }
}

/// Leaves the rise towards low speeds open where two points or more that are slower than the Stribeck velocity are off the
/// curve and below it: an axis that has not moved on by some presliding lengths does not have its friction yet, and points that
/// are less far off for the same reason still bend the curve.
fn unsettled<'a>(outlying: impl Iterator<Item = &'a Placed<'a>>, parameters: &mut [Parameter]) {
    let velocities = parameters
        .iter()
        .filter(|p| p.name == Quantity::StribeckVelocity);
    let slow = velocities.fold(0.0, |most: f64, p| most.max(p.value));
    let below = |p: &&Placed| p.point.velocity.abs() < slow && p.residual * p.friction < 0.0;
    if outlying.filter(below).count() < procedure::MIN_UNSETTLED_POINTS {
        return;
    }
    let rise = [Quantity::Static, Quantity::StribeckVelocity];
    for p in parameters
        .iter_mut()
        .filter(|p| rise.contains(&p.name.quantity) && p.identified && p.identifiable)
    {
        p.identifiable = false;
        p.reason =
            "the slowest points lie far below the curve: friction had not settled there".into();
        p.advice = "Record longer strokes at the lowest speeds, so that the axis moves many times its presliding length".into();
    }
}

fn standardised<'a>(residual: &'a [f64], block: &'a Block) -> impl Iterator<Item = f64> + 'a {
    residual.iter().zip(&block.deviation).map(|(r, s)| r / s)
}

/// Sets the deviation that each point is expected to have, and returns the scatter beyond the
/// standard errors: cogging that was not averaged out, temperature, a curve of another shape.
fn expect(blocks: &mut [Block], points: &[StaticPoint], exponent: f64, unknowns: usize) -> f64 {
    let top = points.iter().fold(0.0_f64, |m, p| m.max(p.force.abs()));
    let floor = (FORCE_RESOLUTION * top).max(f64::MIN_POSITIVE.sqrt());
    let mut residual = Vec::new();
    for block in blocks.iter_mut() {
        block.deviation.fill(floor);
        residual.extend(block.rough(exponent).residual);
    }
    let spread = robust::scale(residual.into_iter(), unknowns);
    let mut errors: Vec<f64> = points.iter().map(|p| p.error * p.error).collect();
    let middle = errors.len() / 2;
    let (_, usual, _) = errors.select_nth_unstable_by(middle, f64::total_cmp);
    let scatter = (spread * spread - *usual).max(0.0);
    let one_way = blocks.len() > 1;
    for (k, block) in blocks.iter_mut().enumerate() {
        let side = if k == 0 { 1.0 } else { -1.0 };
        block.deviation = points
            .iter()
            .filter(|p| !one_way || p.velocity * side > 0.0)
            .map(|p| (p.error * p.error + scatter + floor * floor).sqrt())
            .collect();
    }
    scatter.sqrt()
}

struct Fitted<'a> {
    settings: &'a StaticSettings,
    points: Vec<StaticPoint>,
    blocks: Vec<Block>,
    best: Vec<Best>,
    exponent: f64,
    scale: f64,
    scatter: f64,
    unknowns: usize,
}

/// Names and slopes of what a block's unknowns mean.
struct Row {
    found: Found,
    slope: Vec<f64>,
}

impl Fitted<'_> {
    fn map(self) -> StaticMap {
        let free = (self.points.len() - self.unknowns.min(self.points.len() - 1)) as f64;
        let covariance = self.covariance();
        let rows = self.rows();
        let width = covariance.nrows();
        let t = DMatrix::from_fn(rows.len(), width, |i, j| rows[i].slope[j]);
        let matrix = &t * &covariance * t.transpose();
        let level = self
            .best
            .iter()
            .map(|b| b.solved.coefficients[0])
            .fold(0.0, f64::max);
        let names = rows.iter().map(|r| r.found.name).collect();
        let mut parameters: Vec<Parameter> = rows
            .into_iter()
            .enumerate()
            .map(|(i, row)| {
                let found = Found {
                    variance: matrix[(i, i)],
                    ..row.found
                };
                found.parameter(level, quantile(free))
            })
            .collect();
        if self.settings.stribeck && self.settings.exponent != Exponent::Fitted {
            let name = Quantity::StribeckExponent;
            parameters.push(Parameter::given(name, self.exponent));
        }
        parameters.sort_by_key(|p| p.name.quantity.place());
        let covariance = Covariance::new(names, &matrix);
        advice::explain(&mut parameters, &covariance);
        let (model, weights, deviation) = self.by_point();
        let offset = parameters.iter().find(|p| p.name == Quantity::Offset);
        let offset = offset.map_or(0.0, |p| p.value);
        let placed = self.points.iter().zip(&model);
        let placed: Vec<Placed> = placed
            .map(|(point, model)| Placed {
                point,
                residual: point.force - model,
                friction: model - offset,
            })
            .collect();
        let disagreement = disagreement(&placed, level);
        if let Some(found) = &disagreement {
            scattered(found, &mut parameters);
        }
        let outlying = placed.iter().zip(&weights);
        let outlying = outlying
            .filter_map(|(p, weight)| (*weight < procedure::MAX_OUTLYING_WEIGHT).then_some(p));
        unsettled(outlying, &mut parameters);
        StaticMap {
            disagreement,
            settings: *self.settings,
            points: self.points,
            model,
            deviation,
            weights,
            scatter: self.scatter,
            loss: self.best.iter().map(|best| best.solved.cost).sum(),
            parameters,
            covariance,
        }
    }

    /// Force of the map, weight and deviation of each point, in order of velocity.
    fn by_point(&self) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        let mut at = vec![0; self.blocks.len()];
        let mut out = (Vec::new(), Vec::new(), Vec::new());
        for point in &self.points {
            let k = usize::from(self.blocks.len() > 1 && point.velocity < 0.0);
            let turn = if k == 1 { -1.0 } else { 1.0 };
            let i = at[k];
            at[k] += 1;
            let solved = &self.best[k].solved;
            out.0.push(point.force - turn * solved.residual[i]);
            out.1.push(solved.weights[i]);
            out.2.push(self.scale * self.blocks[k].deviation[i]);
        }
        out
    }

    /// Covariance of the unknowns: each block's coefficients and ln vs, then delta where fitted.
    fn covariance(&self) -> DMatrix<f64> {
        let fitted = usize::from(self.fits_exponent());
        let widths: Vec<usize> = self
            .best
            .iter()
            .map(|b| b.solved.coefficients.len() + usize::from(self.settings.stribeck))
            .collect();
        let width = widths.iter().sum::<usize>() + fitted;
        let mut gram = DMatrix::<f64>::zeros(width, width);
        let mut all = Vec::new();
        let mut start = 0;
        for ((block, best), own) in self.blocks.iter().zip(&self.best).zip(&widths) {
            let jacobian = self.jacobian(block, best);
            let place = |j: usize| if j < *own { start + j } else { width - 1 };
            for i in 0..jacobian.len() {
                for j in 0..jacobian.len() {
                    let products = (0..block.speed.len())
                        .map(|k| jacobian[i][k] * jacobian[j][k] / block.deviation[k].powi(2));
                    gram[(place(i), place(j))] += products.sum::<f64>();
                }
            }
            let usual = standardised(&best.solved.residual, block).map(|u| u / self.scale);
            all.extend(usual);
            start += own;
        }
        let widening = robust::widening(&all, self.unknowns);
        inverse(gram) * (self.scale * self.scale * widening)
    }

    /// Slopes of a block's force with its coefficients, ln vs, and delta where fitted.
    fn jacobian(&self, block: &Block, best: &Best) -> Vec<Vec<f64>> {
        let mut out = block.columns.clone();
        if !self.settings.stribeck {
            return out;
        }
        let rise = best.solved.coefficients.last().copied().unwrap_or(0.0);
        let delta = self.exponent;
        let over = |f: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
            let rows = block.columns[0].iter().zip(&block.speed);
            rows.map(|(sign, v)| sign * f(*v, fall(*v, best.velocity, delta)))
                .collect()
        };
        let power = |v: f64| libm::pow(v / best.velocity, delta);
        // Where the exponential has become zero its slopes are zero; computing them would be 0 times infinity.
        let unless_gone = |w: f64, x: f64| if w == 0.0 { 0.0 } else { w * x };
        out.push(over(&|_, w| w));
        out.push(over(&|v, w| rise * unless_gone(w, delta * power(v))));
        if self.fits_exponent() {
            out.push(over(&|v, w| {
                -rise * unless_gone(w, power(v) * libm::log(v / best.velocity))
            }));
        }
        out
    }

    fn fits_exponent(&self) -> bool {
        self.settings.stribeck && self.settings.exponent == Exponent::Fitted
    }

    /// The physical parameters as functions of the unknowns.
    fn rows(&self) -> Vec<Row> {
        let width = self
            .best
            .iter()
            .map(|b| b.solved.coefficients.len() + usize::from(self.settings.stribeck))
            .sum::<usize>()
            + usize::from(self.fits_exponent());
        let one_way = self.points.iter().all(|p| p.velocity > 0.0)
            || self.points.iter().all(|p| p.velocity < 0.0);
        let mut out = Vec::new();
        let mut start = 0;
        for (k, (block, best)) in self.blocks.iter().zip(&self.best).enumerate() {
            let side = match (self.blocks.len(), k) {
                (1, _) => Side::Both,
                (_, 0) => Side::Positive,
                _ => Side::Negative,
            };
            let c = &best.solved.coefficients;
            let mut push = |quantity, value, slopes: &[(usize, f64)], reason| {
                let mut slope = vec![0.0; width];
                for (j, x) in slopes {
                    slope[start + j] = *x;
                }
                out.push(Row {
                    found: Found {
                        name: Name::new(quantity, side),
                        value,
                        variance: 0.0,
                        reason,
                    },
                    slope,
                });
            };
            let offset = block.columns.len() > 2;
            let mixed = if offset && one_way {
                "cannot be separated from a constant force: the axis moves in one direction only"
            } else {
                ""
            };
            let zero = |x: f64| {
                if x > 0.0 {
                    ""
                } else {
                    "held at zero: the data ask for a negative value"
                }
            };
            let level = if mixed.is_empty() { zero(c[0]) } else { mixed };
            push(Quantity::Coulomb, c[0], &[(0, 1.0)], level);
            push(Quantity::Sigma2, c[1], &[(1, 1.0)], zero(c[1]));
            if offset {
                push(Quantity::Offset, c[2], &[(2, 1.0)], mixed);
            }
            if self.settings.stribeck {
                let rise = block.columns.len();
                let none = c[rise] <= LEAST_RISE * c[0];
                let most = 0.5 * (procedure::MIN_BOUNDED_RISE * self.scale).powi(2);
                let open = best.at_bound || best.within(most).is_some_and(|(.., open)| open);
                let curve = match (none, open) {
                    (true, _) => "the force does not rise towards low speeds",
                    (_, true) => "the points hardly tell where the force rises towards low speeds",
                    _ => "",
                };
                let fixed = if curve.is_empty() { mixed } else { curve };
                let (level, velocity) = (c[0] + c[rise], best.velocity);
                let slopes = [(0, 1.0), (rise, 1.0)];
                push(Quantity::Static, level, &slopes, fixed);
                let slopes = [(rise + 1, velocity)];
                push(Quantity::StribeckVelocity, velocity, &slopes, curve);
            }
            start += c.len() + usize::from(self.settings.stribeck);
        }
        if self.fits_exponent() {
            let mut slope = vec![0.0; width];
            slope[width - 1] = 1.0;
            let (low, high) = EXPONENT_RANGE;
            let inside = self.exponent > low + 1e-3 && self.exponent < high - 1e-3;
            out.push(Row {
                found: Found {
                    name: Quantity::StribeckExponent.into(),
                    value: self.exponent,
                    variance: 0.0,
                    reason: if inside {
                        ""
                    } else {
                        "is at the bound of its search range"
                    },
                },
                slope,
            });
        }
        out
    }
}

/// Inverse of a symmetric matrix in which directions lost to rounding come out as unknown.
fn inverse(gram: DMatrix<f64>) -> DMatrix<f64> {
    let n = gram.nrows();
    let scale: Vec<f64> = (0..n)
        .map(|i| {
            let x = gram[(i, i)];
            if x > 0.0 { 1.0 / x.sqrt() } else { 1.0 }
        })
        .collect();
    let eigen = SymmetricEigen::new(DMatrix::from_fn(n, n, |i, j| {
        gram[(i, j)] * scale[i] * scale[j]
    }));
    let most = eigen.eigenvalues.iter().fold(0.0_f64, |m, x| m.max(*x));
    DMatrix::from_fn(n, n, |i, j| {
        (0..n)
            .map(|k| {
                let size = eigen.eigenvalues[k].max(ROUNDED_EIGENVALUE * most);
                eigen.eigenvectors[(i, k)] * eigen.eigenvectors[(j, k)] / size
            })
            .sum::<f64>()
            * scale[i]
            * scale[j]
    })
}
