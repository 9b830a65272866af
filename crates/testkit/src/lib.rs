//! For tests only: where measured recordings are, what must hold on them, an interpreter and a compiler of Structured Text, other
//! programs of the set-up, LinuxCNC, the plain midpoint step, simulated logs of worlds that an identification does, or does not,
//! assume ([`worlds`]), joints behind gears ([`geared`]), whole robots ([`robots`]), and servers that stand for devices ([`devices`]).
//!
//! Start with [`recordings`] for a test on measured data, and with [`st::Library`] for one that runs Structured Text:
//!
//! ```
//! let mut library = stiction_testkit::st::Library::default();
//! library
//!     .add("FUNCTION_BLOCK Twice VAR_INPUT x : LREAL; END_VAR VAR_OUTPUT y : LREAL; END_VAR y := 2.0 * x; END_FUNCTION_BLOCK")
//!     .unwrap();
//! let mut block = library.instance("Twice");
//! let (x, y) = (block.slot("x"), block.slot("y"));
//! block.set(x, 1.5);
//! block.call();
//! assert_eq!(block.get(y), 3.0);
//! ```

mod cases;
pub mod devices;
pub mod geared;
#[cfg(unix)]
pub mod hal;
pub mod matiec;
mod mean_of_ends;
mod pages;
pub mod programs;
mod random;
pub mod robots;
pub mod st;
pub mod worlds;

pub use cases::{CASES, Case, DEFAULT_RUNS, DefaultRun, Limit, Metric};
pub use mean_of_ends::MeanOfEnds;
pub use pages::assert_tables_fit;

use std::path::{Path, PathBuf};

/// The folder of the workspace.
pub fn workspace() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.ancestors().nth(2).unwrap_or(here).to_path_buf()
}

/// The first cases of a table where the gate runs, and all of them in the soak, which sets `STICTION_SOAK`.
pub fn gate<T>(first: usize, all: impl IntoIterator<Item = T>) -> impl Iterator<Item = T> {
    let some = std::env::var_os("STICTION_SOAK").is_none();
    all.into_iter().take(if some { first } else { usize::MAX })
}

/// The folder of measured recordings: `STICTION_DATA`, else `../shared/data` beside the workspace.
///
/// Where there is none, a test has to say so and skip; with `CI=true` their absence is a
/// failure.
///
/// # Panics
/// With `CI=true` and no recordings.
pub fn recordings() -> Option<PathBuf> {
    let dir = match std::env::var_os("STICTION_DATA") {
        Some(dir) => PathBuf::from(dir),
        None => workspace().join("../shared/data"),
    };
    if dir.is_dir() {
        return Some(dir);
    }
    // A test runs in a thread of its own name.
    let thread = std::thread::current();
    let test = thread.name().unwrap_or("test");
    let message = format!(
        "SKIPPED {test}: no recordings in {} (set STICTION_DATA to the folder that holds them)",
        dir.display()
    );
    assert!(std::env::var("CI").as_deref() != Ok("true"), "{message}");
    eprintln!("{message}");
    None
}
