//! Runs shared out among threads, each of which works on one at a time.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;
use stiction_search::{Control, Observer, Progress, Stage};

/// Does every task and returns the results in the order of the tasks, and whether the work was stopped.
///
/// Every thread has a pool of its own with one thread in it. In a common pool, a thread whose run waits for its batch
/// would start another run meanwhile, and the time of neither would mean anything.
pub(super) fn run<T: Sync, R: Send>(
    tasks: &[T],
    observer: &mut dyn Observer,
    work: impl Fn(&T, &AtomicBool) -> Option<R> + Sync,
) -> (Vec<Option<R>>, bool) {
    let (next, done, stop) = (
        AtomicUsize::new(0),
        AtomicUsize::new(0),
        AtomicBool::new(false),
    );
    let results: Mutex<Vec<Option<R>>> = Mutex::new(tasks.iter().map(|_| None).collect());
    let one = || {
        while !stop.load(Ordering::SeqCst) {
            let i = next.fetch_add(1, Ordering::SeqCst);
            let Some(task) = tasks.get(i) else { break };
            let found = work(task, &stop);
            results.lock().unwrap_or_else(PoisonError::into_inner)[i] = found;
            done.fetch_add(1, Ordering::SeqCst);
        }
    };
    let threads = rayon::current_num_threads().min(tasks.len());
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads)
            .map(|_| {
                scope.spawn(
                    || match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
                        Ok(pool) => pool.install(one),
                        Err(_) => one(),
                    },
                )
            })
            .collect();
        while workers.iter().any(|worker| !worker.is_finished()) {
            let fraction = done.load(Ordering::SeqCst) as f64 / tasks.len().max(1) as f64;
            let control = observer.progress(&Progress::of(Stage::Search, fraction));
            if control == Control::Stop {
                stop.store(true, Ordering::SeqCst);
            }
            std::thread::park_timeout(Duration::from_millis(20));
        }
    });
    let results = results.into_inner().unwrap_or_else(PoisonError::into_inner);
    (results, stop.into_inner())
}
