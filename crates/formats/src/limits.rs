//! How much memory a log may take: what the program allows, what a file asks for, and the refusal.

use std::cell::Cell;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::{Error, Kind};
use stiction_number::{bytes, bytes_option};

/// Bytes that a number of a log takes at most while the log is read and mapped: itself, and twice that for what a reader or the
/// findings hold beside it.
pub(crate) const PER_SAMPLE: u64 = 3 * size_of::<f64>() as u64;

/// What [`allow_memory`] said; 0 before that.
static ALLOWED: AtomicU64 = AtomicU64::new(0);

/// How much memory reading a log may take before it is refused with [`Kind::Limit`].
///
/// A compressed file can claim a thousand times its size; nothing is allocated for more than this.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Bytes that a log may take at its peak, beside some megabytes of buffers: three times its columns, of HDF5 also the file
    /// itself. By default what [`within_memory`] says, and [`allowed_memory`] outside of it.
    pub memory: u64,
}

impl Limits {
    /// Refuses `what` with samples that were read, where it would take more than is allowed: so many bytes. `instead` says what
    /// would take less.
    ///
    /// # Errors
    /// [`Kind::Limit`], without a file.
    pub fn check(self, what: &str, bytes: u64, instead: &str) -> Result<(), Error> {
        match bytes <= self.memory {
            true => Ok(()),
            false => Err(Budget::from(self).refused(what, Some(bytes), instead)),
        }
    }
}

impl Default for Limits {
    fn default() -> Self {
        let memory = OF_THREAD.get().unwrap_or_else(allowed_memory);
        Self { memory }
    }
}

thread_local! {
    /// What [`within_memory`] said to this thread.
    static OF_THREAD: Cell<Option<u64>> = const { Cell::new(None) };
}

/// Bytes that a log of this process may take: what [`allow_memory`] said, and a quarter of the memory of this machine, or of
/// its control group, where it said nothing.
pub fn allowed_memory() -> u64 {
    match ALLOWED.load(Ordering::Relaxed) {
        0 => memory_of_machine() / 4,
        allowed => allowed,
    }
}

/// Does something during which a log that this thread opens may take that many bytes (1 or more), for whoever reads several at the
/// same time and shares what is allowed among them.
pub fn within_memory<T>(bytes: u64, does: impl FnOnce() -> T) -> T {
    /// Puts back what was allowed before, also where a panic leaves.
    struct Before(Option<u64>);
    impl Drop for Before {
        fn drop(&mut self) {
            OF_THREAD.set(self.0);
        }
    }
    let _before = Before(OF_THREAD.replace(Some(bytes.max(1))));
    does()
}

/// Sets how many bytes (1 or more) a log may take from now on, for all readings of this process that name no limit of their
/// own.
pub fn allow_memory(bytes: u64) {
    ALLOWED.store(bytes.max(1), Ordering::Relaxed);
}

/// The memory of this machine in bytes, or what its control group may take; without end where neither is told.
fn memory_of_machine() -> u64 {
    let read = |file: &str| std::fs::read_to_string(file).unwrap_or_default();
    let about = read("/proc/meminfo");
    let total = about.lines().find_map(|line| {
        let kibibytes = line.strip_prefix("MemTotal:")?.trim().strip_suffix("kB")?;
        kibibytes.trim().parse::<u64>().ok()?.checked_mul(1024)
    });
    let group = read("/sys/fs/cgroup/memory.max").trim().parse().ok();
    total.unwrap_or(u64::MAX).min(group.unwrap_or(u64::MAX))
}

/// What is allowed for the samples of a file, beside what its decoder holds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Budget {
    memory: u64,
    held: u64,
}

impl From<Limits> for Budget {
    fn from(limits: Limits) -> Self {
        Self {
            memory: limits.memory,
            held: 0,
        }
    }
}

