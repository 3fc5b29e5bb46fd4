"""Score and survivors, as a file of results and as a page of the docs."""

import json
import tomllib
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any

REASONS = Path("tests/mutation/reasons.toml")
RESULTS = Path("docs/results/mutation.json")
PAGE = Path("docs/mutation.md")
NOTICED = ("killed", "timeout")


def read_reasons(path: Path) -> dict[str, str]:
    """Why a survivor is no gap, or what it lacks, by key of the fault."""
    if not path.exists():
        return {}
    found: dict[str, str] = tomllib.loads(path.read_text(encoding="utf-8"))
    return found


def summary(
    rows: list[dict[str, Any]],
    *,
    sample: int | None,
    seed: int,
    cap: float,
    version: str,
    reasons: Mapping[str, str],
) -> dict[str, Any]:
    """What a run says, without times, so that it can be compared.

    Args:
        rows: Records of the trials, in the order of the draw.
        sample: How many faults were drawn; None for all.
        seed: Seed of the draw.
        cap: Processor time of tests that a fault could take, in [s].
        version: Fingerprint of the code that was changed.
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
        "version": version,
        "sample": sample,
        "seed": seed,
        "cap_s": cap,
        "faults": len(rows),
        "noticed": noticed,
        "score": round(noticed / len(rows), 4) if rows else None,
        "outcomes": dict(sorted(Counter(r["outcome"] for r in rows).items())),
        "packages": packages,
        "survivors": survivors,
    }


def score_line(found: Mapping[str, Any]) -> str:
    """One line with the score."""
    if not found["faults"]:
        return "no faults"
    return (
        f"{found['noticed']} of {found['faults']} faults noticed "
        f"({100.0 * found['score']:.1f} %)"
    )


def write(root: Path, found: Mapping[str, Any]) -> None:
    """Write the file of results and the page of the docs."""
    path = root / RESULTS
    path.parent.mkdir(parents=True, exist_ok=True)
    text = json.dumps(found, indent=2, ensure_ascii=False)
    path.write_text(text + "\n", encoding="utf-8")
    (root / PAGE).write_text(markdown(found), encoding="utf-8")


def markdown(found: Mapping[str, Any]) -> str:
    """Page of the docs about a run."""
    intro = Path(__file__).with_name("page.md").read_text(encoding="utf-8")
    outcomes = found["outcomes"]
    drawn = "all" if found["sample"] is None else "drawn"
    lines = [
        intro.rstrip(),
        "",
        "## Score",
        "",
        f"**{score_line(found)}**; {drawn} by seed {found['seed']}, on code "
        f"version `{found['version']}`. {outcomes.get('timeout', 0)} were "
        "noticed by a time limit; "
        f"{outcomes.get('unreached', 0)} are reached by no test.",
        "",
        "| package | faults | noticed | share |",
        "|---|---|---|---|",
    ]
    for name, row in found["packages"].items():
        share = 100.0 * row["noticed"] / row["faults"]
        lines.append(
            f"| {name} | {row['faults']} | {row['noticed']} | {share:.0f} % |"
        )
    lines += ["", "## Survivors", ""]
    lines += ["| where | before | after | reason |", "|---|---|---|---|"]
    for row in found["survivors"]:
        where = f"{row['file'].removeprefix('src/stepaside/')}:{row['line']}"
        reason = row["reason"] or ("" if row["reached"] else "no test reaches")
        before, after = _code(row["before"]), _code(row["after"])
        lines.append(f"| {where} | {before} | {after} | {reason} |")
    return "\n".join(lines) + "\n"


def _code(text: str) -> str:
    """Code for a cell of a table."""
    return "`" + text.replace("|", "\\|") + "`" if text else "nothing"


def _package(row: Mapping[str, Any]) -> str:
    return str(row["file"]).removeprefix("src/stepaside/").partition("/")[0]
