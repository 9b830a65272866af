//! `stiction record`: samples of a device into a log, read-only.

use crate::arguments::{self, Common};
use crate::exit::Exit;
use crate::output;
use crate::progress::Bar;
use std::io::Write;
use stiction_identify::{Control, Observer, Progress, Stage};
use stiction_record::{Device, End, Options, record};
use stiction_workflows::Error;

/// Records until the time is over, or the user or the device ends it.
pub fn run(typed: &arguments::Record, common: &Common) -> Result<Exit, Error> {
    let device = Device::parse(&typed.device)?;
    let mut source = device.clone().source(typed.rate)?;
    let options = Options {
        time: typed.time.unwrap_or(f64::INFINITY),
        ..Options::default()
    };
    let mut bar = Bar::new(common.json || common.quiet);
    let recorded = record(&mut *source, &typed.out, &options, &mut |part| {
        bar.progress(&Progress::of(Stage::Recording, part)) == Control::Continue
    });
    bar.finish();
    let recorded = recorded?;
    let fault = match &recorded.end {
        End::Failed(e) => Some(e),
        End::Complete | End::Stopped => None,
    };
    if let Some(e) = fault {
        // With standard error closed only the exit code is left to tell.
        let line = output::line(&e.to_string());
        let _ = writeln!(std::io::stderr(), "stiction: [{}] {line}", e.code());
    }
    if common.json {
        output::json(&serde_json::json!({
            "written": recorded.path.as_ref().map(|path| path.to_string_lossy()),
            "samples": recorded.rows,
            "seconds": recorded.span,
            "rate_hz": recorded.rate,
            "lost": recorded.lost,
            "gaps": recorded.gaps,
            "reconnects": recorded.reconnects,
            "repeated": recorded.repeated,
            "incomplete": recorded.incomplete,
            "unwritten": recorded.unwritten,
            "complete": matches!(recorded.end, End::Complete),
            "fault": fault.map(|e| serde_json::json!({ "code": e.code(), "message": e.to_string() })),
        }))?;
    } else if !common.quiet {
        output::print(&stiction_pages::text::recorded(&recorded, &device))?;
    }
    Ok(match recorded.end {
        End::Complete => Exit::Done,
        End::Stopped => Exit::Interrupted,
        End::Failed(_) => Exit::NotTrustworthy,
    })
}
