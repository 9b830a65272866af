//! The best points of a search, no two of them close together.

use crate::bits;
use crate::points::Points;
use serde::{Deserialize, Serialize};

/// A few good points, best first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Niches {
    most: usize,
    #[serde(with = "bits")]
    radius: f64,
    points: Points,
    #[serde(with = "bits")]
    costs: Vec<f64>,
}

impl Niches {
    /// At most `most` points, each further than `radius` (greatest difference of a coordinate) from
    /// the others.
    pub fn new(most: usize, radius: f64, dimensions: usize) -> Self {
        Self {
            most,
            radius,
            points: Points::new(dimensions),
            costs: Vec::new(),
        }
    }

    pub fn points(&self) -> &Points {
        &self.points
    }

    /// Takes a point in if it is better than all within its radius and than the last of the rest.
    pub fn offer(&mut self, point: &[f64], cost: f64) {
        let full = self.costs.len() == self.most;
        let last = self.costs.last().copied().unwrap_or(f64::INFINITY);
        if !cost.is_finite() || (full && cost >= last) {
            return;
        }
        let near = |other: &[f64]| {
            let apart = point.iter().zip(other).map(|(a, b)| (a - b).abs());
            apart.fold(0.0, f64::max) <= self.radius
        };
        let close: Vec<bool> = self.points.rows().map(near).collect();
        let better = |i: usize| self.costs[i] <= cost;
        if (0..close.len()).any(|i| close[i] && better(i)) {
            return;
        }
        let (mut points, mut costs) = (Points::new(point.len()), Vec::new());
        let mut placed = false;
        for (i, close) in close.into_iter().enumerate() {
            if !placed && !better(i) {
                points.push(point);
                costs.push(cost);
                placed = true;
            }
            if !close && costs.len() < self.most {
                points.push(self.points.row(i));
                costs.push(self.costs[i]);
            }
        }
        if !placed && costs.len() < self.most {
            points.push(point);
            costs.push(cost);
        }
        (self.points, self.costs) = (points, costs);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_best_is_there_and_none_are_close(
            offers in prop::collection::vec((0.0..1.0f64, 0.0..1.0f64, 0.0..1.0f64), 1..60)
        ) {
            let mut niches = Niches::new(4, 0.1, 2);
            for &(x, y, cost) in &offers {
                niches.offer(&[x, y], cost);
            }
            let least = offers.iter().map(|o| o.2).fold(f64::INFINITY, f64::min);
            prop_assert_eq!(niches.costs[0], least);
            prop_assert!(niches.costs.is_sorted());
            prop_assert!(niches.costs.len() <= 4 && niches.points.len() == niches.costs.len());
            for i in 0..niches.points.len() {
                for j in 0..i {
                    let (a, b) = (niches.points.row(i), niches.points.row(j));
                    prop_assert!((a[0] - b[0]).abs().max((a[1] - b[1]).abs()) > 0.1);
                }
            }
        }
    }
}
