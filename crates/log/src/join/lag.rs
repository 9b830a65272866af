//! By how much one course of time is later than another, from what they have in common.
//!
//! At every lag one course is explained by columns of the other, by least squares over the samples that both have then; the lag
//! is where the least is left unexplained. Two grids: a coarse one for all lags at once, by Fourier transforms, and a fine one
//! around the best. What is left at all other lags says whether the best is the only one, and leaving out an eighth of the record
//! at a time says how well it is known, whatever the noise and whatever the columns do not explain.

use super::Course;
use rayon::prelude::*;
use stiction_policy::join;
use stiction_signal::{Lags, Spectrum};

/// Most points of a course on the coarse and on the fine grid.
const POINTS: [usize; 2] = [1 << 15, 1 << 16];
/// Time over which both are smoothed, s: an encoder is too coarse for accelerations from sample to sample.
const SMOOTHED: f64 = 0.01;
/// Lags on the fine grid.
const LAGS: usize = 25;
/// Parts of the record that are left out in turn, and the factor of a 95 % interval with so many (Student's t).
const PARTS: usize = 8;
const STUDENT: f64 = 2.365;
/// Distances within which friction follows a reversal, as parts of the travel: the longest, and the factor from one to the next, so
/// many of them on the coarse and on the fine grid.
const GIVING: f64 = 0.1;
const CLOSER: [(f64, i32); 2] = [(5.6, 5), (2.5, 10)];
/// By how much friction may be ahead of its deflection, s: bristles are damped (sigma1/sigma0 of LuGre).
const AHEAD: [f64; 9] = [0.0, 2.5e-4, 5e-4, 1e-3, 1.5e-3, 2e-3, 3e-3, 4e-3, 6e-3];
/// Speeds below which it may be higher, as parts of the largest.
const SLOW: [f64; 2] = [0.01, 0.1];
/// How closely a motion tells when its force acts, s: what friction does at a reversal is not known better before it is
/// identified. On simulated axes it was up to 1.3 ms off.
const FRICTION: f64 = 1.5e-3;
/// What keeps equations solvable whose columns are nearly the same.
const RIDGE: f64 = 1e-9;
/// Most lags that are named where several fit.
const NAMED: usize = 3;

/// What a course is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Is {
    /// A position along a line, or one whose unit nobody knows.
    Position,
    /// An angle in rad, under whose sine and cosine a weight acts.
    Angle,
    Velocity,
    Force,
}

/// A lag that explains the one course by the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lag {
    /// What is added to the times of the second course, s.
    pub seconds: f64,
    /// Half the width of its 95 % interval, s.
    pub half_width: f64,
    /// Part of the variance that is explained.
    pub explained: f64,
}

/// Why there is none.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Unclear {
    /// Too few samples, or nothing that varies.
    Little,
    /// The most that any lag explains.
    Weak(f64),
    /// Several lags explain about as much, the best first.
    Several(Vec<Lag>),
    /// The best is not known closely enough.
    Blunt(Lag),
}

impl Unclear {
    /// How much of the variance the best lag explains.
    pub fn explained(&self) -> f64 {
        match self {
            Unclear::Little => 0.0,
            Unclear::Weak(explained) => *explained,
            Unclear::Blunt(lag) => lag.explained,
            Unclear::Several(lags) => lags.first().map_or(0.0, |lag| lag.explained),
        }
    }

    /// Whether a lag that explains less is none of those that are possible.
    pub fn excludes(&self, lag: &Lag) -> bool {
        let possible = match self {
            Unclear::Little | Unclear::Weak(_) => return false,
            Unclear::Blunt(blunt) => std::slice::from_ref(blunt),
            Unclear::Several(lags) => lags,
        };
        let near =
            |other: &Lag| (other.seconds - lag.seconds).abs() <= other.half_width + lag.half_width;
        lag.explained < self.explained() && !possible.iter().any(near)
    }
}

