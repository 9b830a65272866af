//! stiction beside the searches of Python, on the same logs.

use crate::python::{self, Environment};
use crate::shell::{self, Outcome};

const ENVIRONMENT: Environment = Environment {
    folder: "target/peers/venv",
    requirements: "bench/peers/requirements.txt",
    probe: "import cma, deap, numba, pymoo, scipy",
};

/// Runs the peers and rewrites their part of `docs/performance.md`.
pub fn run() -> Outcome {
    let python = python::make(&ENVIRONMENT)?;
    shell::run(shell::command(&python, &["bench/peers/compare.py"]))
}
