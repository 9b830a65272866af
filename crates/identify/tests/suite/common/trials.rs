//! Records with known truth and one kind of noise each, a different realisation for every run: what
//! the coverage of intervals is measured on.

use super::{MACHINE, Noise, Set, record};
use std::f64::consts::TAU;
use std::ops::Range;
use stiction_friction::LuGre;
use stiction_identify::{
    Conditioning, Estimate, Law, LawKind, Mass, Optimum, Parameter, Record, Samples, SearchBox,
    Settings, Silent, Terms, condition, estimate, intervals, separable,
};
use stiction_servo::cascade::Cascade;
use stiction_servo::closed_loop::{ClosedLoop, ForceLog};
use stiction_servo::encoder::Encoder;
use stiction_servo::path::{Path, Sine};
use stiction_servo::plant::Plant;

/// Sample time of the records with noise on the force, s.
const STEP: f64 = 5e-4;
/// Deviation of the noise on the force, N.
const NOISE: f64 = 0.5;
/// Moving mass of the closed loop, kg.
const MASS: f64 = 10.0;

/// A record to fit, what is fitted beside the law, and the truth.
pub struct Trial {
    pub record: Record,
    pub terms: Terms,
    pub truth: Vec<(&'static str, f64)>,
}

/// Two tones: reversals of many depths, and speeds through the whole Stribeck range.
pub fn motion(n: usize) -> Vec<f64> {
    (0..n)
        .map(|i| {
            let t = i as f64 * STEP;
            0.02 * (TAU * t).sin() + 0.012 * (TAU * 6.3 * t + 0.4).sin()
        })
        .collect()
}

/// Force along the samples, one step of the friction crate a sample.
pub fn stepped(law: &LuGre<f64>, v: &[f64]) -> Vec<f64> {
    let mut z = 0.0;
    let mut out = Vec::with_capacity(v.len());
    for (i, &now) in v.iter().enumerate() {
        if i > 0 {
            z = law.step_record(z, STEP, v[i - 1], now);
        }
        out.push(law.force(z, now));
    }
    out
}

/// Velocity known exactly, noise on the force: a first-order autoregression with coefficient `rho`,
/// white for 0.
pub fn autoregressive(rho: f64, run: u64) -> Trial {
    let v = motion(4000);
    let mut noise = Noise::new(1000 + run);
    let innovation = NOISE * (1.0 - rho * rho).sqrt();
    let mut e = NOISE * noise.normal();
    let u = stepped(&MACHINE.law(), &v)
        .iter()
        .map(|u| {
            let now = u + e;
            e = rho * e + innovation * noise.normal();
            now
        })
        .collect();
    let mut truth = MACHINE.truth().to_vec();
    truth.push(("offset", 0.0));
    Trial {
        record: record(STEP, v, u),
        terms: Terms {
            mass: Mass::Absent,
            ..Terms::default()
        },
        truth,
    }
}

/// The log of a drive whose encoder has steps of `count` m, with white noise of `force` N on the force.
/// Speeds and frequencies of the three segments differ a little from run to run, and so does the place
/// of the encoder's steps.
pub fn quantised(count: f64, force: f64, conditioning: &Conditioning, run: u64) -> Trial {
    quantised_law(MACHINE.law(), count, force, conditioning, run)
}

/// The same of an axis with another law; the truth is that of [`MACHINE`].
pub fn quantised_law(
    law: LuGre<f64>,
    count: f64,
    force: f64,
    conditioning: &Conditioning,
    run: u64,
) -> Trial {
    let mut noise = Noise::new(7000 + run);
    let mut near = |x: f64| x * (0.95 + 0.1 * noise.uniform());
    let path = Path::new(vec![
        Sine::new(near(0.1), near(1.0), 2.0),
        Sine::new(near(3.7e-3), near(1.2), 2.0),
        Sine::new(near(25e-3), near(28.0), 2.0),
    ]);
    // Where the counts stand is as good as random on any axis.
    let log = ClosedLoop {
        plant: Plant::new(MASS, law).unwrap(),
        controller: Cascade::tuned(MASS, 60.0, 500.0).unwrap(),
        path: path.unwrap(),
        encoder: Encoder::new(count)
            .unwrap()
            .with_phase(noise.uniform())
            .unwrap(),
        rate: 4000.0,
        substeps: 5,
        force_noise: force,
        force_log: ForceLog::Centred,
        seed: run,
    }
    .run()
    .unwrap();
    let samples = Samples {
        time: log.time,
        position: Some(log.position),
        force: log.force,
        ..Samples::default()
    };
    let conditioning = Conditioning {
        resolution: Some(count),
        ..*conditioning
    };
    let mut truth = MACHINE.truth().to_vec();
    truth.extend([("mass", MASS), ("offset", 0.0)]);
    Trial {
        record: condition(&[samples], &conditioning).unwrap(),
        terms: Terms::default(),
        truth,
    }
}

/// The optimum next to the truth. That the search is global is tested elsewhere; here it only has to
/// be quick.
pub fn local(trial: &Trial, set: &Set) -> (Law, Optimum) {
    let law = Law::new(LawKind::LuGre);
    let truth = [
        (set.sigma0 / set.coulomb).ln(),
        (set.fixed / set.coulomb - 1.0).ln(),
        set.velocity.ln(),
    ];
    let settings = Settings {
        bounds: Some(SearchBox::around(&truth, 0.5)),
        scan: 4,
        starts: 1,
        ..Settings::default()
    };
    let found = separable(&trial.record, law, &trial.terms, &settings, &mut Silent).unwrap();
    (law, found)
}

/// The interval of the same test again, now.
pub fn at_once(p: &Parameter) -> Option<(f64, f64)> {
    let half = p.half?.at_once;
    Some(match p.name.quantity.allowed().is_never_negative() {
        true => {
            let factor = (half / p.value).exp();
            (p.value / factor, p.value * factor)
        }
        false => (p.value - half, p.value + half),
    })
}

/// How often the intervals of one parameter for the same test again held the truth.
#[derive(Clone, Debug)]
pub struct Tally {
    pub name: &'static str,
    pub truth: f64,
    /// Runs that know the parameter to 20 % of its value, or of one for what may be zero, when the same test is repeated at once.
    pub identifiable: usize,
    /// Runs whose interval held the truth.
    pub inside: usize,
    /// Estimates of all runs.
    pub values: Vec<f64>,
    /// Deviations of all runs, where there was one.
    pub deviations: Vec<f64>,
}

impl Tally {
    pub fn new(name: &'static str, truth: f64) -> Self {
        Self {
            name,
            truth,
            identifiable: 0,
            inside: 0,
            values: Vec::new(),
            deviations: Vec::new(),
        }
    }

