//! What a plan is made for: the law with its directions, and the linear terms beside it.

use crate::candidate::{Back, Candidate};
use crate::limits::Limits;
use std::f64::consts::TAU;
use stiction_parameters::{Name, Quantity, Side, Wave};

/// What an identification of the log will fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Subject {
    /// Maxwell-slip elements in the place of the bristle of LuGre; the same in both directions.
    pub elements: Option<Elements>,
    /// Whether each direction of motion has Coulomb, static and viscous friction and a Stribeck velocity of its own.
    pub asymmetric: bool,
    /// Whether a constant force is fitted beside them.
    pub offset: bool,
    /// The terms beside the law, and those that change its level.
    pub terms: Vec<Term>,
}

impl Default for Subject {
    /// Symmetric LuGre with a constant force.
    fn default() -> Self {
        Subject {
            elements: None,
            asymmetric: false,
            offset: true,
            terms: Vec::new(),
        }
    }
}

/// Maxwell-slip elements: how many, which of the two laws they are of, and what is known beside them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Elements {
    /// 1 to 10.
    pub count: usize,
    /// Whether their level falls with speed (`gms`) or not (`maxwell-slip`).
    pub falls: bool,
    /// Whether the delay of the force is fitted beside them, or known. Beside LuGre a plan always has it fitted.
    pub delayed: bool,
}

impl Elements {
    /// Parameters of the law: stiffness and yield deflection of each element, viscous friction, and with a fall Coulomb friction, the
    /// Stribeck velocity and the attraction.
    pub(crate) fn parameters(self) -> usize {
        2 * self.count + 1 + if self.falls { 3 } else { 0 }
    }

    /// Their names, in the order of [`Candidate::values`].
    fn names(self) -> impl Iterator<Item = Name> {
        use Quantity::{Attraction, Coulomb, ElementStiffness, ElementYield, Sigma2};
        let each = |of: fn(u32) -> Quantity| (1..=self.count as u32).map(of);
        let fall = [Coulomb, Quantity::StribeckVelocity, Attraction];
        let fall = fall.into_iter().filter(move |_| self.falls);
        let law = each(ElementStiffness).chain(each(ElementYield));
        law.chain([Sigma2]).chain(fall).map(Name::from)
    }
}

/// A linear term: `size` times a known function of the motion is added to the force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// Its parameter; one of a direction acts in that alone.
    pub name: Name,
    /// The function.
    pub shape: Shape,
    /// Largest value of the function, > 0: what the term makes there is given in parts of Coulomb friction.
    pub reach: f64,
}

/// A function of the motion. Positions count from where the axis stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A force that is a sine or cosine of the position: gravity of a joint, cogging.
    Force(Along),
    /// `v |v|`: viscous friction that grows with the square of the speed.
    Square,
    /// The level of friction grows along the stroke, from this position on, m (rad).
    Level(f64),
    /// The level of friction is a sine or cosine of the position.
    LevelWave(Along),
}

/// A sine or cosine of the position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Along {
    /// Which.
    pub wave: Wave,
    /// 2 pi over the pitch, > 0, 1/m (1/rad).
    pub rate: f64,
    /// Position of where the axis stands, m (rad).
    pub origin: f64,
}

impl Along {
    fn at(&self, position: f64) -> f64 {
        let angle = self.rate * (self.origin + position);
        match self.wave {
            Wave::Sine => libm::sin(angle),
            Wave::Cosine => libm::cos(angle),
        }
    }
}

/// Ranges that the nameplate of an axis leaves open. Of a weight, as torque over the rated one, and of cogging, as force over the
/// rated one, in equal ratios; of what friction gains at the largest speed with its square, over Coulomb friction; of what Coulomb
/// friction gains at an end of the stroke, as a part of it, and of a wave of it, in equal ratios.
const GRAVITY: [f64; 2] = [0.05, 0.4];
const COGGING: [f64; 2] = [0.002, 0.05];
const SQUARE: [f64; 2] = [-0.05, 0.8];
const LEVEL: [f64; 2] = [-0.3, 0.3];
const LEVEL_WAVE: [f64; 2] = [0.02, 0.2];
/// Factors between the directions: of Coulomb and viscous friction and Fs/Fc - 1, and of the Stribeck velocity.
const BETWEEN: f64 = 1.5;
const BETWEEN_VELOCITIES: f64 = 2.0;
/// Places in the unit cube of the other direction, and of the first term: those before are the nameplate's own.
const DIRECTION_AT: usize = 7;
const TERMS_AT: usize = 11;

impl Subject {
    /// Gravity of a joint that stands at `origin`, rad.
    pub fn gravity(origin: f64) -> [Term; 2] {
        waves(Quantity::Gravity, (1.0, origin), Shape::Force)
    }

    /// The `k`th cogging, from 1, of a pitch, m (rad), of an axis that stands at `origin`.
    pub fn cogging(k: u32, pitch: f64, origin: f64) -> [Term; 2] {
        let of = |wave| Quantity::Cogging(k, wave);
        waves(of, (TAU / pitch, origin), Shape::Force)
    }

