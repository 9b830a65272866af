//! A private file that forwards a browser to the page. Every user of a machine sees the arguments of its processes, so a browser
//! is started with the path of this file and never with the address, which holds a token.

use std::io::{Error, Result, Write};
use std::path::Path;
use std::time::Duration;
use tempfile::{Builder, NamedTempFile, TempDir};

/// Longest wait for the browser; then the file goes, and the token in it is worth nothing.
pub const WAIT: Duration = Duration::from_secs(300);
/// Start of the names of folders with such a file.
pub const PREFIX: &str = ".stiction-open-";

/// The file, in a folder of its own; both are removed when this is dropped.
#[derive(Debug)]
pub struct Forward {
    file: NamedTempFile,
    _folder: TempDir,
}

impl Forward {
    /// Writes it below the first of these folders that keeps it from other users.
    pub fn to(address: &str, folders: &[&Path]) -> Result<Self> {
        let mut folders = folders.iter();
        let kept = folders.find_map(|folder| Self::below(folder, address).ok());
        kept.ok_or_else(|| Error::other("no folder keeps a file from other users"))
    }

    fn below(folder: &Path, address: &str) -> Result<Self> {
        let mut builder = Builder::new();
        builder.prefix(PREFIX);
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o700));
        let folder = builder.tempdir_in(folder)?;
        if !is_private(folder.path()) {
            return Err(Error::other("others can read it"));
        }
        let mut file = Builder::new().suffix(".html").tempfile_in(folder.path())?;
        write!(
            file,
            "<!doctype html>\n<meta charset=\"utf-8\">\n<meta name=\"referrer\" content=\"no-referrer\">\n\
             <meta http-equiv=\"refresh\" content=\"0; url={address}\">\n<title>stiction studio</title>\n\
             <p><a href=\"{address}\">Open stiction studio</a></p>\n"
        )?;
        Ok(Self {
            file,
            _folder: folder,
        })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        self.file.path()
    }
}

/// Whether only its owner can look into a folder; some file systems, such as that of a memory stick, know no owners.
#[cfg(unix)]
fn is_private(folder: &Path) -> bool {
    use std::os::unix::fs::PermissionsExt;
    let about = folder.metadata();
    about.is_ok_and(|about| about.permissions().mode() & 0o077 == 0)
}

/// Elsewhere every user has a folder for temporary files.
#[cfg(not(unix))]
fn is_private(folder: &Path) -> bool {
    folder.starts_with(std::env::temp_dir())
}
