//! Tests of the rigid-body dynamics.

mod common;
mod dynamics;
mod hostile;
mod pinocchio;
mod urdf;
