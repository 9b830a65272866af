//! The integration tests of `stiction` in one program, which is linked once: a new file is a module here.

mod auto;
mod chain;
mod check;
mod common;
mod compare;
mod compare_logs;
mod contours;
mod export;
mod library;
mod measure;
mod model;
mod motions;
mod paper;
mod procedures;
mod promise;
mod recordings;
mod rests;
mod simulation;
mod study;
mod study_axis;
mod study_events;
mod study_examples;
mod study_sweep;
mod terms;
mod workflow;
