//! `ga`, `adaptive-ga` and `annealing-ga`: one genetic algorithm with three sets of settings.
//!
//! The annealing GA follows Zhang et al. 2025 (Z25, doi 10.1371/journal.pone.0322844), section 4, with
//! eqs. (16) to (22); its two modules that the text names without a step follow Liao et al. 2023 (L23,
//! doi 10.3390/s23042076). A generation is: crossover and mutation of the population in pairs, at
//! rates that adapt; the children are filtered by annealed survival, a rejected one leaving its
//! parent; the elite and a draw by rank are the next generation. Each round draws anew in a box that
//! has shrunk around the best.

mod crossover;
mod population;
mod rates;
mod selection;
mod settings;
mod state;
mod survival;

pub use crossover::{Crossover, Ratio};
pub use rates::Rates;
pub use selection::Selection;
pub use settings::Settings;
pub use state::Genetic;
pub use survival::Annealing;

pub(crate) use crossover::cross;
pub(crate) use population::{Individual, costs_of, fitness, least};
