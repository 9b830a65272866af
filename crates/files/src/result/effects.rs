//! What the residual of a law shows.

use serde::{Deserialize, Serialize};
use stiction_codes::Code;

/// A force, or a change of friction, that the law does not have.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EffectEntry {
    /// What it is, as the code of its warning.
    pub code: Code,
    /// Part of the squares of what the law leaves on strokes that were not fitted which is gone with it, percent.
    pub explains_percent: f64,
    /// Standard deviation of the first of `sizes`, percent; absent where it has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub std_percent: Option<f64>,
    /// 95 % interval of the first of `sizes` where strokes alone do not tell it: of the width of a gap.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ci95: Option<[f64; 2]>,
    /// How large it is.
    pub sizes: Vec<SizeEntry>,
}

/// A size of an effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SizeEntry {
    /// Such as `pitch` or `lost_motion`.
    pub name: String,
    /// In `unit`.
    pub value: f64,
    /// SI.
    pub unit: String,
}

impl EffectEntry {
    /// A size by its name.
    pub fn size(&self, name: &str) -> Option<f64> {
        let own = self.sizes.iter().find(|own| own.name == name);
        own.map(|own| own.value)
    }
}
