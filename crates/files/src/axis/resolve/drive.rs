//! `[drive]`: the motor that makes the force of the current or voltage that is logged.

use crate::config::Table;
use crate::error::Error;
use stiction_log::mapping::{BACK_EMFS, FORCE_CONSTANTS, RESISTANCES, SUPPLIES};
use stiction_log::{Dimension, Drive, Motion};

pub(super) fn drive(root: &Table<'_>) -> Result<Option<Drive>, Error> {
    let Some(table) = root.table("drive")? else {
        return Ok(None);
    };
    let per = |a: Dimension, b: Dimension| a.per(b).unwrap_or(a);
    let constant = |motion: Motion| per(motion.force(), Dimension::CURRENT);
    let (linear, rotary) = (constant(Motion::Linear), constant(Motion::Rotary));
    let given = table.get("force_constant");
    let given = given.map(|given| given.among(&[linear, rotary], &FORCE_CONSTANTS));
    let example = "the force of one ampere, such as \"96 N/A\" or \"0.05 N m/A\"";
    let (force_constant, dimension) =
        table.required("force_constant", given.transpose()?, example)?;
    let motion = match dimension == linear {
        true => Motion::Linear,
        false => Motion::Rotary,
    };
    let emf = table.not_negative("back_emf", per(Dimension::VOLTAGE, motion.velocity()))?;
    if emf.is_some_and(|emf| !BACK_EMFS.contains(&emf)) {
        return Err(table.refused("back_emf", &format!("at most {:e}", BACK_EMFS.end())));
    }
    let drive = Drive {
        motion,
        force_constant,
        resistance: table.among("resistance", Dimension::RESISTANCE, &RESISTANCES)?,
        // The power that a motor gives is the one that it takes: both constants are one number in SI.
        back_emf: emf.unwrap_or(force_constant),
        supply: table.among("supply", Dimension::VOLTAGE, &SUPPLIES)?,
    };
    table.end()?;
    Ok(Some(drive))
}
