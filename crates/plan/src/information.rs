//! What a run tells of the parameters: sums over its samples, which add over the pieces of a motion.

use crate::candidate::Candidate;
use crate::rig::Rig;
use crate::run::Run;
use stiction_identify::{Along, asymmetric_lugre_along, lugre_along, run_through};
use stiction_signal::{SignalError, Sos, gradient, gradient_sixth_order};

/// Pairs of cut-offs that an identification is likely to choose among: the rate over each, in common and on the position.
const PAIRS: [(f64, f64); PAIR_COUNT] = [(10.0, 10.0), (20.0, 5.0), (10.0, 20.0), (40.0, 10.0)];
pub(crate) const PAIR_COUNT: usize = 4;
/// Order of the filters, as in an identification.
const ORDER: usize = 4;

/// Sums over samples for each pair of cut-offs, in N^2 (N^2 m^2). The unknowns are the logarithms of the parameters of the law, the
/// terms beside it in units of Coulomb friction, the offset over it where one is fitted, and where it is fitted the delay in samples.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Information {
    /// How many of the unknowns, the first ones, are parameters whose deviation counts.
    pub parameters: usize,
    /// All of them.
    pub unknowns: usize,
    /// The sums of a pair, one pair after the other.
    sums: Vec<f64>,
}

/// The sums of a pair of cut-offs.
pub(crate) struct Sums<'a> {
    /// `J^T J`, the lower triangle by rows.
    pub gram: &'a [f64],
    /// Covariance of `J^T r` over where the encoder stands in its step.
    pub scatter: &'a [f64],
    /// Mean of `J^T r`: what the encoder and the filters add whatever the noise.
    pub bias: &'a [f64],
}

/// Entries of a symmetric matrix of unknowns.
pub(crate) const fn entries(unknowns: usize) -> usize {
    unknowns * (unknowns + 1) / 2
}

impl Information {
    /// None, of parameters of interest among unknowns.
    pub fn none(parameters: usize, unknowns: usize) -> Self {
        let pair = 2 * entries(unknowns) + unknowns;
        Information {
            parameters,
            unknowns,
            sums: vec![0.0; PAIR_COUNT * pair],
        }
    }

    /// None, of an axis.
    pub fn none_of(candidate: &Candidate) -> Self {
        let subject = &candidate.subject;
        let parameters = subject.parameters();
        let delay = usize::from(subject.elements.is_none_or(|elements| elements.delayed));
        Self::none(parameters, parameters + usize::from(subject.offset) + delay)
    }

    pub fn add(&mut self, other: &Information, sign: f64) {
        let both = self.sums.iter_mut().zip(&other.sums);
        both.for_each(|(a, b)| *a += sign * b);
    }

    /// The sums of so many times the motion: each time the encoder stands where it stood, so what it adds is the same again.
    pub fn repeat(&mut self, times: f64) {
        for pair in 0..PAIR_COUNT {
            let (gram, scatter, bias) = self.pair_mut(pair);
            let once = gram.iter_mut().chain(bias);
            once.for_each(|sum| *sum *= times);
            scatter.iter_mut().for_each(|sum| *sum *= times * times);
        }
    }

    /// Takes the sums of another one of as many unknowns.
    pub fn copy_from(&mut self, other: &Information) {
        self.sums.copy_from_slice(&other.sums);
    }

    /// The sums of each pair.
    pub fn pairs(&self) -> impl Iterator<Item = Sums<'_>> {
        let n = entries(self.unknowns);
        self.sums
            .chunks(2 * n + self.unknowns)
            .map(move |pair| Sums {
                gram: &pair[..n],
                scatter: &pair[n..2 * n],
                bias: &pair[2 * n..],
            })
    }

    /// `J^T J`, the scatter and the mean of `J^T r` of a pair.
    fn pair_mut(&mut self, pair: usize) -> (&mut [f64], &mut [f64], &mut [f64]) {
        let n = entries(self.unknowns);
        let size = 2 * n + self.unknowns;
        let own = &mut self.sums[pair * size..(pair + 1) * size];
        let (gram, rest) = own.split_at_mut(n);
        let (scatter, bias) = rest.split_at_mut(n);
        (gram, scatter, bias)
    }
}

