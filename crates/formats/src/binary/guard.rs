//! The boundary around third-party decoders.

use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::{Error, Kind};

/// Runs a reader that calls a third-party decoder, and turns a panic in it into an error.
///
/// The decoders of HDF5, Parquet and ZIP are large, and a file is not to be trusted; one slice
/// index wrong in them must cost the user that file and not the program. Nothing of the unwound
/// reader is used afterwards, so no broken state can be seen. Our own readers need no such guard.
/// The message of the panic also goes where the program's panic hook sends it: that of `stiction` keeps it for a panic that
/// nothing catches.
pub(crate) fn guard<T>(format: &str, read: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    catch_unwind(AssertUnwindSafe(read)).unwrap_or_else(|panic| {
        let why = panic
            .downcast_ref::<&str>()
            .map(|text| (*text).to_owned())
            .or_else(|| panic.downcast_ref::<String>().cloned())
            .unwrap_or_default();
        Err(Error::new(
            Kind::Format,
            format!("the {format} decoder failed on this file ({why})"),
            "write the file again, or in another format",
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_an_error_that_says_why() {
        let error = guard("HDF5", || -> Result<(), Error> {
            panic!("index {} of 3", 4)
        });
        assert!(error.unwrap_err().to_string().contains("index 4 of 3"));
    }
}
