//! The law of parameters that an experiment found.

use stiction_friction::LuGre;
use stiction_identify::candidates::Named;
use stiction_parameters::{LawError, LawKind, ParameterSet};

/// The law of identified parameters, sigma1 constant as in the paper.
pub(super) fn law(parameters: &Named) -> Result<LuGre<f64>, LawError> {
    ParameterSet::of(LawKind::LuGre, parameters.iter().copied()).lugre()
}
