//! TwinCAT CNC (TF5200): the friction table of an axis, as entries of its list of compensation values.
//!
//! Parameters P-COMP-00041 to 00047, 00058 and 00062 of Beckhoff's documentation: fewer than 20 pairs of a speed (um/s, or
//! 0.001 deg/s) and a motor current in the units of the drive's actual torque, which CiA 402 counts in per mille of the
//! rated one. How the controller interpolates is not documented; linear is taken.

mod spacing;

use crate::number::{Literal, short};
use crate::template::Fill;
use crate::{Error, File, Model, header};
use stiction_friction::ParamError;
use stiction_friction::compensator::Friction;

const TABLE: &str = include_str!("../templates/tf5200/table.lis.in");
const SELFTEST: &str = include_str!("../templates/tf5200/selftest.py.in");

/// Entries that every controller takes: fewer than the 20 that are set up by default (P-COMP-00041, 00062).
const POINTS: usize = 19;

/// Largest force in rated ones: the drive's 60B2h counts per mille in 16 bits.
const MOST_RATED: f64 = 32.0;

/// Least static friction in rated forces: ten steps of the table.
const LEAST_RATED: f64 = 1e-3;

/// Largest `position_delay` (P-COMP-00043).
const LONGEST_DELAY: f64 = 10.0;

/// Speeds between which errors are looked for.
const GRID: usize = 3000;

