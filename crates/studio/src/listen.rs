//! Connections: as many as are taken at once, none of which may hold its place by sending slowly.

use axum::Router;
use axum::body::{Body, BodyDataStream, Bytes};
use axum::extract::Request;
use axum::middleware::Next;
use axum::response::Response;
use futures_core::Stream;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use std::future::Future;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::sync::Semaphore;
use tokio::time::{Instant, Sleep, sleep};

/// How long the head of a request, and its body, may take to arrive.
pub const PATIENCE: Duration = Duration::from_secs(30);
/// Connections at once; further ones wait to be accepted.
const CONNECTIONS: usize = 256;
/// Until it is tried again where no connection can be accepted, as when the process has too many files open.
const AGAIN: Duration = Duration::from_millis(200);

/// Answers until the process ends.
pub async fn serve(listener: TcpListener, router: Router, patience: Duration) {
    let places = Arc::new(Semaphore::new(CONNECTIONS));
    let mut http = http1::Builder::new();
    // The time for a head counts between the requests of a connection as well.
    http.timer(TokioTimer::new()).header_read_timeout(patience);
    loop {
        let Ok(place) = places.clone().acquire_owned().await else {
            return;
        };
        let Ok((stream, _)) = listener.accept().await else {
            sleep(AGAIN).await;
            continue;
        };
        // Answers are short, and waited for.
        let _ = stream.set_nodelay(true);
        let service = TowerToHyperService::new(router.clone());
        let connection = http.serve_connection(TokioIo::new(stream), service);
        tokio::spawn(async move {
            // A connection that breaks off is nobody's fault here.
            let _ = connection.await;
            drop(place);
        });
    }
}

/// Gives up on a body that does not arrive: as a whole, and for an upload, which may be long, on the next piece of it.
pub async fn in_time(patience: Duration, request: Request, next: Next) -> Response {
    let renewed = request.uri().path() == "/api/upload";
    let timed = |body: Body| {
        Body::from_stream(Timed {
            body: body.into_data_stream(),
            left: Box::pin(sleep(patience)),
            renewed: renewed.then_some(patience),
        })
    };
    next.run(request.map(timed)).await
}

/// A body that has to arrive in time.
struct Timed {
    body: BodyDataStream,
    left: Pin<Box<Sleep>>,
    /// What is left after each piece.
    renewed: Option<Duration>,
}

impl Stream for Timed {
    type Item = Result<Bytes, axum::BoxError>;

    fn poll_next(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Option<Self::Item>> {
        if let Poll::Ready(piece) = Pin::new(&mut self.body).poll_next(context) {
            if let Some(patience) = self.renewed {
                self.left.as_mut().reset(Instant::now() + patience);
            }
            return Poll::Ready(piece.map(|piece| piece.map_err(Into::into)));
        }
        match self.left.as_mut().poll(context) {
            Poll::Ready(()) => Poll::Ready(Some(Err(
                "the body of the request did not arrive in time".into(),
            ))),
            Poll::Pending => Poll::Pending,
        }
    }
}
