//! Identification of the generalised Maxwell-slip law (Al-Bender, Lampaert and Swevers 2005, doi
//! 10.1109/TAC.2005.858676): a handful of elastic elements in parallel, each of which sticks until it
//! reaches its share of the Stribeck curve and then slips.
//!
//! ```text
//! u = sum_k W_k w_k(d_k, r, vs, a) sgn(v) + s2 v + M a + F0 + ...
//! ```
//!
//! With the elements counted in units of their yield force `W_k`, only the yield deflections `d_k`,
//! the Stribeck curve (`r = Fs/Fc`, `vs`) and the rate `a` at which slip follows it are nonlinear; the
//! yield forces are linear and not negative. Every column depends on its own `d_k` and on what all
//! share, so a trial costs one exponential a sample whatever the number of elements. And for a given
//! curve the elements need no starting values: a dictionary of yield deflections, solved as one
//! convex problem, says where they are.

mod choose;
mod count;
mod curves;
pub(crate) mod delay;
pub(crate) mod dictionary;
mod kink;
mod ladder;
mod limit;

pub use count::{FEWEST, MOST};
pub(crate) mod history;
pub(crate) mod physical;
pub(crate) mod recursion;
pub(crate) mod score;
pub(crate) mod search;
