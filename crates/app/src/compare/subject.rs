//! What is compared on: a record, a curve or a drive, with its box, and where its optimum is.

use super::excitation::{DURATION, Excitation};
use super::known::{self, Known, KnownCurve};
use super::{CompareOptions, Cost, Input};
use crate::axis::Axis;
use crate::error::Error;
use crate::identify::record_of;
use std::f64::consts::LN_10;
use stiction_friction::{LuGre, ParamError};
use stiction_identify as engine;
use stiction_identify::candidates::{
    Candidates, Curve, Nonlinear, Scheme, Simulated, SixParameters, box_of_six, thinned,
};
use stiction_identify::{
    Conditioning, Cutoff, Law, LawKind, Mass, Observer, Record, Samples, SearchBox, Settings, Terms,
};
use stiction_search::{Bounds, Limits, Method, Plan, Run};
use stiction_servo::known::KnownAxis;
use stiction_servo::noise::Noise;
use stiction_servo::plant::{Load, Motion, Plant};

/// Decades by which the middle of a box is off the truth, in turn; less in boxes of less than a decade.
const OFF: [f64; 6] = [0.31, -0.27, 0.23, -0.35, 0.29, -0.33];
/// Steps of the true law in one sample.
const FINE: usize = 20;
/// Seed of the noise of a made record: the searches have seeds of their own.
const NOISE_SEED: u64 = 1;

/// A subject of a comparison.
pub(super) struct Subject {
    pub name: String,
    pub source: String,
    /// How it moves, in words.
    pub motion: String,
    pub samples: usize,
    pub rate_hz: f64,
    /// Known parameters; empty for a log.
    pub truth: Vec<(String, f64)>,
    pub cost: Cost,
    data: Data,
    bounds: Bounds,
    scheme: Scheme,
}

enum Data {
    Record {
        record: Box<Record>,
        thinned: Option<Box<Record>>,
        terms: Terms,
    },
    Curve {
        force: Vec<f64>,
    },
    Drive {
        mass: f64,
        step: f64,
        force: Vec<f64>,
        position: Vec<f64>,
    },
}

type Shared<'a> = Box<dyn Candidates + Sync + 'a>;

impl Subject {
    /// Reads or makes what is compared on.
    pub fn new(options: &CompareOptions, observer: &mut dyn Observer) -> Result<Self, Error> {
        match &options.input {
            Input::Log { logs, axis } => from_log(options, logs, axis.as_deref(), observer),
            Input::Named(name) => match known::find(name) {
                Some(Known::Axis(axis)) => from_axis(options, &axis),
                Some(Known::Curve(curve)) => from_curve(options, curve),
                None => Err(Error::usage(
                    format!("--problem {name}"),
                    format!("one of {}", known::names().join(", ")),
                )),
            },
        }
    }

