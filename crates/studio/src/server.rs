//! The server: a folder, a port of this machine, and what they share.

use crate::api;
use crate::guard::{self, Keys};
use crate::jobs::Jobs;
use crate::logs::Logs;
use crate::tickets::Tickets;
use crate::workspace::Workspace;
use axum::middleware;
use std::net::{Ipv4Addr, SocketAddr};
use std::path::Path;
use std::sync::Arc;
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
}

/// A folder that is going to be served.
#[derive(Debug)]
pub struct Studio {
    workspace: Workspace,
    port: u16,
}

/// A server that listens.
#[derive(Debug)]
pub struct Served {
    listener: TcpListener,
    shared: Arc<Shared>,
    address: SocketAddr,
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
        Ok(Self { workspace, port })
    }

    /// Serves it until the process ends. `listening` is told the address to open, which holds the token, once it can be opened.
    ///
    /// # Errors
    /// Where the port is taken, or no thread can be started.
    pub fn serve(self, listening: impl FnOnce(&str)) -> std::io::Result<()> {
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(2)
            .enable_all()
            .build()?;
        runtime.block_on(async {
            let served = self.listen().await?;
            listening(&served.address());
            served.run().await
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
        };
        Ok(Served {
            listener,
            shared: Arc::new(shared),
            address,
        })
    }
}

impl Served {
    /// The address to open, with the token in its fragment, which no browser sends.
    pub fn address(&self) -> String {
        format!("http://{}/#token={}", self.address, self.shared.keys.token)
    }

    /// Answers until the process ends.
    ///
    /// # Errors
    /// Where the listener fails.
    pub async fn run(self) -> std::io::Result<()> {
        let guard = middleware::from_fn_with_state(self.shared.clone(), guard::guard);
        let router = api::router().layer(guard).with_state(self.shared);
        axum::serve(self.listener, router).await
    }
}
