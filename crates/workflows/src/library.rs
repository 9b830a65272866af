//! Machines identified from licensed public recordings: their models, where they come from, and what they are worth.

#[path = "../library/files.rs"]
mod files;

use crate::Error;
use serde::{Deserialize, Serialize};
use std::path::Path;
use stiction_files::write_folder;

/// Schema of the index.
pub const SCHEMA: &str = "stiction.library/1";

/// The index of the library.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Library {
    /// [`SCHEMA`].
    pub schema: String,
    /// The machines, by name.
    pub machines: Vec<Machine>,
}

/// A machine: by hand down to the command, and what the command found.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Machine {
    /// Name, a folder of the library.
    pub name: String,
    /// What it is, in a few words.
    pub title: String,
    /// Axis, servo or robot.
    pub kind: MachineKind,
    /// Where the recordings are published, as far as it is known.
    pub source: String,
    /// Licence of the recordings, with its holder where the licence names one.
    pub licence: String,
    /// The recordings, which are no part of the library.
    pub recordings: Vec<Recording>,
    /// URDF of a robot, a path in the robots of the PyPI package `example-robot-data`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub urdf: Option<String>,
    /// The command that identified it, in a folder with the recordings, the URDF, and the axis file from here.
    pub command: String,
    /// What was found.
    #[serde(default)]
    pub found: Found,
}

/// What a machine is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum MachineKind {
    /// One axis with a measured force or torque.
    Axis,
    /// A servo, whose torque is made of what it reports.
    Servo,
    /// All joints of a robot.
    Robot,
}

impl MachineKind {
    /// As the index writes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Axis => "axis",
            Self::Servo => "servo",
            Self::Robot => "robot",
        }
    }
}

/// A recording that a machine was identified from.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Recording {
    /// Path among the project's recordings.
    pub file: String,
    /// SHA-256 of its bytes.
    #[serde(default)]
    pub sha256: String,
}

/// What an identification found, in short.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct Found {
    /// Day on which these numbers were found first, UTC, such as `2026-11-30`.
    pub identified: String,
    /// Version of stiction.
    pub version: String,
    /// The law; of a robot those of its joints.
    pub law: String,
    /// Held-out error, % of the force; of a robot that of its worst joint, % of the torque.
    pub held_out_error_percent: f64,
    /// Whether the model may be used for compensation, of a robot for feedforward.
    pub usable: bool,
    /// Why not.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub reasons: Vec<String>,
    /// The joints of a robot.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub joints: Vec<FoundJoint>,
}

/// What was found of a joint.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct FoundJoint {
    /// Name in the URDF.
    pub name: String,
    /// The law.
    pub law: String,
    /// Held-out error, % of the torque.
    pub held_out_error_percent: f64,
    /// Whether its friction law may compensate by itself.
    pub usable: bool,
    /// Why not.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub reasons: Vec<String>,
}

impl Library {
    /// The library that comes with this version.
    pub fn new() -> Self {
        serde_json::from_str(include_str!("../library/index.json")).expect("a test reads it")
    }

    /// The names of its machines, in order.
    pub fn names() -> Vec<&'static str> {
        let folders = files::FILES.iter();
        let folders = folders.filter_map(|(path, _)| Some(path.split_once('/')?.0));
        let mut names: Vec<&str> = folders.collect();
        names.dedup();
        names
    }

    /// The machine of this name.
    ///
    /// # Errors
    /// Where there is none, with the names that there are.
    pub fn machine(&self, name: &str) -> Result<&Machine, Error> {
        let found = self.machines.iter().find(|own| own.name == name);
        found.ok_or_else(|| {
            let found = format!("the library has no machine {name}");
            Error::usage(found, format!("it has {}", Self::names().join(", ")))
        })
    }
}

impl Default for Library {
    fn default() -> Self {
        Self::new()
    }
}

impl Machine {
    /// The file that is exported.
    pub fn model(&self) -> &'static str {
        match self.kind {
            MachineKind::Robot => "robot.toml",
            MachineKind::Axis | MachineKind::Servo => "model.toml",
        }
    }

    /// Files of the machine, by their paths from its folder: models, the axis or robot file, and `machine.json`, its row of the index.
    pub fn files(&self) -> Vec<(&'static str, String)> {
        let folder = format!("{}/", self.name);
        let own = files::FILES.iter();
        let own = own.filter_map(|(path, text)| Some((path.strip_prefix(&folder)?, *text)));
        let mut all: Vec<_> = own.map(|(path, text)| (path, text.into())).collect();
        let row = serde_json::to_string_pretty(self).expect("plain data");
        all.push(("machine.json", format!("{row}\n")));
        all
    }

    /// Writes [`files`](Self::files) into a folder; their paths.
    ///
    /// # Errors
    /// When the folder holds something else, unless `force`, or cannot be written.
    pub fn write(&self, dir: impl AsRef<Path>, force: bool) -> Result<Vec<&'static str>, Error> {
        let files = self.files();
        let bytes = files.iter().map(|(path, text)| (*path, text.as_bytes()));
        write_folder(dir, bytes, force)?;
        Ok(files.into_iter().map(|(path, _)| path).collect())
    }
}