    /// The problem that the searches see.
    pub fn problem(&self) -> Result<Shared<'_>, Error> {
        self.within(self.bounds.clone())
    }

    fn within(&self, bounds: Bounds) -> Result<Shared<'_>, Error> {
        let refused = |e| self.refused(e);
        Ok(match &self.data {
            Data::Record {
                record,
                thinned,
                terms,
            } => match self.cost {
                Cost::Separable => {
                    let bounds = search_box(&bounds);
                    let thinned = thinned.as_deref();
                    Box::new(
                        Nonlinear::new(record, thinned, lugre(), terms, &bounds)
                            .map_err(refused)?,
                    )
                }
                _ => Box::new(
                    SixParameters::new(record, lugre(), terms, bounds, self.scheme)
                        .map_err(refused)?,
                ),
            },
            Data::Curve { force } => {
                Box::new(Curve::new(known::speeds(), force.clone(), bounds).map_err(refused)?)
            }
            Data::Drive {
                mass,
                step,
                force,
                position,
            } => Box::new(
                Simulated::new(*mass, *step, force.clone(), position.clone(), bounds)
                    .map_err(refused)?,
            ),
        })
    }

    /// Whether its problem has derivatives.
    pub fn descends(&self) -> bool {
        self.scheme == Scheme::Explin && self.cost != Cost::Position
    }

    /// The least cost that is known before any search runs, and how it was found.
    pub fn reference(&self, observer: &mut dyn Observer) -> Result<(f64, &'static str), Error> {
        let refused = |e| self.refused(e);
        if let Data::Record { record, terms, .. } = &self.data {
            let still = Terms {
                delay: engine::Delay::NONE,
                ..terms.clone()
            };
            let settings = Settings::default();
            let found =
                engine::separable(record, lugre(), &still, &settings, observer).map_err(refused)?;
            let energy: f64 = record.gather(|s| &s.force).iter().map(|u| u * u).sum();
            if self.scheme == Scheme::Explin {
                return Ok((found.evaluation.cost / energy, "separable"));
            }
            // Where another integrator has its optimum is not known: near that of EXPLIN, if it is stable
            // there.
            let value = |name: &str| {
                let estimate = engine::estimate(record, lugre(), &still, &found, 0.0);
                estimate.value(name).unwrap_or(f64::NAN)
            };
            let fc = value("coulomb");
            let six = [
                value("sigma0"),
                value("sigma1"),
                value("sigma2").max(1e-12 * fc),
                fc,
                value("static") - fc,
                value("stribeck_velocity"),
            ];
            let mut points = stiction_search::Points::new(6);
            points.push(&six.map(libm::log));
            let mut cost = [f64::INFINITY];
            let full = stiction_search::Fidelity::Full;
            self.problem()?.costs(&points, full, &mut cost);
            return Ok((cost[0], "separable (EXPLIN), seen by this integrator"));
        }
        // A small box about the truth holds the optimum and nothing else.
        let (method, evaluations, by) = match &self.data {
            Data::Curve { .. } => ("lm", 2_000, "least squares near the truth"),
            _ => ("cma-es", 5_000, "cma-es near the truth"),
        };
        let middle = self.centre();
        let reach = 0.1 * LN_10;
        let bounds = Bounds::new(
            middle.iter().map(|x| x - reach).collect(),
            middle.iter().map(|x| x + reach).collect(),
        );
        let bounds = bounds.map_err(|e| Error::usage(e.to_string(), "a finite box"))?;
        let problem = self.within(bounds)?;
        let plan = Plan {
            method: Method::named(method).expect("a method"),
            finish: None,
        };
        let search = plan.start(middle.len(), 0).expect("default settings");
        let spread = crate::spread::Spread(&*problem);
        let mut run = Run::new(search, &spread);
        let limits = Limits {
            costs: evaluations,
            derivatives: evaluations,
            ..Limits::default()
        };
        run.advance(&spread, &limits, &mut stiction_search::Silent)
            .map_err(|e| Error::usage(e.to_string(), "a method for this cost"))?;
        Ok((run.best().map_or(f64::INFINITY, |b| b.cost), by))
    }

    /// The genome of the truth.
    fn centre(&self) -> Vec<f64> {
        genome(&self.truth, self.cost, 0.0)
    }

    fn refused(&self, source: engine::Error) -> Error {
        Error::Identify {
            inputs: self.name.clone(),
            source,
        }
    }
}

fn lugre() -> Law {
    Law::new(LawKind::LuGre)
}

fn search_box(bounds: &Bounds) -> SearchBox {
    SearchBox::between(bounds.low().to_vec(), bounds.high().to_vec())
}

