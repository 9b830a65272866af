//! The integration tests of `stiction-identify` in one program, which is linked once: a new file is a module here.

mod accelerometer;
mod break_away;
mod candidates;
mod commissioning;
mod common;
mod conditioning;
mod counts;
mod coverage;
mod dwells;
mod dynamic;
mod elasto_plastic;
mod exponent;
mod gms;
mod hostile;
mod identifiable;
mod lugre;
mod oracle;
mod output_error;
mod profile;
mod refusals;
mod static_map;
mod step;
mod stretches;
mod terms;
mod transmitted;
mod watched;