/// What is to be added to the times of `other` so that it goes with `own`, to within `allowed` seconds.
pub(super) fn between(
    own: (&Course, Is),
    other: (&Course, Is),
    allowed: f64,
) -> Result<Lag, Unclear> {
    // A force is explained by a motion, else either by the other.
    let turned = own.1 == Is::Force && other.1 != Is::Force;
    let (motion, target) = if turned { (other, own) } else { (own, other) };
    let sign = if turned { -1.0 } else { 1.0 };
    let of = |lag: Lag| Lag {
        seconds: sign * lag.seconds,
        ..lag
    };
    let found = search(motion, target, allowed);
    found.map(of).map_err(|unclear| match unclear {
        Unclear::Several(lags) => Unclear::Several(lags.into_iter().map(of).collect()),
        Unclear::Blunt(lag) => Unclear::Blunt(of(lag)),
        other => other,
    })
}

fn search(motion: (&Course, Is), target: (&Course, Is), allowed: f64) -> Result<Lag, Unclear> {
    let ends = (motion.0.first(), target.0.first());
    let coarse = Pair::new(motion, target, 0).ok_or(Unclear::Little)?;
    let left = coarse.everywhere();
    let best = (0..left.len())
        .filter(|n| left[*n].is_finite())
        .min_by(|a, b| left[*a].total_cmp(&left[*b]))
        .ok_or(Unclear::Little)?;
    let seconds =
        |n: usize| ends.0 - ends.1 + coarse.step * (coarse.first_lag() + n as isize) as f64;
    if left[best] > join::MAX_UNEXPLAINED {
        return Err(Unclear::Weak(1.0 - left[best]));
    }
    let same = (motion.1 == Is::Force) == (target.1 == Is::Force);
    let beyond = if same {
        join::MIN_RIVAL_OF_COPY
    } else {
        join::MIN_RIVAL_OF_FORCE
    };
    let rivals = rivals(
        &left,
        best,
        (join::MIN_RIVAL_RATIO * left[best]).max(left[best] + beyond),
    );
    let fine = Pair::new(motion, target, 1).ok_or(Unclear::Little)?;
    let half = 0.5 * motion.0.step.max(target.0.step);
    let half = if same { half } else { half.max(FRICTION) };
    let around = |n: usize| {
        let lag = fine.around(
            seconds(n) - (ends.0 - ends.1),
            2.0 * coarse.step + 1.5 * allowed,
        )?;
        Some(Lag {
            seconds: lag.seconds + ends.0 - ends.1,
            half_width: lag.half_width.max(half),
            ..lag
        })
    };
    if !rivals.is_empty() {
        let lag = |n: &usize| {
            around(*n).unwrap_or(Lag {
                seconds: seconds(*n),
                half_width: coarse.step.max(half),
                explained: 1.0 - left[*n],
            })
        };
        let all = std::iter::once(&best).chain(&rivals);
        return Err(Unclear::Several(all.take(NAMED).map(lag).collect()));
    }
    let lag = around(best).ok_or(Unclear::Little)?;
    if lag.half_width > allowed {
        return Err(Unclear::Blunt(lag));
    }
    Ok(lag)
}

/// Lags beside the lobe of the best at which hardly more is left unexplained, the best of each lobe, the best first.
fn rivals(left: &[f64], best: usize, near: f64) -> Vec<usize> {
    let near = |n: &usize| left[*n] < near;
    let from = (0..best).rev().take_while(near).last().unwrap_or(best);
    let to = (best + 1..left.len())
        .take_while(near)
        .last()
        .unwrap_or(best);
    let mut out: Vec<usize> = Vec::new();
    let mut before = None;
    for n in (0..left.len())
        .filter(|n| !(from..=to).contains(n))
        .filter(near)
    {
        match out.last_mut() {
            Some(last) if before == Some(n - 1) => {
                if left[n] < left[*last] {
                    *last = n;
                }
            }
            _ => out.push(n),
        }
        before = Some(n);
    }
    out.sort_by(|a, b| left[*a].total_cmp(&left[*b]));
    out
}

/// A motion and what it explains, on grids of one step that begin with each of them.
struct Pair {
    step: f64,
    /// Columns that explain; 0 where `known` is 0. The first goes with the target, not against it.
    columns: Vec<Vec<f64>>,
    known: Vec<f64>,
    /// Which of them are friction that follows a deflection.
    friction: std::ops::Range<usize>,
    target: Vec<f64>,
    target_known: Vec<f64>,
    /// Variance of all of the target.
    variance: f64,
    fewest: f64,
}

