//! Parts of a record that are kept by their time.

use crate::mapping_common::{axis, codes, warnings};
use proptest::prelude::*;
use stiction_log::{Enable, Log, Mapping, Parts, Selector};

fn parts(parts: Parts) -> Mapping {
    Mapping {
        parts: Some(parts),
        ..Mapping::default()
    }
}

#[test]
fn parts_are_counted_from_the_first_sample_of_the_file() {
    let stretches = vec![(1.0, 1.5), (2.0, 2.001), (3.0, 9.0)];
    let mut table = axis(4000).table();
    table.columns[0].values.iter_mut().for_each(|t| *t += 20.0);
    let mapping = Mapping {
        crop: Some((0.5, 60.0)),
        ..parts(Parts::inside(stretches.clone()))
    };
    let log = Log::from_table(&table, &mapping).unwrap();
    assert_eq!(log.segments, [0..500, 500..501, 501..1501]);
    assert!((log.start - 21.0).abs() < 1e-9, "{}", log.start);
    assert_eq!(warnings(&log), [""; 0]);
    assert!(!codes(&log).contains(&"gap"), "{:?}", codes(&log));
    let rest = Log::from_table(&table, &parts(Parts::outside(stretches))).unwrap();
    assert_eq!(rest.segments, [0..1000, 1000..1500, 1500..2499]);
}

#[test]
fn what_is_refused() {
    let refused = |mapping: &Mapping| {
        let error = Log::from_table(&axis(4000).table(), mapping).unwrap_err();
        format!("{error} <- {}", error.setting().unwrap_or("no key"))
    };
    let cropped = Mapping {
        crop: Some((1.0, 2.0)),
        ..parts(Parts::inside(vec![(1.0, 1.5), (2.5, 3.0)]))
    };
    let lines = [
        refused(&parts(Parts::inside(vec![(0.0, 1.0), (4.0, 5.0)]))),
        refused(&parts(Parts::outside(vec![(4.0, 5.0)]))),
        refused(&parts(Parts::outside(vec![(0.0, 5.0)]))),
        refused(&parts(Parts::inside(vec![(2.0, 1.0)]))),
        refused(&cropped),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}

/// Only the rows of the part count as left out by the enable column.
#[test]
fn parts_and_a_mode() {
    let mut table = axis(4000).table();
    let mut on = table.columns[0].clone();
    on.name = "on".into();
    on.unit = None;
    on.values = (0..4000)
        .map(|i| f64::from(u8::from(i % 1000 < 900)))
        .collect();
    table.columns.push(on);
    let mapping = Mapping {
        enable: Some(Enable {
            column: Selector::Name("on".into()),
            equals: None,
            mask: None,
        }),
        ..parts(Parts::inside(vec![(0.5, 1.5)]))
    };
    let log = Log::from_table(&table, &mapping).unwrap();
    assert_eq!(log.segments, [0..400, 400..900]);
    let left_out = log.not_enabled.unwrap();
    assert_eq!((left_out.rows, left_out.of), (100, 1000));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Every row is in a part or in the rest, and in one of them only.
    #[test]
    fn parts_and_the_rest_are_the_whole(ends in prop::collection::btree_set(1_u32..3900, 2..9)) {
        let ends: Vec<f64> = ends.into_iter().map(|ms| f64::from(ms) / 1000.0).collect();
        let stretches: Vec<(f64, f64)> = ends.chunks_exact(2).map(|e| (e[0], e[1])).collect();
        prop_assume!(stretches.iter().map(|(a, b)| b - a).sum::<f64>() > 0.01);
        let table = axis(4000).table();
        let read = |parts_of| Log::from_table(&table, &parts(parts_of)).unwrap();
        let own = read(Parts::inside(stretches.clone()));
        let rest = read(Parts::outside(stretches));
        let instants = |log: &Log| -> Vec<u32> {
            log.time.iter().map(|t| ((log.start + t) * 1000.0).round() as u32).collect()
        };
        let mut all = instants(&own);
        all.extend(instants(&rest));
        all.sort_unstable();
        prop_assert_eq!(all, (0..4000).collect::<Vec<u32>>());
    }
}
