//! Subjects that are measured: logs of one axis.

use super::genome::{Floor, about, genome};
use super::options::{CompareOptions, Cost};
use super::subject::{Data, Subject, lugre};
use crate::error::Error;
use crate::identify::{ranges, record_of};
use crate::wording::Setting;
use std::path::PathBuf;
use stiction_files::Axis;
use stiction_identify as engine;
use stiction_identify::candidates::{box_of_six, thinned};
use stiction_identify::{Law, Observer, SearchBox, Settings};
use stiction_search::Bounds;

/// The logs as searches see them.
pub(super) fn subject(
    options: &CompareOptions,
    logs: &[PathBuf],
    axis: &Axis,
    observer: &mut dyn Observer,
) -> Result<Subject, Error> {
    let made = [
        (Setting::Noise.into(), options.noise.is_some()),
        (Setting::Excitation.into(), options.excitation.is_some()),
        (Setting::Rate.into(), options.rate.is_some()),
        (Setting::OtherLaw.into(), options.other_law),
    ];
    let of_a_problem = [Cost::Position, Cost::Curve, Cost::Dynamic];
    let cost = options.cost.filter(|cost| of_a_problem.contains(cost));
    let cost = cost.map(|cost| (Setting::Cost.is(cost.name()), true));
    let mut made = made.into_iter().chain(cost);
    if let Some((setting, _)) = made.find(|(_, given)| *given) {
        return Err(Error::usage(
            [setting, " together with a log".into()],
            "only a problem is made; a log is what it is",
        ));
    }
    if axis.exponent_fitted {
        return Err(Error::usage(
            "stribeck_exponent = \"fit\"",
            "a number; only the default method of identify fits it",
        ));
    }
    let law = Law {
        exponent: axis.exponent(),
        ..lugre()
    };
    let (sources, record, terms) = record_of(logs, axis, observer).map_err(|e| e.at_axis(axis))?;
    let name: Vec<String> = sources
        .iter()
        .map(|s| s.path.display().to_string())
        .collect();
    let name = name.join(", ");
    let refused = |source| Error::identify(name.clone(), source);
    let cost = options.cost.unwrap_or(Cost::Six);
    let bounds = match (options.decades, cost) {
        (None, Cost::Separable) => {
            ranges::refuse_beside_separable(axis)?;
            let inner = SearchBox::from_record(&record, &law).map_err(refused)?;
            let ends = |end: fn(&SearchBox, usize) -> f64| {
                (0..inner.len()).map(|i| end(&inner, i)).collect()
            };
            Bounds::new(ends(SearchBox::low), ends(SearchBox::high))
                .map_err(|e| Error::usage(e.to_string(), "a log with motion and force"))?
        }
        (None, _) => {
            let usual = box_of_six(&record).map_err(refused)?;
            ranges::given(axis, &sources, usual, ranges::SIX)?
        }
        (Some(decades), _) => {
            let settings = Settings::default();
            let (estimate, _) =
                engine::fit_law(&record, law, &terms, 0.0, &settings, observer).map_err(refused)?;
            let found: Vec<(String, f64)> = (estimate.parameters.iter())
                .map(|p| (p.name.to_string(), p.value))
                .collect();
            let floor = Floor::new(estimate.value("coulomb").unwrap_or(1.0), record.top_speed());
            about(&genome(&found, cost, floor), decades)?
        }
    };
    Ok(Subject {
        name: name.clone(),
        source: "a log".into(),
        motion: record.notes.join("; "),
        samples: record.kept(),
        rate_hz: 1.0 / record.step(),
        truth: Vec::new(),
        cost,
        law,
        scheme: options.integrator,
        bounds,
        data: Data::Record {
            thinned: thinned(&record).map(Box::new),
            record: Box::new(record),
            terms: Box::new(terms),
            held: None,
        },
    })
}
