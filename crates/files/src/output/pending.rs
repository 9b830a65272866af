//! What is being renamed in a folder, on record while that goes on.
//!
//! Renaming several files is no single step. Where the program is ended in between, some are of the new outcome and some of
//! the old one, and nothing about them tells. So they are renamed under a record: it is made and locked before anything is
//! written, filled once everything is complete, and removed when the last file has its name. Whoever is about to write into a
//! folder with a record that nobody holds ends what it says first; one that is not complete says that nothing was renamed.
//! Whoever reads a file there changes nothing: [`whole`] says which file has the content that is to be.
//!
//! A folder may come from elsewhere, and its record with it: no name in it leads out of the folder, also not through a link.

use super::staged;
use crate::error::Error;
use std::fs::{self, File};
use std::io::{ErrorKind, Read, Write};
use std::path::{Component, Path, PathBuf};

/// The record's name in the folder.
const NAME: &str = ".stiction-pending";

/// Its first and its last line.
const HEAD: &str = "stiction renames 1";
const END: &str = "end";

/// Largest record that is read, bytes.
const MOST_BYTES: u64 = 1 << 20;

/// A record that this program holds.
pub(super) struct Pending {
    path: PathBuf,
    file: File,
}

/// One file to be renamed, both names relative to the folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Rename {
    /// A file of the earlier outcome that is kept under a name that nothing had.
    Keep(String, String),
    /// A complete file under its temporary name gets its own.
    Publish(String, String),
}

impl Rename {
    /// Renames, unless that was done before.
    pub(super) fn run(&self, dir: &Path) -> std::io::Result<()> {
        let (from, to) = self.names();
        // What is published was written under its first name, and a link never is.
        let from_is_link = matches!(self, Rename::Publish(..)) && dir.join(from).is_symlink();
        let link = from_is_link.then(|| dir.join(from));
        if let Some(link) = link
            .or_else(|| linked(dir, from))
            .or_else(|| linked(dir, to))
        {
            let found = format!("{} is a link, which no record may follow", link.display());
            return Err(std::io::Error::other(found));
        }
        let (from, to) = (dir.join(from), dir.join(to));
        let there = |path: &Path| path.symlink_metadata().is_ok();
        let done = match self {
            // After it another file may have the old name.
            Rename::Keep(..) => there(&to) || !there(&from),
            Rename::Publish(..) => !there(&from),
        };
        if done {
            return Ok(());
        }
        if let Some(folder) = to.parent() {
            fs::create_dir_all(folder)?;
        }
        fs::rename(from, to)
    }

    fn names(&self) -> (&str, &str) {
        let (Rename::Keep(from, to) | Rename::Publish(from, to)) = self;
        (from, to)
    }

    fn line(&self) -> String {
        let verb = match self {
            Rename::Keep(..) => "keep",
            Rename::Publish(..) => "publish",
        };
        let (from, to) = self.names();
        format!("{verb}\t{from}\t{to}\n")
    }

    /// A line of a record; `None` where it is none, or leads out of the folder.
    fn read(line: &str) -> Option<Self> {
        let mut cells = line.split('\t');
        let (verb, from, to) = (cells.next()?, cells.next()?, cells.next()?);
        if cells.next().is_some() || !is_inside(from) || !is_inside(to) {
            return None;
        }
        let (from, to) = (from.to_string(), to.to_string());
        match verb {
            "keep" => Some(Rename::Keep(from, to)),
            "publish" if staged::is_temporary(&from) => Some(Rename::Publish(from, to)),
            _ => None,
        }
    }
}

/// Whether a relative path stays in its folder, and in a line of a record.
pub(super) fn is_inside(name: &str) -> bool {
    let plain = |c| matches!(c, Component::Normal(_));
    let path = Path::new(name);
    !name.is_empty() && !name.contains(char::is_control) && path.components().all(plain)
}

/// The first folder of a relative path that is a link.
pub(super) fn linked(dir: &Path, name: &str) -> Option<PathBuf> {
    let folders = Path::new(name).ancestors().skip(1);
    let folders = folders.filter(|folder| !folder.as_os_str().is_empty());
    folders
        .map(|folder| dir.join(folder))
        .find(|folder| folder.is_symlink())
}

impl Pending {
    /// Makes the record of a folder, and waits for and ends what another program has begun there.
    pub(super) fn begin(dir: &Path) -> Result<Self, Error> {
        let fail = |e: std::io::Error| Error::io(dir, &e);
        let path = dir.join(NAME);
        loop {
            let new = File::options().write(true).create_new(true).open(&path);
            match new {
                Ok(file) => {
                    // Some file systems have no locks; then two programs at once in one folder are not told apart.
                    let _ = file.lock();
                    if is_the_file(&file, &path) {
                        return Ok(Self { path, file });
                    }
                }
                Err(e) if e.kind() == ErrorKind::AlreadyExists => settle(dir)?,
                Err(e) => return Err(fail(e)),
            }
        }
    }

    /// Says what is going to be renamed: from here on that is done, by this program or by the next.
    pub(super) fn commit(&mut self, renames: &[Rename]) -> std::io::Result<()> {
        let lines: String = renames.iter().map(Rename::line).collect();
        self.file
            .write_all(format!("{HEAD}\n{lines}{END}\n").as_bytes())?;
        self.file.sync_all()
    }

