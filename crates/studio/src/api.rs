//! What the page may ask for, each a small function over the workspace, the logs and the work.

mod axis;
mod contour;
mod events;
mod files;
mod fit;
mod marks;
mod opened;
mod trial;
mod upload;

use crate::asked::Asked;
use crate::assets::asset;
use crate::given::{Json, Query, sent, written};
use crate::jobs::View;
use crate::logs::{self, Correction};
use crate::refused::Refused;
use crate::server::Shared;
use crate::units::SHOWN;
use axum::Router;
use axum::extract::{DefaultBodyLimit, Path, State};
use axum::http::header::{CONTENT_TYPE, SET_COOKIE};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Largest body of a request that is no upload, bytes.
const BODY: usize = 256 << 10;

type App = State<Arc<Shared>>;
type Answer = Result<Response, Refused>;
/// What is done on a thread of its own.
type Work<T> = Box<dyn FnOnce(&Shared) -> Result<T, Refused> + Send>;

/// All of it.
pub fn router() -> Router<Arc<Shared>> {
    let uploads = Router::new()
        .route("/api/upload", post(upload::upload))
        .layer(DefaultBodyLimit::disable());
    Router::new()
        .route("/api/session", post(session))
        .route("/api/workspace", get(workspace))
        .route("/api/log", get(log))
        .route("/api/axis", get(axis::which).post(axis::begin))
        .route("/api/tiles", get(tiles))
        .route("/api/map", get(map))
        .route("/api/table", get(table))
        .route("/api/correct", post(correct))
        .route("/api/mark", post(marks::mark))
        .route("/api/text", get(files::read).put(files::write))
        .route("/api/study", post(files::study))
        .route("/api/study/command", post(files::study_command))
        .route("/api/fit", get(fit::fit))
        .route("/api/left", get(fit::left))
        .route("/api/contour", get(contour::contour))
        .route("/api/trial", post(trial::tried))
        .route("/api/targets", get(targets))
        .route("/api/command", post(command))
        .route("/api/jobs", post(begin).get(jobs))
        .route("/api/jobs/{id}/stop", post(stop))
        .route("/api/events", get(events::events))
        .route("/api/ticket", post(opened::ticket))
        .route("/open/{ticket}/{name}", get(opened::open))
        .layer(DefaultBodyLimit::max(BODY))
        .merge(uploads)
        .fallback(get(asset))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Token {
    token: String,
}

async fn session(State(shared): App, Json(asked): Json<Token>) -> Answer {
    let Some((cookie, key)) = shared.keys.exchange(&asked.token) else {
        return Err(Refused::forbidden(
            "this address was opened already, or is of an earlier run. Each opens one session: start stiction studio again for another",
        ));
    };
    let body = Json(serde_json::json!({ "key": key }));
    Ok(([(SET_COOKIE, cookie)], body).into_response())
}

async fn workspace(State(shared): App) -> Answer {
    blocking(shared, |shared| {
        Ok(serde_json::json!({
            "folder": shared.workspace.folder().to_string_lossy(),
            "version": env!("CARGO_PKG_VERSION"),
            "files": shared.workspace.list(),
            "units": SHOWN,
        }))
    })
    .await
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Log {
    name: String,
    axis: Option<String>,
}

async fn log(State(shared): App, Query(asked): Query<Log>) -> Answer {
    read(shared, move |shared| {
        let Log { name, axis } = &asked;
        let found = shared.logs.log(&shared.workspace, name, axis.as_deref())?;
        Ok(found.about.clone())
    })
    .await
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Drawn {
    name: String,
    axis: Option<String>,
    /// Whether it is a table that stiction wrote, and no log.
    #[serde(default)]
    table: bool,
    /// Which run of it.
    #[serde(default)]
    run: usize,
    /// Separated by commas.
    #[serde(default)]
    channels: String,
    from: f64,
    to: f64,
    #[serde(default)]
    pixels: usize,
}

impl Drawn {
    fn of(&self, shared: &Shared) -> Result<Arc<logs::Loaded>, Refused> {
        match self.table {
            true => shared.logs.table(&shared.workspace, &self.name, self.run),
            false => {
                let axis = self.axis.as_deref();
                shared.logs.log(&shared.workspace, &self.name, axis)
            }
        }
    }
}

async fn tiles(State(shared): App, Query(asked): Query<Drawn>) -> Answer {
    let work: Work<_> = Box::new(move |shared| {
        let loaded = asked.of(shared)?;
        let names: Vec<&str> = asked.channels.split(',').collect();
        let part = (asked.from, asked.to);
        logs::tiles(&loaded.series, &names, part, asked.pixels)
    });
    in_turn(shared, work).await.map(binary)
}

async fn map(State(shared): App, Query(asked): Query<Drawn>) -> Answer {
    let work: Work<_> = Box::new(move |shared| {
        let loaded = asked.of(shared)?;
        let names: Vec<&str> = match asked.channels.as_str() {
            "" => logs::MAPPED.into(),
            names => names.split(',').collect(),
        };
        Ok(logs::map(&loaded.series, &names, (asked.from, asked.to)))
    });
    in_turn(shared, work).await.map(binary)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    name: String,
    #[serde(default)]
    run: usize,
}

async fn table(State(shared): App, Query(asked): Query<Table>) -> Answer {
    read(shared, move |shared| {
        let Table { name, run } = &asked;
        let found = shared.logs.table(&shared.workspace, name, *run)?;
        let runs = logs::runs(&shared.workspace.file(name)?)?;
        let time = &found.series.time;
        Ok(serde_json::json!({
            "from": time.first(),
            "to": time.last(),
            "channels": found.about.channels,
            "runs": runs.iter().map(|keys| keys.join(" · ")).collect::<Vec<_>>(),
        }))
    })
    .await
}

async fn correct(State(shared): App, Json(asked): Json<Correction>) -> Answer {
    read(shared, move |shared| {
        shared.alone(|| logs::correct(&shared.logs, &shared.workspace, &asked))
    })
    .await
}

/// A target of the export.
#[derive(Serialize)]
struct Target {
    name: &'static str,
    simulated: bool,
}

async fn targets() -> Json<Vec<Target>> {
    let all = stiction_workflows::export::Target::ALL.into_iter();
    let one = |target: stiction_workflows::export::Target| Target {
        name: target.name(),
        simulated: target.is_simulated(),
    };
    Json(all.map(one).collect())
}

/// The command line that does what would be begun.
async fn command(Json(asked): Json<Asked>) -> Json<String> {
    Json(asked.command())
}

async fn begin(State(shared): App, Json(asked): Json<Asked>) -> Answer {
    let begun = shared.jobs.begin(&shared.workspace, asked)?;
    Ok(Json(begun).into_response())
}

async fn jobs(State(shared): App) -> Json<Vec<View>> {
    Json(shared.jobs.all())
}

async fn stop(State(shared): App, Path(id): Path<u64>) -> Answer {
    shared.jobs.stop(id)?;
    Ok(Json(()).into_response())
}

fn binary(bytes: Vec<u8>) -> Response {
    ([(CONTENT_TYPE, "application/octet-stream")], bytes).into_response()
}

/// Answers with what work finds that reads or writes files.
fn blocking<T: Serialize>(
    shared: Arc<Shared>,
    work: impl FnOnce(&Shared) -> Result<T, Refused> + Send + 'static,
) -> impl Future<Output = Answer> {
    answered(away(shared, as_json(work)))
}

/// The same for what may need much memory or time: two at once, the others wait.
fn read<T: Serialize>(
    shared: Arc<Shared>,
    work: impl FnOnce(&Shared) -> Result<T, Refused> + Send + 'static,
) -> impl Future<Output = Answer> {
    answered(in_turn(shared, as_json(work)))
}

/// What is found is written as JSON where it is found, and not by the thread that answers.
fn as_json<T: Serialize>(
    work: impl FnOnce(&Shared) -> Result<T, Refused> + Send + 'static,
) -> Work<Vec<u8>> {
    Box::new(move |shared| written(&work(shared)?))
}

async fn answered(bytes: impl Future<Output = Result<Vec<u8>, Refused>>) -> Answer {
    bytes.await.map(sent)
}

async fn away<T: Send + 'static>(shared: Arc<Shared>, work: Work<T>) -> Result<T, Refused> {
    tokio::task::spawn_blocking(move || work(&shared)).await?
}

async fn in_turn<T: Send + 'static>(shared: Arc<Shared>, work: Work<T>) -> Result<T, Refused> {
    let own = shared.clone();
    let one = own.readers.acquire().await;
    let _one = one.map_err(|_| Refused::internal("a lock"))?;
    away(shared, work).await
}