/// Logarithms of the genes of known parameters; what is zero counts as `least`.
fn genome(truth: &[(String, f64)], cost: Cost, least: f64) -> Vec<f64> {
    let value = |name: &str| {
        truth
            .iter()
            .find(|(n, _)| n == name)
            .map_or(f64::NAN, |x| x.1)
    };
    match cost {
        Cost::Curve => truth
            .chunks(4)
            .flat_map(|side| [side[0].1, side[1].1, side[2].1 - side[1].1, side[3].1])
            .map(libm::log)
            .collect(),
        _ => {
            let (fc, fs, vs) = (
                value("coulomb"),
                value("static"),
                value("stribeck_velocity"),
            );
            let s2 = value("sigma2").max(least);
            let six = [value("sigma0"), value("sigma1"), s2, fc, fs - fc, vs];
            match cost {
                Cost::Separable => [six[0] / fc, six[4] / fc, vs].map(libm::log).into(),
                _ => six.map(libm::log).into(),
            }
        }
    }
}

/// A box of decades to each side of a point that is off the given one.
fn about(middle: &[f64], decades: f64) -> Result<Bounds, Error> {
    if !(decades > 0.0 && decades <= 6.0) {
        return Err(Error::usage(
            format!("--box {decades}"),
            "decades to each side, above 0 and up to 6",
        ));
    }
    let off = OFF.map(|x| x * decades.min(1.0));
    let ends = |side: f64| -> Vec<f64> {
        let each = middle.iter().zip(off.iter().cycle());
        each.map(|(x, off)| x + (off + side * decades) * LN_10)
            .collect()
    };
    Bounds::new(ends(-1.0), ends(1.0))
        .map_err(|e| Error::usage(e.to_string(), "parameters above zero"))
}

fn from_log(
    options: &CompareOptions,
    logs: &[std::path::PathBuf],
    axis: Option<&std::path::Path>,
    observer: &mut dyn Observer,
) -> Result<Subject, Error> {
    let made = [
        ("--noise", options.noise.is_some()),
        ("--excitation", options.excitation.is_some()),
        ("--rate", options.rate.is_some()),
        ("--other-law", options.other_law),
        ("--cost position", options.cost == Some(Cost::Position)),
    ];
    if let Some((name, _)) = made.iter().find(|(_, given)| *given) {
        return Err(Error::usage(
            format!("{name} beside a log"),
            "only a --problem is made; a log is what it is",
        ));
    }
    let axis = axis.map_or_else(|| Ok(Axis::default()), Axis::read)?;
    let (sources, record, terms) = record_of(logs, &axis, observer)?;
    let name: Vec<String> = sources
        .iter()
        .map(|s| s.path.display().to_string())
        .collect();
    let name = name.join(", ");
    let refused = |source| Error::Identify {
        inputs: name.clone(),
        source,
    };
    let cost = options.cost.unwrap_or(Cost::Six);
    let bounds = match (options.decades, cost) {
        (None, Cost::Separable) => {
            let inner = SearchBox::from_record(&record, &lugre()).map_err(refused)?;
            let ends = |end: fn(&SearchBox, usize) -> f64| {
                (0..inner.len()).map(|i| end(&inner, i)).collect()
            };
            Bounds::new(ends(SearchBox::low), ends(SearchBox::high))
                .map_err(|e| Error::usage(e.to_string(), "a log with motion and force"))?
        }
        (None, _) => box_of_six(&record).map_err(refused)?,
        (Some(decades), _) => {
            let settings = Settings::default();
            let (estimate, _) =
                engine::identify(&record, lugre(), &terms, 0.0, &settings, observer)
                    .map_err(refused)?;
            let found: Vec<(String, f64)> = (estimate.parameters.iter())
                .map(|p| (p.name.clone(), p.value))
                .collect();
            let least = 1e-3 * estimate.value("coulomb").unwrap_or(1.0) / record.top_speed();
            about(&genome(&found, cost, least), decades)?
        }
    };
    Ok(Subject {
        name: name.clone(),
        source: "a log".into(),
        motion: record.notes.join("; "),
        samples: record.kept(),
        rate_hz: 1.0 / record.step(),
        truth: Vec::new(),
        cost,
        scheme: options.integrator,
        bounds,
        data: Data::Record {
            thinned: thinned(&record).map(Box::new),
            record: Box::new(record),
            terms,
        },
    })
}

