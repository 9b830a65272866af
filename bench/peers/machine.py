"""Where things are, and what they were measured on. Imported first: it enters the environment."""

import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import environment

environment.enter()

# One core for everybody; to be set before numpy is imported.
for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ[name] = "1"

ROOT = environment.ROOT
WORK = environment.WORK / "peers"
WORK.mkdir(parents=True, exist_ok=True)

described = environment.described
