//! The sentences that a user reads, one line each.
//!
//! Other crates decide on facts and state them as a kind with its numbers; only here these become words. A sentence says what
//! happened, what it means and what to do, in the nouns of the field.
//!
//! ```
//! use stiction_say::Reason;
//! let reason = Reason::FewReversals { reversals: 1 };
//! assert_eq!(reason.to_string(), "the log has 1 reversal, too few to determine the Coulomb level");
//! ```

mod effect;
mod found;
mod notice;
mod reason;
mod robot;
mod unplanned;

pub use effect::{Effect, Explained, Extent, Remedy, What};
pub use found::{
    AtRest, Dropout, ForceLine, Found, Jump, Mended, Mismatch, Moving, Sample, Size, Turn, Useless,
    Value, WrongWrap, Zeros, counter,
};
pub use notice::{
    Differs, Doubt, DrawnAxis, Naming, NoRun, Notice, OffPlan, Origin, Outside, Sought, Stated,
    Taken, Unsteady, Whole, Whose,
};
pub use reason::{On, Reason};
pub use robot::OfRobot;
pub use unplanned::Unplanned;
