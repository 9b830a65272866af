//! Why a model is refused.

/// The key, what was found, what is allowed.
pub(super) type Fault = (String, String, String);
