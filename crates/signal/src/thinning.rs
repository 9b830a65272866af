//! Zero-phase filtering of which only every n-th sample is read.
//!
//! A low-pass leaves little to know between the samples that are read, but run as written, forward and
//! then backward, it computes every one of them. In the form here the output is a sum over two states:
//! that of the forward pass, which holds the samples before, and one that holds the samples after. Both
//! can go over many samples at once, since a state n samples on is a linear function of the state and of
//! the samples between.
//!
//! With the forward pass `s' = A s + B x`, `f = C s + d x`, the backward one, `t' = A t + B f` against
//! time, is the sum of a part of the forward state and of a state of the samples to come alone:
//! `t(n) = P s(n + 1) + u(n)`, `u(n - 1) = A u(n) + E x(n)`, with `P = A P A + B C`, `E = A P B + B d`.
//! Hence `y(n) = (C P A + d C) s(n) + (C P B + d^2) x(n) + C u(n)`.

use crate::cascade::Cascade;
use crate::sos::{Section, Sos};
use std::array::from_fn;
use stiction_dispatch::{InstructionSet, Kernel};

/// States of a filter of order 4.
const STATES: usize = 4;
/// Samples around each place that an output may be interpolated from.
pub(crate) const POINTS: usize = 6;
/// Doublings of the number of terms of a sum of powers of a stable matrix, at most: 2^40 terms.
const MOST_DOUBLINGS: usize = 40;
/// Size of a power of the matrix, relative to one, that adds nothing any more.
const NO_MORE: f64 = 1e-30;

type State = [f64; STATES];
/// Column by column.
type Square = [State; STATES];

/// A zero-phase filter of order 4 or less together with the number of samples from one that is read to
/// the next.
///
/// ```
/// use stiction_signal::{Reading, Sos, Thinning};
///
/// let filter = Sos::butterworth_low_pass(4, 50.0, 4000.0)?;
/// let signal: Vec<f64> = (0..4000).map(|k| (k as f64 * 0.01).sin()).collect();
/// let whole = filter.zero_phase(&signal)?;
/// let thinning = Thinning::new(&filter, 32).unwrap();
/// let read = thinning.read(&[&signal], 500, 60, &[Reading::SAMPLE]).unwrap();
/// assert!((0..60).all(|k| (read[0][0][k] - whole[500 + 32 * k]).abs() < 1e-11));
/// # Ok::<(), stiction_signal::SignalError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Thinning {
    every: usize,
    padding: usize,
    /// State after a constant of 1.
    settled: State,
    forward: Model,
    /// `P`, `E`.
    shared: Square,
    ahead: State,
    /// `C P A + d C`, `C P B + d^2`.
    past: State,
    now: f64,
    /// `A` to the power of `every`.
    jump: [[Weight; STATES]; STATES],
    /// What each sample of a block adds to the state after it, and to the one before it.
    to_past: Vec<[Weight; STATES]>,
    to_ahead: Vec<[Weight; STATES]>,
}

/// Most signals that run side by side.
const SIDE_BY_SIDE: usize = 4;
/// A weight as often as there can be signals, so that one load brings it to all of them.
type Weight = [f64; SIDE_BY_SIDE];

/// One pass of a filter.
#[derive(Clone, Copy, Debug)]
struct Model {
    a: Square,
    b: State,
    c: State,
    d: f64,
}

/// What is read at a place: a weighted sum of the six filtered samples from it on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Weight of each of them.
    pub weights: [f64; POINTS],
    /// How many count, 1 or 6: of the others nothing is computed.
    points: usize,
}

impl Reading {
    /// The sample itself.
    pub const SAMPLE: Self = Self {
        weights: [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        points: 1,
    };

    /// A weighted sum, as an interpolation between samples needs.
    pub fn between(weights: [f64; POINTS]) -> Self {
        Self {
            weights,
            points: POINTS,
        }
    }
}

impl Thinning {
    /// `None` for a filter of an order above 4, or for `every` of 0.
    pub fn new(filter: &Sos, every: usize) -> Option<Self> {
        let rest = Section {
            b: [1.0, 0.0, 0.0],
            a: [0.0, 0.0],
        };
        let sections = match *filter.sections() {
            [one] => [one, rest],
            [one, two] => [one, two],
            _ => return None,
        };
        if every == 0 {
            return None;
        }
        let forward = Model::of(sections);
        let Model { a, b, c, d } = forward;
        let shared = shared(&forward);
        let ahead = add(transform(&a, transform(&shared, b)), b.map(|b| d * b));
        // Row vectors are multiplied from the left.
        let cp = transposed(&shared, c);
        let past = add(transposed(&a, cp), c.map(|c| d * c));
        let mut to_past = vec![b];
        let mut to_ahead = vec![ahead];
        let mut jump = a;
        for i in 1..every {
            to_past.push(transform(&a, to_past[i - 1]));
            to_ahead.push(transform(&a, to_ahead[i - 1]));
            jump = product(&a, &jump);
        }
        // The first sample of a block goes through the most steps.
        to_past.reverse();
        let mut settled = [0.0; STATES];
        for (to, from) in settled
            .iter_mut()
            .zip(filter.settled_state().iter().flatten())
        {
            *to = *from;
        }
        Some(Self {
            every,
            padding: filter.padding(),
            settled,
            forward,
            shared,
            ahead,
            past,
            now: dot(cp, b) + d * d,
            jump: jump.map(repeated),
            to_past: to_past.into_iter().map(repeated).collect(),
            to_ahead: to_ahead.into_iter().map(repeated).collect(),
        })
    }

