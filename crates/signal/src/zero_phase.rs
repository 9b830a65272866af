//! Forward and backward filtering.

use crate::cascade::{Cascade, for_each_length};
use crate::sos::{Section, Sos};
use crate::{SignalError, check};
use stiction_dispatch::{InstructionSet, Kernel};

impl Sos {
    /// The signal filtered forward and backward: no delay at any frequency, and the gain squared.
    ///
    /// Equal to `scipy.signal.sosfiltfilt` with its defaults: beyond each end the signal is
    /// continued by [`padding`](Self::padding) samples rotated about the end point (odd extension),
    /// and each pass starts as if its first value had been there for ever. What lies beyond the
    /// ends is thus a guess, which [`settling_samples`](Self::settling_samples) bounds.
    ///
    /// ```
    /// use stiction_signal::Sos;
    ///
    /// let filter = Sos::butterworth_low_pass(2, 0.05, 1.0)?;
    /// let mut impulse = vec![0.0; 401];
    /// impulse[200] = 1.0;
    /// let smooth = filter.zero_phase(&impulse)?;
    /// // Symmetric about the impulse, and of the same area.
    /// assert!((1..100).all(|k| (smooth[200 - k] - smooth[200 + k]).abs() < 1e-15));
    /// assert!((smooth.iter().sum::<f64>() - 1.0).abs() < 1e-9);
    /// # Ok::<(), stiction_signal::SignalError>(())
    /// ```
    ///
    /// # Errors
    /// If the signal has no more than [`padding`](Self::padding) samples or one is not finite.
    pub fn zero_phase(&self, signal: &[f64]) -> Result<Vec<f64>, SignalError> {
        let mut copy = signal.to_vec();
        self.zero_phase_in_place(&mut copy)?;
        Ok(copy)
    }

    /// [`zero_phase`](Self::zero_phase) without a copy of the signal.
    ///
    /// # Errors
    /// As there; the signal is then left as it was.
    pub fn zero_phase_in_place(&self, signal: &mut [f64]) -> Result<(), SignalError> {
        self.zero_phase_columns(&mut [signal])
    }

    /// [`zero_phase_in_place`](Self::zero_phase_in_place) for several signals of one length. The
    /// result is the same to the last bit, at half the time or less: four columns run side by side.
    ///
    /// # Errors
    /// As there, and if the lengths differ; all signals are then left as they were.
    pub fn zero_phase_columns(&self, columns: &mut [&mut [f64]]) -> Result<(), SignalError> {
        let padding = self.padding();
        let expected = columns.first().map_or(0, |first| first.len());
        for column in columns.iter() {
            check::same_length("a column", column.len(), expected)?;
            check::length("zero-phase filtering", column, padding + 1)?;
            check::finite(column)?;
        }
        let settled = self.settled_state();
        for_each_length!(self.sections(), |sections| {
            let state = core::array::from_fn(|index| settled[index]);
            let pass = Pass {
                sections,
                state,
                padding,
            };
            let (fours, rest) = columns.as_chunks_mut::<4>();
            let (twos, rest) = rest.as_chunks_mut::<2>();
            fours.iter_mut().for_each(|four| pass.run(four));
            twos.iter_mut().for_each(|two| pass.run(two));
            rest.as_chunks_mut::<1>()
                .0
                .iter_mut()
                .for_each(|one| pass.run(one));
        });
        Ok(())
    }

    /// [`zero_phase_in_place`](Self::zero_phase_in_place) for `L` signals that stand side by side, a row for each sample: the
    /// same to the last bit. A signal with a sample that is not finite becomes one without any that is, the others stay right.
    ///
    /// # Errors
    /// If there are no more rows than [`padding`](Self::padding); they are then left as they were.
    pub fn zero_phase_rows<const L: usize>(
        &self,
        rows: &mut [[f64; L]],
    ) -> Result<(), SignalError> {
        let padding = self.padding();
        check::length("zero-phase filtering", rows, padding + 1)?;
        let settled = self.settled_state();
        for_each_length!(self.sections(), |sections| {
            let state = core::array::from_fn(|index| settled[index]);
            let pass = Pass {
                sections,
                state,
                padding,
            };
            InstructionSet::best().run(OverRows(pass, rows));
        });
        Ok(())
    }

