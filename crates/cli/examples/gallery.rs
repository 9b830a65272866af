//! Writes `docs/gallery.md` and its pictures from the recordings. Run by `cargo xtask gallery`.

#[path = "../tests/suite/gallery/entries.rs"]
mod entries;
#[path = "../tests/suite/gallery/entry.rs"]
mod entry;
mod shared;

use entries::ENTRIES;
use entry::{Folders, Inputs, make};
use std::fs;
use std::path::PathBuf;
use stiction_testkit::{recordings, workspace};

fn main() -> Result<(), String> {
    let program = std::env::args_os().nth(1).map(PathBuf::from);
    let program = program.ok_or("no program is given; run cargo xtask gallery")?;
    let program = program.canonicalize().map_err(|e| e.to_string())?;
    let data = recordings().ok_or("without recordings there is nothing to show")?;
    let (workspace, urdfs) = (workspace(), shared::urdfs());
    let inputs = Inputs {
        program: &program,
        workspace: &workspace,
        data: &data,
        urdfs: urdfs.as_deref(),
    };
    let mut page = format!(
        "# Gallery\n\n\
         Written by `cargo xtask gallery` on {} with stiction {}; do not edit.\n\n\
         Ten public recordings that may be passed on, each with its command, some of the lines that it prints, and its \
         code. Pictures are figures of the reports, half-widths of intervals those for the same test on another day. Four \
         verdicts are *no*. The recordings are not in the tree.\n",
        shared::today()?,
        env!("CARGO_PKG_VERSION")
    );
    let mut folders = Folders::default();
    for entry in &ENTRIES {
        println!("{}: {}", entry.name, entry.command);
        let made = make(entry, &inputs, folders.of(entry)?)?;
        page.push('\n');
        page.push_str(&made.section);
        let picture = workspace.join(format!("docs/gallery/{}.svg", entry.name));
        fs::write(&picture, made.svg).map_err(|e| format!("{}: {e}", picture.display()))?;
    }
    fs::write(workspace.join("docs/gallery.md"), page).map_err(|e| e.to_string())
}
