//! The integration tests of `stiction-studio` in one program, which is linked once: a new file is a module here.

mod client;
mod sessions;
mod slow;
mod trial;
mod uploads;
mod work;