    /// The `k`th wave of the level of friction.
    pub fn level_wave(k: u32, pitch: f64, origin: f64) -> [Term; 2] {
        let of = |wave| Quantity::CoulombPitch(k, wave);
        waves(of, (TAU / pitch, origin), Shape::LevelWave)
    }

    /// Viscous friction that grows with the square of the speed.
    pub fn square(limits: &Limits) -> Term {
        Term {
            name: Quantity::QuadraticViscous.into(),
            shape: Shape::Square,
            reach: limits.speed * limits.speed,
        }
    }

    /// Friction that changes along the stroke.
    pub fn level(limits: &Limits) -> Term {
        let [low, high] = limits.reach();
        Term {
            name: Quantity::CoulombPosition.into(),
            shape: Shape::Level(0.5 * (low + high)),
            reach: 0.5 * (high - low),
        }
    }

    /// The same with the terms that change friction for each direction.
    #[must_use]
    pub fn directed(self) -> Self {
        let each = self.terms.into_iter().flat_map(|term| {
            let of = |side| Term {
                name: Name::new(term.name.quantity, side),
                ..term
            };
            match term.shape {
                Shape::Force(_) => vec![term],
                _ => Side::all(true).iter().map(|side| of(*side)).collect(),
            }
        });
        // A sine and its cosine stay neighbours.
        let mut terms: Vec<Term> = each.collect();
        terms.sort_by_key(|term| match term.shape {
            Shape::LevelWave(_) => (1, Some((pitch_of(term), term.name.side)), term.name),
            _ => (0, None, term.name),
        });
        Subject {
            asymmetric: true,
            terms,
            ..self
        }
    }

    /// Names of all parameters, in the order of [`Candidate::values`].
    pub fn names(&self) -> Vec<String> {
        use Quantity::{Coulomb, Mass, Sigma0, Sigma1, Sigma2, Static, StribeckVelocity};
        let terms = self.terms.iter().map(|term| term.name);
        let text = |name: Name| name.to_string();
        if let Some(elements) = self.elements {
            let all = elements.names().chain([Mass.into()]).chain(terms);
            return all.map(text).collect();
        }
        let sides = Side::all(self.asymmetric);
        let directed = [Sigma2, Coulomb, Static, StribeckVelocity];
        let directed = directed
            .iter()
            .flat_map(|q| sides.iter().map(|side| Name::new(*q, *side)));
        let law = [Sigma0, Sigma1].map(Name::from).into_iter().chain(directed);
        let all = law.chain([Mass.into()]);
        all.chain(terms).map(text).collect()
    }

    /// How many parameters there are.
    pub fn parameters(&self) -> usize {
        self.first_term() + self.terms.len()
    }

    /// Place of the first term among the parameters.
    pub fn first_term(&self) -> usize {
        match (self.elements, self.asymmetric) {
            (Some(elements), _) => elements.parameters() + 1,
            (None, true) => 11,
            (None, false) => 7,
        }
    }

    /// Whether the axis has to go to several places of its stroke.
    pub fn has_places(&self) -> bool {
        let mut terms = self.terms.iter();
        terms.any(|term| term.shape != Shape::Square)
    }

    /// Whether the level of friction depends on the position.
    pub(crate) fn has_levels(&self) -> bool {
        let mut terms = self.terms.iter();
        terms.any(|term| matches!(term.shape, Shape::Level(_) | Shape::LevelWave(_)))
    }

    /// An axis that the nameplate allows, with the other direction and the terms that it allows beside it. `unit` is its place in the
    /// unit cube.
    #[must_use]
    pub fn dress(
        &self,
        axis: Candidate,
        limits: &Limits,
        unit: impl Fn(usize) -> f64,
    ) -> Candidate {
        let factor = |at: usize, by: f64| libm::pow(by, 2.0 * unit(at) - 1.0);
        let back = self.asymmetric.then(|| {
            let coulomb = axis.coulomb * factor(DIRECTION_AT, BETWEEN);
            let excess = axis.excess() * factor(DIRECTION_AT + 1, BETWEEN);
            Back {
                sigma2: axis.sigma2 * factor(DIRECTION_AT + 2, BETWEEN),
                coulomb,
                static_friction: coulomb * (1.0 + excess),
                stribeck_velocity: axis.stribeck_velocity
                    * factor(DIRECTION_AT + 3, BETWEEN_VELOCITIES),
            }
        });
        let mut sizes = vec![0.0; self.terms.len()];
        for (i, term) in self.terms.iter().enumerate() {
            let unit = |more: usize| unit(TERMS_AT + i + more);
            let between = |[low, high]: [f64; 2]| low + (high - low) * unit(0);
            let coulomb = match (&back, term.name.side) {
                (Some(back), Side::Negative) => back.coulomb,
                _ => axis.coulomb,
            };
            let size = term.range(limits, coulomb);
            match term.wave() {
                Some(Wave::Sine) => {
                    let amplitude = size[0] * libm::pow(size[1] / size[0], unit(0));
                    let phase = TAU * unit(1);
                    sizes[i] = amplitude * libm::cos(phase);
                    if let Some(cosine) = sizes.get_mut(i + 1) {
                        *cosine = amplitude * libm::sin(phase);
                    }
                }
                Some(Wave::Cosine) => {}
                None => sizes[i] = between(size),
            }
        }
        Candidate {
            back,
            sizes,
            subject: self.clone(),
            ..axis
        }
    }

