//! A user's own axis in place of the stage of this project.

use super::stage::{BANDWIDTH, RATE, Stage};
use super::tune;
use crate::error::Error;
use std::f64::consts::TAU;
use std::path::PathBuf;
use stiction_files::Axis;
use stiction_files::study::Model;
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
use stiction_identify::Mass;
use stiction_log::Motion;
use stiction_parameters::{LawKind, Quantity};
use stiction_servo::drive::Drive;
use stiction_servo::encoder::Encoder;
use stiction_servo::integrator::Ode4;
use stiction_servo::known::{Kind, KnownAxis};
use stiction_servo::plant::Plant;

/// Files of an axis.
#[derive(Clone, Debug, Default)]
pub struct OwnAxis {
    /// What is known of it: `axis.toml`.
    pub axis: Option<PathBuf>,
    /// Its friction: `model.toml`, as `stiction identify` writes it.
    pub model: PathBuf,
}

/// Force limit over the static level where the axis file has none, dimensionless: as on our stage, about.
const LIMIT: f64 = 60.0;
/// Longest period of the mass on its bristles, s: presliding, and every motion that is chosen for it, lasts some of them.
const LONGEST_PERIOD: f64 = 1.0;
/// Most steps of ode4 in a control period.
const MOST_STEPS: u32 = 64;

/// Keys and tables of an axis file that change an identification and nothing here.
const UNUSED: [&str; 12] = [
    "search",
    "conditioning",
    "simulation",
    "controller",
    "terms.gravity",
    "terms.cogging",
    "terms.coulomb_load",
    "terms.delay",
    "terms.offset",
    "terms.quadratic_viscous",
    "terms.stribeck_exponent",
    "terms.gms_elements",
];

impl Stage {
    /// The axis of these files.
    pub(super) fn own(files: &OwnAxis) -> Result<Self, Error> {
        let model = Model::read(&files.model)?;
        let axis = match &files.axis {
            Some(file) => Axis::read(file)?,
            None => Axis::default(),
        };
        if model.kind != LawKind::LuGre {
            let found = format!("{:?}", model.kind.name());
            let allowed = "the experiments identify the LuGre law: identify with --law lugre";
            return Err(model.refuse("law", found, allowed).into());
        }
        let kind = match model.motion {
            Motion::Linear => Kind::Linear,
            Motion::Rotary => Kind::Rotary,
        };
        if let Some(motion) = axis.mapping.motion.filter(|m| *m != model.motion) {
            let found = format!("\"{}\"", model.motion);
            let allowed = format!("\"{motion}\", as the axis file has it");
            return Err(model.refuse("kind", found, &allowed).into());
        }
        axis.fits(model.motion, &model.motion.force().si_text(), "model")?;
        let mut notes: Vec<String> = vec![model.origin.clone()];
        notes.extend(model.warnings.iter().map(|w| w.message.clone()));
        let unused: Vec<&str> = UNUSED.into_iter().filter(|key| axis.gives(key)).collect();
        if !unused.is_empty() {
            notes.push(format!(
                "Of the axis file {} {} not used: the experiments have the searches, filters and controllers of the paper, on an \
                 axis without other forces.",
                unused.join(", "),
                if unused.len() == 1 { "is" } else { "are" }
            ));
        }
        let mass = match axis.terms.mass {
            Mass::Given(mass) => Some(mass),
            _ => model.value(Quantity::Mass),
        };
        let Some(mass) = mass.filter(|m| *m > 0.0) else {
            let found = match mass {
                Some(mass) => mass.to_string(),
                None => "no mass".into(),
            };
            let allowed = "a mass above 0: in the model, or as mass in the axis file";
            return Err(model.refuse_parameter("mass", found, allowed).into());
        };
        let read = model.values().lugre();
        let read = read
            .map_err(|e| model.refuse("parameter", e.to_string(), "every parameter of the law"))?;
        let law = symmetric(&read, &mut notes).ok_or_else(|| {
            let allowed = "above 0: the experiments need an axis that slides";
            model.refuse_parameter("coulomb", "0".into(), allowed)
        })?;
        let period = TAU * (mass / law.stiffness()).sqrt();
        if period > LONGEST_PERIOD {
            let found = stiction_number::short(mass);
            let allowed = format!(
                "a mass that swings on its bristles (sigma0) in at most {LONGEST_PERIOD} s, here in {} s",
                stiction_number::short(period)
            );
            return Err(model.refuse_parameter("mass", found, &allowed).into());
        }
        let peak = axis.mapping.force_limit;
        let peak = peak.unwrap_or(LIMIT * law.curve().largest_static_level());
        let resolution = axis.mapping.resolution.unwrap_or(0.0);
        let refused = |e: stiction_friction::ParamError| {
            let found = format!("{} = {}", e.name, stiction_number::four_digits(e.value));
            model.refuse("parameter", found, e.allowed)
        };
        let truth = KnownAxis {
            name: "own",
            source: "an axis of the user",
            kind,
            mass,
            law,
        };
        let mut stage = Stage {
            name: axis.name.clone(),
            truth,
            own: true,
            // One file describes one axis: the corner is driven by two of them.
            second: truth,
            drive: Drive {
                peak_current: peak,
                ..Drive::ideal()
            },
            encoder: Encoder::new(resolution).map_err(refused)?,
            bandwidth: BANDWIDTH,
            steps: 1,
            notes,
        };
        let plant = Plant::new(mass, law).map_err(refused)?;
        let fastest = stage.fastest();
        let stable =
            |steps: &u32| Ode4::check(&plant, 1.0 / RATE / f64::from(*steps), fastest).is_ok();
        let mut tried = (0..).map(|k| 1 << k).take_while(|n| *n <= MOST_STEPS);
        let Some(steps) = tried.find(stable) else {
            let sigma0 = stiction_number::short(law.stiffness());
            let found = format!("{sigma0} {}", stage.units().stiffness);
            let allowed = "a law with which ode4 is stable in 64 steps of each 0.1 ms: softer bristles or a lower vs";
            return Err(model.refuse_parameter("sigma0", found, allowed).into());
        };
        stage.steps = steps;
        stage.bandwidth = tune::bandwidth(&stage).map_err(refused)?;
        Ok(stage)
    }
}

/// The same in both directions, as the paper has it; none without Coulomb friction.
fn symmetric(law: &LuGre<f64>, notes: &mut Vec<String>) -> Option<LuGre<f64>> {
    let curve = law.curve();
    let [a, b] = [curve.positive(), curve.negative()];
    let mean = |of: fn(&Direction<f64>) -> f64| 0.5 * (of(a) + of(b));
    let both = Direction {
        coulomb: mean(|s| s.coulomb),
        static_friction: mean(|s| s.static_friction),
        stribeck_velocity: mean(|s| s.stribeck_velocity),
        viscous: mean(|s| s.viscous),
    };
    if a != b || curve.offset() != 0.0 {
        notes.push(
            "The law differs between the directions or has a constant force; the paper's does not: the mean of both \
             directions was taken, without the constant."
                .into(),
        );
    }
    if curve.shape() != Shape::Gaussian {
        notes.push(
            "The Stribeck exponent of the model is not 2, as in the paper; 2 was taken.".into(),
        );
    }
    if both.coulomb <= 0.0 {
        return None;
    }
    let curve = Stribeck::symmetric(Shape::Gaussian, both, 0.0).ok()?;
    LuGre::new(
        law.stiffness(),
        Damping::Constant(law.damping().at_rest()),
        curve,
    )
    .ok()
}
