//! Work that leaves the interpreter free, tells its progress, and ends early on Ctrl-C.
//!
//! The engines call their observer from any thread, and only the main thread of Python sees signals. So the work has a thread of
//! its own, and the one that called waits, looks for signals and tells the progress.

use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError};
use pyo3::prelude::*;
use std::any::Any;
use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, OnceLock};
use std::thread;
use std::time::Duration;
use stiction_identify::{Control, Observer, Progress};

/// Between two looks for signals and progress.
const BETWEEN: Duration = Duration::from_millis(20);
/// Stack of the thread, bytes: that of a main thread.
const STACK: usize = 8 << 20;

/// The process whose threads those of the process are: one that was forked from it has none of them, and would wait for ever.
static FIRST: OnceLock<u32> = OnceLock::new();

/// What becomes of work that is stopped.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Stopped {
    /// What was found until then is returned.
    Keeps,
    /// There is nothing to keep.
    Loses,
}

/// Who is told of the progress, and how many threads may work.
pub struct How {
    /// Called with stage, fraction and relative error; `False` stops the work.
    pub progress: Option<Py<PyAny>>,
    /// Threads of this work alone; `None` takes those of the process.
    pub threads: Option<usize>,
    /// What a stop does.
    pub stopped: Stopped,
}

impl How {
    /// Nobody is told, and a stop loses everything.
    pub fn quiet() -> Self {
        Self {
            progress: None,
            threads: None,
            stopped: Stopped::Loses,
        }
    }
}

/// What the thread at work and the one that waits share.
#[derive(Default)]
struct Shared {
    stop: AtomicBool,
    /// Whether the work was told so: a stop that comes when everything is found stops nothing.
    stopped: AtomicBool,
    last: Mutex<Option<Progress>>,
}

/// Whom the work asks whether it is to go on.
pub struct Watch<'a>(&'a Shared);

impl Watch<'_> {
    /// Whether it is, for work that tells no progress.
    pub fn goes_on(&mut self) -> bool {
        if !self.0.stop.load(Ordering::Relaxed) {
            return true;
        }
        self.0.stopped.store(true, Ordering::Relaxed);
        false
    }
}

impl Observer for Watch<'_> {
    fn progress(&mut self, progress: &Progress) -> Control {
        if let Ok(mut last) = self.0.last.lock() {
            *last = Some(*progress);
        }
        match self.goes_on() {
            true => Control::Continue,
            false => Control::Stop,
        }
    }
}

/// Does the work and returns what it found, and whether it was told to stop.
pub fn run<T: Send>(
    py: Python<'_>,
    how: &How,
    work: impl FnOnce(&mut Watch<'_>) -> T + Send,
) -> PyResult<(T, bool)> {
    let forked = *FIRST.get_or_init(process::id) != process::id();
    // As many as there are cores where none is asked for.
    let threads = how.threads.or(forked.then_some(0));
    let pool = threads.map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build()
    });
    let pool = pool.transpose();
    let pool = pool.map_err(|e| PyRuntimeError::new_err(e.to_string()))?;
    let shared = Shared::default();
    let (found, refused) = py.detach(|| {
        let (done, awaited) = channel::<()>();
        thread::scope(|scope| {
            let shared = &shared;
            let worker = thread::Builder::new().stack_size(STACK);
            let worker = worker.spawn_scoped(scope, move || {
                // Dropped at the end, also by a panic.
                let _done = done;
                let mut watch = Watch(shared);
                match pool {
                    Some(pool) => pool.install(|| work(&mut watch)),
                    None => work(&mut watch),
                }
            });
            let worker = match worker {
                Ok(worker) => worker,
                Err(e) => return (None, Some(PyRuntimeError::new_err(e.to_string()))),
            };
            let mut refused = None;
            while awaited.recv_timeout(BETWEEN) == Err(RecvTimeoutError::Timeout) {
                let seen = Python::attach(|py| look(py, how, shared));
                if let Err(error) = seen {
                    // The first Ctrl-C asks for what there is, the next one for nothing.
                    let asks = Python::attach(|py| error.is_instance_of::<PyKeyboardInterrupt>(py));
                    let again = shared.stop.swap(true, Ordering::Relaxed);
                    if !asks || again || how.stopped == Stopped::Loses {
                        refused = refused.or(Some(error));
                    }
                }
            }
            let found = match worker.join() {
                Ok(found) => Some(found),
                Err(panic) => {
                    refused = Some(PyRuntimeError::new_err(words(panic.as_ref())));
                    None
                }
            };
            (found, refused)
        })
    });
    // Short work has not been seen at all.
    if refused.is_none() {
        tell(py, how, &shared)?;
    }
    match (found, refused) {
        (_, Some(error)) => Err(error),
        (Some(found), None) => Ok((found, shared.stopped.load(Ordering::Relaxed))),
        (None, None) => Err(PyRuntimeError::new_err("no thread could be started")),
    }
}

/// Looks for signals, then tells the progress.
fn look(py: Python<'_>, how: &How, shared: &Shared) -> PyResult<()> {
    py.check_signals()?;
    tell(py, how, shared)
}

/// Tells what is new.
fn tell(py: Python<'_>, how: &How, shared: &Shared) -> PyResult<()> {
    let Some(progress) = &how.progress else {
        return Ok(());
    };
    let last = shared.last.lock().ok().and_then(|mut last| last.take());
    let Some(last) = last else {
        return Ok(());
    };
    let error = last.best.is_finite().then_some(last.best);
    let answer = progress.call1(py, (last.stage.name(), last.fraction, error))?;
    // `None` and everything else go on.
    if answer.extract::<bool>(py).is_ok_and(|goes_on| !goes_on) {
        shared.stop.store(true, Ordering::Relaxed);
    }
    Ok(())
}

/// What a panic said.
fn words(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or(panic.downcast_ref::<&str>().copied());
    format!(
        "internal error of stiction, please report it: {}",
        text.unwrap_or("no message")
    )
}
