//! Wrong parameters: what a compensator is given instead of those of the axis.

use super::model::{Model, axis_law};
use crate::model::covariance::root;
use crate::result::{CovarianceEntry, RemainingEntry};
use stiction_friction::{Damping, Direction, Stribeck};
use stiction_number::four_digits as short;
use stiction_parameters::{LawError, Name, ParameterSet, Quantity, Side};
use stiction_servo::law::AxisLaw;
use stiction_servo::noise::Noise;
use stiction_servo::unmodelled::{Shape, Unmodelled, Wandering, Wave};

/// The parameters of the axis that a compensator assumes, right or wrong.
#[derive(Clone, Copy, PartialEq)]
pub struct Belief {
    /// Its friction.
    pub law: AxisLaw,
    /// Its mass, kg (kg m^2).
    pub mass: f64,
}

/// Beliefs of one kind.
pub struct Family {
    /// `exact`, `corners`, `covariance`, `promised` or `moved`.
    pub kind: &'static str,
    /// For tables: `exact`, `±10 %`, `95 % of 200 draws`.
    pub name: String,
    /// The members, one run each.
    pub beliefs: Vec<Belief>,
    /// The axis of each member; none where it is that of the study.
    pub axes: Vec<Drawn>,
}

/// An axis as it may be, as far as its identification tells.
#[derive(Clone)]
pub struct Drawn {
    /// Its law and mass.
    pub axis: Belief,
    /// Forces that its law does not have.
    pub beside: Unmodelled,
}

/// Axes that a promise is drawn from: the least and the largest but one of 32 leave out 5 % at each end.
pub const PROMISE_DRAWS: u64 = 32;
/// Makes the forces beside the law independent of its parameters.
const REMAINING_SEED: u64 = 0x7072_6f6d_6973_6564;
/// Least level of friction that is drawn, as a part of that of the law.
const LEAST_LEVEL: f64 = 0.05;

/// Draws that fit no law are drawn again, at most this many times for each one asked for.
const MOST_TRIES: u64 = 1000;

/// Largest standard deviation of a drawn parameter, as a part of its value, dimensionless: a choice; a larger one
/// says nothing.
const MOST_SPREAD: f64 = 1e6;

/// Why nothing can be drawn.
#[derive(Debug)]
pub(super) struct Undrawn {
    /// The key of the model file; `None` for a known axis, which has no file.
    pub key: Option<String>,
    /// In words.
    pub found: String,
}

impl Family {
    /// The parameters of the axis itself.
    pub fn exact(truth: Belief) -> Self {
        Family {
            kind: "exact",
            name: "exact".into(),
            beliefs: vec![truth],
            axes: Vec::new(),
        }
    }

    /// An axis that was moved away from its model, which the compensator keeps.
    pub fn moved(model: Belief, axis: Belief) -> Self {
        Family {
            kind: "moved",
            name: "moved".into(),
            beliefs: vec![model],
            axes: vec![Drawn {
                axis,
                beside: Unmodelled::default(),
            }],
        }
    }

    /// All 64 sets in which each of sigma0, sigma1, sigma2, Fc, Fs, vs is too small or too large by the part `by`.
    pub fn corners(truth: Belief, by: f64) -> Self {
        let beliefs = truth.law.corners(by).into_iter();
        let beliefs = beliefs.map(|law| Belief { law, ..truth });
        Family {
            kind: "corners",
            name: format!("±{} %", percent(by)),
            beliefs: beliefs.collect(),
            axes: Vec::new(),
        }
    }

    /// Parameters drawn from the normal distribution of the estimate, cut to what a law can have, with sigma1 capped or
    /// constant as `truth` has it. `mass` is the one to believe where the covariance knows none.
    ///
    /// `Err` says why nothing can be drawn.
    pub(super) fn draws(
        model: &Model,
        truth: Belief,
        mass: Option<f64>,
        count: u64,
        seed: u64,
    ) -> Result<Self, Undrawn> {
        let Some(covariance) = &model.covariance else {
            return Err(Undrawn {
                key: None,
                found: "a known axis has no covariance".into(),
            });
        };
        let refused = |key: &str, found: &str| {
            Err(Undrawn {
                key: Some(key.into()),
                found: found.into(),
            })
        };
        let varies = (0..covariance.names.len()).any(|i| covariance.matrix[i][i] > 0.0);
        if !varies {
            return refused("covariance.names", "the covariance knows of no error");
        }
        determined(model, covariance)?;
        let spread = Spread::of(covariance)?;
        let names: Vec<Option<Name>> = covariance.names.iter().map(|n| n.parse().ok()).collect();
        let exact = model.values();
        let mut noise = Noise::new(seed);
        let mut beliefs = Vec::new();
        let mut tries = 0;
        while (beliefs.len() as u64) < count {
            if tries == MOST_TRIES * count {
                return refused("covariance.matrix", "hardly a draw from it is a law");
            }
            tries += 1;
            let off = spread.draw(&mut noise);
            let mut values = exact.clone();
            for (name, off) in names.iter().zip(&off) {
                if let Some((name, x)) = name.and_then(|n| Some((n, exact.get(n)?))) {
                    values.insert(name, x + off);
                }
            }
            let Ok(law) = law_of(&values, truth.law.damping()) else {
                continue;
            };
            let Some(mass) = mass.or_else(|| values.get(Quantity::Mass)) else {
                return refused("parameter", "no mass");
            };
            if mass > 0.0 {
                beliefs.push(Belief { law, mass });
            }
        }
        Ok(Family {
            kind: "covariance",
            name: format!("{count} draws"),
            beliefs,
            axes: Vec::new(),
        })
    }

