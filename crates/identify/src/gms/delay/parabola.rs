//! A parabola through points that scatter about it.

use nalgebra::{Matrix3, Vector3};

/// A minimum that a parabola shows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parabola {
    /// Where it is.
    pub at: f64,
    /// Half the second derivative.
    pub curvature: f64,
    /// Variance of where it is, from how points scatter about the parabola.
    pub scatter: f64,
}

impl Parabola {
    /// By least squares, through four points or more; `None` where there is no minimum.
    pub fn through(points: &[(f64, f64)]) -> Option<Self> {
        let row = |x: f64| Vector3::new(1.0, x, x * x);
        let mut gram = Matrix3::zeros();
        let mut sums = Vector3::zeros();
        for &(x, y) in points {
            gram += row(x) * row(x).transpose();
            sums += row(x) * y;
        }
        let bread = gram.try_inverse()?;
        let fit = bread * sums;
        let (slope, curvature) = (fit[1], fit[2]);
        if curvature.is_nan() || curvature <= 0.0 {
            return None;
        }
        let left = points.iter().map(|&(x, y)| y - row(x).dot(&fit));
        let free = points.len().saturating_sub(3).max(1) as f64;
        let noise = left.map(|r| r * r).sum::<f64>() / free;
        let at = -0.5 * slope / curvature;
        // How it moves with the slope and the curvature.
        let by = Vector3::new(0.0, -0.5 / curvature, -at / curvature);
        Some(Self {
            at,
            curvature,
            scatter: noise * (by.transpose() * bread * by)[(0, 0)],
        })
    }

    /// The same with its places counted from elsewhere.
    pub fn moved(self, by: f64) -> Self {
        Self {
            at: self.at + by,
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_found_and_what_bends_up_alone() {
        let of = |f: &dyn Fn(f64) -> f64| -> Vec<(f64, f64)> {
            (-3..=3)
                .map(|i| 0.1 * f64::from(i))
                .map(|x| (x, f(x)))
                .collect()
        };
        let found = Parabola::through(&of(&|x| 2.0 + 3.0 * (x - 0.07) * (x - 0.07))).unwrap();
        let found = found.moved(1.0);
        assert!((found.at - 1.07).abs() < 1e-12 && found.scatter < 1e-24);
        assert!((found.curvature - 3.0).abs() < 1e-10);
        assert!(Parabola::through(&of(&|x| 1.0 - x * x)).is_none());
        assert!(Parabola::through(&of(&|_| f64::NAN)).is_none());
    }

    /// Of points with noise the minimum scatters as it says.
    #[test]
    fn what_it_says_of_its_scatter_is_so() {
        // A sequence that fills the unit interval evenly stands for chance; a sum of twelve is nearly normal.
        let mut place = 0.5_f64;
        let mut noise = || {
            let mut sum = -6.0;
            for _ in 0..12 {
                place = (1e4 * libm::sin(place + 1.0)).rem_euclid(1.0);
                sum += place;
            }
            sum
        };
        let (mut squares, mut said) = (0.0, 0.0);
        let many = 400;
        for _ in 0..many {
            let points = (-3..=3).map(f64::from).map(|x| (x, 5.0 * x * x + noise()));
            let found = Parabola::through(&points.collect::<Vec<_>>()).unwrap();
            squares += found.at * found.at / f64::from(many);
            said += found.scatter / f64::from(many);
        }
        let ratio = squares / said;
        assert!((0.8..1.25).contains(&ratio), "{squares} of {said}");
    }
}
