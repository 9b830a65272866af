//! Samples of a device into a log, read-only.

use crate::error::raised;
use crate::run::{How, Stopped, run};
use pyo3::prelude::*;
use std::path::PathBuf;
use stiction_identify::{Control, Observer, Progress, Stage};
use stiction_record::{Device, End, Options, Recorded};
use stiction_workflows::Error;

/// Numbers of a recording with their names, and why the device was lost: code and message.
type Told = (
    Option<PathBuf>,
    Vec<(&'static str, f64)>,
    bool,
    Option<(String, String)>,
);

/// Records until the time is over, or Ctrl-C or the device ends it: path, numbers, whether the time is over, what went wrong.
#[pyfunction]
pub fn record(
    py: Python<'_>,
    device: Vec<String>,
    out: PathBuf,
    rate: Option<f64>,
    time: Option<f64>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Told> {
    let how = How {
        progress,
        threads: None,
        stopped: Stopped::Keeps,
    };
    let (recorded, _) = run(py, &how, |watch| -> Result<Recorded, Error> {
        let mut source = Device::parse(&device)?.source(rate)?;
        let options = Options {
            time: time.unwrap_or(f64::INFINITY),
            ..Options::default()
        };
        let goes_on =
            &mut |part| watch.progress(&Progress::of(Stage::Recording, part)) == Control::Continue;
        let recorded = stiction_record::record(&mut *source, &out, &options, goes_on);
        Ok(recorded?)
    })?;
    let recorded = recorded.map_err(|e| raised(py, &e))?;
    let numbers = vec![
        ("samples", recorded.rows as f64),
        ("seconds", recorded.span),
        ("rate_hz", recorded.rate),
        ("lost", recorded.lost as f64),
        ("gaps", recorded.gaps as f64),
        ("reconnects", recorded.reconnects as f64),
        ("repeated", recorded.repeated as f64),
        ("incomplete", recorded.incomplete as f64),
        ("unwritten", recorded.unwritten as f64),
    ];
    let complete = matches!(recorded.end, End::Complete);
    let fault = match &recorded.end {
        End::Failed(e) => Some((e.code().to_string(), e.to_string())),
        End::Complete | End::Stopped => None,
    };
    Ok((recorded.path, numbers, complete, fault))
}
