"""The identified friction in MuJoCo: a push below the static friction holds, one above it moves.

    stiction export examples/export/model.toml --target mujoco --out sim
    python examples/export/mujoco/push.py sim
"""

import sys
from pathlib import Path
import mujoco

model = mujoco.MjModel.from_xml_path(str(next(Path(sys.argv[1]).glob("*_friction.xml"))))
model.opt.timestep = 1e-4
for push in (15.0, 20.0):
    data = mujoco.MjData(model)
    data.actuator(model.nu - 1).ctrl[0] = push
    for _ in range(5000):
        mujoco.mj_step(model, data)
    speed = data.qvel[0]
    print(f"{push:.0f} N: {'moves' if abs(speed) > 0.1 else 'holds'}")
