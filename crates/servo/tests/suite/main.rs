//! The integration tests of `stiction-servo` in one program, which is linked once: a new file is a module here.

mod adaptation;
mod any_law;
mod c95;
mod closed_loop;
mod compensation;
mod drive;
mod forces;
mod integrators;
mod levelled;
mod load;
mod metrics;
mod mid;
mod motion;
mod mujoco;
mod noise;
mod passivity;
mod path;
mod pid;
mod plane;
mod unmodelled;
