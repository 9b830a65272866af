//! `stiction plan`: the motion to record.

use super::{Done, Found, Run, What, Words, Work};
use crate::named::read_axis;
use crate::refused::Refused;
use serde::Deserialize;
use stiction_files::{check_folder_of, check_inputs, plan};
use stiction_pages::bundle;
use stiction_pages::text;
use stiction_workflows::Verdict;
use stiction_workflows::plan::{Known, PlanOptions, Want, plan as plan_motion};

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    axis: String,
    /// s.
    time: Option<f64>,
    model: Option<String>,
    #[serde(default)]
    wants: Vec<String>,
    out: String,
}

impl Work for Plan {
    fn what(&self) -> What<'_> {
        What {
            kind: "plan",
            about: self.axis.clone(),
            out: Some(&self.out),
        }
    }

    fn words(&self, words: &mut Words) {
        words.word(&self.axis);
        let time = self.time.map(|time| format!("{time}s"));
        words.option("--time", time.as_deref());
        words.option("--model", self.model.as_deref());
        for want in &self.wants {
            words.option("--want", Some(want));
        }
    }

    fn run(&self, run: Run<'_>) -> Result<Done, Refused> {
        let dir = run.workspace.place(&self.out)?;
        check_folder_of(&dir, plan::SCHEMA, false)?;
        read_axis(run.workspace, &self.axis, &[])?;
        let file = run.workspace.file(&self.axis)?;
        let model = self.model.as_ref().map(|name| run.workspace.file(name));
        let model = model.transpose()?;
        check_inputs(&dir, model.iter().chain([&file]))?;
        let wants = self.wants.iter().map(|text| Want::parse(text));
        let options = PlanOptions {
            time: self.time,
            known: model.map(Known::Model),
            wants: wants.collect::<Result<_, _>>()?,
            ..PlanOptions::default()
        };
        let Some(planned) = plan_motion(&file, &options, run.observer)? else {
            return Ok(Done {
                verdict: Some(Verdict::Interrupted),
                text: "stopped before there was a motion; nothing is written".into(),
                ..Done::default()
            });
        };
        let found = Found {
            workspace: run.workspace,
            bundle: &bundle::plan(&planned),
            out: (&dir, &self.out),
            schema: plan::SCHEMA,
            verdict: planned.verdict(),
            stopped: (run.stopped)(),
        };
        Ok(Done {
            json: serde_json::to_value(&planned.file).ok(),
            ..found.done(|folder| text::planned(&planned, &file, folder))?
        })
    }
}