/// Sums over the samples that two courses share at a lag.
#[derive(Clone, Debug, Default)]
struct Sums {
    count: f64,
    target: f64,
    squares: f64,
    columns: Vec<f64>,
    /// Of products of two columns, the first with itself, the second with the first, and so on.
    products: Vec<f64>,
    with_target: Vec<f64>,
}

impl Pair {
    /// On the coarse (0) or the fine grid (1).
    fn new(motion: (&Course, Is), target: (&Course, Is), grid: usize) -> Option<Self> {
        // Straight lines between a few samples go with anything.
        if motion.0.time.len().min(target.0.time.len()) < join::MIN_POINTS {
            return None;
        }
        let most = POINTS[grid];
        let longest = motion.0.span().max(target.0.span());
        let step = motion
            .0
            .step
            .min(target.0.step)
            .max(longest / (most - 1) as f64);
        let half = (SMOOTHED / step / 2.0).round().clamp(1.0, most as f64) as usize;
        let on_grid = |course: &Course| course.grid(step);
        let target_grid = smooth(&on_grid(target.0), half);
        let motion_grid = on_grid(motion.0);
        let columns = match (motion.1, target.1) {
            (Is::Force, _) => vec![smooth(&motion_grid, half)],
            (is, Is::Force) => explaining(&motion_grid, is, step, (half, CLOSER[grid])),
            (is, _) => vec![velocity(&smooth(&motion_grid, half), is, step)],
        };
        let friction = match (motion.1, target.1) {
            (Is::Force, _) => 0..0,
            (_, Is::Force) => 2..2 + SLOW.len() + CLOSER[grid].1 as usize,
            _ => 0..0,
        };
        let target = match target.1 {
            Is::Force => target_grid,
            is => velocity(&target_grid, is, step),
        };
        let known: Vec<f64> = (0..columns[0].len())
            .map(|n| f64::from(columns.iter().all(|c| c[n].is_finite())))
            .collect();
        let columns = columns.into_iter().map(|c| scaled(c, &known));
        // What does not vary explains nothing.
        let columns: Vec<Vec<f64>> = columns
            .map(|c| c.unwrap_or_else(|| vec![0.0; known.len()]))
            .collect();
        let target_known: Vec<f64> = target.iter().map(|x| f64::from(x.is_finite())).collect();
        let target = scaled(target, &target_known)?;
        let counts: [f64; 2] = [known.iter().sum(), target_known.iter().sum()];
        let shorter = counts[0].min(counts[1]);
        (shorter >= join::MIN_POINTS as f64 && columns[0].iter().any(|x| *x != 0.0)).then_some(
            Self {
                step,
                columns,
                known,
                friction,
                target,
                target_known,
                variance: 1.0,
                fewest: join::MIN_SHARED_PART * shorter,
            },
        )
    }

    fn first_lag(&self) -> isize {
        1 - self.target.len() as isize
    }

