"""The compensator as an FMU, over one period of a triangle of the position, 10 mm/s each way.

    stiction export examples/export/model.toml --target fmu --out fmu
    python examples/export/fmu/simulate.py fmu
"""

import sys
from pathlib import Path
import numpy as np
from fmpy import simulate_fmu

path = next(Path(sys.argv[1]).glob("*_fmi3.fmu"))
time = np.arange(0.0, 2.0, 1e-3)
velocity = np.where(time < 1.0, 0.010, -0.010)
signals = np.array(
    list(zip(time, velocity, np.ones(len(time), dtype=bool))),
    dtype=[("time", float), ("reference_velocity", float), ("enable", bool)],
)
# The watchdog is off for this example only: it would let the axis move without compensation first.
result = simulate_fmu(
    str(path),
    stop_time=2.0,
    step_size=1e-3,
    output_interval=1e-3,
    start_values={"gain": 0.5, "watchdog_window": 0.0},
    input=signals,
    output=["force", "deflection"],
)
there, back = result["force"][990], result["force"][1990]
print(f"{there:.2f} N at 10 mm/s, {back:.2f} N at -10 mm/s")
