//! Preconditions shared by all operations.

use crate::SignalError;

/// All samples finite.
pub(crate) fn finite(signal: &[f64]) -> Result<(), SignalError> {
    // Chunks are tested as a whole first: a search with an early exit at every sample is not
    // vectorised, and this runs before every filter pass.
    for (number, chunk) in signal.chunks(256).enumerate() {
        if chunk
            .iter()
            .fold(true, |good, value| good & value.is_finite())
        {
            continue;
        }
        if let Some(offset) = chunk.iter().position(|value| !value.is_finite()) {
            return Err(SignalError::NotFinite {
                index: 256 * number + offset,
                found: chunk[offset],
            });
        }
    }
    Ok(())
}

/// At least `needed` samples.
pub(crate) fn length(
    operation: &'static str,
    signal: &[impl Sized],
    needed: usize,
) -> Result<(), SignalError> {
    let found = signal.len();
    if found >= needed {
        return Ok(());
    }
    Err(SignalError::TooShort {
        operation,
        found,
        needed,
    })
}

/// Two signals of one length.
pub(crate) fn same_length(
    signal: &'static str,
    found: usize,
    expected: usize,
) -> Result<(), SignalError> {
    if found == expected {
        return Ok(());
    }
    Err(SignalError::LengthMismatch {
        signal,
        found,
        expected,
    })
}

/// Finite time stamps, each after the one before.
pub(crate) fn increasing(times: &[f64]) -> Result<(), SignalError> {
    finite(times)?;
    match times.windows(2).position(|pair| pair[1] <= pair[0]) {
        None => Ok(()),
        Some(before) => Err(SignalError::NotIncreasing {
            index: before + 1,
            previous: times[before],
            found: times[before + 1],
        }),
    }
}

/// A positive, finite number such as a step, s, or a rate, Hz.
pub(crate) fn positive(parameter: &'static str, found: f64) -> Result<(), SignalError> {
    if found > 0.0 && found.is_finite() {
        return Ok(());
    }
    Err(SignalError::Parameter {
        parameter,
        found,
        allowed: "positive and finite".into(),
    })
}
