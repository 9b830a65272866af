//! `niched-ga`: an annealing genetic algorithm that finds where to descend, and the descents.
//!
//! In the spirit of the annealing GA (Z25), made to reach the optimum with few evaluations:
//!
//! 1. A round draws a scrambled Sobol sequence on the *coarse* record and keeps the best.
//! 2. A few generations: each child lies on the line through two parents, the first chosen by rank, or
//!    a little beyond either end, with a step along the difference of two others. So scale and
//!    direction come from the population's own covariance.
//! 3. A child competes with the individual nearest to it (restricted tournament, Harik 1995) and
//!    survives with the annealed probability on the relative cost, Z25 eq. (21); so separate valleys
//!    stay populated.
//! 4. The best of the niches descend by least squares on the coarse record, side by side.
//! 5. Once the best minimum was reached from two niches it is trusted; else another round follows,
//!    from new points.
//! 6. The best minima descend on the full record.
//!
//! Without a coarse record all of it happens on the full one. What it is worth, and what was tried
//! instead: decision 0019.

mod settings;
mod state;

pub use settings::Settings;
pub use state::NichedGa;
