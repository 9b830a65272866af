//! Which law a motion is planned for.

use super::{Known, PlanOptions};
use crate::error::Error;
use crate::wording::{Setting, TOGETHER_WITH, Wording};
use std::path::Path;
use stiction_files::Axis;
use stiction_parameters::LawKind;
use stiction_plan::Elements;

/// Laws that a motion can be planned for.
pub const PLANNED: [LawKind; 3] = [LawKind::LuGre, LawKind::MaxwellSlip, LawKind::Gms];

/// The law that is asked for, of a first log also by the elements of the axis file; `None` where it is that of the model, or LuGre.
///
/// # Errors
/// For a law that is not planned for, and for Maxwell-slip elements of which nothing is known.
pub(super) fn asked(
    axis: &Axis,
    file: &Path,
    options: &PlanOptions,
) -> Result<Option<LawKind>, Error> {
    let of_elements = axis.gms_elements.map(|_| LawKind::Gms);
    let law = match options.known {
        Some(Known::Log(_)) => options.law.or(of_elements),
        Some(Known::Model(_)) | None => options.law,
    };
    let Some(kind) = law else { return Ok(None) };
    if !PLANNED.contains(&kind) {
        let names = PLANNED.map(LawKind::name).join(", ");
        return Err(Error::usage(Setting::Law.is(kind), names));
    }
    if kind.has_elements() && options.known.is_none() {
        let found = [
            Setting::Law.is(kind),
            " with the limits of the axis alone".into(),
        ];
        let allowed = format!(
            "a first log or model, since limits say neither how many elements there are nor where they yield: {}",
            steps(file, kind)
        );
        return Err(Error::usage(found, allowed));
    }
    if kind.has_elements() && options.asymmetric {
        let found = [
            Setting::Asymmetric.into(),
            TOGETHER_WITH.into(),
            Setting::Law.is(kind),
        ];
        return Err(Error::usage(found, same_both_ways()));
    }
    Ok(law)
}

/// What a plan for Maxwell-slip elements needs of the directions.
pub(super) fn same_both_ways() -> Wording {
    let same = "Maxwell-slip elements that are the same in both directions: leave ";
    let out = " out here and in identify";
    [same.into(), Setting::Asymmetric.into(), out.into()].into()
}

/// From the limits of an axis to a motion for Maxwell-slip elements: what to type.
pub(super) fn steps(file: &Path, kind: LawKind) -> String {
    let axis = stiction_files::shell::quoted_path(file);
    format!(
        "stiction plan {axis} --stage probe --out probe, record probe/setpoints.csv as probe.csv, then stiction plan {axis} --log probe.csv \
         --law {kind} --out plan"
    )
}

/// Elements of a model of such a law.
pub(super) fn elements(kind: LawKind, count: usize) -> Option<Elements> {
    kind.has_elements().then_some(Elements {
        count,
        falls: kind.has_stribeck(),
        // Unless the axis file gives it.
        delayed: true,
    })
}
