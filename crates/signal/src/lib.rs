//! Zero-phase filters, derivatives and resampling for uniformly sampled signals, and the
//! correlation statistics of residuals.
//!
//! A motion log gives position and force; identification wants velocity and acceleration, free of
//! noise above the band of interest and *without delay*, because half a sample between force and
//! velocity already biases the bristle damping. Hence everything here is symmetric in time:
//! a [`Sos`] filter runs [forward and backward](Sos::zero_phase), [`SavitzkyGolay`] fits a
//! polynomial around each sample, [`gradient`] takes central differences.
//!
//! ```
//! use stiction_signal::{Sos, gradient};
//!
//! // Velocity from an encoder position logged at 4 kHz, nothing kept above 400 Hz.
//! let rate = 4000.0;
//! let position: Vec<f64> = (0..4000).map(|k| 0.25 * k as f64 / rate).collect();
//! let filter = Sos::butterworth_low_pass(2, 400.0, rate)?;
//! let velocity = gradient(&filter.zero_phase(&position)?, 1.0 / rate)?;
//! assert!((velocity[2000] - 0.25).abs() < 1e-9);
//! # Ok::<(), stiction_signal::SignalError>(())
//! ```
//!
//! Filters, derivatives and interpolation agree with `scipy.signal` and `numpy` to 1e-12 of the
//! largest value. The same input gives the same bits on every machine.

mod butterworth;
mod cascade;
mod check;
mod correlation;
mod decimate;
mod derivative;
mod error;
mod first_order;
mod fourier;
mod gaps;
mod noise;
mod orthogonal;
mod resample;
mod savitzky_golay;
mod settling;
mod sos;
mod thinning;
mod timing;
mod travel;
mod wavelet;
mod zero_phase;

pub use correlation::{EffectiveSize, autocorrelation, effective_sample_size};
pub use decimate::{anti_alias, decimate};
pub use derivative::{gradient, gradient_irregular, gradient_sixth_order, second_derivative};
pub use error::SignalError;
pub use first_order::{of_mean, undo_low_pass, undo_mean};
pub use fourier::{Lags, Spectrum};
pub use gaps::{Gaps, fill_gaps};
pub use noise::noise_deviation;
pub use resample::{interpolate, resample_uniform};
pub use savitzky_golay::SavitzkyGolay;
pub use sos::{Section, Sos};
pub use thinning::{Reading, Thinning};
pub use timing::{TimingNoise, timing_noise};
pub use travel::Travel;
pub use wavelet::{finest_scale, without_noise};
