//! What reads files of every format: only where all readers are built.

mod bytes;
mod common;
mod ethercat;
mod json;
mod lerobot;
mod mdf;
mod recordings;
mod rosbag;
mod roundtrip;
mod svb;
mod workbooks;
