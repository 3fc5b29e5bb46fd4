"""Tables of records: shares and means with their intervals, data frames."""

import json
from collections.abc import Iterable, Mapping, Sequence
from importlib import import_module
from math import sqrt
from typing import Any

import numpy as np
from scipy.special import stdtrit

from ..core.errors import check_choice

Record = dict[str, Any]
"""Measured values of one case by name, as values for JSON."""
NORMAL = 1.959964  # standard deviations of a 95 % interval
# Values for an interval of their mean: that of two is 12.7 standard errors.
LEAST_SPREAD = 3


def tabulate(
    records: Iterable[Mapping[str, Any]],
    by: Sequence[str],
    values: Sequence[str],
) -> list[Record]:
    """Tabulate values over groups of records that agree in ``by``.

    Returns:
        One row for each group, in the order of its first record: the values
        of ``by``; ``number``, that of its records; and for each value a
        dictionary. Of a number: ``number`` of records that have the value,
        ``mean``, ``half``, half of its 95 % interval by Student's t (None
        below three values), ``min``, ``median`` and ``max``. Of a truth
        value: ``count``, ``share`` and its 95 % interval ``low`` to ``high``
        after Wilson. Of a text: these for each text that occurs. None
        without any value.

    Raises:
        ConfigurationError: If no record has one of the values, nor the part
            of it before the dot.
    """
    groups: dict[str, list[Mapping[str, Any]]] = {}
    for record in records:
        key = json.dumps([record.get(name) for name in by])
        groups.setdefault(key, []).append(record)
    rows = [r for group in groups.values() for r in group]
    for name in (*by, *values):
        part = name.partition(".")[0]  # None where the level has no such part
        if rows and not any({name, part} & r.keys() for r in rows):
            names = dict.fromkeys(n for g in groups.values() for n in g[0])
            check_choice(name, names, "by" if name in by else "value")
    return [
        {name: group[0].get(name) for name in by}
        | {"number": len(group)}
        | {name: _statistics([r.get(name) for r in group]) for name in values}
        for group in groups.values()
    ]


def _statistics(found: list[Any]) -> Any:
    """Return the statistics of a value over the records of a group."""
    present = [value for value in found if value is not None]
    if not present:
        return None
    if all(isinstance(value, bool) for value in present):
        return share_of(sum(present), len(present))
    if any(isinstance(value, str) for value in present):
        return {
            text: share_of(found.count(text), len(found))
            for text in dict.fromkeys(present)
        }
    return mean_of(present)


def share_of(count: int, number: int) -> Record:
    """Return a share of a number of cases, with its 95 % interval."""
    low, high = wilson_interval(count, number)
    share = count / number if number else None
    return {"count": count, "share": share, "low": low, "high": high}


def mean_of(values: Sequence[float]) -> Record:
    """Return the mean of values, with half of its 95 % interval.

    It is by Student's t, and None below three values, which tell no spread.
    """
    each, n, half = np.asarray(values, dtype=np.float64), len(values), None
    if n >= LEAST_SPREAD:
        half = float(stdtrit(n - 1, 0.975) * each.std(ddof=1) / sqrt(n))
    return {
        "number": n,
        "mean": float(each.mean()),
        "half": half,
        "min": float(each.min()),
        "median": float(np.median(each)),
        "max": float(each.max()),
    }


def wilson_interval(count: int, number: int) -> tuple[float, float]:
    """Return the 95 % interval of a proportion, after Wilson (1927)."""
    if number == 0:
        return 0.0, 1.0
    z, n = NORMAL, number
    share = count / n
    middle = (share + z * z / (2 * n)) / (1 + z * z / n)
    half = z / (1 + z * z / n)
    half *= sqrt(share * (1 - share) / n + z * z / (4 * n * n))
    # by rounding an end may miss the share, where that is 0 or 1
    low, high = min(middle - half, share), max(middle + half, share)
    return max(0.0, low), min(1.0, high)


def flat(record: Mapping[str, Any]) -> Record:
    """Return a record without nested dictionaries; names get dots."""
    found: Record = {}
    for name, value in record.items():
        if isinstance(value, Mapping):
            for inner, one in flat(value).items():
                found[f"{name}.{inner}"] = one
        else:
            found[name] = value
    return found


def to_frame(
    records: Iterable[Mapping[str, Any]], library: str = "polars"
) -> Any:
    """Return records as a data frame of polars or pandas, one row each.

    Lists become JSON text; a value that a record lacks is null.

    Raises:
        ConfigurationError: If the library is neither.
        ModuleNotFoundError: If it is not installed.
    """
    check_choice(library, ("polars", "pandas"), "library")
    try:
        frames = import_module(library)
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(
            f"to_frame({library!r}) needs {library}, which is not installed: "
            f"pip install {library}; the other of polars and pandas will do",
            name=error.name,
        ) from error
    rows = [
        {
            name: json.dumps(value) if isinstance(value, list) else value
            for name, value in record.items()
        }
        for record in records
    ]
    if library == "pandas":
        return frames.DataFrame(rows)
    return frames.DataFrame(rows, infer_schema_length=None, strict=False)
