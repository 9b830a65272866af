//! The native half of the Python package `stiction`: arrays and options go in, outcomes of the library come out.
//!
//! Nothing is computed here. The other half, `python/stiction`, has what users call; it is described there and held by the
//! stub `_native.pyi`. While Rust works the interpreter is free: see `run`.

mod axis;
mod command;
mod drift;
mod error;
mod export;
mod fit;
mod fleet;
mod law;
mod library;
mod log;
mod motion;
mod next;
mod options;
mod record;
mod robot;
mod run;
mod study;

/// The module `stiction._native`.
///
/// It needs no lock of the interpreter: every class is frozen and shares nothing that changes but a law its state, which has a
/// lock of its own; what is static is set once or atomic.
#[pyo3::pymodule(gil_used = false)]
mod _native {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::axis::Axis;
    #[pymodule_export]
    use crate::command::command;
    #[pymodule_export]
    use crate::drift::{Drift, drift, drift_of_columns, drift_of_rows};
    #[pymodule_export]
    use crate::export::export;
    #[pymodule_export]
    use crate::fit::{Fit, friction_at, identify, identify_files};
    #[pymodule_export]
    use crate::fleet::{
        find_logs, identify_row, keep_rows, read_rows, seconds_of, unread_row, write_rows,
    };
    #[pymodule_export]
    use crate::law::Law;
    #[pymodule_export]
    use crate::library::{library, machine_files, write_machine};
    #[pymodule_export]
    use crate::log::{Log, allow_memory, check, check_files, write_demo_log, write_procedure_logs};
    #[pymodule_export]
    use crate::motion::{Plan, plan};
    #[pymodule_export]
    use crate::options::choices;
    #[pymodule_export]
    use crate::record::record;
    #[pymodule_export]
    use crate::robot::{Robot, robot};
    #[pymodule_export]
    use crate::study::{Study, simulate};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