    /// Number of samples from one place to the next.
    pub fn every(&self) -> usize {
        self.every
    }

    /// For each of some signals of one length, and for each reading, its values at `count` places, the first at the
    /// sample `first`. As [`Sos::zero_phase`] would give them, up to rounding; a signal that is not finite gives values
    /// that are not. Signals that are read together give the same bits as each alone, at a third of the time: four run
    /// side by side.
    ///
    /// `None` where a place, with the points that a reading takes after it, lies outside the signals, or they are too
    /// short to be filtered or differ in length.
    pub fn read(
        &self,
        signals: &[&[f64]],
        first: usize,
        count: usize,
        readings: &[Reading],
    ) -> Option<Vec<Vec<Vec<f64>>>> {
        self.read_with(signals, first, count, readings, InstructionSet::best())
    }

    fn read_with(
        &self,
        signals: &[&[f64]],
        first: usize,
        count: usize,
        readings: &[Reading],
        instructions: InstructionSet,
    ) -> Option<Vec<Vec<Vec<f64>>>> {
        let points = readings.iter().map(|r| r.points).max()?;
        let last = count.checked_sub(1)?.checked_mul(self.every)?;
        let end = first.checked_add(last)?.checked_add(points)?;
        let length = signals.first().map_or(0, |signal| signal.len());
        let differ = signals.iter().any(|signal| signal.len() != length);
        if differ || end > length || length <= self.padding {
            return None;
        }
        let taps: Vec<Taps> = readings.iter().map(|r| self.taps(r, points)).collect();
        let places = Places {
            first,
            count,
            points,
            taps: &taps,
        };
        let mut out = Vec::with_capacity(signals.len());
        for four in signals.chunks(SIDE_BY_SIDE) {
            match *four {
                [one] => self.side_by_side([one], &places, instructions, &mut out),
                [one, two] => self.side_by_side([one, two], &places, instructions, &mut out),
                // A lane that nobody asks for costs nothing.
                [one, two, three] => {
                    self.side_by_side([one, two, three, one], &places, instructions, &mut out);
                    out.pop();
                }
                [one, two, three, four] => {
                    self.side_by_side([one, two, three, four], &places, instructions, &mut out);
                }
                _ => {}
            }
        }
        Some(out)
    }

    /// Appends what is read of each of `L` signals.
    fn side_by_side<const L: usize>(
        &self,
        signals: [&[f64]; L],
        places: &Places,
        instructions: InstructionSet,
        out: &mut Vec<Vec<Vec<f64>>>,
    ) {
        let rows = Rows::of(signals);
        let mut read = vec![vec![[0.0; L]; places.count]; places.taps.len()];
        instructions.run(Pass {
            filter: self,
            rows: rows.all(),
            places,
            out: &mut read,
        });
        out.extend((0..L).map(|l| {
            let of = |values: &Vec<[f64; L]>| values.iter().map(|row| row[l]).collect();
            read.iter().map(of).collect()
        }));
    }

