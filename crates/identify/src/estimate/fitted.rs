//! The result that every fit of a law gives, whether it fitted the force, the position or points of the
//! steady curve.

use crate::agreement::Disagreement;
use crate::conditioning::record::extent;
use crate::effects::Found;
use crate::estimate::series::Series;
use crate::estimate::sliding::is_presliding;
use crate::fit::Fit;
use crate::gms::score::ElementsScore;
use crate::law::Law;
use crate::law::terms::Terms;
use crate::parameter::Parameter;
use crate::parameter::covariance::Covariance;
use stiction_parameters::{Name, ParameterSet, Quantity};
use stiction_search::{Counts, Status};

/// A fitted law: its parameters with their uncertainty, how well it fits, and how the search went.
#[derive(Clone, Debug)]
pub struct FittedLaw {
    /// The law.
    pub law: Law,
    /// The linear terms beside it.
    pub terms: Terms,
    /// Its parameters, in the order of tables.
    pub parameters: Vec<Parameter>,
    /// Covariance of the identified parameters.
    pub covariance: Covariance,
    /// Fit over all kept samples.
    pub fit: Fit,
    /// Fit over the kept samples slower than `low_speed_bound`.
    pub low_speed: Option<Fit>,
    /// That bound, m/s or rad/s.
    pub low_speed_bound: f64,
    /// What its residual shows, the largest first; known once intervals are.
    pub effects: Vec<Found>,
    /// Parameters that logs have differently; known once intervals are.
    pub disagreements: Vec<Disagreement>,
    /// The Stribeck exponent that the counts of an axis that rests are likelier with, where that of the law is doubted.
    pub likelier_exponent: Option<f64>,
    /// Its parameters are those that the counts of the encoder make most likely, not those of the fit of the force.
    pub of_the_counts: bool,
    /// Signals at the kept samples.
    pub series: Series,
    /// How the search ended.
    pub status: Status,
    /// Evaluations by kind.
    pub counts: Counts,
    /// Steps of all descents.
    pub iterations: usize,
    /// Evaluations and relative residual over the last descent.
    pub history: Vec<(usize, f64)>,
    /// The numbers of elements that were tried for a Maxwell-slip law; empty where it was given.
    pub elements: Vec<ElementsScore>,
}

impl FittedLaw {
    /// The parameter of this name, typed or as files have it (`"sigma0"`, `"coulomb_pos"`).
    pub fn parameter<N>(&self, name: N) -> Option<&Parameter>
    where
        Name: PartialEq<N>,
    {
        self.parameters.iter().find(|p| p.name == name)
    }

    /// The value of this name, typed or as files have it.
    pub fn value<N>(&self, name: N) -> Option<f64>
    where
        Name: PartialEq<N>,
    {
        self.parameter(name).map(|p| p.value)
    }

    /// Whether the stroke is shorter than the travel that turns the bristles from one side to the other (`2 Fc/sigma0`), so
    /// that the axis hardly slides. False for a law without a bristle and a fit without positions.
    pub fn stays_in_presliding(&self) -> bool {
        let (low, high) = extent(&self.series.position);
        low <= high && is_presliding(high - low, &self.parameters)
    }

    /// All values, those that were given too.
    pub fn values(&self) -> ParameterSet {
        let own = self.parameters.iter().map(|p| (p.name, p.value));
        let mut set = ParameterSet::of(self.law.kind, own);
        if set.get(Quantity::StribeckExponent).is_none() {
            set.insert(Quantity::StribeckExponent, self.law.exponent);
        }
        set
    }
}
