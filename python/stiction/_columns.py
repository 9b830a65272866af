"""Columns in memory, as the library takes them: headers, units, and arrays of 64-bit floats.

An array of that kind which is contiguous is passed on as it is; any other that has numbers is copied once.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from . import _native
from ._errors import argument, kind_of

if TYPE_CHECKING:
    import numpy
    from numpy.typing import NDArray

    from ._errors import StictionError

    Column = tuple[str, "str | None", NDArray[numpy.float64]]

WHAT = "a path, a dict of arrays, a DataFrame of pandas or polars, or an Arrow table"
"""What a log may be."""
TABLES = ("collect_schema", "columns", "column_names", "__arrow_c_stream__")
"""What a table has: one of polars, of pandas, of pyarrow, of any other library that passes on Arrow tables."""
SECONDS = (
    "seconds as numbers: ((t - t[0]) / numpy.timedelta64(1, 's'), 's'), of a DataFrame (t - t.iloc[0]).dt.total_seconds()"
)
"""What a column of times may be."""
IN_SECONDS = re.compile(r"[\[(]\s*s\s*[\])]\s*$")
"""How a name ends that says seconds itself."""
EXACT = 2**53
"""Integers up to this are exact as 64-bit floats."""


def is_columns(data: object) -> bool:
    """Whether this is a table in memory rather than a path."""
    return isinstance(data, Mapping) or any(hasattr(data, name) for name in TABLES)


def columns(data: Any, name: str) -> list[Column]:
    """Every column of a table; `name` is that of the argument."""
    out: list[Column] = []
    for header, values in items(data, name):
        if not isinstance(header, str) or not header.strip() or not header.isprintable():
            raise argument(name, f"a column called {header!r}", "names that are text, such as 'position [mm]'")
        place = f"{name}[{header!r}]"
        unit = None
        if isinstance(values, tuple):
            if len(values) != 2 or not isinstance(values[1], str):
                raise argument(place, f"a tuple of {len(values)}", "an array, or (array, 'unit')")
            values, unit = values
        out.append(_column(header, unit, values, place))
    if not out:
        raise argument(name, "no column", "a time, a position or velocity, and a force")
    _same_length(out, name)
    return out


def index(data: Any, name: str) -> Column | None:
    """The index of a DataFrame of pandas as a column, where it may be the time: one of times, or with a name and numbers that rise."""
    found: Any = getattr(data, "index", None)
    if not hasattr(data, "columns") or not hasattr(found, "is_monotonic_increasing"):
        return None
    kind = getattr(found.dtype, "kind", "O")
    header = found.name if found.name is not None or kind not in "mM" else "time"
    if not isinstance(header, str) or header in list(data.columns) or kind not in "mMfiu" or not found.is_monotonic_increasing:
        return None
    return _column(header, None, found, f"{name}.index")


def _column(header: str, unit: str | None, values: Any, place: str) -> Column:
    """One column; times as seconds from the first."""
    found, mask = _found(values, place)
    times = _since_first(found)
    if times is None:
        return header, unit, _numbers(found, mask, place)
    if unit not in (None, "s"):
        raise argument(place, f"times with the unit {unit!r}", "no unit: they are taken as seconds from the first")
    return header, None if IN_SECONDS.search(header) else "s", _numbers(times, mask, place)


def is_missing(value: Any) -> bool:
    """None, NaN and the like of tables."""
    return value is None or type(value).__name__ in ("NaTType", "NAType") or value != value


def items(data: Any, name: str) -> Iterator[tuple[Any, Any]]:
    """The columns of a table with their names."""
    if hasattr(data, "collect_schema") and hasattr(data, "collect"):  # polars: one that is not computed yet
        raise argument(name, kind_of(data), "a table that is there: .collect()")
    if isinstance(data, Mapping):
        yield from data.items()
    elif hasattr(data, "column_names"):  # pyarrow
        _each_once(data.column_names, name)
        for header in data.column_names:
            yield header, data.column(header)
    elif hasattr(data, "__arrow_c_stream__") and not _has_arrays(data):
        yield from items(_arrow(data, name), name)
    elif hasattr(data, "columns"):  # pandas, polars
        headers = list(data.columns)
        _each_once(headers, name)
        for header in headers:
            yield header, data[header]
    else:
        raise argument(name, kind_of(data), WHAT)


def _each_once(headers: list[Any], name: str) -> None:
    for k, header in enumerate(headers):
        if header in headers[:k]:
            raise argument(name, f"two columns called {header!r}", "a name of its own for each column")


def _has_arrays(data: Any) -> bool:
    """Whether columns are given by their names as something that becomes an array, as pandas and polars do."""
    if not hasattr(data, "columns"):
        return False
    headers = list(data.columns)
    # Of two columns of one name pandas gives a table.
    return not headers or hasattr(data[headers[0]], "to_numpy")


def _arrow(data: Any, name: str) -> Any:
    """A table of another library, through pyarrow: without a copy where the columns are whole."""
    try:
        import pyarrow
    except ImportError:
        raise argument(name, f"{kind_of(data)}, which needs pyarrow", f"pip install pyarrow, or {WHAT}") from None
    try:
        return pyarrow.table(data)
    except (TypeError, ValueError) as error:
        raise argument(name, f"{kind_of(data)} that is no table ({error})", WHAT) from error


def array(values: Any, place: str) -> NDArray[numpy.float64]:
    """One column as contiguous 64-bit floats; missing samples are NaN."""
    found, mask = _found(values, place)
    return _numbers(found, mask, place)


def _found(values: Any, place: str) -> tuple[NDArray[Any], Any]:
    """One column as an array of whatever it holds, and which samples are masked."""
    import numpy

    mask = getattr(values, "mask", None) if isinstance(values, numpy.ma.MaskedArray) else None
    try:
        found = _plain(values)
    except (TypeError, ValueError) as error:
        raise argument(place, f"no array ({error})", "one number for each sample") from error
    if found.ndim == 0:
        raise argument(place, kind_of(values), "an array: one number for each sample")
    if found.ndim != 1:
        raise argument(place, f"an array of shape {found.shape}", "one dimension: one number for each sample")
    return found, mask


def _since_first(found: NDArray[Any]) -> NDArray[numpy.float64] | None:
    """Times as seconds from the first that is there; None of anything else."""
    import numpy

    if found.dtype.kind in "mM":
        there = found[~numpy.isnat(found)]
        return (found - there[0]) / numpy.timedelta64(1, "s") if len(there) else numpy.full(len(found), numpy.nan)
    there = [value for value in found if not is_missing(value)] if found.dtype.kind == "O" else []
    # Those of Python and pandas, which may have a time zone.
    if not there or not all(hasattr(value, "utcoffset") or hasattr(value, "total_seconds") for value in there):
        return None
    try:
        spans = [numpy.nan if is_missing(value) else (value - there[0]).total_seconds() for value in found]
    except TypeError:
        return None
    return numpy.array(spans)


def _numbers(found: NDArray[Any], mask: Any, place: str) -> NDArray[numpy.float64]:
    """The numbers of a column."""
    import numpy

    if found.dtype.kind in "mM":
        raise argument(place, f"an array of {found.dtype}", SECONDS)
    if found.dtype.kind == "O":
        raise _objects(found, place)
    if found.dtype.kind not in "fiub":
        raise argument(place, f"an array of {found.dtype}", _of_text(found[0] if len(found) else None))
    if found.dtype.kind in "iu" and found.size and max(abs(int(found.min())), abs(int(found.max()))) > EXACT:
        raise argument(
            place,
            "integers above 2**53, which lose digits as 64-bit floats",
            "smaller ones: subtract the first sample",
        )
    out = numpy.ascontiguousarray(found, dtype=numpy.float64)
    if mask is not None and numpy.any(mask):
        out = numpy.where(mask, numpy.nan, out)
    return out


def _objects(found: NDArray[Any], place: str) -> StictionError:
    """What is wrong with an array of Python objects: most are numbers beside something else, or times with a zone."""
    odd = next((k for k, value in enumerate(found) if not isinstance(value, (int, float))), None)
    if odd is None:
        return argument(place, "an array of objects", "real numbers: .astype(float) makes them of these")
    value = found[odd]
    what = f"an array of objects, {kind_of(value)} in row {odd + 1}"
    if hasattr(value, "utcoffset") or hasattr(value, "total_seconds"):
        return argument(place, what, SECONDS)
    if hasattr(value, "__len__"):
        return argument(place, what, _of_text(value))
    if is_missing(value):
        return argument(place, what, "NaN where a sample is missing: .astype(float) makes it of None")
    if hasattr(value, "__float__"):
        return argument(place, what, "real numbers: .astype(float) makes them of these")
    return argument(place, what, "real numbers; leave columns of text out")


def _of_text(value: Any) -> str:
    """What makes a column of a text like this one that can be taken."""
    text = str(value) if isinstance(value, str) else ""
    try:
        float(text)
        return "real numbers: .astype(float) makes them of these, of polars .cast(float)"
    except ValueError:
        pass
    if _native.seconds_of(text) is not None:
        return "times: pandas.to_datetime(...) makes them of these, of polars .str.to_datetime()"
    return "real numbers; leave columns of text out"


def _plain(values: Any) -> NDArray[Any]:
    """An array of what pandas, polars, pyarrow or a list has, without a copy where there need be none."""
    import numpy

    # Times with a zone, of pandas.
    if getattr(getattr(values, "dtype", None), "tz", None) is not None:
        return numpy.asarray(values.to_numpy(dtype="M8[ns]"))
    # Numbers that may be missing, of pandas.
    if hasattr(values, "isna") and getattr(values.dtype, "na_value", None) is not None:
        if getattr(values.dtype, "kind", "O") in "fiub":
            return numpy.asarray(values.to_numpy(dtype=numpy.float64, na_value=numpy.nan))
    if type(values).__module__.split(".")[0] == "pyarrow":
        return numpy.asarray(values.to_numpy(zero_copy_only=False))
    if hasattr(values, "to_numpy") and not isinstance(values, numpy.ndarray):
        return numpy.asarray(values.to_numpy())
    if isinstance(values, numpy.ma.MaskedArray):
        return numpy.asarray(values.data)
    return numpy.asarray(values)


def _same_length(out: list[Column], name: str) -> None:
    first, _, values = out[0]
    for header, _, other in out[1:]:
        if len(other) != len(values):
            raise argument(
                f"{name}[{header!r}]",
                f"{len(other)} samples, where {name}[{first!r}] has {len(values)}",
                "as many in every column",
            )
    if len(values) < 2:
        found = "no sample" if len(values) == 0 else "1 sample"
        raise argument(name, found, "a record: at least 2 samples to be read, some hundreds to be identified")
