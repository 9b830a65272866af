//! From what was found to `robot.json`.

use super::filters::Filters;
use super::load::Loaded;
use super::outcome::JointOutcome;
use super::verdict::JointFacts;
use crate::error::Error;
use crate::identify::{Outcome, rms};
use crate::source::Source;
use stiction_files::Warning;
use stiction_files::axis::entry;
use stiction_files::result::{Action, ParameterEntry};
use stiction_files::robot::result::{
    BaseEntry, BodyEntry, Estimated, FileEntry, JointColumn, JointEntry, JointFit, RobotFile,
    RobotInput, RobotTrust, SCHEMA,
};
use stiction_identify::{NORMAL_Q95, RigidFit, Status};
use stiction_log::{Motion, Role};
use stiction_number::short;
use stiction_parameters::Quantity;
use stiction_rigid::base::{Base, Parameter, Scope};
use stiction_rigid::project;
use stiction_say::{Notice, OfRobot};

/// Weight of the URDF where the log says nothing of an inertia, beside which one sample counts as 1.
const URDF_WEIGHT: f64 = 1e-3;

/// What is known when all joints are done.
pub(super) struct Parts<'a> {
    pub loaded: &'a Loaded,
    pub filters: &'a Filters,
    pub rigid: &'a RigidFit,
    pub joints: &'a [JointOutcome],
    pub notices: Vec<OfRobot>,
    pub seed: u64,
}

/// The whole file.
pub(super) fn result(parts: Parts) -> Result<RobotFile, Error> {
    let Parts {
        loaded,
        filters,
        rigid,
        joints,
        ..
    } = parts;
    let facts: Vec<JointFacts> = joints.iter().map(facts).collect();
    let against: Vec<OfRobot> = facts.iter().filter_map(JointFacts::against).collect();
    let trustworthy = against.is_empty() && !facts.is_empty();
    let mut warnings: Vec<Warning> = Vec::new();
    for notice in parts.notices {
        warnings.push(Notice::Robot(notice).into());
    }
    let base_parameters = base_of(loaded)?;
    // Of a rotor beside the inertia of its link the sum is known, and the URDF divides it.
    let alone: Vec<usize> = (0..base_parameters.len())
        .filter_map(|number| match base_parameters.terms(number)[..] {
            [(Parameter::Armature { joint }, _)] => Some(joint),
            _ => None,
        })
        .collect();
    let mut entries = Vec::new();
    for joint in &loaded.joints {
        let name = &loaded.robot.joints()[joint.joint].name;
        let found = joints.iter().zip(&facts).find(|(own, _)| own.name == *name);
        let Some(source) = joint.fitted.first() else {
            continue;
        };
        entries.push(JointEntry {
            name: name.clone(),
            kind: source.log.motion.to_string(),
            unit: match source.log.motion {
                Motion::Linear => "N".into(),
                Motion::Rotary => "N*m".into(),
            },
            columns: columns(source),
            fit: found.and_then(|(own, facts)| {
                let mut fit = fit(own, facts)?;
                fit.armature.identifiable &= alone.contains(&joint.joint);
                Some(fit)
            }),
        });
    }
    let name = loaded.file.name.clone();
    let stem = loaded.urdf.path.file_stem();
    let stem = stem.map(|stem| stem.to_string_lossy().into_owned());
    Ok(RobotFile {
        schema: SCHEMA.into(),
        version: env!("CARGO_PKG_VERSION").into(),
        seed: parts.seed,
        name: name.or(stem).unwrap_or_default(),
        urdf: FileEntry {
            path: stiction_files::shell::text(&loaded.urdf.path),
            sha256: loaded.urdf.sha256.clone(),
        },
        robot: loaded.file.file().map(|(path, sha256)| FileEntry {
            path: stiction_files::shell::text(path),
            sha256: sha256.into(),
        }),
        gravity: loaded.robot.gravity(),
        tool: loaded.file.tool.clone(),
        couplings: loaded.file.couplings.clone(),
        time: loaded
            .joints
            .iter()
            .flat_map(|joint| &joint.fitted)
            .next()
            .and_then(|source| of_roles(source, |role| role == Role::Time).pop()),
        inputs: inputs(loaded),
        conditioning: filters.entry,
        trust: RobotTrust {
            trustworthy,
            reasons: against.iter().map(ToString::to_string).collect(),
            next: match trustworthy {
                true => Action::Export,
                false => Action::Record,
            },
        },
        joints: entries,
        base: base(loaded, &base_parameters, rigid),
        bodies: bodies(loaded, rigid)?,
        warnings,
    })
}

