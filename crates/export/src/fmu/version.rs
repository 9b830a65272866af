//! The versions of the interface, and text in XML.

use super::Platform;

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

    /// Folder of the binary for a platform in `binaries`, where the standard names one.
    pub(super) fn folder(self, platform: Platform) -> Option<&'static str> {
        match self {
            Version::Two => platform.name_in_2(),
            Version::Three => Some(platform.name()),
        }
    }
}

pub(super) fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}
