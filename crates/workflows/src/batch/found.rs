//! Which logs a batch is made of: those of folders, patterns and lists.

use crate::error::Error;
use std::collections::{HashMap, HashSet};
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use stiction_files::batch::{Listed, is_list, read_list};
use stiction_files::shell;
use stiction_formats::{Irregular, is_of_kernel};

/// The logs, each once, in the order of the inputs, those of a folder and a pattern in alphabetical order; but for what is in `out`.
///
/// What lies beside the result of an earlier command goes to `beside`.
pub(super) fn found(
    inputs: &[PathBuf],
    out: &Path,
    beside: &mut Vec<PathBuf>,
) -> Result<Vec<Listed>, Error> {
    let mut all = Vec::new();
    for input in inputs {
        let before = all.len();
        let is_pattern = || shell::text(input).contains(['*', '?', '[']);
        if input.is_dir() && is_of_kernel(input) {
            let found = format!("{} is a folder of the kernel", shell::text(input));
            return Err(Error::usage(found, "a folder of logs"));
        }
        if input.is_dir() && is_outcome(input) {
            return Err(Error::usage(
                format!(
                    "{} holds what an earlier command has written",
                    shell::text(input)
                ),
                "a folder of logs; logs that lie beside a result are named by themselves",
            ));
        }
        if input.is_dir() {
            walk(input, out, &mut (&mut all, beside));
            if all.len() == before {
                let but = match beside.first() {
                    Some(log) => format!(" but beside results, such as {}", shell::text(log)),
                    None => String::new(),
                };
                let found = format!("{} holds no logs{but}", shell::text(input));
                return Err(Error::usage(
                    found,
                    "a folder with logs in it or in folders below it",
                ));
            }
        } else if input.symlink_metadata().is_err() && is_pattern() {
            matching(input, out, &mut (&mut all, beside))?;
        } else if is_list(input) {
            let listed = read_list(input)?;
            if let Some(list) = listed.iter().find(|listed| is_list(&listed.path)) {
                let [list, input] = [&list.path, input].map(|path| shell::text(path));
                let found = format!("{input} lists {list}, which is a list itself");
                return Err(Error::usage(
                    found,
                    "logs in a list; several lists are given one after the other",
                ));
            }
            all.extend(listed);
        } else if let Err(e) = stiction_formats::regular(input) {
            let kind = stiction_formats::Kind::Io;
            let allowed = match e {
                Irregular::Io(_) => "",
                Irregular::Other(_) => "recordings, lists of them, folders and patterns",
            };
            let refused = stiction_formats::Error::new(kind, e.to_string(), allowed);
            return Err(refused.in_file(input).into());
        } else {
            all.push(log(input.clone()));
        }
    }
    let mut seen = HashSet::new();
    // One log may have several paths.
    let place = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    // A list in a folder of logs is no log of it.
    seen.extend(
        inputs
            .iter()
            .filter(|input| is_list(input))
            .map(|list| place(list)),
    );
    let mut once: Vec<Listed> = Vec::with_capacity(all.len());
    let mut at: HashMap<PathBuf, usize> = HashMap::new();
    for listed in all {
        let place = place(&listed.path);
        match at.get(&place) {
            Some(first) => once[*first].take(listed),
            None if seen.insert(place.clone()) => {
                at.insert(place, once.len());
                once.push(listed);
            }
            None => {}
        }
    }
    let all = once;
    beside.retain(|log| seen.insert(place(log)));
    Ok(all)
}

fn log(path: PathBuf) -> Listed {
    Listed {
        path,
        ..Listed::default()
    }
}

/// Whether a folder is what a command of this program wrote.
fn is_outcome(folder: &Path) -> bool {
    let begins = |name: &str| {
        let mut begin = String::new();
        let file = fs::File::open(folder.join(name)).ok()?;
        file.take(200).read_to_string(&mut begin).ok()?;
        begin.contains("\"stiction.").then_some(())
    };
    ["result.json", "batch.json", "study.json", "drift.json"]
        .into_iter()
        .any(|name| stiction_formats::is_regular(&folder.join(name)) && begins(name).is_some())
}

