//! The axis of a study with parameters that somebody moves: a short simulation for each change.

use super::{Answer, App, read};
use crate::given::Json;
use crate::named::read_study;
use crate::refused::Refused;
use axum::extract::State;
use serde::Deserialize;
use std::collections::BTreeMap;
use stiction_workflows::study::{Which, trial};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Moved {
    study: String,
    #[serde(default)]
    path: usize,
    #[serde(default)]
    controller: usize,
    /// `None` takes the last.
    compensator: Option<usize>,
    /// SI, of the parameters that are not those of the model.
    #[serde(default)]
    values: BTreeMap<String, f64>,
    /// The same of the second axis.
    #[serde(default)]
    second_values: BTreeMap<String, f64>,
}

/// Tries it.
pub async fn tried(State(shared): App, Json(asked): Json<Moved>) -> Answer {
    read(shared, move |shared| {
        let study = read_study(&shared.workspace, &asked.study)?;
        let which = Which {
            path: asked.path,
            controller: asked.controller,
            compensator: asked.compensator,
            values: asked.values.into_iter().collect(),
            second_values: asked.second_values.into_iter().collect(),
        };
        trial(study, &which).map_err(|e| Refused::bad(e.to_string()))
    })
    .await
}
