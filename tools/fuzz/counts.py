"""Counts of fuzz cases by class, and the stored result."""

from collections import Counter
from pathlib import Path
from typing import Any

from stepaside.core.errors import ConfigurationError
from stepaside.studies.code_version import ROOT
from stepaside.studies.result_files import header, read_result, write_result

# First words of failures, and the column that each is counted in.
FAULTS = {
    "traceback": "tracebacks",
    "hang": "hangs",
    "accepted nonsense": "nonsense",
    "leftovers": "leftovers",
}
OTHER = "other"  # lost files, long words, statuses, results
COLUMNS = ("tried", *FAULTS.values(), OTHER)


class Counts:
    """Number of cases and failures of each class.

    Attributes:
        by_class: Counts by class and column.
    """

    def __init__(self) -> None:
        """Start with empty counts."""
        self.by_class: dict[str, Counter[str]] = {}

    def add(self, kind: str, complaint: str) -> None:
        """Count a case; the complaint is empty if it passed."""
        row = self.by_class.setdefault(kind, Counter())
        row["tried"] += 1
        if complaint:
            row[FAULTS.get(complaint.partition(":")[0], OTHER)] += 1

    def total(self) -> Counter[str]:
        """Return the counts of all classes together."""
        return sum(self.by_class.values(), Counter())

    @property
    def wrong(self) -> int:
        """Number of failed cases."""
        return wrong_in(self.total())

    def lines(self) -> list[str]:
        """Return one line per class, and one for the total."""
        rows = [*sorted(self.by_class.items()), ("all", self.total())]
        return [
            f"{kind:<28} {row['tried']:>7} tried {wrong_in(row):>5} wrong"
            for kind, row in rows
        ]


def wrong_in(row: Counter[str]) -> int:
    """Return the number of failures of any kind."""
    return row.total() - row["tried"]


def keep(
    file: Path, counts: Counts, seed: int, kinds: list[str], minutes: float
) -> None:
    """Store the counts of a seed in a result; replace former counts of it.

    Args:
        file: Result with the counts of all seeds; created if missing.
        counts: Counts of this run.
        seed: Random seed of this run.
        kinds: Kinds of cases.
        minutes: Duration of this run.
    """
    head = header(
        {"seeds": [], "kinds": sorted(kinds)},
        modules=all_modules(),
        libraries=("click", "mujoco", "numpy", "viser"),
        command=f"python -m tools.fuzz --seed SEED --kinds {' '.join(kinds)} "
        f"--minutes MINUTES --keep docs/results/{file.name}",
    )
    run = {
        "seed": seed,
        "minutes": minutes,
        "version": head["version"],
        "classes": {
            kind: {column: row[column] for column in COLUMNS}
            for kind, row in sorted(counts.by_class.items())
        },
    }
    runs = sorted([*_others(file, seed), run], key=lambda each: each["seed"])
    head["settings"]["seeds"] = [each["seed"] for each in runs]
    together: dict[str, Counter[str]] = {}
    for each in runs:
        for kind, row in each["classes"].items():
            together.setdefault(kind, Counter()).update(row)
    write_result(
        file,
        head,
        classes={k: dict(row) for k, row in sorted(together.items())},
        total={c: sum(row[c] for row in together.values()) for c in COLUMNS},
        runs=runs,
    )


def all_modules() -> tuple[str, ...]:
    """Return all modules and folders of the package."""
    names = (p.stem for p in ROOT.iterdir() if p.suffix in ("", ".py"))
    return tuple(sorted(name for name in names if name[0].isalpha()))


def _others(file: Path, seed: int) -> list[dict[str, Any]]:
    """Return the stored counts of other seeds."""
    try:
        runs = read_result(file)["runs"]
    except ConfigurationError:
        return []
    return [each for each in runs if each["seed"] != seed]