fn inputs(loaded: &Loaded) -> Vec<RobotInput> {
    let Some(first) = loaded.joints.first() else {
        return Vec::new();
    };
    let fitted = first.fitted.iter().map(|source| (source, true));
    let all = fitted.chain(first.held_out.iter().map(|source| (source, false)));
    all.map(|(source, fitted)| RobotInput {
        path: stiction_files::shell::text(&source.path),
        part: source.part.clone(),
        sha256: source.sha256.clone(),
        fitted,
        samples: source.log.time.len(),
        rate_hz: source.log.rate_hz,
    })
    .collect()
}

/// The columns of a joint with the lines that name them.
fn columns(source: &Source) -> Vec<JointColumn> {
    of_roles(source, |role| role != Role::Time)
}

fn of_roles(source: &Source, is_wanted: impl Fn(Role) -> bool) -> Vec<JointColumn> {
    let used = source.log.columns.iter();
    used.filter_map(|column| {
        let role = column.role.filter(|role| is_wanted(*role))?;
        let channel = source.log.mapping.channel(role)?;
        Some(JointColumn {
            role: role.to_string(),
            column: column.column.clone(),
            unit: column.unit.clone(),
            line: format!("{role} = {}", entry(channel)),
        })
    })
    .collect()
}

/// What a verdict depends on.
fn facts(joint: &JointOutcome) -> JointFacts {
    let name = joint.name.clone();
    match &joint.outcome {
        Err(error) => JointFacts {
            joint: name,
            refused: Some(error.to_string()),
            left: f64::NAN,
            converged: false,
        },
        Ok(outcome) => JointFacts {
            joint: name,
            refused: None,
            left: held_out(joint, outcome).0 / torque(outcome),
            converged: outcome.law().status == Status::Converged,
        },
    }
}

/// Root mean square of the measured torque about its mean, N m or N.
fn torque(outcome: &Outcome) -> f64 {
    let forces = outcome.sources.iter().filter_map(|s| s.log.force.as_ref());
    let mut all: Vec<f64> = forces.flatten().copied().collect();
    let mean = all.iter().sum::<f64>() / all.len().max(1) as f64;
    all.iter_mut().for_each(|x| *x -= mean);
    rms(&all)
}

/// Root mean square of what the model leaves on samples that were not fitted, and which those are. Blocks of the fitted logs were
/// left out for the friction, not for the rigid body, whose error is added by its covariance.
fn held_out(joint: &JointOutcome, outcome: &Outcome) -> (f64, &'static str) {
    let [_, unseen] = &joint.left;
    if !unseen.is_empty() {
        return (rms(unseen), "validation");
    }
    let series = &outcome.law().series;
    let own = outcome.result.laws.iter().find(|law| law.reported);
    let percent = own.and_then(|law| law.held_out_error_percent);
    match percent {
        Some(percent) => {
            let friction = percent / 100.0 * rms(&series.measured);
            (libm::hypot(friction, joint.rigid_deviation), "held-out")
        }
        None => (
            libm::hypot(outcome.law().fit.rmse, joint.rigid_deviation),
            "fitted",
        ),
    }
}

fn fit(joint: &JointOutcome, facts: &JointFacts) -> Option<JointFit> {
    let outcome = joint.outcome.as_ref().ok()?;
    let result = &outcome.result;
    let of = |quantity: Quantity| -> Option<Estimated> {
        let name = stiction_parameters::Name::from(quantity).to_string();
        let both = result.parameters.iter();
        let own: Vec<&ParameterEntry> = both
            .filter(|p| {
                p.name == name
                    || p.name.strip_suffix("_pos") == Some(&name)
                    || p.name.strip_suffix("_neg") == Some(&name)
            })
            .collect();
        mean(&own)
    };
    let (held_out_rms, judged_on) = held_out(joint, outcome);
    let curve = result.friction_curve.as_ref();
    let line = curve.and_then(|curve| curve.line.as_ref());
    Some(JointFit {
        folder: joint.folder.clone(),
        law: result.law.clone(),
        asymmetric: result.asymmetric,
        coulomb: of(Quantity::Coulomb),
        viscous: of(Quantity::Sigma2),
        static_friction: of(Quantity::Static),
        load: of(Quantity::CoulombTransmitted),
        armature: of(Quantity::Mass).unwrap_or(Estimated {
            value: 0.0,
            half_width: None,
            identifiable: false,
        }),
        // A line that falls with the speed is none of a simulator, which takes the one nearest to the law.
        simulators: line
            .map(|line| [line.coulomb, line.viscous])
            .filter(|line| line.iter().all(|own| own.value >= 0.0)),
        torque_rms: torque(outcome),
        fit_rms: rms(&joint.left[0]),
        held_out_rms,
        judged_on: judged_on.into(),
        rigid_deviation: joint.rigid_deviation,
        trustworthy: facts.against().is_none(),
        compensates: result.trust.trustworthy,
        reasons: result.trust.reasons.clone(),
    })
}

