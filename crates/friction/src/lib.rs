//! Friction laws as they run on the drive: `no_std`, no allocation, no unsafe code. This crate is the only definition
//! of the laws; simulation, identification and exported code are tested against it.
//!
//! SI throughout. Units are given for a linear axis, those of a rotary axis in brackets.
//!
//! | type | memory | use |
//! |---|---|---|
//! | [`LuGre`] | bristle deflection z | presliding, Stribeck, frictional lag, stick-slip |
//! | [`ElastoPlastic`] | z | the same without creep below break-away |
//! | [`Gms`] | one force per element | presliding with non-local memory, Stribeck, frictional lag |
//! | [`Dahl`] | z | presliding and Coulomb only |
//! | [`Stribeck`] | none | the steady curve, any [`Shape`], separate parameters for each direction |
//! | [`CoulombViscous`] | none | the simplest law |
//! | [`TanhRegularised`] | none | a steady curve for solvers that need it smooth |
//!
//! Parameters are checked once, at construction:
//!
//! ```
//! use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
//!
//! let both = Direction {
//!     coulomb: 20.0,            // N
//!     static_friction: 30.0,    // N
//!     stribeck_velocity: 5e-3,  // m/s
//!     viscous: 60.0,            // N s/m
//! };
//! let curve = Stribeck::symmetric(Shape::Gaussian, both, 0.0)?;
//! let law = LuGre::new(1.2e5, Damping::Capped(600.0), curve)?;
//!
//! let wrong = Stribeck::symmetric(Shape::Gaussian, Direction { coulomb: 40.0, ..both }, 0.0);
//! assert_eq!(wrong.unwrap_err().to_string(), "static = 30; allowed: finite and >= the Coulomb level");
//! # Ok::<(), stiction_friction::ParamError>(())
//! ```
//!
//! **In real time**, one call a sample; the force is finite whatever the sensor delivers:
//!
//! ```
//! # use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
//! # let both = Direction { coulomb: 20.0, static_friction: 30.0, stribeck_velocity: 5e-3, viscous: 60.0 };
//! # let law = LuGre::new(1.2e5, Damping::Capped(600.0), Stribeck::symmetric(Shape::Gaussian, both, 0.0)?)?;
//! let mut state = law.rest();
//! for _ in 0..4000 {
//!     law.step(&mut state, 250e-6, 0.1); // 1 s at 0.1 m/s
//! }
//! assert!((state.force - 26.0_f64).abs() < 1e-9); // Fc + sigma2 v
//! assert_eq!(law.step(&mut state, 250e-6, f64::NAN), state.force);
//! # Ok::<(), stiction_friction::ParamError>(())
//! ```
//!
//! **Along a record**, with the velocity known at both ends of each interval; second order, and bounded for every
//! stiffness and step:
//!
//! ```
//! # use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
//! # let both = Direction { coulomb: 20.0, static_friction: 30.0, stribeck_velocity: 5e-3, viscous: 60.0 };
//! # let law = LuGre::new(1.2e5, Damping::Constant(600.0), Stribeck::symmetric(Shape::Gaussian, both, 0.0)?)?;
//! let velocity = [0.0, 1e-3, 2e-3, 1e-3, -1e-3];
//! let mut z = 0.0_f64;
//! for ends in velocity.windows(2) {
//!     z = law.step_record(z, 1e-3, ends[0], ends[1]);
//!     assert!(z.abs() <= law.bound());
//! }
//! let force = law.force(z, -1e-3);
//! # assert!(force.is_finite());
//! # Ok::<(), stiction_friction::ParamError>(())
//! ```
//!
//! The laws with other memory step in the same way; [`Held`] is what a simulated axis needs of any of them:
//!
//! ```
//! # use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
//! # let both = Direction { coulomb: 20.0, static_friction: 30.0, stribeck_velocity: 5e-3, viscous: 60.0 };
//! # let curve = Stribeck::symmetric(Shape::Gaussian, both, 0.0)?;
//! # let lugre = LuGre::new(1.2e5, Damping::Constant(600.0), curve)?;
//! use stiction_friction::{ElastoPlastic, Element, Elements, Gms};
//!
//! let law = ElastoPlastic::new(lugre, 0.7)?; // elastic up to 0.7 Fs
//! assert_eq!(law.step_record(0.0, 1e-3, 0.05, 0.05), 0.05 * 1e-3); // 6 N: the deflection is the path
//!
//! let element = |stiffness, share| Element { stiffness, share }; // N/m, part of the friction level
//! let law = Gms::new([element(8e5, 0.4), element(2e5, 0.6)], 1e3, 600.0, curve)?;
//! let at = law.step_record(Elements::default(), 1e-3, 0.0, 0.02); // 10 um in all
//! assert_eq!(at.force, [8.0, 2.0]);
//! # Ok::<(), stiction_friction::ParamError>(())
//! ```
//!
//! The law as a feedforward force with limits and a watchdog: [`compensator`].
//!
//! Laws without memory:
//!
//! ```
//! use stiction_friction::{CoulombViscous, Dahl, Direction, Shape, Stribeck, TanhRegularised};
//!
//! let plain = CoulombViscous::symmetric(20.0, 60.0, -3.0)?;
//! assert_eq!(plain.force(0.1), 23.0);
//! assert_eq!(plain.force(0.0), -3.0);
//!
//! let side = Direction { coulomb: 20.0, static_friction: 30.0, stribeck_velocity: 5e-3, viscous: 60.0 };
//! let curve = Stribeck::symmetric(Shape::Lorentzian, side, 0.0)?;
//! assert_eq!(curve.force(-5e-3), -25.3); // half way between Fs and Fc, and the viscous part
//! assert_eq!(TanhRegularised::new(curve, 1e-4)?.force(0.0), 0.0);
//!
//! let dahl = Dahl::new(1e6, [20.0, 18.0], 0.0)?;
//! assert_eq!(dahl.law().bound(), 2e-5);
//! # Ok::<(), stiction_friction::ParamError>(())
//! ```
#![no_std]
#![forbid(unsafe_code)]

pub mod compensator;
mod dahl;
mod damping;
mod elasto_plastic;
mod error;
pub mod explicit;
mod exponential;
mod gms;
mod held;
mod lugre;
mod real;
mod realtime;
mod record;
mod shape;
pub mod source;
mod statics;
mod stribeck;
mod sweep;

pub use dahl::Dahl;
pub use damping::Damping;
pub use elasto_plastic::ElastoPlastic;
pub use error::ParamError;
pub use gms::{Element, Elements, Gms, GmsState, MOST_ELEMENTS, MaxwellSlip};
pub use held::{Held, Pace};
pub use lugre::LuGre;
pub use real::Real;
pub use realtime::State;
pub use shape::Shape;
pub use statics::{CoulombViscous, TanhRegularised};
pub use stribeck::{Direction, LevelGradient, Stribeck};
pub use sweep::{Sweep, Sweeps};
