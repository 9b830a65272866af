//! Reports of long records stay small.

use stiction_report::{Axis, Document, Figure, Layer, Panel, Samples};

/// A repeatable uniform sequence in -1 ... 1 (xorshift64*, Vigna 2016).
fn uniform(n: usize, mut state: u64) -> Samples {
    let mut next = || {
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        (state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    (0..n).map(|_| next()).collect()
}

#[test]
fn ten_figures_of_100_000_samples_are_below_a_megabyte() {
    let n = 100_000;
    let time: Samples = (0..n).map(|i| i as f64 * 1e-3).collect();
    let axes = || (Axis::new("Time", "s"), Axis::new("Force", "N"));
    let mut document = Document::new("Long");
    for k in 0..5 {
        let (x, y) = axes();
        let lines = (0..3).fold(Panel::new(x, y), |panel, i| {
            panel.layer(Layer::line(time.clone(), uniform(n, 10 * k + i + 1)))
        });
        let (x, y) = axes();
        let cloud = Panel::new(x, y).layer(Layer::points(uniform(n, k + 90), uniform(n, k + 70)));
        document = document
            .block(Figure::new("Lines").panel(lines))
            .block(Figure::new("Cloud").panel(cloud));
    }
    let html = document.to_html();
    assert!(html.len() < 1_000_000, "{} bytes", html.len());
}

#[test]
fn the_worst_line_is_bounded() {
    // Jumps all over the plot, in both directions.
    let n = 300_000;
    let panel = Panel::new(Axis::new("x", ""), Axis::new("y", ""))
        .layer(Layer::line(uniform(n, 1), uniform(n, 2)));
    let svg = Figure::new("Tangle").panel(panel).to_svg();
    assert!(svg.len() < 60_000, "{} bytes", svg.len());
}

#[test]
fn one_outlier_in_a_million_is_seen() {
    let n = 1_000_000;
    let mut y: Vec<f64> = uniform(n, 5).to_vec();
    y[654_321] = 50.0;
    let time: Samples = (0..n).map(|i| i as f64).collect();
    let panel = |y: Vec<f64>| {
        Figure::new("").panel(
            Panel::new(Axis::new("t", "s"), Axis::new("y", "").range(-60.0, 60.0))
                .layer(Layer::line(time.clone(), y)),
        )
    };
    let with = panel(y.clone()).to_svg();
    y[654_321] = 0.0;
    assert_ne!(with, panel(y).to_svg());
}
