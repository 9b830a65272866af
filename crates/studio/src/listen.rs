//! Connections: bounds on how many are open at once and on how long a request may take to arrive.
//!
//! A connection without the cookie of the session is a stranger. Strangers have few places, and the oldest is dropped for a new
//! one: whoever opens connections and sends nothing cannot shut out a browser with a session.

use crate::held::held;
use crate::server::Shared;
use axum::Router;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::sync::Semaphore;
use tokio::task::{self, AbortHandle};
use tokio::time::sleep;

/// How long the body of a request may take to arrive.
pub const PATIENCE: Duration = Duration::from_secs(30);
/// How long its head may take, at most.
const HEAD: Duration = Duration::from_secs(10);
/// Connections at once; further ones wait to be accepted.
const CONNECTIONS: usize = 256;
/// Connections at once on which nobody has shown the cookie.
const STRANGERS: usize = 64;
/// Until it is tried again where no connection can be accepted, as when the process has too many files open.
const AGAIN: Duration = Duration::from_millis(200);

/// Connections on which nobody has shown the cookie of the session, the oldest first.
#[derive(Debug, Default)]
pub struct Strangers(Mutex<VecDeque<AbortHandle>>);

impl Strangers {
    /// Takes the connection of the running task out: it has shown the cookie, or ends.
    pub fn leave(&self) {
        let own = task::id();
        held(&self.0).retain(|other| other.id() != own);
    }

    /// Adds a connection, and drops the oldest where there are too many.
    fn add(&self, connection: AbortHandle) {
        let mut all = held(&self.0);
        all.push_back(connection);
        if all.len() > STRANGERS {
            all.pop_front().iter().for_each(AbortHandle::abort);
        }
    }
}

/// Answers until the process ends.
pub async fn serve(listener: TcpListener, router: Router, shared: Arc<Shared>) {
    let places = Arc::new(Semaphore::new(CONNECTIONS));
    let mut http = http1::Builder::new();
    // The time for a head counts between the requests of a connection as well.
    http.timer(TokioTimer::new())
        .header_read_timeout(shared.patience.min(HEAD));
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
        let own = shared.clone();
        let connection = task::spawn(async move {
            // A connection that breaks off is nobody's fault here.
            let _ = connection.await;
            own.strangers.leave();
            drop(place);
        });
        shared.strangers.add(connection.abort_handle());
        // It may show its cookie before the next is let in.
        task::yield_now().await;
    }
}