    /// What a reading takes of the state before its place, of the state after its last point, and of the
    /// points.
    fn taps(&self, reading: &Reading, points: usize) -> Taps {
        let Model { a, b, c, .. } = self.forward;
        let mut past = [0.0; STATES];
        let mut ahead = [0.0; STATES];
        let mut inside = [0.0; POINTS];
        for (at, &weight) in reading.weights[..points].iter().enumerate() {
            // Row vectors, back to the place and on to the last point.
            let mut row = self.past.map(|x| weight * x);
            for before in (0..at).rev() {
                inside[before] += dot(row, b);
                row = transposed(&a, row);
            }
            past = add(past, row);
            let mut row = c.map(|x| weight * x);
            for inside in &mut inside[at + 1..points] {
                *inside += dot(row, self.ahead);
                row = transposed(&a, row);
            }
            ahead = add(ahead, row);
            inside[at] += weight * self.now;
        }
        Taps {
            past: repeated(past),
            ahead: repeated(ahead),
            inside: repeated(inside),
        }
    }
}

impl Model {
    /// Of two sections, from the answers to each state and to the input.
    fn of(sections: [Section; 2]) -> Self {
        let probe = |at: Option<usize>, x: f64| {
            let mut cascade = Cascade::<2, 1>::new(sections);
            if let Some(at) = at {
                cascade.set(at / 2, at % 2, 1.0);
            }
            let [y] = cascade.step([x]);
            let state: State = from_fn(|i| cascade.get(i / 2, i % 2));
            (state, y)
        };
        let states: [(State, f64); STATES] = from_fn(|i| probe(Some(i), 0.0));
        let (b, d) = probe(None, 1.0);
        Self {
            a: states.map(|s| s.0),
            b,
            c: states.map(|s| s.1),
            d,
        }
    }
}

/// The sum of `A^j B C A^j` over all j from 0, by doubling the number of terms.
fn shared(model: &Model) -> Square {
    let mut power = model.a;
    let mut sum: Square = from_fn(|j| model.b.map(|b| b * model.c[j]));
    for _ in 0..MOST_DOUBLINGS {
        let more = product(&power, &product(&sum, &power));
        for (sum, more) in sum.iter_mut().zip(more) {
            *sum = add(*sum, more);
        }
        power = product(&power, &power);
        if power.iter().flatten().all(|x| x.abs() < NO_MORE) {
            break;
        }
    }
    sum
}

#[inline(always)]
fn dot(a: State, b: State) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3])
}

fn repeated<const N: usize>(weights: [f64; N]) -> [Weight; N] {
    weights.map(|w| [w; SIDE_BY_SIDE])
}

fn add(a: State, b: State) -> State {
    from_fn(|i| a[i] + b[i])
}

/// `M x`.
fn transform(m: &Square, x: State) -> State {
    from_fn(|i| (0..STATES).map(|j| m[j][i] * x[j]).sum())
}

/// `x M` of a row vector.
fn transposed(m: &Square, x: State) -> State {
    from_fn(|j| dot(m[j], x))
}

fn product(a: &Square, b: &Square) -> Square {
    from_fn(|j| transform(a, b[j]))
}

/// Samples of `L` signals, those of one instant beside each other.
enum Rows<'a, const L: usize> {
    AsTheyStand(&'a [[f64; L]]),
    Interleaved(Vec<[f64; L]>),
}

impl<'a, const L: usize> Rows<'a, L> {
    /// Of signals of one length.
    fn of(signals: [&'a [f64]; L]) -> Self {
        let length = signals.first().map_or(0, |signal| signal.len());
        let signals = signals.map(|signal| &signal[..length]);
        match L {
            1 => Rows::AsTheyStand(signals[0].as_chunks::<L>().0),
            _ => Rows::Interleaved((0..length).map(|k| from_fn(|l| signals[l][k])).collect()),
        }
    }

    fn all(&self) -> &[[f64; L]] {
        match self {
            Rows::AsTheyStand(rows) => rows,
            Rows::Interleaved(rows) => rows,
        }
    }
}

/// What a reading is made of.
struct Taps {
    past: [Weight; STATES],
    ahead: [Weight; STATES],
    inside: [Weight; POINTS],
}

/// Where signals are read: at `count` places from the sample `first` on, by readings that see so many points each.
struct Places<'a> {
    first: usize,
    count: usize,
    points: usize,
    taps: &'a [Taps],
}

/// Both directions over signals side by side; `out` has for each reading a row for each place.
struct Pass<'a, const L: usize> {
    filter: &'a Thinning,
    rows: &'a [[f64; L]],
    places: &'a Places<'a>,
    out: &'a mut [Vec<[f64; L]>],
}

/// The states of `L` signals.
type States<const L: usize> = [[f64; L]; STATES];

/// `sum + w x` for each signal, the bits of which do not depend on the instruction set: each product is rounded once, in
/// the sum.
#[inline(always)]
fn fused<const L: usize>(sum: [f64; L], w: &Weight, x: [f64; L]) -> [f64; L] {
    from_fn(|l| w[l].mul_add(x[l], sum[l]))
}

/// `sum + w x` for a state.
#[inline(always)]
fn along<const L: usize>(mut sum: States<L>, w: &[Weight; STATES], x: [f64; L]) -> States<L> {
    for i in 0..STATES {
        sum[i] = fused(sum[i], &w[i], x);
    }
    sum
}