    /// Part of the intervals that held the truth: of all runs, since the runs in which a parameter
    /// at the edge happens to look identifiable are not a fair sample.
    pub fn coverage(&self) -> f64 {
        self.inside as f64 / self.values.len() as f64
    }

    /// Whether nine runs of ten call it identifiable.
    pub fn counts(&self) -> bool {
        10 * self.identifiable >= 9 * self.values.len()
    }

    pub fn add(&mut self, fitted: &Estimate) {
        let p = fitted.parameter(self.name).unwrap();
        self.values.push(p.value);
        self.deviations
            .extend(p.half.map(|half| half.at_once / 1.96));
        let Some((low, high)) = at_once(p) else {
            return;
        };
        self.identifiable += usize::from(high - low <= 0.4 * p.value.abs().max(1.0));
        self.inside += usize::from(low <= self.truth && self.truth <= high);
    }
}

/// Fits every run and counts.
pub fn coverage(runs: Range<u64>, trial: impl Fn(u64) -> Trial) -> Vec<Tally> {
    let mut tallies: Vec<Tally> = Vec::new();
    for run in runs {
        let trial = trial(run);
        let (law, found) = local(&trial, &MACHINE);
        let mut fitted = estimate(&trial.record, law, &trial.terms, &found, 1e-3);
        intervals(&trial.record, &found, &mut fitted, &mut Silent);
        if tallies.is_empty() {
            tallies.extend(trial.truth.iter().map(|&(name, x)| Tally::new(name, x)));
        }
        for tally in &mut tallies {
            tally.add(&fitted);
        }
    }
    tallies
}
