"""Mutation score, and survivors."""

from collections.abc import Mapping
from typing import Any

from stepaside.studies.survival_statistics import wilson_interval

from .markdown import number, table

PACKAGE = "src/stepaside/"


def score(result: Mapping[str, Any]) -> str:
    """List the number of detected faults, in total and by package."""
    outcomes = result["outcomes"]
    since = sum("noticed_by" in row for row in result["survivors"])
    later = (
        " Newer tests, and tests that the time limit had excluded, detect "
        f"{since} of the survivors."
        if since
        else ""
    )
    low, high = (
        number(100.0 * share, 0)
        for share in wilson_interval(result["noticed"], result["faults"])
    )
    rows = [
        (
            name,
            str(found["faults"]),
            str(found["noticed"]),
            f"{number(100.0 * found['noticed'] / found['faults'], 0)} %",
        )
        for name, found in result["packages"].items()
    ]
    return (
        f"**{result['noticed']} of {result['faults']} faults detected "
        f"({number(100.0 * result['score'], 1)} %)**; `{result['command']}`, "
        f"drawn by seed {result['settings']['seed']}, on code version "
        f"`{result['version']}`. {outcomes.get('timeout', 0)} were detected "
        f"by a time limit; {outcomes.get('unreached', 0)} are reached by no "
        f"test. The 95 % interval of the detection rate is {low} to "
        f"{high} %.{later}\n\n"
        + table(("package", "faults", "detected", "rate"), rows)
    )


def survivors(result: Mapping[str, Any]) -> str:
    """List each undetected fault with its reason."""
    if not result["survivors"]:
        return "None."
    rows = [
        (
            f"{row['file'].removeprefix(PACKAGE)}:{row['line']}",
            _code(row["before"]),
            _code(row["after"]),
            _reason(row),
        )
        for row in result["survivors"]
    ]
    return table(("location", "before", "after", "reason"), rows)


def _reason(row: Mapping[str, Any]) -> str:
    if "noticed_by" in row:
        test = row["noticed_by"].partition("[")[0]
        return f"detected since by `{test.rpartition('/')[2]}`"
    return str(row["reason"]) or (
        "" if row["reached"] else "reached by no test"
    )


def _code(text: str) -> str:
    return f"`{text}`" if text else "nothing"
