//! SHA-256 of inputs, so that a result identifies the files that it was made from.

use crate::error::Error;
use sha2::{Digest, Sha256};
use std::io::Read;
use std::path::Path;

/// SHA-256 of bytes that come one part after the other.
#[derive(Clone, Debug, Default)]
pub struct Hash(Sha256);

impl Hash {
    /// Takes the next part.
    pub fn take(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    /// Of all that was taken, hexadecimal.
    pub fn finish(self) -> String {
        hexadecimal(&self.0.finalize())
    }
}

/// SHA-256 of a file, hexadecimal.
///
/// # Errors
/// Where it cannot be read.
pub fn sha256(path: &Path) -> Result<String, Error> {
    let fail = |e: std::io::Error| {
        let kind = stiction_formats::Kind::Io;
        Error::Log(stiction_formats::Error::new(kind, e.to_string(), "").in_file(path))
    };
    let mut file = std::fs::File::open(path).map_err(fail)?;
    let mut hash = Hash::default();
    let mut buffer = vec![0; 1 << 16];
    loop {
        let n = file.read(&mut buffer).map_err(fail)?;
        if n == 0 {
            break;
        }
        hash.take(&buffer[..n]);
    }
    Ok(hash.finish())
}

/// SHA-256 of bytes, hexadecimal.
pub fn sha256_of(bytes: &[u8]) -> String {
    hexadecimal(&Sha256::digest(bytes))
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
