//! From a table to a log: closed forms, and each finding on a recording made to have it.

use crate::mapping_common;
use crate::mapping_common::{Axis, axis, codes, column, message, noise, table, told, warnings};
use std::f64::consts::PI;
use stiction_formats::{Kind, Scalar, Table, Unit, Value};
use stiction_log::mapping::{PositionLoop, servo};
use stiction_log::{Channel, Drive, Log, Mapping, Motion, Selector, Sign, Wrap};

fn read(table: &Table) -> Log {
    let log = Log::from_table(table, &Mapping::default()).unwrap_or_else(|e| panic!("{e}"));
    // The same where the table is given away.
    let own = Log::of_table(table.clone(), &Mapping::default());
    assert!(own.as_ref() == Ok(&log));
    log
}

#[test]
fn a_clean_log_has_no_warning_and_is_kept_as_it_is() {
    let table = axis(5000).table();
    let log = read(&table);
    assert_eq!(warnings(&log), [""; 0]);
    assert_eq!(log.time, table.columns[0].values);
    assert_eq!(log.position.as_ref().unwrap(), &table.columns[1].values);
    assert_eq!(log.velocity.as_ref().unwrap(), &table.columns[2].values);
    assert_eq!(log.force.as_ref().unwrap(), &table.columns[3].values);
    assert_eq!((log.rate_hz, log.start), (1000.0, 0.0));
    assert_eq!(log.segments, vec![0..5000]);
    assert!(log.valid().iter().all(|v| *v));
}

/// Rounding makes two steps of one, of which the median is neither; their mean is the rate.
#[test]
fn the_rate_of_rounded_time_stamps_is_that_of_their_mean_step() {
    // 4 kHz as seconds since 1970, which 64 bits resolve to 0.24 us; as ticks of 100 ns since the year 1, to 12.8 us; 3 kHz to 1 us.
    let stamps = |f: &dyn Fn(f64) -> f64| (0..4000).map(|i| f(f64::from(i))).collect::<Vec<_>>();
    for (header, time, rate) in [
        (
            "time [s]",
            stamps(&|i| 1_732_622_400.0 + i / 4000.0),
            4000.0,
        ),
        ("time [us]", stamps(&|i| 6.38e16 + i * 250.0), 4000.0),
        ("time [us]", stamps(&|i| (i * 1e6 / 3000.0).round()), 3000.0),
        ("time [ms]", stamps(&|i| i), 1000.0),
    ] {
        let mut axis = axis(4000);
        axis.time = time;
        let mut table = axis.table();
        table.columns[0] = column(header, table.columns[0].values.clone());
        let log = read(&table);
        assert!(
            (log.rate_hz / rate - 1.0).abs() < 1e-5,
            "{header}: {}",
            log.rate_hz
        );
        assert_eq!(log.segments.len(), 1);
    }
}

#[test]
fn large_time_offsets_are_taken_off_before_rounding() {
    // FILETIME: 100 ns ticks since 1601, near 1.3e17, where neighbouring doubles are 16 apart.
    let origin = 133_000_000_000_000_000.0;
    let mut axis = axis(2000);
    axis.time = (0..2000)
        .map(|i| origin + 16_000.0 * f64::from(i))
        .collect();
    let mut table = axis.table();
    table.columns[0].unit = Some("us".into());
    let time = Some(
        Channel::index(1)
            .unit(Unit::parse("us").unwrap())
            .scale("0.1".parse().unwrap()),
    );
    let log = Log::from_table(
        &table,
        &Mapping {
            time,
            ..Mapping::default()
        },
    )
    .unwrap();
    for (i, t) in log.time.iter().enumerate() {
        let exact = 16_000.0 * i as f64 / 1e7;
        assert!(
            (t - exact).abs() <= 2.0 * f64::EPSILON * exact,
            "{t} {exact}"
        );
    }
    assert_eq!(log.rate_hz, 625.0);
    assert_eq!(log.start, origin / 1e7);
}

#[test]
fn gaps_are_counted_and_long_ones_split() {
    let mut table = axis(4000).table();
    // 1 missing after row 99, 3 after 999, 700 after 1999.
    for column in &mut table.columns {
        let keep = |i: usize| i != 100 && !(1001..1004).contains(&i) && !(2003..2703).contains(&i);
        let values = column
            .values
            .iter()
            .enumerate()
            .filter(|(i, _)| keep(*i))
            .map(|(_, x)| *x);
        column.values = values.collect();
    }
    let log = read(&table);
    let gaps: Vec<_> = log
        .gaps
        .iter()
        .map(|g| (g.start_index, g.missing_samples))
        .collect();
    assert_eq!(gaps, [(99, 1), (999, 3), (1998, 700)]);
    assert!((log.gaps[2].seconds - 0.701).abs() < 1e-12);
    assert_eq!(log.segments, vec![0..1999, 1999..3296]);
    assert_eq!(warnings(&log), ["gap"]);
    insta::assert_snapshot!(message(&log, "gap"));
}

#[test]
fn the_first_of_equal_time_stamps_is_kept() {
    let mut table = axis(2000).table();
    for row in [10, 500, 501] {
        table.columns[0].values[row] = table.columns[0].values[row - 1];
    }
    let log = read(&table);
    assert_eq!(log.time.len(), 1997);
    assert_eq!(
        log.position.as_ref().unwrap()[10],
        table.columns[1].values[11]
    );
    let few = message(&log, "duplicate-time").to_string();
    // Milliseconds at 4 kHz: three of four stamps repeat.
    for (i, t) in table.columns[0].values.iter_mut().enumerate() {
        *t = (i / 4) as f64 / 1000.0;
    }
    let error = Log::from_table(&table, &Mapping::default()).unwrap_err();
    assert_eq!(error.kind, Kind::Time);
    insta::assert_snapshot!(format!("{few}\n{error}"));
}

