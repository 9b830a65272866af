"""Friction of the models beside this file by BAM, Better Actuator Models 1.0.2 of PyPI (needs Python 3.12):

    python evaluate.py > friction.txt

Rows: model, torque that the gear transmits, speed, frictionloss, damping. The motor has that torque, and what is outside its opposite.
For m5 also the balance with friction, the motor driving (+) or the load (-): frictionloss + damping |v| there.
"""
import os
from bam.model import load_model

HERE = os.path.dirname(os.path.abspath(__file__))
TORQUES = [0.0, 0.5, 2.0, 10.0, 40.0]
SPEEDS = [0.0, 0.01, 0.05, 0.2, 1.0, 5.0]

for name in ["m1", "m2", "m3", "m4", "m5"]:
    model = load_model(os.path.join(HERE, name + ".json"))
    assert model.name == name
    for torque in TORQUES:
        for speed in SPEEDS:
            both = model.compute_frictions(torque, -torque, speed)
            print(name, torque, speed, *(repr(float(x)) for x in both))
    if name == "m5":
        for torque in TORQUES[3:]:
            for speed in SPEEDS:
                for sense in [1.0, -1.0]:
                    friction = 0.0
                    for _ in range(200):
                        motor = torque + sense * friction
                        friction = float(model.compute_frictions(motor, -torque, speed)[0])
                    print("m5", sense * torque, speed, repr(friction), "balance")
