//! Areas between two edges.

use std::cmp::Ordering;

use super::draw::{Frame, Stroke};
use super::path::Path;

/// Path data of one closed outline.
pub(crate) fn outline(corners: &[(f64, f64)]) -> String {
    let mut path = Path::new();
    add_outline(&mut path, corners.iter().copied());
    path.into_data()
}

fn add_outline(path: &mut Path, mut corners: impl Iterator<Item = (f64, f64)>) {
    if let Some((x, y)) = corners.next() {
        path.move_to(x, y);
        corners.for_each(|(x, y)| path.line_to(x, y));
        path.close();
    }
}

/// Outlines of the area between two edges, one for each run without a break. In a pixel column
/// with more than two samples the area reaches from the lowest to the highest of them.
pub(crate) fn band(x: &[f64], low: &[f64], high: &[f64], frame: &Frame) -> String {
    let mut order: Vec<usize> = Vec::new();
    if !x.is_sorted_by(|a, b| a.partial_cmp(b) != Some(Ordering::Greater)) {
        order = (0..x.len()).collect();
        order.sort_by(|a, b| x[*a].total_cmp(&x[*b]));
    }
    let mut path = Path::new();
    let mut run: Vec<Stroke> = Vec::new();
    let mut in_column = 0;
    for i in 0..=x.len() {
        let i = order.get(i).copied().unwrap_or(i);
        let slice = (i < x.len())
            .then(|| Some((frame.x_px(x[i]), frame.edge(high[i])?, frame.edge(low[i])?)))
            .flatten()
            .filter(|(x, ..)| x.is_finite());
        let Some((x, top, bottom)) = slice else {
            add_band(&mut path, &run);
            run.clear();
            continue;
        };
        let (top, bottom) = (top.min(bottom), top.max(bottom));
        match run.last_mut() {
            Some(last) if last.0.floor() == x.floor() => {
                in_column += 1;
                if in_column > 2 {
                    *last = (x.floor() + 0.5, last.1.min(top), last.2.max(bottom));
                } else {
                    run.push((x, top, bottom));
                }
            }
            _ => {
                in_column = 1;
                run.push((x, top, bottom));
            }
        }
        // What lies left or right of the plot needs one slice beyond its edge only.
        if let [.., a, b] = run[..] {
            let left = a.0 < 0.0 && b.0 < 0.0;
            let right = a.0 > frame.width && b.0 > frame.width;
            if left {
                let at = run.len() - 2;
                run.remove(at);
            } else if right {
                run.pop();
            }
        }
    }
    path.into_data()
}

fn add_band(path: &mut Path, run: &[Stroke]) {
    let top = run.iter().map(|(x, top, _)| (*x, *top));
    let bottom = run.iter().rev().map(|(x, _, bottom)| (*x, *bottom));
    if run.len() > 1 {
        add_outline(path, top.chain(bottom));
    }
}
