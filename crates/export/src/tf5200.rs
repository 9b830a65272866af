//! TwinCAT CNC (TF5200): the friction table of an axis, as entries of its list of compensation values.
//!
//! Parameters P-COMP-00041 to 00047, 00058 and 00062 of Beckhoff's documentation: up to 20 pairs of a speed (um/s, or
//! 0.001 deg/s) and a motor current in the units of the drive's actual torque, which CiA 402 counts in per mille of the
//! rated one. How the controller interpolates is not documented; linear is taken.

mod spacing;

use crate::number::Literal;
use crate::template::Fill;
use crate::{Error, File, Model, header};
use stiction_friction::ParamError;
use stiction_friction::compensator::Friction;

const TABLE: &str = include_str!("../templates/tf5200/table.lis.in");
const SELFTEST: &str = include_str!("../templates/tf5200/selftest.py.in");

/// Entries that every controller takes (P-COMP-00062).
const POINTS: usize = 20;

/// Largest `position_delay` (P-COMP-00043).
const LONGEST_DELAY: f64 = 10.0;

/// Speeds between which errors are looked for.
const GRID: usize = 3000;

pub(crate) fn files(model: &Model) -> Result<Vec<File>, Error> {
    let rated = rated(model)?;
    let step = speed_step(model.rotary);
    let grid = grid(model, step);
    let wanted: Vec<f64> = grid.iter().map(|n| mean(model, n * step)).collect();
    let count = |force: f64| libm::round(force / rated * 1e4);
    let table: Vec<(f64, f64)> = spacing::least_error(&grid, &wanted, POINTS)
        .into_iter()
        .map(|(at, force)| (grid[at], count(force)))
        .collect();
    let given = |n: f64| interpolate(&table, n) * 1e-4 * rated;
    let largest = |of: &dyn Fn(f64) -> f64| {
        let errors = grid.iter().map(|&n| (of(n * step) - given(n)).abs());
        errors.fold(0.0, f64::max)
    };
    let mean_error = largest(&|v| mean(model, v));
    let side_error = largest(&|v| side(model, v)).max(largest(&|v| -side(model, -v)));
    let length = match &model.friction {
        Friction::LuGre(law) => law.bound(),
        _ => 0.0,
    };
    let delay = libm::round(length / (0.1 * step));
    let scale = model.scale().max(f64::MIN_POSITIVE);
    let file = format!("{}_frict_comp", model.identifier);
    let due: Vec<String> = grid
        .iter()
        .zip(&wanted)
        .step_by(GRID / 40)
        .map(|(n, force)| format!("    ({}, {}),", (n * step).c(), force.c()))
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
        .set("end", format!("{:.3}", grid[grid.len() - 1] * step))
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
        .set("mean_error", format!("{mean_error:.2e}"))
        .set("mean_percent", format!("{:.2}", 100.0 * mean_error / scale))
        .set("side_error", format!("{side_error:.2e}"))
        .set("side_percent", format!("{:.2}", 100.0 * side_error / scale))
        .set("tolerance", (mean_error + 1e-9 * scale).c())
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
        return Err(Error::RatedForce { target: "tf5200" });
    };
    // The table's numbers are of 32 bits.
    let least = 1e4 * model.settings.limit / f64::from(i32::MAX);
    if rated.is_finite() && rated > least {
        return Ok(rated);
    }
    let allowed = "finite, > 0, and the force in 0.1 per mille of it within 32 bits";
    Err(Error::number(
        "SGN32",
        ParamError::new("rated_force", rated, allowed),
    ))
}

/// What one in a table's speed is, m/s (rad/s).
fn speed_step(rotary: bool) -> f64 {
    if rotary {
        1e-3 * core::f64::consts::PI / 180.0
    } else {
        1e-6
    }
}

/// Whole speeds from 0, closer where it is slower, to far beyond where the curve falls.
fn grid(model: &Model, step: f64) -> Vec<f64> {
    let falls = match &model.friction {
        Friction::Coulomb(_) => 0.0,
        Friction::Stribeck(curve) => slowest(curve),
        Friction::LuGre(law) => slowest(law.curve()),
    };
    let fast = if model.rotary { 100.0 } else { 1.0 };
    let end = libm::floor((100.0 * falls).max(fast) / step).min(f64::from(i32::MAX) - 1.0);
    let ratio = libm::log(end) / (GRID - 1) as f64;
    let mut grid = vec![0.0];
    grid.extend((0..GRID - 1).map(|k| libm::round(libm::exp(ratio * k as f64))));
    grid.push(end);
    grid.dedup();
    grid
}

fn slowest(curve: &stiction_friction::Stribeck<f64>) -> f64 {
    let (pos, neg) = (curve.positive(), curve.negative());
    pos.stribeck_velocity.max(neg.stribeck_velocity)
}

/// The steady force at a velocity that is not 0, within the limit.
fn side(model: &Model, v: f64) -> f64 {
    let v = if v == 0.0 { v + v.signum() * 1e-300 } else { v };
    let force = match &model.friction {
        Friction::Coulomb(law) => law.force(v),
        Friction::Stribeck(curve) => curve.force(v),
        Friction::LuGre(law) => law.curve().force(v),
    };
    force.clamp(-model.settings.limit, model.settings.limit)
}

/// The mean of both directions; the offset falls out.
fn mean(model: &Model, speed: f64) -> f64 {
    0.5 * (side(model, speed) - side(model, -speed))
}

fn interpolate(table: &[(f64, f64)], n: f64) -> f64 {
    let after = table.partition_point(|p| p.0 < n).clamp(1, table.len() - 1);
    let ((a, low), (b, high)) = (table[after - 1], table[after]);
    low + (high - low) * ((n - a) / (b - a))
}
