//! Rigid-body dynamics of robots from a URDF.
//!
//! ```text
//! text --Document::parse--> Document --Robot::new--> Robot --torque, regressor--> numbers
//! ```
//!
//! ```
//! use stiction_rigid::{Document, Robot, Workspace};
//!
//! let urdf = r#"<robot name="pendulum"><link name="base"/>
//!   <link name="bob"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
//!     <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>
//!   <joint name="pivot" type="continuous"><parent link="base"/><child link="bob"/><axis xyz="0 1 0"/></joint></robot>"#;
//! let robot = Robot::new(&Document::parse(urdf)?)?;
//! let mut workspace = Workspace::new(&robot);
//! // Held horizontally: m g l.
//! let q = [std::f64::consts::FRAC_PI_2];
//! let mut torque = [0.0];
//! robot.torque([&q, &[0.0], &[0.0]], &robot.parameters(), &mut workspace, &mut torque);
//! assert!((torque[0] - 2.0 * 9.81 * 0.5).abs() < 1e-12);
//! # Ok::<(), stiction_rigid::Error>(())
//! ```
//!
//! Parameters of a body are those of Pinocchio, about the origin of the joint's frame: see [`inertia`]. Units are SI.

pub mod base;
pub mod consistency;
mod dynamics;
mod error;
pub mod inertia;
mod linear;
mod projection;
mod random;
mod regressor;
mod rewrite;
mod robot;
mod scalar;
mod space;
mod symmetric;
pub mod urdf;

pub use base::{Base, Parameter, Scope};
pub use dynamics::Workspace;
pub use error::Error;
pub use projection::{Projection, project};
pub use rewrite::{NewDynamics, NewInertial, rewrite};
pub use robot::{Body, Finding, Follows, GRAVITY, Joint, MOST_JOINTS, PlacedLink, Robot};
pub use space::Frame;
pub use urdf::Document;
