//! The server: a folder, a port of this machine, and what they share.

use crate::api;
use crate::forward::{self, Forward};
use crate::guard::{self, Keys};
use crate::held::held;
use crate::jobs::Jobs;
use crate::listen::{self, Strangers};
use crate::logs::Logs;
use crate::refused::Refused;
use crate::secret::secret;
use crate::tickets::Tickets;
use crate::workspace::Workspace;
use axum::middleware;
use std::net::{Ipv4Addr, TcpListener};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::sync::Semaphore;

/// Requests with the cookie that are answered at once; further ones are told so.
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
    pub strangers: Strangers,
    pub requests: Semaphore,
    pub uploads: Semaphore,
    pub readers: Semaphore,
    /// Held while a text file is read and written again, so that of two changes at once none is lost.
    pub writing: Mutex<()>,
    /// How long the body of a request may take to arrive.
    pub patience: Duration,
}

impl Shared {
    /// Reads a text file and writes it again while nobody else does.
    pub fn alone<T>(&self, work: impl FnOnce() -> Result<T, Refused>) -> Result<T, Refused> {
        let _one = held(&self.writing);
        work()
    }
}

/// A folder on a port of this machine, which is answered on once it is served.
#[derive(Debug)]
pub struct Studio {
    listener: TcpListener,
    shared: Shared,
}

impl Studio {
    /// A folder that is there, on a port of this machine alone; 0 takes one that is free.
    ///
    /// Where it is the working directory, results name their inputs as the command line does there.
    ///
    /// # Errors
    /// Where it cannot be read or is no folder, or the port is taken.
    pub fn open(folder: &Path, port: u16) -> std::io::Result<Self> {
        let workspace = Workspace::open(folder)?;
        workspace.tidy();
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        listener.set_nonblocking(true)?;
        let shared = Shared {
            keys: Keys::new(listener.local_addr()?.port())?,
            workspace,
            logs: Logs::default(),
            jobs: Arc::default(),
            tickets: Tickets::default(),
            strangers: Strangers::default(),
            requests: Semaphore::new(REQUESTS),
            uploads: Semaphore::new(UPLOADS),
            readers: Semaphore::new(READERS),
            writing: Mutex::default(),
            patience: listen::PATIENCE,
        };
        Ok(Self { listener, shared })
    }

    /// Waits so long for the body of a request (of an upload, for each piece of it), instead of 30 s, and no longer for its head.
    #[must_use]
    pub fn with_patience(mut self, patience: Duration) -> Self {
        self.shared.patience = patience;
        self
    }

    /// An address that opens the page once: in its fragment, which no browser sends, it has a token of its own.
    ///
    /// # Errors
    /// Where the system gives no random numbers.
    pub fn address(&self) -> std::io::Result<String> {
        let token = secret()?;
        let address = self.shared.keys.address(&token);
        self.shared.keys.add(token, None);
        Ok(address)
    }

    /// A file that opens the page once, which no other user can read. It is removed when a browser has opened it, else after
    /// five minutes.
    ///
    /// # Errors
    /// Where no folder keeps it from other users.
    pub fn forward(&self) -> std::io::Result<PathBuf> {
        let token = secret()?;
        // A browser in a sandbox does not see the folder for temporary files, but that of its user.
        let folders = [self.shared.workspace.folder(), &std::env::temp_dir()];
        let forward = Forward::to(&self.shared.keys.address(&token), &folders)?;
        let path = forward.path().to_path_buf();
        self.shared.keys.add(token, Some(forward));
        Ok(path)
    }

    /// Serves it until the process ends.
    ///
    /// # Errors
    /// Where no thread can be started.
    pub fn serve(self) -> std::io::Result<()> {
        // One thread answers: whatever reads, writes or computes does so on others.
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()?;
        let shared = Arc::new(self.shared);
        runtime.block_on(async {
            let listener = tokio::net::TcpListener::from_std(self.listener)?;
            let late = shared.clone();
            tokio::spawn(async move {
                tokio::time::sleep(forward::WAIT).await;
                late.keys.forget_files();
            });
            // Who may not ask is refused before anything of a body is waited for.
            let guard = middleware::from_fn_with_state(shared.clone(), guard::guard);
            let router = api::router().layer(guard).with_state(shared.clone());
            listen::serve(listener, router, shared).await;
            Ok(())
        })
    }
}
