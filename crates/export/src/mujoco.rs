//! MuJoCo 4: the `dcmotor` with the law's bristles, on a joint.
//!
//! MuJoCo holds the velocity over a step as stiction does, so the deflections are the same; its force is that of the
//! beginning of the step, with the deflection rate of the state equation and a constant sigma1. The self-test compares with that.

use crate::check::{CYCLE_TIMES, two_digits};
use crate::number::{Literal, short};
use crate::template::Fill;
use crate::vectors::Vectors;
use crate::{Advice, Error, File, Model, header, law};
use stiction_codes::Code;
use stiction_friction::compensator::Friction;
use stiction_friction::{Damping, LuGre, Shape};

const MODEL: &str = include_str!("../templates/mujoco/model.xml.in");
const SELFTEST: &str = include_str!("../templates/mujoco/selftest.py.in");

/// Largest error of the self-test, relative to the largest force or deflection: MuJoCo's own integration of the motion rounds
/// too.
const TOLERANCE: f64 = 1e-9;

pub(crate) fn files(model: &Model) -> Result<Vec<File>, Error> {
    let given = simple(model)?;
    if !model.in_newtons() {
        return Err(Error::ForceUnit {
            target: "mujoco",
            found: model.force_unit().into(),
            allowed: if model.rotary { "N m" } else { "N" },
        });
    }
    let constant = Damping::Constant(given.damping().at_rest());
    let lugre = given
        .with_damping(constant)
        .map_err(|e| Error::number("double", e))?;
    let vectors = Vectors::<f64>::new(model, "double")?;
    let name = &model.identifier;
    let (motor, load) = masses(model);
    let steps = Steps::of(model, &lugre);
    let step = steps.written;
    let mut fill = Fill::default();
    fill.set("name", name.clone())
        .set("v_unit", model.speed_unit())
        .set("x_unit", model.length_unit())
        .set("joint", format!("{name}_joint"))
        .set("input", "")
        .flag("offset", true)
        .set("f_unit", model.force_unit())
        .set("type", if model.rotary { "hinge" } else { "slide" })
        .set("axis", if model.rotary { "0 0 1" } else { "1 0 0" })
        .set("against", (-lugre.curve().offset()).c())
        .set("rows", rows(&lugre, &vectors, step))
        .set("force_tolerance", (TOLERANCE * vectors.scale(model)).c())
        .set("deflection_tolerance", (TOLERANCE * lugre.bound()).c());
    let width = model.backlash.map_or(0.0, |gap| gap.width);
    fill.set("timestep", step.c())
        .set("longest", short(steps.longest).c())
        .set("mass", motor.to_string())
        .flag("gap", model.backlash.is_some())
        .set("load", load.to_string())
        .set("gap_width", width.c())
        .set("half_gap", (0.5 * width).c())
        .set("stop_time", (2.0 * step).c())
        .set("stop_width", (STOP * width).c());
    law::fill(&mut fill, &Friction::LuGre(lugre), f64::c);
    let late = delay(model);
    let samples = libm::ceil(late.abs() / step) + 1.0;
    fill.flag("late", late > 0.0).set(
        "late",
        format!("delay=\"{}\" nsample=\"{samples}\"", late.abs().c()),
    );
    fill.set(
        "early",
        match late < 0.0 {
            true => format!(" delay=\"{}\" nsample=\"{samples}\"", late.abs().c()),
            false => String::new(),
        },
    );
    let words = spaced(&header::comment(model, ""));
    let xml = fill.clone().set("header", words).render(MODEL);
    let test = fill
        .set("header", header::comment(model, "# "))
        .render(SELFTEST);
    Ok(vec![
        File::text(format!("{name}_friction.xml"), xml),
        File::text(format!("{name}_selftest.py"), test),
    ])
}

/// A text for a comment in XML, where no two hyphens may stand together.
pub(crate) fn spaced(text: &str) -> String {
    let mut out = text.replace("--", "- -");
    // Of three hyphens the last two are together still.
    while out.contains("--") {
        out = out.replace("--", "- -");
    }
    out
}

/// How much later the force is logged than the motion, s, where the log shows that; below 0 the force is ahead of its motion.
fn delay(model: &Model) -> f64 {
    let mut all = model.parameters.iter();
    let found = all.find(|p| p.name == "delay" && (p.identifiable || p.given));
    found.map_or(0.0, |p| p.value)
}

/// The mass in the file, kg (kg m^2).
const MASS: f64 = 1.0;
/// The load where only its gap is known, as a part of the mass.
const LOAD: f64 = 0.5;
/// Longest time step as a part of the time in which the motor crosses the gap, driven by as much as its Coulomb friction. A stop takes two
/// steps to catch the load, which goes into it by a few percent of the gap meanwhile.
const CROSSING: f64 = 0.025;
/// Depth at which a stop of a gap is as hard as it gets, as a part of the gap.
const STOP: f64 = 0.01;

