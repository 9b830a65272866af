//! Options of an identification under the names that the command line has for them.

use crate::error::Refusal;
use pyo3::prelude::*;
use std::path::PathBuf;
use stiction_parameters::LawKind;
use stiction_workflows::export::{Feedforward, Target, Width};
use stiction_workflows::identify::{CostKind, Method, Options, Procedures, Searching};
use stiction_workflows::plan::Carrier;

/// The law that stands for a choice by the data.
const AUTO: &str = "auto";

/// A dict with every option.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Asked {
    law: String,
    asymmetric: bool,
    compare_laws: bool,
    split: Option<f64>,
    seed: u64,
    method: String,
    statics: Vec<PathBuf>,
    model: Option<PathBuf>,
    break_away: Vec<PathBuf>,
    plan: Option<PathBuf>,
    search: Option<String>,
    no_finish: bool,
    cost: Option<String>,
    evaluations: Option<u64>,
    target: Option<f64>,
    time: Option<f64>,
    checkpoint: Option<PathBuf>,
    resume: Option<PathBuf>,
}

impl Asked {
    /// As the library takes them.
    ///
    /// # Errors
    /// Where a name is none that there is.
    pub fn options(self) -> Result<Options, Refusal> {
        let mut options = Options::default();
        options.law = match self.law.as_str() {
            AUTO => None,
            name => Some(LawKind::from_name(name).ok_or_else(|| unknown("law", name))?),
        };
        options.asymmetric = self.asymmetric;
        options.compare_laws = self.compare_laws;
        options.split = self.split;
        options.seed = self.seed;
        let method = Method::from_name(&self.method);
        options.procedures = Procedures {
            method: method.ok_or_else(|| unknown("method", &self.method))?,
            statics: self.statics,
            model: self.model,
            break_away: self.break_away,
            plan: self.plan,
        };
        let search = self.search.map(|name| {
            let mut names = Method::SEARCHES.into_iter();
            names
                .find(|own| *own == name)
                .ok_or_else(|| unknown("search", &name))
        });
        let cost = self.cost.map(|name| {
            let mut kinds = COSTS.into_iter();
            kinds
                .find(|kind| kind.name() == name)
                .ok_or_else(|| unknown("cost", &name))
        });
        options.searching = Searching {
            search: search.transpose()?,
            no_finish: self.no_finish,
            cost: cost.transpose()?,
            evaluations: self.evaluations,
            target: self.target,
            time: self.time,
            checkpoint: self.checkpoint,
            resume: self.resume,
        };
        Ok(options)
    }
}

/// Stages of a plan.
const STAGES: [&str; 2] = ["probe", "whole"];

const COSTS: [CostKind; 2] = [CostKind::Six, CostKind::Separable];

/// A name that is none of those that an argument takes.
pub fn unknown(argument: &str, name: &str) -> Refusal {
    let names = choices(argument).join(", ");
    Refusal::argument(argument, format!("{name:?}"), format!("one of {names}"))
}

/// The names that an argument takes.
#[pyfunction]
pub fn choices(argument: &str) -> Vec<&'static str> {
    match argument {
        "law" => {
            let laws = LawKind::ALL.into_iter().map(LawKind::name);
            std::iter::once(AUTO).chain(laws).collect()
        }
        "method" => {
            let own = Method::ALL.into_iter().map(Method::name);
            own.chain(Method::SEARCHES).collect()
        }
        "search" => Method::SEARCHES.to_vec(),
        "cost" => COSTS.into_iter().map(CostKind::name).collect(),
        "target" => Target::ALL.into_iter().map(Target::name).collect(),
        "formats" => Carrier::ALL.map(Carrier::name).to_vec(),
        "feedforward" => Feedforward::all().names(),
        "width" => Width::ALL.map(Width::name).to_vec(),
        "planned_law" => stiction_workflows::plan::PLANNED
            .map(LawKind::name)
            .to_vec(),
        "stage" => STAGES.to_vec(),
        _ => Vec::new(),
    }
}
