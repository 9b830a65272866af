//! Sums of products of two signals at every lag between them, by the fast Fourier transform.

/// A complex number.
type Complex = (f64, f64);

/// What is common to the transforms of signals that are compared.
///
/// ```
/// use stiction_signal::Lags;
///
/// let (a, b) = ([1.0, 2.0, 0.0], [0.0, 0.0, 1.0, 2.0]);
/// let lags = Lags::new(a.len(), b.len());
/// let sums = lags.sums(&lags.spectrum(&a), &lags.spectrum(&b));
/// // b is a, two samples later; the first lag is that at which the last sample of a meets the first of b.
/// assert_eq!(lags.first(), -2);
/// assert!((sums[4] - 5.0).abs() < 1e-12);
/// ```
#[derive(Clone, Debug)]
pub struct Lags {
    first_length: usize,
    second_length: usize,
    /// exp(-2 pi i k / size), the first half of the circle.
    roots: Vec<Complex>,
}

/// The transform of a signal.
#[derive(Clone, Debug)]
pub struct Spectrum(Vec<Complex>);

impl Spectrum {
    /// The square of each frequency, from none to half of one a sample.
    pub fn power(&self) -> Vec<f64> {
        let half = self.0.iter().take(self.0.len() / 2);
        half.map(|(re, im)| re * re + im * im).collect()
    }
}

impl Lags {
    /// For signals of these lengths, each at least 1.
    pub fn new(first: usize, second: usize) -> Self {
        let size = (first.max(1) + second.max(1) - 1)
            .next_power_of_two()
            .max(2);
        let root = |k: usize| {
            let (sin, cos) = libm::sincos(-2.0 * std::f64::consts::PI * k as f64 / size as f64);
            (cos, sin)
        };
        Self {
            first_length: first.max(1),
            second_length: second.max(1),
            roots: (0..size / 2).map(root).collect(),
        }
    }

    /// The lag of the first sum.
    pub fn first(&self) -> isize {
        1 - self.first_length as isize
    }

    /// The transform of either signal; what is beyond the longer length is left out.
    pub fn spectrum(&self, signal: &[f64]) -> Spectrum {
        let longest = self.first_length.max(self.second_length);
        let mut out: Vec<Complex> = signal.iter().take(longest).map(|x| (*x, 0.0)).collect();
        out.resize(2 * self.roots.len(), (0.0, 0.0));
        self.transform(&mut out);
        Spectrum(out)
    }

    /// `sum a[n] b[n + lag]` for every lag at which the two meet, from [`first`](Self::first) on.
    pub fn sums(&self, a: &Spectrum, b: &Spectrum) -> Vec<f64> {
        // The inverse transform is the transform of the conjugate; the result is real.
        let pairs = a.0.iter().zip(&b.0);
        let mut out: Vec<Complex> = pairs
            .map(|((ar, ai), (br, bi))| (ar * br + ai * bi, ai * br - ar * bi))
            .collect();
        self.transform(&mut out);
        let size = out.len();
        let all = self.first_length + self.second_length - 1;
        let at = |n: usize| (n + size + 1 - self.first_length) % size;
        (0..all).map(|n| out[at(n)].0 / size as f64).collect()
    }

    /// In place, radix 2 (Cooley, Tukey 1965).
    fn transform(&self, data: &mut [Complex]) {
        let size = data.len();
        let shift = usize::BITS - size.trailing_zeros();
        for n in 0..size {
            let mirrored = n.reverse_bits() >> shift;
            if n < mirrored {
                data.swap(n, mirrored);
            }
        }
        let mut half = 1;
        while half < size {
            let stride = size / (2 * half);
            for block in data.chunks_exact_mut(2 * half) {
                let (low, high) = block.split_at_mut(half);
                let roots = self.roots.iter().step_by(stride);
                for ((a, b), (cos, sin)) in low.iter_mut().zip(high).zip(roots) {
                    let turned = (b.0 * cos - b.1 * sin, b.0 * sin + b.1 * cos);
                    *b = (a.0 - turned.0, a.1 - turned.1);
                    *a = (a.0 + turned.0, a.1 + turned.1);
                }
            }
            half *= 2;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn sums_are_those_of_the_definition(
            a in prop::collection::vec(-10.0_f64..10.0, 1..40),
            b in prop::collection::vec(-10.0_f64..10.0, 1..90),
        ) {
            let lags = Lags::new(a.len(), b.len());
            let sums = lags.sums(&lags.spectrum(&a), &lags.spectrum(&b));
            prop_assert_eq!(sums.len(), a.len() + b.len() - 1);
            for (n, sum) in sums.iter().enumerate() {
                let lag = lags.first() + n as isize;
                let at = |i: usize| usize::try_from(i as isize + lag).ok().and_then(|j| b.get(j));
                let plain: f64 = a.iter().enumerate().filter_map(|(i, x)| Some(x * at(i)?)).sum();
                prop_assert!((sum - plain).abs() < 1e-9, "{} is {}, not {}", lag, sum, plain);
            }
        }
    }
}
