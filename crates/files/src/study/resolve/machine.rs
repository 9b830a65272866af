//! `[axis]` and `[second_axis]`

use super::depends::depends;
use super::dimensions::Dimensions;
use super::disturbance::disturbance;
use super::drive::drive;
use super::inputs::input;
use super::published::published;
use crate::config::machine::MASSES;
use crate::config::{Form, Table};
use crate::error::{Error, Warning};
use crate::study::model::{Model, axis_law};
use crate::study::plan::Machine;
use crate::study::result::StudyInput;
use std::path::Path;
use stiction_codes::Code;
use stiction_formats::Dimension;
use stiction_friction::Damping;
use stiction_log::mapping::WRAPS;
use stiction_number::short;
use stiction_parameters::Quantity;
use stiction_servo::disturbance::Cogging;
use stiction_servo::encoder::Encoder;
use stiction_servo::known;

/// Least rate at which the plant is stepped, Hz: that of the simulations of Zhang et al. (steps of 1e-4 s).
const PLANT_RATE: f64 = 1e4;
/// Most plant steps of a control period: a choice that bounds the time of a study.
const MOST_SUBSTEPS: f64 = 100.0;
/// Longest step h of the plant as `h sqrt(sigma0/M)`, dimensionless: one radian of the swing on the bristles. Longer steps do
/// not show that swing (`docs/codes/long-steps.md`).
const LONGEST_STEP: f64 = 1.0;

/// An axis; the control rate is that of the first axis where there is one. What was read for it is added to `inputs`.
pub(super) fn machine(
    table: &Table<'_>,
    folder: &Path,
    first: Option<f64>,
    inputs: &mut Vec<StudyInput>,
) -> Result<Machine, Error> {
    let mut model = match (
        table.get("model"),
        table.get("known"),
        table.get("parameters"),
    ) {
        (None, None, Some(given)) => published(&given)?,
        (Some(given), None, None) => {
            let (file, text) = given.file(folder, Form::Model)?;
            inputs.push(input(&file, &text));
            Model::parse(&text, &file)?
        }
        (None, Some(given), None) => {
            let names: Vec<_> = known::all().map(|axis| axis.name).collect();
            let name = given.choice(&names)?;
            Model::known(name).ok_or_else(|| given.refused(&names.join(", ")))?
        }
        (None, None, None) => {
            let allowed = "give a model file, known = \"motor\" for a known axis, or parameters = { sigma0 = \"2e6 N/m\", .. }";
            return Err(table.refuse("model", "is missing".into(), allowed));
        }
        (Some(_), Some(_), _) => {
            let allowed = "a model file, a known axis or parameters";
            return Err(table.refuse("known", "stands beside model".into(), allowed));
        }
        (model, _, Some(given)) => {
            let beside = if model.is_some() { "model" } else { "known" };
            let allowed = "a model file, a known axis or parameters";
            return Err(given.refuse(format!("stands beside {beside}"), allowed));
        }
    };
    let motion = model.motion;
    let is = Dimensions::of(motion);
    let swept = match (first, table.swept()) {
        (None, Some(swept)) => model.take(&swept)?,
        _ => None,
    };
    // The law of a model that was read, or of a known axis, is one.
    let law = axis_law(&model.values()).map_err(|e| {
        let allowed = "a model whose parameters make a law";
        match swept {
            Some(given) => given.refuse(e.to_string(), allowed),
            None => table.refuse("model", e.to_string(), allowed),
        }
    })?;
    let law = match table.choice("sigma1", &["capped", "constant"])? {
        Some("constant") => Ok(law),
        _ => law.damped_as(Damping::Capped),
    };
    let law = law.map_err(|e| table.together(&e))?;
    let depends = depends(table, &model, &law)?;
    let given = table.among("mass", is.mass, &MASSES)?;
    let of_model = model.value(Quantity::Mass);
    if let (None, Some(mass)) = (given, of_model.filter(|mass| !MASSES.contains(mass))) {
        let unit = is.mass.si_text();
        let found = format!("{} {unit}", stiction_number::shortest(mass));
        let (least, most) = (MASSES.start(), MASSES.end());
        let allowed = format!(
            "a study needs a mass from {least:e} to {most:e} {unit}: in the model, or as mass of its axis"
        );
        return Err(model.refuse_parameter("mass", found, &allowed));
    }
    let mass = table.required(
        "mass",
        given.or(of_model),
        "one such as \"4.6 kg\": the model has none",
    )?;
    let rate = match first {
        None => table.positive("rate", Dimension::FREQUENCY)?,
        rate => rate,
    };
    let rate = table.required("rate", rate, "the control rate, such as \"4 kHz\"")?;
    if !(10.0..=1e6).contains(&rate) {
        return Err(table.refuse("rate", format!("{rate} Hz"), "10 Hz to 1 MHz"));
    }
    let stiffness = Dimensions::per(is.force, is.length);
    let viscous = table.not_negative("viscous", Dimensions::per(is.force, is.speed))?;
    let spring = table.not_negative("spring", stiffness)?.unwrap_or(0.0);
    let (substeps, warning) = plant_steps((law.stiffness() + spring) / mass, rate);
    model.warnings.extend(warning);
    let stepped = rate * f64::from(substeps);
    let (disturbance, said) = disturbance(table, folder, &is, stepped, inputs)?;
    model.warnings.extend(said);
    let encoder = table.not_negative("encoder", is.length)?.unwrap_or(0.0);
    let drive = drive(table, &is, rate)?;
    let sides = [law.curve().positive(), law.curve().negative()];
    let of_law = sides
        .map(|side| side.viscous)
        .into_iter()
        .fold(0.0, f64::max);
    let of_motor = drive.gain() * drive.back_emf;
    if of_motor > of_law + viscous.unwrap_or(0.0) {
        let unit = Dimensions::per(is.force, is.speed)
            .si_text()
            .replace('*', "·");
        model.warnings.push(Warning::new(
            Code::BackEmf,
            format!(
                "the voltage that motion makes in the motor brakes the axis with {} {unit}, viscous friction with {} {unit}: neither the \
                 compensators nor the feedforward know of it, and most of the error that is left may come from it",
                short(of_motor),
                short(of_law + viscous.unwrap_or(0.0))
            ),
        ));
    }
    let machine = Machine {
        motion,
        law,
        depends,
        mass,
        viscous: viscous.unwrap_or(0.0),
        spring,
        given_mass: given.is_some(),
        rate,
        substeps,
        drive,
        encoder: Encoder::new(encoder).map_err(|e| table.together(&e))?,
        position_noise: table
            .not_negative("position_noise", is.length)?
            .unwrap_or(0.0),
        cogging: cogging(table, &is, encoder)?,
        disturbance,
        model,
    };
    table.end()?;
    Ok(machine)
}