    /// What [`dress`](Self::dress) draws the other direction from, as text for people: name and range.
    pub fn direction_ranges(&self) -> Vec<(String, [f64; 2])> {
        if !self.asymmetric {
            return Vec::new();
        }
        let wide = [1.0 / BETWEEN, BETWEEN];
        let between = |name: &str, range| (format!("{name}_neg over {name}_pos"), range);
        let wider = [1.0 / BETWEEN_VELOCITIES, BETWEEN_VELOCITIES];
        vec![
            between("coulomb", wide),
            ("static over coulomb - 1, _neg over _pos".into(), wide),
            between("sigma2", wide),
            between("stribeck_velocity", wider),
        ]
    }

    /// The same of a term; none of a cosine, whose amplitude is that of its sine.
    pub fn term_range(&self, term: usize, limits: &Limits) -> Option<(String, [f64; 2])> {
        let term = self.terms.get(term)?;
        let name = term.name.to_string();
        match (term.wave(), term.shape) {
            (Some(Wave::Cosine), _) => None,
            (Some(Wave::Sine), Shape::Force(_)) => {
                let both = name.replace("_sin", ", amplitude");
                Some((both, term.range(limits, 1.0)))
            }
            (Some(Wave::Sine), _) => {
                let both = name.replace("_sin", "");
                let range = term.range(limits, 1.0);
                Some((format!("{both}, amplitude over coulomb"), range))
            }
            (None, _) => {
                let range = term.range(limits, 1.0).map(|size| size * term.reach);
                Some((format!("{name} at its most over coulomb"), range))
            }
        }
    }
}

impl Term {
    /// Which part of a wave it is.
    pub fn wave(&self) -> Option<Wave> {
        match self.shape {
            Shape::Force(along) | Shape::LevelWave(along) => Some(along.wave),
            Shape::Square | Shape::Level(_) => None,
        }
    }

    /// Least and largest size that the nameplate leaves open, of a wave least and largest amplitude.
    fn range(&self, limits: &Limits, coulomb: f64) -> [f64; 2] {
        match (self.shape, self.name.quantity) {
            (Shape::Force(_), Quantity::Gravity(_)) => {
                GRAVITY.map(|part| part * limits.rated_force)
            }
            (Shape::Force(_), _) => COGGING.map(|part| part * limits.rated_force),
            (Shape::Square, _) => SQUARE.map(|part| part * coulomb / self.reach),
            (Shape::Level(_), _) => LEVEL.map(|part| part * coulomb / self.reach),
            (Shape::LevelWave(_), _) => LEVEL_WAVE.map(|part| part * coulomb),
        }
    }

    /// The function where the bristles are bent by `eta`, the axis is at `position`, m (rad), and moves at `velocity`, m/s (rad/s).
    /// Levels are in units of the Coulomb level of their direction.
    pub(crate) fn at(&self, eta: f64, position: f64, velocity: f64) -> f64 {
        let acts = |x: f64| match self.name.side {
            Side::Both => true,
            Side::Positive => x > 0.0,
            Side::Negative => x < 0.0,
        };
        match self.shape {
            Shape::Force(along) => along.at(position),
            Shape::Square if acts(velocity) => velocity * velocity.abs(),
            Shape::Level(_) | Shape::LevelWave(_) if acts(eta) => eta * self.factor(position),
            _ => 0.0,
        }
    }

    /// What multiplies the level; 0 of a term that does not change it.
    pub(crate) fn factor(&self, position: f64) -> f64 {
        match self.shape {
            Shape::Level(middle) => position - middle,
            Shape::LevelWave(along) => along.at(position),
            Shape::Force(_) | Shape::Square => 0.0,
        }
    }

    /// Whether it changes the level of friction.
    pub(crate) fn is_level(&self) -> bool {
        matches!(self.shape, Shape::Level(_) | Shape::LevelWave(_))
    }
}

fn pitch_of(term: &Term) -> u32 {
    match term.name.quantity {
        Quantity::CoulombPitch(k, _) => k,
        _ => 0,
    }
}

fn waves(
    of: impl Fn(Wave) -> Quantity,
    (rate, origin): (f64, f64),
    shape: impl Fn(Along) -> Shape,
) -> [Term; 2] {
    [Wave::Sine, Wave::Cosine].map(|wave| Term {
        name: of(wave).into(),
        shape: shape(Along { wave, rate, origin }),
        reach: 1.0,
    })
}