/// `sum + M x`.
#[inline(always)]
fn onto<const L: usize>(
    mut sum: States<L>,
    m: &[[Weight; STATES]; STATES],
    x: States<L>,
) -> States<L> {
    for j in 0..STATES {
        sum = along(sum, &m[j], x[j]);
    }
    sum
}

/// `w x`.
#[inline(always)]
fn times<const L: usize>(w: &State, x: [f64; L]) -> States<L> {
    from_fn(|i| x.map(|x| w[i] * x))
}

/// `sum + w . x`.
#[inline(always)]
fn weighed<const L: usize, const N: usize>(
    sum: [f64; L],
    w: &[Weight; N],
    x: &[[f64; L]; N],
) -> [f64; L] {
    let pairs = w.iter().zip(x);
    pairs.fold(sum, |sum, (w, x)| fused(sum, w, *x))
}

/// What a block of samples adds to a state.
#[inline(always)]
fn block<const L: usize>(weights: &[[Weight; STATES]], rows: &[[f64; L]]) -> States<L> {
    let (fours, rest) = weights.as_chunks::<4>();
    let (wide, tail) = rows.as_chunks::<4>();
    let mut sum = [[0.0; L]; STATES];
    for (w, x) in fours.iter().zip(wide) {
        for k in 0..4 {
            sum = along(sum, &w[k], x[k]);
        }
    }
    for (w, x) in rest.iter().zip(tail) {
        sum = along(sum, w, *x);
    }
    sum
}