    /// What is left unexplained at every lag from the first on; infinite where the two share too little.
    fn everywhere(&self) -> Vec<f64> {
        let lags = Lags::new(self.target.len(), self.known.len());
        let of = |x: &[f64]| lags.spectrum(x);
        let product =
            |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| a * b).collect() };
        let sums = |a: &Spectrum, b: &Spectrum| lags.sums(a, b);
        let known = of(&self.known);
        let (target, target_known) = (of(&self.target), of(&self.target_known));
        let count = sums(&target_known, &known);
        let sum = sums(&target, &known);
        let squares = sums(&of(&product(&self.target, &self.target)), &known);
        let (mut columns, mut products, mut with_target) = (Vec::new(), Vec::new(), Vec::new());
        for (i, column) in self.columns.iter().enumerate() {
            let own = of(column);
            columns.push(sums(&target_known, &own));
            with_target.push(sums(&target, &own));
            for other in &self.columns[..=i] {
                products.push(sums(&target_known, &of(&product(column, other))));
            }
        }
        let at = |all: &[Vec<f64>], n: usize| all.iter().map(|sums| sums[n]).collect();
        let one = |n: usize| {
            let sums = Sums {
                count: count[n],
                target: sum[n],
                squares: squares[n],
                columns: at(&columns, n),
                products: at(&products, n),
                with_target: at(&with_target, n),
            };
            sums.unexplained(self.fewest, join::MIN_COMMON_VARIANCE * self.variance)
        };
        (0..count.len()).map(one).collect()
    }

    /// The best lag within so many seconds of one, and how well it is known.
    fn around(&self, centre: f64, within: f64) -> Option<Lag> {
        let stride = (2.0 * within / self.step / (LAGS - 1) as f64)
            .ceil()
            .max(1.0) as isize;
        let centre = (centre / self.step).round() as isize;
        let lag = |n: usize| centre + (n as isize - LAGS as isize / 2) * stride;
        let ahead: &[f64] = if self.friction.is_empty() {
            &AHEAD[..1]
        } else {
            &AHEAD
        };
        let sums_of = |ahead: &f64| -> Vec<Vec<Sums>> {
            let moved = self.ahead(*ahead);
            let part = |part| (0..LAGS).map(|n| moved.sums(part, lag(n))).collect();
            (0..PARTS).map(part).collect()
        };
        let all: Vec<Vec<Vec<Sums>>> = ahead.par_iter().map(sums_of).collect();
        let vertex = |parts: &[Vec<Sums>], without: Option<usize>| -> Option<(f64, f64)> {
            let fewest = self.fewest * (1.0 - without.map_or(0.0, |_| 1.0 / PARTS as f64));
            let left: Vec<f64> = (0..LAGS)
                .map(|n| {
                    let kept = parts.iter().enumerate();
                    let kept = kept.filter(|(part, _)| Some(*part) != without);
                    let mut all = Sums::default();
                    kept.for_each(|(_, sums)| all.add(&sums[n]));
                    all.unexplained(0.5 * fewest, 0.0)
                })
                .collect();
            let n = (0..LAGS).filter(|n| left[*n].is_finite());
            let n = n.min_by(|a, b| left[*a].total_cmp(&left[*b]))?;
            let beside = |n: Option<usize>| n.and_then(|n| left.get(n)).copied();
            let known = |n| beside(n).filter(|x: &f64| x.is_finite());
            let (beyond, least) = match (known(n.checked_sub(1)), known(Some(n + 1))) {
                (Some(a), Some(b)) if a + b > 2.0 * left[n] => {
                    let beyond = 0.5 * (a - b) / (a - 2.0 * left[n] + b);
                    (beyond, left[n] - 0.25 * (a - b) * beyond)
                }
                _ => (0.0, left[n]),
            };
            let lag = lag(n) as f64 + beyond * stride as f64;
            Some((lag * self.step, least))
        };
        let best = |without: Option<usize>| {
            let each = all.iter().filter_map(|parts| vertex(parts, without));
            each.min_by(|a, b| a.1.total_cmp(&b.1))
        };
        let (seconds, left) = best(None)?;
        let others: Vec<f64> = (0..PARTS)
            .filter_map(|part| Some(best(Some(part))?.0))
            .collect();
        let count = others.len() as f64;
        let mean = others.iter().sum::<f64>() / count;
        let spread: f64 = others.iter().map(|x| (x - mean) * (x - mean)).sum();
        Some(Lag {
            seconds,
            half_width: STUDENT * ((count - 1.0) / count * spread).sqrt(),
            explained: 1.0 - left,
        })
    }

    /// The same with friction that is so many seconds ahead.
    fn ahead(&self, seconds: f64) -> Self {
        let whole = (seconds / self.step).floor();
        let (skipped, part) = (whole as usize, seconds / self.step - whole);
        let length = self.known.len();
        let moved = |x: &[f64], n: usize| {
            let at = |n: usize| x.get(n).copied().unwrap_or(0.0);
            at(n + skipped) * (1.0 - part) + at(n + skipped + 1) * part
        };
        let mut out = Self {
            columns: self.columns.clone(),
            known: self.known.clone(),
            friction: self.friction.clone(),
            target: self.target.clone(),
            target_known: self.target_known.clone(),
            ..*self
        };
        for column in &mut out.columns[self.friction.clone()] {
            *column = (0..length).map(|n| moved(column, n)).collect();
        }
        for (n, known) in out.known.iter_mut().enumerate() {
            *known *= f64::from(moved(&self.known, n) == 1.0);
        }
        out
    }

    /// The sums over a part of the target at a lag.
    fn sums(&self, part: usize, lag: isize) -> Sums {
        let length = self.target.len();
        let mut out = Sums::default();
        out.fit(self.columns.len());
        for n in part * length / PARTS..(part + 1) * length / PARTS {
            let Ok(at) = usize::try_from(n as isize + lag) else {
                continue;
            };
            if self.target_known[n] == 0.0 || self.known.get(at).is_none_or(|known| *known == 0.0) {
                continue;
            }
            let target = self.target[n];
            out.count += 1.0;
            out.target += target;
            out.squares += target * target;
            let mut place = 0;
            for (i, column) in self.columns.iter().enumerate() {
                out.columns[i] += column[at];
                out.with_target[i] += target * column[at];
                for other in &self.columns[..=i] {
                    out.products[place] += column[at] * other[at];
                    place += 1;
                }
            }
        }
        out
    }
}

