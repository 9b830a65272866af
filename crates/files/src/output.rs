//! Files on disk: what is written is there whole or not at all, and never on top of something else.
//!
//! A file alone is complete under a temporary name before it is renamed ([`single`]). Files that belong together are all
//! complete before the first is renamed, and what is to be renamed is on record beside them while that goes on
//! ([`replace`]): where the program is ended in between, the next one that writes into the folder ends the work, and one that
//! reads a file there has what is to be its content ([`whole`]).

mod bundle;
mod folder;
mod journal;
mod pending;
mod replace;
mod runs;
mod single;
mod staged;
mod taken;

pub use bundle::Bundle;
pub use folder::write_folder;
pub use journal::Journal;
pub(crate) use pending::whole;
pub use runs::{Runs, Work, has_runs};
pub use single::{Kept, check_writable, write_atomic, write_keeping};
pub(crate) use staged::Staged;
pub use taken::{check_apart, check_folder, check_folder_of, check_inputs};

#[cfg(test)]
mod tests {
    use crate::Error;
    use std::io::ErrorKind;
    use std::path::Path;

    #[test]
    fn a_full_disk_is_told_from_other_faults() {
        let full = |kind: ErrorKind| Error::io(Path::new("out"), &kind.into()).is_full_disk();
        assert!(full(ErrorKind::StorageFull) && full(ErrorKind::QuotaExceeded));
        assert!(!full(ErrorKind::PermissionDenied) && !full(ErrorKind::Other));
    }
}
