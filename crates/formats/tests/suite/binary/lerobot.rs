//! Data sets of LeRobot come back with the names of their elements, and are split between their episodes.

use super::common::{Truth, written};
use std::path::Path;
use stiction_formats::{
    Kind, Limits, ReadOptions, Table, Unit, data_set_of, is_recording_folder, read_table,
    read_table_with,
};
use stiction_log::{Channel, Log, Mapping};

/// Frames of the episodes that the script writes.
const LENGTHS: [usize; 4] = [40, 31, 1, 52];
const FRAMES: usize = 124;

fn read(path: &Path) -> Table {
    read_table(path, &ReadOptions::default()).unwrap()
}

/// Position and force by these names.
fn mapping(position: &str, force: &str) -> Mapping {
    let unit = |text| Unit::parse(text).unwrap();
    Mapping {
        position: Some(Channel::named(position).unit(unit("deg"))),
        force: Some(Channel::named(force).unit(unit("N m"))),
        ..Mapping::default()
    }
}

#[test]
fn data_sets_come_back_bit_for_bit() {
    let folder = written("write_lerobot.py");
    for name in ["v20", "v21", "v30"] {
        let root = folder.path().join(name);
        let truth = Truth::beside(&folder.path().join(format!("{name}.all"))).unwrap();
        let table = read(&root);
        // Columns are in the order of the file, those of Python in that of the truth.
        assert_eq!(Truth::of(&table), truth, "{name}");
        assert_eq!(table.starts, [40, 71, 72], "{name}");
        assert_eq!(
            Truth::of(&read(&root.join("meta/info.json"))),
            truth,
            "{name}"
        );
        assert_eq!(data_set_of(&root), Some(root.join("meta/info.json")));
        let said = table.detected.join("\n");
        assert!(
            said.contains("4 episodes, split between them: 0 from 0.000 s, 1 from 1.333 s"),
            "{said}"
        );
    }
    assert_eq!(data_set_of(folder.path()), None);
    let is_one = ["v30", "v30/data"].map(|name| is_recording_folder(&folder.path().join(name)));
    assert_eq!(is_one, [true, false]);
}

#[test]
fn one_file_has_the_names_of_its_data_set() {
    let folder = written("write_lerobot.py");
    for (path, starts, rows) in [
        (
            "v21/data/chunk-000/episode_000003.parquet",
            vec![],
            LENGTHS[3],
        ),
        ("v21/data/chunk-000/episode_000002.parquet", vec![], 1),
        ("v30/data/chunk-000/file-000.parquet", vec![40, 71], 72),
    ] {
        let table = read(&folder.path().join(path));
        let named = table.columns.iter().any(|c| c.name == "action.gripper.pos");
        assert!(named, "{path}");
        assert_eq!(
            (table.starts, table.columns[0].values.len()),
            (starts, rows),
            "{path}"
        );
    }
}

#[test]
fn an_element_is_chosen_by_any_of_its_names() {
    let folder = written("write_lerobot.py");
    let table = read(&folder.path().join("v21"));
    let log = |position: &str| {
        Log::from_table(&table, &mapping(position, "observation.plain[1]")).unwrap()
    };
    let named = log("observation.state.elbow_flex.pos");
    for name in [
        "observation.state(:,2)",
        "observation.state[1]",
        "observation.state.1",
    ] {
        assert_eq!(log(name).position, named.position, "{name}");
    }
    let force = log("observation.plain.0").force;
    assert_eq!(force, named.force);
    let refused = Log::from_table(
        &table,
        &mapping("observation.state[3]", "observation.plain.0"),
    );
    assert_eq!(refused.unwrap_err().kind, Kind::Missing);
}

#[test]
fn nothing_joins_two_episodes() {
    let folder = written("write_lerobot.py");
    for name in ["v21", "v30"] {
        let table = read(&folder.path().join(name));
        let map = mapping("observation.state[0]", "observation.plain[0]");
        let log = Log::from_table(&table, &map).unwrap();
        assert_eq!(log.time.len(), FRAMES);
        assert_eq!(log.segments, [0..40, 40..71, 71..72, 72..124], "{name}");
        assert!(log.gaps.is_empty());
        // A crop moves the borders with the rows.
        let crop = Some((1.0, 3.0));
        let cut = Log::from_table(&table, &Mapping { crop, ..map }).unwrap();
        let starts: Vec<f64> = cut.segments[1..]
            .iter()
            .map(|s| cut.time[s.start] + cut.start)
            .collect();
        let whole: Vec<f64> = [40, 71, 72].map(|at| log.time[at] + log.start).to_vec();
        assert!(
            starts.iter().zip(&whole).all(|(a, b)| (a - b).abs() < 1e-9),
            "{starts:?} {whole:?}"
        );
        assert_eq!(starts.len(), whole.len());
    }
}

#[test]
fn all_bytes_of_a_data_set_are_handed_on() {
    let folder = written("write_lerobot.py");
    let root = folder.path().join("v30");
    let mut handed = Vec::new();
    let take = |bytes: &[u8]| handed.extend_from_slice(bytes);
    read_table_with(&root, &ReadOptions::default(), take).unwrap();
    let names = [
        "meta/info.json",
        "data/chunk-000/file-000.parquet",
        "data/chunk-001/file-000.parquet",
    ];
    let files = names.map(|name| std::fs::read(root.join(name)).unwrap());
    assert!(handed == files.concat());
}

#[test]
fn what_is_wrong_with_a_data_set_is_named() {
    let folder = written("write_lerobot.py");
    let root = folder.path().join("v21");
    // All files together count: each of them alone would fit.
    let memory = 24 * 13 * 80;
    let limits = Limits { memory };
    let options = ReadOptions {
        limits,
        ..ReadOptions::default()
    };
    assert!(
        read_table(
            &root.join("data/chunk-000/episode_000003.parquet"),
            &options
        )
        .is_ok()
    );
    assert_eq!(read_table(&root, &options).unwrap_err().kind, Kind::Limit);
    let other = folder
        .path()
        .join("v20/data/chunk-000/episode_000001.parquet");
    std::fs::write(root.join("data/chunk-000/episode_000001.parquet"), b"PAR1").unwrap();
    let error = read_table(&root, &ReadOptions::default())
        .unwrap_err()
        .to_string();
    assert!(error.contains("episode_000001.parquet: "), "{error}");
    std::fs::write(
        root.join("data/chunk-000/episode_000001.parquet"),
        std::fs::read(other).unwrap(),
    )
    .unwrap();
    assert!(read_table(&root, &ReadOptions::default()).is_ok());
    std::fs::remove_dir_all(root.join("data/chunk-000")).unwrap();
    let error = read_table(&root, &ReadOptions::default()).unwrap_err();
    assert_eq!(error.kind, Kind::Missing, "{error}");
}
