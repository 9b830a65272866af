//! What a model has beside its law: what friction depends on, and what is fed forward beside it.

use crate::error::Error;
use std::f64::consts::TAU;
use stiction_files::ModelFile;
use stiction_files::model::ReadModel;
use stiction_files::model::dependences::{pitch, put, together, wave};
use stiction_friction::compensator::{
    Channel, Channels, Friction, Settings, Terms, WAVES, Wave, Weight,
};
use stiction_parameters::{Name, Quantity};

/// What is fed forward beside friction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Feedforward {
    /// Mass times the acceleration of the reference.
    pub mass: bool,
    /// The weight: the constant force of the law, and on a rotary axis sine and cosine of its angle.
    pub gravity: bool,
    /// Waves of the force along the position.
    pub cogging: bool,
    /// Gravity, inertia and Coriolis forces of the rigid body of a robot.
    pub rigid: bool,
}

/// The names of all that can be fed forward beside friction, in their order.
const BESIDE: [&str; 4] = ["mass", "gravity", "cogging", "rigid"];

impl Feedforward {
    /// All that can be fed forward.
    pub fn all() -> Self {
        Self {
            mass: true,
            gravity: true,
            cogging: true,
            rigid: true,
        }
    }

    /// From the names of its parts, of which one is `friction`.
    ///
    /// # Errors
    /// A name that is none, or where friction is not among them.
    pub fn from_names<'a>(names: impl IntoIterator<Item = &'a str>) -> Result<Self, Error> {
        let mut feedforward = Self::default();
        let mut friction = false;
        for name in names {
            match name.trim() {
                "friction" => friction = true,
                "mass" => feedforward.mass = true,
                "gravity" => feedforward.gravity = true,
                "cogging" => feedforward.cogging = true,
                "rigid" => feedforward.rigid = true,
                other => {
                    let short: String = other.chars().take(60).collect();
                    return Err(Error::usage(
                        format!("a feedforward of {short:?}"),
                        "friction, and of mass, gravity and cogging what the model has, or rigid for a robot",
                    ));
                }
            }
        }
        match friction {
            true => Ok(feedforward),
            false => Err(Error::NotFed {
                found: "a feedforward without friction: the block is that of friction, which everything else stands beside".into(),
                instead: feedforward.names(),
            }),
        }
    }

    /// The names of its parts.
    pub fn names(self) -> Vec<&'static str> {
        let own = [self.mass, self.gravity, self.cogging, self.rigid];
        let beside = BESIDE.into_iter().zip(own).filter(|(_, own)| *own);
        let beside = beside.map(|(name, _)| name);
        std::iter::once("friction").chain(beside).collect()
    }
}

/// What a compensator takes of a model beside its law.
pub(super) struct Beside {
    pub terms: Terms<f64>,
    /// The law; beside a weight without its offset.
    pub friction: Friction<f64>,
    /// The parameters that are in the terms.
    pub taken: Vec<String>,
    /// The lines that would bring in what is left at its reference, such as `[range] temperature = [290.0, 310.0]`.
    pub lacking: Vec<&'static str>,
    /// Largest force of mass, weight and cogging within what the log has seen; `None` where that is not known.
    largest: Option<f64>,
}

/// What a model has, with the law that its code gets. `fed` is what is asked for beside friction.
pub(super) fn beside(
    read: &ReadModel,
    friction: Friction<f64>,
    fed: Feedforward,
) -> Result<Beside, Error> {
    let file = &read.model;
    let depends = file.dependences(friction.coulomb());
    let mut found = Beside {
        terms: Terms {
            channels: depends.channels,
            levels: depends.levels,
            ..Terms::default()
        },
        friction,
        taken: depends.taken,
        lacking: depends.lacking,
        largest: Some(0.0),
    };
    feed(file, fed, &mut found)?;
    Ok(found)
}

impl Beside {
    /// Settings whose limit has room for the terms, from those for the law.
    pub fn settings(&self, of_law: Settings<f64>, friction: &Friction<f64>) -> Settings<f64> {
        let levels = self.terms.levels.map(|l| l.largest(&self.terms.channels));
        let more =
            2.0 * friction.scale() * (levels.unwrap_or(1.0) - 1.0) + self.largest.unwrap_or(0.0);
        match more > 0.0 {
            true => of_law.reaching(of_law.limit + more),
            false => of_law,
        }
    }

    /// Whether a limit follows from the model.
    pub fn has_limit(&self) -> bool {
        self.largest.is_some()
    }
}

