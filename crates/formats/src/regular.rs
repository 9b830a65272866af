//! What may be opened: a regular file that is on a disk.

use std::fs::Metadata;
use std::io;
use std::path::Path;

/// Where kernels show themselves as files: reading one may wait for ever, or never end.
const OF_THE_KERNEL: [&str; 2] = ["/proc", "/sys"];

/// Why a path is not opened.
#[derive(Debug)]
pub enum Irregular {
    /// It cannot be looked at.
    Io(io::Error),
    /// It is something else, which is named.
    Other(&'static str),
}

impl std::fmt::Display for Irregular {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Irregular::Io(e) => write!(f, "cannot be read ({e})"),
            Irregular::Other(what) => write!(f, "{what}"),
        }
    }
}

/// Looks at a path before it is opened: to open a pipe waits for who writes into it, and a device has no end. What a link leads to
/// counts, such as the file that a shell gives as `/dev/stdin`.
///
/// # Errors
/// With what it is, where that is no regular file.
pub fn regular(path: &Path) -> Result<Metadata, Irregular> {
    let about = std::fs::metadata(path).map_err(Irregular::Io)?;
    if !about.is_file() {
        return Err(Irregular::Other(other(&about)));
    }
    match is_of_kernel(path) {
        true => Err(Irregular::Other("a file of the kernel, not one on a disk")),
        false => Ok(about),
    }
}

/// Whether a path leads to where the kernel shows itself as files.
pub fn is_of_kernel(path: &Path) -> bool {
    let real = path.canonicalize();
    real.is_ok_and(|real| OF_THE_KERNEL.iter().any(|dir| real.starts_with(dir)))
}

/// Whether a path is a regular file.
pub fn is_regular(path: &Path) -> bool {
    regular(path).is_ok()
}

#[cfg(unix)]
fn other(about: &Metadata) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    let kind = about.file_type();
    if kind.is_dir() {
        "a folder, not a file"
    } else if kind.is_fifo() {
        "a pipe, not a regular file"
    } else if kind.is_socket() {
        "a socket, not a regular file"
    } else if kind.is_char_device() || kind.is_block_device() {
        "a device, not a regular file"
    } else {
        "not a regular file"
    }
}

#[cfg(not(unix))]
fn other(about: &Metadata) -> &'static str {
    match about.is_dir() {
        true => "a folder, not a file",
        false => "not a regular file",
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_regular_file_is_named() {
        let dir = tempfile::tempdir().unwrap();
        let pipe = dir.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.unwrap().success());
        let file = dir.path().join("log.csv");
        std::fs::write(&file, "t,x\n").unwrap();
        assert!(is_regular(&file));
        for (path, said) in [
            (dir.path(), "a folder"),
            (&pipe, "a pipe"),
            (Path::new("/dev/zero"), "a device"),
            (Path::new("/dev/null"), "a device"),
            (Path::new("/proc/self/mem"), "a file of the kernel"),
            (Path::new("/proc/self/../kmsg"), "a file of the kernel"),
            (Path::new("/nowhere"), "cannot be read"),
        ] {
            let refused = regular(path).unwrap_err().to_string();
            assert!(refused.starts_with(said), "{refused}");
        }
    }
}
