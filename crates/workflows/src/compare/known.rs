//! The named problems: known axes, and published steady curves.

use stiction_friction::{Damping, Direction, LuGre, ParamError, Shape, Stribeck};
use stiction_servo::known::{self, KnownAxis};

/// A steady curve with its parameters, `[Fc, Fs, sigma2, vs]` of each direction; the force depends on the velocity
/// alone.
pub(super) struct KnownCurve {
    pub name: &'static str,
    pub source: &'static str,
    pub positive: [f64; 4],
    /// `None` where both directions are the same.
    pub negative: Option<[f64; 4]>,
}

/// Speeds of every curve: from -1 to 1 rad/s in steps of 0.05.
pub(super) fn speeds() -> Vec<f64> {
    (-20..=20).map(|i| 0.05 * f64::from(i)).collect()
}

const CURVES: [KnownCurve; 3] = [
    KnownCurve {
        name: "V2",
        source: "steady curve with a direction each, Liu Jinkun, lectures on system identification, 8.7; \
                 on these speeds Fs and vs are not identifiable",
        positive: [0.28, 0.34, 0.02, 0.01],
        negative: Some([0.29, 0.33, 0.03, 0.015]),
    },
    KnownCurve {
        name: "V3",
        source: "steady curve with a direction each, Liu Jinkun, lectures on system identification, 8.5",
        positive: [0.15, 0.60, 0.02, 0.05],
        negative: Some([0.20, 0.70, 0.03, 0.05]),
    },
    KnownCurve {
        name: "V7",
        source: "steady curve of Na et al., chapter 2",
        positive: [0.28, 0.34, 0.01, 0.2],
        negative: None,
    },
];

/// A problem by its name.
pub(super) enum Known {
    Axis(KnownAxis),
    Curve(&'static KnownCurve),
}

/// The names, as [`find`] takes them.
pub(super) fn names() -> Vec<&'static str> {
    let curves = CURVES.iter().map(|c| c.name);
    known::all().map(|axis| axis.name).chain(curves).collect()
}

/// The problem of this name, upper or lower case.
pub(super) fn find(name: &str) -> Option<Known> {
    let curve = CURVES.iter().find(|c| c.name.eq_ignore_ascii_case(name));
    let axis = || known::find(name).map(Known::Axis);
    curve.map(Known::Curve).or_else(axis)
}

impl KnownCurve {
    /// Force at each of the speeds.
    pub fn forces(&self) -> Result<Vec<f64>, ParamError> {
        let side = |[fc, fs, s2, vs]: [f64; 4]| Direction {
            coulomb: fc,
            static_friction: fs,
            stribeck_velocity: vs,
            viscous: s2,
        };
        let negative = self.negative.unwrap_or(self.positive);
        let curve = Stribeck::new(Shape::Gaussian, side(self.positive), side(negative), 0.0)?;
        Ok(speeds().into_iter().map(|v| curve.force(v)).collect())
    }

    /// Parameters by name.
    pub fn truth(&self) -> Vec<(String, f64)> {
        let suffixes = match self.negative {
            None => &[""][..],
            Some(_) => &["_pos", "_neg"],
        };
        let sides = suffixes.iter().zip([Some(self.positive), self.negative]);
        sides
            .flat_map(|(suffix, side)| {
                let [fc, fs, s2, vs] = side.unwrap_or(self.positive);
                [
                    ("sigma2", s2),
                    ("coulomb", fc),
                    ("static", fs),
                    ("stribeck_velocity", vs),
                ]
                .map(|(name, value)| (format!("{name}{suffix}"), value))
            })
            .collect()
    }
}

/// A law that differs a little from the one that is fitted: Stribeck exponent 1, and in the negative direction Fc and
/// sigma2 of 80 % and Fs of 90 %.
pub(super) fn mismatched(law: &LuGre<f64>) -> Result<LuGre<f64>, ParamError> {
    let positive = *law.curve().positive();
    let negative = Direction {
        coulomb: 0.8 * positive.coulomb,
        static_friction: 0.9 * positive.static_friction,
        viscous: 0.8 * positive.viscous,
        ..positive
    };
    let curve = Stribeck::new(Shape::Power(1.0), positive, negative, 0.0)?;
    LuGre::new(
        law.stiffness(),
        Damping::Constant(law.damping().at_rest()),
        curve,
    )
}
