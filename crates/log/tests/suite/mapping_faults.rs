//! Random clean logs have no warnings; faults put into them are found; nothing brings the mapping
//! down.

use crate::mapping_common::{codes, column, noise, table, told, warnings};
use proptest::prelude::*;
use stiction_formats::{Column, Kind, Table};
use stiction_log::{Channel, Code, Log, Mapping, Motion, Selector, Sign, Wrap};

/// An axis that follows two sines; force from mass, Coulomb and viscous friction, with noise.
#[derive(Clone, Debug)]
struct Clean {
    rate: f64,
    samples: usize,
    amplitude: f64,
    frequency: f64,
    mass: f64,
    seed: usize,
}

fn clean() -> impl Strategy<Value = Clean> {
    (
        200.0..4000.0_f64,
        1500..4000_usize,
        -4.0..0.5_f64,
        1.2..4.0_f64,
        0.1..50.0_f64,
        0..9999_usize,
    )
        .prop_map(|(rate, samples, decade, turns, mass, seed)| {
            let frequency = turns * rate.round() / samples as f64;
            // The speed of the two sines, of one for an amplitude of 1; no servo axis is faster than 20 m/s.
            let speed = 1.81 * 2.0 * std::f64::consts::PI * frequency;
            Clean {
                rate: rate.round(),
                samples,
                amplitude: 10.0_f64.powf(decade).min(20.0 / speed),
                frequency,
                mass,
                seed: seed * 10_000,
            }
        })
}

impl Clean {
    fn table(&self) -> Table {
        let w = 2.0 * std::f64::consts::PI * self.frequency;
        let a = self.amplitude;
        let t: Vec<f64> = (0..self.samples).map(|i| i as f64 / self.rate).collect();
        let x = t
            .iter()
            .map(|t| a * ((w * t).sin() + 0.3 * (2.7 * w * t).sin()));
        let v: Vec<f64> = t
            .iter()
            .map(|t| a * w * ((w * t).cos() + 0.81 * (2.7 * w * t).cos()))
            .collect();
        let acc = |t: f64| -a * w * w * ((w * t).sin() + 0.3 * 7.29 * (2.7 * w * t).sin());
        let big = self.mass * a * w * w;
        let force = t.iter().zip(&v).enumerate().map(|(i, (t, v))| {
            let friction = big * (v / (0.01 * a * w)).tanh() + 0.5 * big * v / (a * w);
            self.mass * acc(*t) + friction + 0.02 * big * noise(self.seed + i)
        });
        let (x, force) = (x.collect(), force.collect());
        table(vec![
            column("time [s]", t),
            column("position [m]", x),
            column("velocity [m/s]", v),
            column("force [N]", force),
        ])
    }
}

/// What is put into a clean log, and the code that must tell.
const FAULTS: [&str; 10] = [
    "gap",
    "duplicate-time",
    "time-missing",
    "missing-cells",
    "saturation",
    "force-spike",
    "stuck-encoder",
    "velocity-mismatch",
    "force-sign",
    "jitter",
];

