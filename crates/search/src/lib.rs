//! Searches for the minimum of a cost in a box, behind one interface: a search asks for points and is
//! told what they cost. It knows nothing of friction.
//!
//! ```text
//! Plan --start--> Search <--ask, tell--> Run <--points, costs--> Problem
//! (method,        (state machine,        (counts, best,          (box, cost,
//!  settings)       unit cube)             history, limits)        derivatives)
//! ```
//!
//! Start with a [`Problem`], a [`Plan`] and a [`Run`]:
//!
//! ```
//! use stiction_search::{Bounds, Fidelity, Limits, Plan, Points, Problem, Run, Silent};
//!
//! struct Sphere(Bounds);
//!
//! impl Problem for Sphere {
//!     fn bounds(&self) -> &Bounds {
//!         &self.0
//!     }
//!     fn costs(&self, points: &Points, _: Fidelity, costs: &mut [f64]) {
//!         for (x, cost) in points.rows().zip(costs) {
//!             *cost = x.iter().map(|x| x * x).sum();
//!         }
//!     }
//! }
//!
//! let problem = Sphere(Bounds::new(vec![-1.0; 3], vec![2.0; 3])?);
//! let plan = Plan::named("cma-es").expect("a method");
//! let mut run = Run::new(plan.start(3, 1)?, &problem);
//! run.advance(&problem, &Limits { target: Some(1e-12), ..Limits::default() }, &mut Silent)?;
//! assert!(run.best().expect("a finite cost").cost <= 1e-12);
//! assert!(run.counts().costs < 1000);
//! # Ok::<(), stiction_search::Error>(())
//! ```
//!
//! | method | what | source |
//! |---|---|---|
//! | `ga`, `adaptive-ga`, `annealing-ga` | [`genetic`] algorithms | Zhang et al. 2025 |
//! | `niched-ga` | [`niched`] annealing GA, then descents | decision 0019 |
//! | `de` | [`differential_evolution`], best/1/bin | Storn and Price 1997 |
//! | `cma-es` | [`cma_es`], restarted | Hansen 2016; Auger and Hansen 2005 |
//! | `pso` | [`particle_swarm`], constriction on a ring | Clerc and Kennedy 2002 |
//! | `annealing` | simulated [`annealing`], adaptive steps | Corana et al. 1987 |
//! | `nelder-mead` | [`nelder_mead`], adaptive, restarted | Gao and Han 2012 |
//! | `lm` | [`levenberg`]-Marquardt, many starts | More 1978; Nielsen 1999 |
//!
//! Any of them can be followed by a [`Finish`] of least squares, counted and reported apart.
//!
//! The same seed gives the same bits, on any machine and however the batches are split. A [`Run`] can
//! be written out between any two batches and goes on from there with the same bits. Nothing here
//! prints, sleeps or reads a clock; an [`Observer`] sees progress and may stop a run.

pub mod annealing;
pub mod bits;
mod bounds;
pub mod cma_es;
pub mod descent;
pub mod differential_evolution;
mod error;
mod finish;
pub mod genetic;
mod history;
pub mod levenberg;
mod linear;
mod lockstep;
mod method;
pub mod nelder_mead;
pub mod niched;
mod niches;
mod observe;
pub mod particle_swarm;
mod points;
mod problem;
mod random;
mod run;
mod search;
mod shared;
mod status;

pub use bounds::{Bounds, MOST_DIMENSIONS};
pub use error::Error;
pub use finish::{Finish, Finished};
pub use history::{Generation, History, Improvement};
pub use method::{Method, Plan, Searcher};
pub use observe::{Control, Counts, Limits, Observer, Progress, Silent, Stage};
pub use points::Points;
pub use problem::{CostsOnly, Derivatives, Fidelity, Kind, Problem};
pub use run::{Best, Run};
pub use search::{Answers, Phase, Request, Search};
pub use shared::{Relay, Shared};
pub use status::Status;
