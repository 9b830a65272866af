//! `stiction export`: a compensator for a controller.

use super::{Done, Run, What, Words, Work};
use crate::refused::Refused;
use serde::Deserialize;
use std::path::Path;
use stiction_pages::text;
use stiction_workflows::export::{ExportOptions, Feedforward, Target};

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Export {
    model: String,
    target: String,
    /// s.
    cycle_time: f64,
    gain: Option<f64>,
    limit: Option<f64>,
    rated_force: Option<f64>,
    #[serde(default)]
    adapt: bool,
    /// Of mass, gravity and cogging, what is fed forward beside friction.
    #[serde(default)]
    beside: Vec<String>,
    out: String,
    #[serde(default)]
    force: bool,
}

impl Export {
    /// The names of all that is fed forward.
    fn fed(&self) -> impl Iterator<Item = &str> {
        std::iter::once("friction").chain(self.beside.iter().map(String::as_str))
    }
}

impl Work for Export {
    fn what(&self) -> What<'_> {
        What {
            kind: "export",
            about: self.model.clone(),
            out: Some(&self.out),
        }
    }

    fn words(&self, words: &mut Words) {
        words.word(&self.model);
        words.option("--target", Some(&self.target));
        words.number("--cycle-time", Some(self.cycle_time));
        words.number("--gain", self.gain);
        words.number("--limit", self.limit);
        words.number("--rated-force", self.rated_force);
        words.flag("--adapt", self.adapt);
        if !self.beside.is_empty() {
            let parts: Vec<&str> = self.fed().collect();
            words.option("--feedforward", Some(&parts.join(",")));
        }
        words.flag("--force", self.force);
    }

    fn run(&self, run: Run<'_>) -> Result<Done, Refused> {
        let dir = run.workspace.place(&self.out)?;
        let mut targets = Target::ALL.into_iter();
        let target = targets
            .find(|own| own.name() == self.target)
            .ok_or_else(|| Refused::bad(format!("{}: no such target", self.target)))?;
        let mut options = ExportOptions::new(target, self.cycle_time);
        options.gain = self.gain;
        options.limit = self.limit;
        options.rated_force = self.rated_force;
        options.adapt = self.adapt;
        options.feedforward = Feedforward::from_names(self.fed())?;
        let exported =
            stiction_workflows::export::export_file(run.workspace.file(&self.model)?, &options)?;
        exported.write(&dir, self.force)?;
        Ok(Done {
            verdict: Some(exported.verdict()),
            text: text::exported(&exported, Path::new(&self.out)),
            folder: Some(self.out.clone()),
            written: exported.written.clone(),
            json: serde_json::to_value(&exported).ok(),
        })
    }
}
