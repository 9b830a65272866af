//! Whatever is thrown at conditioning and search comes back as an error or as a result whose numbers
//! are finite wherever they are said to be known.

use proptest::prelude::*;
use stiction_identify::{
    Conditioning, Control, Cutoff, Delay, DelayFrom, Dependence, FirstDelay, Lag, Law, LawKind,
    Map, Mass, Observer, Progress, Samples, Settings, Source, Terms, Transmitted, condition,
    cross_validate, estimate, intervals, low_speed_bound, predict, separable,
};

#[derive(Clone, Copy, Debug)]
enum Motion {
    Rest,
    Constant,
    OneWay,
    BothWays,
    Noise,
    Alternating,
}

#[derive(Clone, Copy, Debug)]
enum Force {
    Zero,
    Constant,
    Friction,
    Saturated,
    Noise,
}

#[derive(Clone, Debug)]
struct Case {
    n: usize,
    motion: Motion,
    force: Force,
    /// Powers of ten of time, length and force.
    scale: [f64; 3],
    seed: u64,
}

/// A cheap deterministic sequence in -1..1.
fn noise(seed: u64, i: usize) -> f64 {
    let mut x = (seed ^ i as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    x ^= x >> 29;
    x = x.wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x ^= x >> 32;
    (x >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

impl Case {
    fn samples(&self) -> Samples {
        let [time, length, force] = self.scale.map(|e| 10f64.powf(e));
        let position = |t: f64, i: usize| match self.motion {
            Motion::Rest => 0.3,
            Motion::Constant => 0.1 * t,
            Motion::OneWay => 0.1 * t + 0.005 * (9.0 * t).sin(),
            Motion::BothWays => 0.1 * (5.0 * t).sin() + 0.01 * (31.0 * t).sin(),
            Motion::Noise => 1e-3 * noise(self.seed, i),
            Motion::Alternating => {
                if i.is_multiple_of(2) {
                    1.0
                } else {
                    -1.0
                }
            }
        };
        let h = 1e-3;
        let x: Vec<f64> = (0..self.n).map(|i| position(i as f64 * h, i)).collect();
        let v: Vec<f64> = (0..self.n)
            .map(|i| {
                let (a, b) = (i.saturating_sub(1), (i + 1).min(self.n - 1));
                if a == b {
                    0.0
                } else {
                    (x[b] - x[a]) / ((b - a) as f64 * h)
                }
            })
            .collect();
        let u = (0..self.n).map(|i| {
            let friction = 20.0 * (v[i] / 1e-3).tanh() + 60.0 * v[i] + noise(!self.seed, i);
            match self.force {
                Force::Zero => 0.0,
                Force::Constant => 7.0,
                Force::Friction => friction,
                Force::Saturated => friction.clamp(-15.0, 15.0),
                Force::Noise => noise(!self.seed, i),
            }
        });
        Samples {
            time: (0..self.n).map(|i| i as f64 * h * time).collect(),
            force: u.map(|u| u * force).collect(),
            position: Some(x.iter().map(|x| x * length).collect()),
            velocity: Some(v.iter().map(|v| v * (length / time)).collect()),
            load: Some((0..self.n).map(|i| force * (2.0 + noise(7, i))).collect()),
            temperature: (self.seed & 1 == 0).then(|| vec![300.0; self.n]),
            external: (self.seed & 2 == 0)
                .then(|| (0..self.n).map(|i| force * noise(11, i)).collect()),
            ..Samples::default()
        }
    }
}

fn exponents() -> impl Strategy<Value = [f64; 3]> {
    prop_oneof![
        3 => Just([0.0; 3]),
        1 => [-6.0..6.0, -6.0..6.0, -6.0..6.0],
        1 => [-150.0..150.0, -150.0..150.0, -150.0..150.0],
    ]
}

fn case() -> impl Strategy<Value = Case> {
    use Motion::{Alternating, BothWays, Constant, Noise, OneWay, Rest};
    let n = prop_oneof![1 => 0usize..30, 2 => 30usize..400, 1 => 400usize..2000];
    let motion = prop_oneof![
        1 => Just(Rest),
        1 => Just(Constant),
        1 => Just(OneWay),
        3 => Just(BothWays),
        1 => Just(Noise),
        1 => Just(Alternating)
    ];
    let force = prop_oneof![
        1 => Just(Force::Zero),
        1 => Just(Force::Constant),
        3 => Just(Force::Friction),
        1 => Just(Force::Saturated),
        1 => Just(Force::Noise)
    ];
    (n, motion, force, exponents(), any::<u64>()).prop_map(|(n, motion, force, scale, seed)| Case {
        n,
        motion,
        force,
        scale,
        seed,
    })
}

/// What is broken about a log.
#[derive(Clone, Debug)]
enum Fault {
    None,
    Number(usize, usize, f64),
    Shorter(usize, usize),
    Time(usize, f64),
    Mask(u64),
    ShortMask,
    Breaks(Vec<usize>),
    Channel(bool),
}

fn fault() -> impl Strategy<Value = Fault> {
    let odd = prop_oneof![
        Just(f64::NAN),
        Just(f64::INFINITY),
        Just(f64::NEG_INFINITY),
        Just(1e308),
        Just(-0.0),
        Just(5e-324)
    ];
    prop_oneof![
        4 => Just(Fault::None),
        2 => (0usize..4, 0usize..2000, odd.clone()).prop_map(|(c, i, x)| Fault::Number(c, i, x)),
        1 => (0usize..4, 0usize..2000).prop_map(|(c, i)| Fault::Shorter(c, i)),
        1 => (0usize..2000, odd).prop_map(|(i, x)| Fault::Time(i, x)),
        2 => any::<u64>().prop_map(Fault::Mask),
        1 => Just(Fault::ShortMask),
        1 => prop::collection::vec(0usize..3000, 0..9).prop_map(Fault::Breaks),
        2 => any::<bool>().prop_map(Fault::Channel),
    ]
}

fn spoil(samples: &mut Samples, fault: &Fault) {
    let n = samples.time.len();
    let mut channels = [
        Some(&mut samples.time),
        samples.position.as_mut(),
        samples.velocity.as_mut(),
        Some(&mut samples.force),
    ];
    match fault {
        Fault::None => {}
        Fault::Number(c, i, x) => {
            if let (Some(channel), true) = (&mut channels[*c], n > 0) {
                channel[i % n] = *x;
            }
        }
        Fault::Shorter(c, i) => {
            if let (Some(channel), true) = (&mut channels[*c], n > 0) {
                channel.truncate(i % n);
            }
        }
        Fault::Time(i, x) => {
            if n > 0 {
                let at = i % n;
                samples.time[at] += x * 1e-3;
            }
        }
        Fault::Mask(seed) => samples.valid = (0..n).map(|i| noise(*seed, i / 7) > 0.0).collect(),
        Fault::ShortMask => samples.valid = vec![true; n / 2],
        Fault::Breaks(at) => samples.breaks.clone_from(at),
        Fault::Channel(position) => {
            if *position {
                samples.position = None;
            } else {
                samples.velocity = None;
            }
        }
    }
}

fn conditioning() -> impl Strategy<Value = Conditioning> {
    let cutoff = || {
        prop_oneof![
            3 => Just(Cutoff::Auto),
            3 => Just(Cutoff::Off),
            1 => (1.0..600.0).prop_map(Cutoff::Hz),
            1 => prop_oneof![Just(f64::NAN), Just(-1.0), Just(0.0), Just(f64::INFINITY), Just(1e-9)]
                .prop_map(Cutoff::Hz),
        ]
    };
    let source = prop_oneof![
        Just(None),
        Just(Some(Source::Position)),
        Just(Some(Source::Velocity))
    ];
    let decimate = prop_oneof![
        4 => Just(None),
        2 => (1usize..20).prop_map(Some),
        1 => Just(Some(0)),
        1 => Just(Some(usize::MAX)),
    ];
    let small = || {
        prop_oneof![
            6 => Just(0.0),
            1 => Just(1e-3),
            1 => Just(f64::NAN),
            1 => Just(-1.0),
            1 => Just(f64::INFINITY),
        ]
    };
    (
        source,
        cutoff(),
        cutoff(),
        decimate,
        small(),
        prop::option::of(small()),
    )
        .prop_map(
            |(source, source_cutoff, common_cutoff, decimate, min_speed, resolution)| {
                Conditioning {
                    source,
                    source_cutoff,
                    common_cutoff,
                    force_is_filtered: decimate.is_some_and(|n| n % 2 == 1),
                    decimate,
                    resolution,
                    min_speed,
                    settling: 0.0,
                }
            },
        )
}

fn law() -> impl Strategy<Value = Law> {
    let exponent = prop_oneof![3 => Just(2.0), 1 => Just(1.0), 1 => Just(0.1), 1 => Just(10.0)];
    let elements = prop_oneof![Just(0), 1usize..11];
    let kind = 0..LawKind::ALL.len();
    (kind, any::<bool>(), exponent, elements).prop_map(|(kind, asymmetric, exponent, elements)| {
        Law {
            asymmetric,
            exponent,
            elements,
            exponent_fitted: exponent == 1.0,
            ..Law::new(LawKind::ALL[kind])
        }
    })
}

fn terms() -> impl Strategy<Value = Terms> {
    let mass = prop_oneof![
        Just(Mass::Fitted),
        Just(Mass::Absent),
        (-30.0..30.0).prop_map(|e: f64| Mass::Given(10f64.powf(e)))
    ];
    let pitches = prop::collection::vec((-9.0..9.0).prop_map(|e: f64| 10f64.powf(e)), 0..3);
    let dependence = prop_oneof![
        Just(Dependence::CoulombLoad(0.0)),
        Just(Dependence::CoulombTransmitted(Transmitted::default())),
        Just(Dependence::CoulombDriven(Transmitted::default())),
        Just(Dependence::CoulombTemperature(0.0)),
        Just(Dependence::CoulombPosition(0.0)),
        Just(Dependence::CoulombMap(Map::default())),
        (-9.0..9.0).prop_map(|e: f64| Dependence::CoulombPitch(10f64.powf(e))),
        Just(Dependence::ViscousTemperature(0.0)),
    ];
    let dependences = prop_oneof![
        2 => Just(Vec::new()),
        1 => prop::collection::vec(dependence, 0..4),
    ];
    let flags = (any::<bool>(), any::<bool>(), any::<bool>());
    let delay = prop_oneof![
        Just(Delay::Fitted),
        (-9.0..9.0).prop_map(|e: f64| Delay::Given(10f64.powf(e)))
    ];
    let lag = prop_oneof![
        Just(Lag::NONE),
        (-18.0..6.0, -36.0..6.0).prop_map(|(square, variance): (f64, f64)| Lag {
            square: 10f64.powf(square),
            variance: 10f64.powf(variance),
        })
    ];
    let from = prop_oneof![
        Just(DelayFrom::Stated),
        (-9.0..9.0).prop_map(|e: f64| DelayFrom::OtherLaw(10f64.powf(e)))
    ];
    let deviation = prop_oneof![Just(0.0), (-9.0..9.0).prop_map(|e: f64| 10f64.powf(e))];
    let first_delay = prop::option::of((-1e3..1e3, -9.0..9.0)).prop_map(|given| {
        given.map(|(delay, deviation): (f64, f64)| FirstDelay {
            delay,
            deviation: 10f64.powf(deviation),
        })
    });
    let delay = (delay, deviation, from);
    let lag = (lag, first_delay, any::<bool>());
    let parts = (mass, flags, pitches, dependences, delay, lag);
    parts.prop_map(|(mass, flags, cogging, dependences, delay, lag)| Terms {
        mass,
        offset: flags.0,
        gravity: flags.1,
        cogging,
        quadratic_viscous: flags.2,
        dependences,
        delay: delay.0,
        delay_deviation: delay.1,
        delay_from: delay.2,
        lag: lag.0,
        first_delay: lag.1,
        low_pass_undone: lag.2,
        ..Terms::default()
    })
}

/// Counts, and asks to stop far beyond what any search may need.
struct Counter(usize);

impl Observer for Counter {
    fn progress(&mut self, progress: &Progress) -> Control {
        assert!((0.0..=1.0).contains(&progress.fraction), "{progress:?}");
        self.0 += 1;
        assert!(self.0 < 20_000, "a search that never ends");
        Control::Continue
    }
}

fn run(
    samples: &[Samples],
    conditioning: &Conditioning,
    law: Law,
    terms: &Terms,
) -> Result<(), TestCaseError> {
    let Ok(record) = condition(samples, conditioning) else {
        return Ok(());
    };
    prop_assert!(record.kept() <= record.len());
    let terms = &terms.about(&record);
    let total: usize = samples.iter().map(|s| s.time.len()).sum();
    prop_assert!(record.len() <= 10 * total, "{} from {total}", record.len());
    let mut counter = Counter(0);
    let Ok(found) = separable(&record, law, terms, &Settings::default(), &mut counter) else {
        return Ok(());
    };
    let bound = low_speed_bound(&record);
    let mut e = estimate(&record, law, terms, &found, bound);
    intervals(&record, &found, &mut e, &mut stiction_identify::Silent);
    for p in &e.parameters {
        if !p.identifiable {
            prop_assert!(!p.reason.is_empty(), "{} without a reason", p.name);
            continue;
        }
        prop_assert!(p.value.is_finite(), "{} = {}", p.name, p.value);
        if p.identified {
            let std = p.std.expect("an identifiable parameter has a deviation");
            prop_assert!(std.is_finite() && std >= 0.0, "{}: {std}", p.name);
            let (low, high) = p.ci95.expect("an identifiable parameter has an interval");
            prop_assert!(
                low.is_finite() && high.is_finite() && low <= p.value && p.value <= high,
                "{}: {} in {low} .. {high}",
                p.name,
                p.value
            );
        }
    }
    prop_assert_eq!(e.fit.samples, record.kept());
    prop_assert_eq!(predict(&record, &e).model.len(), record.kept());
    let score = cross_validate(&record, &e, &found, 2, &mut counter);
    prop_assert!(score.held_out.is_none_or(|f| f.samples == record.kept()));
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    /// One log, broken or not, any conditioning, any law.
    #[test]
    fn one_log(
        case in case(),
        fault in fault(),
        conditioning in conditioning(),
        law in law(),
        terms in terms(),
    ) {
        let mut samples = case.samples();
        spoil(&mut samples, &fault);
        run(&[samples], &conditioning, law, &terms)?;
    }

    /// Whole logs that say little or too much, with the settings that a user gets: the fit itself.
    #[test]
    fn whole_logs(case in case(), law in law(), terms in terms()) {
        run(&[case.samples()], &Conditioning::default(), law, &terms)?;
    }

    /// Several logs that do not belong together.
    #[test]
    fn several_logs(
        cases in prop::collection::vec((case(), fault()), 0..4),
        conditioning in conditioning(),
        law in law(),
        terms in terms(),
    ) {
        let logs: Vec<Samples> = cases
            .iter()
            .map(|(case, fault)| {
                let mut samples = case.samples();
                spoil(&mut samples, fault);
                samples
            })
            .collect();
        run(&logs, &conditioning, law, &terms)?;
    }
}
