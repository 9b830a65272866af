//! Planes are drawn to one scale.

use stiction_report::{Axis, Document, Figure, Layer, Panel};

/// Width and height of the plot of a figure, px, by the path of its axes.
fn plot(figure: Figure) -> [f64; 2] {
    let html = Document::new("Plane").block(figure).to_html();
    let (_, path) = html.split_once("<path class=\"axis\" d=\"M").unwrap();
    let path = path.split('"').next().unwrap();
    let numbers: Vec<f64> = path
        .split([' ', 'V', 'H'])
        .map(|number| number.parse().unwrap())
        .collect();
    let [left, top, bottom, right] = numbers[..] else {
        panic!("{path}");
    };
    [right - left, bottom - top]
}

/// A square panel is as high as it is wide, however wide its labels are.
#[test]
fn a_square_is_one() {
    for size in [1e-9, 1.0, 123_456.0] {
        let axis = |name: &str| Axis::new(name, "m").range(-size, size);
        let circle = |f: fn(f64) -> f64| -> Vec<f64> {
            let angles = (0..=100).map(|k| std::f64::consts::TAU * f64::from(k) / 100.0);
            angles.map(|angle| size * f(angle)).collect()
        };
        let panel =
            Panel::new(axis("x"), axis("y")).layer(Layer::line(circle(f64::cos), circle(f64::sin)));
        let [width, height] = plot(Figure::new("Circle").half().panel(panel.clone().square()));
        assert!((width - height).abs() < 1e-9, "{width} {height}");
        let [width, height] = plot(Figure::new("Circle").half().panel(panel.height(200.0)));
        assert!((height - 200.0).abs() < 1e-9 && (width - height).abs() > 10.0);
    }
}
