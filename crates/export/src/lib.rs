//! The compensator of `stiction-friction` as code for a target: C, Structured Text and other forms.
//!
//! Start with a [`Model`] and [`export`], or a [`Robot`] and [`export_robot`]; [`advice`] tells what to know before the code runs.
//!
//! [`export`] returns relative paths with their bytes and writes no file. The compensator in
//! [`stiction_friction::compensator`] is the definition; every target comes with test vectors computed with it, and a
//! self-test that runs them. The same model gives the same bytes.
//!
//! ```
//! use stiction_export::{Model, Provenance, Target, export};
//! use stiction_friction::compensator::{Friction, Settings};
//! use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
//!
//! let both = Direction { coulomb: 12.0, static_friction: 18.0, stribeck_velocity: 3e-3, viscous: 30.0 };
//! let law = LuGre::new(2e6, Damping::Capped(1.5e3), Stribeck::symmetric(Shape::Gaussian, both, 0.0)?)?;
//! let model = Model {
//!     title: "X axis".into(),
//!     identifier: "x_axis".into(),
//!     rotary: false,
//!     force_unit: "N".into(),
//!     friction: Friction::LuGre(law),
//!     terms: Default::default(),
//!     load_unit: String::new(),
//!     backlash: None,
//!     settings: Settings::new(1e-3, 40.0), // 1 kHz, at most 40 N
//!     rated_force: None,
//!     top_speed: None,
//!     parameters: vec![],
//!     domain: Default::default(),
//!     draws: None,
//!     notes: vec![],
//!     provenance: Provenance::default(),
//! };
//! let files = export(&model, Target::C)?;
//! assert_eq!(files[0].path, "x_axis_friction.h");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod backlash;
mod bam;
mod c;
mod check;
mod cogging_map;
mod cpp;
mod domain;
mod drive_table;
mod error;
mod fmu;
mod guid;
mod hal;
mod header;
mod identifier;
mod joint;
mod largest;
mod law;
mod map;
mod matlab;
mod model;
mod modelica;
mod mujoco;
mod newton;
mod number;
mod range;
mod robot;
mod ros2;
mod rust;
mod st;
mod target;
mod template;
mod terms;
mod tf5200;
mod vectors;

pub use check::{Advice, advice};
pub use domain::{Domain, Draws, Number, Scale, Width};
pub use error::Error;
pub use fmu::{Platform, fmu};
pub use identifier::{IDENTIFIER_LENGTH, check_identifier, identifier, is_whole};
pub use joint::{nearest_line, static_friction};
pub use model::{Backlash, Model, Parameter, Provenance};
pub use robot::{Load, Robot, RobotJoint, export_robot, joint_identifiers};
pub use target::{File, Target, UnknownTarget, export};
pub use tf5200::largest_force as largest_force_in_table;