    /// The parameters that a compensator of the model has, on axes as the identification leaves them open: parameters drawn from its covariance,
    /// and beside the law forces of the size of what it leaves.
    pub(super) fn promised(
        model: &Model,
        truth: Belief,
        mass: Option<f64>,
        seed: u64,
    ) -> Result<Self, Undrawn> {
        let Some(remaining) = &model.remaining else {
            return Err(Undrawn {
                key: None,
                found: "no [remaining] says what its law leaves of the force".into(),
            });
        };
        let drawn = Family::draws(model, truth, mass, PROMISE_DRAWS, seed)?.beliefs;
        let mut noise = Noise::new(seed ^ REMAINING_SEED);
        let axes = drawn
            .into_iter()
            .map(|axis| beside(axis, remaining, &mut noise));
        Ok(Family {
            kind: "promised",
            name: "promised".into(),
            beliefs: vec![supported(model, truth); PROMISE_DRAWS as usize],
            axes: axes.collect(),
        })
    }
}

/// What a compensator of a model is made of.
fn supported(model: &Model, truth: Belief) -> Belief {
    let law = model
        .supported
        .as_ref()
        .and_then(|values| law_of(values, truth.law.damping()).ok());
    Belief {
        law: law.unwrap_or(truth.law),
        ..truth
    }
}

/// An axis with forces of that size.
fn beside(axis: Belief, remaining: &RemainingEntry, noise: &mut Noise) -> Drawn {
    let curve = axis.law.curve();
    let mut level = |side: &Direction<f64>| {
        let factor = (1.0 + remaining.level * noise.normal()).max(LEAST_LEVEL);
        Direction {
            coulomb: factor * side.coulomb,
            static_friction: factor * side.static_friction,
            viscous: factor * side.viscous,
            ..*side
        }
    };
    let sides = [level(curve.positive()), level(curve.negative())];
    let curve = Stribeck::new(curve.shape(), sides[0], sides[1], curve.offset());
    let law = curve.and_then(|curve| axis.law.with_curve(curve));
    let shapes = remaining.shapes.iter().map(|shape| Shape {
        force: shape.force * noise.normal(),
        short: shape.short,
        long: shape.long,
    });
    let shapes = shapes.collect();
    // Two waves of about that length.
    let waves = [0, 1].map(|_| Wave {
        force: remaining.place * noise.normal(),
        length: remaining.place_length * libm::exp(0.5 * noise.normal()),
        phase: std::f64::consts::TAU * noise.uniform(),
    });
    let wandering = (remaining.wandering > 0.0).then(|| Wandering {
        force: remaining.wandering,
        memory: remaining.memory,
        seed: (noise.uniform() * (1u64 << 53) as f64) as u64,
    });
    Drawn {
        axis: Belief {
            law: law.unwrap_or(axis.law),
            ..axis
        },
        beside: Unmodelled {
            shapes,
            waves: waves.into(),
            wandering,
        },
    }
}

/// A part below 1 in percent, in few digits, or in full where few digits would give 100.
fn percent(by: f64) -> String {
    match stiction_number::short(100.0 * by) {
        rounded if rounded == "100" => stiction_number::shortest(100.0 * by),
        rounded => rounded,
    }
}

/// The law of parameters, its sigma1 constant or capped as `form` is.
pub(super) fn law_of(
    values: &ParameterSet,
    form: Option<Damping<f64>>,
) -> Result<AxisLaw, LawError> {
    let law = axis_law(values)?;
    Ok(law.damped_as(|sigma1| match form {
        Some(Damping::Constant(_)) => Damping::Constant(sigma1),
        _ => Damping::Capped(sigma1),
    })?)
}