    /// Removes the record: everything has its name, or nothing was renamed.
    pub(super) fn end(self) -> std::io::Result<()> {
        fs::remove_file(&self.path)
    }
}

/// Ends what a program began in a folder before it was ended by force; waits for one that is at work there.
pub(super) fn settle(dir: &Path) -> Result<(), Error> {
    let Some(left) = left(dir)? else {
        return Ok(());
    };
    for rename in &left.renames {
        rename.run(left.dir).map_err(|e| left.fault(&e))?;
    }
    // First the record: read again, it would keep the new file of a name in the place of an old one that was swept.
    fs::remove_file(&left.path).map_err(|e| left.fault(&e))?;
    staged::sweep(left.dir);
    Ok(())
}

/// The file that has the content of this one: itself, or the complete one that a program was about to give its name when it
/// was ended by force. Waits for a program that is at work there, and changes nothing.
pub(crate) fn whole(file: &Path) -> Result<PathBuf, Error> {
    let (Some(dir), Some(name)) = (
        file.parent(),
        file.file_name().and_then(|name| name.to_str()),
    ) else {
        return Ok(file.to_path_buf());
    };
    let left = left(dir)?;
    for rename in left.iter().flat_map(|left| &left.renames) {
        match rename {
            Rename::Publish(from, to) if to == name => {
                let from = dir.join(from);
                if from.is_file() && !from.is_symlink() {
                    return Ok(from);
                }
            }
            _ => {}
        }
    }
    Ok(file.to_path_buf())
}

/// What a program that was ended by force has left to do in a folder, which no other does as long as this is held.
struct Left<'d> {
    dir: &'d Path,
    path: PathBuf,
    _locked: File,
    renames: Vec<Rename>,
}

impl Left<'_> {
    fn fault(&self, e: &std::io::Error) -> Error {
        let why = crate::error::why(e);
        let found = format!(
            "was left half replaced, and that cannot be completed: {why}; to keep what is there, remove {NAME}"
        );
        Error::output(self.dir, found)
    }
}

/// The record of a folder that nobody holds; waits for a program that is at work there.
fn left(dir: &Path) -> Result<Option<Left<'_>>, Error> {
    let dir = match dir.as_os_str().is_empty() {
        true => Path::new("."),
        false => dir,
    };
    let path = dir.join(NAME);
    // Most folders have none. Opening a pipe of this name would wait for ever.
    match path.symlink_metadata() {
        Err(_) => return Ok(None),
        Ok(about) if !about.is_file() => {
            return Err(Error::output(&path, "is not a file; remove it"));
        }
        Ok(_) => {}
    }
    let file = match File::open(&path) {
        Ok(file) => file,
        Err(e) if e.kind() == ErrorKind::NotFound => return Ok(None),
        Err(e) => return Err(Error::io(&path, &e)),
    };
    let _ = file.lock();
    if !is_the_file(&file, &path) {
        // Its program has ended the work meanwhile.
        return Ok(None);
    }
    let mut text = String::new();
    // What is no text is no complete record.
    let _ = (&file).take(MOST_BYTES).read_to_string(&mut text);
    Ok(Some(Left {
        dir,
        path,
        _locked: file,
        renames: renames(&text),
    }))
}

/// What a record says; nothing where it is not complete.
fn renames(text: &str) -> Vec<Rename> {
    let body = text.strip_prefix(&format!("{HEAD}\n"));
    let body = body.and_then(|rest| rest.strip_suffix(&format!("{END}\n")));
    let all = body.and_then(|body| body.lines().map(Rename::read).collect());
    all.unwrap_or_default()
}

/// Whether a file that is open is the one of that name: it may have been removed, and made anew, since.
fn is_the_file(file: &File, path: &Path) -> bool {
    let (Ok(open), Ok(named)) = (file.metadata(), path.symlink_metadata()) else {
        return false;
    };
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        (open.dev(), open.ino()) == (named.dev(), named.ino())
    }
    #[cfg(not(unix))]
    {
        open.len() == named.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_comes_back_and_none_leads_out_of_its_folder() {
        let all = [
            Rename::Keep("model.toml".into(), "model-1.toml".into()),
            Rename::Publish(".stiction-part-aB3dE9".into(), "src/model.toml".into()),
        ];
        let lines: String = all.iter().map(Rename::line).collect();
        assert_eq!(renames(&format!("{HEAD}\n{lines}{END}\n")), all);
        for cut in 0..lines.len() {
            assert_eq!(renames(&format!("{HEAD}\n{}", &lines[..cut])), []);
        }
        for bad in [
            "publish\t../x\ty",
            "publish\t.stiction-part-aB3dE9\t../y",
            "publish\t.stiction-part-aB3dE9\t/etc/y",
            "publish\tmodel.toml\ty",
            "keep\tmodel.toml\t../y",
            "keep\tmodel.toml",
            "keep\ta\tb\tc",
        ] {
            assert_eq!(renames(&format!("{HEAD}\n{bad}\n{END}\n")), []);
        }
    }
}
