//! docs/gallery.md against the recordings that it shows.

mod entries;
mod entry;

use entries::{ENTRIES, Entry};
use entry::{Folders, Inputs, make};
use std::path::{Path, PathBuf};
use stiction_testkit::{recordings, workspace};

/// The entries that take seconds.
const CHEAP: [&str; 2] = ["xl330-sines", "so101-rotation"];
/// Most bytes of a picture.
const MOST: usize = 60_000;

/// Compares the page and the pictures with what the commands give now.
fn compare(entries: &[&Entry], urdfs: Option<&Path>) {
    let Some(data) = recordings() else { return };
    let workspace = workspace();
    let inputs = Inputs {
        program: Path::new(env!("CARGO_BIN_EXE_stiction")),
        workspace: &workspace,
        data: &data,
        urdfs,
    };
    let page = std::fs::read_to_string(workspace.join("docs/gallery.md")).unwrap();
    let mut folders = Folders::default();
    for entry in entries {
        let made = make(entry, &inputs, folders.of(entry).unwrap()).unwrap();
        let (name, section) = (entry.name, &made.section);
        assert!(
            page.contains(section.as_str()),
            "docs/gallery.md does not say\n{section}\nafter an intended change: cargo xtask gallery"
        );
        let kept = workspace.join(format!("docs/gallery/{name}.svg"));
        assert_eq!(std::fs::read_to_string(kept).unwrap(), made.svg, "{name}");
    }
}

#[test]
fn the_page_says_what_the_commands_print() {
    let cheap: Vec<&Entry> = ENTRIES
        .iter()
        .filter(|entry| CHEAP.contains(&entry.name))
        .collect();
    assert_eq!(cheap.len(), CHEAP.len());
    compare(&cheap, None);
}

#[test]
#[ignore = "soak: every log of the gallery, whole robots among them"]
fn the_page_says_what_all_commands_print() {
    let urdfs = std::env::var_os("STICTION_URDFS").map(PathBuf::from);
    let has_urdfs = urdfs.is_some();
    let entries: Vec<&Entry> = ENTRIES
        .iter()
        .filter(|entry| has_urdfs || entry.urdf.is_none())
        .collect();
    compare(&entries, urdfs.as_deref());
}

#[test]
fn pictures_are_small_and_name_their_source() {
    let folder = workspace().join("docs/gallery");
    for entry in &ENTRIES {
        let picture = std::fs::read_to_string(folder.join(format!("{}.svg", entry.name))).unwrap();
        assert!(
            picture.len() < MOST,
            "{}: {} bytes",
            entry.name,
            picture.len()
        );
        assert!(picture.contains(entry.origin.source) && picture.contains(entry.origin.licence));
    }
    assert_eq!(std::fs::read_dir(folder).unwrap().count(), ENTRIES.len());
}
