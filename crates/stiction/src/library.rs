//! Machines that were identified from licensed public recordings.
//!
//! ```
//! use stiction::library::Library;
//! # let folder = tempfile::tempdir().unwrap();
//! # let folder = folder.path();
//!
//! let library = Library::new();
//! let servo = library.machine("xl330")?;
//! println!("{}: {} ({})", servo.title, servo.found.law, servo.licence);
//! servo.write(folder.join("xl330"), false)?; // model.toml, axis.toml, machine.json
//! let model = stiction::ModelFile::read(folder.join("xl330/model.toml"))?;
//! assert_eq!(model.law, servo.found.law);
//! # Ok::<(), stiction::Error>(())
//! ```

pub use stiction_workflows::library::{
    Found, FoundJoint, Library, Machine, MachineKind, Recording, SCHEMA,
};
