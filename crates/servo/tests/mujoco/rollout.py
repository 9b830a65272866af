"""A mass with the LuGre friction of MuJoCo's dcmotor under a force held for a millisecond at a time.

rollout.py STEPS MILLISECONDS MASS SIGMA0 SIGMA1 SIGMA2 FC FS VS AMPLITUDE FREQUENCY: with so many steps a millisecond; prints
position (m) and velocity (m/s) at the end of each.
"""

import math
import sys

import mujoco

steps, milliseconds = int(sys.argv[1]), int(sys.argv[2])
mass, s0, s1, s2, fc, fs, vs, amplitude, frequency = map(float, sys.argv[3:])
# A motor constant and a resistance that leave no counter-voltage; the force of the drive is another actuator.
model = mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <option timestep="{1e-3 / steps!r}" gravity="0 0 0"/>
  <worldbody>
    <body>
      <inertial pos="0 0 0" mass="{mass!r}" diaginertia="1 1 1"/>
      <joint name="axis" type="slide" axis="1 0 0" damping="{s2!r}"/>
    </body>
  </worldbody>
  <actuator>
    <dcmotor joint="axis" motorconst="1" resistance="1e12" lugre="{s0!r} {s1!r} {fc!r} {fs!r} {vs!r}"/>
    <motor name="drive" joint="axis"/>
  </actuator>
</mujoco>
""")
data = mujoco.MjData(model)
drive = model.actuator("drive").id
for k in range(milliseconds):
    data.ctrl[drive] = amplitude * math.sin(2 * math.pi * frequency * 1e-3 * k)
    for _ in range(steps):
        mujoco.mj_step(model, data)
    print(repr(float(data.qpos[0])), repr(float(data.qvel[0])))
