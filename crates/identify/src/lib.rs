//! Identification of friction laws from conditioned records, with uncertainty.