#[test]
fn backward_time_is_refused_unless_cropped_away() {
    let mut table = axis(2000).table();
    for t in &mut table.columns[0].values[1500..] {
        *t -= 1.2;
    }
    let error = Log::from_table(&table, &Mapping::default()).unwrap_err();
    assert_eq!((error.kind, error.place.row), (Kind::Time, Some(1501)));
    insta::assert_snapshot!(error.to_string());
    let mapping = Mapping {
        crop: Some((0.1, 1.4)),
        ..Mapping::default()
    };
    assert_eq!(Log::from_table(&table, &mapping).unwrap().time.len(), 1301);
}

/// From a row on the stamps are milliseconds where seconds were before.
#[test]
fn time_in_two_units_is_refused_where_the_second_begins() {
    for from in [500, 1500] {
        let mut table = axis(2000).table();
        let stamps = &mut table.columns[0].values;
        let step = stamps[1] - stamps[0];
        for t in &mut stamps[from..] {
            *t *= 1e3;
        }
        let error = Log::from_table(&table, &Mapping::default()).unwrap_err();
        let place = (error.kind, error.place.row);
        assert_eq!(place, (Kind::Time, Some(from as u64 + 1)));
        let text = error.to_string();
        let said = format!(
            "time steps of {step} s at the beginning and of {} s",
            1e3 * step
        );
        assert!(text.contains(&said), "{text}");
    }
}

#[test]
fn a_counter_that_overflows_is_counted_on() {
    for size in [65_536.0, 2_147_483_648.0, 4_294_967_296.0_f64] {
        let mut axis = axis(3000);
        axis.time = (0..3000)
            .map(|i| (size - 1000.0 * 7.0 + 7.0 * f64::from(i)) % size)
            .collect();
        let mut table = axis.table();
        table.columns[0].unit = Some("us".into());
        let log = read(&table);
        assert_eq!(warnings(&log), ["velocity-mismatch"]);
        assert!(codes(&log).contains(&"time-wrap"));
        assert!((log.time[2999] - 7e-6 * 2999.0).abs() < 1e-12);
    }
}

#[test]
fn rows_without_time_are_dropped() {
    let mut table = axis(1000).table();
    table.columns[0].values[400] = f64::NAN;
    let log = read(&table);
    assert_eq!(log.time.len(), 999);
    assert_eq!(log.gaps.len(), 1);
    insta::assert_snapshot!(message(&log, "time-missing"));
    table.columns[0].values.fill(f64::NAN);
    assert_eq!(
        Log::from_table(&table, &Mapping::default())
            .unwrap_err()
            .kind,
        Kind::Time
    );
}

#[test]
fn jitter_is_measured() {
    let mut axis = axis(4000);
    for (i, t) in axis.time.iter_mut().enumerate() {
        *t += 1e-4 * noise(i);
    }
    let log = read(&axis.table());
    // Uniform in +-0.1 ms: a difference of two has an rms of 0.1 ms * sqrt(2/3) = 8.16 % of a step.
    let expected = 100.0 * 0.1 * (2.0_f64 / 3.0).sqrt();
    let text = message(&log, "jitter");
    let percent: f64 = text
        .split(['(', ')'])
        .nth(1)
        .unwrap()
        .trim_end_matches(" %")
        .parse()
        .unwrap();
    assert!(
        (percent - expected).abs() < 0.03 * expected,
        "{percent} {expected}"
    );
    assert_eq!(warnings(&log), ["jitter"]);
}

#[test]
fn short_holes_are_bridged_and_long_ones_split() {
    let mut table = axis(3000).table();
    table.columns[1].values[100..103].fill(f64::NAN);
    table.columns[3].values[1000..1050].fill(f64::INFINITY);
    table.columns[3].values[2000] = f64::NAN;
    let log = read(&table);
    assert_eq!(log.time.len(), 2950);
    let x = log.position.as_ref().unwrap();
    // A straight line between the neighbours.
    let third = (x[103] - x[99]) / 4.0;
    for k in 1..4 {
        assert!((x[99 + k] - x[99] - k as f64 * third).abs() < 1e-15);
    }
    let valid = log.valid();
    let invalid: Vec<_> = (0..2950).filter(|i| !valid[*i]).collect();
    assert_eq!(invalid, [100, 101, 102, 1950]);
    assert_eq!(log.segments, vec![0..1000, 1000..2950]);
    let mended = told(&log);
    table.columns[3].values[..1600].fill(f64::NAN);
    let error = Log::from_table(&table, &Mapping::default()).unwrap_err();
    insta::assert_snapshot!(format!("{mended}\n\n{error}"));
}

#[test]
fn a_slow_temperature_is_filled_in() {
    let mut table = axis(1000).table();
    let slow = (0..1000).map(|i| {
        if i % 100 == 50 {
            20.0 + f64::from(i) / 100.0
        } else {
            f64::NAN
        }
    });
    table
        .columns
        .push(column("temperature [degC]", slow.collect()));
    let log = read(&table);
    assert_eq!(warnings(&log), [""; 0]);
    let kelvin = log.temperature.as_ref().unwrap();
    assert_eq!((kelvin[0], kelvin[999]), (293.65, 302.65));
    assert!((kelvin[300] - 296.15).abs() < 1e-9);
    assert!(log.excluded.is_empty());
}

#[test]
fn a_wrapping_position_is_put_together() {
    let mut axis = axis(4000);
    // +-0.05 m folded into +-0.02 m.
    let whole = axis.position.clone();
    for x in &mut axis.position {
        *x -= 0.04 * (*x / 0.04).round();
    }
    let table = axis.table();
    let wrap = Some(Wrap::at(0.02));
    let log = Log::from_table(
        &table,
        &Mapping {
            wrap,
            ..Mapping::default()
        },
    )
    .unwrap();
    for (a, b) in log.position.as_ref().unwrap().iter().zip(&whole) {
        assert!((a - b).abs() < 1e-12);
    }
    assert_eq!(warnings(&log), [""; 0]);
    assert_eq!(log.wrap, Some(0.04));
    let stated = message(&log, "position-wrap").to_string();
    // Not stated, it is seen as jumps and the record is split at them.
    let log = read(&table);
    assert!(warnings(&log).contains(&"position-jump"), "{}", told(&log));
    let jumps = table.columns[1]
        .values
        .windows(2)
        .filter(|w| (w[1] - w[0]).abs() > 0.03)
        .count();
    assert_eq!(log.segments.len(), jumps + 1);
    insta::assert_snapshot!([stated, message(&log, "position-jump")].join("\n"));
    // A jump is no motion: no work is done in it.
    assert!(!codes(&log).contains(&"force-sign"), "{}", told(&log));
    // A wrap that is never reached is said, too.
    let wrap = Some(Wrap::at(20.0));
    let mapping = Mapping {
        wrap,
        ..Mapping::default()
    };
    let log = Log::from_table(&table, &mapping).unwrap();
    assert_eq!(
        message(&log, "position-wrap"),
        "position never wraps (no step is longer than half the wrap of 40 m): nothing was unwrapped"
    );
}

