"""Many machines: what `stiction batch` writes of a log, as one pure function, and its results as a data set of a fleet.

>>> from stiction.fleet import identify_uri, run
>>> row = identify_uri("s3://logs/2026-03-01/m7.parquet", "axis.toml", law="lugre")     # doctest: +SKIP
>>> run("s3://logs/2026-03-01/", "fleet", "axis.toml", law="lugre", client=client)      # doctest: +SKIP

`identify_uri` needs nothing but stiction for local logs; `pip install stiction[fleet]` has what `run` and addresses need.
Guide: docs/fleet.md.
"""

from ._one import identify_uri
from ._run import Summary, run

__all__ = ["Summary", "identify_uri", "run"]
