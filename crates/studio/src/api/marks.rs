//! Stretches of a log that were brushed: kept, fitted, validated on or left out, written into the axis file.

use super::{Answer, App, blocking};
use crate::given::Json;
use crate::refused::Refused;
use crate::workspace::Workspace;
use axum::extract::State;
use serde::Deserialize;
use std::path::Path;
use stiction_files::Axis;
use stiction_files::axis::{Marks, mark as written};
use stiction_files::{visible, write_atomic};
use stiction_workflows::check;

/// What a stretch is marked as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum As {
    /// The record is cropped to it.
    Crop,
    /// It is fitted.
    Fit,
    /// It is not fitted, and the law is held against it.
    Validate,
    /// It is neither.
    LeaveOut,
    /// All marks are taken back.
    Nothing,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Asked {
    log: String,
    axis: String,
    #[serde(rename = "as")]
    what: As,
    /// s from the first sample of the file.
    from: f64,
    to: f64,
    /// Length of the record, s.
    seconds: f64,
}

type Stretch = (f64, f64);

/// Marks a stretch, and says what is marked then.
pub async fn mark(State(shared): App, Json(asked): Json<Asked>) -> Answer {
    blocking(shared, move |shared| {
        shared.alone(|| marked_in(&shared.workspace, &asked))
    })
    .await
}

/// Marks a stretch in the axis file, which is begun where there is none.
fn marked_in(workspace: &Workspace, asked: &Asked) -> Result<Marks, Refused> {
    let log = workspace.file(&asked.log)?;
    let (file, text) = workspace.axis(&asked.axis)?;
    let text = text.map_or_else(|| Ok(check::init(&log, None)?.text), Ok::<_, Refused>)?;
    // The file names the log from its own folder.
    let name = match asked.axis.rsplit_once('/') {
        None => asked.log.clone(),
        Some((folder, _)) => {
            let own = asked
                .log
                .strip_prefix(folder)
                .and_then(|rest| rest.strip_prefix('/'));
            let own = own.map(String::from);
            own.ok_or_else(|| Refused::bad("the axis file is in another folder than the log"))?
        }
    };
    let before = Axis::parse(&text)?.marks(Path::new(&name));
    let whole = (0.0, rounded(asked.seconds) + 1e-3);
    let stretch = (rounded(asked.from).max(0.0), rounded(asked.to).min(whole.1));
    if asked.what != As::Nothing && (stretch.1 <= stretch.0 || stretch.0.is_nan()) {
        return Err(Refused::bad("brush a stretch first"));
    }
    let marks = marked(before, asked.what, stretch, whole);
    let text = written(&text, &name, &marks).ok_or_else(|| {
            Refused::conflict(format!(
                "{}: the lines of [[log]] cannot be placed, or nothing would be left to fit; write them by hand",
                asked.axis
            ))
        })?;
    write_atomic(&file, visible::toml(text).as_bytes())?;
    Ok(marks)
}

/// A time to the microsecond, which no log is finer than by hand.
fn rounded(seconds: f64) -> f64 {
    (1e6 * seconds).round() / 1e6
}

/// Marks with a stretch added to them; parts that would meet give way to it.
fn marked(before: Marks, what: As, stretch: Stretch, whole: Stretch) -> Marks {
    let mut marks = before;
    if what != As::Nothing && marks.validate_all {
        marks.validate_all = false;
        marks.validate = vec![marks.crop.unwrap_or(whole)];
    }
    let kept = marks.crop.unwrap_or(whole);
    match what {
        As::Nothing => return Marks::default(),
        As::Crop => {
            marks.crop = Some(stretch);
            marks.fit = common(&marks.fit, stretch);
            marks.validate = common(&marks.validate, stretch);
        }
        As::Fit => {
            marks.validate = without(&marks.validate, stretch);
            marks.fit = joined(&marks.fit, stretch);
        }
        As::Validate => {
            marks.fit = without(&marks.fit, stretch);
            marks.validate = joined(&marks.validate, stretch);
        }
        As::LeaveOut => {
            if marks.fit.is_empty() {
                let others = marks.validate.iter();
                marks.fit = others.fold(vec![kept], |fit, other| without(&fit, *other));
            }
            marks.fit = without(&marks.fit, stretch);
            marks.validate = without(&marks.validate, stretch);
        }
    }
    if let Some(crop) = marks.crop {
        marks.fit = common(&marks.fit, crop);
        marks.validate = common(&marks.validate, crop);
    }
    marks
}