/// Whether a file has messages of a recording of rosbag2, by its name.
fn has_messages(path: &Path) -> bool {
    let ending = path.extension().and_then(|end| end.to_str());
    ending.is_some_and(|end| end.starts_with("db3") || matches!(end, "mcap" | "zstd"))
}

/// What is in a folder, and in those below it; hidden ones, links to folders, configuration and what was written by a command of
/// this program are left out.
fn walk(folder: &Path, out: &Path, all: &mut (&mut Vec<Listed>, &mut Vec<PathBuf>)) {
    let same = |a: &Path| Some(a.canonicalize().ok()? == out.canonicalize().ok()?);
    if same(folder) == Some(true) || is_of_kernel(folder) {
        return;
    }
    if is_outcome(folder) {
        all.1.extend(logs_beside(folder));
        return;
    }
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    paths.sort();
    if let Some(data_set) = stiction_formats::data_set_of(folder) {
        all.0.push(log(data_set));
        return;
    }
    // Its files are one log, by the list of them.
    if stiction_formats::bag_of(folder).is_some() {
        paths.retain(|path| !has_messages(path));
    }
    for path in paths {
        let hidden = path
            .file_name()
            .is_some_and(|name| name.as_encoded_bytes().starts_with(b"."));
        let Ok(about) = path.symlink_metadata() else {
            continue;
        };
        if hidden {
            continue;
        }
        match about.is_dir() {
            true => walk(&path, out, all),
            // A link that leads nowhere is a log that is not there.
            false if !path.is_dir() && !is_configuration(&path) => all.0.push(log(path)),
            false => {}
        }
    }
}

/// The recordings in a folder of results, by their names: none of those that commands of this program write.
fn logs_beside(folder: &Path) -> Vec<PathBuf> {
    const ENDINGS: [&str; 21] = [
        "csv", "tsv", "txt", "dat", "log", "mat", "npz", "npy", "parquet", "arrow", "feather",
        "h5", "hdf5", "tdms", "mf4", "mcap", "db3", "xlsx", "svb", "pcap", "pcapng",
    ];
    const WRITTEN: [&str; 5] = [
        "fit.csv",
        "contours.csv",
        "trajectories.csv",
        "speeds.csv",
        "results.parquet",
    ];
    const MAPS: [&str; 4] = [
        "_drive_table.csv",
        "_cogging_map.csv",
        "_backlash.csv",
        "_linuxcnc_comp.txt",
    ];
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut logs: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    logs.retain(|path| {
        let name = path
            .file_name()
            .and_then(|name| name.to_str())
            .unwrap_or_default();
        let ending = path
            .extension()
            .and_then(|end| end.to_str())
            .unwrap_or_default();
        let is_log = ENDINGS
            .iter()
            .any(|known| ending.eq_ignore_ascii_case(known));
        let is_ours = WRITTEN.contains(&name)
            || name.starts_with("setpoints.")
            || MAPS.iter().any(|end| name.ends_with(end));
        is_log && !is_ours && !name.starts_with('.') && path.is_file()
    });
    logs.sort();
    logs
}

/// No log is TOML: axis and model files lie beside logs.
fn is_configuration(path: &Path) -> bool {
    path.extension()
        .is_some_and(|end| end.eq_ignore_ascii_case("toml"))
}

