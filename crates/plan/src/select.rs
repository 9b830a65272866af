//! Which pieces make the best motion of a given length.

use crate::aim::Aim;
use crate::information::Information;
use crate::predict::{Scratch, least_worst};
use crate::table::Table;

/// At most so many of one piece: one alone would come again and again where the prediction favours it by chance.
const MOST_OF_ONE: usize = 3;
/// Rounds of leaving out pieces and filling up again.
const ROUNDS: usize = 80;
/// Part of the axes that counts for the worst of them.
const WORST_PART: f64 = 0.2;

/// Evaluates a score for each of `count` numbers, on as many threads as there are; the scores come in their order.
pub trait Spread {
    /// `score(0), score(1), ..`
    fn map(&self, count: usize, score: &(dyn Fn(usize) -> f64 + Sync)) -> Vec<f64>;
}

/// On the calling thread alone.
#[derive(Clone, Copy, Debug)]
pub struct Alone;

impl Spread for Alone {
    fn map(&self, count: usize, score: &(dyn Fn(usize) -> f64 + Sync)) -> Vec<f64> {
        (0..count).map(score).collect()
    }
}

/// What is chosen: indices of pieces of the table, with repetitions.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// Pieces, in the order they were taken.
    pub pieces: Vec<usize>,
    /// Its score: the mean of half the mean and half the mean of the worst fifth, over the axes, of the logarithm of the
    /// deviation of the worst parameter.
    pub score: f64,
    /// Motions that were judged.
    pub evaluations: u64,
    /// Whether it was stopped before all rounds were made.
    pub interrupted: bool,
}

/// Mean of half the mean and half the mean of the worst fifth.
pub(crate) fn score(logarithms: &mut [f64]) -> f64 {
    let n = logarithms.len();
    if n == 0 {
        return 0.0;
    }
    logarithms.sort_by(f64::total_cmp);
    let few = (libm::ceil(WORST_PART * n as f64) as usize).max(1);
    let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
    0.5 * mean(logarithms) + 0.5 * mean(&logarithms[n - few..])
}

/// The sums of a choice on every axis.
struct Sum<'a> {
    table: &'a Table,
    aim: &'a Aim,
    /// What was recorded before, and what is chosen.
    information: Vec<Information>,
    time: f64,
    pieces: Vec<usize>,
}

impl Sum<'_> {
    fn add(&mut self, piece: usize, sign: f64) {
        for (sum, entry) in self.information.iter_mut().zip(&self.table.entries[piece]) {
            sum.add(&entry.information, sign);
        }
        self.time += sign * self.table.atoms[piece].duration();
    }

    fn score_with(&self, piece: Option<usize>) -> f64 {
        let Some(first) = self.information.first() else {
            return 0.0;
        };
        let (mut sums, mut scratch) = (first.clone(), Scratch::new(first));
        let each = self.information.iter().enumerate().map(|(axis, before)| {
            sums.copy_from(before);
            if let Some(piece) = piece {
                sums.add(&self.table.entries[piece][axis].information, 1.0);
            }
            libm::log(least_worst(&sums, self.aim, &mut scratch).max(1e-12))
        });
        score(&mut each.collect::<Vec<f64>>())
    }

    /// Adds the piece with the largest gain per second that still fits, until none does or none helps.
    fn fill(
        &mut self,
        most: f64,
        spread: &dyn Spread,
        barred: Option<usize>,
        evaluations: &mut u64,
    ) -> f64 {
        let mut now = self.score_with(None);
        loop {
            let count = |piece: usize| self.pieces.iter().filter(|p| **p == piece).count();
            let fitting: Vec<usize> = (0..self.table.atoms.len())
                .filter(|&piece| {
                    let fits = self.time + self.table.atoms[piece].duration() <= most + 1e-9;
                    fits && count(piece) < MOST_OF_ONE && Some(piece) != barred
                })
                .collect();
            let scores = spread.map(fitting.len(), &|i| self.score_with(Some(fitting[i])));
            *evaluations += fitting.len() as u64;
            let gain = |i: &usize| (now - scores[*i]) / self.table.atoms[fitting[*i]].duration();
            let best = (0..fitting.len()).max_by(|a, b| gain(a).total_cmp(&gain(b)).then(b.cmp(a)));
            let Some(best) = best.filter(|best| gain(best) > 0.0) else {
                return now;
            };
            now = scores[best];
            self.add(fitting[best], 1.0);
            self.pieces.push(fitting[best]);
        }
    }
}

/// Chooses pieces of at most `time` s in all, greedily and then by leaving out one to three and
/// filling up again. `go_on` is asked between rounds with the part that is done.
pub fn select(
    table: &Table,
    aim: &Aim,
    time: f64,
    spread: &dyn Spread,
    go_on: &mut dyn FnMut(f64) -> bool,
) -> Choice {
    let first = table.entries.first().into_iter().flatten();
    let nothing =
        first.map(|e| Information::none(e.information.parameters, e.information.unknowns));
    let mut sum = Sum {
        table,
        aim,
        information: nothing.collect(),
        time: 0.0,
        pieces: Vec::new(),
    };
    let mut evaluations = 0;
    let mut best = sum.fill(time, spread, None, &mut evaluations);
    let mut interrupted = false;
    let (mut round, mut idle) = (0, 0);
    while round < ROUNDS && idle < sum.pieces.len().max(1) * 3 {
        if !go_on(round as f64 / ROUNDS as f64) {
            interrupted = true;
            break;
        }
        let n = sum.pieces.len();
        if n == 0 {
            break;
        }
        // One to three neighbours in the order in which they were taken, each beginning in turn.
        let count = (1 + (round / n) % 3).min(n);
        let dropped: Vec<usize> = (0..count).map(|k| (round + k) % n).collect();
        let before = (sum.information.clone(), sum.time, sum.pieces.clone());
        let barred = sum.pieces[dropped[0]];
        for &k in &dropped {
            sum.add(before.2[k], -1.0);
        }
        let mut k = 0;
        sum.pieces.retain(|_| {
            k += 1;
            !dropped.contains(&(k - 1))
        });
        let found = sum.fill(time, spread, Some(barred), &mut evaluations);
        if found < best - 1e-9 {
            best = found;
            idle = 0;
        } else {
            (sum.information, sum.time, sum.pieces) = before;
            idle += 1;
        }
        round += 1;
    }
    Choice {
        pieces: sum.pieces,
        score: best,
        evaluations,
        interrupted,
    }
}
