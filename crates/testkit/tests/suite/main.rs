//! Tests of the kit that tests the rest.

mod worlds;
