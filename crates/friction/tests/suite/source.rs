//! The text of the crate that is shipped with exported code: all of it, and as it is.

use std::collections::BTreeSet;
use std::path::Path;
use stiction_friction::source;

fn walk(dir: &Path, root: &Path, found: &mut BTreeSet<String>) {
    for entry in std::fs::read_dir(dir).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            walk(&path, root, found);
        } else {
            let path = path.strip_prefix(root).unwrap();
            let parts: Vec<_> = path.iter().map(|part| part.to_string_lossy()).collect();
            found.insert(parts.join("/"));
        }
    }
}

#[test]
fn every_source_is_listed() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut due: BTreeSet<String> = ["LICENSE-APACHE", "LICENSE-MIT", "README.md"]
        .map(String::from)
        .into();
    walk(&root.join("src"), root, &mut due);
    let listed = source::FILES.iter().map(|(path, _)| path.to_string());
    assert_eq!(listed.collect::<BTreeSet<_>>(), due);
    for (path, text) in source::FILES {
        assert_eq!(std::fs::read_to_string(root.join(path)).unwrap(), *text);
    }
}
