//! Which pieces make the best motion of a given length.

use crate::aim::Aim;
use crate::information::Information;
use crate::predict::{Scratch, least_worst};
use crate::table::Table;

/// At most so many of one piece: one alone would come again and again where the prediction favours it by chance.
const MOST_OF_ONE: usize = 3;
/// Rounds of leaving out pieces and filling up again.
const ROUNDS: usize = 80;
/// Part of the axes that counts for the worst of them, and what those count for.
const WORST_PART: f64 = 0.2;
const WORST_COUNTS: f64 = 0.25;

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
    /// Its score, as that of [`Expected`](crate::Expected); it is chosen by the same above what a motion for each axis alone would leave.
    pub score: f64,
    /// Motions that were judged.
    pub evaluations: u64,
    /// Whether it was stopped before all rounds were made.
    pub interrupted: bool,
}

/// Three quarters of the mean of logarithms, and a quarter of that of the largest fifth of what they are above their floors.
pub(crate) fn score(logarithms: &[f64], floors: &[f64]) -> f64 {
    let n = logarithms.len();
    if n == 0 {
        return 0.0;
    }
    let above = logarithms.iter().zip(floors).map(|(x, floor)| x - floor);
    let mut above: Vec<f64> = above.collect();
    above.sort_by(f64::total_cmp);
    let few = (libm::ceil(WORST_PART * n as f64) as usize).max(1);
    let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
    (1.0 - WORST_COUNTS) * mean(logarithms) + WORST_COUNTS * mean(&above[n - few..])
}

/// The sums of a choice on every axis.
struct Sum<'a> {
    table: &'a Table,
    aim: &'a Aim,
    /// The axes that count.
    axes: Vec<usize>,
    /// Of each the score of a motion that is made for it alone: on some axes no motion tells much, and others could do better.
    floors: Vec<f64>,
    /// What was recorded before, and what is chosen.
    information: Vec<Information>,
    time: f64,
    pieces: Vec<usize>,
}

impl<'a> Sum<'a> {
    /// Nothing chosen yet for these axes.
    fn none(table: &'a Table, aim: &'a Aim, axes: Vec<usize>, floors: Vec<f64>) -> Self {
        let first = table.entries.first();
        let nothing = |axis: &usize| {
            let own = &first?.get(*axis)?.information;
            Some(Information::none(own.parameters, own.unknowns))
        };
        Sum {
            table,
            aim,
            information: axes.iter().filter_map(nothing).collect(),
            axes,
            floors,
            time: 0.0,
            pieces: Vec::new(),
        }
    }

    fn add(&mut self, piece: usize, sign: f64) {
        for (sum, &axis) in self.information.iter_mut().zip(&self.axes) {
            sum.add(&self.table.entries[piece][axis].information, sign);
        }
        self.time += sign * self.table.atoms[piece].duration();
    }

    fn score_with(&self, piece: Option<usize>) -> f64 {
        let Some(first) = self.information.first() else {
            return 0.0;
        };
        let (mut sums, mut scratch) = (first.clone(), Scratch::new(first));
        let each = self
            .information
            .iter()
            .zip(&self.axes)
            .map(|(before, &axis)| {
                sums.copy_from(before);
                if let Some(piece) = piece {
                    sums.add(&self.table.entries[piece][axis].information, 1.0);
                }
                libm::log(least_worst(&sums, self.aim, &mut scratch).max(1e-12))
            });
        score(&each.collect::<Vec<f64>>(), &self.floors)
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
    let axes: Vec<usize> = (0..table.entries.first().map_or(0, Vec::len)).collect();
    let for_one = |axis: usize| {
        let mut own = Sum::none(table, aim, vec![axis], vec![0.0]);
        own.fill(time, &Alone, None, &mut 0)
    };
    let floors = spread.map(axes.len(), &for_one);
    let mut sum = Sum::none(table, aim, axes, floors);
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
    sum.floors.fill(0.0);
    Choice {
        score: sum.score_with(None),
        pieces: sum.pieces,
        evaluations,
        interrupted,
    }
}
