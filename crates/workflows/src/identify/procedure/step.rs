//! `--method presliding-step`: force steps below break-away to sigma0 and sigma1.

use super::break_away::break_away;
use super::curve;
use crate::entries;
use crate::error::Error;
use crate::identify::assemble::{self, Parts};
use crate::identify::beside::Beside;
use crate::identify::load::{Asked, Loaded};
use crate::identify::logs::{log_warnings_but, path_of, refused, run_of, samples};
use crate::identify::outcome::{Found, Outcome};
use crate::identify::trust;
use crate::source::Source;
use crate::wording::{Setting, TOGETHER_WITH};
use stiction_files::Warning;
use stiction_files::result::{InversionEntry, PreslidingStepEntry, StaticMapEntry};
use stiction_files::symbols;
use stiction_friction::Direction;
use stiction_identify::procedure::{Run, Statics, StepFit, StepResponse, StepSettings, fit_steps};
use stiction_identify::{LawKind, Mass, Observer};
use stiction_number::four_digits;
use stiction_parameters::{Name, Quantity, Side};
use stiction_say::{Found as Kind, Notice};

/// Findings about a log that hardly moves, which a step below break-away does on purpose.
fn is_on_purpose(found: &Kind) -> bool {
    matches!(
        found,
        Kind::NoMotion { .. }
            | Kind::Noise { .. }
            | Kind::FewSteps { .. }
            | Kind::OneDirection { .. }
            | Kind::OneSpeed { .. }
    )
}

/// The whole workflow.
pub(in crate::identify) fn run(
    asked: Asked,
    loaded: Loaded,
    observer: &mut dyn Observer,
) -> Result<Outcome, Error> {
    let allowed = "the step response is that of lugre";
    asked.options.require(&[LawKind::LuGre], allowed)?;
    let sources = &loaded.sources;
    let own = samples(sources)?;
    let mut runs: Vec<(Run, StepResponse)> = Vec::new();
    for (k, (source, samples)) in sources.iter().zip(&own).enumerate() {
        let run = run_of(source, samples, asked.axis);
        let step = StepResponse::read(&run, k).map_err(|e| refused(sources, e))?;
        runs.push((run, step));
    }
    let mut warnings = log_warnings_but(sources, is_on_purpose);
    let (settings, map, undetermined) = settings(
        asked,
        sources,
        &loaded.beside,
        &runs,
        &mut warnings,
        observer,
    )?;
    let fit = fit_steps(&runs, &settings, observer).map_err(|e| refused(sources, e))?;
    let mut law = fit.fitted_law(&settings);
    // What an earlier identification left open has no covariance there, and is not exact for that.
    for p in law.parameters.iter_mut().filter(|p| !p.identified) {
        if undetermined.contains(&p.name.quantity) {
            p.identifiable = false;
            p.reason = "the identification that it is taken from did not determine it".into();
        }
    }
    let mut judged = trust::of_steps(&law, &fit, (sources, loaded.motion()), warnings);
    let entry = entry(&fit, &runs, &settings, sources, &mut judged.warnings);
    let break_away = break_away(&loaded.beside, &law)?;
    let mut result = assemble::result(Parts {
        asked,
        sources,
        conditioning: conditioning(&settings, &sources[0].log.force_unit),
        unsettled: None,
        law: &law,
        validation: &[],
        laws: Vec::new(),
        late: 0.0,
        without: Vec::new(),
        law_chosen_by: "user",
        judged,
    });
    let length = symbols::length_unit(loaded.motion());
    result.fit = entries::fit(&law.fit, "position", length);
    result.presliding_step = Some(entry);
    result.static_map = map;
    break_away.into_result(&mut result);
    let found = Found::Procedure(Box::new(law));
    Ok(Outcome::new(result, found, Vec::new(), loaded.sources))
}

/// What was done to the logs, in words.
fn conditioning(settings: &StepSettings, unit: &str) -> Vec<String> {
    let mut out = vec![
        "force and position as logged, nothing filtered; each force held until the next sample"
            .to_string(),
    ];
    if settings.offset != 0.0 {
        out.push(format!(
            "the constant force F₀ of the steady curve, {} {unit}, is taken off the force: friction carries the rest, before the \
             step too",
            four_digits(settings.offset)
        ));
    }
    out
}

