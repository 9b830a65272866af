//! Long work: started by one tab, seen by all of them, and still there after a reload.

use crate::asked::{Asked, Done, Run};
use crate::held::held;
use crate::refused::Refused;
use crate::workspace::Workspace;
use serde::Serialize;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use stiction_identify::{Control, Observer, Progress};
use tokio::sync::mpsc;

/// Work that runs at once; more is refused, and the page says so.
const RUNNING: usize = 2;
/// Finished work that is remembered.
const KEPT: usize = 40;
/// Tabs that watch.
const WATCHERS: usize = 32;
/// Messages that wait for a tab; one that takes none is let go, and asks again.
const WAITING: usize = 64;
/// Between two messages of the same work.
const BETWEEN: Duration = Duration::from_millis(100);
/// Stack of a thread at work, bytes: that of a main thread.
const STACK: usize = 8 << 20;

/// All work of this run.
#[derive(Debug, Default)]
pub struct Jobs(Mutex<Board>);

#[derive(Debug, Default)]
struct Board {
    jobs: Vec<Job>,
    last: u64,
    watchers: Vec<mpsc::Sender<String>>,
}

#[derive(Debug)]
struct Job {
    view: View,
    began: Instant,
    /// When its stage began, and what of it was done then.
    stage: (Instant, f64),
    stop: Arc<AtomicBool>,
}

/// What a tab sees of a piece of work.
#[derive(Clone, Debug, Default, Serialize)]
pub struct View {
    pub id: u64,
    /// The command: `identify`.
    pub kind: &'static str,
    /// The line that does the same.
    pub command: String,
    /// The log or file that it is about.
    pub about: String,
    /// `running`, `stopping`, `done` or `failed`.
    pub state: &'static str,
    pub stage: Option<&'static str>,
    /// Part of the stage that is done.
    pub fraction: f64,
    pub seconds: f64,
    /// Seconds that the stage will take at most as long as so far; `None` where it is not known.
    pub left: Option<f64>,
    /// rms(residual)/rms(measured), in percent.
    pub error_percent: Option<f64>,
    /// What became of it; before, the folder alone.
    #[serde(flatten)]
    pub done: Done,
}

impl Jobs {
    /// Begins a piece of work.
    pub fn begin(self: &Arc<Self>, workspace: &Workspace, asked: Asked) -> Result<u64, Refused> {
        let mut board = held(&self.0);
        let running = || board.jobs.iter().filter(|job| job.is_running());
        if running().count() >= RUNNING {
            return Err(Refused::busy(format!(
                "{RUNNING} pieces of work are running; stop one, or wait"
            )));
        }
        let what = asked.work().what();
        let out = what.out.map(String::from);
        if out.is_some() && running().any(|job| job.view.done.folder == out) {
            return Err(Refused::conflict("other work is writing into that folder"));
        }
        board.last += 1;
        let id = board.last;
        let stop = Arc::new(AtomicBool::new(false));
        let now = Instant::now();
        let view = View {
            id,
            kind: what.kind,
            command: asked.command(),
            about: what.about,
            state: "running",
            done: Done {
                folder: out,
                ..Done::default()
            },
            ..View::default()
        };
        let watch = Watch {
            jobs: self.clone(),
            id,
            stop: stop.clone(),
            stopped: Arc::default(),
            told: None,
        };
        let (workspace, jobs) = (workspace.clone(), self.clone());
        let thread = std::thread::Builder::new().stack_size(STACK);
        thread.spawn(move || {
            let stopped = watch.stopped.clone();
            let work = || {
                let mut watch = watch;
                let stopped = || stopped.load(Ordering::Relaxed);
                asked.work().run(Run {
                    workspace: &workspace,
                    observer: &mut watch,
                    stopped: &stopped,
                })
            };
            let ended = catch_unwind(AssertUnwindSafe(work));
            jobs.end(id, ended.unwrap_or_else(|_| {
                Err(Refused::internal(
                    "internal error of stiction; please report it with the command and, if you can, the log",
                ))
            }));
        })?;
        board.jobs.push(Job {
            view,
            began: now,
            stage: (now, 0.0),
            stop,
        });
        while board.jobs.len() > KEPT {
            let Some(at) = board.jobs.iter().position(|job| !job.is_running()) else {
                break;
            };
            board.jobs.remove(at);
        }
        board.tell(id);
        Ok(id)
    }

