#!/usr/bin/python3
"""Takes the place of the screen: switches the machine on, homes it, runs programs and logs the axis.

    linuxcnc -r stage.ini PROGRAM LOG ..
    linuxcnc -r compensated.ini gain=0 PROGRAM LOG gain=1 PROGRAM LOG ..

`gain=` is that of the compensator from there on. What it has learnt is written at the end, as lines of HAL: kept.hal.
"""

import os
import subprocess
import sys
import time

import hal
import linuxcnc

FRICTION = "x-axis-friction.0."


def wait(machine, condition, seconds):
    """Until the condition holds."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            sys.exit("LinuxCNC does not get on")
        time.sleep(0.01)
        machine.poll()


def switch_on(command, machine):
    command.state(linuxcnc.STATE_ESTOP_RESET)
    command.state(linuxcnc.STATE_ON)
    command.home(-1)
    machine.poll()
    wait(machine, lambda: all(machine.homed[: machine.joints]), 10)
    command.mode(linuxcnc.MODE_AUTO)
    command.wait_complete()


def run(command, machine, program, log):
    """Runs the program; the log has every period of the thread from before its start to after its end."""
    with open(log, "w") as file:
        sampler = subprocess.Popen(["halsampler", "-t"], stdout=file)
        hal.set_p("sampler.0.enable", "TRUE")
        command.program_open(os.path.abspath(program))
        command.auto(linuxcnc.AUTO_RUN, 0)
        wait(machine, lambda: machine.interp_state != linuxcnc.INTERP_IDLE, 10)
        wait(machine, lambda: machine.interp_state == linuxcnc.INTERP_IDLE, 60)
        hal.set_p("sampler.0.enable", "FALSE")
        wait(machine, lambda: hal.get_value("sampler.0.curr-depth") == 0, 10)
        # what it has taken it writes before it ends
        sampler.terminate()
        sampler.wait()
    with open(log) as file:
        print(log, "has", len(file.readlines()), "samples,", hal.get_value("sampler.0.overruns"), "overruns")


def main(arguments):
    component = hal.component("run")
    component.ready()
    command, machine, errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()
    switch_on(command, machine)
    while arguments:
        name, _, value = arguments.pop(0).partition("=")
        if value:
            hal.set_p(FRICTION + name, value)
            continue
        run(command, machine, name, arguments.pop(0))
        while message := errors.poll():
            print("LinuxCNC says:", message[1])
        if hal.component_exists("x_axis_friction"):
            pins = {pin: hal.get_value(FRICTION + pin) for pin in ["gain", "learned", "baseline", "tripped", "valid", "recalled"]}
            with open("kept.hal", "w") as file:
                for number in [f"{FRICTION}kept-{k:02}" for k in range(12)]:
                    file.write(f"setp {number} {hal.get_value(number)!r}\n")
            print("compensator:", ", ".join(f"{pin} {value:.3g}" for pin, value in pins.items()))


# LinuxCNC puts -ini FILE first
main(sys.argv[3:])