/// What is known beside the steps: mass and steady curve, and what of them was not determined.
fn settings(
    asked: Asked,
    sources: &[Source],
    beside: &Beside,
    runs: &[(Run, StepResponse)],
    warnings: &mut Vec<Warning>,
    observer: &mut dyn Observer,
) -> Result<(StepSettings, Option<StaticMapEntry>, Vec<Quantity>), Error> {
    let Asked { options, axis, .. } = asked;
    let terms = axis.terms_for(&sources[0].log, options.asymmetric)?;
    let mass = match terms.mass {
        Mass::Given(mass) => Some(mass),
        Mass::Fitted => beside
            .model
            .as_ref()
            .and_then(|model| curve::value(&model.model, "mass")),
        Mass::Absent => {
            return Err(Error::usage(
                [
                    "mass = \"none\"".into(),
                    TOGETHER_WITH.into(),
                    Setting::Method.is(options.procedures.method.name()),
                ],
                "the step response is that of a mass on its bristles; give the mass, or \"fit\"",
            ));
        }
    };
    let mut settings = StepSettings {
        mass,
        curve: None,
        exponent: axis.exponent(),
        offset: 0.0,
        given: [[0.0; 7]; 7],
    };
    if beside.model.is_none() && beside.statics.is_empty() {
        warnings.push(Notice::AssumedCurve.into());
        return Ok((settings, None, Vec::new()));
    }
    let known = curve::known(asked, sources, beside, observer)?;
    warnings.extend(known.warnings);
    let forth = runs.iter().all(|(_, step)| step.height > 0.0);
    let back = runs.iter().all(|(_, step)| step.height < 0.0);
    let [pos, neg] = known.statics.sides;
    settings.exponent = known.statics.exponent;
    let offset = known.statics.parameters.iter();
    let offset = offset.into_iter().find(|p| p.name == Quantity::Offset);
    settings.offset = offset.map_or(0.0, |p| p.value);
    let shares = match (forth, back) {
        (true, _) => [1.0, 0.0],
        (_, true) => [0.0, 1.0],
        // Steps both ways: what they have in common.
        _ => [0.5, 0.5],
    };
    settings.given = given(&known.statics, shares);
    if matches!(terms.mass, Mass::Given(_)) {
        // The axis file's mass is exact.
        settings.given[4] = [0.0; 7];
        settings.given.iter_mut().for_each(|row| row[4] = 0.0);
    }
    let mean = |of: fn(&Direction<f64>) -> f64| shares[0] * of(&pos) + shares[1] * of(&neg);
    settings.curve = Some(Direction {
        coulomb: mean(|side| side.coulomb),
        static_friction: mean(|side| side.static_friction),
        stribeck_velocity: mean(|side| side.stribeck_velocity),
        viscous: mean(|side| side.viscous),
    });
    let statics = known.statics.parameters.iter();
    let open = statics.filter(|p| p.identified && !p.identifiable);
    let given_mass = matches!(terms.mass, Mass::Given(_));
    let undetermined = open
        .map(|p| p.name.quantity)
        .filter(|quantity| !(given_mass && *quantity == Quantity::Mass))
        .collect();
    Ok((settings, known.map, undetermined))
}

/// Covariance of the curve, the mass, the exponent and the offset that are given: of the one direction in which the steps go, or of the mean
/// of both.
fn given(statics: &Statics, shares: [f64; 2]) -> [[f64; 7]; 7] {
    let covariance = &statics.covariance;
    // Of each what the parameters of the covariance contribute.
    let parts = [
        Quantity::Coulomb,
        Quantity::Static,
        Quantity::StribeckVelocity,
        Quantity::Sigma2,
        Quantity::Mass,
        Quantity::StribeckExponent,
        Quantity::Offset,
    ]
    .map(|quantity| -> Vec<(usize, f64)> {
        let both = covariance.place(quantity.into());
        let sides = [Side::Positive, Side::Negative].into_iter().zip(shares);
        let sides = sides.filter_map(|(side, share)| {
            let place = covariance.place(Name::new(quantity, side))?;
            (share > 0.0).then_some((place, share))
        });
        match both {
            Some(place) => vec![(place, 1.0)],
            None => sides.collect(),
        }
    });
    let mut out = [[0.0; 7]; 7];
    for (i, row) in parts.iter().enumerate() {
        for (j, column) in parts.iter().enumerate() {
            let pairs = row.iter().flat_map(|a| column.iter().map(move |b| (a, b)));
            out[i][j] = pairs
                .map(|((a, x), (b, y))| x * y * covariance.matrix[*a][*b])
                .sum();
        }
    }
    out
}

fn entry(
    fit: &StepFit,
    runs: &[(Run, StepResponse)],
    settings: &StepSettings,
    sources: &[Source],
    warnings: &mut Vec<Warning>,
) -> PreslidingStepEntry {
    let found = |name: &str| fit.value(name).unwrap_or(f64::NAN);
    let off = |value: f64, name: &str| 100.0 * (value / found(name) - 1.0);
    let viscous = settings.curve.map_or(0.0, |c| c.viscous);
    let mass = settings.mass.or_else(|| fit.value("mass"));
    let published = runs
        .iter()
        .enumerate()
        .map(|(k, (_, step))| {
            let inverted = step.invert(mass, viscous);
            if inverted.sigma1.is_none() {
                let log = path_of(sources, k);
                warnings.push(Notice::NoOvershoot { log }.into());
            }
            InversionEntry {
                path: path_of(sources, k),
                height: step.height,
                settled: step.settled,
                overshoot: step.overshoot.map(|(_, mp)| mp),
                damping_ratio: inverted.damping_ratio,
                sigma0: inverted.sigma0,
                sigma1: inverted.sigma1,
                sigma0_off_percent: off(inverted.sigma0, "sigma0"),
                sigma1_off_percent: inverted.sigma1.map(|x| off(x, "sigma1")),
            }
        })
        .collect();
    PreslidingStepEntry {
        used: "simulated".into(),
        displacement_unit: symbols::length_unit(sources[0].log.motion).into(),
        force_unit: sources[0].log.force_unit.clone(),
        damping_ratio: fit.damping_ratio,
        delay_s: fit.delay.0,
        delay_std_s: fit.delay.1,
        published,
    }
}
