//! Outcomes as people read them: [`report`] in HTML, [`text`] for a terminal.
//!
//! Every report explains the terms that it uses, from the table in [`glossary`].
//!
//! A page reads what a workflow found and calls neither a workflow nor an engine.

pub mod glossary;
mod names;
pub mod report;
pub mod text;
