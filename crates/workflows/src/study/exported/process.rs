//! The program of exported C, sample by sample through its pipes.

use std::io::{Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
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

/// A running program; it ends with this.
pub(super) struct Process {
    child: Child,
    input: ChildStdin,
    output: ChildStdout,
}

impl Process {
    /// Starts it, with what its watchdog has learnt before; without that it is only asked for its settings.
    pub fn start(place: &TempDir, watch: Option<&Watch<f64>>) -> Result<(Self, Settled), String> {
        let mut child = Command::new(place.path().join(PROGRAM))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .map_err(|e| format!("its program cannot be started ({e})"))?;
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err("its program has no pipes".into());
        };
        let mut process = Process {
            child,
            input,
            output,
        };
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
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            let mut bytes = [0; 8];
            self.output
                .read_exact(&mut bytes)
                .map_err(|e| format!("its program has ended ({e})"))?;
            *number = f64::from_ne_bytes(bytes);
        }
        Ok(numbers)
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // It may be in an endless loop of its own.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
