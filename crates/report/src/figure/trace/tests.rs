use super::*;

fn path(places: &[Place]) -> String {
    match trace(places.iter().copied(), 100.0, 50.0) {
        Trace::Path(data) => data,
        Trace::Cells(data) => panic!("cells: {data}"),
    }
}

#[test]
fn few_points_are_drawn_as_they_are() {
    let places = [
        Some((0.0, 0.0)),
        Some((0.2, 5.0)),
        Some((0.4, 1.0)),
        Some((1.6, 3.0)),
    ];
    assert_eq!(path(&places), "m0 0 .2 5 .2-4 1.2 2");
    assert_eq!(path(&[]), "");
}

#[test]
fn breaks_and_single_samples_are_seen() {
    let places = [
        Some((0.0, 0.0)),
        None,
        Some((10.0, 5.0)),
        Some((20.0, 5.0)),
        None,
        None,
    ];
    assert_eq!(path(&places), "m0 0h0m10 5h10");
    // Two strokes in one pixel column stay two strokes.
    let step = [
        Some((5.0, 0.0)),
        Some((5.0, 10.0)),
        None,
        Some((5.0, 20.0)),
        Some((5.0, 30.0)),
    ];
    assert_eq!(path(&step), "m5 0v10m0 10v10");
}

#[test]
fn what_is_outside_is_not_written() {
    let far: Vec<Place> = (0..1000).map(|i| Some((500.0 + i as f64, 10.0))).collect();
    assert_eq!(path(&far), "");
    let through = [
        Some((-50.0, 10.0)),
        Some((500.0, 10.0)),
        Some((600.0, 10.0)),
    ];
    assert_eq!(path(&through), "m-50 10h550");
}

/// The lowest and highest place of every pixel column, taken from the data directly.
fn extremes(places: &[Place]) -> Vec<(f64, f64)> {
    let mut out = vec![(f64::INFINITY, f64::NEG_INFINITY); 100];
    for (x, y) in places.iter().flatten() {
        let e = &mut out[*x as usize];
        *e = (e.0.min(*y), e.1.max(*y));
    }
    out
}

#[test]
fn a_million_samples_keep_every_peak() {
    let mut seed = 1_u64;
    let mut places: Vec<Place> = (0..1_000_000)
        .map(|i| {
            seed = seed
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            Some((
                i as f64 * 1e-4,
                20.0 + 10.0 * ((seed >> 40) as f64 / (1 << 24) as f64),
            ))
        })
        .collect();
    places[333_333] = Some((33.3333, 1.0));
    places[777_777] = Some((77.7777, 49.0));
    let merged: Vec<Place> = Columns::new(places.iter().copied()).collect();
    assert!(merged.len() <= 200, "{}", merged.len());
    assert_eq!(extremes(&merged), extremes(&places));
    assert!(path(&places).len() < 3000);
}

#[test]
fn a_long_tangle_becomes_the_cells_it_covers() {
    // 2000 turns of a circle of radius 20 about (50, 25).
    let turn = |i: usize| {
        let a = i as f64 * 0.1;
        Some((50.0 + 20.0 * libm::cos(a), 25.0 + 20.0 * libm::sin(a)))
    };
    let Trace::Cells(data) = trace((0..125_664).map(turn), 100.0, 50.0) else {
        panic!("expected cells")
    };
    // Two arcs a row, 41 rows; at top and bottom one.
    let runs = data.matches(['M', 'm']).count();
    assert!((60..=82).contains(&runs), "{runs}");
    assert!(data.len() < 1000, "{}", data.len());
}

#[test]
fn alternating_breaks_stay_bounded() {
    let places = (0..2_000_000).map(|i| (i % 2 == 0).then_some((i as f64 * 5e-5, (i % 37) as f64)));
    let Trace::Path(data) = trace(places, 100.0, 50.0) else {
        panic!("expected a path")
    };
    assert!(data.len() < 20_000, "{}", data.len());
}

#[test]
fn cut_keeps_only_the_inside() {
    assert_eq!(
        cut((-10.0, 5.0), (10.0, 5.0), 8.0, 8.0),
        Some(((0.0, 5.0), (8.0, 5.0)))
    );
    assert_eq!(cut((-10.0, 5.0), (-5.0, 5.0), 8.0, 8.0), None);
    assert_eq!(cut((-1.0, 20.0), (20.0, -1.0), 8.0, 8.0), None);
}
