//! What is compared on: a record, a curve or a drive, with its box, and where its optimum is.

use super::genome::{Floor, genome};
use super::options::{Cost, Shared};
use crate::error::Error;
use crate::spread::Spread;
use std::f64::consts::LN_10;
use stiction_friction::Direction;
use stiction_identify as engine;
use stiction_identify::candidates::{Curve, Dynamic, Nonlinear, Scheme, Simulated, SixParameters};
use stiction_identify::{Delay, Law, LawKind, Observer, Record, SearchBox, Settings, Terms};
use stiction_search::{Bounds, Fidelity, Limits, Method, Plan, Points, Problem, Run, levenberg};

/// Limit on the evaluations of the reference search on a steady curve: its least squares end long before.
const REFERENCE_EVALUATIONS_OF_CURVE: u64 = 20_000;
/// The same for a simulation, where the reference is found by `cma-es` in a small box about the truth.
const REFERENCE_EVALUATIONS_OF_SIMULATION: u64 = 10_000;

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
    pub data: Data,
    /// The law that is fitted.
    pub law: Law,
    pub bounds: Bounds,
    pub scheme: Scheme,
}

/// The data that the candidates are compared with.
#[derive(Debug)]
pub(super) enum Data {
    Record {
        record: Box<Record>,
        thinned: Option<Box<Record>>,
        terms: Box<Terms>,
        /// The steady curve, where it is known and only the bristles are searched.
        held: Option<Direction<f64>>,
    },
    Curve {
        speed: Vec<f64>,
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
                held,
            } => match self.cost {
                Cost::Separable => {
                    let bounds = search_box(&bounds);
                    let thinned = thinned.as_deref();
                    Box::new(
                        Nonlinear::new(record, thinned, self.law, terms, &bounds)
                            .map_err(refused)?,
                    )
                }
                _ => {
                    let six =
                        |bounds| SixParameters::new(record, self.law, terms, bounds, self.scheme);
                    match held {
                        None => Box::new(six(bounds).map_err(refused)?),
                        Some(curve) => {
                            let all = six(beside(&bounds, curve)).map_err(refused)?;
                            Box::new(Dynamic::new(all, curve).map_err(refused)?)
                        }
                    }
                }
            },
            Data::Curve { speed, force } => {
                Box::new(Curve::new(speed.clone(), force.clone(), bounds).map_err(refused)?)
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
        if let Data::Record {
            record,
            terms,
            held: None,
            ..
        } = &self.data
        {
            // The searches do not fit a delay; they take one that is given.
            let still = Terms {
                delay: match terms.delay {
                    Delay::Fitted => Delay::NONE,
                    given => given,
                },
                ..(**terms).clone()
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
        if !matches!(self.data, Data::Drive { .. }) {
            let many = levenberg::Settings {
                scan: 1024,
                starts: 64,
                ..levenberg::Settings::default()
            };
            let least = least(
                &*self.problem()?,
                Method::Lm(many),
                REFERENCE_EVALUATIONS_OF_CURVE,
            )?;
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
        let least = least(
            &*self.within(bounds)?,
            method,
            REFERENCE_EVALUATIONS_OF_SIMULATION,
        )?;
        Ok((least, "cma-es near the truth"))
    }

    fn refused(&self, source: engine::Error) -> Error {
        Error::identify(self.name.clone(), source)
    }
}

/// The box of six parameters with that of sigma0 and sigma1 in front; the others are held, so that theirs does not matter.
fn beside(bounds: &Bounds, curve: &Direction<f64>) -> Bounds {
    let held = [
        curve.viscous,
        curve.coulomb,
        curve.static_friction - curve.coulomb,
        curve.stribeck_velocity,
    ];
    let ends = |own: &[f64], off: f64| -> Vec<f64> {
        let own = own.iter().copied();
        own.chain(held.map(|x| libm::log(x) + off)).collect()
    };
    Bounds::new(ends(bounds.low(), -1.0), ends(bounds.high(), 1.0)).unwrap_or(bounds.clone())
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
pub(super) fn lugre() -> Law {
    Law::new(LawKind::LuGre)
}

fn search_box(bounds: &Bounds) -> SearchBox {
    SearchBox::between(bounds.low().to_vec(), bounds.high().to_vec())
}
