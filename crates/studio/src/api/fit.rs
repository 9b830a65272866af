//! What a fit leaves: in a stretch that is brushed, and about the reversal that shows most of presliding.

use super::{Answer, App, read};
use crate::given::Query;
use crate::logs::{Channel, Drawable, Series};
use crate::refused::Refused;
use axum::extract::State;
use serde::{Deserialize, Serialize};
use stiction_files::ModelFile;
use stiction_identify::Fit as Quality;
use stiction_workflows::identify::{presliding_length, slowest_turn};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Named {
    /// The folder of a result.
    result: String,
}

/// What can be drawn of a fit.
#[derive(Serialize)]
pub struct Fit {
    from: Option<f64>,
    to: Option<f64>,
    channels: Vec<Drawable>,
    /// The stretch about the slowest reversal, s.
    turn: Option<(f64, f64)>,
    /// Force over position.
    #[serde(rename = "loop")]
    over_position: Option<Pairs>,
    /// Force over velocity.
    curve: Option<Pairs>,
}

/// Names of the channels along both axes.
#[derive(Serialize)]
pub struct Pairs {
    measured: [&'static str; 2],
    model: [&'static str; 2],
}

/// What can be drawn of a fit.
pub async fn fit(State(shared): App, Query(asked): Query<Named>) -> Answer {
    read(shared, move |shared| {
        let result = &asked.result;
        let loaded = shared
            .logs
            .table(&shared.workspace, &format!("{result}/fit.csv"), 0)?;
        let text = shared.workspace.text(&format!("{result}/model.toml"));
        let model = text.ok().and_then(|text| ModelFile::parse(&text).ok());
        let series = &loaded.series;
        Ok(Fit {
            from: series.time.first().copied(),
            to: series.time.last().copied(),
            channels: series.about(),
            turn: model.and_then(|model| turn(series, &model)),
            over_position: pairs(series, "position"),
            curve: pairs(series, "velocity"),
        })
    })
    .await
}

/// Times of the samples about the slowest reversal.
fn turn(series: &Series, model: &ModelFile) -> Option<(f64, f64)> {
    let values = |name: &str| {
        series
            .channel(name)
            .map(|channel| channel.values.as_slice())
    };
    // A fit of positions has those as what was measured.
    let position = values("position").or_else(|| values("measured"))?;
    let length = presliding_length(&model.values()?)?;
    let (_, window) = slowest_turn(values("velocity")?, position, length)?;
    let at = |k: usize| series.time.get(k).copied();
    Some((at(window.start)?, at(window.end - 1)?))
}

/// Which channels make the map over this one.
fn pairs(series: &Series, over: &'static str) -> Option<Pairs> {
    let has = |name: &str| series.channel(name).is_some();
    match () {
        () if has(over) && has("friction") => Some(Pairs {
            measured: [over, "friction"],
            model: [over, "model friction"],
        }),
        // The position is what was fitted: the model has its own, and in closed loop a force of its own.
        () if over == "position" && has("force") => Some(Pairs {
            measured: ["measured", "force"],
            model: [
                "model",
                if has("model force") {
                    "model force"
                } else {
                    "force"
                },
            ],
        }),
        () => None,
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stretch {
    result: String,
    from: f64,
    to: f64,
}

/// What is left in a stretch.
#[derive(Serialize)]
pub struct Left {
    samples: usize,
    /// In the unit of what was fitted.
    rms: f64,
    /// `100 rms(residual) / rms(measured)`.
    percent: f64,
}

/// What is left in a stretch.
pub async fn left(State(shared): App, Query(asked): Query<Stretch>) -> Answer {
    read(shared, move |shared| {
        let name = format!("{}/fit.csv", asked.result);
        let loaded = shared.logs.table(&shared.workspace, &name, 0)?;
        let series = &loaded.series;
        let start = series.time.partition_point(|t| *t < asked.from);
        let end = series.time.partition_point(|t| *t <= asked.to).max(start);
        let within = |name: &str| {
            let values = series
                .channel(name)
                .map(|channel: &Channel| &channel.values);
            values
                .and_then(|values| values.get(start..end))
                .unwrap_or(&[])
        };
        let quality = Quality::new(within("measured"), within("residual"));
        let quality =
            quality.ok_or_else(|| Refused::bad("nothing was measured in this stretch"))?;
        Ok(Left {
            samples: quality.samples,
            rms: quality.rmse,
            percent: quality.relative_error_percent,
        })
    })
    .await
}