/// What is asked for beside friction.
fn feed(file: &ModelFile, fed: Feedforward, found: &mut Beside) -> Result<(), Error> {
    let place = file.place();
    let mut able = fed;
    let mut why = Vec::new();
    let mut largest = Some(0.0);
    if fed.mass {
        match super::known_mass(file) {
            Some(mass) => {
                found.terms.mass = mass;
                found.taken.push("mass".into());
                let top = file.range.acceleration;
                largest = top.map(|a| mass * a);
            }
            None => {
                able.mass = false;
                why.push("the model has no mass that the log determines".to_string());
            }
        }
    }
    if fed.gravity {
        match weight(file, &found.friction, place) {
            Ok((weight, taken)) => {
                if weight.wave.rate > 0.0 {
                    found.terms.channels.position = place.unwrap_or_default();
                }
                found.terms.weight = Some(weight);
                found.friction = found
                    .friction
                    .without_offset()
                    .map_err(|e| Error::usage(format!("{} = {}", e.name, e.value), e.allowed))?;
                found.taken.extend(taken);
            }
            Err(reason) => {
                able.gravity = false;
                why.push(reason);
            }
        }
    }
    if fed.cogging {
        match cogging(file, place) {
            Ok((waves, taken)) => {
                found.terms.channels.position = place.unwrap_or_default();
                found.terms.cogging = waves;
                found.taken.extend(taken);
            }
            Err(reason) => {
                able.cogging = false;
                why.push(reason);
            }
        }
    }
    why.dedup();
    // The constant part of the weight is in the limit of the law.
    let constant = found.terms.weight.map_or(0.0, |w| w.constant.abs());
    found.largest = largest.map(|mass| mass + found.terms.largest_beside() - constant);
    match why.is_empty() {
        true => Ok(()),
        false => Err(Error::NotFed {
            found: why.join("; "),
            instead: able.names(),
        }),
    }
}

/// The cogging of a model alone, for a map of it.
pub(super) fn of_cogging(file: &ModelFile) -> Result<Terms<f64>, Error> {
    let place = file.place();
    let (cogging, _) = cogging(file, place).map_err(|reason| Error::NoMap {
        target: "cogging-map",
        reason,
    })?;
    Ok(Terms {
        channels: Channels {
            position: place.unwrap_or_default(),
            ..Channels::default()
        },
        cogging,
        ..Terms::default()
    })
}

/// Waves with the parameters that they are made of.
type Waves = ([Wave<f64>; WAVES], Vec<String>);

fn cogging(file: &ModelFile, place: Option<Channel<f64>>) -> Result<Waves, String> {
    let mut waves = [Wave::default(); WAVES];
    let mut taken = Vec::new();
    for p in &file.parameter {
        let Ok(name) = p.name.parse::<Name>() else {
            continue;
        };
        let Quantity::Cogging(k, part) = name.quantity else {
            continue;
        };
        if file.leaves_open(name) {
            return Err(format!("the log leaves {} open", p.name));
        }
        let Some(pitch) = pitch(&file.pitch.cogging, k) else {
            return Err(format!(
                "the model has no pitch of its cogging: add [pitch] cogging = [PITCH] in {}",
                length_unit(file)
            ));
        };
        let range = place
            .map(|place| place.range)
            .ok_or_else(|| no_range(file))?;
        let at = &mut waves[k as usize - 1];
        if at.rate == 0.0 {
            *at = wave(pitch, range);
        }
        put(at, part, p.value);
        taken.push(p.name.clone());
    }
    match taken.is_empty() {
        true => Err(
            "the model has no cogging: name its pitch in the axis file, [terms] cogging = [\"24 mm\"], and identify again"
                .into(),
        ),
        false => Ok((together(waves), taken)),
    }
}

fn weight(
    file: &ModelFile,
    friction: &Friction<f64>,
    place: Option<Channel<f64>>,
) -> Result<(Weight<f64>, Vec<String>), String> {
    let constant = friction.offset();
    let mut weight = Weight {
        constant,
        ..Weight::default()
    };
    let mut taken = Vec::new();
    for p in &file.parameter {
        let Ok(name) = p.name.parse::<Name>() else {
            continue;
        };
        let Quantity::Gravity(part) = name.quantity else {
            continue;
        };
        if file.leaves_open(name) {
            return Err(format!("the log leaves {} open", p.name));
        }
        let range = place
            .map(|place| place.range)
            .ok_or_else(|| no_range(file))?;
        if weight.wave.rate == 0.0 {
            weight.wave = Wave {
                rate: 1.0,
                ..wave(TAU, range)
            };
        }
        put(&mut weight.wave, part, p.value);
        taken.push(p.name.clone());
    }
    if taken.is_empty() && constant == 0.0 {
        return Err(match file.kind.as_str() {
            "rotary" => "the model has no gravity: [terms] gravity = true in the axis file, and identify again",
            _ => "the model has no constant force, which on a linear axis is its weight",
        }
        .into());
    }
    Ok((weight, taken))
}

fn no_range(file: &ModelFile) -> String {
    format!(
        "the model does not say over which positions it holds: add [range] position = [LEAST, LARGEST] in {}",
        length_unit(file)
    )
}

pub(super) fn length_unit(file: &ModelFile) -> &'static str {
    match file.kind.as_str() {
        "rotary" => "rad",
        _ => "m",
    }
}
