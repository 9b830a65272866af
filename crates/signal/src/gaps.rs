//! Missing samples.

use crate::SignalError;
use core::ops::Range;

/// What [`fill_gaps`] did.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Gaps {
    /// Samples that were filled.
    pub filled: usize,
    /// Gaps that were left, as ranges of samples: longer than allowed, or at an end.
    pub left: Vec<Range<usize>>,
}

/// Replaces runs of at most `longest` samples that are not finite by the straight line between
/// their neighbours. Longer runs and runs at an end are left and reported.
///
/// ```
/// let mut signal = [1.0, f64::NAN, 3.0, f64::NAN];
/// let gaps = stiction_signal::fill_gaps(&mut signal, 5)?;
/// assert_eq!(signal[1], 2.0);
/// assert_eq!((gaps.filled, gaps.left), (1, vec![3..4]));
/// # Ok::<(), stiction_signal::SignalError>(())
/// ```
///
/// # Errors
/// If `longest` is 0.
pub fn fill_gaps(signal: &mut [f64], longest: usize) -> Result<Gaps, SignalError> {
    if longest == 0 {
        return Err(SignalError::Parameter {
            parameter: "longest gap to fill",
            found: 0.0,
            allowed: "1 or more samples".into(),
        });
    }
    let mut gaps = Gaps {
        filled: 0,
        left: Vec::new(),
    };
    let mut next = 0;
    while let Some(start) = position_from(signal, next, |value| !value.is_finite()) {
        let end = position_from(signal, start, f64::is_finite).unwrap_or(signal.len());
        next = end;
        if start == 0 || end == signal.len() || end - start > longest {
            gaps.left.push(start..end);
            continue;
        }
        let (before, after) = (signal[start - 1], signal[end]);
        let steps = (end - start + 1) as f64;
        for (k, value) in signal[start..end].iter_mut().enumerate() {
            let part = (k + 1) as f64 / steps;
            // Weighted, not before + slope: a difference of two huge values could overflow.
            *value = before * (1.0 - part) + after * part;
        }
        gaps.filled += end - start;
    }
    Ok(gaps)
}

fn position_from(signal: &[f64], start: usize, wanted: impl Fn(f64) -> bool) -> Option<usize> {
    signal[start..]
        .iter()
        .position(|&value| wanted(value))
        .map(|offset| start + offset)
}
