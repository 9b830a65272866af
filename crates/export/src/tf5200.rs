//! TwinCAT CNC (TF5200): the friction table of an axis, as entries of its list of compensation values.
//!
//! Parameters P-COMP-00041 to 00047, 00058 and 00062 of Beckhoff's documentation: fewer than 20 pairs of a speed (um/s, or
//! 0.001 deg/s) and a motor current in the units of the drive's actual torque, which CiA 402 counts in per mille of the
//! rated one. How the controller interpolates is not documented; linear interpolation is assumed.

mod spacing;

use crate::model::ALMOST_STANDSTILL;
use crate::number::{Literal, short};
use crate::template::Fill;
use crate::{Error, File, Model, header};
use stiction_friction::ParamError;

const TABLE: &str = include_str!("../templates/tf5200/table.lis.in");
const SELFTEST: &str = include_str!("../templates/tf5200/selftest.py.in");

/// Most entries that every controller takes: fewer than the default of 20 (P-COMP-00041, 00062).
const MAX_POINTS: usize = 19;

/// Largest force of a table, in rated forces: object 60B2h of the drive counts per mille in 16 bits.
const MAX_FORCE_RATIO: f64 = 32.0;

/// Least static friction and least limit, in rated forces: ten steps of the table.
const MIN_FORCE_RATIO: f64 = 1e-3;

/// Largest `position_delay`, in cycles (P-COMP-00043).
const MAX_POSITION_DELAY: f64 = 10.0;

/// Speeds from which the points of the table are chosen.
const GRID_SPEEDS: usize = 3000;

/// Margin of the self-test beyond the table's own error, relative to the scale of forces: the printed numbers have ten digits
/// or more.
const TOLERANCE: f64 = 1e-9;

/// Last speed of a table, in Stribeck velocities: far beyond where the curve falls ...
const END_STRIBECK_VELOCITIES: f64 = 100.0;
/// ... and at least this, m/s; rad/s for a rotary axis.
const MIN_END: (f64, f64) = (1.0, 100.0);

