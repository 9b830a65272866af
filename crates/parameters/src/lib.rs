//! The parameters of friction laws: one list of their names, symbols, units and ranges, and the one place that makes a law
//! of names and values.
//!
//! | type | what |
//! |---|---|
//! | [`Name`] | a parameter as code knows it: a [`Quantity`] and a [`Side`]; text only where files are read and written |
//! | [`Dimension`], [`Units`] | what a parameter measures, and its unit on a linear or rotary axis |
//! | [`Allowed`] | the values that a parameter may have |
//! | [`LawKind`] | the families of laws, and which parameters each has |
//! | [`ParameterSet`] | names with values; [`law`](ParameterSet::law) makes the law of `stiction-friction` |
//! | [`FrictionLaw`] | that law, whichever it is |
//! | [`SteadyCurve`] | friction at constant velocity of a set of parameters, with its derivatives |
//!
//! ```
//! use stiction_parameters::{FrictionLaw, LawKind, Name, ParameterSet, Units};
//!
//! let mut set = ParameterSet::new(LawKind::LuGre);
//! for (name, value) in [
//!     ("sigma0", 1.2e5),           // N/m
//!     ("sigma1", 600.0),           // N s/m
//!     ("sigma2", 60.0),            // N s/m
//!     ("coulomb_pos", 20.0),       // N, positive direction
//!     ("coulomb_neg", 22.0),
//!     ("static", 30.0),            // N, the same in both directions
//!     ("stribeck_velocity", 5e-3), // m/s
//! ] {
//!     set.insert(name.parse::<Name>()?, value);
//! }
//! let FrictionLaw::LuGre(law) = set.law()? else { unreachable!() };
//! assert_eq!(law.curve().negative().coulomb, 22.0);
//!
//! let name: Name = "sigma1".parse()?;
//! assert_eq!(name.symbol(), "σ₁");
//! assert_eq!(Units::linear("N").of(name.dimension()), "N*s/m");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod allowed;
mod dimension;
mod error;
mod kind;
mod law;
mod name;
mod quantity;
mod set;
mod steady;
mod units;

pub use allowed::Allowed;
pub use dimension::Dimension;
pub use error::{LawError, UnknownLaw, UnknownName};
pub use kind::LawKind;
pub use law::FrictionLaw;
pub use name::{Name, Side};
pub use quantity::{Quantity, Wave};
pub use set::ParameterSet;
pub use steady::SteadyCurve;
pub use units::Units;
