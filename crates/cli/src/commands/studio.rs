//! `stiction studio`: the page is served until the command is interrupted.

use crate::arguments::{self, Common};
use crate::exit::Exit;
use crate::interrupt;
use crate::output;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use stiction_files::Error as FileError;
use stiction_studio::Studio;
use stiction_workflows::Error;

/// Serves a folder. It becomes the working directory, so that results name their inputs as the command line does there.
pub fn run(typed: &arguments::Studio, common: &Common) -> Result<Exit, Error> {
    let folder = typed.folder.as_deref().unwrap_or(Path::new("."));
    let refused = |e: std::io::Error| FileError::output(folder, e.to_string());
    // Work of a page is stopped, and what it found kept, by its own button.
    interrupt::usual_end();
    std::env::set_current_dir(folder).map_err(refused)?;
    let studio = Studio::open(Path::new("."), typed.port.unwrap_or(0)).map_err(refused)?;
    let address = studio.address().map_err(refused)?;
    let told = match common.json {
        true => output::json(&serde_json::json!({ "address": address })),
        false => output::print(&format!(
            "{address}\nopen this address on this machine, where it works once; Ctrl-C ends the page\n"
        )),
    };
    if told.is_ok() && !typed.no_open && studio.forward().and_then(open).is_err() {
        // The address is there to be opened by hand.
        let _ = writeln!(std::io::stderr(), "stiction: no browser could be started");
    }
    studio.serve().map_err(refused)?;
    Ok(Exit::Done)
}

/// Opens a file in the browser of the desktop, where there is one. Other users see what it is started with.
fn open(file: PathBuf) -> std::io::Result<Child> {
    let program = match std::env::consts::OS {
        "macos" => "open",
        "windows" => "explorer",
        _ => "xdg-open",
    };
    Command::new(program)
        .arg(file)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
}
