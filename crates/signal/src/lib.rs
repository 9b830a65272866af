//! Zero-phase filters, derivatives and resampling for uniformly sampled signals.
