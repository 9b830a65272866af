//! What is compared on: a record, a curve or a drive, with its box, and where its optimum is.

mod genome;
mod made;

use super::known::{self, Known};
use super::{CompareOptions, Cost, Input, Shared};
use crate::error::Error;
use crate::identify::record_of;
use crate::spread::Spread;
use genome::{Floor, about, genome};
use std::f64::consts::LN_10;
use stiction_files::Axis;
use stiction_identify as engine;
use stiction_identify::candidates::{
    Curve, Nonlinear, Scheme, Simulated, SixParameters, box_of_six, thinned,
};
use stiction_identify::{Delay, Law, LawKind, Observer, Record, SearchBox, Settings, Terms};
use stiction_search::{Bounds, Fidelity, Limits, Method, Plan, Points, Problem, Run, levenberg};

/// Evaluations of the reference of a steady curve, and of a simulation.
const CURVE: u64 = 20_000;
const SIMULATIONS: u64 = 10_000;

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
    /// The law that is fitted.
    law: Law,
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

impl Subject {
    /// Reads or makes what is compared on.
    pub fn new(options: &CompareOptions, observer: &mut dyn Observer) -> Result<Self, Error> {
        match &options.input {
            Input::Log { logs, axis } => from_log(options, logs, axis.as_deref(), observer),
            Input::Named(name) => match known::find(name) {
                Some(Known::Axis(axis)) => made::from_axis(options, &axis),
                Some(Known::Curve(curve)) => made::from_curve(options, curve),
                None => Err(Error::usage(
                    format!("--problem {name}"),
                    format!("one of {}", known::names().join(", ")),
                )),
            },
        }
    }

    /// The problem that the searches see.
    pub fn problem(&self) -> Result<Box<Shared<'_>>, Error> {
        self.within(self.bounds.clone())
    }

    fn within(&self, bounds: Bounds) -> Result<Box<Shared<'_>>, Error> {
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
                        Nonlinear::new(record, thinned, self.law, terms, &bounds)
                            .map_err(refused)?,
                    )
                }
                _ => Box::new(
                    SixParameters::new(record, self.law, terms, bounds, self.scheme)
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
            // The searches do not fit a delay; they take one that is given.
            let still = Terms {
                delay: match terms.delay {
                    Delay::Fitted => Delay::NONE,
                    given => given,
                },
                ..terms.clone()
            };
            let settings = Settings::default();
            let found = engine::separable(record, self.law, &still, &settings, observer)
                .map_err(refused)?;
            let energy: f64 = record.gather(|s| &s.force).iter().map(|u| u * u).sum();
            if self.scheme == Scheme::Explin {
                return Ok((found.evaluation.cost / energy, "separable"));
            }
            // Where another integrator has its optimum is not known: near that of EXPLIN, if it is stable
            // there.
            let value = |name: &str| {
                let estimate = engine::estimate(record, self.law, &still, &found, 0.0);
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
            let mut points = Points::new(6);
            points.push(&six.map(libm::log));
            let mut cost = [f64::INFINITY];
            self.problem()?.costs(&points, Fidelity::Full, &mut cost);
            return Ok((cost[0], "separable (EXPLIN), seen by this integrator"));
        }
        if let Data::Curve { .. } = &self.data {
            let many = levenberg::Settings {
                scan: 1024,
                starts: 64,
                ..levenberg::Settings::default()
            };
            let least = least(&*self.problem()?, Method::Lm(many), CURVE)?;
            return Ok((least, "least squares from 64 starts"));
        }
        // A small box about the truth holds the optimum and nothing else.
        let middle = genome(&self.truth, self.cost, Floor::NONE);
        let reach = 0.1 * LN_10;
        let bounds = Bounds::new(
            middle.iter().map(|x| x - reach).collect(),
            middle.iter().map(|x| x + reach).collect(),
        );
        let bounds = bounds.map_err(|e| Error::usage(e.to_string(), "a finite box"))?;
        let method = Method::named("cma-es").expect("a method");
        let least = least(&*self.within(bounds)?, method, SIMULATIONS)?;
        Ok((least, "cma-es near the truth"))
    }

    fn refused(&self, source: engine::Error) -> Error {
        Error::Identify {
            inputs: self.name.clone(),
            source,
        }
    }
}

/// The least cost that a method finds.
fn least(problem: &Shared, method: Method, evaluations: u64) -> Result<f64, Error> {
    let problem = Spread(problem);
    let plan = Plan {
        method,
        finish: None,
    };
    let dimensions = problem.bounds().dimensions();
    let mut run = Run::new(plan.start(dimensions, 0).expect("valid settings"), &problem);
    let limits = Limits {
        costs: evaluations,
        derivatives: evaluations,
        ..Limits::default()
    };
    run.advance(&problem, &limits, &mut stiction_search::Silent)
        .map_err(|e| Error::usage(e.to_string(), "a method for this cost"))?;
    Ok(run.best().map_or(f64::INFINITY, |best| best.cost))
}

/// LuGre with a Gaussian curve.
fn lugre() -> Law {
    Law::new(LawKind::LuGre)
}

fn search_box(bounds: &Bounds) -> SearchBox {
    SearchBox::between(bounds.low().to_vec(), bounds.high().to_vec())
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
    if axis.exponent_fitted {
        return Err(Error::usage(
            "stribeck_exponent = \"fit\"",
            "a number; only the default method of identify fits it",
        ));
    }
    let law = Law {
        exponent: axis.stribeck_exponent,
        ..lugre()
    };
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
            let inner = SearchBox::from_record(&record, &law).map_err(refused)?;
            let ends = |end: fn(&SearchBox, usize) -> f64| {
                (0..inner.len()).map(|i| end(&inner, i)).collect()
            };
            Bounds::new(ends(SearchBox::low), ends(SearchBox::high))
                .map_err(|e| Error::usage(e.to_string(), "a log with motion and force"))?
        }
        (None, _) => box_of_six(&record).map_err(refused)?,
        (Some(decades), _) => {
            let settings = Settings::default();
            let (estimate, _) = engine::identify(&record, law, &terms, 0.0, &settings, observer)
                .map_err(refused)?;
            let found: Vec<(String, f64)> = (estimate.parameters.iter())
                .map(|p| (p.name.to_string(), p.value))
                .collect();
            let floor = Floor::new(estimate.value("coulomb").unwrap_or(1.0), record.top_speed());
            about(&genome(&found, cost, floor), decades)?
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
        law,
        scheme: options.integrator,
        bounds,
        data: Data::Record {
            thinned: thinned(&record).map(Box::new),
            record: Box::new(record),
            terms,
        },
    })
}