fn from_curve(options: &CompareOptions, curve: &KnownCurve) -> Result<Subject, Error> {
    let other = [
        ("--cost", options.cost.is_some()),
        ("--excitation", options.excitation.is_some()),
        ("--integrator", options.integrator != Scheme::Explin),
        ("--rate", options.rate.is_some()),
        ("--other-law", options.other_law),
    ];
    if let Some((name, _)) = other.iter().find(|(_, given)| *given) {
        return Err(Error::usage(
            format!("{name} beside --problem {}", curve.name),
            "a steady curve has no motion, no memory and one cost",
        ));
    }
    let truth = curve.truth();
    let mut force = curve
        .forces()
        .map_err(|e| Error::usage(e.to_string(), "a law"))?;
    add_noise(&mut force, noise_of(options)?);
    Ok(Subject {
        name: curve.name.into(),
        source: curve.source.into(),
        motion: "forces at the speeds -1 to 1 rad/s in steps of 0.05 (not at 0)".into(),
        samples: force.len() - 1,
        rate_hz: 0.0,
        bounds: about(
            &genome(&truth, Cost::Curve, 0.0),
            options.decades.unwrap_or(1.0),
        )?,
        truth,
        cost: Cost::Curve,
        scheme: Scheme::Explin,
        data: Data::Curve { force },
    })
}

fn noise_of(options: &CompareOptions) -> Result<f64, Error> {
    let noise = options.noise.unwrap_or(super::NOISE);
    if (0.0..=1.0).contains(&noise) {
        return Ok(noise);
    }
    Err(Error::usage(
        format!("--noise {noise}"),
        "deviation over the largest force, 0 to 1",
    ))
}

/// White noise of a share of the largest value.
fn add_noise(values: &mut [f64], share: f64) {
    let largest = values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let mut noise = Noise::new(NOISE_SEED);
    for x in values {
        *x += share * largest * noise.normal();
    }
}

fn from_axis(options: &CompareOptions, axis: &KnownAxis) -> Result<Subject, Error> {
    let rate = options.rate.unwrap_or(super::RATE);
    if !(100.0..=100_000.0).contains(&rate) {
        return Err(Error::usage(format!("--rate {rate}"), "100 to 100000 Hz"));
    }
    let noise = noise_of(options)?;
    let cost = options.cost.unwrap_or(Cost::Six);
    let excitation = options.excitation.unwrap_or_default();
    let step = 1.0 / rate;
    let samples = (DURATION * rate).round() as usize + 1;
    let law = match options.other_law {
        true => known::mismatched(&axis.law),
        false => Ok(axis.law),
    };
    let law = law.map_err(|e| Error::usage(e.to_string(), "a law"))?;
    let side = axis.law.curve().positive();
    let truth = [
        ("sigma0", axis.law.stiffness()),
        ("sigma1", axis.law.damping().at_rest()),
        ("sigma2", side.viscous),
        ("coulomb", side.coulomb),
        ("static", side.static_friction),
        ("stribeck_velocity", side.stribeck_velocity),
    ];
    let truth: Vec<(String, f64)> = truth.map(|(n, v)| (n.to_string(), v)).into();
    let least = 1e-3 * side.coulomb / (10.0 * side.stribeck_velocity);
    let bounds = about(&genome(&truth, cost, least), options.decades.unwrap_or(1.0))?;
    let made = |e: ParamError| Error::usage(e.to_string(), "a law");
    let (data, motion) = if cost == Cost::Position {
        if options.excitation.is_some() || options.integrator != Scheme::Explin {
            return Err(Error::usage(
                "--excitation or --integrator beside --cost position",
                "the motion is what the force makes of it",
            ));
        }
        let size = 1.5 * side.static_friction;
        let force: Vec<f64> = (0..samples)
            .map(|i| size * libm::sin(std::f64::consts::TAU * (i as f64 + 0.5) * step))
            .collect();
        let mut position = moved(axis.mass, law, step, &force).map_err(made)?;
        add_noise(&mut position, noise);
        let data = Data::Drive {
            mass: axis.mass,
            step,
            force,
            position,
        };
        (
            data,
            "force sine of 1.5 Fs and 1 Hz from rest, position out".into(),
        )
    } else {
        let (velocity, mut force) = match excitation {
            Excitation::BreakAway => broken_away(axis, law, step, samples).map_err(made)?,
            _ => along(&law, step, samples, |t| {
                side.stribeck_velocity * excitation.velocity(t).unwrap_or(0.0)
            }),
        };
        add_noise(&mut force, noise);
        let record = record(step, velocity, force).map_err(|source| Error::Identify {
            inputs: axis.name.into(),
            source,
        })?;
        let data = Data::Record {
            thinned: thinned(&record).map(Box::new),
            record: Box::new(record),
            terms: Terms {
                mass: Mass::Absent,
                offset: false,
                ..Terms::default()
            },
        };
        (data, excitation.description().to_string())
    };
    let other = if options.other_law {
        "; the data follow another law: Stribeck exponent 1, in the negative direction Fc and sigma2 of 80 %, Fs of 90 %"
    } else {
        ""
    };
    Ok(Subject {
        name: axis.name.into(),
        source: axis.source.into(),
        motion: format!("{motion}{other}"),
        samples,
        rate_hz: rate,
        truth,
        cost,
        scheme: options.integrator,
        bounds,
        data,
    })
}