pub(crate) fn files(model: &Model) -> Result<Vec<File>, Error> {
    let rated = rated(model)?;
    let step = speed_step(model.rotary);
    let end = end(model, step);
    let limit = model.settings.limit;
    let kinks = kinks(model, step);
    let grid = grid(end, &kinks);
    let cut = |v: f64| mean(model, v) > limit;
    let limited = grid.iter().any(|n| cut(n * step));
    let at_rest = limited && cut(0.0);
    // Up to the one it is limited at standstill, and from the other on at speed.
    let turns = |kept: bool| kinks.iter().find(|n| cut(**n * step) != kept).copied();
    let (free, from) = (turns(true), turns(false));
    let from = from.map(|n| n * step);
    let wanted: Vec<f64> = grid.iter().map(|n| held(model, n * step)).collect();
    let count = |force: f64| libm::round(force / rated * 1e4);
    let table: Vec<(f64, f64)> = spacing::least_error(&grid, &wanted, MAX_POINTS)
        .into_iter()
        .map(|(at, force)| (grid[at], count(force)))
        .collect();
    let given = |n: f64| interpolate(&table, n) * 1e-4 * rated;
    // Also between the speeds of the grid, up to where the limit is reached.
    let fine: Vec<f64> = grid
        .windows(2)
        .flat_map(|ends| (0..8).map(|k| ends[0] + (ends[1] - ends[0]) * f64::from(k) / 8.0))
        .chain([end])
        .collect();
    let largest = |upto: f64, of: &dyn Fn(f64) -> f64| {
        let speeds = fine.iter().filter(|n| **n * step <= upto);
        speeds.fold((0.0, 0.0), |(most, at), &n| {
            let error = (of(n * step) - given(n)).abs();
            if error > most { (error, n) } else { (most, at) }
        })
    };
    let all = end * step;
    // Where the limit is reached at standstill already, errors are those within it.
    let good = from.filter(|_| !at_rest).unwrap_or(all);
    let most = if at_rest { limit } else { f64::MAX };
    let (mean_error, _) = largest(good, &|v| mean(model, v).min(most));
    let (there, _) = largest(good, &|v| steady(model, v).min(most));
    let (back, _) = largest(good, &|v| (-steady(model, -v)).min(most));
    let side_error = there.max(back);
    let beyond = mean(model, all) - limit;
    let (v_unit, f_unit) = (model.speed_unit(), model.force_unit());
    let at_end = format!("by {beyond:.2e} {f_unit} at {all:.3} {v_unit}");
    let at_speed = from.map_or(String::new(), |v| {
        format!(", and again from {} {v_unit} on, {at_end}", short(v))
    });
    let where_cut = match free {
        Some(n) => format!("up to {} {v_unit}{at_speed}", short(n * step)),
        None => format!("at every speed, {at_end}"),
    };
    let (due_error, worst) = largest(all, &|v| held(model, v));
    let length = model.friction.presliding().unwrap_or(0.0);
    let delay = libm::round(length / (0.1 * step));
    let scale = model.scale().max(f64::MIN_POSITIVE);
    let file = format!("{}_frict_comp", model.identifier);
    let mut speeds: Vec<f64> = grid.iter().copied().step_by(GRID_SPEEDS / 40).collect();
    speeds.extend(kinks);
    speeds.push(worst);
    speeds.sort_by(f64::total_cmp);
    let due: Vec<String> = speeds
        .iter()
        .map(|n| {
            let v = n * step;
            format!("    ({}, {}),", v.c(), held(model, v).c())
        })
        .collect();
    let rows: Vec<String> = table
        .iter()
        .enumerate()
        .map(|(i, (n, out))| {
            format!("frict_comp.table[{i}].in {n:.0}\nfrict_comp.table[{i}].out {out:.0}")
        })
        .collect();
    let mut fill = Fill::default();
    fill.set("header", header::table_comment(model, "# "))
        .set("file", file.clone())
        .set("v_unit", model.speed_unit())
        .set("x_unit", model.length_unit())
        .set("f_unit", model.force_unit())
        .set("in_unit", if model.rotary { "0.001 deg/s" } else { "um/s" })
        .set("rated", rated.c())
        .set("step", step.c())
        .set("end", format!("{good:.3}"))
        .set("entries", table.len().to_string())
        .set("length", format!("{length:.2e}"))
        .set(
            "clamped",
            if delay > MAX_POSITION_DELAY {
                "; the controller takes no more than this"
            } else {
                ""
            },
        )
        .set("delay", format!("{:.0}", delay.min(MAX_POSITION_DELAY)))
        .set("scaling", format!("{:.0}", 1000.0 * model.settings.gain))
        .flag("limited", limited)
        .flag("at_rest", at_rest)
        .set("limit", short(limit).to_string())
        .set("last", format!("{all:.3}"))
        .set("rest_beyond", format!("{:.2e}", mean(model, 0.0) - limit))
        .set("cut", where_cut)
        .set("beyond", format!("{beyond:.2e}"))
        .set("mean_error", format!("{mean_error:.2e}"))
        .set("mean_percent", format!("{:.2}", 100.0 * mean_error / scale))
        .set("side_error", format!("{side_error:.2e}"))
        .set("side_percent", format!("{:.2}", 100.0 * side_error / scale))
        .set("tolerance", (due_error + TOLERANCE * scale).c())
        .set("points", MAX_POINTS.to_string())
        .set("rows", rows.join("\n"))
        .set("due", due.join("\n"));
    Ok(vec![
        File::text(format!("{file}.lis"), fill.render(TABLE)),
        File::text(format!("{file}_selftest.py"), fill.render(SELFTEST)),
    ])
}

