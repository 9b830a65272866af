//! What a law leaves systematically: the part of a residual that comes back at the same time, place, speed or travel.
//!
//! Noise averages out over a part of the motion, a wrong law does not. So the motion is divided into [`parts`](Divided) in
//! several ways, and the products of what the residual has at two visits of a part, apart in time, are the energy of what comes
//! back. Encoder steps and filters leave such a part too; how much, the replicas of the fitted axis show,
//! whose law is right. What is beyond that is the misfit.
//!
//! It is a diagnosis: what comes back in the next run as well moves no parameter from one run to the next.

mod cause;
mod clocks;
mod coupling;
pub(crate) mod dynamics;
mod held;
mod limit;
mod parts;
mod reversals;
mod ripple;
mod spring_force;
mod visits;
mod waves;

pub use cause::Cause;
pub use clocks::Clocks;
pub use coupling::{Between, Coupling, Encoder};
pub use dynamics::Dynamics;
pub use held::Held;
pub use limit::Limit;
pub use parts::Divided;
use parts::Measures;
pub(crate) use parts::reversals;
pub use ripple::{Repeats, Ripple};
pub use spring_force::SpringForce;

use self::coupling::beside::Beside;
use self::reversals::Reversals;
use self::visits::{BLOCKS, Visits};
use crate::conditioning::shift::Shift;
use crate::law::terms::{ColumnKind, Delay, Terms};
use crate::separable::objective::{Evaluation, Objective};

/// What encoder and filters may leave in parts of what they leave in replicas, which show it roughly, and the standard
/// deviations beyond it that chance explains.
const ROUGHLY: f64 = 1.5;
const CHANCE: f64 = 3.0;
/// Part of the friction below which nothing that comes back matters; a record without noise leaves what rounding does.
const NEGLIGIBLE: f64 = 1e-5;

/// How a residual comes back, for each way of dividing the motion: mean squares, in the square of the unit of the force.
pub(crate) type Energies = [f64; Divided::ALL.len()];

/// A record divided in every way, and the friction along it.
pub(crate) struct Divisions {
    parts: Vec<Vec<usize>>,
    friction: Vec<f64>,
    /// The part of it that grows with speed, without which a level is stated.
    viscous: Vec<f64>,
    measures: Measures,
    /// Length over which a bristle is bent, m or rad; none for a law without one.
    length: f64,
    /// Where a bristle turns round; `None` for a law without one.
    reversals: Option<Reversals>,
}

/// What a law leaves systematically, beyond what noise, encoder and filters explain.
#[derive(Clone, Debug, PartialEq)]
pub struct Misfit {
    /// The division that shows most of it.
    pub by: Divided,
    /// Its root mean square, in the unit of the force.
    pub rms: f64,
    /// Its part of the variance of the residual, 0 to 1.
    pub share: f64,
    /// That part for every division.
    pub shares: Vec<(Divided, f64)>,
    /// How far the level of friction, without what grows with speed, differs from its mean over the stretches of time or the
    /// places, as parts of it: least and largest of the means over each.
    pub levels: (f64, f64),
    /// Whether the log is long enough to tell a change with time from what moves on meanwhile.
    pub is_long: bool,
    /// The wave over the position that explains a ripple, or a level along the stroke much better than a line does.
    pub ripple: Option<Ripple>,
    /// Whether a straight line over the position explains at least half of a level that changes along the stroke.
    pub straight: bool,
    /// A force that grows with the position that explains it.
    pub spring_force: Option<SpringForce>,
    /// A spring or a gap between motor and load that explains it.
    pub coupling: Option<Coupling>,
    /// Dynamics between force and motion that law and delay lack.
    pub dynamics: Option<Dynamics>,
    /// Clocks of force and motion that run apart.
    pub clocks: Option<Clocks>,
    /// The most that the drive gave, where more was logged.
    pub limit: Option<Limit>,
    /// Rests in which something else than friction holds the axis.
    pub held: Option<Held>,
    /// Part of the variance of the residual that sine and cosine of the position explain, as those of the angle of a joint do where
    /// a weight hangs on it, beyond what the parameters take up, 0 to 1.
    pub swings: f64,
    /// By what its course is shown: `by`, or the one of a pair that shows more of it.
    pub shown_by: Divided,
    /// Its course: in each part that `shown_by` makes, the mean of what the motion is divided by (s, m, m/s, m/s^2, or with
    /// rad), and that of the residual; for levels as parts of the friction that does not grow with speed.
    pub course: Vec<(f64, f64)>,
}

