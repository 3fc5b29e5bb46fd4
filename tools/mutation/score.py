"""Score and survivors of a run, and the file of results."""

import tomllib
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from stepaside.studies.code_version import LIBRARIES
from stepaside.studies.result_files import header, write_result

# Packages that faults are drawn from.
PACKAGES = (
    "planning",
    "locomotion",
    "control",
    "theory/unicycle",
    "robots",
    "perception",
    "strategies",
    "sim",
    "arena",
    "games",
    "studies",
)
REASONS = Path("tools/mutation/reasons.toml")
RESULTS = Path("docs/results/mutation.json")
SAMPLE = 400  # number of faults
CAP = 40.0  # maximum processor time of the tests of one fault, in [s]
NOTICED = ("killed", "timeout")


def read_reasons(path: Path) -> dict[str, str]:
    """Return why survivors are no gap, or which test is missing, by key."""
    if not path.exists():
        return {}
    found: dict[str, str] = tomllib.loads(path.read_text(encoding="utf-8"))
    return found


def summary(
    rows: list[dict[str, Any]], reasons: Mapping[str, str]
) -> dict[str, Any]:
    """Return the results of a run without times, so that runs are comparable.

    Args:
        rows: Records of the trials, in the order of the draw.
        reasons: Reasons by key.
    """
    survivors = [
        {
            name: row[name]
            for name in ("key", "file", "line", "operator", "before", "after")
        }
        | {
            "reached": row["outcome"] != "unreached",
            "reason": reasons.get(row["key"], ""),
        }
        for row in rows
        if row["outcome"] not in NOTICED
    ]
    survivors.sort(key=lambda row: (row["file"], row["line"], row["key"]))
    packages = {}
    for package in sorted({_package(row) for row in rows}):
        of = [row["outcome"] for row in rows if _package(row) == package]
        noticed = sum(outcome in NOTICED for outcome in of)
        packages[package] = {"faults": len(of), "noticed": noticed}
    noticed = sum(row["outcome"] in NOTICED for row in rows)
    return {
        "faults": len(rows),
        "noticed": noticed,
        "score": round(noticed / len(rows), 4) if rows else None,
        "outcomes": dict(sorted(Counter(r["outcome"] for r in rows).items())),
        "packages": packages,
        "survivors": survivors,
    }


def score_line(found: Mapping[str, Any]) -> str:
    """Return one line with the score."""
    if not found["faults"]:
        return "no faults"
    return (
        f"{found['noticed']} of {found['faults']} faults noticed "
        f"({100.0 * found['score']:.1f} %)"
    )


def head(*, sample: int, seed: int, cap: float) -> dict[str, Any]:
    """Return the header of the results, for the current code.

    Args:
        sample: Number of faults drawn.
        seed: Seed of the draw.
        cap: Maximum processor time of the tests of one fault, in [s].
    """
    make = "make mutate"
    options = f" SAMPLE={sample}" if sample != SAMPLE else ""
    options += f" CAP={cap:g}" if cap != CAP else ""
    return header(
        {"sample": sample, "seed": seed, "cap_s": cap},
        modules=PACKAGES,
        libraries=(*LIBRARIES, "hypothesis"),
        command=make + options,
    )


def write(
    path: Path, where_from: Mapping[str, Any], found: Mapping[str, Any]
) -> None:
    """Write the file of results.

    Args:
        path: File of results.
        where_from: Output of :func:`head`.
        found: Output of :func:`summary`.

    Raises:
        ValueError: If faults of the sample have not been tried. Faults that
            no test reaches come first, so a partial score would be biased.
    """
    drawn = where_from["settings"]["sample"]
    if found["faults"] != drawn:
        raise ValueError(f"want {drawn} faults tried, got {found['faults']}")
    write_result(path, where_from, **found)


def _package(row: Mapping[str, Any]) -> str:
    return str(row["file"]).removeprefix("src/stepaside/").partition("/")[0]
