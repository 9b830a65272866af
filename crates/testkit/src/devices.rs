//! Servers on this machine that send what a device would, from the descriptions of the protocols, and take no command that
//! changes anything.
//!
//! Samples are sent as fast as they are taken; their time stamps are those of the rate.

mod plc;
mod robot;

pub use plc::{Plc, Variable};
pub use robot::Robot;

use std::collections::BTreeSet;
use std::io::{ErrorKind, Read};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

/// What a server does with its samples, by their numbers from 0.
#[derive(Clone, Debug, Default)]
pub struct Script {
    /// So many samples, then silence.
    pub samples: usize,
    /// Samples that are not sent.
    pub lost: BTreeSet<usize>,
    /// Samples before which the connection ends.
    pub cuts: BTreeSet<usize>,
    /// No connection is accepted after the last sample of the first.
    pub gone: bool,
}

/// A server that is ended with the value.
struct Server {
    at: SocketAddr,
    over: Arc<AtomicBool>,
    busy: Arc<AtomicBool>,
    refused: Arc<Mutex<Vec<String>>>,
    thread: Option<JoinHandle<()>>,
}

/// What a server has for one connection.
struct Served<'a> {
    stream: TcpStream,
    over: &'a AtomicBool,
    refused: &'a Mutex<Vec<String>>,
}

impl Server {
    /// Serves one connection after the other; `serve` is told nothing of the one before, and ends the server with `false`.
    fn start(mut serve: impl FnMut(Served) -> bool + Send + 'static) -> Self {
        let listener = TcpListener::bind(("127.0.0.1", 0)).expect("a free port");
        let at = listener.local_addr().expect("a bound port");
        let over = Arc::new(AtomicBool::new(false));
        let refused = Arc::new(Mutex::new(Vec::new()));
        let busy = Arc::new(AtomicBool::new(false));
        let (ends, refuses, works) = (over.clone(), refused.clone(), busy.clone());
        let thread = std::thread::spawn(move || {
            for stream in listener.incoming() {
                if ends.load(Ordering::SeqCst) {
                    return;
                }
                let stream = stream.expect("a connection");
                let wait = stream.set_read_timeout(Some(Duration::from_millis(20)));
                wait.and_then(|()| stream.set_nodelay(true))
                    .expect("a socket with a limit");
                let served = Served {
                    stream,
                    over: &ends,
                    refused: &refuses,
                };
                works.store(true, Ordering::SeqCst);
                let goes_on = serve(served);
                works.store(false, Ordering::SeqCst);
                if !goes_on {
                    return;
                }
            }
        });
        Self {
            at,
            over,
            busy,
            refused,
            thread: Some(thread),
        }
    }

    /// Commands that were refused, once the last client is gone: with one that only reads, none.
    fn refused(&self) -> Vec<String> {
        while self.busy.load(Ordering::SeqCst) {
            std::thread::sleep(Duration::from_millis(1));
        }
        let refused = self.refused.lock();
        refused.unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.over.store(true, Ordering::SeqCst);
        // Wakes the server where it waits for a connection.
        let _ = TcpStream::connect(self.at);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

impl Served<'_> {
    /// Reads so many bytes; `None` where the client or the test is gone.
    fn read(&mut self, bytes: usize) -> Option<Vec<u8>> {
        let mut all = vec![0; bytes];
        let mut read = 0;
        while read < bytes {
            if self.over.load(Ordering::SeqCst) {
                return None;
            }
            match self.stream.read(&mut all[read..]) {
                Ok(0) => return None,
                Ok(more) => read += more,
                Err(e) if matches!(e.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
                Err(_) => return None,
            }
        }
        Some(all)
    }

    fn refuse(&self, what: String) {
        let refused = self.refused.lock();
        refused.unwrap_or_else(PoisonError::into_inner).push(what);
    }
}

/// A value of a column that no two samples share, with all digits.
pub fn value(sample: usize, column: usize) -> f64 {
    (0.618_034 * sample as f64 + 1.7 * column as f64).sin() / 3.0
}