/// A reference that wraps too, and later than the position, ends up in its turns; so does one that does not wrap, however many it
/// counts.
#[test]
fn a_reference_is_in_the_turns_of_its_position() {
    let position = axis(4000).position;
    let wrapped = |x: &f64| x - 0.04 * (x / 0.04).round();
    let ahead = |x: &f64| x + 1e-4;
    for (reference, likewise) in [
        (
            position
                .iter()
                .map(|x| wrapped(&ahead(x)))
                .collect::<Vec<_>>(),
            true,
        ),
        (
            position.iter().map(|x| ahead(x) - 7.0 * 0.04).collect(),
            true,
        ),
        (position.iter().map(ahead).collect(), false),
    ] {
        let mut table = axis(4000).table();
        table.columns[1].values = position.iter().map(wrapped).collect();
        table.columns.push(column("reference [m]", reference));
        let mapping = Mapping {
            wrap: Some(Wrap::Travel(0.04)),
            ..Mapping::default()
        };
        let log = Log::from_table(&table, &mapping).unwrap();
        let [x, r] = [&log.position, &log.reference].map(|x| x.as_ref().unwrap());
        for (x, r) in x.iter().zip(r) {
            assert!((r - x - 1e-4).abs() < 1e-9, "{x} {r}");
        }
        let said = message(&log, "position-wrap");
        assert_eq!(
            said.ends_with("; the reference likewise"),
            likewise,
            "{said}"
        );
    }
}

/// A counter of 16 bits, signed or not, starts again while the axis goes on.
#[test]
fn a_counter_that_overflows_is_put_together() {
    for first in [-32768_i64, 0] {
        let mut axis = axis(4000);
        // 1 um a count: the stroke of 0.1 m overflows 16 bits.
        let counts = |x: f64| (x / 1e-6).round();
        let whole: Vec<f64> = axis.position.iter().map(|x| counts(*x)).collect();
        for x in &mut axis.position {
            *x = (counts(*x) as i64 - first).rem_euclid(65536) as f64 + first as f64;
        }
        let mut table = axis.table();
        table.columns[1].unit = Some("counts".into());
        let position = Channel {
            scale: Some("1 um/count".parse::<Value>().unwrap()),
            ..Channel::named("position")
        };
        let mapping = |wrap| Mapping {
            position: Some(position.clone()),
            wrap,
            ..Mapping::default()
        };
        let split = Log::from_table(&table, &mapping(None)).unwrap();
        let told = message(&split, "position-jump");
        assert!(told.contains("write wrap = \"65536 counts\""), "{told}");
        // A wrap that is none of this counter puts the position together wrongly, which is said.
        for counts in [256.0, 70000.0] {
            let log = Log::from_table(&table, &mapping(Some(Wrap::Counts(counts)))).unwrap();
            assert!(warnings(&log).contains(&"position-wrap"), "{counts}");
            let told = message(&log, "position-wrap");
            assert!(told.contains("under [log]"), "{told}");
        }
        // One less than its bits say, or one more number than it shows: the line that is right is told.
        for wrong in [65535.0, 256.0] {
            let log = Log::from_table(&table, &mapping(Some(Wrap::Counts(wrong)))).unwrap();
            let told = message(&log, "position-wrap");
            assert!(told.contains("write wrap = \"65536 counts\""), "{told}");
        }
        let log = Log::from_table(&table, &mapping(Some(Wrap::Counts(65536.0)))).unwrap();
        let shift = log.position.as_ref().unwrap()[0] - 1e-6 * whole[0];
        for (a, b) in log.position.as_ref().unwrap().iter().zip(&whole) {
            assert!((a - 1e-6 * b - shift).abs() < 1e-9, "{first}");
        }
    }
    // Of a position in metres no counts are known.
    let mapping = Mapping {
        wrap: Some(Wrap::Counts(65536.0)),
        ..Mapping::default()
    };
    let error = Log::from_table(&axis(4000).table(), &mapping).unwrap_err();
    assert_eq!(error.setting(), Some("log.wrap"));
    assert!(error.to_string().contains("the position is in"), "{error}");
}

/// A counter that overflows every few samples, so that no step is small beside its jumps, and one of a turn of 4000 counts.
#[test]
fn a_fast_counter_is_told() {
    for (counts, size) in [(65536_i64, 0.2e-6), (4000, 1e-6)] {
        let mut axis = axis(4000);
        for x in &mut axis.position {
            *x = ((*x / size).round() as i64).rem_euclid(counts) as f64;
        }
        let mut table = axis.table();
        table.columns[1].unit = Some("counts".into());
        let position = Channel {
            scale: Some(format!("{size} m/count").parse::<Value>().unwrap()),
            ..Channel::named("position")
        };
        let mapping = Mapping {
            position: Some(position),
            ..Mapping::default()
        };
        let log = Log::from_table(&table, &mapping).unwrap();
        let told = message(&log, "position-jump");
        let line = format!("write wrap = \"{counts} counts\" under [log]");
        assert!(told.contains(&line), "{told}");
    }
}