impl Sums {
    fn fit(&mut self, columns: usize) {
        self.columns.resize(columns, 0.0);
        self.with_target.resize(columns, 0.0);
        self.products.resize(columns * (columns + 1) / 2, 0.0);
    }

    fn add(&mut self, other: &Self) {
        self.fit(other.columns.len());
        self.count += other.count;
        self.target += other.target;
        self.squares += other.squares;
        for (own, other) in [
            (&mut self.columns, &other.columns),
            (&mut self.with_target, &other.with_target),
            (&mut self.products, &other.products),
        ] {
            own.iter_mut()
                .zip(other)
                .for_each(|(own, other)| *own += other);
        }
    }

    /// Part of the variance that the columns leave unexplained; infinite where there are too few samples, where the target
    /// hardly varies, and where it goes against the first column.
    fn unexplained(&self, fewest: f64, least: f64) -> f64 {
        if self.count < fewest.max(2.0) {
            return f64::INFINITY;
        }
        let mean = |sum: f64| sum / self.count;
        let middle = mean(self.target);
        let variance = mean(self.squares) - middle * middle;
        if variance <= least.max(1e-12) {
            return f64::INFINITY;
        }
        let columns = self.columns.len();
        // Cholesky's factor of the covariance, and the target in its terms.
        let mut factor = vec![0.0; self.products.len()];
        let row = |i: usize| i * (i + 1) / 2;
        let mut explained = 0.0;
        let mut turned: Vec<f64> = Vec::with_capacity(columns);
        for i in 0..columns {
            for j in 0..=i {
                let own =
                    mean(self.products[row(i) + j]) - mean(self.columns[i]) * mean(self.columns[j]);
                let known: f64 = (0..j)
                    .map(|k| factor[row(i) + k] * factor[row(j) + k])
                    .sum();
                factor[row(i) + j] = match i == j {
                    true => (own + RIDGE - known).max(RIDGE).sqrt(),
                    false => (own - known) / factor[row(j) + j],
                };
            }
            let own = mean(self.with_target[i]) - mean(self.columns[i]) * middle;
            if i == 0 && own <= 0.0 {
                return f64::INFINITY;
            }
            let known: f64 = (0..i).map(|k| factor[row(i) + k] * turned[k]).sum();
            let part = (own - known) / factor[row(i) + i];
            explained += part * part;
            turned.push(part);
        }
        (1.0 - explained / variance).max(1e-12)
    }
}