fn spoil(table: &mut Table, fault: &str, at: usize, size: usize, seed: usize) {
    let rows = table.rows();
    let values = |table: &mut Table, k: usize| std::mem::take(&mut table.columns[k].values);
    match fault {
        "gap" => {
            for column in &mut table.columns {
                column.values.drain(at..at + size);
            }
        }
        "duplicate-time" => table.columns[0].values[at] = table.columns[0].values[at - 1],
        "time-missing" => table.columns[0].values[at] = f64::NAN,
        "missing-cells" => table.columns[1 + seed % 3].values[at..at + size].fill(f64::NAN),
        "saturation" => {
            let mut force = values(table, 3);
            let top = force.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
            force
                .iter_mut()
                .for_each(|f| *f = f.clamp(-0.5 * top, 0.5 * top));
            table.columns[3].values = force;
        }
        "force-spike" => {
            let top = table.columns[3]
                .values
                .iter()
                .fold(0.0_f64, |m, f| m.max(f.abs()));
            let sign = [-1.0, 1.0][seed % 2];
            table.columns[3].values[at] = 20.0 * sign * top;
        }
        "stuck-encoder" => {
            // Long enough that the axis cannot have been at rest.
            let end = (at + rows / 8).min(rows);
            let held = table.columns[1].values[at];
            table.columns[1].values[at..end].fill(held);
        }
        "velocity-mismatch" => table.columns[2]
            .values
            .iter_mut()
            .for_each(|v| *v *= 1000.0),
        "force-sign" => table.columns[3].values.iter_mut().for_each(|f| *f = -*f),
        "jitter" => {
            let step = table.columns[0].values[1] - table.columns[0].values[0];
            for (i, t) in table.columns[0].values.iter_mut().enumerate() {
                *t += 0.15 * step * noise(seed + i);
            }
        }
        other => panic!("no fault {other}"),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn clean_logs_have_no_warnings(clean in clean()) {
        let log = Log::from_table(&clean.table(), &Mapping::default()).unwrap();
        prop_assert!(!log.has_warnings(), "{}", told(&log));
        prop_assert!(log.excluded.is_empty() && log.gaps.is_empty());
        prop_assert!((log.rate_hz / clean.rate - 1.0).abs() < 1e-8);
    }

    #[test]
    fn faults_are_found(
        clean in clean(),
        fault in prop::sample::select(FAULTS.to_vec()),
        place in 0.1..0.8_f64,
        size in 1..40_usize,
        seed in 0..1000_usize,
    ) {
        let mut table = clean.table();
        let at = (place * clean.samples as f64) as usize;
        spoil(&mut table, fault, at, size, seed);
        let log = Log::from_table(&table, &Mapping::default()).unwrap();
        prop_assert!(codes(&log).contains(&fault), "{fault}: {}", told(&log));
        if fault == "gap" {
            prop_assert_eq!(log.gaps.len(), 1);
            prop_assert_eq!((log.gaps[0].start_index, log.gaps[0].missing_samples), (at - 1, size));
        }
        if fault == "missing-cells" {
            let gone = if size > 5 { size } else { 0 };
            prop_assert_eq!(log.time.len(), clean.samples - gone);
        }
        for finding in &log.findings {
            prop_assert!(Code::ALL.contains(&finding.code()));
            prop_assert!(finding.at.is_none_or(|at| at < clean.samples));
        }
        check(&log)?;
    }

    #[test]
    fn a_backward_step_is_refused_with_its_row(clean in clean(), place in 0.1..0.9_f64) {
        let mut table = clean.table();
        let at = (place * clean.samples as f64) as usize;
        table.columns[0].values[at..].iter_mut().for_each(|t| *t -= 0.1);
        let error = Log::from_table(&table, &Mapping::default()).unwrap_err();
        prop_assert_eq!((error.kind, error.place.row), (Kind::Time, Some(at as u64 + 1)));
    }

    #[test]
    fn the_unit_of_a_file_changes_nothing(clean in clean()) {
        let table = clean.table();
        let mut other = table.clone();
        for (column, (unit, factor)) in
            [("ms", 1e3), ("mm", 1e3), ("mm/s", 1e3), ("mN", 1e3)].iter().enumerate()
        {
            other.columns[column].unit = Some((*unit).into());
            other.columns[column].values.iter_mut().for_each(|x| *x *= factor);
        }
        let a = Log::from_table(&table, &Mapping::default()).unwrap();
        let b = Log::from_table(&other, &Mapping::default()).unwrap();
        for (x, y) in a.position.unwrap().iter().zip(&b.position.unwrap()) {
            prop_assert!((x - y).abs() <= 4.0 * f64::EPSILON * x.abs());
        }
        prop_assert_eq!(warnings_of(&a.findings), warnings_of(&b.findings));
    }
}

fn warnings_of(findings: &[stiction_log::Finding]) -> Vec<&'static str> {
    let warned = findings
        .iter()
        .filter(|f| f.severity == stiction_log::Severity::Warning);
    warned.map(|f| f.code().as_str()).collect()
}

/// What holds of every log.
fn check(log: &Log) -> Result<(), TestCaseError> {
    let n = log.time.len();
    prop_assert_eq!(log.time[0], 0.0);
    prop_assert!(log.time.windows(2).all(|w| w[1] > w[0]));
    prop_assert!(log.rate_hz.is_finite() && log.rate_hz > 0.0);
    let columns = [
        &log.position,
        &log.velocity,
        &log.force,
        &log.reference,
        &log.temperature,
        &log.load,
    ];
    for values in columns.into_iter().flatten() {
        prop_assert_eq!(values.len(), n);
        prop_assert!(values.iter().all(|x| x.is_finite()));
    }
    let mut next = 0;
    for segment in &log.segments {
        prop_assert_eq!(segment.start, next);
        prop_assert!(segment.end > segment.start);
        next = segment.end;
    }
    prop_assert_eq!(next, n);
    prop_assert!(log.excluded.iter().all(|e| e.samples.end <= n));
    prop_assert_eq!(log.valid().len(), n);
    Ok(())
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -1.0..1.0_f64,
        2 => prop::num::f64::ANY,
        1 => prop::sample::select(vec![0.0, 1.0, f64::NAN, f64::INFINITY, f64::MAX, f64::MIN_POSITIVE]),
    ]
}