/// `J^T J`, and `J^T r` of each run.
#[derive(Clone, Debug, Default)]
struct Products {
    gram: Vec<f64>,
    gradients: Vec<Vec<f64>>,
}

/// What of a log a motion is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Extent {
    /// A piece of it.
    Piece,
    /// All of it: what an identification leaves out at its start tells nothing.
    Log,
}

/// Information of a motion, from runs with the encoder in several places of its step.
pub(crate) fn information(
    candidate: &Candidate,
    rig: &Rig,
    runs: &[Run],
    extent: Extent,
) -> Option<Information> {
    let all = products(candidate, rig, runs, extent).ok()?;
    let count = runs.len() as f64;
    let mut out = Information::none_of(candidate);
    let unknowns = out.unknowns;
    for (pair, Products { gram, gradients }) in all.iter().enumerate() {
        let (own, scatter, bias) = out.pair_mut(pair);
        own.copy_from_slice(gram);
        for gradient in gradients {
            for (sum, x) in bias.iter_mut().zip(gradient) {
                *sum += x / count;
            }
        }
        for gradient in gradients {
            let both = gradient.iter().zip(&*bias);
            let off: Vec<f64> = both.map(|(x, mean)| x - mean).collect();
            for i in 0..unknowns {
                for j in 0..=i {
                    scatter[i * (i + 1) / 2 + j] += off[i] * off[j] / (count - 1.0).max(1.0);
                }
            }
        }
    }
    Some(out)
}

/// `J` along the true motion, and the residuals that the law leaves at the true parameters when it is driven by the encoder, both
/// filtered and thinned as an identification does. Where the encoder stands in its step hardly moves the axis, so the motion is that
/// of the first run.
fn products(
    candidate: &Candidate,
    rig: &Rig,
    runs: &[Run],
    extent: Extent,
) -> Result<[Products; PAIR_COUNT], SignalError> {
    let (rate, step) = (rig.rate, 1.0 / rig.rate);
    let mut out: [Products; PAIR_COUNT] = Default::default();
    let Some(first) = runs.first() else {
        return Ok(out);
    };
    let left_out = match (&candidate.slip, extent) {
        (Some(_), Extent::Log) => run_through(&first.velocity, step),
        _ => 0,
    };
    let columns = jacobian(candidate, step, first)?;
    let unknowns = columns.len();
    let of_source = |cutoff: f64| {
        let each = runs.iter();
        let each = each.map(|run| residual(candidate, rig, run, rate / cutoff));
        each.collect::<Result<Vec<_>, _>>()
    };
    // Pairs that filter the position alike leave the same.
    let mut residuals: Vec<(f64, Vec<Vec<f64>>)> = Vec::new();
    for (_, source) in PAIRS {
        if residuals.iter().all(|(own, _)| *own != source) {
            residuals.push((source, of_source(source)?));
        }
    }
    let mut done = [false; PAIR_COUNT];
    for next in 0..PAIR_COUNT {
        if done[next] {
            continue;
        }
        // All pairs with this common filter.
        let common = PAIRS[next].0;
        let pairs: Vec<usize> = (next..PAIR_COUNT)
            .filter(|&p| PAIRS[p].0 == common)
            .collect();
        let mut filtered = columns.clone();
        for &pair in &pairs {
            done[pair] = true;
            let own = residuals.iter().find(|(own, _)| *own == PAIRS[pair].1);
            filtered.extend(own.iter().flat_map(|(_, of_runs)| of_runs.iter().cloned()));
        }
        let filter = Sos::butterworth_low_pass(ORDER, rate / common, rate)?;
        let mut views: Vec<&mut [f64]> = filtered.iter_mut().map(Vec::as_mut_slice).collect();
        filter.zero_phase_columns(&mut views)?;
        let thin = ((common / 2.5) as usize).max(1);
        let product = |a: &[f64], b: &[f64]| {
            let both = a.iter().zip(b).skip(left_out).step_by(thin);
            thin as f64 * both.map(|(x, y)| x * y).sum::<f64>()
        };
        let (own, residuals) = filtered.split_at(unknowns);
        let mut gram = vec![0.0; entries(unknowns)];
        for i in 0..unknowns {
            for j in 0..=i {
                gram[i * (i + 1) / 2 + j] = product(&own[i], &own[j]);
            }
        }
        for (&pair, residuals) in pairs.iter().zip(residuals.chunks(runs.len())) {
            let of_run = |residual: &Vec<f64>| own.iter().map(|c| product(c, residual)).collect();
            out[pair] = Products {
                gram: gram.clone(),
                gradients: residuals.iter().map(of_run).collect(),
            };
        }
    }
    Ok(out)
}

