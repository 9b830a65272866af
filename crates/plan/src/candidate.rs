//! An axis that may be the one to be measured.

use crate::slip::Slip;
use crate::subject::Subject;
use stiction_friction::{Damping, Direction, LuGre, ParamError, Shape, Stribeck};
use stiction_parameters::Side;

/// Parameters of LuGre with the Gaussian curve, the same in both directions, and the mass.
pub const PARAMETERS: usize = 7;
/// Their names.
pub const NAMES: [&str; PARAMETERS] = [
    "sigma0",
    "sigma1",
    "sigma2",
    "coulomb",
    "static",
    "stribeck_velocity",
    "mass",
];

/// An axis with its friction; all > 0, Fs above Fc. Where the directions differ these are the parameters of the positive one. Of
/// Maxwell-slip elements sigma0 and Fs are sums over them and sigma1 is 0; without a fall of the level Fs is Fc.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// N/m (N m/rad)
    pub sigma0: f64,
    /// N s/m (N m s/rad)
    pub sigma1: f64,
    /// N s/m (N m s/rad)
    pub sigma2: f64,
    /// N (N m)
    pub coulomb: f64,
    /// N (N m)
    pub static_friction: f64,
    /// m/s (rad/s)
    pub stribeck_velocity: f64,
    /// kg (kg m^2)
    pub mass: f64,
    /// The negative direction where it differs.
    pub back: Option<Back>,
    /// Maxwell-slip elements in the place of a bristle.
    pub slip: Option<Slip>,
    /// Sizes of the terms of the subject, SI.
    pub sizes: Vec<f64>,
    /// What an identification of its log will fit.
    pub subject: Subject,
}

/// What differs in the negative direction; all > 0, Fs above Fc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Back {
    /// N s/m (N m s/rad)
    pub sigma2: f64,
    /// N (N m)
    pub coulomb: f64,
    /// N (N m)
    pub static_friction: f64,
    /// m/s (rad/s)
    pub stribeck_velocity: f64,
}

impl Candidate {
    /// Symmetric LuGre without terms beside it, from the values in the order of [`NAMES`].
    pub fn from_values(values: [f64; PARAMETERS]) -> Self {
        let [
            sigma0,
            sigma1,
            sigma2,
            coulomb,
            static_friction,
            stribeck_velocity,
            mass,
        ] = values;
        Candidate {
            sigma0,
            sigma1,
            sigma2,
            coulomb,
            static_friction,
            stribeck_velocity,
            mass,
            back: None,
            slip: None,
            sizes: Vec::new(),
            subject: Subject::default(),
        }
    }

    /// From values in the order of [`Subject::names`], as many as those are.
    pub fn of(subject: &Subject, values: &[f64]) -> Option<Self> {
        let (law, sizes) = values.split_at_checked(subject.first_term())?;
        if sizes.len() != subject.terms.len() {
            return None;
        }
        if let Some(elements) = subject.elements {
            return Some(Candidate {
                sizes: sizes.to_vec(),
                subject: subject.clone(),
                ..Slip::axis(elements, law)?
            });
        }
        let (plain, back) = match *law {
            [s0, s1, s2, fc, fs, vs, mass] => ([s0, s1, s2, fc, fs, vs, mass], None),
            [
                s0,
                s1,
                s2,
                s2_back,
                fc,
                fc_back,
                fs,
                fs_back,
                vs,
                vs_back,
                mass,
            ] => {
                let back = Back {
                    sigma2: s2_back,
                    coulomb: fc_back,
                    static_friction: fs_back,
                    stribeck_velocity: vs_back,
                };
                ([s0, s1, s2, fc, fs, vs, mass], Some(back))
            }
            _ => return None,
        };
        Some(Candidate {
            back,
            sizes: sizes.to_vec(),
            subject: subject.clone(),
            ..Candidate::from_values(plain)
        })
    }

    /// In the order of [`Subject::names`].
    pub fn values(&self) -> Vec<f64> {
        if let Some(slip) = &self.slip {
            let mut out = slip.values(self);
            out.extend(&self.sizes);
            return out;
        }
        let mut out = vec![self.sigma0, self.sigma1];
        let [forward, back] = [0, 1].map(|side| self.direction(side));
        let each = |d: &Back| [d.sigma2, d.coulomb, d.static_friction, d.stribeck_velocity];
        for (forward, back) in each(&forward).into_iter().zip(each(&back)) {
            out.push(forward);
            if self.back.is_some() {
                out.push(back);
            }
        }
        out.push(self.mass);
        out.extend(&self.sizes);
        out
    }

