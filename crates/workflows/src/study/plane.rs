//! A contour as it is drawn: its reference, and the deviations from it magnified.

use super::contour_trace::ContourTrace;
use serde::Serialize;

/// Size of the largest deviation in the picture, as a part of the size of the contour, dimensionless.
const LARGEST_DEVIATION_DRAWN: f64 = 0.12;

/// Runs on a contour, drawn in its plane.
#[derive(Clone, Debug, Serialize)]
pub struct Plane {
    /// By how much deviations are magnified.
    pub magnified: f64,
    /// A deviation of a round size that can be seen beside it, m (rad).
    pub bar: f64,
    /// Middle of the contour, m (rad).
    pub middle: [f64; 2],
    /// Its larger side, m (rad).
    pub size: f64,
    /// The reference, m (rad).
    pub reference: Line,
    /// As far from the reference as the axes were from the contour, times the factor; of each run.
    pub runs: Vec<Line>,
}

/// A line through places of both axes; NaN where it has a gap.
#[derive(Clone, Debug, Serialize)]
pub struct Line {
    /// m (rad)
    #[serde(serialize_with = "seven_digits")]
    pub x: Vec<f64>,
    /// m (rad)
    #[serde(serialize_with = "seven_digits")]
    pub y: Vec<f64>,
}

impl Plane {
    /// Of runs on one contour, of which the first has the scale. `None` where the contour has no size.
    pub fn of(runs: &[&ContourTrace]) -> Option<Self> {
        let first = runs.first()?;
        let [x, y] = [0, 1].map(|i| range(first.reference.iter().map(|p| p[i])));
        let size = (x[1] - x[0]).max(y[1] - y[0]);
        let largest = first.deviation.iter().fold(0.0_f64, |m, d| m.max(d.abs()));
        let magnified = magnification(LARGEST_DEVIATION_DRAWN * size / largest);
        let bar = round(LARGEST_DEVIATION_DRAWN * size / magnified);
        (size > 0.0 && size.is_finite()).then(|| Plane {
            magnified,
            bar,
            middle: [x, y].map(|[low, high]| 0.5 * (low + high)),
            size,
            reference: Line::through(first.reference.iter().copied()),
            runs: runs.iter().map(|run| drawn_off(run, magnified)).collect(),
        })
    }
}

impl Line {
    fn through(points: impl Iterator<Item = [f64; 2]>) -> Self {
        let (x, y) = points.map(|[x, y]| (x, y)).unzip();
        Line { x, y }
    }
}

/// Places as far from the reference as the axes were from the contour, times a factor; a gap where it stands.
fn drawn_off(run: &ContourTrace, by: f64) -> Line {
    let points = run.reference.iter().zip(&run.left).zip(&run.deviation);
    Line::through(points.map(|((at, left), off)| match left {
        [0.0, 0.0] => [f64::NAN; 2],
        _ => [0, 1].map(|i| at[i] - by * off * left[i]),
    }))
}

fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let ends = [f64::INFINITY, f64::NEG_INFINITY];
    values.fold(ends, |[low, high], x| [low.min(x), high.max(x)])
}

/// A round factor, not above what is wanted; 1 where nothing is to be seen.
fn magnification(most: f64) -> f64 {
    match most.is_finite() && most > 0.0 {
        true => round(most).max(1.0),
        false => 1.0,
    }
}

/// One, two or five times a power of ten, not above a number above 0.
fn round(most: f64) -> f64 {
    let decade = libm::pow(10.0, libm::floor(libm::log10(most)));
    let steps = [5.0, 2.0, 1.0].map(|step| step * decade);
    let step = steps.into_iter().find(|step| *step <= most);
    step.unwrap_or(decade)
}

/// Enough for a picture.
fn seven_digits<S: serde::Serializer>(values: &[f64], to: S) -> Result<S::Ok, S::Error> {
    to.collect_seq(values.iter().map(|x| *x as f32))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A circle of 10 mm, on which the axes are `off` too far out.
    fn circle(off: f64) -> ContourTrace {
        let angles = (0..360).map(|k| f64::from(k).to_radians());
        let reference: Vec<[f64; 2]> = angles
            .map(|a| [0.01 * a.cos() - 0.01, 0.01 * a.sin()])
            .collect();
        let time: Vec<f64> = (0..360).map(|k| 1e-3 * f64::from(k)).collect();
        let deviation = vec![off; 360];
        ContourTrace::read(["circle", "c", "none"], false, (time, reference, deviation))
    }

    #[test]
    fn deviations_are_drawn_across_the_contour() {
        // Positive where the contour is to the left of the axes: outside of a counter-clockwise circle.
        let (near, far) = (circle(1e-6), circle(5e-6));
        let plane = Plane::of(&[&far, &near]).unwrap();
        assert!((plane.size - 0.02).abs() < 1e-5);
        assert!((plane.middle[0] + 0.01).abs() < 1e-5, "{:?}", plane.middle);
        // 0.12 of 20 mm over 5 um is 480.
        assert_eq!(plane.magnified, 200.0);
        assert!((plane.bar - 1e-5).abs() < 1e-12, "{}", plane.bar);
        for (run, off) in plane.runs.iter().zip([5e-6, 1e-6]) {
            for (x, y) in run.x.iter().zip(&run.y).skip(1).take(357) {
                let radius = (x + 0.01).hypot(*y);
                assert!((radius - (0.01 + 200.0 * off)).abs() < 1e-7, "{radius}");
            }
        }
        // What does not deviate is drawn as it is, and what does not move is not drawn.
        assert_eq!(Plane::of(&[&circle(0.0)]).unwrap().magnified, 1.0);
        let mut still = circle(0.0);
        still.reference.fill([0.0; 2]);
        assert!(Plane::of(&[&still]).is_none());
        assert!(Plane::of(&[]).is_none());
    }
}
