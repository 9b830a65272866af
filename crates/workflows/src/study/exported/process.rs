//! The program of exported C, sample by sample through its pipes.

use std::io::{Read, Write};
#[cfg(unix)]
use std::os::unix::process::CommandExt;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use stiction_friction::compensator::{Input, Watch};
use tempfile::TempDir;

/// Name of the program in its folder.
pub(super) const PROGRAM: &str = "beside";

/// Settings that C has.
#[derive(Clone, Copy, Debug)]
pub(super) struct Settled {
    pub cycle_time: f64,
    pub gain: f64,
    pub dead_zone: f64,
    pub limit: f64,
    pub slew: f64,
    pub ramp: f64,
    pub window: f64,
    /// The key of its law.
    pub key: f64,
}

/// Longest time for one answer: the step of a compensator takes microseconds.
const LONGEST_ANSWER: Duration = Duration::from_secs(10);
/// How often that is looked at.
const LOOK: Duration = Duration::from_millis(50);

/// A running program; it ends with this.
pub(super) struct Process {
    state: Arc<State>,
    input: ChildStdin,
    output: ChildStdout,
}

/// What the thread that ends a program without an answer shares with the one that waits for it.
struct State {
    child: Mutex<Child>,
    /// Questions and answers so far: odd while an answer is awaited.
    turns: AtomicU64,
    /// Whether it was ended for its silence.
    silent: AtomicBool,
    /// Whether nobody waits any more.
    over: AtomicBool,
}

impl State {
    fn end(&self) {
        let mut child = self.child.lock().unwrap_or_else(PoisonError::into_inner);
        // It may have ended by itself.
        let _ = child.kill();
        let _ = child.wait();
    }

    /// Ends what the program has started as well: it holds its pipes, and an answer would be waited for without end.
    fn end_all(&self) {
        #[cfg(unix)]
        {
            let child = self.child.lock().unwrap_or_else(PoisonError::into_inner);
            let kill = format!("kill -KILL -{}", child.id());
            // The program is the first of its group. Where nothing is left in it, this does nothing.
            let _ = Command::new("sh")
                .args(["-c", &kill])
                .stderr(Stdio::null())
                .status();
        }
        self.end();
    }

    /// Ends the program when one answer takes too long.
    fn watch(&self) {
        let mut seen = (0, Instant::now());
        while !self.over.load(Ordering::Relaxed) {
            std::thread::sleep(LOOK);
            let turns = self.turns.load(Ordering::Relaxed);
            if turns != seen.0 || turns.is_multiple_of(2) {
                seen = (turns, Instant::now());
            } else if seen.1.elapsed() > LONGEST_ANSWER {
                self.silent.store(true, Ordering::Relaxed);
                self.end_all();
                return;
            }
        }
    }
}

impl Process {
    /// Starts it, with what its watchdog has learnt before; without that it is only asked for its settings.
    pub fn start(place: &TempDir, watch: Option<&Watch<f64>>) -> Result<(Self, Settled), String> {
        let mut program = Command::new(place.path().join(PROGRAM));
        program
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null());
        #[cfg(unix)]
        program.process_group(0);
        let mut child = program
            .spawn()
            .map_err(|e| format!("its program cannot be started ({e})"))?;
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err("its program has no pipes".into());
        };
        let state = Arc::new(State {
            child: Mutex::new(child),
            turns: AtomicU64::new(0),
            silent: AtomicBool::new(false),
            over: AtomicBool::new(false),
        });
        let mut process = Process {
            state: state.clone(),
            input,
            output,
        };
        std::thread::Builder::new()
            .spawn(move || state.watch())
            .map_err(|e| format!("its program cannot be watched ({e})"))?;
        let [
            ready,
            cycle_time,
            gain,
            dead_zone,
            limit,
            slew,
            ramp,
            window,
            ratio,
            key,
        ] = process.read()?;
        if ready != 0.0 && ready != 1.0 {
            return Err(
                "its program does not begin with its settings: does the C print something?".into(),
            );
        }
        if ready != 1.0 {
            return Err("its parameters are out of range: it would never give a force".into());
        }
        if ratio != 1.0 {
            return Err(format!(
                "a watchdog_ratio of {ratio}, where exported C has 1"
            ));
        }
        if let Some(watch) = watch {
            process.write(&[watch.without, watch.peak_without])?;
            if process.read::<1>()? != [1.0] {
                return Err("it does not take what its watchdog has learnt".into());
            }
        }
        let settled = Settled {
            cycle_time,
            gain,
            dead_zone,
            limit,
            slew,
            ramp,
            window,
            key,
        };
        Ok((process, settled))
    }

    /// The force of a sample, and whether the watchdog has switched off.
    pub fn step(&mut self, input: &Input<f64>) -> Result<(f64, bool), String> {
        let flag = |on: bool| f64::from(u8::from(on));
        self.write(&[
            input.reference_velocity,
            input.tracking_error,
            flag(input.enable),
            input.drive_force,
            flag(input.learn),
            input.reference_acceleration,
            input.position,
            input.load,
            input.temperature,
            input.transmitted,
        ])?;
        let [force, tripped] = self.read()?;
        Ok((force, tripped != 0.0))
    }

    fn write(&mut self, numbers: &[f64]) -> Result<(), String> {
        let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_ne_bytes()).collect();
        self.input
            .write_all(&bytes)
            .map_err(|e| format!("its program has ended ({e})"))
    }

    fn read<const N: usize>(&mut self) -> Result<[f64; N], String> {
        self.state.turns.fetch_add(1, Ordering::Relaxed);
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            let mut bytes = [0; 8];
            let read = self.output.read_exact(&mut bytes);
            read.map_err(|e| match self.state.silent.load(Ordering::Relaxed) {
                true => {
                    let longest = LONGEST_ANSWER.as_secs();
                    format!("its program gives no answer within {longest} s: it was ended")
                }
                false => format!("its program has ended ({e})"),
            })?;
            *number = f64::from_ne_bytes(bytes);
        }
        self.state.turns.fetch_add(1, Ordering::Relaxed);
        Ok(numbers)
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        self.state.over.store(true, Ordering::Relaxed);
        // It may be in an endless loop of its own.
        self.state.end();
    }
}
