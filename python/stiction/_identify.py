"""Logs to a law."""

from __future__ import annotations

from collections.abc import Sequence

from . import _native
from ._axis import AXIS, path_of, paths_of
from ._errors import argument
from ._fit import Fit
from ._log import Logs, _warn, all_paths, one_axis, read_all, several, some_paths
from ._options import choice, maybe, some_threads, truth, whole
from ._progress import finish, teller
from ._study import STOPPED
from ._types import AxisLike, IdentifyOptions, PathLike, Watcher


def identify(
    logs: Logs | None = None,
    axis: AxisLike = None,
    *,
    law: str = "auto",
    asymmetric: bool = False,
    method: str = "separable",
    validate: Logs | None = None,
    split: float | None = None,
    seed: int = 0,
    compare_laws: bool = True,
    statics: PathLike | Sequence[PathLike] = (),
    model: PathLike | None = None,
    break_away: PathLike | Sequence[PathLike] = (),
    plan: PathLike | None = None,
    search: str | None = None,
    no_finish: bool = False,
    cost: str | None = None,
    evaluations: int | None = None,
    target: float | None = None,
    time: float | None = None,
    checkpoint: PathLike | None = None,
    resume: PathLike | None = None,
    progress: Watcher = None,
    threads: int | None = None,
) -> Fit:
    """Identifies the friction of an axis from its logs, as `stiction identify`: the same options, defaults and bits.

    logs: one log or several of one axis, fitted together: paths, columns in memory, or what `read_log` read; those under
        [[log]] of the axis file if there are none.
    axis: what is known of the axis: path of an axis file or its keys in a dict. Logs that were read have theirs.
    law: `auto` lets the data choose; `coulomb-viscous`, `stribeck`, `dahl`, `lugre`, `elasto-plastic`, `maxwell-slip`, `gms`.
    asymmetric: parameters of its own for each direction of motion.
    method: how the parameters are found: `separable`, `static`, `static-then-dynamic`, `presliding-step`, `output-error`, or
        a search (`ga`, `adaptive-ga`, `annealing-ga`, `niched-ga`, `de`, `cma-es`, `pso`, `annealing`, `nelder-mead`, `lm`).
    validate: logs to validate on, which are not fitted. split: or the share of the samples that is fitted, 0 to 1.
    seed: seed of the search. compare_laws: whether simpler laws are fitted beside one that is named.
    statics: logs of constant velocities (`--static`). model: a model file for what is not identified here.
    break_away: logs of force ramps. plan: the plan.toml that a log was recorded by.
    search, no_finish, cost, evaluations, target, time, checkpoint, resume: of the searches, see docs/searches.md.
    progress: True for a line on standard error, or a function that is given a `Progress` now and then; where it returns False
        the work stops. threads: threads of this call alone; those of the process if it is not given. No result depends on it.

    The interpreter is free while Rust works. Ctrl-C stops the search and keeps the best: the fit is returned with the verdict
    `interrupted` and a warning; a second one raises KeyboardInterrupt. What to beware of is a StictionWarning with its code, what
    cannot be identified a StictionError.
    """
    options: IdentifyOptions = {
        "law": choice(law, "law"),
        "asymmetric": truth(asymmetric, "asymmetric"),
        "compare_laws": truth(compare_laws, "compare_laws"),
        "split": maybe(split, "split"),
        "seed": whole(seed, "seed"),
        "method": choice(method, "method"),
        "statics": paths_of(statics, "statics"),
        "model": None if model is None else path_of(model, "model"),
        "break_away": paths_of(break_away, "break_away"),
        "plan": None if plan is None else path_of(plan, "plan"),
        "search": None if search is None else str(search),
        "no_finish": truth(no_finish, "no_finish"),
        "cost": None if cost is None else str(cost),
        "evaluations": None if evaluations is None else whole(evaluations, "evaluations"),
        "target": maybe(target, "target"),
        "time": maybe(time, "time"),
        "checkpoint": None if checkpoint is None else path_of(checkpoint, "checkpoint"),
        "resume": None if resume is None else path_of(resume, "resume"),
    }
    if split is not None and validate is not None:
        raise argument("split", "split together with validate", "one of the two")
    each = [] if logs is None else several(logs, "logs")
    held_out = [] if validate is None else several(validate, "validate")
    tell, own = teller(progress), some_threads(threads)
    try:
        if all_paths(each + held_out) and not isinstance(axis, dict):
            if not each and axis is None and not break_away:
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
        finish(progress)
    fit = Fit(native, axis=axis)
    told = fit.warnings
    if stopped and all(code != STOPPED[0] for code, _ in told):
        told = [*told, STOPPED]
    _warn(told, 2)
    return fit