    /// Samples by which [`zero_phase`](Self::zero_phase) continues the signal beyond each end:
    /// three times the number of coefficients of the whole filter, as in scipy.
    pub fn padding(&self) -> usize {
        let first_order = |is_zero: fn(&Section) -> bool| {
            self.sections()
                .iter()
                .filter(|section| is_zero(section))
                .count()
        };
        let single = first_order(|s| s.b[2] == 0.0).min(first_order(|s| s.a[1] == 0.0));
        3 * (2 * self.sections().len() + 1 - single)
    }
}

/// What both passes over any group of columns need.
struct Pass<const S: usize> {
    sections: [Section; S],
    state: [[f64; 2]; S],
    padding: usize,
}

struct OverRows<'a, const S: usize, const L: usize>(Pass<S>, &'a mut [[f64; L]]);

impl<const S: usize, const L: usize> Kernel for OverRows<'_, S, L> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.0.run(self.1);
    }
}

/// `L` signals of one length.
trait Signals<const L: usize> {
    fn length(&self) -> usize;
    fn at(&self, sample: usize) -> [f64; L];
    fn set(&mut self, sample: usize, values: [f64; L]);
}

impl<const L: usize> Signals<L> for [&mut [f64]; L] {
    #[inline(always)]
    fn length(&self) -> usize {
        self[0].len()
    }

    #[inline(always)]
    fn at(&self, sample: usize) -> [f64; L] {
        core::array::from_fn(|l| self[l][sample])
    }

    #[inline(always)]
    fn set(&mut self, sample: usize, values: [f64; L]) {
        for (column, value) in self.iter_mut().zip(values) {
            column[sample] = value;
        }
    }
}

impl<const L: usize> Signals<L> for [[f64; L]] {
    #[inline(always)]
    fn length(&self) -> usize {
        self.len()
    }

    #[inline(always)]
    fn at(&self, sample: usize) -> [f64; L] {
        self[sample]
    }

    #[inline(always)]
    fn set(&mut self, sample: usize, values: [f64; L]) {
        self[sample] = values;
    }
}

impl<const S: usize> Pass<S> {
    /// Forward and backward over signals longer than the padding.
    #[inline(always)]
    fn run<const L: usize>(&self, signals: &mut (impl Signals<L> + ?Sized)) {
        let length = signals.length();
        let rotated = |end: [f64; L], inside: [f64; L]| {
            let mut value = end;
            for l in 0..L {
                value[l] = 2.0 * end[l] - inside[l];
            }
            value
        };
        let mut cascade = Cascade::<S, L>::new(self.sections);

        // The continuation at the start only prepares the state: the backward pass ends before it.
        let first = signals.at(0);
        cascade.settle(&self.state, rotated(first, signals.at(self.padding)));
        for inside in (1..=self.padding).rev() {
            cascade.step(rotated(first, signals.at(inside)));
        }
        let end = signals.at(length - 1);
        let mut beyond: Vec<[f64; L]> = Vec::with_capacity(self.padding);
        for k in 1..=self.padding {
            beyond.push(rotated(end, signals.at(length - 1 - k)));
        }
        for n in 0..length {
            let output = cascade.step(signals.at(n));
            signals.set(n, output);
        }
        for value in &mut beyond {
            *value = cascade.step(*value);
        }

        cascade.settle(&self.state, beyond[self.padding - 1]);
        for value in beyond.iter().rev() {
            cascade.step(*value);
        }
        for n in (0..length).rev() {
            let output = cascade.step(signals.at(n));
            signals.set(n, output);
        }
    }
}