/// The law along a velocity.
fn along(candidate: &Candidate, step: f64, velocity: &[f64], slopes: bool) -> Along {
    let kappa = candidate.sigma0 / candidate.coulomb;
    match candidate.back {
        None => {
            let (excess, vs) = (candidate.excess(), candidate.stribeck_velocity);
            lugre_along(kappa, excess, vs, step, velocity, slopes)
        }
        Some(back) => asymmetric_lugre_along(
            kappa,
            [
                candidate.excess(),
                back.static_friction / back.coulomb - 1.0,
            ],
            [candidate.stribeck_velocity, back.stribeck_velocity],
            back.coulomb / candidate.coulomb,
            (step, velocity),
            slopes,
        ),
    }
}

/// Places of the derivatives of [`Along`]: of the length of presliding, of Fs/Fc - 1 and the Stribeck velocity of each direction, and of
/// the ratio of their levels.
const KAPPA: usize = 0;
const EXCESS: [usize; 2] = [1, 4];
const VELOCITY: [usize; 2] = [2, 5];
const RATIO: usize = 3;

/// Derivatives of the force with respect to the unknowns along the true motion, in the order of [`Subject::names`](crate::Subject::names),
/// then the offset and the delay.
fn jacobian(candidate: &Candidate, step: f64, run: &Run) -> Result<Vec<Vec<f64>>, SignalError> {
    let Candidate {
        sigma1,
        coulomb,
        mass,
        ..
    } = *candidate;
    if let Some(slip) = &candidate.slip {
        let acceleration = gradient(&run.velocity, step)?;
        let motion = (&run.velocity[..], &acceleration[..]);
        let columns = slip.jacobian(candidate, step, motion);
        let mut columns = beside(candidate, run, columns);
        let elements = candidate.subject.elements;
        if elements.is_none_or(|elements| elements.delayed) {
            let mut force = slip.force(candidate, step, motion);
            for (i, force) in force.iter_mut().enumerate() {
                *force += candidate.beside(0.0, run.reading[i], run.velocity[i]);
            }
            columns.push(gradient(&force, 1.0)?);
        }
        return Ok(columns);
    }
    let along = along(candidate, step, &run.velocity, true);
    // The force about an instant is the mean over the periods beside it, and so are these differences.
    let acceleration = gradient(&run.velocity, step)?;
    let n = run.velocity.len();
    let has_levels = candidate.subject.has_levels();
    let level = |i: usize| match has_levels {
        true => coulomb * candidate.level(usize::from(along.eta[i] < 0.0), run.reading[i]),
        false => coulomb,
    };
    let slope =
        |k: usize, i: usize| level(i) * along.eta_slope[k][i] + sigma1 * along.rate_slope[k][i];
    let column = |f: &dyn Fn(usize) -> f64| (0..n).map(f).collect::<Vec<f64>>();
    let viscous = |i: usize| {
        let v = run.velocity[i];
        candidate.direction(usize::from(v < 0.0)).sigma2 * v
    };
    let terms = candidate.subject.terms.len();
    let force = column(&|i| {
        let law =
            coulomb * along.eta[i] + sigma1 * along.rate[i] + viscous(i) + mass * acceleration[i];
        match terms {
            0 => law,
            _ => law + candidate.beside(along.eta[i], run.reading[i], run.velocity[i]),
        }
    });
    let sides = 0..1 + usize::from(candidate.back.is_some());
    // ln (Fs/Fc - 1) grows this much faster than ln Fs.
    let steeper = [0, 1].map(|side| {
        let of = candidate.direction(side);
        of.static_friction / (of.static_friction - of.coulomb)
    });
    let mut out = vec![
        column(&|i| slope(KAPPA, i)),
        column(&|i| sigma1 * along.rate[i]),
    ];
    for side in sides.clone() {
        let is_one = candidate.back.is_none();
        let moves = |v: f64| is_one || usize::from(v < 0.0) == side;
        out.push(column(&|i| {
            if moves(run.velocity[i]) {
                viscous(i)
            } else {
                0.0
            }
        }));
    }
    for side in sides.clone() {
        out.push(column(&|i| {
            let own = match (side, candidate.back) {
                (0, None) => coulomb * along.eta[i] - slope(KAPPA, i),
                (0, Some(_)) => coulomb * along.eta[i] - slope(KAPPA, i) - slope(RATIO, i),
                _ => slope(RATIO, i),
            };
            own - steeper[side] * slope(EXCESS[side], i)
        }));
    }
    for side in sides.clone() {
        out.push(column(&|i| steeper[side] * slope(EXCESS[side], i)));
    }
    for side in sides {
        out.push(column(&|i| slope(VELOCITY[side], i)));
    }
    out.push(column(&|i| mass * acceleration[i]));
    for (k, term) in candidate.subject.terms.iter().enumerate() {
        let unit = coulomb / term.reach;
        out.push(column(&|i| {
            unit * candidate.column(k, along.eta[i], run.reading[i], run.velocity[i])
        }));
    }
    if candidate.subject.offset {
        out.push(vec![coulomb; n]);
    }
    out.push(gradient(&force, 1.0)?);
    Ok(out)
}

