//! An axis that changes while it runs, and what is found of it: the load that is estimated, the level that is adapted.

use serde::{Deserialize, Serialize};
use stiction_files::study::{Belief, Event, Machine, ModelScheme, Scheme, Study};
use stiction_friction::ParamError;
use stiction_search::bits;
use stiction_servo::axis::{Axis, Correction, Sample};
use stiction_servo::integrator::Integrator;
use stiction_servo::law::{AxisLaw, OfAxis};
use stiction_servo::load::{LoadEstimator, LoadSettings};
use stiction_servo::path::Reference;

/// Most points of a course that are kept.
const MOST_POINTS_KEPT: usize = 1000;

/// The load of an axis over a run, from its beginning, and what was found of it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LoadCourse {
    /// s
    #[serde(with = "bits")]
    pub time: Vec<f64>,
    /// kg (kg m^2)
    #[serde(with = "bits")]
    pub mass: Vec<f64>,
    /// Factor on the friction of the law.
    #[serde(with = "bits")]
    pub level: Vec<f64>,
    /// The mass that is estimated; empty where none is.
    #[serde(with = "bits")]
    pub found_mass: Vec<f64>,
    /// The level that is estimated or adapted; empty where neither is.
    #[serde(with = "bits")]
    pub found_level: Vec<f64>,
    /// How long the load estimate learnt, s; `None` where there is none.
    #[serde(with = "bits")]
    pub learning_time: Option<f64>,
}

impl LoadCourse {
    /// Whether it has a value of each signal at each time.
    pub(super) fn is_whole(&self) -> bool {
        let known = [&self.mass, &self.level];
        let found = [&self.found_mass, &self.found_level];
        let all = |s: &&Vec<f64>| s.len() == self.time.len();
        known.iter().all(all) && found.iter().all(|s| s.is_empty() || all(s))
    }
}

/// What moves an axis by a period, given its reference and the velocity ahead.
pub(super) type Step<'a, L, I> = &'a mut dyn FnMut(&mut Axis<L, I>, Reference, f64) -> Sample;

/// What changes in a run and is looked for.
pub(super) struct Changing<'a> {
    events: &'a [Event],
    machine: &'a Machine,
    /// The axis itself.
    axis: Belief,
    belief: Belief,
    /// Part of the mass that is fed forward, where the load is estimated.
    estimates: Option<f64>,
    adapts: bool,
}

impl<'a> Changing<'a> {
    /// `None` where nothing changes and nothing is looked for. `fed` is the mass that the controller feeds forward.
    pub fn of(
        study: &'a Study,
        scheme: &Scheme,
        axis: Belief,
        belief: Belief,
        fed: f64,
    ) -> Option<Self> {
        let model = |test: fn(&ModelScheme) -> bool| match scheme {
            Scheme::Model(model) => test(model),
            _ => false,
        };
        let changing = Changing {
            events: &study.events,
            machine: &study.machine,
            axis,
            belief,
            estimates: model(|m| m.load_estimate).then_some(fed / belief.mass),
            adapts: model(|m| m.adaptation.is_some()),
        };
        let any = !study.events.is_empty() || changing.estimates.is_some() || changing.adapts;
        any.then_some(changing)
    }

    /// Runs the axis over the references, each with the velocity ahead.
    pub fn follow<L: OfAxis, I: Integrator<L>>(
        &self,
        axis: &mut Axis<L, I>,
        references: impl ExactSizeIterator<Item = (Reference, f64)>,
    ) -> Result<(Vec<Sample>, LoadCourse), ParamError> {
        self.follow_by(axis, references, &mut |axis, now, ahead| {
            axis.step(now, ahead, Correction::default())
        })
    }

    /// The same with a step of the caller's.
    pub fn follow_by<L: OfAxis, I: Integrator<L>>(
        &self,
        axis: &mut Axis<L, I>,
        references: impl ExactSizeIterator<Item = (Reference, f64)>,
        step: Step<L, I>,
    ) -> Result<(Vec<Sample>, LoadCourse), ParamError> {
        let machine = self.machine;
        let mut estimator = match self.estimates {
            Some(share) => {
                let (law, mass) = (of::<L>(&self.belief.law)?, self.belief.mass);
                let settings = LoadSettings::default();
                let made = LoadEstimator::new(law, mass, machine.drive, machine.rate, settings)?;
                Some((made, share))
            }
            None => None,
        };
        let mut events = self.events.iter().peekable();
        let (mut mass, mut level) = (self.axis.mass, 1.0);
        let thin = references.len().div_ceil(MOST_POINTS_KEPT).max(1);
        let mut samples = Vec::with_capacity(references.len());
        let mut course = LoadCourse::default();
        for (k, (now, ahead)) in references.enumerate() {
            let time = k as f64 / machine.rate;
            while let Some(event) = events.next_if(|event| event.time <= time) {
                if let Some(new) = event.mass {
                    mass = new;
                    axis.set_mass(mass)?;
                }
                if let Some(new) = event.friction {
                    level = new;
                    axis.set_law(of(&self.axis.law.scaled(level)?)?);
                }
            }
            let sample = step(axis, now, ahead);
            if let Some((estimator, share)) = &mut estimator {
                let load = estimator.sample(sample.measured, sample.command);
                axis.set_mass_feedforward(*share * load.mass)?;
                axis.set_friction_level(load.level);
            }
            samples.push(sample);
            if k % thin != 0 {
                continue;
            }
            course.time.push(time);
            course.mass.push(mass);
            course.level.push(level);
            if let Some((estimator, _)) = &estimator {
                course.found_mass.push(estimator.load().mass);
                course.found_level.push(estimator.load().level);
            } else if self.adapts
                && let Some(compensator) = axis.feedforward().compensator()
            {
                let learnt = &compensator.state().learnt;
                course.found_level.push(learnt.level);
                course.found_mass.push(learnt.mass);
            }
        }
        course.learning_time = estimator.map(|(estimator, _)| estimator.learning_time());
        Ok((samples, course))
    }
}

/// A law as the type that the axis is made of.
fn of<L: OfAxis>(law: &AxisLaw) -> Result<L, ParamError> {
    L::of(law).ok_or_else(|| ParamError::new("law", f64::NAN, "that of the model"))
}