fn common(all: &[Stretch], with: Stretch) -> Vec<Stretch> {
    let parts = all.iter().map(|own| (own.0.max(with.0), own.1.min(with.1)));
    parts.filter(|own| own.1 > own.0).collect()
}

fn without(all: &[Stretch], other: Stretch) -> Vec<Stretch> {
    let parts = all
        .iter()
        .flat_map(|own| [(own.0, own.1.min(other.0)), (own.0.max(other.1), own.1)]);
    parts.filter(|own| own.1 > own.0).collect()
}

fn joined(all: &[Stretch], with: Stretch) -> Vec<Stretch> {
    let touches = |own: &&Stretch| own.0 <= with.1 && with.0 <= own.1;
    let one = all.iter().filter(touches);
    let one = one.fold(with, |one, own| (one.0.min(own.0), one.1.max(own.1)));
    let mut out: Vec<Stretch> = all.iter().filter(|own| !touches(own)).copied().collect();
    out.push(one);
    out.sort_by(|a, b| a.0.total_cmp(&b.0));
    out
}

#[cfg(test)]
mod tests {
    use super::{As, marked};
    use proptest::prelude::*;
    use stiction_files::axis::{Marks, mark};

    const WHOLE: (f64, f64) = (0.0, 60.0);

    fn step() -> impl Strategy<Value = (As, (f64, f64))> {
        let what = prop_oneof![
            Just(As::Crop),
            Just(As::Fit),
            Just(As::Validate),
            Just(As::LeaveOut),
            Just(As::Nothing)
        ];
        (what, 0..59_000u32, 1..60_000u32).prop_map(|(what, from, length)| {
            let from = f64::from(from) / 1e3;
            (what, (from, (from + f64::from(length) / 1e3).min(60.0)))
        })
    }

    proptest! {
        #[test]
        fn whatever_is_brushed_the_parts_never_meet(steps in prop::collection::vec(step(), 1..8)) {
            let mut marks = Marks::default();
            for (what, stretch) in steps {
                marks = marked(marks, what, stretch, WHOLE);
                let mut all: Vec<_> = marks.fit.iter().chain(&marks.validate).copied().collect();
                all.sort_by(|a, b| a.0.total_cmp(&b.0));
                prop_assert!(all.iter().all(|own| own.0 < own.1), "{:?}", marks);
                prop_assert!(all.windows(2).all(|w| w[0].1 <= w[1].0), "{:?}", marks);
                let kept = marks.crop.unwrap_or(WHOLE);
                prop_assert!(all.iter().all(|own| kept.0 <= own.0 && own.1 <= kept.1), "{:?}", marks);
                if what == As::Fit {
                    prop_assert!(mark("", "a.csv", &marks).is_some() || marks.fit.is_empty(), "{:?}", marks);
                }
            }
        }
    }

    #[test]
    fn a_stretch_that_is_left_out_splits_what_is_fitted() {
        let marks = marked(Marks::default(), As::Validate, (40.0, 60.0), WHOLE);
        let marks = marked(marks, As::LeaveOut, (10.0, 12.0), WHOLE);
        assert_eq!(marks.fit, [(0.0, 10.0), (12.0, 40.0)]);
        assert_eq!(marks.validate, [(40.0, 60.0)]);
    }
}
