//! Rebuilds the library of machines from the recordings: models, index and list of files. Run by `cargo xtask library`.

#[path = "../tests/suite/library/rebuild.rs"]
mod rebuild;
mod shared;

use rebuild::{Inputs, Rebuilt, rebuild};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use stiction_testkit::{recordings, workspace};
use stiction_workflows::library::Library;

fn main() -> Result<(), String> {
    let program = std::env::args_os().nth(1).map(PathBuf::from);
    let program = program.ok_or("no program is given; run cargo xtask library")?;
    let program = program.canonicalize().map_err(said)?;
    let data = recordings().ok_or("without recordings there is nothing to identify")?;
    let folder = workspace().join("crates/workflows/library");
    let urdfs = shared::urdfs();
    let inputs = Inputs {
        program: &program,
        library: &folder,
        data: &data,
        urdfs: urdfs.as_deref(),
    };
    let index = folder.join("index.json");
    let text = fs::read_to_string(&index).map_err(said)?;
    let mut library: Library = serde_json::from_str(&text).map_err(|e| e.to_string())?;
    library.machines.sort_by(|a, b| a.name.cmp(&b.name));
    let mut rows = String::new();
    for machine in &mut library.machines {
        println!("{}: {}", machine.name, machine.command);
        let Rebuilt {
            mut found,
            sums,
            files,
        } = rebuild(machine, &inputs)?;
        let own = folder.join(&machine.name);
        let mut is_new = false;
        for (path, text) in &files {
            let _ = writeln!(
                rows,
                "    (\"{0}/{path}\", include_str!(\"{0}/{path}\")),",
                machine.name
            );
            is_new |= write(&own.join(path), text)?;
        }
        found.identified.clone_from(&machine.found.identified);
        is_new |= found != machine.found;
        if is_new {
            found.identified = shared::today()?;
        }
        machine.found = found;
        for (recording, sum) in machine.recordings.iter_mut().zip(sums) {
            recording.sha256 = sum;
        }
    }
    let text = serde_json::to_string_pretty(&library).map_err(|e| e.to_string())?;
    write(&index, &format!("{text}\n"))?;
    let list = format!(
        "//! Files of the library. Written by `cargo xtask library`; do not edit.\n\n\
         /// Paths from the folder of the library, and contents.\n\
         #[rustfmt::skip]\n\
         pub const FILES: &[(&str, &str)] = &[\n{rows}];\n"
    );
    write(&folder.join("files.rs"), &list)?;
    Ok(())
}

/// Writes a file unless it has this text; whether it was written.
fn write(file: &Path, text: &str) -> Result<bool, String> {
    if fs::read_to_string(file).is_ok_and(|there| there == text) {
        return Ok(false);
    }
    if let Some(folder) = file.parent() {
        fs::create_dir_all(folder).map_err(said)?;
    }
    fs::write(file, text).map_err(said)?;
    Ok(true)
}

fn said(e: std::io::Error) -> String {
    e.to_string()
}
