//! The integration tests of `stiction-export` in one program, which is linked once: a new file is a module here.

mod backlash;
mod c;
mod cogging_map;
mod common;
mod cpp;
mod drive_table;
mod fmu;
mod hal;
mod joint;
mod matiec;
mod matlab;
mod modelica;
mod mujoco;
mod robot;
mod ros2;
mod rust;
mod simulators;
mod st;
mod texts;
mod tf5200;
mod weight;