/// What explains a force: velocity, acceleration, friction that follows the motion within distances from small to large, and what
/// goes with the position.
///
/// Friction does not turn with the velocity but some way behind the reversal, which would be taken for a lag.
fn explaining(
    motion: &[f64],
    is: Is,
    step: f64,
    (half, (closer, count)): (usize, (f64, i32)),
) -> Vec<Vec<f64>> {
    let velocity = velocity(&smooth(motion, half), is, step);
    let acceleration = slope(&velocity, step);
    // What friction follows is smoothed after it, as the force is.
    let position = match is {
        Is::Position | Is::Angle => smooth(motion, 1),
        Is::Velocity | Is::Force => travelled(motion, step),
    };
    let known = || position.iter().copied().filter(|x| x.is_finite());
    let (low, high) = known().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
        (low.min(x), high.max(x))
    });
    let fastest = velocity
        .iter()
        .filter(|v| v.is_finite())
        .fold(0.0, |fastest: f64, v| fastest.max(v.abs()));
    let least = GIVING * (high - low) / closer.powi(count - 1);
    let sliding = dragged(&position, least);
    let slow = SLOW.map(|part| {
        let slow = (part * fastest).powi(2).max(f64::MIN_POSITIVE);
        let each = sliding
            .iter()
            .zip(&velocity)
            .map(|(z, v)| z * slow / (v * v + slow));
        smooth(&each.collect::<Vec<_>>(), half)
    });
    let mut out = vec![velocity, acceleration];
    out.extend(slow);
    for n in 0..count {
        let distance = GIVING * (high - low) / closer.powi(n);
        out.push(smooth(&dragged(&position, distance), half));
    }
    match is {
        Is::Angle => {
            for of in [libm::sin, libm::cos] {
                let weight: Vec<f64> = position.iter().map(|x| of(*x)).collect();
                out.push(smooth(&weight, half));
            }
        }
        Is::Position => out.push(smooth(&position, half)),
        Is::Velocity | Is::Force => {}
    }
    out
}

/// How far something is deflected that follows a position until it slips at this distance.
fn dragged(position: &[f64], distance: f64) -> Vec<f64> {
    let (mut deflection, mut before) = (0.0, None::<f64>);
    let next = |x: &f64| {
        if !x.is_finite() {
            return f64::NAN;
        }
        deflection = (deflection + x - before.unwrap_or(*x)).clamp(-distance, distance);
        before = Some(*x);
        deflection
    };
    position.iter().map(next).collect()
}

/// The way that a velocity makes; none where it is not known.
fn travelled(velocity: &[f64], step: f64) -> Vec<f64> {
    let mut way = 0.0;
    let next = |v: &f64| {
        if v.is_finite() {
            way += v * step;
        }
        way + 0.0 * v
    };
    velocity.iter().map(next).collect()
}

fn velocity(course: &[f64], is: Is, step: f64) -> Vec<f64> {
    match is {
        Is::Position | Is::Angle => slope(course, step),
        Is::Velocity | Is::Force => course.to_vec(),
    }
}

/// Central differences; unknown beside what is.
fn slope(course: &[f64], step: f64) -> Vec<f64> {
    let at = |n: Option<usize>| n.and_then(|n| course.get(n)).copied().unwrap_or(f64::NAN);
    (0..course.len())
        .map(|n| (at(Some(n + 1)) - at(n.checked_sub(1))) / (2.0 * step))
        .collect()
}

/// Three means over `half` samples to either side, one after the other; what is unknown stays so.
fn smooth(course: &[f64], half: usize) -> Vec<f64> {
    let mut out = course.to_vec();
    for _ in 0..3 {
        let mut sums = Vec::with_capacity(out.len() + 1);
        sums.push((0.0, 0_usize));
        for x in &out {
            let (sum, count) = sums[sums.len() - 1];
            sums.push(match x.is_finite() {
                true => (sum + x, count + 1),
                false => (sum, count),
            });
        }
        for (n, x) in out.iter_mut().enumerate() {
            // As many on one side as on the other, so that nothing is moved.
            let half = half.min(n).min(course.len() - 1 - n);
            let (from, to) = (sums[n - half], sums[n + half + 1]);
            if x.is_finite() {
                *x = (to.0 - from.0) / (to.1 - from.1) as f64;
            }
        }
    }
    out
}

/// A course about its mean in units of its deviation, 0 where it is not known; `None` where it does not vary.
fn scaled(course: Vec<f64>, known: &[f64]) -> Option<Vec<f64>> {
    let there = || course.iter().zip(known).filter(|(_, known)| **known > 0.0);
    let count = there().count() as f64;
    let mean = there().map(|(x, _)| x).sum::<f64>() / count;
    let variance = there().map(|(x, _)| (x - mean) * (x - mean)).sum::<f64>() / count;
    let deviation = variance.sqrt();
    let scale = |(x, known): (&f64, &f64)| match *known > 0.0 {
        true => (x - mean) / deviation,
        false => 0.0,
    };
    let varies = deviation.is_finite() && deviation > 1e-9 * mean.abs() && deviation > 0.0;
    varies.then(|| course.iter().zip(known).map(scale).collect())
}
