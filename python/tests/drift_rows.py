"""Rows of a fleet over time for the tests: scatter, and one machine whose friction steps up."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy
from stiction import _native

MACHINES = 6
LOGS = 40
STEPS = "m3"
"""The machine whose Coulomb friction steps up by a quarter with log 25."""
DAY = 86_400.0


def rows() -> list[dict[str, Any]]:
    """What `identify_uri` gives of the logs, machine by machine."""
    dice = numpy.random.default_rng(7)
    out = []
    for machine in range(MACHINES):
        name = f"m{machine}"
        for k in range(LOGS):
            warm = float(20.0 + 3.0 * dice.standard_normal())
            level = 20.0 * (1.0 - 0.005 * (warm - 20.0)) * (1.25 if name == STEPS and k >= 25 else 1.0)
            value = float(level * (1.0 + 0.01 * dice.standard_normal()))
            out.append(row(name, k, warm, value))
    return out


def row(machine: str, k: int, temperature: float, coulomb: float) -> dict[str, Any]:
    """One log."""
    return {
        "path": f"{machine}/{k:03}.csv",
        "sha256": "0" * 64,
        "machine": machine,
        "time": 1.7e9 + DAY * k,
        "temperature": temperature,
        "axis": "axis.toml",
        "law": "coulomb-viscous",
        "asymmetric": False,
        "method": "separable",
        "trustworthy": True,
        "relative_error_percent": 1.0,
        "samples": 1000,
        "warnings": [],
        "error": None,
        "message": None,
        "report": None,
        "version": "0",
        "seed": 0,
        "key": f"{machine}-{k}",
        "parameters": [
            {
                "parameter": "coulomb",
                "value": coulomb,
                "unit": "N",
                "std": 0.1,
                "low": coulomb - 0.2,
                "high": coulomb + 0.2,
                "identifiable": True,
                "origin": "identified",
            }
        ],
    }


def table(path: Path) -> Path:
    """The same as a table."""
    _native.write_rows(str(path), [json.dumps(each) for each in rows()])
    return path


def columns() -> dict[str, list[Any]]:
    """The same as columns."""
    flat = [{**{key: each[key] for key in each if key != "parameters"}, **p} for each in rows() for p in each["parameters"]]
    for each in flat:
        each |= {"warnings": "", "schema": "stiction.batch/1"}
    return {key: [each[key] for each in flat] for key in flat[0]}
