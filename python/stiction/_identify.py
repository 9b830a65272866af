"""Logs to a law."""

from __future__ import annotations

from . import _native
from ._axis import AXIS, path_of, paths_of, some_path
from ._errors import argument
from ._fit import Fit
from ._groups import Procedures, Run, Search, group
from ._log import Logs, _warn, all_paths, one_axis, read_all, several, some_paths
from ._options import choice, maybe, some_threads, truth, whole
from ._progress import finish, teller
from ._study import STOPPED
from ._types import AxisLike, IdentifyOptions, LawName, MethodName


def identify(
    logs: Logs | None = None,
    axis: AxisLike = None,
    *,
    law: LawName = "auto",
    asymmetric: bool = False,
    method: MethodName = "separable",
    validate: Logs | None = None,
    split: float | None = None,
    procedures: Procedures = Procedures(),
    search: Search = Search(),
    run: Run = Run(),
) -> Fit:
    """Identifies the friction of an axis from its logs, as `stiction identify`: the same defaults and bits.

    logs: one log or several of one axis, fitted together: paths, columns in memory, or what `read_log` read; those under
        [[log]] of the axis file if there are none.
    axis: what is known of the axis: path of an axis file or its keys in a dict. Logs that were read have theirs.
    law: `auto` lets the data choose. asymmetric: parameters of its own for each direction of motion.
    method: how the parameters are found (docs/procedures.md, docs/searches.md).
    validate: logs to validate on, which are not fitted. split: or the share of the samples that is fitted, 0 to 1.
    procedures: recordings and files beside the logs. search: settings of a search. run: seed, threads, progress.

    The interpreter is free while Rust works. Ctrl-C stops the search and keeps the best: the fit is returned with the verdict
    `interrupted` and a warning; a second one raises KeyboardInterrupt. What to beware of is a StictionWarning with its code, what
    cannot be identified a StictionError.
    """
    procedures, search, run = group(procedures, Procedures, "procedures"), group(search, Search, "search"), group(run, Run, "run")
    options: IdentifyOptions = {
        "law": choice(law, "law"),
        "asymmetric": truth(asymmetric, "asymmetric"),
        "compare_laws": truth(run.compare_laws, "run.compare_laws"),
        "split": maybe(split, "split"),
        "seed": whole(run.seed, "run.seed"),
        "method": choice(method, "method"),
        "statics": paths_of(procedures.statics, "procedures.statics"),
        "model": some_path(procedures.model, "procedures.model"),
        "break_away": paths_of(procedures.break_away, "procedures.break_away"),
        "plan": some_path(procedures.plan, "procedures.plan"),
        "search": None if search.name is None else choice(search.name, "search.name", "search"),
        "no_finish": truth(search.no_finish, "search.no_finish"),
        "cost": None if search.cost is None else choice(search.cost, "search.cost"),
        "evaluations": None if search.evaluations is None else whole(search.evaluations, "search.evaluations"),
        "target": maybe(search.target, "search.target"),
        "time": maybe(search.time, "search.time"),
        "checkpoint": some_path(search.checkpoint, "search.checkpoint"),
        "resume": some_path(search.resume, "search.resume"),
    }
    if split is not None and validate is not None:
        raise argument("split", "split together with validate", "one of the two")
    each = [] if logs is None else several(logs, "logs")
    held_out = [] if validate is None else several(validate, "validate")
    tell, own = teller(run.progress), some_threads(run.threads)
    try:
        if all_paths(each + held_out) and not isinstance(axis, dict):
            if not each and axis is None and not options["break_away"]:
                raise argument("logs", "no log", "at least one log, here or under [[log]] of the axis file")
            native, stopped = _native.identify_files(
                some_paths(each, "logs"),
                some_paths(held_out, "validate"),
                None if axis is None else path_of(axis, "axis", AXIS),
                options,
                tell,
                own,
            )
        else:
            if not each:
                raise argument("logs", "no log", "at least one log")
            fitted = read_all(each, axis, "logs")
            axis = fitted[0]._origin[1]
            unseen = read_all(held_out, axis, "validate")
            native, stopped = _native.identify(
                [log._native for log in fitted],
                [log._native for log in unseen],
                one_axis(fitted + unseen),
                options,
                tell,
                own,
            )
    finally:
        finish(run.progress)
    fit = Fit(native, axis=axis)
    told = fit.warnings
    if stopped and all(code != STOPPED[0] for code, _ in told):
        told = [*told, STOPPED]
    _warn(told, 2)
    return fit
