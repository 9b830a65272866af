//! Logs made on the spot, each in its own folder.
#![allow(dead_code)]

pub mod identified;
pub mod kept;

use std::fmt::Write;
use std::ops::{Deref, DerefMut};
use std::path::{Path, PathBuf};
use stiction_identify::{Observer, Progress, Stage};
use stiction_parameters::LawKind;
use stiction_workflows::Error;
use stiction_workflows::identify::Options;
use stiction_workflows::identify::{Files, Outcome};
use tempfile::TempDir;

/// Sample rate of every log here, Hz.
pub const RATE: f64 = 1000.0;

/// A cheap deterministic sequence, uniform in -1..1.
pub fn noise(seed: u64, i: usize) -> f64 {
    let mut x = (seed.wrapping_mul(0xD134_2543_DE82_EF95) ^ i as u64)
        .wrapping_add(0x632B_E59B_D9B4_E019)
        .wrapping_mul(0x9E37_79B9_7F4A_7C15);
    x ^= x >> 29;
    x = x.wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x ^= x >> 32;
    (x >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// Both directions, reversals of several depths, speeds up to .5 m/s.
pub fn both_ways(t: f64) -> [f64; 3] {
    let mut out = [0.0; 3];
    for (a, w) in [(0.05, 6.3), (0.008, 22.0)] {
        out[0] += a * (w * t).sin();
        out[1] += a * w * (w * t).cos();
        out[2] -= a * w * w * (w * t).sin();
    }
    out
}

/// Force of an axis of 9 kg with 20 N of Coulomb and 60 N s/m of viscous friction, 1 N offset.
pub fn friction([_, v, a]: [f64; 3]) -> f64 {
    20.0 * f64::from(i8::from(v > 0.0) - i8::from(v < 0.0)) + 60.0 * v + 9.0 * a + 1.0
}

/// How many experiments of how many are done.
pub fn counted(progress: &Progress) -> (usize, usize) {
    match progress.stage {
        Stage::Experiments { done, all } => (done, all),
        stage => panic!("{stage:?} is not counted"),
    }
}

/// A folder with logs.
pub struct Bench(TempDir);

impl Bench {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn dir(&self) -> &Path {
        self.0.path()
    }

    /// Writes text to a file.
    pub fn write(&self, name: &str, text: &str) -> PathBuf {
        std::fs::write(self.path(name), text).unwrap();
        self.path(name)
    }

    /// A log of `n` samples: what moves, and what pushes (N) at each sample.
    pub fn log(
        &self,
        name: &str,
        n: usize,
        motion: impl Fn(f64) -> f64,
        force: impl Fn(usize, f64) -> f64,
    ) -> PathBuf {
        let mut text = String::from("Time [s],Position [mm],Force [N]\n");
        for i in 0..n {
            let t = i as f64 / RATE;
            let _ = writeln!(text, "{t:.4},{:.6},{:.4}", 1e3 * motion(t), force(i, t));
        }
        self.write(name, &text)
    }

    /// A log that tells all.
    pub fn good(&self, name: &str, seed: u64) -> PathBuf {
        self.log(
            name,
            6000,
            |t| both_ways(t)[0],
            |i, t| friction(both_ways(t)) + 0.5 * noise(seed, i),
        )
    }

    /// A message without the folder, which differs from run to run.
    pub fn plain(&self, message: &str) -> String {
        message.replace(&format!("{}/", self.dir().display()), "")
    }
}

/// An identification from files.
#[derive(Clone)]
pub struct Asked {
    pub files: Files,
    pub options: Options,
}

impl Asked {
    pub fn identify(&self, observer: &mut dyn Observer) -> Result<Outcome, Error> {
        stiction_workflows::identify::identify(&self.files, &self.options, observer)
    }

    /// The same but for a change.
    pub fn but(mut self, change: impl FnOnce(&mut Self)) -> Self {
        change(&mut self);
        self
    }
}

impl Deref for Asked {
    type Target = Options;

    fn deref(&self) -> &Options {
        &self.options
    }
}

impl DerefMut for Asked {
    fn deref_mut(&mut self) -> &mut Options {
        &mut self.options
    }
}

/// A law of some logs, compared with no others.
pub fn options(logs: &[&Path], law: LawKind) -> Asked {
    let files = Files {
        logs: logs.iter().map(|p| p.to_path_buf()).collect(),
        ..Files::default()
    };
    let mut options = Options::default();
    (options.law, options.compare_laws) = (Some(law), false);
    Asked { files, options }
}