impl Divisions {
    /// Divides the record of an objective, evaluated at the unknowns `p`.
    pub fn of(objective: &Objective, at: &Evaluation, p: &[f64]) -> Self {
        let measures = Measures::of(objective.record());
        let bristle = objective.law().layout().kappa;
        let length = bristle.map(|i| libm::exp(-p[i]));
        Self {
            parts: Divided::ALL.map(|by| measures.parts(by)).to_vec(),
            friction: friction(objective, at),
            viscous: viscous(objective, at),
            reversals: length.map(|length| Reversals::of(&measures, length)),
            length: length.unwrap_or(0.0),
            measures,
        }
    }

    /// The energies of a residual along this motion.
    pub fn energies(&self, residual: &[f64]) -> Energies {
        std::array::from_fn(|i| match Divided::ALL[i] {
            Divided::AfterReversals => self.after_reversals(residual).0,
            _ if self.parts[i].is_empty() => 0.0,
            _ => self.visits(i, residual).energy(),
        })
    }

    /// What a residual has after reversals beyond what it has elsewhere, and how much of that may be chance.
    fn after_reversals(&self, residual: &[f64]) -> (f64, f64) {
        let reversals = self.reversals.as_ref();
        reversals.map_or((0.0, 0.0), |reversals| reversals.excess(residual))
    }

    /// Sums over each part of a division: for a level over the friction that does not grow with speed and that which does.
    fn sums(&self, i: usize, residual: &[f64]) -> Sums {
        let mut sums = Sums::new(&self.parts[i]);
        for (t, r) in residual.iter().enumerate() {
            let viscous = match Divided::ALL[i].is_a_level() {
                true => self.viscous[t],
                false => 0.0,
            };
            sums.add(self.parts[i][t], [self.weight(i, t) - viscous, viscous], *r);
        }
        sums
    }

    fn weight(&self, i: usize, t: usize) -> f64 {
        match Divided::ALL[i].is_a_level() {
            true => self.friction[t],
            false => 1.0,
        }
    }

    fn visits(&self, i: usize, residual: &[f64]) -> Visits {
        let n = residual.len();
        let block = |t: usize| t * BLOCKS / n.max(1);
        let mut visits = Visits::new(&self.parts[i]);
        for (t, r) in residual.iter().enumerate() {
            visits.add(block(t), self.parts[i][t], self.weight(i, t), *r);
        }
        visits
    }

    /// Means over the parts of a division, in order of what it divides by.
    fn course(&self, i: usize, residual: &[f64]) -> Vec<(f64, f64)> {
        let sums = self.sums(i, residual);
        let along = self.measures.along(Divided::ALL[i]);
        let mut places = vec![0.0; sums.samples.len()];
        for (&part, x) in self.parts[i].iter().zip(along) {
            places[part] += x;
        }
        let mut course: Vec<(f64, f64)> = places
            .iter()
            .zip(&sums.samples)
            .zip(sums.means())
            .filter_map(|((place, samples), mean)| Some((place / samples, mean?)))
            .collect();
        course.sort_by(|a, b| a.0.total_cmp(&b.0));
        course
    }

