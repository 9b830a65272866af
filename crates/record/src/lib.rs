//! Records motion logs live, read-only: Beckhoff ADS and RTDE of Universal Robots.
//!
//! ```no_run
//! use stiction_record::{Device, Options, record};
//!
//! let mut source = Device::parse(&["rtde://192.168.0.5"])?.source(Some(500.0))?;
//! let options = Options { time: 30.0, ..Options::default() };
//! let recorded = record(&mut *source, "log.csv".as_ref(), &options, &mut |_| true)?;
//! println!("{} samples, {} lost", recorded.rows, recorded.lost);
//! # Ok::<(), stiction_record::Error>(())
//! ```

// Reads only. Requests are made in `ads::request` and `rtde::request` and nowhere else. The types there have no variant for
// an ADS Write, WriteControl or a ReadWrite other than the look-up of a symbol, nor for RTDE inputs; scripts go to another
// port, which is not opened. The servers of the tests refuse every other command and fail the test.

mod ads;
mod device;
mod error;
mod link;
mod log_file;
mod pace;
mod rtde;
mod run;
mod source;
mod table;

pub use device::Device;
pub use error::{Error, Fault};
pub use run::{End, Options, Recorded, record};
pub use source::{Column, Sample, Source};
