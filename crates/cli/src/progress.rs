//! Progress on standard error: a bar on a terminal, now and then a line where that is none.

use crate::interrupt;
use crate::output;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::mem::discriminant;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use stiction_formats::Reading;
use stiction_identify::{Control, Observer, Progress, Stage};
use stiction_number::Percent;

/// Shows how far work is with the best cost so far, and passes the user's interrupt on.
pub struct Bar {
    bar: ProgressBar,
    stage: Option<Stage>,
    /// When the present stage was first told of, and what of it was done then.
    first: (Instant, f64),
    /// Where there is no terminal.
    lines: Option<Lines>,
}

impl Bar {
    /// A bar, or lines where standard error is no terminal; neither where the user wants none.
    pub fn new(hidden: bool) -> Self {
        let terminal = std::io::stderr().is_terminal();
        Self {
            bar: bar(1000, hidden || !terminal),
            stage: None,
            first: (Instant::now(), 0.0),
            lines: (!hidden && !terminal).then(Lines::default),
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// A bar, or a hidden one.
fn bar(length: u64, hidden: bool) -> ProgressBar {
    let bar = ProgressBar::new(length);
    if hidden {
        bar.set_draw_target(ProgressDrawTarget::hidden());
    }
    if let Ok(style) =
        ProgressStyle::with_template("{prefix:>18} {wide_bar} {percent:>3} %  {msg}  {left}")
    {
        let time = |state: &ProgressState, out: &mut dyn std::fmt::Write| {
            // A bar that cannot be written has nobody to see it.
            let _ = out.write_str(&left(state.pos(), state.eta()));
        };
        bar.set_style(style.with_key("left", time));
    }
    bar
}

/// The time that is left, which nobody knows before anything is done.
fn left(done: u64, eta: Duration) -> String {
    match done {
        0 => String::new(),
        _ => format!("left {:#}", HumanDuration(eta)),
    }
}

/// Between the lines that say how far work is, and before the first: what is short says nothing.
const BETWEEN: Duration = Duration::from_secs(20);

/// How far a log has been read, where that takes long.
struct Read {
    bar: ProgressBar,
    shown: bool,
    lines: Option<Lines>,
    began: Instant,
}

/// Before a bar of reading is shown: what is short says nothing.
const SHORT: Duration = Duration::from_millis(500);

static HIDDEN: AtomicBool = AtomicBool::new(true);
static READ: Mutex<Option<Read>> = Mutex::new(None);

/// Shows from now on how far a log has been read, unless the user wants nothing of it; an interrupt while that lasts ends the
/// process.
pub fn watch_readings(hidden: bool) {
    HIDDEN.store(hidden, Ordering::Relaxed);
    stiction_formats::watch(|reading| {
        interrupt::nothing_yet();
        if let (false, Ok(mut read)) = (HIDDEN.load(Ordering::Relaxed), READ.lock()) {
            show(&mut read, reading);
        }
    });
}

fn show(read: &mut Option<Read>, reading: &Reading) {
    if reading.done >= reading.all {
        if let Some(done) = read.take() {
            done.bar.finish_and_clear();
        }
        return;
    }
    let read = read.get_or_insert_with(|| {
        let terminal = std::io::stderr().is_terminal();
        Read {
            bar: bar(1000, true),
            shown: !terminal,
            lines: (!terminal).then(Lines::default),
            began: Instant::now(),
        }
    });
    if !read.shown && read.began.elapsed() > SHORT {
        read.shown = true;
        read.bar.set_draw_target(ProgressDrawTarget::stderr());
        read.bar.set_prefix("reading");
        let name = reading.file.file_name().unwrap_or_default();
        read.bar.set_message(output::line(&name.to_string_lossy()));
    }
    let part = reading.done as f64 / reading.all as f64;
    read.bar.set_position((1000.0 * part) as u64);
    if let Some(lines) = &mut read.lines {
        let elapsed = read.began.elapsed();
        if lines.due(elapsed) {
            let file = reading.file.display();
            let line = format!(
                "{} s: reading {file}, {} %",
                elapsed.as_secs(),
                (100.0 * part) as u64
            );
            // As everywhere here.
            let _ = writeln!(std::io::stderr(), "stiction: {}", output::line(&line));
        }
    }
}

/// When the next line is due.
struct Lines {
    began: Instant,
    said: Duration,
    /// When the present stage was first told of, and what of it was done then.
    first: Option<(Stage, Duration, f64)>,
}

impl Default for Lines {
    fn default() -> Self {
        Self {
            began: Instant::now(),
            said: Duration::ZERO,
            first: None,
        }
    }
}

impl Lines {
    /// Whether a line is due at a time after the start; then the next is due later.
    fn due(&mut self, elapsed: Duration) -> bool {
        let due = elapsed >= self.said + BETWEEN;
        if due {
            self.said = elapsed;
        }
        due
    }

    fn tell(&mut self, progress: &Progress) {
        let elapsed = self.began.elapsed();
        let of = |stage: &Stage| discriminant(stage) == discriminant(&progress.stage);
        let first = self.first.filter(|(stage, ..)| of(stage));
        let (_, since, before) =
            *self
                .first
                .insert(first.unwrap_or((progress.stage, elapsed, progress.fraction)));
        if self.due(elapsed) {
            // With standard error closed there is nowhere to say it.
            let took = elapsed.saturating_sub(since);
            let ahead = ahead(progress.fraction, before, took);
            let rate =
                rate(progress, before, took).map_or(String::new(), |said| format!(", {said}"));
            let line = output::line(&format!("{}{rate}{ahead}", line(progress, elapsed)));
            let _ = writeln!(std::io::stderr(), "stiction: {line}");
        }
    }
}

/// The time that is left of a stage of which that part is done, `before` of it before the time that it took.
fn ahead(done: f64, before: f64, took: Duration) -> String {
    let left = took.as_secs_f64() * (1.0 - done) / (done - before);
    match Duration::try_from_secs_f64(left) {
        Ok(left) => format!(", left {:#}", HumanDuration(left)),
        Err(_) => String::new(),
    }
}

/// How many logs a second, or a minute, are done, `before` of all before the time that it took.
fn rate(progress: &Progress, before: f64, took: Duration) -> Option<String> {
    let Stage::Logs { all, .. } = progress.stage else {
        return None;
    };
    let each_second = (progress.fraction - before) * all as f64 / took.as_secs_f64();
    match each_second {
        x if x >= 1.0 => Some(format!("{x:.1} logs/s")),
        x if x > 0.0 => Some(format!("{:.1} logs/min", 60.0 * x)),
        _ => None,
    }
}

/// How far work is, as a line.
fn line(progress: &Progress, elapsed: Duration) -> String {
    let percent = (100.0 * progress.fraction) as u64;
    let message = message(progress).map_or_else(String::new, |said| format!(", {said}"));
    let stage = progress.stage.name();
    format!("{} s: {stage}, {percent} %{message}", elapsed.as_secs())
}

/// What is said beside the part that is done.
fn message(progress: &Progress) -> Option<String> {
    if progress.best.is_finite() {
        let error = Percent::error(100.0 * progress.best).decimals(3);
        return Some(format!("error {error}"));
    }
    match progress.stage {
        Stage::Experiments { done, all } | Stage::Logs { done, all } => {
            Some(format!("{done} of {all}"))
        }
        _ => None,
    }
}

impl Observer for Bar {
    fn progress(&mut self, progress: &Progress) -> Control {
        interrupt::something_to_keep();
        let same = |stage: &Stage| discriminant(stage) == discriminant(&progress.stage);
        let new = !self.stage.as_ref().is_some_and(same);
        if new {
            self.stage = Some(progress.stage);
            self.bar.reset();
            self.bar.set_prefix(progress.stage.name());
            self.first = (Instant::now(), progress.fraction);
        }
        self.bar.set_position((1000.0 * progress.fraction) as u64);
        if new {
            // What was done before says nothing of the time that is left.
            self.bar.reset_eta();
        }
        let (began, before) = self.first;
        let said = [message(progress), rate(progress, before, began.elapsed())];
        let said: Vec<String> = said.into_iter().flatten().collect();
        if !said.is_empty() {
            self.bar.set_message(said.join(", "));
        }
        if let Some(lines) = &mut self.lines {
            lines.tell(progress);
        }
        if interrupt::stops() {
            Control::Stop
        } else {
            Control::Continue
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Lines, left, line, rate};
    use std::time::Duration;
    use stiction_identify::{Progress, Stage};

    #[test]
    fn time_that_is_left_is_said_once_something_is_done() {
        let second = Duration::from_secs(1);
        assert_eq!(left(0, Duration::ZERO), "");
        assert_eq!(left(1, 45 * second), "left 45s");
        assert_eq!(left(999, Duration::ZERO), "left 0s");
    }

    #[test]
    fn lines_are_due_now_and_then_and_not_for_what_is_short() {
        let mut lines = Lines::default();
        let due = (0..60).filter(|s| lines.due(Duration::from_secs(*s)));
        assert_eq!(due.collect::<Vec<_>>(), [20, 40]);
    }

    #[test]
    fn a_rate_is_said_of_logs_in_words_that_fit_it() {
        let stage = Stage::Logs { done: 30, all: 120 };
        let said = |before, seconds| {
            rate(
                &Progress::of(stage, 0.25),
                before,
                Duration::from_secs(seconds),
            )
        };
        assert_eq!(said(0.0, 10).as_deref(), Some("3.0 logs/s"));
        assert_eq!(said(0.125, 10).as_deref(), Some("1.5 logs/s"));
        assert_eq!(said(0.0, 100).as_deref(), Some("18.0 logs/min"));
        assert_eq!(said(0.25, 0), None);
        let other = Stage::Experiments { done: 3, all: 12 };
        assert_eq!(
            rate(&Progress::of(other, 0.25), 0.0, Duration::from_secs(9)),
            None
        );
    }

    #[test]
    fn a_line_says_what_is_done_and_how_much_of_it() {
        let stage = Stage::Experiments { done: 3, all: 12 };
        let told = line(&Progress::of(stage, 0.25), Duration::from_secs(21));
        assert_eq!(told, "21 s: simulating, 25 %, 3 of 12");
    }
}