/// The rated force, if the table can be written in per mille of it.
fn rated(model: &Model) -> Result<f64, Error> {
    let Some(rated) = model.rated_force else {
        return Err(Error::RatedForce {
            target: "tf5200",
            unit: model.force_unit().into(),
        });
    };
    let limit = model.settings.limit;
    let most = largest_force(model).min(limit);
    let refuse = |name, value, allowed| {
        let source = ParamError::new(name, value, allowed);
        Err(Error::number("table", source))
    };
    if !(rated.is_finite()
        && rated >= most / MAX_FORCE_RATIO
        && rated * MIN_FORCE_RATIO <= model.scale())
    {
        let allowed = "from a 32nd of the table's largest force (the range of the drive's object 60B2h) to 1000 times the static friction \
             (beyond, tenths of a per mille are too coarse)";
        return refuse("rated_force", rated, allowed);
    }
    if limit < rated * MIN_FORCE_RATIO {
        let allowed =
            "from a thousandth of the rated force (below, tenths of a per mille are too coarse)";
        return refuse("limit", limit, allowed);
    }
    Ok(rated)
}

/// Largest force of the table, without a limit.
pub fn largest_force(model: &Model) -> f64 {
    largest_upto(model, f64::MAX)
}

/// The same up to a speed, m/s (rad/s).
pub(crate) fn largest_upto(model: &Model, speed: f64) -> f64 {
    let step = speed_step(model.rotary);
    let end = end(model, step);
    let last = speed.min(end * step);
    let speeds = grid(end, &[]).into_iter().map(|n| n * step);
    let speeds = speeds.take_while(|v| *v < last).chain([last]);
    speeds.fold(0.0, |most, v| most.max(mean(model, v)))
}

/// The unit of a table's speeds, m/s (rad/s).
fn speed_step(rotary: bool) -> f64 {
    if rotary {
        1e-3 * core::f64::consts::PI / 180.0
    } else {
        1e-6
    }
}

/// The table's last speed: far beyond where the curve falls, a whole number of steps.
fn end(model: &Model, step: f64) -> f64 {
    let fast = if model.rotary { MIN_END.1 } else { MIN_END.0 };
    let end = libm::floor((END_STRIBECK_VELOCITIES * model.stribeck_velocity()).max(fast) / step);
    end.min(f64::from(i32::MAX) - 1.0)
}

/// Whole speeds from 0 to `end`, closer where it is slower, with those on both sides of each of `kinks`.
fn grid(end: f64, kinks: &[f64]) -> Vec<f64> {
    let ratio = libm::log(end) / (GRID_SPEEDS - 1) as f64;
    let mut grid = vec![0.0];
    grid.extend((0..GRID_SPEEDS - 1).map(|k| libm::round(libm::exp(ratio * k as f64))));
    grid.extend(kinks.iter().flat_map(|n| [libm::floor(*n), libm::ceil(*n)]));
    grid.push(end);
    grid.retain(|n| *n <= end);
    grid.sort_by(f64::total_cmp);
    grid.dedup();
    grid
}

/// Speeds, in steps, at which the friction passes the limit, each between two of the plain grid.
fn kinks(model: &Model, step: f64) -> Vec<f64> {
    let plain = grid(end(model, step), &[]);
    let beyond = |n: f64| mean(model, n * step) > model.settings.limit;
    let mut found = Vec::new();
    for ends in plain.windows(2) {
        let (mut low, mut high) = (ends[0], ends[1]);
        let first = beyond(low);
        if first == beyond(high) {
            continue;
        }
        while high - low > 0.01 {
            let middle = 0.5 * (low + high);
            *if beyond(middle) == first {
                &mut low
            } else {
                &mut high
            } = middle;
        }
        found.push(high);
    }
    found
}

/// The steady force at a velocity, at rest that of the least speed in its direction.
fn steady(model: &Model, v: f64) -> f64 {
    model.steady(if v == 0.0 {
        v.signum() * ALMOST_STANDSTILL
    } else {
        v
    })
}

/// The mean of both directions; the offset falls out.
pub(crate) fn mean(model: &Model, speed: f64) -> f64 {
    0.5 * (steady(model, speed) - steady(model, -speed))
}

/// The same within the limit: the force to put into the table.
fn held(model: &Model, speed: f64) -> f64 {
    mean(model, speed).min(model.settings.limit)
}

fn interpolate(table: &[(f64, f64)], n: f64) -> f64 {
    let after = table.partition_point(|p| p.0 < n).clamp(1, table.len() - 1);
    let ((a, low), (b, high)) = (table[after - 1], table[after]);
    low + (high - low) * ((n - a) / (b - a))
}