/// Plant steps of a control period for a stiffness over a mass, 1/s^2, at a control rate, Hz; with a warning where they are
/// too long.
pub(super) fn plant_steps(stiffness_over_mass: f64, rate: f64) -> (u32, Option<Warning>) {
    let swing = stiffness_over_mass.sqrt();
    let substeps = (PLANT_RATE.max(swing / LONGEST_STEP) / rate).ceil();
    let substeps = substeps.clamp(1.0, MOST_SUBSTEPS.max(PLANT_RATE / rate).ceil());
    let long = swing / (rate * substeps);
    let warning = (long > LONGEST_STEP).then(|| {
        Warning::new(
            Code::LongSteps,
            format!(
                "the bristles are too stiff for a plant step of {:.3e} s: h sqrt(sigma0/M) = {}, above {LONGEST_STEP}; \
                 what happens before break-away is not to be relied on; a higher rate makes the steps shorter",
                1.0 / (rate * substeps),
                stiction_number::short(long)
            ),
        )
    });
    (substeps as u32, warning)
}

fn cogging(table: &Table<'_>, is: &Dimensions, encoder: f64) -> Result<Option<Cogging>, Error> {
    let Some(table) = table.table("cogging")? else {
        return Ok(None);
    };
    let amplitude = table.positive("amplitude", is.force)?;
    let pitch = table.positive("pitch", is.length)?;
    let cogging = Cogging {
        amplitude: table.required("amplitude", amplitude, "a force such as \"2 N\"")?,
        pitch: table.required("pitch", pitch, "a length such as \"24 mm\"")?,
        phase: 0.0,
    };
    if !WRAPS.contains(&cogging.pitch) || cogging.pitch < encoder {
        let (low, high) = (encoder.max(*WRAPS.start()), WRAPS.end());
        let allowed = format!(
            "from {low:e} to {high:e} {}, and not below the encoder step",
            is.length.si_text()
        );
        return Err(table.refused("pitch", &allowed));
    }
    table.end()?;
    Ok(Some(cogging))
}
