//! The server: a folder, a port of this machine, and what they share.

use crate::api;
use crate::guard::{self, Keys};
use crate::jobs::Jobs;
use crate::listen;
use crate::logs::Logs;
use crate::refused::Refused;
use crate::tickets::Tickets;
use crate::workspace::Workspace;
use axum::middleware;
use std::net::{Ipv4Addr, SocketAddr};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::sync::Semaphore;

/// Requests that are answered at once; further ones are told so.
const REQUESTS: usize = 64;
/// Uploads at once.
const UPLOADS: usize = 2;
/// Logs that are read, and tables that are packed, at once.
const READERS: usize = 2;

/// What all requests share.
#[derive(Debug)]
pub struct Shared {
    pub keys: Keys,
    pub workspace: Workspace,
    pub logs: Logs,
    pub jobs: Arc<Jobs>,
    pub tickets: Tickets,
    pub requests: Semaphore,
    pub uploads: Semaphore,
    pub readers: Semaphore,
    /// Held while a text file is read and written again, so that of two changes at once none is lost.
    pub writing: Mutex<()>,
}

impl Shared {
    /// Reads a text file and writes it again while nobody else does.
    pub fn alone<T>(&self, work: impl FnOnce() -> Result<T, Refused>) -> Result<T, Refused> {
        // Who panicked has written the whole file or nothing of it.
        let _one = self.writing.lock().unwrap_or_else(PoisonError::into_inner);
        work()
    }
}

/// A folder that is going to be served.
#[derive(Debug)]
pub struct Studio {
    workspace: Workspace,
    port: u16,
    patience: Duration,
}

/// A server that listens.
#[derive(Debug)]
pub struct Served {
    listener: TcpListener,
    shared: Arc<Shared>,
    address: SocketAddr,
    patience: Duration,
}

impl Studio {
    /// A folder that is there, on a port of this machine alone; 0 takes one that is free.
    ///
    /// Where it is the working directory, results name their inputs as the command line does there.
    ///
    /// # Errors
    /// Where it cannot be read or is no folder.
    pub fn open(folder: &Path, port: u16) -> std::io::Result<Self> {
        let workspace = Workspace::open(folder)?;
        workspace.tidy();
        Ok(Self {
            workspace,
            port,
            patience: listen::PATIENCE,
        })
    }

    /// Waits so long for the head of a request, and for its body (of an upload, for each piece of it), instead of 30 s.
    #[must_use]
    pub fn with_patience(mut self, patience: Duration) -> Self {
        self.patience = patience;
        self
    }

    /// Serves it until the process ends. `listening` is told the address to open, which holds the token, once it can be opened.
    ///
    /// # Errors
    /// Where the port is taken, or no thread can be started.
    pub fn serve(self, listening: impl FnOnce(&str)) -> std::io::Result<()> {
        // One thread answers: whatever reads, writes or computes does so on others.
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()?;
        runtime.block_on(async {
            let served = self.listen().await?;
            listening(&served.address());
            served.run().await;
            Ok(())
        })
    }

    /// Listens.
    ///
    /// # Errors
    /// Where the port is taken.
    pub async fn listen(self) -> std::io::Result<Served> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, self.port)).await?;
        let address = listener.local_addr()?;
        let shared = Shared {
            keys: Keys::new(address.port())?,
            workspace: self.workspace,
            logs: Logs::default(),
            jobs: Arc::default(),
            tickets: Tickets::default(),
            requests: Semaphore::new(REQUESTS),
            uploads: Semaphore::new(UPLOADS),
            readers: Semaphore::new(READERS),
            writing: Mutex::default(),
        };
        Ok(Served {
            listener,
            shared: Arc::new(shared),
            address,
            patience: self.patience,
        })
    }
}

impl Served {
    /// The address to open, with the token in its fragment, which no browser sends.
    pub fn address(&self) -> String {
        format!("http://{}/#token={}", self.address, self.shared.keys.token)
    }

    /// Answers until the process ends.
    pub async fn run(self) {
        let patience = self.patience;
        let in_time =
            middleware::from_fn(move |request, next| listen::in_time(patience, request, next));
        let guard = middleware::from_fn_with_state(self.shared.clone(), guard::guard);
        // Who may not ask is refused before anything of a body is waited for.
        let router = api::router().layer(in_time).layer(guard);
        listen::serve(self.listener, router.with_state(self.shared), patience).await;
    }
}
