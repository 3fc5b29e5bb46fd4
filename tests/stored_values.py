"""Texts and numbers that a test stores in ``tests/data`` and compares.

Store what is meant: ``STORE=1 pytest tests/...``.
"""

import json
import os
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np
import pytest

PATH = r"(?<!\S)(?![\[(]?(?:m|rad|deg|1)/s\b)\S*/\S*"  # no unit
OF_THE_MACHINE = (
    rf"real time factor +\S+|(median|p99) \S+ us|solver time .*|{PATH}"
)
LONG = 300  # of a text that is cut, in characters
DATA = Path(__file__).parent / "data"


def compare_stored(
    file: str, key: str, found: Iterable[str | float], rel: float = 2e-3
) -> None:
    """Compare texts and numbers with those that a file has under a key."""
    path, values = DATA / file, list(found)
    stored = json.loads(path.read_text("utf-8")) if path.exists() else {}
    if "STORE" in os.environ:
        stored[key] = [
            float(f"{x:.6g}") if isinstance(x, float) else x for x in values
        ]
        lines = (
            f"{json.dumps(k)}: {json.dumps(v)}" for k, v in stored.items()
        )
        path.write_text("{\n" + ",\n".join(lines) + "\n}\n", "utf-8")
    both = zip(values, stored[key], strict=False)
    for number, (one, other) in enumerate(both):
        near = pytest.approx(other, rel=rel, abs=0.01 * rel)
        around = values[max(0, number - 6) : number + 2]
        assert one == (near if isinstance(other, float) else other), around
    assert len(values) == len(stored[key])


def rows_of(table: str) -> list[Any]:
    """Return the rows of a table of what is refused, and how."""
    rows: list[Any] = json.loads((DATA / "refusals.json").read_text())[table]
    return rows


def words_of(text: str) -> Iterator[str | float]:
    """Yield words and numbers of a printed text, but times and folders."""
    for word in re.sub(OF_THE_MACHINE, "", text).split():
        try:
            yield float(word.rstrip(",:;)").lstrip("("))
        except ValueError:
            yield word


def content_of(value: Any) -> Iterator[str | float]:
    """Yield the texts and numbers in a value; of arrays three rows."""
    if is_dataclass(value):
        for field in fields(value):
            if not field.name.endswith(("uuid", "container_id", "order")):
                yield from content_of(getattr(value, field.name))
    elif isinstance(value, Mapping):
        for name, each in value.items():
            yield str(name)
            yield from content_of(each)
    elif isinstance(value, np.ndarray) and value.dtype.kind in "fiub":
        yield from map(float, value.shape)
        if value.size:
            rows = np.atleast_1d(value).astype(float)
            rows[~np.isfinite(rows)] = -1.0
            rows = rows.reshape(len(rows), -1)
            for row in (rows[0], rows[-1], rows.mean(axis=0)):
                yield from row[:8].tolist()
    elif isinstance(value, tuple | list):
        for each in value:
            yield from content_of(each)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield float(value) if isfinite(value) else str(value)
    elif not isinstance(value, bytes):
        yield str(value)


def summed(value: Any) -> Iterator[str | float]:
    """Yield the texts in a value, and two sums of all its numbers.

    Large numbers, like times in [ns], count by their logarithms.
    """
    values = [*content_of(value)]
    numbers = np.array([x for x in values if isinstance(x, float)])
    numbers = np.arcsinh(numbers)
    phase = np.arange(len(numbers))
    text = " ".join(x for x in values if isinstance(x, str))
    yield text if len(text) < LONG else f"{text[:LONG]} {len(text)}"
    yield from (float(numbers @ np.cos(phase)), float(numbers @ np.sin(phase)))
