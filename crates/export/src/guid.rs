//! Identifiers made from contents, so that the same model gives the same file.

use sha2::{Digest, Sha256};

/// In braces; marked as one made from a hash (RFC 9562, version 8).
pub(crate) fn guid(content: &str) -> String {
    let mut bytes = Sha256::digest(content.as_bytes());
    bytes[6] = (bytes[6] & 0x0f) | 0x80;
    bytes[8] = (bytes[8] & 0x3f) | 0x80;
    let hex = |range: std::ops::Range<usize>| -> String {
        bytes[range].iter().map(|b| format!("{b:02x}")).collect()
    };
    format!(
        "{{{}-{}-{}-{}-{}}}",
        hex(0..4),
        hex(4..6),
        hex(6..8),
        hex(8..10),
        hex(10..16)
    )
}
