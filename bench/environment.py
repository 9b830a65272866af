"""The Python that the comparisons run in: a virtual environment in `target/bench`, made from `requirements.txt` by the
first script that is started, from a clean checkout too. Needs Python 3.11 or later and PyPI.

    import environment
    environment.enter()     # before anything that is not in the standard library

A script with other requirements names their file and has an environment of its own.
"""

import os
import subprocess
import sys
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
# What the scripts write, and the environment.
WORK = ROOT / "target" / "bench"
HOME = WORK / "venv"
REQUIREMENTS = ROOT / "bench" / "requirements.txt"


def make(home, requirements):
    """Makes the environment afresh, unless it was made from the requirements as they are now."""
    wanted = requirements.read_text()
    # A copy of the requirements, written last: it is there only if all of them are installed.
    stamp = home / "requirements.installed"
    if stamp.exists() and stamp.read_text() == wanted:
        return
    assert sys.version_info >= (3, 11), f"found Python {sys.version.split()[0]}; 3.11 or later is needed"
    venv.create(home, clear=True, with_pip=True)
    pip = [home / "bin/python", "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    subprocess.check_call([*pip, "--only-binary", ":all:", "-r", requirements])
    stamp.write_text(wanted)


def enter(home=HOME, requirements=REQUIREMENTS):
    """Starts the script again inside the environment; returns where it runs there already."""
    if Path(sys.prefix) == home:
        return
    make(home, requirements)
    sys.stdout.flush()
    os.execv(home / "bin/python", [str(home / "bin/python"), *sys.argv])


def program():
    """Builds the command line and gives its path."""
    subprocess.check_call(["cargo", "build", "--quiet", "--release", "--bin", "stiction"], cwd=ROOT)
    return target() / "release/stiction"


def example(name):
    """Builds an example of the workspace and gives its path."""
    subprocess.check_call(["cargo", "build", "--quiet", "--release", "--workspace", "--example", name], cwd=ROOT)
    return target() / "release/examples" / name


def target():
    """Where cargo builds."""
    return ROOT / os.environ.get("CARGO_TARGET_DIR", "target")


def described(*packages, is_timed=True):
    """Date, machine and versions, for the line over a table."""
    import datetime
    import importlib.metadata

    cpu = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if "model name" in line), "unknown processor")
    load = f" under a load of {os.getloadavg()[0]:.0f}" if is_timed else ""
    commit = subprocess.check_output(["git", "rev-parse", "--short=8", "HEAD"], cwd=ROOT, text=True).strip()
    rustc = subprocess.check_output(["rustc", "--version"], text=True).split()[1]
    versions = [f"{name} {importlib.metadata.version(name)}" for name in packages]
    about = [f"{datetime.date.today()}", f"commit {commit}", f"{cpu}, {os.cpu_count()} cores{load}"]
    return "; ".join([*about, ", ".join([f"Python {sys.version.split()[0]}", *versions, f"rustc {rustc}"])])
