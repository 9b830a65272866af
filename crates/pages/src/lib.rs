//! Outcomes as people read them: [`report`] in HTML, [`text`] for a terminal, [`bundle`] as files of a folder.
//!
//! Every report explains the terms that it uses, from the table in [`glossary`].
//!
//! Begin with [`text::outcome`] and [`report::identification`]:
//!
//! ```
//! use stiction_pages::{report, text};
//! use stiction_workflows::identify::Outcome;
//!
//! fn show(outcome: &Outcome) -> String {
//!     println!("{}", text::outcome(outcome)); // tables for a terminal
//!     report::identification(outcome).to_html() // one file, without scripts
//! }
//! # let mut terms = stiction_pages::glossary::terms();
//! # assert!(terms.any(|term| term.name == "Stribeck velocity"));
//! ```
//!
//! A page reads what a workflow found and calls neither a workflow nor an engine.

mod apart;
pub mod bundle;
mod deviation;
mod drift;
pub mod glossary;
mod inputs;
mod more_logs;
mod names;
mod next;
pub mod report;
mod robot;
mod saved;
pub mod text;
mod trust;

pub use saved::SavedFit;
