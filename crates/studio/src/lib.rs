//! `stiction studio`: the chain from log to code on one local page, over the same engine, files and verdicts as the command
//! line.
//!
//! [`Studio::open`] takes a folder, the workspace; [`Studio::serve`] answers on loopback until its process ends. Everything that
//! is read or written lies in that folder, and everything is asked by the page alone: see `docs/decisions/0094-studio.md`.

mod api;
mod asked;
mod assets;
mod forward;
mod given;
mod guard;
mod held;
mod jobs;
mod listen;
mod logs;
mod named;
mod origin;
pub mod pyramid;
mod refused;
mod secret;
mod server;
mod tickets;
mod units;
mod workspace;

pub use server::Studio;