/// The columns of a law without levels that depend on the position, with those of what stands beside it.
fn beside(candidate: &Candidate, run: &Run, mut columns: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let coulomb = candidate.coulomb;
    let n = run.velocity.len();
    for (k, term) in candidate.subject.terms.iter().enumerate() {
        let unit = coulomb / term.reach;
        let at = |i: usize| unit * candidate.column(k, 0.0, run.reading[i], run.velocity[i]);
        columns.push((0..n).map(at).collect());
    }
    if candidate.subject.offset {
        columns.push(vec![coulomb; n]);
    }
    columns
}

/// What the law leaves of the force at the true parameters, driven by the filtered encoder.
fn residual(
    candidate: &Candidate,
    rig: &Rig,
    run: &Run,
    cutoff: f64,
) -> Result<Vec<f64>, SignalError> {
    let step = 1.0 / rig.rate;
    let filter = Sos::butterworth_low_pass(ORDER, cutoff, rig.rate)?;
    let position = filter.zero_phase(&run.reading)?;
    let velocity = gradient_sixth_order(&position, step)?;
    let acceleration = gradient_sixth_order(&velocity, step)?;
    if let Some(slip) = &candidate.slip {
        let asked = slip.force(candidate, step, (&velocity, &acceleration));
        let left = run.force.iter().zip(asked).enumerate();
        return Ok(left
            .map(|(i, (force, asked))| {
                force - asked - candidate.beside(0.0, position[i], velocity[i])
            })
            .collect());
    }
    let along = along(candidate, step, &velocity, false);
    let has_terms = !candidate.subject.terms.is_empty();
    let left = run.force.iter().enumerate().map(|(i, force)| {
        let v = velocity[i];
        let left = force
            - candidate.coulomb * along.eta[i]
            - candidate.sigma1 * along.rate[i]
            - candidate.direction(usize::from(v < 0.0)).sigma2 * v
            - candidate.mass * acceleration[i];
        match has_terms {
            true => left - candidate.beside(along.eta[i], position[i], v),
            false => left,
        }
    });
    Ok(left.collect())
}