    /// What the residual of a log shows beyond chance, `replicas` being the energies of replicas of the axis.
    pub fn misfit(&self, residual: &[f64], replicas: &[Energies]) -> Option<Misfit> {
        let n = residual.len() as f64;
        let square = residual.iter().map(|r| r * r).sum::<f64>() / n;
        let mut own = Energies::default();
        let mut beyond = Energies::default();
        for i in 0..own.len() {
            let by_chance;
            (own[i], by_chance) = match Divided::ALL[i] {
                Divided::AfterReversals => self.after_reversals(residual),
                _ if self.parts[i].is_empty() => (0.0, 0.0),
                _ => {
                    let visits = self.visits(i, residual);
                    (visits.energy(), visits.chance())
                }
            };
            let count = replicas.len() as f64;
            let mean = replicas.iter().map(|e| e[i]).sum::<f64>() / count.max(1.0);
            let scatter = replicas.iter().map(|e| (e[i] - mean).powi(2)).sum::<f64>();
            let scatter = (scatter / (count - 1.0).max(1.0)).sqrt();
            let chance = scatter.max(by_chance);
            beyond[i] = (own[i] - ROUGHLY * mean.max(0.0) - CHANCE * chance).max(0.0);
        }
        let of_all = |kinds: &mut dyn Iterator<Item = usize>| {
            kinds.max_by(|&a, &b| beyond[a].total_cmp(&beyond[b]))
        };
        // What comes back says more of its cause than what lies after reversals.
        let returns = |i: &usize| Divided::ALL[*i] != Divided::AfterReversals;
        let most = of_all(&mut (0..own.len()).filter(returns))
            .filter(|&i| beyond[i] >= cause::NAMED_SHARE * square)
            .or_else(|| of_all(&mut (0..own.len())))?;
        let level = self.friction.iter().map(|f| f * f).sum::<f64>() / n;
        let least = NEGLIGIBLE * NEGLIGIBLE * level;
        if beyond[most].is_nan() || beyond[most] <= least || beyond[most].is_infinite() {
            return None;
        }
        let shares = Divided::ALL
            .into_iter()
            .zip(beyond.iter().map(|e| e / square));
        let by = Divided::ALL[most];
        let mut misfit = Misfit {
            by,
            rms: beyond[most].sqrt(),
            share: (beyond[most] / square).min(1.0),
            shares: shares.collect(),
            levels: (0.0, 0.0),
            is_long: self.measures.is_long(),
            ripple: None,
            straight: false,
            spring_force: None,
            coupling: None,
            dynamics: None,
            clocks: None,
            limit: None,
            held: None,
            swings: 0.0,
            shown_by: by,
            course: Vec::new(),
        };
        misfit.by = misfit.cause().and_then(Cause::level).unwrap_or(by);
        let shown = (0..own.len())
            .filter(|&i| misfit.by.is_shown_by(Divided::ALL[i]))
            .max_by(|&a, &b| own[a].total_cmp(&own[b]))?;
        misfit.shown_by = Divided::ALL[shown];
        misfit.levels = self.sums(shown, residual).extent();
        misfit.course = self.course(shown, residual);
        Some(misfit)
    }
}

/// Part of the squares of the first column that keeps it apart from the second where they are hardly two: at one speed both share
/// what is left, the larger more of it.
const RIDGE: f64 = 1e-3;

/// Sums over each part, of two columns and a residual.
struct Sums {
    /// Of each part the products of the first column with itself, with the second, of the second with itself, and of both with
    /// the residual.
    products: Vec<[f64; 5]>,
    samples: Vec<f64>,
}

impl Sums {
    fn new(parts: &[usize]) -> Self {
        let count = parts.iter().max().map_or(0, |most| most + 1);
        Self {
            products: vec![[0.0; 5]; count],
            samples: vec![0.0; count],
        }
    }

    fn add(&mut self, part: usize, [a, b]: [f64; 2], residual: f64) {
        let products = [a * a, a * b, b * b, a * residual, b * residual];
        let own = self.products[part].iter_mut();
        own.zip(products).for_each(|(sum, x)| *sum += x);
        self.samples[part] += 1.0;
    }

    /// What the residual has of the first column in each part, beside what it has of the second; `None` where there is none of it.
    fn means(&self) -> impl Iterator<Item = Option<f64>> {
        self.products.iter().map(|&[aa, ab, bb, ar, br]| {
            if bb <= 0.0 {
                return (aa > 0.0).then(|| ar / aa);
            }
            let ridge = RIDGE * aa;
            let (aa, bb) = (aa + ridge, bb + ridge);
            Some((ar * bb - br * ab) / (aa * bb - ab * ab)).filter(|x| x.is_finite())
        })
    }

    /// Least and largest mean.
    fn extent(&self) -> (f64, f64) {
        self.means()
            .flatten()
            .fold((0.0, 0.0), |(low, high): (f64, f64), mean| {
                (low.min(mean), high.max(mean))
            })
    }
}

impl Divisions {
    /// The misfit with a spring or a gap between motor and load where one shows. It is looked for where the misfit has no other
    /// cause than the shape of the law, or none; what it explains is a misfit, also where no division shows one.
    pub fn coupled(
        &self,
        misfit: Option<Misfit>,
        objective: &Objective,
        terms: &Terms,
        at: (&Evaluation, &[f64]),
        residual: &[f64],
    ) -> Option<Misfit> {
        let cause = misfit.as_ref().and_then(Misfit::cause);
        if !matches!(cause, None | Some(Cause::Shape)) {
            return misfit;
        }
        let Some(found) = coupling::sought(self, objective, terms, at, residual) else {
            return misfit;
        };
        let mut misfit = self.counted(misfit, Divided::Acceleration, found.share, residual);
        misfit.coupling = Some(found).filter(Coupling::is_sure);
        Some(misfit)
    }

