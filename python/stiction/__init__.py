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
from ._fit import Covariance, Fit, Prediction
from ._frames import Rows, Series
from ._friction import Friction, FrictionCurve
from ._groups import Compensator, Draws, Procedures, Run, Search
from ._identify import identify
from ._law import Law
from ._library import Library, Machine, library
from ._log import Check, Finding, Log, allow_memory, check, read_log, write_demo_log, write_procedure_logs
from ._native import __version__
from ._parameters import Parameter, Parameters
from ._plan import Plan, plan
from ._record import Recorded, record
from ._robot import Joint, Robot, robot
from ._study import Study, simulate
from ._style import style
from ._types import (
    BandName,
    ColumnWidth,
    CostName,
    FeedforwardName,
    FormatName,
    FrameName,
    LawName,
    MethodName,
    PlannedLawName,
    Progress,
    SearchName,
    StageName,
    TargetName,
    Verdict,
    WidthName,
)

load = Fit.load
"""Reads the folder of a fit: `Fit.load`."""

__all__ = [
    "BandName",
    "Check",
    "ColumnWidth",
    "Compensator",
    "CostName",
    "Course",
    "Covariance",
    "Draws",
    "Drift",
    "Exported",
    "FeedforwardName",
    "Finding",
    "Fit",
    "FormatName",
    "FrameName",
    "Friction",
    "FrictionCurve",
    "Joint",
    "Law",
    "LawName",
    "Library",
    "Log",
    "Machine",
    "MethodName",
    "Parameter",
    "Parameters",
    "Plan",
    "PlannedLawName",
    "Prediction",
    "Procedures",
    "Progress",
    "Recorded",
    "Robot",
    "Rows",
    "Run",
    "Search",
    "SearchName",
    "Series",
    "StageName",
    "StictionError",
    "StictionWarning",
    "Study",
    "TargetName",
    "Verdict",
    "WidthName",
    "__version__",
    "allow_memory",
    "check",
    "drift",
    "export",
    "identify",
    "library",
    "load",
    "plan",
    "read_log",
    "record",
    "robot",
    "simulate",
    "style",
    "write_demo_log",
    "write_procedure_logs",
]