/// Refuses a variance that makes nearly every draw absurd, as of a parameter that the data did not determine. The
/// scale for an offset near 0 is the Coulomb friction, for a damping near 0 the Coulomb friction over the Stribeck
/// velocity.
fn determined(model: &Model, covariance: &CovarianceEntry) -> Result<(), Undrawn> {
    let values = model.values();
    let of = |quantity| values.on(quantity, Side::Positive).map_or(0.0, f64::abs);
    let damping = match of(Quantity::StribeckVelocity) {
        0.0 => f64::INFINITY,
        speed => of(Quantity::Coulomb) / speed,
    };
    for (i, name) in covariance.names.iter().enumerate() {
        let Ok(parameter) = name.parse::<Name>() else {
            continue;
        };
        let value = values.get(parameter).map_or(0.0, f64::abs);
        let size = match parameter.quantity {
            Quantity::Sigma0
            | Quantity::Coulomb
            | Quantity::Static
            | Quantity::StribeckVelocity
            | Quantity::StribeckExponent
            | Quantity::Mass => value,
            Quantity::Sigma1 | Quantity::Sigma2 => value.max(damping),
            Quantity::Offset => value.max(of(Quantity::Coulomb)),
            // Not simulated.
            _ => continue,
        };
        let std = libm::sqrt(covariance.matrix[i][i]);
        if std > MOST_SPREAD * size {
            let (value, std) = (short(value), short(std));
            return Err(Undrawn {
                key: Some(format!("covariance.matrix[{0}][{0}]", i + 1)),
                found: format!(
                    "{name} = {value} has a standard deviation of {std}: the data did not determine it"
                ),
            });
        }
    }
    Ok(())
}

/// A square root of a covariance.
struct Spread {
    lower: Vec<Vec<f64>>,
}

impl Spread {
    fn of(covariance: &CovarianceEntry) -> Result<Self, Undrawn> {
        match root(&covariance.matrix) {
            Ok(lower) => Ok(Spread { lower }),
            Err((i, j)) => Err(Undrawn {
                key: Some(format!("covariance.matrix[{}][{}]", i + 1, j + 1)),
                found: format!("no covariance, seen at {}", covariance.names[i]),
            }),
        }
    }

    fn draw(&self, noise: &mut Noise) -> Vec<f64> {
        let normal: Vec<f64> = self.lower.iter().map(|_| noise.normal()).collect();
        let row = |row: &Vec<f64>| row.iter().zip(&normal).map(|(a, b)| a * b).sum();
        self.lower.iter().map(row).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_not_rounded_to_the_whole() {
        for (by, text) in [(0.1, "10"), (0.07, "7"), (1e-5, "0.001"), (0.9999, "99.99")] {
            assert_eq!(percent(by), text);
        }
        assert!(percent(0.999_999_999_999_999).starts_with("99.9999"));
    }

    /// The draws have the covariance that was asked for, a parameter tied to another stays tied, and one without
    /// variance stays where it is.
    #[test]
    fn draws_have_the_covariance() {
        let matrix = vec![
            vec![4.0, 1.0, 0.0, 8.0],
            vec![1.0, 9.0, 0.0, 2.0],
            vec![0.0, 0.0, 0.0, 0.0],
            vec![8.0, 2.0, 0.0, 16.0],
        ];
        let covariance = CovarianceEntry {
            names: ["a", "b", "c", "d"].map(String::from).to_vec(),
            matrix: matrix.clone(),
        };
        let spread = Spread::of(&covariance).unwrap();
        let mut noise = Noise::new(1);
        let n = 40_000;
        let all: Vec<Vec<f64>> = (0..n).map(|_| spread.draw(&mut noise)).collect();
        for i in 0..4 {
            for j in 0..4 {
                let found = all.iter().map(|x| x[i] * x[j]).sum::<f64>() / f64::from(n);
                // Five standard errors of a covariance.
                let allowed = 5.0
                    * ((matrix[i][i] * matrix[j][j] + matrix[i][j] * matrix[i][j]) / f64::from(n))
                        .sqrt();
                assert!((found - matrix[i][j]).abs() <= allowed, "{i} {j}: {found}");
            }
        }
        assert!(all.iter().all(|x| (x[3] - 2.0 * x[0]).abs() < 1e-12));
        let wrong = CovarianceEntry {
            names: ["a", "b"].map(String::from).to_vec(),
            matrix: vec![vec![1.0, 2.0], vec![2.0, 1.0]],
        };
        assert!(Spread::of(&wrong).is_err());
    }
}
