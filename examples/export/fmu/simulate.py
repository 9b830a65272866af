"""The compensator as an FMU, over a triangle of the position, 10 mm/s each way.

    stiction export examples/export/model.toml --target fmu --out fmu
    python examples/export/fmu/simulate.py fmu

Nothing is added for the first 11 s: the watchdog learns the error without compensation over five cycles of the motion. On a
machine enable is: drive in operation, homed, no stop, brake open.
"""

import sys
from pathlib import Path
import numpy as np
from fmpy import simulate_fmu

path = next(Path(sys.argv[1]).glob("*_fmi3.fmu"))
time = np.arange(0.0, 14.0, 1e-3)
velocity = np.where(np.arange(len(time)) % 2000 < 1000, 0.010, -0.010)
signals = np.array(
    list(zip(time, velocity, np.ones(len(time), dtype=bool))),
    dtype=[("time", float), ("reference_velocity", float), ("enable", bool)],
)
result = simulate_fmu(
    str(path),
    stop_time=14.0,
    step_size=1e-3,
    output_interval=1e-3,
    start_values={"gain": 0.5, "watchdog_window": 1.9},
    input=signals,
    output=["force", "deflection"],
)
there, back = result["force"][12990], result["force"][13990]
print(f"{there:.2f} N at 10 mm/s, {back:.2f} N at -10 mm/s")