    /// The misfit with clocks that run apart where they show. They are looked for where the misfit has no other cause than the
    /// shape of the law, of which they explain a good part, or none.
    pub fn clocked(
        &self,
        misfit: Option<Misfit>,
        objective: &Objective,
        at: &Evaluation,
        residual: &[f64],
    ) -> Option<Misfit> {
        let Some(least) = least_beside(misfit.as_ref(), clocks::PART_OF_MISFIT) else {
            return misfit;
        };
        // Motion one way and at one speed has no instant at which a delay shows, and two show no course of it.
        if !self.measures.is_long() || self.measures.reversals() < clocks::FEWEST_REVERSALS {
            return misfit;
        }
        let time = &self.measures.time;
        let found = clocks::sought(objective.record(), objective, at, time, residual);
        let Some(found) = found.filter(|found| found.share >= least) else {
            return misfit;
        };
        let mut misfit = self.counted(misfit, Divided::AfterReversals, found.share, residual);
        misfit.clocks = Some(found);
        Some(misfit)
    }

    /// The misfit, or one that nothing has shown yet, of which a cause explains so much.
    fn counted(
        &self,
        misfit: Option<Misfit>,
        divided: Divided,
        share: f64,
        residual: &[f64],
    ) -> Misfit {
        let mut misfit = misfit.unwrap_or_else(|| self.unseen(divided, residual));
        misfit.count(share, residual);
        misfit
    }

    /// The misfit with dynamics between force and motion where they show surely. They are looked for where the misfit has no other cause
    /// than the shape of the law, of which they explain a good part, or none.
    pub fn dynamic(
        &self,
        misfit: Option<Misfit>,
        found: Option<Dynamics>,
        residual: &[f64],
    ) -> Option<Misfit> {
        let Some(least) = least_beside(misfit.as_ref(), dynamics::PART_OF_MISFIT) else {
            return misfit;
        };
        let Some(found) = found.filter(|found| found.is_sure() && found.share >= least) else {
            return misfit;
        };
        let mut misfit = self.counted(misfit, Divided::Acceleration, found.share, residual);
        misfit.dynamics = Some(found);
        Some(misfit)
    }

    /// The misfit with the most that a drive gave, where more was logged; that explains what is left whatever else seems to.
    pub fn limited(
        &self,
        misfit: Option<Misfit>,
        (objective, terms): (&Objective, &Terms),
        at: &Evaluation,
        residual: &[f64],
    ) -> Option<Misfit> {
        // A force whose delay is beyond all that fits look for is logged beside its motion, which explains nearly as much.
        if terms.delay == Delay::NONE {
            return misfit;
        }
        let Some(found) = limit::sought(objective.record(), at, residual) else {
            return misfit;
        };
        let mut misfit = self.counted(misfit, Divided::Acceleration, found.share, residual);
        misfit.limit = Some(found);
        Some(misfit)
    }

    /// The misfit with the rests in which something else than friction holds the axis.
    pub fn held(
        &self,
        mut misfit: Option<Misfit>,
        (objective, terms): (&Objective, &Terms),
        at: &Evaluation,
        p: &[f64],
    ) -> Option<Misfit> {
        // Beside a delay that no fit reaches the stiffness is none of the bristles.
        if let Some(misfit) = &mut misfit
            && terms.delay != Delay::NONE
            && let Some(kappa) = objective.law().layout().kappa
        {
            let linear = objective.linear().iter().zip(&at.solution.coefficients);
            let mut level = linear.filter(|(term, _)| term.column == ColumnKind::Level);
            if let Some((_, coulomb)) = level.next() {
                misfit.held = held::sought(objective.record(), coulomb * libm::exp(p[kappa]));
            }
        }
        misfit
    }

