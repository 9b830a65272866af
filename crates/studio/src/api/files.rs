//! The text files of the folder, read and edited; what is written is what a text editor would write, once the engine has read it.

use super::{Answer, App, blocking};
use crate::asked::Words;
use crate::given::{Json, Query};
use crate::named::read_as;
use crate::refused::Refused;
use crate::workspace::{Workspace, kind_of_file};
use axum::extract::State;
use serde::{Deserialize, Serialize};
use std::path::Path;
use stiction_files::study::Study;
use stiction_files::{Axis, ModelFile};
use stiction_files::{study, visible, write_atomic};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Named {
    name: String,
}

/// A text as it was found.
#[derive(Serialize)]
pub struct Text {
    text: String,
}

/// Reads a text file.
pub async fn read(State(shared): App, Query(asked): Query<Named>) -> Answer {
    blocking(shared, move |shared| {
        let text = shared.workspace.text(&asked.name)?;
        Ok(Text { text })
    })
    .await
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Written {
    name: String,
    text: String,
    /// The text that was read before; empty for a new file.
    before: String,
}

/// Writes a TOML file: one that the engine can read, over what the page has seen.
pub async fn write(State(shared): App, Json(asked): Json<Written>) -> Answer {
    blocking(shared, move |shared| {
        shared.alone(|| written(&shared.workspace, &asked))
    })
    .await
}

fn written(workspace: &Workspace, asked: &Written) -> Result<(), Refused> {
    let Written {
        name,
        text: new,
        before,
    } = asked;
    if !name.ends_with(".toml") {
        return Err(Refused::forbidden(format!(
            "{name}: only TOML files are edited here"
        )));
    }
    let path = workspace.place(name)?;
    let now = match path.is_file() {
        true => workspace.text(name)?,
        false => String::new(),
    };
    if now != *before {
        return Err(Refused::conflict(format!(
            "{name} was changed by another program meanwhile; read it again"
        )));
    }
    workspace.holds_named(new, &path)?;
    readable(&path, new)?;
    write_atomic(&path, visible::toml(new.clone()).as_bytes())?;
    Ok(())
}

/// Refuses a text that the engine could not read, with its words.
fn readable(path: &Path, text: &str) -> Result<(), Refused> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    match kind_of_file(&name) {
        "model" => {
            ModelFile::parse(text)?;
        }
        "study" => {
            read_as(path, text, |beside| Study::read(beside))?;
        }
        "axis" => {
            Axis::parse(text)?;
        }
        _ => {}
    }
    Ok(())
}

/// A study to begin.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Begun {
    /// The model of the axis; `None` for a known axis.
    model: Option<String>,
    /// The model of a second one.
    second: Option<String>,
    /// The file to write.
    name: String,
}

impl Begun {
    /// The command line that does the same in the folder of the page.
    fn command(&self) -> String {
        let mut words = Words::of("simulate");
        words.option("--init", Some(&self.name));
        words.option("--model", self.model.as_deref());
        words.option("--second-model", self.second.as_deref());
        words.line()
    }
}

/// The command line of a study to begin.
pub async fn study_command(Json(asked): Json<Begun>) -> Json<String> {
    Json(asked.command())
}

/// Begins a study as `stiction simulate --init` does.
pub async fn study(State(shared): App, Json(asked): Json<Begun>) -> Answer {
    blocking(shared, move |shared| {
        let Begun {
            model,
            second,
            name,
        } = &asked;
        let path = shared.workspace.place(name)?;
        if path.symlink_metadata().is_ok() {
            return Err(Refused::conflict(format!("{name}: is there already")));
        }
        if kind_of_file(name) != "study" {
            return Err(Refused::bad(format!(
                "{name}: a study file ends in .toml and has study in its name, such as circle-study.toml"
            )));
        }
        let file = |model: &Option<String>| {
            let name = model.as_ref();
            name.map(|name| shared.workspace.file(name)).transpose()
        };
        let (model, second) = (file(model)?, file(second)?);
        let started = study::start(model.as_deref(), second.as_deref(), &path)?;
        write_atomic(&path, visible::toml(started.text).as_bytes())?;
        Ok(())
    })
    .await
}