impl Budget {
    /// Beside a decoder that holds this many bytes for as long as it reads.
    ///
    /// # Errors
    /// Where these alone are too many.
    #[cfg(feature = "hdf5")]
    pub(crate) fn beside(limits: Limits, held: u64) -> Result<Self, Error> {
        let budget = Self {
            held,
            ..limits.into()
        };
        if held > limits.memory {
            return Err(budget.refusal("the file itself", Some(held)));
        }
        Ok(budget)
    }

    /// Most samples over all columns.
    pub(crate) fn samples(self) -> u64 {
        self.memory.saturating_sub(self.held) / PER_SAMPLE
    }

    /// Bytes that are allowed at all.
    #[cfg(any(feature = "mcap", feature = "parquet"))]
    pub(crate) fn memory(self) -> u64 {
        self.memory
    }

    /// Refuses what would take so many bytes, `None` where there are too many to count.
    pub(crate) fn refusal(self, what: &str, wanted: Option<u64>) -> Error {
        let instead = "export fewer columns, a shorter part or a lower rate";
        self.refused(what, wanted, instead)
    }

    /// The same with what to do `instead`.
    fn refused(self, what: &str, wanted: Option<u64>, instead: &str) -> Error {
        let found = match wanted {
            Some(wanted) => format!("{what} would take {} of memory", bytes(wanted)),
            None => format!("{what} would take more memory than can be counted"),
        };
        let machine = memory_of_machine();
        let raise = match wanted {
            Some(wanted) if wanted <= machine => {
                format!("--max-memory {} allows it", bytes_option(wanted))
            }
            Some(wanted) if machine < u64::MAX => format!(
                "--max-memory {} would allow it, and this machine has {}",
                bytes_option(wanted),
                bytes(machine)
            ),
            _ => "--max-memory allows more".to_owned(),
        };
        let allowed = format!(
            "at most {} is allowed; {raise}; or {instead}",
            bytes(self.memory)
        );
        Error::new(Kind::Limit, found, allowed)
    }

    /// Refuses so many samples, `None` where there are too many to count.
    pub(crate) fn too_many_samples(self, samples: Option<u64>) -> Error {
        let what = match samples {
            Some(samples) => format!("reading {samples} samples"),
            None => "reading this many samples".to_owned(),
        };
        let bytes = samples.and_then(|samples| samples.checked_mul(PER_SAMPLE));
        let wanted = bytes.and_then(|bytes| bytes.checked_add(self.held));
        self.refusal(&what, wanted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_shared_counts_for_the_thread_and_the_time_that_it_is_said_for() {
        let before = Limits::default();
        let inside = within_memory(1000, || {
            let elsewhere = std::thread::spawn(Limits::default).join().unwrap();
            assert_eq!(elsewhere, before);
            within_memory(10, || assert_eq!(Limits::default().memory, 10));
            Limits::default()
        });
        assert_eq!(inside.memory, 1000);
        let panics = std::panic::catch_unwind(|| within_memory(10, || panic!("inside")));
        assert!(panics.is_err());
        assert_eq!(Limits::default(), before);
    }

    #[test]
    fn a_log_may_take_a_quarter_of_the_memory_where_nothing_is_said() {
        assert_eq!(Limits::default().memory, memory_of_machine() / 4);
    }

    #[test]
    fn a_refusal_says_what_is_asked_what_is_allowed_and_how_to_raise_it() {
        let limits = Budget::from(Limits { memory: 2_400_000 });
        assert_eq!(limits.samples(), 100_000);
        let error = limits.too_many_samples(Some(1_000_000)).to_string();
        assert!(error.starts_with(
            "reading 1000000 samples would take 24 MB of memory; at most 2.4 MB is allowed; --max-memory 24MB allows it; or"
        ));
        let error = limits.too_many_samples(Some(u64::MAX)).to_string();
        assert!(
            error.contains("than can be counted; at most 2.4 MB"),
            "{error}"
        );
        let error = limits.too_many_samples(Some(1 << 50)).to_string();
        assert!(error.contains("and this machine has"), "{error}");
    }
}