    /// Asks work to stop; what it found until then is kept.
    pub fn stop(&self, id: u64) -> Result<(), Refused> {
        let mut board = held(&self.0);
        let job = board.job(id).filter(|job| job.is_running());
        let job = job.ok_or_else(|| Refused::missing("no such work is running"))?;
        job.stop.store(true, Ordering::Relaxed);
        job.view.state = "stopping";
        board.tell(id);
        Ok(())
    }

    /// All work, the oldest first.
    pub fn all(&self) -> Vec<View> {
        held(&self.0)
            .jobs
            .iter()
            .map(|job| job.view.clone())
            .collect()
    }

    /// What becomes of all work from now on, each message the JSON of one piece; first come all as they are.
    pub fn watch(&self) -> Result<mpsc::Receiver<String>, Refused> {
        let mut board = held(&self.0);
        board.watchers.retain(|watcher| !watcher.is_closed());
        if board.watchers.len() >= WATCHERS {
            return Err(Refused::busy("too many tabs"));
        }
        let (sender, receiver) = mpsc::channel(WAITING + KEPT);
        for job in &board.jobs {
            // There is room for all of them.
            let _ = sender.try_send(job.view.json());
        }
        board.watchers.push(sender);
        Ok(receiver)
    }

    fn end(&self, id: u64, ended: Result<Done, Refused>) {
        let mut board = held(&self.0);
        if let Some(job) = board.job(id) {
            let view = &mut job.view;
            view.seconds = job.began.elapsed().as_secs_f64();
            (view.stage, view.left) = (None, None);
            match ended {
                Ok(done) => {
                    view.state = "done";
                    view.done = done;
                }
                Err(refused) => {
                    view.state = "failed";
                    view.done.text = refused.message().into();
                }
            }
        }
        board.tell(id);
    }
}

impl Board {
    fn job(&mut self, id: u64) -> Option<&mut Job> {
        self.jobs.iter_mut().find(|job| job.view.id == id)
    }

    /// Tells all tabs of a piece of work; one that does not listen is let go.
    fn tell(&mut self, id: u64) {
        let Some(message) = self.job(id).map(|job| job.view.json()) else {
            return;
        };
        self.watchers
            .retain(|watcher| watcher.try_send(message.clone()).is_ok());
    }
}

impl Job {
    fn is_running(&self) -> bool {
        ["running", "stopping"].contains(&self.view.state)
    }
}

impl View {
    fn json(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }
}

/// Sees one piece of work.
struct Watch {
    jobs: Arc<Jobs>,
    id: u64,
    stop: Arc<AtomicBool>,
    /// Whether the work was told so: a stop that comes when everything is found stops nothing.
    stopped: Arc<AtomicBool>,
    told: Option<Instant>,
}

impl Observer for Watch {
    fn progress(&mut self, progress: &Progress) -> Control {
        if self.told.is_none_or(|told| told.elapsed() >= BETWEEN) {
            self.told = Some(Instant::now());
            let mut board = held(&self.jobs.0);
            if let Some(job) = board.job(self.id) {
                job.progress(progress);
            }
            board.tell(self.id);
        }
        if !self.stop.load(Ordering::Relaxed) {
            return Control::Continue;
        }
        self.stopped.store(true, Ordering::Relaxed);
        Control::Stop
    }
}

impl Job {
    fn progress(&mut self, progress: &Progress) {
        let stage = progress.stage.name();
        if self.view.stage != Some(stage) {
            self.stage = (Instant::now(), progress.fraction);
        }
        let (since, before) = self.stage;
        let left = since.elapsed().as_secs_f64() * (1.0 - progress.fraction)
            / (progress.fraction - before);
        let view = &mut self.view;
        view.stage = Some(stage);
        view.fraction = progress.fraction;
        view.seconds = self.began.elapsed().as_secs_f64();
        view.left = left.is_finite().then_some(left);
        view.error_percent = progress.best.is_finite().then_some(100.0 * progress.best);
    }
}