/// Counts that are lost in motion, for good or for one sample; a slip out of a rest is no fault.
#[test]
fn single_steps_that_no_motion_makes_split_the_record() {
    let count = |x: &mut f64| *x = (*x / 1e-6).round() * 1e-6;
    let mut lost = axis(4000);
    lost.position[1501..].iter_mut().for_each(|x| *x -= 3e-3);
    let mut garbled = axis(4000);
    garbled.position[2400] += 3e-3;
    let mut slips = axis(4000);
    // Rests of 0.3 s, between which it slips by 0.3 mm within one sample.
    let hold = |i: usize| 3e-4 * (i / 300) as f64;
    (0..4000).for_each(|i| slips.position[i] = hold(i));
    for axis in [&mut lost, &mut garbled, &mut slips] {
        axis.position.iter_mut().for_each(count);
    }
    let read = |axis: Axis| {
        let table = table(vec![
            column("time [s]", axis.time),
            column("position [m]", axis.position),
            column("force [N]", axis.force),
        ]);
        read(&table)
    };
    let (lost, garbled, slips) = (read(lost), read(garbled), read(slips));
    assert_eq!(lost.segments, [0..1501, 1501..4000], "{}", told(&lost));
    assert_eq!(garbled.segments, [0..2400, 2400..2401, 2401..4000]);
    assert!(
        !codes(&slips).contains(&"position-jump"),
        "{}",
        told(&slips)
    );
    let said = [&lost, &garbled].map(|log| message(log, "position-jump"));
    insta::assert_snapshot!(said.join("\n"));
}

#[test]
fn encoder_steps_are_estimated() {
    for (step, rounding) in [
        (1e-6, 0.0),
        (5e-8, 0.0),
        (6.2832e-4, 1e-6),
        (360.0 / 4096.0, 0.0),
    ] {
        let mut axis = axis(4000);
        for (i, x) in axis.position.iter_mut().enumerate() {
            // A slow stretch, where single steps show, as every recording with reversals has.
            let slow = if i < 2000 {
                0.0
            } else {
                400.0 * step * (i as f64 / 150.0).sin()
            };
            *x = ((if i < 2000 { *x } else { slow }) / step).round() * step;
            if rounding > 0.0 {
                *x = (*x / rounding).round() * rounding;
            }
        }
        let log = read(&axis.table());
        let quantum = log.quantum.unwrap_or_else(|| panic!("no step at {step}"));
        assert!(
            (quantum / step - 1.0).abs() < 1e-3,
            "{quantum} against {step}"
        );
    }
    assert_eq!(read(&axis(4000).table()).quantum, None);
}

#[test]
fn a_cut_off_force_is_excluded() {
    let mut axis = axis(4000);
    let limit = 60.0;
    let cut: Vec<usize> = (0..4000)
        .filter(|i| axis.force[*i].abs() >= limit)
        .collect();
    assert!(cut.len() > 500);
    for f in &mut axis.force {
        *f = f.clamp(-limit, limit);
    }
    let table = axis.table();
    let log = read(&table);
    let valid = log.valid();
    let excluded: Vec<usize> = (0..4000).filter(|i| !valid[*i]).collect();
    // Stretches shorter than five samples at the edges, where noise dips below, are left.
    assert!(excluded.iter().all(|i| cut.binary_search(i).is_ok()));
    assert!(excluded.len() as f64 > 0.95 * cut.len() as f64);
    insta::assert_snapshot!(message(&log, "saturation"));
    let mapping = Mapping {
        force_limit: Some(limit),
        ..Mapping::default()
    };
    let log = Log::from_table(&table, &mapping).unwrap();
    let valid = log.valid();
    assert!(cut.iter().all(|i| !valid[*i]));
    let excluded = valid.iter().filter(|v| !**v).count();
    assert!(excluded <= cut.len() + cut.len() / 100);
}

#[test]
fn crests_and_staircases_are_not_cut_off() {
    let slow = |i: usize| 2.0 * PI * 0.25 * i as f64 / 1000.0;
    // Coarse current, smooth, no noise: its crests are flat for tens of samples.
    let mut crest = axis(8000);
    crest.force = (0..8000)
        .map(|i| (500.0 * slow(i).sin()).round() / 10.0)
        .collect();
    assert!(!codes(&read(&crest.table())).contains(&"saturation"));
    // A commanded staircase rests on every level alike.
    let mut stairs = axis(8000);
    stairs.force = (0..8000)
        .map(|i| 10.0 * ((i / 250) as f64 - 16.0).abs())
        .collect();
    assert!(!codes(&read(&stairs.table())).contains(&"saturation"));
    // So does a triangular command in steps of the converter.
    let mut triangle = axis(8000);
    let up_down = |i: usize| 20.0 * ((i % 2000) as f64 / 1000.0 - 1.0).abs() - 10.0;
    triangle.force = (0..8000)
        .map(|i| (up_down(i) / 0.25).round() * 0.25)
        .collect();
    assert!(!codes(&read(&triangle.table())).contains(&"saturation"));
}

#[test]
fn a_frozen_encoder_is_told_from_rest() {
    // Told by the velocity.
    let mut frozen = axis(6000);
    let held = frozen.position[3000];
    frozen.position[3000..3200].fill(held);
    let log = read(&frozen.table());
    assert!(warnings(&log).contains(&"stuck-encoder"), "{}", told(&log));
    assert!(
        log.excluded
            .iter()
            .any(|e| e.samples.start == 3000 && e.samples.len() == 200)
    );
    insta::assert_snapshot!(message(&log, "stuck-encoder"));
    // Told by the jump that follows.
    let mut frozen = axis(6000);
    frozen.position[3000..3200].fill(held);
    let mut table = frozen.table();
    table.columns.remove(2);
    let log = read(&table);
    assert!(warnings(&log).contains(&"stuck-encoder"));
    // Told by the reference, to the end.
    let mut frozen = axis(6000);
    let reference = frozen.position.clone();
    let held = frozen.position[4000];
    frozen.position[4000..].fill(held);
    let mut table = frozen.table();
    table.columns.remove(2);
    table.columns.push(column("reference [m]", reference));
    let log = read(&table);
    assert!(warnings(&log).contains(&"stuck-encoder"));

    // Rest with a noisy velocity, and stiction under a rising force, are not frozen.
    let mut rest = axis(6000);
    let smooth = |i: usize| (1.0 - (PI * i as f64 / 1000.0).cos()) * 0.01;
    for i in 0..6000 {
        let phase = i % 2000;
        let moves = phase < 1000;
        let base = 0.02 * (i / 2000) as f64;
        rest.position[i] = base + if moves { smooth(phase) } else { 0.02 };
        let v = if moves {
            10.0 * PI * (PI * phase as f64 / 1000.0).sin() / 1000.0
        } else {
            0.0
        };
        rest.velocity[i] = v + 1e-3 * noise(i);
        rest.force[i] = phase as f64 / 100.0 + 0.1 * noise(i + 77);
    }
    let log = read(&rest.table());
    assert!(!codes(&log).contains(&"stuck-encoder"), "{}", told(&log));
}