impl<const L: usize> Kernel for Pass<'_, L> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Pass {
            filter,
            rows,
            places,
            out,
        } = self;
        let Places {
            first,
            count,
            points,
            taps,
        } = *places;
        let Model { a, b, c, d } = filter.forward;
        let every = filter.every;
        let end = rows.len() - 1;
        let a = a.map(repeated);
        let step = |state: States<L>, x: [f64; L]| onto(times(&b, x), &a, state);
        // Beyond each end the signal goes on turned about the end point, as in `zero_phase`.
        let turned = |end: usize, k: usize| from_fn(|l| 2.0 * rows[end][l] - rows[k][l]);
        let before = |k: usize| turned(0, k);
        let beyond = |k: usize| turned(end, end - k);

        let mut state = times(&filter.settled, before(filter.padding));
        for k in (1..=filter.padding).rev() {
            state = step(state, before(k));
        }
        for x in &rows[..first] {
            state = step(state, *x);
        }
        let mut at = first;
        for k in 0..count {
            let now = &rows[at..at + points];
            for (taps, out) in taps.iter().zip(out.iter_mut()) {
                let past = weighed([0.0; L], &taps.past, &state);
                out[k] = match now.first_chunk::<POINTS>() {
                    Some(six) => weighed(past, &taps.inside, six),
                    None => now
                        .iter()
                        .zip(&taps.inside)
                        .fold(past, |sum, (x, w)| fused(sum, w, *x)),
                };
            }
            if k + 1 < count {
                let new = block(&filter.to_past, &rows[at..at + every]);
                state = onto(new, &filter.jump, state);
                at += every;
            }
        }
        for x in &rows[at..] {
            state = step(state, *x);
        }
        let mut last = [0.0; L];
        for k in 1..=filter.padding {
            let x = beyond(k);
            last = from_fn(|l| d * x[l] + dot(c, state.map(|s| s[l])));
            state = step(state, x);
        }

        // The backward pass begins as if the last value of the forward one had been there for ever.
        let shared = filter.shared.map(repeated);
        let held = onto([[0.0; L]; STATES], &shared, state);
        let mut state: States<L> =
            from_fn(|i| from_fn(|l| filter.settled[i] * last[l] - held[i][l]));
        let back = |state: States<L>, x: [f64; L]| onto(times(&filter.ahead, x), &a, state);
        for k in (1..=filter.padding).rev() {
            state = back(state, beyond(k));
        }
        for x in rows[at + points..].iter().rev() {
            state = back(state, *x);
        }
        for k in (0..count).rev() {
            for (taps, out) in taps.iter().zip(out.iter_mut()) {
                out[k] = weighed(out[k], &taps.ahead, &state);
            }
            if k > 0 {
                at -= every;
                let new = block(&filter.to_ahead, &rows[at + points..at + points + every]);
                state = onto(new, &filter.jump, state);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn signal(n: usize) -> Vec<f64> {
        let wave = |k: usize| libm::sin(0.013 * k as f64) + 0.3 * libm::sin(0.7 * k as f64 + 1.0);
        (0..n)
            .map(|k| wave(k) + 1e-3 * ((k * 7919 % 1000) as f64))
            .collect()
    }

    /// Six samples weighted, with a weight of the first as large as that of the last.
    const WEIGHTS: [f64; POINTS] = [0.4, -0.2, 0.7, 0.1, 0.05, -0.4];

    #[test]
    fn what_is_read_is_what_the_whole_filter_gives() {
        let x = signal(6000);
        for (order, cutoff, every) in [
            (4, 0.2, 2),
            (4, 0.025, 16),
            (4, 0.02, 7),
            (3, 0.05, 8),
            (2, 0.01, 40),
            (1, 0.1, 1),
            (4, 4e-3, 100),
            (4, 4e-4, 1000),
        ] {
            let filter = Sos::butterworth_low_pass(order, cutoff, 1.0).unwrap();
            let whole = filter.zero_phase(&x).unwrap();
            let thinning = Thinning::new(&filter, every).unwrap();
            // The states of a slow filter are large differences of each other.
            let allowed = 1e-12_f64.max(1e-15 / (cutoff * cutoff));
            let mut worst = 0.0_f64;
            for first in [0, 3, 900] {
                let count = (x.len() - first - POINTS) / every + 1;
                let readings = [Reading::SAMPLE, Reading::between(WEIGHTS)];
                let read = thinning
                    .read(&[&x], first, count, &readings)
                    .unwrap()
                    .remove(0);
                for (k, (sample, between)) in read[0].iter().zip(&read[1]).enumerate() {
                    let whole = &whole[first + k * every..];
                    let right: f64 = WEIGHTS.iter().zip(whole).map(|(w, y)| w * y).sum();
                    let off = (sample - whole[0]).abs().max((between - right).abs());
                    worst = worst.max(off);
                }
                let alone = thinning.read(&[&x], first, count, &readings[..1]).unwrap();
                let mut pairs = alone[0][0].iter().zip(&read[0]);
                assert!(pairs.all(|(a, b)| (a - b).abs() < allowed));
            }
            assert!(worst < allowed, "order {order}, {cutoff}: {worst:e}");
        }
    }

    #[test]
    fn every_instruction_set_and_number_of_signals_gives_the_same_bits() {
        let signals: Vec<Vec<f64>> = (0..6)
            .map(|i| {
                signal(3000)
                    .iter()
                    .map(|x| x + 0.1 * f64::from(i) * x * x)
                    .collect()
            })
            .collect();
        let signals: Vec<&[f64]> = signals.iter().map(Vec::as_slice).collect();
        let filter = Sos::butterworth_low_pass(4, 0.03, 1.0).unwrap();
        let thinning = Thinning::new(&filter, 13).unwrap();
        let readings = [Reading::SAMPLE, Reading::between(WEIGHTS)];
        let bits = |signals: &[&[f64]], set| -> Vec<u64> {
            let read = thinning.read_with(signals, 5, 200, &readings, set);
            let all = read.unwrap().into_iter().flatten().flatten();
            all.map(f64::to_bits).collect()
        };
        let sets = InstructionSet::all();
        let alone: Vec<u64> = signals.iter().flat_map(|x| bits(&[x], sets[0])).collect();
        for set in sets {
            for many in 1..=signals.len() {
                let together = bits(&signals[..many], set);
                assert_eq!(together.len(), many * 400);
                assert!(together == alone[..many * 400], "{set} {many}");
            }
        }
    }

    #[test]
    fn a_place_outside_and_a_filter_of_a_high_order_are_refused() {
        let x = signal(200);
        let filter = Sos::butterworth_low_pass(4, 0.1, 1.0).unwrap();
        let thinning = Thinning::new(&filter, 10).unwrap();
        let six = [Reading::between(WEIGHTS)];
        assert!(thinning.read(&[&x], 0, 20, &[Reading::SAMPLE]).is_some());
        assert!(thinning.read(&[&x], 4, 20, &six).is_some());
        assert!(thinning.read(&[&x], 5, 20, &six).is_none());
        assert!(thinning.read(&[&x], 0, 21, &six).is_none());
        assert!(thinning.read(&[&x[..15]], 0, 1, &six).is_none());
        assert!(thinning.read(&[&x], usize::MAX, 2, &six).is_none());
        assert!(thinning.read(&[&x, &x[1..]], 0, 1, &six).is_none());
        let steep = Sos::butterworth_low_pass(6, 0.1, 1.0).unwrap();
        assert!(Thinning::new(&steep, 10).is_none() && Thinning::new(&filter, 0).is_none());
    }
}