/// What a pattern names: `*` and `?` within a name, `**` over folders, `[a-c]`.
fn matching(
    pattern: &Path,
    out: &Path,
    all: &mut (&mut Vec<Listed>, &mut Vec<PathBuf>),
) -> Result<(), Error> {
    let text = shell::text(pattern);
    let options = glob::MatchOptions {
        require_literal_separator: true,
        require_literal_leading_dot: true,
        ..glob::MatchOptions::new()
    };
    let paths = glob::glob_with(&text, options)
        .map_err(|e| Error::usage(format!("{text}: {e}"), "a pattern with *, ?, ** and [a-c]"))?;
    let before = all.0.len();
    for path in paths.flatten() {
        match path.is_dir() {
            true => walk(&path, out, all),
            false if !is_configuration(&path) => all.0.push(log(path)),
            false => {}
        }
    }
    if all.0.len() == before {
        return Err(Error::usage(
            format!("{text} names no logs"),
            "a pattern of files that are there",
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_patterns_and_lists_give_each_log_once() {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        fs::create_dir_all(at.join("a/deep")).unwrap();
        fs::create_dir_all(at.join("out")).unwrap();
        for name in [
            "b.csv",
            "a/2.csv",
            "a/10.csv",
            "a/axis.toml",
            "a/.hidden.csv",
            "a/deep/1.mat",
            "out/old.csv",
        ] {
            fs::write(at.join(name), "t,x\n").unwrap();
        }
        fs::write(
            at.join("list.csv"),
            "path,machine\nb.csv,M\nnowhere.csv,N\n",
        )
        .unwrap();
        let found = |inputs: &[&str]| {
            let inputs: Vec<PathBuf> = inputs.iter().map(|name| at.join(name)).collect();
            let all = found(&inputs, &at.join("out"), &mut Vec::new());
            all.map(|all| {
                let name = |l: &Listed| l.path.strip_prefix(at).unwrap().display().to_string();
                all.iter().map(name).collect::<Vec<_>>()
            })
        };
        let walked = ["a/10.csv", "a/2.csv", "a/deep/1.mat"];
        assert_eq!(found(&["a"]).unwrap(), walked);
        assert_eq!(found(&["a/*.csv", "a"]).unwrap(), walked);
        assert_eq!(found(&["**/*.mat"]).unwrap(), ["a/deep/1.mat"]);
        assert_eq!(
            found(&["b.csv", "list.csv"]).unwrap(),
            ["b.csv", "nowhere.csv"]
        );
        assert_eq!(found(&[""]).unwrap().len(), 5);
        fs::create_dir_all(at.join("done")).unwrap();
        fs::write(
            at.join("done/result.json"),
            "{\"schema\":\"stiction.result/1\"}",
        )
        .unwrap();
        // Beside a result in a folder below a log is left out, and named.
        for name in [
            "fit.csv",
            "setpoints.csv",
            "run.csv",
            "run.mat",
            "report.html",
        ] {
            fs::write(at.join("done").join(name), "t,x\n").unwrap();
        }
        let mut beside = Vec::new();
        let all = super::found(&[at.into()], &at.join("out"), &mut beside).unwrap();
        assert_eq!(all.len(), 5);
        assert_eq!(beside, [at.join("done/run.csv"), at.join("done/run.mat")]);
        let named = [at.into(), at.join("done/run.csv")];
        beside.clear();
        let all = super::found(&named, &at.join("out"), &mut beside).unwrap();
        assert_eq!((all.len(), beside), (6, vec![at.join("done/run.mat")]));
        fs::create_dir_all(at.join("bag")).unwrap();
        for name in ["bag_0.db3", "bag_1.db3", "notes.csv", "metadata.yaml"] {
            fs::write(at.join("bag").join(name), "rosbag2_bagfile_information:\n").unwrap();
        }
        assert_eq!(
            found(&["bag"]).unwrap(),
            ["bag/metadata.yaml", "bag/notes.csv"]
        );
        for folder in ["set/meta", "set/data/chunk-000"] {
            fs::create_dir_all(at.join(folder)).unwrap();
        }
        let info = "{\"codebase_version\": \"v2.1\", \"fps\": 30, \"features\": {}}";
        fs::write(at.join("set/meta/info.json"), info).unwrap();
        fs::write(at.join("set/meta/tasks.jsonl"), "{}\n").unwrap();
        let episode = "set/data/chunk-000/episode_000000.parquet";
        fs::write(at.join(episode), "PAR1").unwrap();
        assert_eq!(found(&["set"]).unwrap(), ["set/meta/info.json"]);
        for (input, said) in [
            ("out", "holds no logs"),
            ("done", "holds what an earlier command has written"),
            ("nothing/*.csv", "names no logs"),
            ("none.csv", "cannot be read"),
            ("[", "a pattern with"),
            #[cfg(target_os = "linux")]
            ("/proc/self", "is a folder of the kernel"),
        ] {
            let error = found(&[input]).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
    }
}