/// The masses of the motor, and of the load behind a gap; 0 without one.
fn masses(model: &Model) -> (f64, f64) {
    let load = model.backlash.map_or(0.0, |gap| gap.load.unwrap_or(LOAD));
    // As a person would write them.
    let load = short(MASS * load);
    (short(MASS - load), load)
}

/// Time steps, s.
pub(crate) struct Steps {
    /// From this one on a joint that sticks does not come to rest.
    pub longest: f64,
    /// The longest that resolves the gap, where there is one.
    pub of_gap: Option<f64>,
    /// That which is written: the one that was asked for, or less if there is one that is allowed, to two digits.
    pub written: f64,
}

impl Steps {
    fn of(model: &Model, law: &LuGre<f64>) -> Self {
        let (motor, _) = masses(model);
        let longest = longest_step(law, motor);
        let of_gap = model.backlash.map(|gap| {
            let acceleration = law.curve().positive().coulomb / motor;
            CROSSING * libm::sqrt(2.0 * gap.width / acceleration)
        });
        let mut written = model.settings.cycle_time;
        for most in [Some(longest), of_gap].into_iter().flatten() {
            let most = short(two_digits(most));
            if most >= CYCLE_TIMES.0 {
                written = written.min(most);
            }
        }
        Self {
            longest,
            of_gap,
            written,
        }
    }
}

/// Time steps of a model; `None` for a law without bristles.
pub(crate) fn steps(model: &Model) -> Option<Steps> {
    Some(Steps::of(model, &bristle(&model.friction)?))
}

/// The longest time step, s, at which a joint with a mass, kg (kg m^2), that sticks comes to rest.
///
/// Stuck, the bristles are a spring. MuJoCo takes deflection and velocity at the beginning of a step of h for both, and
/// the joint's damping implicitly: `z+ = z + h v`, `(m + h sigma2) v+ = m v - h (sigma0 z + sigma1 v)`. By Jury's criterion that decays for
/// `h sigma0 < sigma1 + sigma2` and `sigma0 h^2 - 2 (sigma1 - sigma2) h + 4 m > 0`.
fn longest_step(law: &LuGre<f64>, mass: f64) -> f64 {
    let (stiffness, damping) = (law.stiffness(), law.damping().at_rest());
    let viscous = law.curve().positive().viscous;
    let spring = (damping + viscous) / stiffness;
    let excess = damping - viscous;
    let root = excess * excess - 4.0 * mass * stiffness;
    if excess <= 0.0 || root < 0.0 {
        return spring;
    }
    // The lesser root, without the difference of nearly equal numbers.
    spring.min(4.0 * mass / (excess + libm::sqrt(root)))
}

/// The bristle of a law, as MuJoCo has one: of Maxwell-slip elements one as stiff as they are while all stick.
pub(crate) fn bristle(friction: &Friction<f64>) -> Option<LuGre<f64>> {
    match friction {
        Friction::Gms(law) => {
            LuGre::new(law.stiffness(), Damping::Constant(0.0), *law.curve()).ok()
        }
        friction => friction.bristle().copied(),
    }
}

/// What a law has that the bristle of MuJoCo has not.
pub(crate) fn simplified(model: &Model) -> Option<Advice> {
    let message = match &model.friction {
        Friction::ElastoPlastic(_) => {
            "the joint has the bristles of LuGre, with the same stiffness and steady friction: they creep below break-away too, so \
             under a force that oscillates there the joint drifts, where the law does not"
        }
        Friction::Gms(_) => {
            "the joint has one bristle as LuGre has it, as stiff as all elements of the law while they stick, with the same steady \
             friction: it does not remember reversals inside reversals, and slides after a shorter way than the last element"
        }
        _ => return None,
    };
    Some(Advice {
        code: Code::ExportSimplified,
        message: message.into(),
    })
}

/// The bristle of the law, if MuJoCo has one with its steady friction.
pub(crate) fn simple(model: &Model) -> Result<LuGre<f64>, Error> {
    let refuse = |law: String| Error::Law {
        target: "mujoco",
        law,
        allowed: "a law with bristles or elements, with a Stribeck exponent of 2, the same in both directions",
    };
    let name = model.law();
    let law = bristle(&model.friction).ok_or_else(|| refuse(name.into()))?;
    let curve = law.curve();
    if curve.positive() != curve.negative() {
        return Err(refuse(format!("{name}, asymmetric")));
    }
    if curve.shape() != Shape::Gaussian {
        return Err(refuse(format!("{name} with another Stribeck exponent")));
    }
    Ok(law)
}

fn rows(law: &LuGre<f64>, vectors: &Vectors<f64>, h: f64) -> String {
    let mut z = 0.0;
    let rows: Vec<String> = vectors
        .rows
        .iter()
        .map(|row| {
            let force = law.force(z, row.velocity);
            z = law.step_held(z, h, row.velocity);
            format!("    ({}, {}, {}),", row.velocity.c(), force.c(), z.c())
        })
        .collect();
    rows.join("\n")
}
