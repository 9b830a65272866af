//! Files that belong to one outcome: they take the place of an earlier one together.

use super::replace::replace;
use super::taken::{MARKS, is_ours};
use crate::error::Error;
use std::borrow::Cow;
use std::fs;
use std::path::{Path, PathBuf};

/// Files to be written together.
#[derive(Clone, Debug, Default)]
pub struct Bundle {
    files: Vec<(Cow<'static, str>, Vec<u8>)>,
    absent: Vec<Cow<'static, str>>,
}

impl Bundle {
    /// Adds a file by its plain name, or its path with slashes from the folder.
    pub fn add(&mut self, name: impl Into<Cow<'static, str>>, content: impl Into<Vec<u8>>) {
        self.files.push((name.into(), content.into()));
    }

    /// Says that there is none of a file that others of this kind have: an older one does not belong to what is written.
    pub fn lacks(&mut self, name: impl Into<Cow<'static, str>>) {
        self.absent.push(name.into());
    }

    /// Files in `dir` that [`Bundle::write`] keeps under another name, with that: those that were changed since the outcome that is
    /// there was written, links, and those that belong to that alone.
    pub fn kept(&self, dir: impl AsRef<Path>) -> Vec<(PathBuf, PathBuf)> {
        let dir = dir.as_ref();
        let mark = self.files.iter().find(|(name, _)| is_mark(name));
        let Some((mark, _)) = mark.filter(|(name, _)| {
            let kind = name.trim_end_matches(".json").trim_end_matches(".toml");
            is_ours(&dir.join(&**name), kind)
        }) else {
            return Vec::new();
        };
        let changed = |path: &Path| path.metadata().and_then(|m| m.modified()).ok();
        // The mark is written last.
        let written = changed(&dir.join(&**mark));
        let edited = self.files.iter().filter(|(name, content)| {
            let path = dir.join(&**name);
            // A link would be replaced by a file, and what it leads to no longer follow.
            if path.is_symlink() {
                return true;
            }
            let later = name != mark && path.is_file() && changed(&path) > written;
            later && fs::read(&path).is_ok_and(|there| there != *content)
        });
        let edited = edited.map(|(name, _)| &**name);
        let stale = self.absent.iter().map(|name| &**name);
        let stale = stale.filter(|name| dir.join(name).is_file());
        let kept = edited
            .chain(stale)
            .map(|name| (dir.join(name), free(dir, name)));
        kept.collect()
    }

    /// Names and contents, in the order they were added.
    pub fn files(&self) -> &[(Cow<'static, str>, Vec<u8>)] {
        &self.files
    }

    /// Writes every file into `dir`, the one that marks the folder last. A full disk leaves what was there; where the work is
    /// ended by force, the folder holds what was there, or all of this once it is next looked at. What [`Bundle::kept`] names
    /// is kept under another name.
    ///
    /// # Errors
    /// When the folder cannot be made or a file cannot be written.
    pub fn write(&self, dir: impl AsRef<Path>) -> Result<Vec<PathBuf>, Error> {
        let dir = dir.as_ref();
        let mut order: Vec<_> = self.files.iter().collect();
        order.sort_by_key(|(name, _)| is_mark(name));
        let files = order.iter().map(|(name, content)| (&**name, &content[..]));
        replace(dir, files, || self.kept(dir))?;
        Ok(order.iter().map(|(name, _)| dir.join(&**name)).collect())
    }
}

/// Whether a file of this name marks a folder.
fn is_mark(name: &str) -> bool {
    MARKS.contains(&name)
}

/// The first of `study-1.toml`, `study-2.toml` and so on that nothing is called.
pub(super) fn free(dir: &Path, name: &str) -> PathBuf {
    let (stem, end) = name.rsplit_once('.').unwrap_or((name, ""));
    let names = (1_u64..).map(|k| dir.join(format!("{stem}-{k}.{end}")));
    let mut names = names.filter(|path| path.symlink_metadata().is_err());
    names.next().unwrap_or_else(|| dir.join(name))
}
