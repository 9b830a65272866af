//! A recording from its first sample to its last.

use crate::error::{Error, Fault};
use crate::log_file::LogFile;
use crate::pace::{Pace, Step};
use crate::source::Source;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// How long is recorded, and waited.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Time to record, s of the device, above 0.
    pub time: f64,
    /// Time without a sample after which the connection is made anew.
    pub stall: Duration,
    /// Time without a sample after which the recording ends.
    pub patience: Duration,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            time: f64::INFINITY,
            stall: Duration::from_secs(5),
            patience: Duration::from_secs(30),
        }
    }
}

/// Why a recording ended.
#[derive(Debug)]
pub enum End {
    /// The time is over.
    Complete,
    /// The caller wanted no more.
    Stopped,
    /// The device was lost and did not come back, or no more can be written.
    Failed(Error),
}

/// What was recorded.
#[derive(Debug)]
#[non_exhaustive]
pub struct Recorded {
    /// The log; `None` where there is no sample.
    pub path: Option<PathBuf>,
    /// Samples in it.
    pub rows: u64,
    /// Time from the first to the last sample, s.
    pub span: f64,
    /// Rate that the device has, Hz; 0 where there are too few samples to tell.
    pub rate: f64,
    /// Rate that was asked for, Hz.
    pub asked: f64,
    /// Gaps between time stamps.
    pub gaps: u64,
    /// Samples that are missing in the gaps.
    pub lost: u64,
    /// Connections that were made anew.
    pub reconnects: u64,
    /// Samples that were left out because their time stamp was there already.
    pub repeated: u64,
    /// Samples that were left out because a column was missing.
    pub incomplete: u64,
    /// Samples that came and could not be written.
    pub unwritten: u64,
    /// Why it ended.
    pub end: End,
}

/// Time between two looks at what the caller wants.
const LOOK: Duration = Duration::from_millis(100);
/// Time between two attempts to connect.
const ATTEMPT: Duration = Duration::from_millis(500);

/// Records from a source into a new file, `.csv` or `.parquet`. `observe` is told which part is done, 0 to 1, several times a
/// second, and ends the recording where it returns `false`.
///
/// # Errors
/// Where the time is none, the file cannot be begun or the device gives no first sample. What goes wrong later is an [`End`], and the log is kept.
pub fn record(
    source: &mut dyn Source,
    out: &Path,
    options: &Options,
    observe: &mut dyn FnMut(f64) -> bool,
) -> Result<Recorded, Error> {
    // Also where it is no number.
    if options.time.is_nan() || options.time <= 0.0 {
        let found = format!("a time of {} s to record", options.time);
        return Err(Error::usage(found, "a time above 0, such as 30 s"));
    }
    let mut log = LogFile::new(out, source.columns())?;
    let mut pace = Pace::new(source.rate());
    let (mut reconnects, mut repeated, mut taken) = (0, 0, 0);
    let half = 0.5 / source.rate();
    source.connect()?;
    let mut heard = Instant::now();
    // When the connection was made, or a sample came after that.
    let mut alive = heard;
    let mut connected = true;
    let mut samples = Vec::new();
    let end = loop {
        if !observe((pace.span() / options.time).clamp(0.0, 1.0)) {
            break End::Stopped;
        }
        let mut fault = None;
        if connected {
            samples.clear();
            fault = source.next(LOOK, &mut samples).err();
            if !samples.is_empty() {
                heard = Instant::now();
                alive = heard;
            } else if fault.is_none() && alive.elapsed() > options.stall {
                let what = "is connected and sends no samples; does its program run?";
                fault = Some(Error::device(source.address(), Fault::Silent, what));
            }
        }
        let mut over = None;
        for sample in &samples {
            if pace.since_first(sample.time) > options.time + half {
                over = Some(End::Complete);
                break;
            }
            match pace.add(sample.time) {
                Step::Later => {}
                Step::Repeated => {
                    repeated += 1;
                    continue;
                }
                Step::Back => {
                    let what = "its clock was set back, as by a restart";
                    let e = Error::device(source.address(), Fault::Restarted, what);
                    over = Some(End::Failed(e));
                    break;
                }
            }
            taken += 1;
            if let Err(e) = log.add(sample) {
                over = Some(End::Failed(e));
                break;
            }
        }
        samples.clear();
        if over.is_none() && pace.span() >= options.time - half && taken > 0 {
            over = Some(End::Complete);
        }
        if let Some(end) = over {
            break end;
        }
        // Nothing waits for a device that is slow to come back.
        if heard.elapsed() > LOOK
            && let Err(e) = log.flush()
        {
            break End::Failed(e);
        }
        if let Some(e) = fault {
            // Before the first sample there is nothing to lose, and a refusal stays one.
            if taken == 0 {
                source.close();
                return Err(e);
            }
            connected = false;
        }
        if !connected {
            match source.connect() {
                Ok(()) => {
                    connected = true;
                    alive = Instant::now();
                    reconnects += 1;
                }
                Err(e) if heard.elapsed() > options.patience => break End::Failed(e),
                Err(_) => std::thread::sleep(ATTEMPT),
            }
        } else if heard.elapsed() > options.patience {
            let what = "is connected again and sends no samples";
            break End::Failed(Error::device(source.address(), Fault::Silent, what));
        }
    };
    source.close();
    let incomplete = source.incomplete();
    let found = pace.found();
    let flushed = log.flush();
    let (rows, span) = (log.rows(), log.span());
    let (path, fault) = log.finish();
    let end = match (end, flushed.err().or(fault)) {
        (End::Failed(e), _) => End::Failed(e),
        (_, Some(e)) => End::Failed(e),
        (end, None) => end,
    };
    Ok(Recorded {
        path,
        rows,
        span,
        rate: found.rate,
        asked: source.rate(),
        gaps: found.gaps,
        lost: found.lost,
        reconnects,
        repeated,
        incomplete,
        unwritten: taken - rows,
        end,
    })
}
