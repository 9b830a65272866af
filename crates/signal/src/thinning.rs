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
//!
//! Four places are read at once: what is read there is a weighted sum of the samples around them, of the state before
//! these and of the state after them. Samples stand in the lanes of a vector, so one signal fills them.

use crate::cascade::Cascade;
use crate::sos::{Section, Sos};
use std::array::from_fn;
use std::cmp::Ordering;
use stiction_dispatch::{InstructionSet, Kernel};

/// States of a filter of order 4.
const STATES: usize = 4;
/// Samples around each place that an output may be interpolated from.
pub(crate) const POINTS: usize = 6;
/// Places that are read at once, and samples of one vector.
const LANES: usize = 4;
/// Tiles by which the samples of readings at four places may go beyond those from there to the next four places.
const WIDER: usize = 2;
/// Most doublings of the number of terms of a sum of powers of a stable matrix: 2^40 terms.
const MOST_DOUBLINGS: usize = 40;
/// Size of a power of the matrix, relative to one, that adds nothing any more.
const NO_MORE: f64 = 1e-30;

type State = [f64; STATES];
/// Column by column.
type Square = [State; STATES];
type Lanes = [f64; LANES];
/// For each of four samples its weights in four sums.
type Tile = [Lanes; LANES];

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
    /// `A` to the power of the samples from one place to the next, and of those of four places.
    step: Square,
    jump: Square,
    /// What each sample of four places adds to the state after them, and to the one before them.
    to_past: Vec<Tile>,
    to_ahead: Vec<Tile>,
    /// Weight in an output of the samples before it and after it, the nearest first.
    before: Vec<f64>,
    after: Vec<f64>,
}

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
        let step = (1..every).fold(a, |step, _| product(&a, &step));
        let jump = (1..LANES).fold(step, |jump, _| product(&step, &jump));
        // As far as from the first of four places to the last point of the last one.
        let reach = LANES * every + POINTS;
        let follow = |from: State| -> Vec<State> {
            let states = std::iter::successors(Some(from), |x| Some(transform(&a, *x)));
            states.take(reach).collect()
        };
        let (to_past, to_ahead) = (follow(b), follow(ahead));
        let block = ..LANES * every;
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
            step,
            jump,
            before: to_past.iter().map(|x| dot(past, *x)).collect(),
            after: to_ahead.iter().map(|x| dot(c, *x)).collect(),
            // The first sample goes through the most steps.
            to_past: tiles(to_past[block].iter().rev(), every + WIDER),
            to_ahead: tiles(to_ahead[block].iter(), every),
        })
    }

    /// Number of samples from one place to the next.
    pub fn every(&self) -> usize {
        self.every
    }

    /// For each of some signals of one length, and for each reading, its values at `count` places, the first at the
    /// sample `first`. As [`Sos::zero_phase`] would give them, up to rounding; a signal that is not finite gives values
    /// that are not.
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
        let block = LANES * self.every;
        let width = block.max(block - self.every + points);
        let span = width.next_multiple_of(LANES);
        let fours = match length.checked_sub(first + span) {
            Some(left) => (left / block + 1).min(count / LANES),
            None => 0,
        };
        let together = |r| (fours > 0).then(|| self.together(r, points, width));
        let places = Places {
            first,
            count,
            points,
            fours,
            width,
            taps: readings.iter().map(|r| self.taps(r, points)).collect(),
            together: readings.iter().filter_map(together).collect(),
        };
        let read = |signal: &&[f64]| {
            instructions.run(Pass {
                filter: self,
                signal,
                places: &places,
            })
        };
        Some(signals.iter().map(read).collect())
    }

    /// What a reading takes of the state before its place, of the state after its last point, and of the
    /// points.
    fn taps(&self, reading: &Reading, points: usize) -> Taps {
        let mut taps = Taps {
            past: [0.0; STATES],
            ahead: [0.0; STATES],
            inside: [0.0; POINTS],
        };
        let Model { a, c, .. } = self.forward;
        for (at, &weight) in reading.weights[..points].iter().enumerate() {
            let (mut past, mut ahead) = (self.past, c);
            for _ in 0..at {
                past = transposed(&a, past);
            }
            for _ in at + 1..points {
                ahead = transposed(&a, ahead);
            }
            taps.past = add(taps.past, past.map(|x| weight * x));
            taps.ahead = add(taps.ahead, ahead.map(|x| weight * x));
            for (t, inside) in taps.inside[..points].iter_mut().enumerate() {
                *inside += weight * self.response(t, at);
            }
        }
        taps
    }

    /// The same at four places, in a span of `width` samples from the first place on.
    fn together(&self, reading: &Reading, points: usize, width: usize) -> Together {
        let Taps { past, ahead, .. } = self.taps(reading, points);
        let places: [usize; LANES] = from_fn(|j| j * self.every);
        let mut pasts = [past; LANES];
        for j in 1..LANES {
            pasts[j] = transposed(&self.step, pasts[j - 1]);
        }
        // From the last point of the last place to the end of the span.
        let beyond = width - (places[LANES - 1] + points);
        let last = (0..beyond).fold(ahead, |row, _| transposed(&self.forward.a, row));
        let mut aheads = [last; LANES];
        for j in (1..LANES).rev() {
            aheads[j - 1] = transposed(&self.step, aheads[j]);
        }
        let weight = |t: usize, place: usize| -> f64 {
            let points = reading.weights[..points].iter().enumerate();
            let parts = points.map(|(i, w)| w * self.response(t, place + i));
            parts.sum()
        };
        let tile = |tile: usize| -> Tile {
            from_fn(|l| match LANES * tile + l {
                t if t < width => places.map(|place| weight(t, place)),
                _ => [0.0; LANES],
            })
        };
        Together {
            past: from_fn(|i| pasts.map(|row| row[i])),
            ahead: from_fn(|i| aheads.map(|row| row[i])),
            inside: (0..width.div_ceil(LANES)).map(tile).collect(),
        }
    }

    /// Weight of one sample in the output at another, where nothing is known of the states between them.
    fn response(&self, sample: usize, output: usize) -> f64 {
        match sample.cmp(&output) {
            Ordering::Less => self.before[output - sample - 1],
            Ordering::Equal => self.now,
            Ordering::Greater => self.after[sample - output - 1],
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

/// The states that samples lead to, four samples at a time, and samples that lead to none up to a number of tiles.
fn tiles<'a>(states: impl Iterator<Item = &'a State>, count: usize) -> Vec<Tile> {
    let states: Vec<State> = states.copied().collect();
    let mut tiles = states.as_chunks::<LANES>().0.to_vec();
    tiles.resize(count, Tile::default());
    tiles
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

/// What a reading is made of.
struct Taps {
    past: State,
    ahead: State,
    inside: [f64; POINTS],
}

/// What a reading at four places is made of: of each state and of four samples at a time, the weight in each.
struct Together {
    past: [Lanes; STATES],
    ahead: [Lanes; STATES],
    inside: Vec<Tile>,
}

/// Where signals are read: at `count` places from the sample `first` on, by readings that see so many points each.
struct Places {
    first: usize,
    count: usize,
    points: usize,
    /// How many times four places are read at once, of `width` samples each; the places left over are read alone.
    fours: usize,
    width: usize,
    taps: Vec<Taps>,
    together: Vec<Together>,
}

/// Both directions over a signal; the values of each reading.
struct Pass<'a> {
    filter: &'a Thinning,
    signal: &'a [f64],
    places: &'a Places,
}

/// `sum + w x`, the bits of which do not depend on the instruction set: each product is rounded once, in the sum.
#[inline(always)]
fn along(mut sum: Lanes, w: &Lanes, x: f64) -> Lanes {
    for l in 0..LANES {
        sum[l] = w[l].mul_add(x, sum[l]);
    }
    sum
}

/// `sum + M x`.
#[inline(always)]
fn onto(mut sum: Lanes, m: &[Lanes; STATES], x: State) -> Lanes {
    for j in 0..STATES {
        sum = along(sum, &m[j], x[j]);
    }
    sum
}

/// `w x`.
#[inline(always)]
fn times(w: &State, x: f64) -> State {
    along([0.0; STATES], w, x)
}

/// `sum + w . x`.
#[inline(always)]
fn weighed<const N: usize>(mut sum: f64, w: &[f64; N], x: &[f64; N]) -> f64 {
    for n in 0..N {
        sum = w[n].mul_add(x[n], sum);
    }
    sum
}

/// Weighted sums of samples, four for each of some weights: as many as stay in registers, each in two parts.
#[inline(always)]
fn sums<const N: usize>(weights: [&[Tile]; N], samples: &[f64]) -> [Lanes; N] {
    let mut parts = [[[0.0; LANES]; 2]; N];
    let tiles = weights[0].len();
    let samples = &samples.as_chunks::<LANES>().0[..tiles];
    let mut all = [weights[0]; N];
    for n in 1..N {
        all[n] = &weights[n][..tiles];
    }
    for i in 0..tiles {
        for l in 0..LANES {
            for n in 0..N {
                parts[n][l % 2] = along(parts[n][l % 2], &all[n][i][l], samples[i][l]);
            }
        }
    }
    let mut out = [[0.0; LANES]; N];
    for n in 0..N {
        for j in 0..LANES {
            out[n][j] = parts[n][0][j] + parts[n][1][j];
        }
    }
    out
}

/// The same for any number of weights.
#[inline(always)]
fn all_sums(weights: &[&[Tile]], samples: &[f64], out: &mut [Lanes]) {
    let (threes, rest) = weights.as_chunks::<3>();
    let (outs, out) = out.as_chunks_mut::<3>();
    for (three, out) in threes.iter().zip(outs) {
        *out = sums(*three, samples);
    }
    match (rest, out) {
        ([a, b], [x, y]) => [*x, *y] = sums([*a, *b], samples),
        ([a], [x]) => [*x] = sums([*a], samples),
        _ => {}
    }
}

impl Kernel for Pass<'_> {
    type Output = Vec<Vec<f64>>;

    #[inline(always)]
    fn run(self) -> Vec<Vec<f64>> {
        let Pass {
            filter,
            signal,
            places,
        } = self;
        let Places {
            first,
            count,
            points,
            fours,
            width,
            ..
        } = *places;
        let Model { a, b, c, d } = filter.forward;
        let end = signal.len() - 1;
        let step = |state: State, x: f64| onto(times(&b, x), &a, state);
        // Beyond each end the signal goes on turned about the end point, as in `zero_phase`.
        let before = |k: usize| 2.0 * signal[0] - signal[k];
        let beyond = |k: usize| 2.0 * signal[end] - signal[end - k];

        let mut state = times(&filter.settled, before(filter.padding));
        for k in (1..=filter.padding).rev() {
            state = step(state, before(k));
        }
        for x in &signal[..first] {
            state = step(state, *x);
        }
        let mut out = Vec::with_capacity(places.taps.len());
        for _ in &places.taps {
            out.push(Vec::with_capacity(count));
        }
        let mut added = Vec::with_capacity(fours);
        let stride = LANES * filter.every;
        let mut at = first;
        let mut weights = Vec::with_capacity(1 + places.together.len());
        weights.push(&filter.to_past[..width.div_ceil(LANES)]);
        for four in &places.together {
            weights.push(&four.inside[..]);
        }
        let mut found = vec![[0.0; LANES]; weights.len()];
        for _ in 0..fours {
            let samples = &signal[at..];
            all_sums(&weights, samples, &mut found);
            for (r, four) in places.together.iter().enumerate() {
                out[r].extend_from_slice(&onto(found[1 + r], &four.past, state));
            }
            let [ahead] = sums([&filter.to_ahead[..]], &samples[width - stride..]);
            added.push(ahead);
            state = onto(found[0], &filter.jump, state);
            at += stride;
        }
        // The places left over, sample by sample.
        let mut place = at;
        for n in at..=end {
            if n == place && out[0].len() < count {
                for (taps, out) in places.taps.iter().zip(&mut out) {
                    let mut value = weighed(0.0, &taps.past, &state);
                    for (x, w) in signal[n..n + points].iter().zip(&taps.inside) {
                        value = w.mul_add(*x, value);
                    }
                    out.push(value);
                }
                place += filter.every;
            }
            state = step(state, signal[n]);
        }
        let mut last = 0.0;
        for k in 1..=filter.padding {
            let x = beyond(k);
            last = d * x + dot(c, state);
            state = step(state, x);
        }

        // The backward pass begins as if the last value of the forward one had been there for ever.
        let held = onto([0.0; STATES], &filter.shared, state);
        let mut state = times(&filter.settled, last);
        for i in 0..STATES {
            state[i] -= held[i];
        }
        let back = |state: State, x: f64| onto(times(&filter.ahead, x), &a, state);
        for k in (1..=filter.padding).rev() {
            state = back(state, beyond(k));
        }
        let mut k = count;
        let mut place = first + count * filter.every;
        let least = match fours {
            0 => first,
            _ => at - stride + width,
        };
        for n in (least..=end).rev() {
            if k > LANES * fours && n + 1 + filter.every == place + points {
                k -= 1;
                place -= filter.every;
                for (taps, out) in places.taps.iter().zip(&mut out) {
                    out[k] = weighed(out[k], &taps.ahead, &state);
                }
            }
            state = back(state, signal[n]);
        }
        for (k, added) in added.iter().enumerate().rev() {
            for (four, out) in places.together.iter().zip(&mut out) {
                if let Some(four_read) = out[LANES * k..].first_chunk_mut::<LANES>() {
                    *four_read = onto(*four_read, &four.ahead, state);
                }
            }
            state = onto(*added, &filter.jump, state);
        }
        out
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