fn any_column() -> impl Strategy<Value = Column> {
    let name = prop_oneof![
        3 => prop::sample::select(vec![
            "t", "time", "x", "position", "velocity", "force", "tau", "reference", "temperature",
            "normal", "cmd", "",
        ]).prop_map(String::from),
        1 => ".{0,12}",
    ];
    let unit = prop_oneof![
        2 => Just(None),
        3 => prop::sample::select(vec!["s", "ms", "m", "mm", "rad", "rad/s", "m/s", "N", "A", "degC"])
            .prop_map(|u| Some(u.to_string())),
        1 => ".{0,8}".prop_map(Some),
    ];
    let walk = (0.0001..0.1_f64, prop::collection::vec(any_number(), 0..60))
        .prop_map(|(step, n)| (0..n.len()).map(|i| i as f64 * step).collect());
    let values = prop_oneof![prop::collection::vec(any_number(), 0..60), walk];
    (name, unit, values).prop_map(|(name, unit, values)| Column {
        name,
        unit,
        values,
        ..Column::default()
    })
}

fn any_channel() -> impl Strategy<Value = Option<Channel>> {
    let selector = prop_oneof![
        (0..6_usize).prop_map(Selector::Index),
        prop::sample::select(vec!["t", "x", "force"]).prop_map(|n| Selector::Name(n.into())),
    ];
    let unit = prop::sample::select(vec!["s", "m", "rad", "N", "count", "degC", "m/s"]);
    let scale = prop::sample::select(vec!["1", "2 m/rad", "-3 N/A", "1e-300 um/count", "1e300"]);
    let sign = prop_oneof![
        Just(Sign::FollowingError),
        selector.clone().prop_map(Sign::Column)
    ];
    let channel = (
        selector,
        prop::option::of(unit),
        prop::option::of(scale),
        any::<bool>(),
        prop::option::weighted(0.2, sign),
    );
    prop::option::weighted(
        0.3,
        channel.prop_map(|(column, unit, scale, invert, sign)| Channel {
            column,
            unit: unit.map(|u| u.parse().unwrap()),
            scale: scale.map(|s| s.parse().unwrap()),
            invert,
            sign,
        }),
    )
}

fn any_mapping() -> impl Strategy<Value = Mapping> {
    let motion = prop::sample::select(vec![None, Some(Motion::Linear), Some(Motion::Rotary)]);
    let number = || prop::option::weighted(0.2, any_number());
    let crop = prop::option::weighted(0.2, (any_number(), any_number()));
    let channels = [(); 5].map(|()| any_channel());
    (
        motion,
        number(),
        channels,
        number(),
        crop,
        number(),
        number(),
    )
        .prop_map(
            |(motion, rate_hz, channels, period, crop, resolution, force_limit)| {
                let [time, position, velocity, force, reference] = channels;
                let wrap = period.map(Wrap::Travel);
                Mapping {
                    motion,
                    rate_hz,
                    time,
                    position,
                    velocity,
                    force,
                    reference,
                    wrap,
                    crop,
                    resolution,
                    force_limit,
                    ..Mapping::default()
                }
            },
        )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn any_table_is_read_or_refused(
        columns in prop::collection::vec(any_column(), 0..6),
        sample_time in prop::option::of(any_number()),
        mapping in any_mapping(),
    ) {
        let table = Table { columns, sample_time, ..Table::default() };
        match Log::from_table(&table, &mapping) {
            Ok(log) => check(&log)?,
            Err(error) => prop_assert!(!error.found.is_empty()),
        }
    }
}

#[test]
fn the_helpers_of_this_test_make_warnings() {
    // Guards the tests above: with every fault a log must differ from the clean one.
    let clean = Clean {
        rate: 1000.0,
        samples: 3000,
        amplitude: 0.1,
        frequency: 1.0,
        mass: 2.0,
        seed: 3,
    };
    for fault in FAULTS {
        let mut spoiled = clean.table();
        spoil(&mut spoiled, fault, 700, 12, 5);
        let log = Log::from_table(&spoiled, &Mapping::default()).unwrap();
        assert!(!warnings(&log).is_empty(), "{fault}");
    }
}
