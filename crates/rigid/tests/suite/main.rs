//! Tests of the rigid-body dynamics.

mod base;
mod common;
mod consistency;
mod dynamics;
mod hostile;
mod pinocchio;
mod rewrite;
mod robots;
mod urdf;
