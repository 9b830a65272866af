//! The versions of the interface, and text in XML.

/// A version of the standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Version {
    Two,
    Three,
}

impl Version {
    pub(super) fn number(self) -> &'static str {
        match self {
            Version::Two => "2",
            Version::Three => "3",
        }
    }

    /// Folder of the binary for x86-64 Linux.
    pub(super) fn binaries(self) -> &'static str {
        match self {
            Version::Two => "binaries/linux64",
            Version::Three => "binaries/x86_64-linux",
        }
    }
}

pub(super) fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}
