//! `axis.toml`: what is known of the machine and its log. Raw as typed, then resolved to SI.

mod raw;
mod resolve;
mod syntax;
mod template;

pub use resolve::{Axis, ResolvedAxis};
pub use template::template;
