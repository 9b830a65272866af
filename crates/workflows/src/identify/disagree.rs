//! What logs of one axis have differently, in words.

use super::load::Asked;
use super::logs::path_of;
use crate::identify::Method;
use crate::source::Source;
use std::fmt::Write;
use stiction_codes::Code;
use stiction_files::result::{Action, CauseEntry};
use stiction_files::{Warning, shell, symbols};
use stiction_identify::{Disagreement, FittedLaw};
use stiction_log::Motion;
use stiction_number::Percent;
use stiction_parameters::Quantity;
use stiction_policy::verdict;
use stiction_say::Notice;

/// The options of a run that is to be repeated for each log, as they are typed.
pub(super) fn options(asked: Asked) -> String {
    let Asked { options, axis, .. } = asked;
    let mut out = String::new();
    if let Some(file) = axis.file() {
        let _ = write!(out, " --axis {}", shell::quoted_path(file));
    }
    if options.procedures.method == Method::Static {
        out.push_str(" --method static");
    }
    if let Some(law) = options.law {
        let _ = write!(out, " --law {}", law.name());
    }
    if options.asymmetric {
        out.push_str(" --asymmetric");
    }
    out
}

/// A warning for every parameter that two logs have differently; `options` are those of the run that has to be repeated for each
/// log, as they are typed, and whether its law has one level for all logs.
pub(super) fn named(
    found: &[Disagreement],
    sources: &[Source],
    motion: Motion,
    (options, one_level): (&str, bool),
) -> Vec<Warning> {
    let all = found.iter().enumerate();
    // The commands are the same for all.
    all.map(|(i, found)| {
        warning(
            found,
            sources,
            motion,
            ((i == 0).then_some(options), one_level),
        )
    })
    .collect()
}

fn warning(
    found: &Disagreement,
    sources: &[Source],
    motion: Motion,
    (options, one_level): (Option<&str>, bool),
) -> Warning {
    let logs = found.logs.map(|log| path_of(sources, log));
    let commands = options.map(|options| {
        [0, 1].map(|i| {
            let log = shell::quoted(&logs[i]);
            format!("stiction identify {log}{options} --out another-{}", i + 1)
        })
    });
    let size = (found.values[1] - found.values[0]) / found.part;
    let notice = Notice::LogsDiffer {
        name: found.name.to_string(),
        meaning: symbols::meaning_of(found.name, motion),
        values: found.values,
        unit: symbols::unit(
            found.name.dimension(),
            motion,
            force_unit(sources, motion),
            "",
        ),
        logs,
        apart: found.part,
        of_coulomb: found.name.quantity == Quantity::Offset,
        chance: found.deviation / size,
        key: own_level(found).filter(|_| !one_level),
        commands,
    };
    notice.into()
}

/// Whether a law has one level for all logs, whatever the axis file says: Maxwell-slip elements have levels of their own.
pub(super) fn has_one_level(law: &FittedLaw) -> bool {
    law.law.kind.has_elements()
}

/// The key of the axis file that gives each log a level of its own.
fn own_level(found: &Disagreement) -> Option<&'static str> {
    match found.name.quantity {
        Quantity::Coulomb => Some("coulomb_log"),
        Quantity::Sigma2 => Some("sigma2_log"),
        _ => None,
    }
}

/// A level or a mass that differs by so much that the logs are not of one axis in one state, and its ratio.
pub(super) fn of_two_axes(found: &[Disagreement]) -> Option<(String, f64)> {
    let telling = |d: &&Disagreement| {
        let quantity = d.name.quantity;
        matches!(quantity, Quantity::Coulomb | Quantity::Mass)
            && d.part >= verdict::MIN_AXES_DIFFERENCE
    };
    let d = found.iter().find(telling)?;
    Some((d.name.to_string(), d.values[1] / d.values[0]))
}

/// The first of them as a part of the verdict.
pub(super) fn cause(law: &FittedLaw) -> Option<CauseEntry> {
    let first = law.disagreements.first()?;
    let key = own_level(first).filter(|_| !has_one_level(law));
    Some(CauseEntry {
        code: Code::LogsDisagree,
        text: format!("the logs differ in {}", first.name),
        size: Percent::error(100.0 * first.part).digits(2),
        cure: key.map(|key| Action::Line {
            table: "terms".into(),
            line: format!("{key} = true"),
            replaces: false,
        }),
    })
}

/// The unit of the force of the logs.
fn force_unit(sources: &[Source], motion: Motion) -> &str {
    let first = sources.first();
    first.map_or(symbols::force_unit(motion), |s| &s.log.force_unit)
}