/// Velocity and friction force at each sample, the law on a finer grid.
fn along(
    law: &LuGre<f64>,
    step: f64,
    samples: usize,
    velocity: impl Fn(f64) -> f64,
) -> (Vec<f64>, Vec<f64>) {
    let h = step / FINE as f64;
    let mut z = 0.0;
    (0..samples)
        .map(|i| {
            for k in 0..if i > 0 { FINE } else { 0 } {
                let t = (i - 1) as f64 * step + k as f64 * h;
                z = law.step_record(z, h, velocity(t), velocity(t + h));
            }
            let v = velocity(i as f64 * step);
            (v, law.force(z, v))
        })
        .unzip()
}

/// The same where force ramps move the mass.
fn broken_away(
    axis: &KnownAxis,
    law: LuGre<f64>,
    step: f64,
    samples: usize,
) -> Result<(Vec<f64>, Vec<f64>), ParamError> {
    let plant = Plant::new(axis.mass, law)?;
    let largest = axis.law.curve().positive().static_friction;
    let h = step / FINE as f64;
    let mut at = Motion::default();
    let mut out = (Vec::with_capacity(samples), Vec::with_capacity(samples));
    for i in 0..samples {
        for k in 0..if i > 0 { FINE } else { 0 } {
            let t = (i - 1) as f64 * step + (k as f64 + 0.5) * h;
            let load = Load::force(largest * Excitation::force(t));
            at = plant.step(at, h, load).motion;
        }
        out.0.push(at.velocity);
        out.1.push(law.force(at.deflection, at.velocity));
    }
    Ok(out)
}

/// Position at the end of each step under a force held in it.
fn moved(mass: f64, law: LuGre<f64>, step: f64, force: &[f64]) -> Result<Vec<f64>, ParamError> {
    let plant = Plant::new(mass, law)?;
    let h = step / FINE as f64;
    let mut at = Motion::default();
    let mut out = Vec::with_capacity(force.len());
    for &u in force {
        for _ in 0..FINE {
            at = plant.step(at, h, Load::force(u)).motion;
        }
        out.push(at.position);
    }
    Ok(out)
}

fn record(step: f64, velocity: Vec<f64>, force: Vec<f64>) -> Result<Record, engine::Error> {
    let samples = Samples {
        time: (0..velocity.len()).map(|i| i as f64 * step).collect(),
        velocity: Some(velocity),
        force,
        ..Samples::default()
    };
    let raw = Conditioning {
        source_cutoff: Cutoff::Off,
        common_cutoff: Cutoff::Off,
        ..Conditioning::default()
    };
    engine::condition(&[samples], &raw)
}
