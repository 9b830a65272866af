//! A run of a study on a contour beside that without compensation: in the plane, its deviations magnified, and over the time.

use super::{Answer, App, read};
use crate::given::Query;
use crate::logs::{self, Series};
use crate::refused::Refused;
use crate::workspace::Workspace;
use axum::extract::State;
use serde::{Deserialize, Serialize};
use stiction_files::study::result::StudyFile;
use stiction_workflows::study::{ContourTrace, Plane};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Asked {
    /// The folder of a study that was simulated.
    folder: String,
    /// Which run of its `contours.csv`, counted from 0.
    run: usize,
}

/// What is drawn.
#[derive(Serialize)]
pub struct Drawn {
    /// Unit of positions and deviations.
    unit: String,
    plane: Plane,
    /// Without compensation, and the run itself where it is another one.
    runs: Vec<Run>,
}

/// A run.
#[derive(Serialize)]
pub struct Run {
    name: String,
    /// s
    time: Vec<f64>,
    /// m (rad), positive where the contour lies to the left of the axes.
    deviation: Vec<f64>,
}

/// What is drawn of a run, from where its samples count.
pub async fn contour(State(shared): App, Query(asked): Query<Asked>) -> Answer {
    read(shared, move |shared| {
        let file = format!("{}/contours.csv", asked.folder);
        let keys = logs::runs(&shared.workspace.file(&file)?)?;
        let places = beside(&keys, asked.run).ok_or_else(|| {
            let count = keys.len();
            Refused::bad(format!(
                "{file}: run {}; it has {count}, counted from 0",
                asked.run
            ))
        })?;
        let from = counts_from(&shared.workspace, &asked.folder, &keys[asked.run])?;
        let mut traces = Vec::new();
        let mut unit = String::new();
        for place in places {
            let loaded = shared.logs.table(&shared.workspace, &file, place)?;
            let trace = trace(&loaded.series, &keys[place], from);
            traces.push(trace.ok_or_else(|| {
                Refused::bad(format!("{file}: not as stiction simulate writes it"))
            })?);
            let deviation = loaded.series.channel("deviation");
            unit = deviation.map_or_else(String::new, |own| own.unit.clone());
        }
        let all: Vec<&ContourTrace> = traces.iter().collect();
        let plane = Plane::of(&all)
            .ok_or_else(|| Refused::bad(format!("{file}: the contour has no size")))?;
        let runs = traces.into_iter().map(|own| Run {
            name: match own.coupled {
                true => format!("{}, coupled", own.compensator),
                false => own.compensator,
            },
            time: own.time,
            deviation: own.deviation,
        });
        Ok(Drawn {
            unit,
            plane,
            runs: runs.collect(),
        })
    })
    .await
}

/// The places of the run without compensation on the same contour under the same controller, and of a run.
fn beside(keys: &[Vec<String>], run: usize) -> Option<Vec<usize>> {
    let own = keys.get(run)?;
    let is_without = |other: &Vec<String>| {
        own.get(..2) == other.get(..2)
            && matches!(other.get(2..), Some([compensator, coupled]) if compensator == "none" && coupled == "0")
    };
    let without = keys.iter().position(is_without);
    let without = without.filter(|place| *place != run);
    Some(without.into_iter().chain([run]).collect())
}

/// From when on the samples of a contour count, s.
fn counts_from(workspace: &Workspace, folder: &str, keys: &[String]) -> Result<f64, Refused> {
    let name = format!("{folder}/study.json");
    let text = workspace.text(&name)?;
    let study: StudyFile =
        serde_json::from_str(&text).map_err(|e| Refused::bad(format!("{name}: {e}")))?;
    let path = study
        .paths
        .iter()
        .find(|path| Some(&path.name) == keys.first());
    Ok(path.map_or(0.0, |path| path.skip_s))
}

fn trace(series: &Series, keys: &[String], from: f64) -> Option<ContourTrace> {
    let [contour, controller, compensator, coupled] = keys else {
        return None;
    };
    let start = series.time.partition_point(|t| *t < from);
    let values = |name: &str| series.channel(name)?.values.get(start..);
    let pairs = values("reference x")?.iter().zip(values("reference y")?);
    let reference = pairs.map(|(x, y)| [*x, *y]).collect();
    let deviation = values("deviation")?.to_vec();
    Some(ContourTrace::read(
        [contour, controller, compensator],
        coupled == "1",
        (series.time.get(start..)?.to_vec(), reference, deviation),
    ))
}
