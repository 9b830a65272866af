//! Types shared by the search for elements and the choice of their number.

use crate::conditioning::record::Record;
use crate::law::Law;
use crate::law::terms::Terms;
use crate::separable::descent::Descent;
use crate::separable::search_box::SearchBox;
use crate::separable::settings::Settings;

/// A fit with some number of elements.
pub(super) struct Rung {
    pub law: Law,
    pub bounds: SearchBox,
    pub descent: Descent,
}

impl Rung {
    pub fn cost(&self) -> f64 {
        let cost = self.descent.evaluation.cost;
        if cost.is_nan() { f64::INFINITY } else { cost }
    }
}

/// One search for a law with any number of elements.
pub(super) struct Search<'a> {
    pub record: &'a Record,
    pub law: Law,
    pub terms: &'a Terms,
    pub settings: &'a Settings,
    pub iterations: usize,
}
