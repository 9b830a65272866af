"""Friction of servo axes: from a drive's log to a law with intervals, and on to its compensation.

>>> import stiction
>>> log = stiction.read_log("run.csv")                     # doctest: +SKIP
>>> fit = stiction.identify(log)                           # doctest: +SKIP
>>> fit.parameters["coulomb"].value                        # doctest: +SKIP

The command line `stiction` in Python: the same names, defaults and bits. Guide: docs/python.md.
"""

from ._drift import Course, Drift, drift
from ._errors import StictionError, StictionWarning
from ._export import Exported, export
from ._fit import Covariance, Fit, Friction, Prediction
from ._identify import identify
from ._law import Law
from ._log import Check, Finding, Log, allow_memory, check, read_log, write_demo_log, write_procedure_logs
from ._native import __version__
from ._parameters import Parameter, Parameters
from ._plan import Plan, plan
from ._robot import Joint, Robot, robot
from ._study import Study, simulate
from ._types import Progress

load = Fit.load
"""Reads the folder of a fit: `Fit.load`."""

__all__ = [
    "Check",
    "Course",
    "Covariance",
    "Drift",
    "Exported",
    "Finding",
    "Fit",
    "Friction",
    "Joint",
    "Law",
    "Log",
    "Parameter",
    "Parameters",
    "Plan",
    "Prediction",
    "Progress",
    "Robot",
    "StictionError",
    "StictionWarning",
    "Study",
    "__version__",
    "allow_memory",
    "check",
    "drift",
    "export",
    "identify",
    "load",
    "plan",
    "read_log",
    "robot",
    "simulate",
    "write_demo_log",
    "write_procedure_logs",
]