    /// The misfit with what sine and cosine of the position explain of it.
    pub fn swung(
        &self,
        mut misfit: Option<Misfit>,
        objective: &Objective,
        at: &Evaluation,
        residual: &[f64],
    ) -> Option<Misfit> {
        if let Some(misfit) = &mut misfit {
            let record = objective.record();
            let wave = |of: fn(f64) -> f64| {
                let mut full: Vec<Vec<f64>> = record
                    .segments
                    .iter()
                    .map(|s| s.position.iter().map(|x| of(*x)).collect())
                    .collect();
                record.filter(&mut full);
                let mut column = Vec::with_capacity(residual.len());
                for (segment, full) in record.segments.iter().zip(&full) {
                    record.thin(segment, full, Shift::NONE, &mut column);
                }
                column
            };
            let beside = Beside::new(&at.jacobian(), residual);
            (misfit.swings, _) = beside.pair(&[wave(libm::sin), wave(libm::cos)]);
        }
        misfit
    }

    /// A misfit that no division shows; its course is shown by one of them.
    fn unseen(&self, by: Divided, residual: &[f64]) -> Misfit {
        let shown = Divided::ALL.iter().position(|own| *own == by);
        Misfit {
            by,
            rms: 0.0,
            share: 0.0,
            shares: Divided::ALL.map(|by| (by, 0.0)).to_vec(),
            levels: (0.0, 0.0),
            is_long: self.measures.is_long(),
            ripple: None,
            straight: false,
            spring_force: None,
            coupling: None,
            dynamics: None,
            clocks: None,
            limit: None,
            held: None,
            swings: 0.0,
            shown_by: by,
            course: shown.map_or_else(Vec::new, |i| self.course(i, residual)),
        }
    }
}

impl Misfit {
    /// Counts what one more column explains of a residual, as a part of its variance.
    fn count(&mut self, share: f64, residual: &[f64]) {
        let square = residual.iter().map(|r| r * r).sum::<f64>() / residual.len() as f64;
        self.share = self.share.max(share);
        self.rms = self.rms.max((share * square).sqrt());
    }
}

/// What another cause has to explain beside a misfit: nothing where that has none, a part of it where its cause is the shape of the
/// law; with any other cause none is looked for.
fn least_beside(misfit: Option<&Misfit>, part: f64) -> Option<f64> {
    match misfit.map(|misfit| (misfit.cause(), misfit.share)) {
        None | Some((None, _)) => Some(0.0),
        Some((Some(Cause::Shape), share)) => Some(part * share),
        Some((Some(_), _)) => None,
    }
}

/// Friction as the law has it at the kept samples.
pub(crate) fn friction(objective: &Objective, at: &Evaluation) -> Vec<f64> {
    sum_of(objective, at, |column| {
        let beside = [ColumnKind::Acceleration, ColumnKind::One];
        let wave = matches!(column, ColumnKind::Sine(_) | ColumnKind::Cosine(_));
        !wave && !beside.contains(column)
    })
}

/// The part of it that grows with speed.
fn viscous(objective: &Objective, at: &Evaluation) -> Vec<f64> {
    sum_of(objective, at, |column| {
        matches!(
            column,
            ColumnKind::Speed(_) | ColumnKind::Square(_) | ColumnKind::SpeedTimes(..)
        )
    })
}

/// The force of the linear terms of some kinds at the kept samples.
fn sum_of(objective: &Objective, at: &Evaluation, is: impl Fn(&ColumnKind) -> bool) -> Vec<f64> {
    let mut out = vec![0.0; at.residual().len()];
    let columns = at.columns.iter().zip(&at.solution.coefficients);
    let terms = objective.linear().iter().zip(columns);
    for (_, (column, c)) in terms.filter(|(term, _)| is(&term.column)) {
        for (y, x) in out.iter_mut().zip(column.iter()) {
            *y += c * x;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::Sums;

    /// A level that rises by a fifth is told as that, also where most of the friction grows with speed.
    #[test]
    fn a_level_is_told_beside_viscous_friction() {
        let parts: Vec<usize> = (0..400).map(|t| t / 200).collect();
        let mut sums = Sums::new(&parts);
        for (t, part) in parts.into_iter().enumerate() {
            let speed = 1.0 + (t % 10) as f64;
            let side = if t % 20 < 10 { 1.0 } else { -1.0 };
            let change = [0.2, -0.2][part];
            sums.add(part, [side, side * speed], change * side);
        }
        let (low, high) = sums.extent();
        assert!(
            (low + 0.2).abs() < 0.01 && (high - 0.2).abs() < 0.01,
            "{low} {high}"
        );
    }
}