pub(crate) fn files(model: &Model) -> Result<Vec<File>, Error> {
    let rated = rated(model)?;
    let step = speed_step(model.rotary);
    let end = end(model, step);
    let limited = largest_force(model) > model.settings.limit;
    // Where the limit cuts the static friction already, it is part of every error.
    let from = model
        .saturates_from(1.0)
        .filter(|from| model.settings.limit >= model.scale() && *from < end * step);
    let grid = grid(end, &kinks(model, step));
    let wanted: Vec<f64> = grid.iter().map(|n| mean(model, n * step)).collect();
    let count = |force: f64| libm::round(force / rated * 1e4);
    let table: Vec<(f64, f64)> = spacing::least_error(&grid, &wanted, POINTS)
        .into_iter()
        .map(|(at, force)| (grid[at], count(force)))
        .collect();
    let given = |n: f64| interpolate(&table, n) * 1e-4 * rated;
    // Between the speeds of the grid too, up to where the limit cuts.
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
    let (all, good) = (end * step, from.unwrap_or(end * step));
    let (mean_error, _) = largest(good, &|v| mean_of(v, &|v| steady(model, v)));
    let side_error = largest(good, &|v| steady(model, v))
        .0
        .max(largest(good, &|v| -steady(model, -v)).0);
    let (beyond, _) = largest(all, &|v| mean_of(v, &|v| steady(model, v)));
    let (due_error, worst) = largest(all, &|v| mean(model, v));
    let length = match &model.friction {
        Friction::LuGre(law) => law.bound(),
        _ => 0.0,
    };
    let delay = libm::round(length / (0.1 * step));
    let scale = model.scale().max(f64::MIN_POSITIVE);
    let file = format!("{}_frict_comp", model.identifier);
    let mut speeds: Vec<f64> = grid.iter().copied().step_by(GRID / 40).collect();
    speeds.extend(kinks(model, step));
    speeds.push(worst);
    speeds.sort_by(f64::total_cmp);
    let due: Vec<String> = speeds
        .iter()
        .map(|n| {
            let v = n * step;
            format!("    ({}, {}),", v.c(), mean(model, v).c())
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
            if delay > LONGEST_DELAY {
                "; the controller takes no more than this"
            } else {
                ""
            },
        )
        .set("delay", format!("{:.0}", delay.min(LONGEST_DELAY)))
        .set("scaling", format!("{:.0}", 100.0 * model.settings.gain))
        .flag("limited", limited)
        .flag("at_speed", from.is_some())
        .set("limit", short(model.settings.limit).to_string())
        .set("last", format!("{all:.3}"))
        .set("beyond", format!("{beyond:.2e}"))
        .set("mean_error", format!("{mean_error:.2e}"))
        .set("mean_percent", format!("{:.2}", 100.0 * mean_error / scale))
        .set("side_error", format!("{side_error:.2e}"))
        .set("side_percent", format!("{:.2}", 100.0 * side_error / scale))
        .set("tolerance", (due_error + 1e-9 * scale).c())
        .set("points", POINTS.to_string())
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
    let most = largest_force(model).min(model.settings.limit);
    if rated.is_finite() && rated >= most / MOST_RATED && rated * LEAST_RATED <= model.scale() {
        return Ok(rated);
    }
    let allowed = "from a 32nd of the table's largest force, which is the range of the drive's 60B2h, to 1000 times the static friction, \
         below which tenths of a per mille are too coarse";
    Err(Error::number(
        "table",
        ParamError::new("rated_force", rated, allowed),
    ))
}

/// Largest steady force at the speeds of the table, without a limit.
pub fn largest_force(model: &Model) -> f64 {
    largest_upto(model, f64::MAX)
}

/// The same at those that are not above a speed, m/s (rad/s), and at that speed.
pub(crate) fn largest_upto(model: &Model, speed: f64) -> f64 {
    let step = speed_step(model.rotary);
    let end = end(model, step);
    let speeds = grid(end, &[]).into_iter().map(|n| n * step);
    let last = speed.min(end * step);
    let forces = speeds
        .take_while(|v| *v < last)
        .chain([last])
        .flat_map(|v| [steady(model, v).abs(), steady(model, -v).abs()]);
    forces.fold(0.0, f64::max)
}

/// What one in a table's speed is, m/s (rad/s).
fn speed_step(rotary: bool) -> f64 {
    if rotary {
        1e-3 * core::f64::consts::PI / 180.0
    } else {
        1e-6
    }
}

/// The table's last speed: far beyond where the curve falls, a whole number of steps.
fn end(model: &Model, step: f64) -> f64 {
    let fast = if model.rotary { 100.0 } else { 1.0 };
    let end = libm::floor((100.0 * model.stribeck_velocity()).max(fast) / step);
    end.min(f64::from(i32::MAX) - 1.0)
}

/// Whole speeds from 0 to `end`, closer where it is slower, with those on both sides of each of `kinks`.
fn grid(end: f64, kinks: &[f64]) -> Vec<f64> {
    let ratio = libm::log(end) / (GRID - 1) as f64;
    let mut grid = vec![0.0];
    grid.extend((0..GRID - 1).map(|k| libm::round(libm::exp(ratio * k as f64))));
    grid.extend(kinks.iter().flat_map(|n| [libm::floor(*n), libm::ceil(*n)]));
    grid.push(end);
    grid.retain(|n| *n <= end);
    grid.sort_by(f64::total_cmp);
    grid.dedup();
    grid
}

/// Speeds, in steps, at which the limit begins or ends to cut a direction, each between two of the plain grid.
fn kinks(model: &Model, step: f64) -> Vec<f64> {
    let plain = grid(end(model, step), &[]);
    let limit = model.settings.limit;
    let mut found = Vec::new();
    for sign in [1.0, -1.0] {
        let beyond = |n: f64| steady(model, sign * n * step).abs() > limit;
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
    }
    found
}

/// The steady force at a velocity, at rest that of the least speed in its direction.
fn steady(model: &Model, v: f64) -> f64 {
    model.steady(if v == 0.0 { v.signum() * 1e-300 } else { v })
}

/// The mean of both directions; the offset falls out.
fn mean_of(speed: f64, side: &dyn Fn(f64) -> f64) -> f64 {
    0.5 * (side(speed) - side(-speed))
}

/// The same within the limit: what the table is to hold.
fn mean(model: &Model, speed: f64) -> f64 {
    let limit = model.settings.limit;
    mean_of(speed, &|v| steady(model, v).clamp(-limit, limit))
}

fn interpolate(table: &[(f64, f64)], n: f64) -> f64 {
    let after = table.partition_point(|p| p.0 < n).clamp(1, table.len() - 1);
    let ((a, low), (b, high)) = (table[after - 1], table[after]);
    low + (high - low) * ((n - a) / (b - a))
}