    /// What differs between the directions: of the positive (0) or negative one (1).
    pub fn direction(&self, side: usize) -> Back {
        match self.back {
            Some(back) if side == 1 => back,
            _ => Back {
                sigma2: self.sigma2,
                coulomb: self.coulomb,
                static_friction: self.static_friction,
                stribeck_velocity: self.stribeck_velocity,
            },
        }
    }

    /// Fs/Fc - 1
    pub fn excess(&self) -> f64 {
        self.static_friction / self.coulomb - 1.0
    }

    /// What relative deviations count: of a parameter of the law or the mass its value, of a term the size that makes Coulomb
    /// friction at its most.
    pub fn units(&self) -> Vec<f64> {
        let mut out = self.values();
        out.truncate(self.subject.first_term());
        let terms = self.subject.terms.iter();
        out.extend(terms.map(|term| self.coulomb / term.reach));
        out
    }

    /// Refuses values that are no such axis.
    pub fn validate(&self) -> Result<(), ParamError> {
        if let Some(slip) = &self.slip {
            slip.validate(self)?;
            return self.has_finite_sizes();
        }
        for (name, value) in NAMES.into_iter().zip([
            self.sigma0,
            self.sigma1,
            self.sigma2,
            self.coulomb,
            self.static_friction,
            self.stribeck_velocity,
            self.mass,
        ]) {
            ParamError::positive(name, value)?;
        }
        for side in [0, 1] {
            let Back {
                sigma2,
                coulomb,
                static_friction,
                stribeck_velocity,
            } = self.direction(side);
            ParamError::positive("sigma2", sigma2)?;
            ParamError::positive("coulomb", coulomb)?;
            ParamError::positive("stribeck_velocity", stribeck_velocity)?;
            if static_friction.is_nan() || static_friction <= coulomb {
                let allowed = "above Coulomb friction";
                return Err(ParamError::new("static", static_friction, allowed));
            }
        }
        self.has_finite_sizes()?;
        self.law().map(|_| ())
    }

    fn has_finite_sizes(&self) -> Result<(), ParamError> {
        let mut sizes = self.sizes.iter();
        sizes.try_for_each(|size| ParamError::finite("term", *size))
    }

    /// Its law where that is LuGre; of Maxwell-slip elements see [`Slip::law`].
    pub fn law(&self) -> Result<LuGre<f64>, ParamError> {
        let direction = |side: usize| {
            let of = self.direction(side);
            Direction {
                coulomb: of.coulomb,
                static_friction: of.static_friction,
                stribeck_velocity: of.stribeck_velocity,
                viscous: of.sigma2,
            }
        };
        let curve = match self.back {
            None => Stribeck::symmetric(Shape::Gaussian, direction(0), 0.0)?,
            Some(_) => Stribeck::new(Shape::Gaussian, direction(0), direction(1), 0.0)?,
        };
        LuGre::new(self.sigma0, Damping::Constant(self.sigma1), curve)
    }

    /// What the terms add to the force where the bristles are bent by `eta` in units of the Coulomb level of the positive direction,
    /// at a position, m (rad), and velocity, m/s (rad/s); N (N m).
    pub(crate) fn beside(&self, eta: f64, position: f64, velocity: f64) -> f64 {
        let terms = self.subject.terms.iter().enumerate().zip(&self.sizes);
        terms
            .map(|((i, _), size)| size * self.column(i, eta, position, velocity))
            .sum()
    }

    /// The function of the term `i` there.
    pub(crate) fn column(&self, i: usize, eta: f64, position: f64, velocity: f64) -> f64 {
        let term = &self.subject.terms[i];
        let at = term.at(eta, position, velocity);
        match (self.back, term.name.side) {
            (Some(back), Side::Negative) if term.is_level() => at * self.coulomb / back.coulomb,
            _ => at,
        }
    }

    /// The factor on the level of friction, positive and negative deflection, at a position, m (rad).
    pub(crate) fn level(&self, side: usize, position: f64) -> f64 {
        let coulomb = self.direction(side).coulomb;
        let terms = self.subject.terms.iter().zip(&self.sizes);
        let own = terms.filter(|(term, _)| term.name.side.holds(side));
        let more = own.map(|(term, size)| size * term.factor(position));
        1.0 + more.sum::<f64>() / coulomb
    }
}