/// An accelerometer beside the encoder, in g, on a mount that is not level; and one that shows something else.
#[test]
fn acceleration_that_is_not_that_of_the_position() {
    let with = |name: &str, unit: &str, factor: f64| {
        let mut table = axis(4000).table();
        let x = table.columns[1].values.clone();
        let bend = |i: usize| match i {
            0 | 3999 => 0.0,
            _ => (x[i + 1] - 2.0 * x[i] + x[i - 1]) * 1e6,
        };
        let values = (0..4000)
            .map(|i| factor * (bend(i) / 9.80665 + 0.02))
            .collect();
        table
            .columns
            .push(column(&format!("{name} [{unit}]"), values));
        read(&table)
    };
    let right = with("Accel Z", "g", 1.0);
    assert_eq!(warnings(&right), [""; 0], "{}", told(&right));
    let found = right.acceleration.as_ref().unwrap();
    assert!((found[0] - 0.02 * 9.80665).abs() < 1e-12);
    // Thousandths of it are no milligrams.
    let thousandths = with("Accel Z", "mg", 1000.0);
    let found = thousandths.acceleration.as_ref().unwrap();
    assert!((found[0] - 0.02 * 9.80665).abs() < 1e-12);
    // A command says nothing of the motion.
    assert!(with("acceleration_cmd", "g", 1.0).acceleration.is_none());
    let lines = [("m/s^2", 1.0), ("g", -1.0), ("g", 1.3)].map(|(unit, factor)| {
        message(&with("acceleration", unit, factor), "acceleration-mismatch").to_string()
    });
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn velocity_that_is_not_the_derivative() {
    let told_by = |factor: f64| {
        let mut axis = axis(4000);
        for v in &mut axis.velocity {
            *v *= factor;
        }
        message(&read(&axis.table()), "velocity-mismatch").to_string()
    };
    let mut lines = [1000.0, 180.0 / PI, -1.0, 1.25].map(told_by).to_vec();
    let mut other = axis(4000);
    other.velocity = (0..4000).map(|i| (i as f64 / 37.0).sin()).collect();
    lines.push(message(&read(&other.table()), "velocity-mismatch").to_string());
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn a_force_that_opposes_motion() {
    let mut axis = axis(4000);
    for f in &mut axis.force {
        *f = -*f;
    }
    let log = read(&axis.table());
    insta::assert_snapshot!(message(&log, "force-sign"));
    assert_eq!(warnings(&log), ["force-sign"]);
    let mapping = Mapping {
        force: Some(Channel::named("force").inverted()),
        ..Mapping::default()
    };
    let table = mapping_common::axis(4000).table();
    assert!(codes(&Log::from_table(&table, &mapping).unwrap()).contains(&"force-sign"));
}

/// A motion with a force whose magnitude alone is logged, and a reference ahead of the motion in the direction of the force.
fn magnitude(count: usize) -> (Table, Vec<f64>) {
    let mut table = axis(count).table();
    let force = table.columns[3].values.clone();
    let position = &table.columns[1].values;
    let ahead: Vec<f64> = position
        .iter()
        .zip(&force)
        .map(|(x, f)| x + 1e-3 * f)
        .collect();
    let signs = force.iter().map(|f| f.signum()).collect();
    table.columns[3]
        .values
        .iter_mut()
        .for_each(|f| *f = f.abs());
    let unit = table.columns[1].unit.clone().unwrap();
    table
        .columns
        .push(column(&format!("reference [{unit}]"), ahead));
    table.columns.push(column("direction", signs));
    (table, force)
}

#[test]
fn a_magnitude_is_found_and_takes_its_sign_from_what_has_it() {
    let (table, force) = magnitude(4000);
    let mut bare = table.clone();
    bare.columns.truncate(4);
    let lines = [&table, &bare].map(|table| message(&read(table), "force-sign").to_string());
    insta::assert_snapshot!(lines.join("\n"));
    for sign in [
        Sign::FollowingError,
        Sign::Column(Selector::Name("direction".into())),
    ] {
        let own = Channel {
            sign: Some(sign),
            ..Channel::named("force")
        };
        let mapping = |force| Mapping {
            force: Some(force),
            ..Mapping::default()
        };
        let log = Log::from_table(&table, &mapping(own.clone())).unwrap();
        assert_eq!(warnings(&log), [""; 0]);
        assert_eq!(log.force.as_ref().unwrap(), &force);
        let inverted = Log::from_table(&table, &mapping(own.inverted())).unwrap();
        let back: Vec<f64> = force.iter().map(|f| -f).collect();
        assert_eq!(inverted.force.as_ref().unwrap(), &back);
    }
    let own = Channel {
        sign: Some(Sign::FollowingError),
        ..Channel::named("force")
    };
    let mapping = Mapping {
        force: Some(own),
        ..Mapping::default()
    };
    let refused = Log::from_table(&bare, &mapping).unwrap_err();
    assert_eq!(refused.kind, Kind::Missing);
    assert!(refused.to_string().contains("reference = "), "{refused}");
}

/// What weighs more than friction never pulls the other way, and is no magnitude.
#[test]
fn a_weight_beyond_friction_keeps_its_sign() {
    for load in [1.2, 2.0, 20.0] {
        let mut axis = axis(4000);
        let most = axis.force.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
        axis.force.iter_mut().for_each(|f| *f += load * most);
        let log = read(&axis.table());
        assert!(
            !codes(&log).contains(&"force-sign"),
            "{load}: {}",
            told(&log)
        );
    }
}

/// The duty of a P loop in closed form, with the gain and the supply of the file, and of the library without them.
#[test]
fn a_servo_makes_its_torque_of_command_and_position() {
    let count = 400;
    let time: Vec<f64> = (0..count).map(|i| f64::from(i) * 0.005).collect();
    let position: Vec<f64> = time.iter().map(|t| (3.0 * t).sin()).collect();
    let goal: Vec<f64> = position
        .iter()
        .enumerate()
        .map(|(i, x)| x + 0.02 * (i as f64 - 200.0))
        .collect();
    let mut table = Table {
        columns: vec![
            column("timestamp", time),
            column("position", position.clone()),
            column("goal_position", goal.clone()),
        ],
        ..Table::default()
    };
    let own = servo("xl330").unwrap();
    let drive = Drive {
        motion: Motion::Rotary,
        force_constant: own.torque_constant,
        resistance: Some(own.resistance),
        back_emf: 0.0,
        supply: None,
        position_loop: Some(PositionLoop {
            kp: None,
            error_gain: own.error_gain,
            duty_limit: own.duty_limit,
            servo: own,
        }),
    };
    let mapping = Mapping {
        motion: Some(Motion::Rotary),
        drive: Some(drive),
        ..Mapping::default()
    };
    // 4096 counts a turn, divided by 256 and by 885 for a duty of 1.
    let gain = 4096.0 / (2.0 * PI) / 256.0 / 885.0;
    let mut compared = |scalars: &[(&str, f64)], kp: f64, supply: f64| {
        table.scalars = scalars
            .iter()
            .map(|(name, value)| Scalar {
                name: (*name).into(),
                value: *value,
            })
            .collect();
        let log = Log::from_table(&table, &mapping).unwrap();
        assert_eq!(log.force_unit, "N*m");
        for (i, force) in log.force.as_ref().unwrap().iter().enumerate() {
            // A command is held until the next one: the mean about the sample is of it and of the one before.
            let held = 0.5 * (goal[i] + goal[i.saturating_sub(1)]);
            let duty = (kp * gain * (held - position[i])).clamp(-1.0, 1.0);
            let wanted = 0.3867 * supply * duty / 4.017;
            assert!((force - wanted).abs() < 1e-12, "{i}: {force} {wanted}");
        }
    };
    compared(&[("kp", 200.0), ("vin", 7.4)], 200.0, 7.4);
    compared(&[("kp", 100.0), ("vin", 5.0)], 100.0, 5.0);
    compared(&[], 400.0, 7.4);
    table.columns.pop();
    let refused = Log::from_table(&table, &mapping).unwrap_err();
    assert!(refused.to_string().contains("reference = "), "{refused}");
}

#[test]
fn motion_that_tells_little() {
    let with = |position: &dyn Fn(usize) -> f64, n: usize| {
        let mut axis = axis(n);
        axis.position = (0..n).map(position).collect();
        let mut table = axis.table();
        table.columns.remove(2);
        read(&table)
    };
    let mut lines = Vec::new();
    for (code, log) in [
        ("no-motion", with(&|_| 0.125, 1000)),
        (
            "no-motion",
            with(&|i| 1e-6 * f64::from(noise(i) > 0.5), 1000),
        ),
        ("noise-only", with(&noise, 1000)),
        (
            "one-direction",
            with(&|i| (i as f64 / 1000.0).powi(2), 1000),
        ),
        (
            "constant-velocity",
            with(&|i| 0.2 * i as f64 / 1000.0 + 1e-5 * noise(i), 1000),
        ),
        ("few-samples", with(&|i| (i as f64 / 3.0).sin(), 20)),
    ] {
        assert!(warnings(&log).contains(&code), "{code}: {}", told(&log));
        lines.push(message(&log, code).to_string());
    }
    insta::assert_snapshot!(lines.join("\n"));
    let flat = table(vec![
        column("t [s]", axis(1000).time),
        column("velocity [m/s]", vec![0.5; 1000]),
        column("force [N]", vec![3.0; 1000]),
    ]);
    let log = read(&flat);
    for code in ["constant-velocity", "one-direction", "constant-column"] {
        assert!(warnings(&log).contains(&code), "{code}: {}", told(&log));
    }
}

#[test]
fn too_little_is_refused() {
    for rows in 0..3 {
        let error = Log::from_table(&axis(rows).table(), &Mapping::default()).unwrap_err();
        assert!(
            [Kind::Value, Kind::Time].contains(&error.kind),
            "{rows}: {error}"
        );
    }
    assert_eq!(read(&axis(3).table()).time.len(), 3);
}

#[test]
fn many_faults_take_linear_time() {
    let n = 2_000_000;
    let mut axis = axis(n);
    let mut clock = 0.0;
    for i in 0..n {
        // Every fifth step misses ten samples, the position is held for runs, wraps, and has holes.
        clock += if i % 5 == 0 { 0.011 } else { 0.001 };
        axis.time[i] = clock;
        axis.position[i] = ((i / 12) as f64 / 40.0).rem_euclid(1.0);
        if i % 31 == 0 {
            axis.force[i] = f64::NAN;
        }
        if i % 29 < 8 {
            axis.force[i] = 100.0;
        }
    }
    let begin = std::time::Instant::now();
    let wrap = Some(Wrap::Travel(1.0));
    let log = Log::from_table(
        &axis.table(),
        &Mapping {
            wrap,
            ..Mapping::default()
        },
    )
    .unwrap();
    assert!(log.segments.len() > n / 6);
    // Anything quadratic in 400 000 gaps or 60 000 runs takes many minutes.
    assert!(begin.elapsed().as_secs() < 30, "{:?}", begin.elapsed());
}

#[test]
fn numbers_too_large_for_a_measurement_are_named() {
    let mut said = String::new();
    for (unit, number) in [("N", 3e100), ("MN", -1e300), ("kN", f64::MAX)] {
        let mut table = axis(300).table();
        table.columns[3].unit = Some(unit.into());
        table.columns[3].values[7..].fill(number);
        let error = Log::from_table(&table, &Mapping::default()).unwrap_err();
        assert_eq!(error.place.row, Some(8));
        said.push_str(&format!("{error}\n"));
    }
    // Empty cells are another matter.
    let mut table = axis(300).table();
    table.columns[3].values[7..].fill(f64::NAN);
    table.columns[3].values[9] = 3e100;
    let error = Log::from_table(&table, &Mapping::default()).unwrap_err();
    said.push_str(&format!("{error}\n"));
    insta::assert_snapshot!(said);
}

/// An infinite number, and one that no `f64` holds, is counted among what is missing, and named.
#[test]
fn infinite_numbers_are_named() {
    let mut table = axis(300).table();
    table.columns[3].values[9] = f64::INFINITY;
    table.columns[3].values[20] = f64::NAN;
    let log = Log::from_table(&table, &Mapping::default()).unwrap();
    let said = message(&log, "missing-cells");
    assert!(
        said.starts_with(
            "force: 2 cells of 300 missing, first in data row 10 of the part that is kept, 1 of them implausibly \
             large, such as inf N in data row 10: "
        ),
        "{said}"
    );
    table.columns[3].values[7..].fill(f64::NEG_INFINITY);
    let error = Log::from_table(&table, &Mapping::default()).unwrap_err();
    assert_eq!(error.place.row, Some(8));
    assert!(
        error.found.starts_with("force is -inf N, and 293 "),
        "{error}"
    );
}

/// Numbers of three hundred digits are written with a power of ten.
#[test]
fn numbers_of_any_size_stay_short() {
    for size in [5e-324, 1e300] {
        let mapping = Mapping {
            resolution: Some(size),
            ..Mapping::default()
        };
        let error = Log::from_table(&axis(300).table(), &mapping).unwrap_err();
        assert!(error.found.ends_with(&format!("is {size:e}")), "{error}");
    }
    let mut table = axis(300).table();
    table.columns[0].values[200] = 5e-324;
    let error = Log::from_table(&table, &Mapping::default()).unwrap_err();
    assert!(error.found.contains("0.199 to 5e-324"), "{error}");
}

/// A step of time, a travel or a force that no axis has is refused with its column: the unit is wrong. What is tiny on purpose is
/// read.
#[test]
fn what_no_axis_does_is_refused() {
    let mut said = String::new();
    let scaled = |column: usize, size: f64| {
        let mut table = axis(300).table();
        table.columns[column]
            .values
            .iter_mut()
            .for_each(|x| *x *= size);
        Log::from_table(&table, &Mapping::default())
    };
    for (column, size) in [
        (0, 1e-12),
        (0, 1e9),
        (1, 1e-300),
        (1, 1e20),
        (3, 1e-20),
        (3, 1e20),
    ] {
        let error = scaled(column, size).unwrap_err();
        assert!(error.setting().is_some());
        said.push_str(&format!("{error}\n"));
    }
    insta::assert_snapshot!(said);
    for (column, size) in [(1, 1e-6), (1, 1e6), (3, 1e-6), (3, 1e6)] {
        scaled(column, size).unwrap();
    }
}

/// A time step, travel, speed or force of no machine is read, and named with the column, its unit and the line for another one.
#[test]
fn what_no_machine_does_is_named() {
    let said = |column: usize, size: f64| {
        let mut table = axis(300).table();
        table.columns[column]
            .values
            .iter_mut()
            .for_each(|x| *x *= size);
        let log = Log::from_table(&table, &Mapping::default()).unwrap();
        let named = log.findings.into_iter();
        let named = named.filter(|f| f.code() == stiction_codes::Code::UnlikelySize);
        named.map(|f| format!("{}\n", f)).collect::<String>()
    };
    let all = [(0, 1e3), (0, 1e-3), (1, 1e3), (1, 1e9), (1, 1e-8), (3, 1e9)];
    let all: String = all.into_iter().map(|(k, size)| said(k, size)).collect();
    insta::assert_snapshot!(all);
    for (column, size) in [(0, 1.0), (1, 1.0), (1, 10.0), (3, 1.0)] {
        assert_eq!(said(column, size), "");
    }
}

/// A force of two values is as coarse as one in steps, however seldom it changes.
#[test]
fn a_force_of_few_values_is_coarse() {
    let with = |levels: f64, every: usize| {
        let mut table = axis(3000).table();
        for (k, x) in table.columns[3].values.iter_mut().enumerate() {
            *x = 10.0 * ((k / every) as f64 % levels);
        }
        Log::from_table(&table, &Mapping::default()).unwrap()
    };
    let coarse = |log: &Log| {
        let mut codes = log.findings.iter().map(|f| f.code());
        codes.any(|code| code == stiction_codes::Code::CoarseForce)
    };
    for levels in [2.0, 5.0, 7.0] {
        let log = with(levels, 500);
        assert!(coarse(&log) && log.has_few_force_levels(), "{levels}");
    }
    let log = with(40.0, 10);
    assert!(coarse(&log) && !log.has_few_force_levels());
    let log = with(1.0, 1);
    assert!(!coarse(&log) && !log.has_few_force_levels());
}

/// A force that is commanded as one step has two values, and no rounding.
#[test]
fn a_step_of_one_level_is_not_coarse() {
    let with = |force: &dyn Fn(usize) -> f64| {
        let mut table = axis(3000).table();
        let values = table.columns[3].values.iter_mut().enumerate();
        values.for_each(|(k, x)| *x = force(k));
        let log = Log::from_table(&table, &Mapping::default()).unwrap();
        let mut codes = log.findings.iter().map(|f| f.code());
        codes.any(|code| code == stiction_codes::Code::CoarseForce)
    };
    assert!(!with(&|k| if k < 1000 { 0.0 } else { 3.0 }));
    assert!(!with(&|k| if (1000..2000).contains(&k) {
        -3.0
    } else {
        0.0
    }));
    // What goes to and fro between two values is rounded to them.
    assert!(with(&|k| if k / 300 % 2 == 0 { 0.0 } else { 3.0 }));
}

/// A wrap that the encoder does not resolve is refused, whether its step is given or seen.
#[test]
fn a_wrap_is_longer_than_the_steps_of_the_encoder() {
    let mut table = axis(3000).table();
    let position = &mut table.columns[1].values;
    position
        .iter_mut()
        .for_each(|x| *x = (*x / 1e-6).round() * 1e-6);
    let with = |period: f64, resolution: Option<f64>| {
        let mapping = Mapping {
            wrap: Some(Wrap::Travel(period)),
            resolution,
            ..Mapping::default()
        };
        Log::from_table(&table, &mapping)
    };
    for (period, resolution) in [(1e-9, None), (1.5e-6, None), (1e-3, Some(1e-3))] {
        let error = with(period, resolution).unwrap_err();
        assert_eq!(error.setting(), Some("log.wrap"), "{error}");
        assert!(
            error.allowed.contains("two steps of the encoder"),
            "{error}"
        );
    }
    with(10.0, None).unwrap();
    with(10.0, Some(1e-6)).unwrap();
}

/// However long the header of a column is, what is said of it stays short.
#[test]
fn long_headers_are_cut() {
    let mut table = axis(300).table();
    table.columns[1].unit = Some("a".repeat(1_000_000));
    let error = Log::from_table(&table, &Mapping::default()).unwrap_err();
    let said = error.to_string();
    assert!(said.len() < 500, "{} bytes", said.len());
    assert!(said.contains("aaa...]"), "{said}");
}

#[test]
fn counts_without_their_sign_are_read_with_it() {
    let mut own = axis(5000);
    own.force
        .iter_mut()
        .for_each(|force| *force = (100.0 * *force).round());
    let signed = own.table();
    let mut unsigned = signed.clone();
    let written = &mut unsigned.columns[3].values;
    written
        .iter_mut()
        .for_each(|count| *count = count.rem_euclid(65536.0));
    assert!(written.iter().any(|count| *count > 65000.0));
    let log = read(&unsigned);
    assert_eq!(log.force, read(&signed).force);
    assert_eq!(
        message(&log, "unsigned-counts"),
        "force has whole numbers near 0 and near 65535 only, as a counter of 16 bits without its sign: 65535 is read as -1"
    );
    assert!(!codes(&read(&signed)).contains(&"unsigned-counts"));
}

/// A drive that is off while the axis moves on is no friction.
#[test]
fn a_force_that_is_zero_while_the_axis_moves_is_left_out() {
    let mut table = axis(8000).table();
    let force = table.columns.iter().position(|c| c.name == "force");
    let force = &mut table.columns[force.unwrap()].values;
    force[3000..4000].iter_mut().for_each(|f| *f *= 1e-3);
    let log = Log::from_table(&table, &Mapping::default()).unwrap();
    assert_eq!(warnings(&log), ["force-dead"]);
    insta::assert_snapshot!(message(&log, "force-dead"));
    let valid = log.valid();
    assert!(!valid[2960] && !valid[3500] && !valid[4040]);
    assert!(valid[2900] && valid[4100]);
    // Passing zero is no such stretch.
    let whole = Log::from_table(&axis(8000).table(), &Mapping::default()).unwrap();
    assert_eq!(warnings(&whole), [""; 0]);
}

/// Where braking takes just what friction does, the force stays near zero for a while: it passes through, or is the friction
/// of an axis whose mass takes nearly all.
#[test]
fn a_force_that_lingers_near_zero_is_kept() {
    let with = |change: fn(f64) -> f64| {
        let mut table = axis(8000).table();
        let force = table.columns.iter().position(|c| c.name == "force");
        let force = &mut table.columns[force.unwrap()].values;
        let top = force.iter().fold(0.0_f64, |top, f| top.max(f.abs()));
        for (i, f) in force[3000..4000].iter_mut().enumerate() {
            *f = top * change(i as f64 / 500.0 - 1.0);
        }
        warnings(&Log::from_table(&table, &Mapping::default()).unwrap())
    };
    assert_eq!(with(|at| 0.3 * at.powi(3)), [""; 0]);
    assert_eq!(with(|at| 0.02 + 0.001 * at), [""; 0]);
    assert_eq!(with(|at| 0.005 + 0.001 * at), ["force-dead"]);
}

/// Rows at one rate, of which a coarser clock stamps some alike, are all kept.
#[test]
fn rows_of_one_rate_keep_their_repeated_stamps() {
    let mut table = axis(8000).table();
    table.columns[0].values = (0..8000)
        .map(|i| (f64::from(i) / 1.024).floor() * 1e-3)
        .collect();
    let log = Log::from_table(&table, &Mapping::default()).unwrap();
    assert_eq!((log.time.len(), log.rate_hz), (8000, 1024.0));
    assert_eq!(warnings(&log), [""; 0]);
    insta::assert_snapshot!(message(&log, "duplicate-time"));
}

/// A wrap below the travel of a position that goes on without a jump is none.
#[test]
fn a_wrap_below_the_travel_is_a_warning() {
    let mapping = |wrap: f64| Mapping {
        wrap: Some(Wrap::Travel(wrap)),
        ..Mapping::default()
    };
    let log = Log::from_table(&axis(5000).table(), &mapping(0.06)).unwrap();
    assert_eq!(warnings(&log), ["position-wrap"]);
    insta::assert_snapshot!(message(&log, "position-wrap"));
    let log = Log::from_table(&axis(5000).table(), &mapping(0.12)).unwrap();
    assert_eq!(warnings(&log), [""; 0]);
}