/// The mean of a parameter over the directions.
fn mean(each: &[&ParameterEntry]) -> Option<Estimated> {
    let count = each.len() as f64;
    let half = |p: &ParameterEntry| {
        p.half_width.map(|half| half.repeat).or_else(|| {
            let [low, high] = p.ci95?;
            Some(0.5 * (high? - low?))
        })
    };
    let halves: Option<Vec<f64>> = each.iter().map(|p| half(p)).collect();
    (!each.is_empty()).then(|| Estimated {
        value: each.iter().map(|p| p.value).sum::<f64>() / count,
        half_width: halves.map(|halves| halves.iter().sum::<f64>() / count),
        identifiable: each.iter().all(|p| p.identifiable),
    })
}

/// The combinations of inertial parameters that motion of the logged joints can determine.
fn base_of(loaded: &Loaded) -> Result<Base, Error> {
    let robot = &loaded.robot;
    let scope = Scope {
        moving: (0..robot.len())
            .map(|i| {
                let leads = robot.joints()[i].mimic.map_or(i, |mimic| mimic.of);
                loaded.joints.iter().any(|own| own.joint == leads)
            })
            .collect(),
        position: loaded.at.clone(),
        armature: true,
    };
    Base::of(robot, &scope).map_err(|source| Error::Urdf {
        file: loaded.urdf.path.clone(),
        source: Box::new(source),
    })
}

fn base(loaded: &Loaded, base: &Base, rigid: &RigidFit) -> Vec<BaseEntry> {
    let robot = &loaded.robot;
    let values = base.values(&rigid.parameters, &rigid.armature);
    let nominal = base.values(&robot.parameters(), &[]);
    let entry = |number: usize| {
        let terms = base.terms(number);
        let mut variance = 0.0;
        for (a, x) in &terms {
            for (b, y) in &terms {
                let at = (a.index(robot.len()), b.index(robot.len()));
                variance += x * y * rigid.covariance[at];
            }
        }
        BaseEntry {
            name: name(loaded, &terms),
            unit: unit(terms[0].0).into(),
            value: values[number],
            half_width: NORMAL_Q95 * variance.max(0.0).sqrt(),
            urdf: nominal[number],
        }
    };
    (0..base.len()).map(entry).collect()
}

/// A sum of parameters in words.
fn name(loaded: &Loaded, terms: &[(Parameter, f64)]) -> String {
    let mut out = String::new();
    for (i, (parameter, factor)) in terms.iter().enumerate() {
        let joint = &loaded.robot.joints()[parameter.body()].name;
        let sign = match (i, *factor < 0.0) {
            (0, _) => "",
            (_, true) => " - ",
            (_, false) => " + ",
        };
        let size = match short(factor.abs()).as_str() {
            "1" => String::new(),
            size => format!("{size} "),
        };
        out.push_str(&format!("{sign}{size}{}({joint})", parameter.symbol()));
    }
    out
}

fn unit(parameter: Parameter) -> &'static str {
    match parameter {
        Parameter::Inertial { number: 0, .. } => "kg",
        Parameter::Inertial { number: 1..4, .. } => "kg*m",
        _ => "kg*m^2",
    }
}

/// Physically consistent inertias nearest to the fit.
fn bodies(loaded: &Loaded, rigid: &RigidFit) -> Result<Vec<BodyEntry>, Error> {
    let robot = &loaded.robot;
    let size = rigid.parameters.len();
    let attached: Vec<f64> = robot.bodies().iter().flat_map(|b| b.attached).collect();
    let own: Vec<f64> = robot.bodies().iter().flat_map(|b| b.own).collect();
    let estimate: Vec<f64> = rigid
        .parameters
        .iter()
        .zip(&attached)
        .map(|(x, attached)| x - attached)
        .collect();
    let covariance = rigid.covariance.view((0, 0), (size, size)).into_owned();
    let information = stiction_identify::pseudo_inverse(covariance);
    let refused = |source| Error::Urdf {
        file: loaded.urdf.path.clone(),
        source: Box::new(source),
    };
    let found = project(&estimate, information.as_slice(), &own, URDF_WEIGHT);
    let found = found.map_err(refused)?;
    let (ten, _) = found.parameters.as_chunks::<10>();
    let mut out = Vec::new();
    for (i, (own, body)) in ten.iter().zip(robot.bodies()).enumerate() {
        let whole = stiction_rigid::inertia::sum(own, &body.attached);
        let Some(inertial) = robot.carrier_inertial(i, &whole) else {
            continue;
        };
        out.push(BodyEntry {
            joint: robot.joints()[i].name.clone(),
            link: robot.links()[body.carrier].name.clone(),
            mass: inertial.mass,
            center: inertial.origin.xyz,
            inertia: inertial.inertia,
            urdf_mass: body.own[0],
        });
    }
    Ok(out)
}
