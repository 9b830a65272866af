//! Machines that were identified from licensed public recordings.
//!
//! ```
//! use stiction::library;
//! # let folder = tempfile::tempdir().unwrap();
//! # let folder = folder.path();
//!
//! let servo = library::machine("xl330")?;
//! println!("{} ({})", servo.title(), servo.licence());
//! servo.write(folder.join("xl330"))?; // model.toml, axis.toml, machine.json
//! let model = stiction::Model::read(folder.join("xl330/model.toml"))?;
//! assert_eq!(Some(model), servo.model());
//! # Ok::<(), stiction::Error>(())
//! ```

use crate::{Error, Model};
use serde_json::Value;
use std::path::Path;
use stiction_workflows::library as workflow;

/// What a machine is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MachineKind {
    /// One axis with a measured force or torque.
    Axis,
    /// A servo, whose torque is made of what it reports.
    Servo,
    /// All joints of a robot.
    Robot,
}

/// A machine of the library.
#[derive(Clone, Debug)]
pub struct Machine(workflow::Machine);

/// The machines, in order of their names.
pub fn machines() -> impl ExactSizeIterator<Item = Machine> {
    let machines = workflow::Library::new().machines;
    machines.into_iter().map(Machine)
}

/// The machine of this name.
///
/// # Errors
/// Where there is none, with the names that there are.
pub fn machine(name: &str) -> Result<Machine, Error> {
    let library = workflow::Library::new();
    let machine = library.machine(name).map_err(Error::of)?;
    Ok(Machine(machine.clone()))
}

impl Machine {
    /// Name, such as `xl330`.
    pub fn name(&self) -> &str {
        &self.0.name
    }

    /// What it is, in a few words.
    pub fn title(&self) -> &str {
        &self.0.title
    }

    /// Axis, servo or robot.
    pub fn kind(&self) -> MachineKind {
        match self.0.kind {
            workflow::MachineKind::Axis => MachineKind::Axis,
            workflow::MachineKind::Servo => MachineKind::Servo,
            workflow::MachineKind::Robot => MachineKind::Robot,
        }
    }

    /// Where the recordings are published, as far as it is known.
    pub fn source(&self) -> &str {
        &self.0.source
    }

    /// Licence of the recordings, with its holder where the licence names one.
    pub fn licence(&self) -> &str {
        &self.0.licence
    }

    /// Error on samples that were not fitted, percent of the force; of a robot that of its worst joint.
    pub fn held_out_error_percent(&self) -> f64 {
        self.0.found.held_out_error_percent
    }

    /// Whether its model may be used for compensation, of a robot for feedforward.
    pub fn is_usable(&self) -> bool {
        self.0.found.usable
    }

    /// Its model; `None` of a robot, which has one for each joint in its folder.
    pub fn model(&self) -> Option<Model> {
        let files = self.0.files();
        let (_, text) = files.iter().find(|(path, _)| *path == "model.toml")?;
        Model::parse(text).ok()
    }

    /// Its row of the library, as `machine.json` has it (docs/library.md).
    pub fn result(&self) -> Value {
        serde_json::to_value(&self.0).expect("plain data")
    }

    /// Writes models, axis or robot file and `machine.json` into a folder that is new or empty.
    ///
    /// # Errors
    /// Where the folder holds something else, or cannot be written.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<(), Error> {
        self.0.write(folder, false).map(drop).map_err(Error::of)
    }
}
