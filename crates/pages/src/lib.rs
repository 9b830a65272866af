//! Outcomes as people read them: [`report`] in HTML, [`text`] for a terminal.
//!
//! A page reads what a workflow found and calls neither a workflow nor an engine.

mod names;
pub mod report;
pub mod text;
