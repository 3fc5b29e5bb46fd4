"""Survivors of a stored run, tried again with newer tests."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from stepaside.studies.result_files import read_result, write_result

from .faults import Fault
from .score import NOTICED


def survivors_of(path: Path, faults: Iterable[Fault]) -> list[Fault]:
    """Return the faults that a stored run lists as survivors.

    Args:
        path: File of results.
        faults: Faults of the current code; a survivor whose line has changed
            is not among them.
    """
    keys = {row["key"] for row in read_result(path)["survivors"]}
    return [fault for fault in faults if fault.key in keys]


def write_noticed(
    path: Path,
    rows: Mapping[str, Mapping[str, Any]],
    reasons: Mapping[str, str],
) -> int:
    """Store which newer tests detect the survivors of a run.

    The score remains that of the run.

    Args:
        path: File of results.
        rows: Records of later trials by key of the fault.
        reasons: Reasons why other survivors are no gap, by key.

    Returns:
        Number of survivors detected now.
    """
    result = read_result(path)
    noticed = 0
    for survivor in result["survivors"]:
        row = rows.get(survivor["key"])
        survivor.pop("noticed_by", None)
        survivor["reason"] = reasons.get(survivor["key"], "")
        if row is not None and row["outcome"] in NOTICED:
            survivor["noticed_by"] = row["test"]
            noticed += 1
    write_result(path, result)
    return noticed
