//! What logs of one axis have differently, in words.

use super::logs::path_of;
use super::trust::Evidence;
use stiction_codes::Code;
use stiction_files::{Warning, shell, symbols};
use stiction_identify::{Disagreement, NOT_CONSTANT};
use stiction_log::Motion;
use stiction_number::{Percent, four_digits};
use stiction_parameters::Quantity;

/// Names every parameter that two logs have differently.
pub(super) fn named(evidence: &Evidence, warnings: &mut Vec<Warning>) {
    let found = evidence.law.disagreements.iter();
    warnings.extend(found.map(|found| warning(found, evidence)));
}

fn warning(found: &Disagreement, evidence: &Evidence) -> Warning {
    let motion = evidence.motion;
    let paths = found.logs.map(|log| path_of(evidence.sources, log));
    let values = found.values.map(four_digits);
    let unit = symbols::unit(
        found.name.dimension(),
        motion,
        force_unit(evidence, motion),
        "",
    );
    let of = match found.name.quantity {
        Quantity::Offset => " of the Coulomb level",
        _ => "",
    };
    let part = |x: f64| Percent::error(100.0 * x).digits(2);
    let size = (found.values[1] - found.values[0]) / found.part;
    let verdict = match found.part < NOT_CONSTANT {
        true => "The intervals count how the logs scatter",
        false => "It is no constant of the machine",
    };
    let own_level = match found.name.quantity {
        Quantity::Coulomb => Some("coulomb_log"),
        Quantity::Sigma2 => Some("sigma2_log"),
        _ => None,
    };
    let identify = match own_level {
        Some(key) => format!(
            "Give each log its own in one fit with {key} = true under [terms] in the axis file ({} is then that of the first \
             log), or identify",
            found.name
        ),
        None => "Identify".into(),
    };
    let command = |path: &str| format!("stiction identify {} --out RESULT", shell::quoted(path));
    Warning::new(
        Code::LogsDisagree,
        format!(
            "the logs differ in {} ({}): {} {unit} in {}, {} {unit} in {}, {}{of} apart, where {} is chance. {verdict}. \
             {identify} each by itself, with the other options of this run: {}; {}",
            found.name,
            symbols::meaning_of(found.name, motion),
            values[0],
            paths[0],
            values[1],
            paths[1],
            part(found.part),
            part(found.deviation / size),
            command(&paths[0]),
            command(&paths[1]),
        ),
    )
}

/// The unit of the force of the logs.
fn force_unit<'a>(evidence: &'a Evidence, motion: Motion) -> &'a str {
    let first = evidence.sources.first();
    first.map_or(symbols::force_unit(motion), |s| &s.log.force_unit)
}
